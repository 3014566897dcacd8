# SPDX-License-Identifier: GPL-3.0-or-later
# A polytrope of index 1: does it stand still, and how fast does it pulsate when it is pulled apart a little.
#   make -f pipelines/polytrope.mk [SIZE=small|medium|large]
# G = M = R = 1. Lane and Emden: density pi/4 sin(pi r)/(pi r); radial wave equation, Gamma = 2: period 3.24254.

# particles; time between snapshots of the pulsation (5 periods)
N = $(call by_size,4000,64000,1000000)
EVERY = $(call by_size,0.162127,0.162127,0.4053175)
# in a support: 100 of this kernel, as Dehnen & Aly (2012) take. In the close packing pressure then acts as it should to 6e-4; with 57 it is 2.4 % too weak
# at any N, so that the radius of the star is 1.2 % and the period 1.8 % too small.
NEIGHBOURS = 100
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/polytrope.png

# On the exact profile; settled under friction; then v = 0.02 r for five periods.
$(OUT)/profile.tsv:
	@mkdir -p $(@D)
	awk -f $(here)verdict.awk -f $(here)polytrope.awk -v profile=1 > $@
$(call from,$(OUT)/placed.h5,-n $(N) --neighbours $(NEIGHBOURS))
$(OUT)/placed.h5: $(OUT)/profile.tsv | $(programs)
	mksphere $(vars) -p $< -o $@
	$(remember)
settings = $(call sets,gravity.G=1 density=sum viscosity.alpha=0.05 viscosity.beta=0 step.cfl=0.3 $(SET))
$(call from,$(OUT)/settled.h5,--end +10 --every 10 --set damping.rate=2 $(settings))
$(OUT)/settled.h5: $(OUT)/placed.h5
	$(call run,$(OUT)/settle)
	cp $(OUT)/settle/snap_0001.h5 $@
	$(remember)
$(OUT)/start.h5: $(OUT)/settled.h5
	alter -t 0s $(foreach c,x y z,-s 'Velocities.$c=0.02*Coordinates.$c/1s') -o $@ $<
$(call from,$(OUT)/pulse.tsv,--end 16.2127 --every $(EVERY) $(settings))
$(OUT)/pulse.tsv: $(OUT)/start.h5
	$(call run,$(OUT)/run)
	for s in $(OUT)/run/snap_*.h5; do columns -f Masses -f '|Coordinates|' $$s | \
	  awk '/^#/ { next } { m += $$1; s += $$1*$$2^2 } END { print sqrt(s/m) }'; done | awk '{ print (NR - 1)*$(EVERY) "\t" $$1 }' > $@
	$(remember)
$(OUT)/settled.tsv: $(OUT)/settled.h5
	columns -f '|Coordinates|' -f Density -f Masses -f Pressure $< > $@

$(OUT)/verdict.tsv: $(here)polytrope.awk $(OUT)/settled.tsv $(OUT)/pulse.tsv
	$(call judge,polytrope.awk) -v n=$(N) $(OUT)/settled.tsv $(OUT)/pulse.tsv $(OUT)/run/conserved.tsv > $@
$(OUT)/polytrope.png: $(here)polytrope.gp $(OUT)/settled.tsv $(OUT)/pulse.tsv
	gnuplot -c $^ $@
