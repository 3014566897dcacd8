# SPDX-License-Identifier: GPL-3.0-or-later
# Two particles on a Kepler orbit of eccentricity 0.5, ten times around: energy, and the apsis that should not turn.
#   make -f pipelines/kepler.mk [SIZE=small|medium|large]
# Masses 1/2, G = 1, semi-major axis 1, from the apocentre, integrated by rk2-adaptive; the softening ends at a distance of 0.1.

# orbits
N = $(call by_size,10,15,20)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

# Two particles: a second thread only waits.
export OMP_NUM_THREADS = 1
here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/kepler.png

settings = $(call sets,gravity.G=1 gravity.method=direct precision=double integrator=rk2-adaptive step.error=1e-8 smoothing.mode=fixed $(SET))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --shape box --size 3m,1m,1m --spacing 1.5m --lattice grid -l gas:rho=1 -u 1 | \
	  alter -s 'Coordinates.y=0' -s 'Coordinates.z=0' -s 'Masses=0.5' -s 'SmoothingLength=0.1' -s 'Velocities.y=sign(Coordinates.x)/sqrt(12)' > $@
turn = 6.283185307179586
end = $(shell awk 'BEGIN { printf "%.15g", $(N)*$(turn) }')
$(call from,$(OUT)/orbit.tsv,--end $(end) --every $(turn) $(settings))
$(OUT)/orbit.tsv: $(OUT)/start.h5
	$(call run,$(OUT)/run)
	for s in $(OUT)/run/snap_*.h5; do columns -d 17 -w 'Coordinates.x > 0m' -f Coordinates.x -f Coordinates.y -f Velocities.x -f Velocities.y $$s | tail -n +2; done > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)kepler.awk $(OUT)/orbit.tsv
	$(call judge,kepler.awk) -v n=$(N) $(OUT)/orbit.tsv $(OUT)/run/conserved.tsv > $@
$(OUT)/kepler.png: $(here)kepler.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/run/conserved.tsv $(OUT)/orbit.tsv $@
