# SPDX-License-Identifier: GPL-3.0-or-later
# Taylor-Green vortices, 2D, periodic: a viscous flow with an exact solution, whose speeds decay by exp(-2 nu k^2 t). Physical viscosity alone.
#   make -f pipelines/taylorgreen.mk [SIZE=small|medium|large]
# Taylor & Green (1937), Proc. R. Soc. A 158, 499: v = U (sin kx cos ky, -cos kx sin ky), k = 2 pi/L; U = 0.5 m/s, L = 1 m, nu = 0.5 m^2/s.

# particles along an edge; all of these are run
N = $(call up_to,32 64,128,256)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/taylorgreen.png $(OUT)/frames.png $(OUT)/convergence.png

runs = $(N:%=$(OUT)/n%)
x = 2*3.14159265358979*Coordinates.x/1m
y = 2*3.14159265358979*Coordinates.y/1m
# The mean pressure is 500 Pa, so that there is no tension in the vortices; p = rho U^2/4 (cos 2kx + cos 2ky) goes into the density.
$(runs:%=%/start.h5): $(OUT)/n%/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape box --size 1m,1m --spacing $$(awk 'BEGIN { printf "%.12g", 1/$* }')m --neighbours 60 --lattice grid -l slow_water:rho=1000.2 | \
	  alter -s 'Coordinates.y=Coordinates.y + 0.5m' -s 'Velocities.x=0.5m/s*sin($x)*cos($y)' -s 'Velocities.y=-0.5m/s*cos($x)*sin($y)' \
	    -s 'Density=Density*(1 + 0.25*(0.5/50)^2*(cos(2*($x)) + cos(2*($y))))' > $@
$(call from,$(runs:%=%/end.tsv),--end 0.05 --every 0.025 $(call sets,gravity.method=none precision=double kernel=wendland_c4 smoothing.mode=fixed \
  viscosity.alpha=0 viscosity.beta=0 viscosity.kinematic=0.5 boundary.x=periodic boundary.y=periodic \
  boundary.low=-0.5$(,)-0.5$(,)0 boundary.high=0.5$(,)0.5$(,)0 output.log_every=1 $(SET)))
$(runs:%=%/end.tsv): $(OUT)/n%/end.tsv: $(OUT)/n%/start.h5
	$(call run,$(@D)/run)
	columns -f $* -f 'sin($x)*cos($y)' -f '-cos($x)*sin($y)' -f Velocities.x -f Velocities.y $(@D)/run/snap_0002.h5 > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)taylorgreen.awk $(runs:%=%/end.tsv)
	$(call judge,taylorgreen.awk) -v errors=$(OUT)/errors.tsv $(vars:%=%/end.tsv) $(vars:%=%/run/conserved.tsv) > $@
	$(remember)
$(OUT)/taylorgreen.png: $(here)taylorgreen.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(lastword $(runs))/run/conserved.tsv $@
$(OUT)/frames.png: $(OUT)/verdict.tsv
	render -v slice -c '|Velocities|' -c Pressure -e 1m -P 2x1 -s 1100x480 -o $@ \
	  $(lastword $(runs))/run/snap_0002.h5
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative error' 'spacing [m]' $@
