# SPDX-License-Identifier: GPL-3.0-or-later
# Sod's shock tube in 1D, against the exact solution of the Riemann problem: shock, contact and fan, and the order of convergence.
#   make -f pipelines/sod.mk [SIZE=small|medium|large]
# Sod (1978), J. Comp. Phys. 27, 1: (rho, p) = (1, 1) left and (0.125, 0.1) right of 0, gamma 1.4, at t = 0.2.

# particles on the left, per unit of length; all of these are run
N = $(call up_to,400 800 2000,4000,8000)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/sod.png $(OUT)/convergence.png

runs = $(N:%=$(OUT)/n%)

# Equal masses: the spacing is eight times as wide on the right; h is 4 of them.
rod = mkshape -d 1 --shape rod --size 1m --spacing $$(awk 'BEGIN { print $2/$1 }')m --neighbours 8 --lattice grid
$(runs:%=%/start.h5): $(OUT)/n%/start.h5: | $(programs)
	@mkdir -p $(@D)
	$(call rod,$*,8) -l air:rho=0.125 -u 2 -o $(@D)/right.h5
	$(call rod,$*,1) -l air:rho=1 -u 2.5 | \
	  alter -j $(@D)/right.h5 -s 'Coordinates.x=Coordinates.x + if(BodyID == 0, -0.5, 0.5)' > $@
$(call from,$(runs:%=%/end.tsv),--end 0.2 --every 0.2 $(call sets,gravity.method=none density=sum kernel=cubic_spline $(SET)))
$(runs:%=%/end.tsv): %/end.tsv: %/start.h5
	$(call run,$*/run)
	columns -f Coordinates.x -f Density -f Velocities.x -f Pressure -f InternalEnergy -f Masses $*/run/snap_0001.h5 > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)sod.awk $(runs:%=%/end.tsv)
	$(call judge,sod.awk) -v errors=$(OUT)/errors.tsv $(vars:%=%/end.tsv) > $@
	$(remember)
$(OUT)/sod.png: $(here)sod.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(lastword $(runs))/end.tsv $@
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative L1 error' 'spacing on the left' $@
