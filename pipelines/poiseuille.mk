# SPDX-License-Identifier: GPL-3.0-or-later
# Plane Poiseuille flow, 2D: a force along a channel sets a viscous fluid in motion between two walls, until it flows steadily.
#   make -f pipelines/poiseuille.mk [SIZE=small|medium|large]
# Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214: the series solution of the start. L = 1 m, nu = 0.5 m^2/s, v0 = F L^2/(8 nu) = 0.5 m/s.

# particles across the channel; all of these are run
N = $(call up_to,10 20 40,80,160)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/poiseuille.png $(OUT)/convergence.png

runs = $(N:%=$(OUT)/n%)
# Time goes in L^2/nu, which is 2 s. Twelve particles along the channel, which is periodic; y = 0 is its middle.
$(runs:%=%/start.h5): $(OUT)/n%/start.h5: | $(programs)
	@mkdir -p $(@D)
	dx=$$(awk 'BEGIN { printf "%.12g", 1/$* }'); mkshape -d 2 --shape box --size $$(awk 'BEGIN { printf "%.12g", 12/$* }')m,1m --spacing $${dx}m \
	  --neighbours 60 --lattice grid -l slow_water:rho=1000.2 | alter -s 'Coordinates.y=Coordinates.y + 0.5m' > $@
$(call from,$(runs:%=%/end.tsv),--end 1 --every 0.1 $(call sets,gravity.method=none kernel=wendland_c4 smoothing.mode=fixed viscosity.alpha=0.05 viscosity.beta=0 \
  viscosity.kinematic=0.5 force.x=2 boundary.x=periodic boundary.y=no_slip $(SET)))
$(runs:%=%/end.tsv): $(OUT)/n%/end.tsv: $(OUT)/n%/start.h5
	@rm -rf $(@D)/run
	half=$$(awk 'BEGIN { printf "%.12g", 6/$* }'); solver -o $(@D)/run $(vars) --set boundary.low=-$$half,-0.5,0 --set boundary.high=$$half,0.5,0 $<
	for k in 01 02 04 10; do columns -f $$k/20 -f $* -f Coordinates.y -f Velocities.x -f Velocities.y $(@D)/run/snap_00$$k.h5; done > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)poiseuille.awk $(runs:%=%/end.tsv)
	$(call judge,poiseuille.awk) -v errors=$(OUT)/errors.tsv $(vars:%=%/end.tsv) > $@
	$(remember)
$(OUT)/poiseuille.png: $(here)poiseuille.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(lastword $(runs))/end.tsv $@
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative L2 error of the velocity' 'spacing [m]' $@
