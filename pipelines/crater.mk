# SPDX-License-Identifier: GPL-3.0-or-later
# A sphere of aluminium of 6.35 mm hits the flat side of half a ball of aluminium at 7 km/s: depth and width of the crater, for two strengths.
#   make -f pipelines/crater.mk [SIZE=small|medium|large]
# Schaefer et al. (2016), section 4.3 (its radius of 6.35 mm is the diameter, its strength of 100 MPa that of soft aluminium); equation of
# Cour-Palais and Christiansen for the depth: 12.8 mm in 6061-T6, 18.3 mm in 1100-O. At these sizes the depth hangs on resolution and viscosity.

# spacing of the particles, as edges of cubes of their volume [mm]; radius of the half ball that is hit [mm]; end, time between snapshots
# [microseconds]
DX = $(call by_size,1.25,1,0.63)
REACH = $(call by_size,30,50,50)
END = 30
EVERY = $(call by_size,1,2.5,2.5)
# yield strengths [MPa]
STRENGTH = 276 100
# artificial viscosity: these are the alpha, beta = 1, 2 of codes whose h is half the support; the paper prints 0.5 and 0 for the full support
SET = viscosity.alpha=0.5 viscosity.beta=0.5

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/crater.png $(OUT)/depth.png
aluminium = $(firstword $(wildcard $(here)../materials/aluminium.cfg $(here)../../materials/aluminium.cfg))
runs = $(STRENGTH:%=$(OUT)/Y%)

# A close packing, turned: where the sphere meets a lattice along its rows, these open before it and the crater is too deep on its axis.
$(call from,$(runs:%=%/start.h5),$(DX) $(REACH))
$(runs:%=%/start.h5): $(OUT)/Y%/start.h5: | $(programs)
	@mkdir -p $(@D)
	sed -e 's/^name = .*/name = "aluminium_$*";/' -e 's/ Y = "276 MPa"/ Y = "$* MPa"/' $(aluminium) > $(@D)/aluminium_$*.cfg
	mkshape --size 3.175mm,3.175mm,3.175mm --spacing $(DX)mm --lattice cubic -l $(@D)/aluminium_$*.cfg -o $(@D)/sphere.h5
	a=$$(awk 'BEGIN { printf "%.9g", $(DX)*2^(1/6) }'); \
	mkshape --shape hemisphere --size $(REACH)mm --spacing $${a}mm --rotate 3 -l $(@D)/aluminium_$*.cfg | \
	  alter -j $(@D)/sphere.h5 -s 'Coordinates.z=Coordinates.z + if(BodyID == 1, 3.175mm + 0.5*$(DX)mm, 0m)' \
	    -s 'Velocities.z=if(BodyID == 1, -7km/s, 0m/s)' -o $@
	$(remember)
$(call from,$(runs:%=%/shape.tsv),--end $(END)e-6 --every $(EVERY)e-6 $(call sets,gravity.method=none $(SET)))
$(runs:%=%/shape.tsv): %/shape.tsv: %/start.h5
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do columns -f Coordinates.x -f Coordinates.y -f Coordinates.z -f Masses -w 'BodyID == 0 && Density > 2000kg/m^3' $$s | \
	  awk -v dx=$(DX)e-3 -v every=$(EVERY) -v sheet=$$s -f $(here)crater_shape.awk; done > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)crater.awk $(runs:%=%/shape.tsv)
	$(call judge,crater.awk) -v dx=$(DX) $(runs:%=%/shape.tsv) $(firstword $(runs))/run/conserved.tsv > $@
$(OUT)/crater.png: $(OUT)/verdict.tsv
	render --view slice --plane xz -C 0,0.1mm,-12mm --color Density --range 1500:3000 --extent 45mm --size 1200x500 --panels 2x1 -o $@ $$(for r in $(runs); do ls $$r/run/snap_*.h5 | tail -1; done)
$(OUT)/depth.png: $(here)crater.gp $(OUT)/verdict.tsv
	gnuplot -c $< '$(STRENGTH)' $(OUT) $@
