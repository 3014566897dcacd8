# SPDX-License-Identifier: GPL-3.0-or-later
# A rod with flaws is pulled apart at its ends, in a plane: one crack across it, in the middle, and the stress is gone.
#   make -f pipelines/tensile.mk [SIZE=small|medium|large]
# Gray, Monaghan & Swift (2001), CMAME 190, 6641, section on fracture; units as in rings.mk: 3 cm by 1 cm, K 1, mu 0.3, Weibull m 8.5, k 1.4e19
# an area of 1; the ends (|x| > 1.3) move at 5e-3 of the speed of sound, beyond 1.1 there are no flaws.

# spacing of the particles: 4800, 19 200, 120 000 of them; seeds of the flaws
DX = $(call by_size,0.025,0.0125,0.005)
SEEDS = 1 2 3 4
# time between snapshots, of 6
EVERY = $(call by_size,0.1,0.1,0.2)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/damage.png $(OUT)/stress.png
runs = $(SEEDS:%=$(OUT)/s%)

# The middle breaks; the grips are of the same without flaws. Bodies: middle 0, left end 1, right end 2. mkshape puts the top at y = 0.
$(OUT)/grip.cfg: $(firstword $(wildcard $(here)../materials/rubber.cfg $(here)../../materials/rubber.cfg))
	@mkdir -p $(@D)
	sed -e 's/^name = .*/name = "grip";/' -e 's/0.22 Pa/0.3 Pa/' -e 's/1e30 Pa/0.03 Pa/' $< > $@
$(OUT)/rod.cfg: $(OUT)/grip.cfg
	{ sed -e 's/^name = .*/name = "rod";/' $<; echo 'damage = { form = "grady_kipp"; k = "1.4e19 1/m^3"; m = 8.5; };'; } > $@
$(call from,$(OUT)/rod.h5,$(DX))
$(OUT)/rod.h5: $(OUT)/rod.cfg | $(programs)
	for p in 'rod 2.2' 'grip 0.4'; do set -- $$p; \
	  mkshape -d 2 --shape box --size $${2}m,1m --spacing $(DX)m --lattice grid --neighbours 28.2743 -l $(OUT)/$$1.cfg -o $(OUT)/$$1.part.h5; done
	alter -j $(OUT)/grip.part.h5 -j $(OUT)/grip.part.h5 -s 'Coordinates.x=Coordinates.x + if(BodyID == 0, 0, if(BodyID == 1, -1.3, 1.3))*1m' \
	  -s 'BodyID=if(Coordinates.x < -1.3m, 1, if(Coordinates.x > 1.3m, 2, 0))' -o $@ $(OUT)/rod.part.h5
	$(remember)
$(runs:%=%/start.h5): $(OUT)/s%/start.h5: $(OUT)/rod.h5
	@mkdir -p $(@D)
	weibull --seed $* $< | alter -s 'Velocities.x=if(BodyID == 0, 0, if(BodyID == 1, -5e-3, 5e-3))*1m/s' -o $@
settings = --end 6 --every $(EVERY) $(call sets,gravity.method=none kernel=cubic_spline smoothing.mode=fixed viscosity.alpha=1 viscosity.beta=2 \
  walls.body1=-5e-3$(,)0$(,)0 walls.body2=5e-3$(,)0$(,)0 $(SET))
# Over time: the most damaged particle's damage, its place; mean stress at |x| = 0.6.
$(call from,$(runs:%=%/crack.tsv),$(settings))
$(runs:%=%/crack.tsv): %/crack.tsv: %/start.h5
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do columns -f Coordinates.x -f Coordinates.y -f Damage -f 'if(Pressure < 0Pa, 1 - Damage, 1)*Pressure' -f '(1 - Damage)*DeviatoricStress.xx' -f Velocities.x $$s | \
	  awk -v dx=$(DX) -f $(here)crack.awk; done | awk '{ print (NR - 1)*$(EVERY) "\t" $$0 }' > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)tensile.awk $(runs:%=%/crack.tsv)
	$(call judge,tensile.awk) -v dx=$(DX) $(runs:%=%/crack.tsv) > $@
$(OUT)/damage.png: $(OUT)/verdict.tsv
	render --color Damage --range 0:1 --size 1200x700 --panels 2x2 --extent 3.4m -o $@ $(foreach r,$(runs),$$(ls $r/run/snap_*.h5 | tail -1))
$(OUT)/stress.png: $(here)tensile.gp $(OUT)/verdict.tsv
	gnuplot -c $< '$(SEEDS)' $(OUT) $@
