# SPDX-License-Identifier: GPL-3.0-or-later
# A plate, clamped at one end, swings freely: period and damping, against the theory of thin plates.
#   make -f pipelines/plate.mk [SIZE=small|medium|large]
# Landau & Lifshitz, Theory of Elasticity, section 25; Gray, Monaghan & Swift (2001), CMAME 190, 6641. In a plane, 20 cm long, 2 cm thick;
# omega^2 = E H^2 k^4/(12 rho (1 - nu^2)), k L = 1.8751: T = 0.25403 s. Codes of this kind have published periods 5 to 12 % longer.

# spacing of the particles [mm]; speed of the tip over that of sound
DX = $(call by_size,2,1,0.5)
SPEEDS = $(call by_size,0.01,0.01 0.05,0.01 0.05)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/plate.png $(OUT)/bent.png
runs = $(SPEEDS:%=$(OUT)/v%)

# E = 2 MPa, nu = 0.3975, rho 1000: rubber with K and mu of these.
$(OUT)/plate.cfg: $(firstword $(wildcard $(here)../materials/rubber.cfg $(here)../../materials/rubber.cfg))
	@mkdir -p $(@D)
	sed -e 's/^name = .*/name = "plate";/' -e 's/"1 kg/"1000 kg/' -e 's/"1 Pa"/"3.25203e6 Pa"/' -e 's/0.22 Pa/7.15564e5 Pa/' $< > $@
# Artificial stress as in Gray et al.: without it particles in tension gather, and 44 % of the amplitude are lost in a period; so are 18 % (1 mm) with the cubic spline.
# The first mode, 1 at the tip: (cos kL + cosh kL)(cosh kx - cos kx) + (sin kL - sinh kL)(sinh kx - sin kx) over what that is at x = L.
# What lies in the clamp (6 cm, body 1) is held. mkshape puts the top at y = 0.
kx = 9.37552034*Coordinates.x/1m
mode = 0.5*((exp($(kx)) + exp(-$(kx)))/2 - cos($(kx))) - 0.36704776*((exp($(kx)) - exp(-$(kx)))/2 - sin($(kx)))
$(call from,$(runs:%=%/start.h5),$(DX))
$(runs:%=%/start.h5): $(OUT)/v%/start.h5: $(OUT)/plate.cfg | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape box --size 260mm,20mm --spacing $(DX)mm --lattice grid --neighbours 30 -l $< | \
	  alter -s 'Coordinates.x=Coordinates.x + 70mm' -s 'Coordinates.y=Coordinates.y + 10mm' -s 'BodyID=Coordinates.x < 0m' \
	    -s 'Velocities.y=if(BodyID == 1, 0, $**57.0266*($(mode)))*1m/s' -o $@
	$(remember)
settings = --end 0.36 --every 0.004 $(call sets,gravity.method=none smoothing.mode=fixed stress.artificial=0.2 walls.body1=held viscosity.alpha=0.05 viscosity.beta=0 $(SET))
$(call from,$(runs:%=%/tip.tsv),$(settings))
$(runs:%=%/tip.tsv): %/tip.tsv: %/start.h5
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do columns -f Coordinates.y -f ParticleIDs $$s | \
	  awk -v tips="$$(columns -f ParticleIDs -w 'Coordinates.x > 200mm - 1.5*$(DX)*1mm' $< | grep -v '^#' | tr '\n' ' ')" \
	    'BEGIN { n = split(tips, t, " "); for (k = 1; k <= n; k++) is[t[k]] = 1 } /^#/ { next } $$2 in is { y += $$1/n } END { print y }'; done | \
	  awk '{ print (NR - 1)*0.004 "\t" $$1 }' > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)plate.awk $(runs:%=%/tip.tsv)
	$(call judge,plate.awk) -v dx=$(DX) $(foreach r,$(runs),$r/tip.tsv $r/run/conserved.tsv) > $@
$(OUT)/plate.png: $(here)plate.gp $(OUT)/verdict.tsv
	gnuplot -c $< '$(SPEEDS)' $(OUT) $@
$(OUT)/bent.png: $(OUT)/verdict.tsv
	render --color Pressure --size 1200x400 --panels 2x1 -C 0.08,0,0 --extent 0.3m -o $@ $(foreach k,0015 0048,$(lastword $(runs))/run/snap_$k.h5)
