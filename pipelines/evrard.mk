# SPDX-License-Identifier: GPL-3.0-or-later
# Evrard's collapse: a cold gas sphere of density 1/(2 pi r) falls onto itself, bounces, and a shock runs out. Gravity and gas at once.
#   make -f pipelines/evrard.mk [SIZE=small|medium|large]
# Evrard (1988), MNRAS 235, 911: M = R = G = 1, u = 0.05, gamma 5/3. References: 1-D Lagrangian calculations (tests/test_evrard.c).

# particles
N = $(call by_size,9000,100000,1000000)
# length of the softening of all particles: as the mean distance of particles, from 0.02 with 9000. With the varying h of each pair
# the energy drifts by 1.2 %, as the potential then changes with h.
EPSILON = $(call by_size,0.02,0.009,0.0042)
# of h over the signal velocity: the energy drifts with the steps, by 6.9e-4 with 0.4 and 1.1e-4 with 0.2 (9000 particles)
CFL = 0.2
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/evrard.png
reference = $(firstword $(wildcard $(here)../tests/data/evrard.tsv $(here)data/evrard.tsv))

# A uniform sphere stretched radially: r to r^(3/2) makes 1/r of equal masses; h is that of 57 neighbours at its density.
$(call from,$(OUT)/start.h5,$(N))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --size 1m,1m,1m -n $(vars) -l gas:rho=0.238732414637843 -u 0.05 | \
	  alter -s 'Radius=max(|Coordinates|, 1e-6m)' $(foreach c,x y z,-s 'Coordinates.$c=Coordinates.$c*sqrt(Radius/1m)') \
	    -s 'Density=1kg/m^3/(2*3.14159265358979*max((Radius/1m)^1.5, 0.01))' -s 'SmoothingLength=cbrt(57*3/(4*3.14159265358979)*Masses/Density)' > $@
	$(remember)
$(call from,$(OUT)/energies.tsv,--end 1.5 --every 0.8 $(call sets,gravity.G=1 gravity.epsilon=$(EPSILON) step.cfl=$(CFL) density=sum output.log_every=1 $(SET)))
$(OUT)/energies.tsv: $(OUT)/start.h5
	$(call run,$(OUT)/run)
	cp $(OUT)/run/conserved.tsv $@
	$(remember)
$(OUT)/profile.tsv: $(OUT)/energies.tsv
	columns -f '|Coordinates|' -f Density -f Pressure -f '(Coordinates.x*Velocities.x+Coordinates.y*Velocities.y+Coordinates.z*Velocities.z)/max(|Coordinates|, 1e-9m)' \
	  $(OUT)/run/snap_0001.h5 > $@

$(OUT)/verdict.tsv: $(here)evrard.awk $(reference) $(OUT)/profile.tsv $(OUT)/energies.tsv
	$(call judge,evrard.awk) -v n=$(N) $(reference) $(OUT)/profile.tsv $(OUT)/energies.tsv > $@
$(OUT)/evrard.png: $(here)evrard.gp $(OUT)/energies.tsv $(OUT)/profile.tsv $(reference)
	gnuplot -c $^ $@
