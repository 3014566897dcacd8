# SPDX-License-Identifier: GPL-3.0-or-later
# The collapse of a rotating cold cloud with a disturbance of two arms: its density against time, and two condensations in the end.
#   make -f pipelines/cloud.mk [SIZE=small|medium|large]
# Boss & Bodenheimer (1979), ApJ 234, 289, as in Schaefer et al. (2016), section 4.2: one solar mass in 3.2e14 m, 10 K, Omega 1.6e-12/s,
# density 1 + 0.5 cos(2 phi). Gravity is softened with each pair's h, as in the paper, and with Plummer's lengths of Bate & Burkert (1997),
# MNRAS 288, 1060. h ends at 1e-9 kg/m^3 (smoothing.min), where the gas no longer is isothermal.
# Times in free-fall times of M and R, 5.519e11 s (the paper's 5.529e11 fits neither M and R nor its density).

# particles
N = $(call by_size,8200,137000,2000000)
# lengths of Plummer's softening over R that are compared with h
LENGTHS = 0.05 0.10
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/cloud.png $(OUT)/midplane.png

# Azimuths phi of a uniform ball go to f with f + 0.25 sin 2f = phi: equal masses, the density follows.
turn = -s 'f=atan2(Coordinates.y, Coordinates.x)' -s 'phi=f' $(foreach k,1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16,-s 'f=phi - 0.25*sin(2*f)')
$(call from,$(OUT)/start.h5,$(N))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --size 3.2e14,3.2e14,3.2e14 -n $(vars) --neighbours 50 -l cold_hydrogen:rho=1.4487e-14 --rotate 1 | \
	  alter $(turn) -s 'd=hypot(Coordinates.x, Coordinates.y)' -s 'Coordinates.x=d*cos(f)' -s 'Coordinates.y=d*sin(f)' \
	    -s 'Velocities.x=-1.6e-12*Coordinates.y/1s' -s 'Velocities.y=1.6e-12*Coordinates.x/1s' > $@
	$(remember)
settings = $(call sets,gravity.theta=0.5 density=sum smoothing.mode=neighbours smoothing.neighbours=50 smoothing.min=0.02 kernel=cubic_spline $1 $(SET))
output = --end 6.6228e11 --every 2.7595e10
$(call from,$(OUT)/density.tsv,$(output) $(call settings))
$(foreach l,$(LENGTHS),$(call from,$(OUT)/density_$l.tsv,$(output) $(call settings,gravity.softening=plummer gravity.epsilon=$(shell echo $l | awk '{ print $$1*3.2e14 }'))))
# The largest densities of the run in folder $1.
define densest
$(call run,$1)
printf '# t/t_ff\tlargest density[kg/m^3]\n' > $@
k=0; for s in $1/snap_*.h5; do info -s fields $$s | awk -F'\t' -v t=$$k '$$1 == "Density" { print t*0.05 "\t" $$7 }'; k=$$((k + 1)); done >> $@
$(remember)
endef
$(OUT)/density.tsv: $(OUT)/start.h5
	$(call densest,$(OUT)/run)
softer = $(LENGTHS:%=$(OUT)/density_%.tsv)
$(softer): $(OUT)/density_%.tsv: $(OUT)/start.h5
	$(call densest,$(OUT)/run_$*)
$(OUT)/arms.tsv: $(OUT)/density.tsv
	columns -f Coordinates.x -f Coordinates.y -f Density -w 'Density > 1e-13kg/m^3' $$(ls $(OUT)/run/snap_*.h5 | tail -1) > $@

$(OUT)/verdict.tsv: $(here)cloud.awk $(OUT)/density.tsv $(OUT)/arms.tsv $(softer)
	$(call judge,cloud.awk) -v n=$(N) $(OUT)/density.tsv $(softer) $(OUT)/arms.tsv $(OUT)/run/conserved.tsv > $@
$(OUT)/cloud.png: $(here)cloud.gp $(OUT)/density.tsv $(softer)
	gnuplot -c $< $@ $(filter %.tsv,$^)
$(OUT)/midplane.png: $(OUT)/density.tsv
	render --view slice --color Density --log --extent 4e14 --size 1200x600 --panels 2x1 -o $@ $(OUT)/run/snap_0020.h5 $(OUT)/run/snap_0024.h5
