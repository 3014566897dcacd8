# SPDX-License-Identifier: GPL-3.0-or-later
# A square of four times the density in pressure equilibrium, 2D, periodic: nothing should happen. SPH's surface tension rounds its corners.
#   make -f pipelines/square.mk [SIZE=small|medium|large]
# Saitoh & Makino (2013), ApJ 768, 44: density 4 in |x|, |y| < 1/4 of a box of edge 1, else 1, pressure 2.5, at rest, gamma 5/3.

# particles along an edge, all at equal distances
N = $(call by_size,32,64,256)
# all of these are run: weights of the pressure, or the density as number
FORMS = squares product miscible
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/square.png

runs = $(FORMS:%=$(OUT)/%)
form.squares = pressure_form=squares
form.product = pressure_form=product
form.miscible = density=miscible
inside = (abs(Coordinates.x) < 0.25m)*(abs(Coordinates.y) < 0.25m)
$(call from,$(OUT)/start.h5,$(N))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape box --size 1m,1m --spacing $$(awk 'BEGIN { printf "%.12g", 1/$(vars) }')m --neighbours 28 --lattice grid -l gas:rho=1 | \
	  alter -s 'Coordinates.y=Coordinates.y + 0.5m' -s 'BodyID=$(inside)' -s 'Density=Density*(1 + 3*BodyID)' -s 'Masses=Masses*(1 + 3*BodyID)' \
	    -s 'InternalEnergy=1.5J/kg*2.5/(1 + 3*BodyID)' > $@
	$(remember)
$(foreach f,$(FORMS),$(call from,$(OUT)/$f/end.tsv,--end 4 --every 1 $(call sets,$(form.$f) gravity.method=none precision=double boundary.x=periodic boundary.y=periodic \
  boundary.low=-0.5$(,)-0.5$(,)0 boundary.high=0.5$(,)0.5$(,)0 $(SET))))
$(runs:%=%/end.tsv): $(OUT)/start.h5
	$(call run,$(@D)/run)
	columns -f Coordinates.x -f Coordinates.y -f BodyID -f Pressure -f Masses -f Density $(@D)/run/snap_0004.h5 > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)square.awk $(runs:%=%/end.tsv)
	$(call judge,square.awk) -v n=$(N) $(foreach r,$(vars),$r/end.tsv $r/run/conserved.tsv) > $@
	$(remember)
$(OUT)/square.png: $(OUT)/verdict.tsv
	render -v slice -c Density -r 0.8:4.2 -e 1m -P $(words $(runs))x1 -s 1440x480 -o $@ $(runs:%=%/run/snap_0004.h5)
