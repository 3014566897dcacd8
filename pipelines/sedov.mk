# SPDX-License-Identifier: GPL-3.0-or-later
# Sedov's blast wave in 3D: energy 1 at a point in gas of density 1; radius of the front, peak, isotropy, conservation; order.
#   make -f pipelines/sedov.mk [SIZE=small|medium|large]
# Sedov (1959), Similarity and Dimensional Methods in Mechanics: E t^2/(rho R^5) = 0.49358 for gamma 5/3, so R = 0.34747 at t = 0.05.

# particles along an edge of the box of edge 1; all of these are run, the last is judged
N = $(call up_to,16 24 32,50,128)
# by continuity, hot particles of the cavity keep their density once they have no neighbours left, and their energy with it
FORM = density=sum smoothing.mode=neighbours
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/sedov.png $(OUT)/convergence.png

runs = $(N:%=$(OUT)/n%)
finest = $(lastword $(runs))

# The energy is a Gaussian as wide as the spacing; the rest has p = 1e-6.
$(runs:%=%/start.h5): $(OUT)/n%/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --shape box --size 1m,1m,1m --spacing $$(awk 'BEGIN { print 1/$* }')m --lattice grid -l gas:rho=1 -u 1.5e-6 | \
	  alter -s 'Coordinates.z=Coordinates.z + 0.5' \
	    -s 'InternalEnergy=InternalEnergy + $*^3/(2*3.14159265359)^1.5*exp(-($**|Coordinates|/1m)^2/2)*1J/kg' > $@
$(call from,$(runs:%=%/end.tsv),--end 0.05 --every 0.05 $(call sets,gravity.method=none kernel=cubic_spline step.cfl=0.3 $(FORM) $(SET)))
$(runs:%=%/end.tsv): %/end.tsv: %/start.h5
	$(call run,$*/run)
	columns -f '|Coordinates|' -f Density -f '(Coordinates.x*Velocities.x+Coordinates.y*Velocities.y+Coordinates.z*Velocities.z)/|Coordinates|' \
	  -f Pressure -f Masses -f '(Coordinates.x > 0) + 2*(Coordinates.y > 0) + 4*(Coordinates.z > 0)' $*/run/snap_0001.h5 > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)sedov.awk $(runs:%=%/end.tsv)
	$(call judge,sedov.awk) -v n=$(lastword $(N)) -v bins=$(OUT)/bins.tsv -v errors=$(OUT)/errors.tsv $(vars:%=%/end.tsv) $(finest)/run/conserved.tsv > $@
	$(remember)
$(OUT)/sedov.png: $(here)sedov.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(finest)/end.tsv $(OUT)/bins.tsv $@
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative L1 error of the density' spacing $@
