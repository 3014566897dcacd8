# SPDX-License-Identifier: GPL-3.0-or-later
# Sedov's blast wave in 3D: energy 1 at a point in gas of density 1; radius of the front, peak, isotropy, conservation.
#   make -f pipelines/sedov.mk [SIZE=small|medium|large]
# Sedov (1959), Similarity and Dimensional Methods in Mechanics: E t^2/(rho R^5) = 0.49358 for gamma 5/3, so R = 0.34747 at t = 0.05.

# particles along an edge of the box of edge 1
N = $(call by_size,32,50,128)
# by continuity, hot particles of the cavity keep their density once they have no neighbours left, and their energy with it
FORM = density=sum smoothing.mode=neighbours
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/sedov.png

# The energy is a Gaussian as wide as the spacing; the rest has p = 1e-6.
$(call from,$(OUT)/start.h5,$(N))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --shape box --size 1m,1m,1m --spacing $$(awk 'BEGIN { print 1/$(N) }')m --lattice grid -l gas:rho=1 -u 1.5e-6 | \
	  alter -s 'Coordinates.z=Coordinates.z + 0.5' \
	    -s 'InternalEnergy=InternalEnergy + $(N)^3/(2*3.14159265359)^1.5*exp(-($(N)*|Coordinates|/1m)^2/2)*1J/kg' > $@
	$(remember)
$(call from,$(OUT)/end.tsv,--end 0.05 --every 0.05 $(call sets,gravity.method=none kernel=cubic_spline step.cfl=0.3 $(FORM) $(SET)))
$(OUT)/end.tsv: $(OUT)/start.h5
	$(call run,$(OUT)/run)
	columns -f '|Coordinates|' -f Density -f '(Coordinates.x*Velocities.x+Coordinates.y*Velocities.y+Coordinates.z*Velocities.z)/|Coordinates|' \
	  -f Pressure -f Masses -f '(Coordinates.x > 0) + 2*(Coordinates.y > 0) + 4*(Coordinates.z > 0)' $(OUT)/run/snap_0001.h5 > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)sedov.awk $(OUT)/end.tsv
	$(call judge,sedov.awk) -v n=$(N) -v bins=$(OUT)/bins.tsv $(OUT)/end.tsv $(OUT)/run/conserved.tsv > $@
$(OUT)/sedov.png: $(here)sedov.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/end.tsv $(OUT)/bins.tsv $@
