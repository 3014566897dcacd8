# SPDX-License-Identifier: GPL-3.0-or-later
# A sphere of aluminium of 6.35 mm hits a block of aluminium 6061 at 7 km/s: depth and width of the crater, for two strengths.
#   make -f pipelines/crater.mk [SIZE=small|medium|large]
# Schaefer et al. (2016), section 4.3 (its radius of 6.35 mm is the diameter, its strength of 100 MPa that of soft aluminium); equation of
# Cour-Palais and Christiansen for the depth: 12.8 mm in 6061-T6, 18.3 mm in 1100-O. At these sizes the depth hangs on resolution and viscosity.

# spacing of the particles [mm], size of the block (width and depth in mm; a quarter of it is calculated), end, time between snapshots [microseconds]
DX = $(call by_size,1.25,1,0.63)
BLOCK = $(call by_size,60 40,100 100,100 100)
END = $(call by_size,25,30,30)
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
wide = $(firstword $(BLOCK))
deep = $(lastword $(BLOCK))

# The sphere: cells of a grid about its centre, as many as have their middles within, and their spacing such that they have its volume.
cells = $$(awk 'BEGIN { r = 3.175/$(DX); c = int(r + 0.5); for (x = 0.5; x < c; x++) for (y = 0.5; y < c; y++) for (z = 0.5; z < c; z++) \
  n += 8*(x*x + y*y + z*z < r*r); s = 3.175*(4.18879020479/n)^(1/3); printf "edge=%.9gmm spacing=%.9gmm reach=%.9gmm", 2*c*s, s, r*s }')
quarter = boundary.x=mirror_low boundary.y=mirror_low
$(call from,$(runs:%=%/start.h5),$(DX) $(BLOCK))
$(runs:%=%/start.h5): $(OUT)/Y%/start.h5: | $(programs)
	@mkdir -p $(@D)
	sed -e 's/^name = .*/name = "aluminium_$*";/' -e 's/ Y = "276 MPa"/ Y = "$* MPa"/' $(aluminium) > $(@D)/aluminium_$*.cfg
	export $(cells); \
	mkshape --shape box --size $$edge,$$edge,$$edge --spacing $$spacing --lattice grid -l $(@D)/aluminium_$*.cfg | \
	  alter -s "Coordinates.z=Coordinates.z + $$edge/2" -k "|Coordinates| < $$reach" -o $(@D)/sphere.h5
	mkshape --shape box --size $(wide)mm,$(wide)mm,$(deep)mm --spacing $(DX)mm --lattice grid -l $(@D)/aluminium_$*.cfg | \
	  alter -j $(@D)/sphere.h5 -s 'Coordinates.z=Coordinates.z + if(BodyID == 1, 3.175mm + 0.5*$(DX)mm, 0m)' \
	    -s 'Velocities.z=if(BodyID == 1, -7km/s, 0m/s)' -k 'Coordinates.x > 0' -o $(@D)/half.h5
	alter -k 'Coordinates.y > 0' $(@D)/half.h5 -o $@
	$(remember)
$(call from,$(runs:%=%/shape.tsv),--end $(END)e-6 --every $(EVERY)e-6 $(call sets,gravity.method=none $(quarter) $(SET)))
$(runs:%=%/shape.tsv): %/shape.tsv: %/start.h5
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do columns -f Coordinates.x -f Coordinates.y -f Coordinates.z -w 'BodyID == 0 && Density > 2000kg/m^3' $$s | \
	  awk -v dx=$(DX)e-3 -v every=$(EVERY) -v sheet=$$s -f $(here)crater_shape.awk; done > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)crater.awk $(runs:%=%/shape.tsv)
	$(call judge,crater.awk) -v dx=$(DX) $(runs:%=%/shape.tsv) $(firstword $(runs))/run/conserved.tsv > $@
# The quarter and its image across x.
$(OUT)/crater.png: $(OUT)/verdict.tsv
	for r in $(runs); do last=$$(ls $$r/run/snap_*.h5 | tail -1); \
	  alter -j $$last $$last -s 'Coordinates.x=Coordinates.x*if(BodyID > 1, -1, 1)' -o $$r/both.h5; done
	render --view slice --plane xz -C 0,0.1mm,-12mm --color Density --range 1500:3000 --extent 45mm --size 1200x500 --panels 2x1 -o $@ $(runs:%=%/both.h5)
$(OUT)/depth.png: $(here)crater.gp $(OUT)/verdict.tsv
	gnuplot -c $< '$(STRENGTH)' $(OUT) $@
