# SPDX-License-Identifier: GPL-3.0-or-later
# Porous basalt is crushed by a piston, and let go: distention against the crush curve of the P-alpha model, on the way in and out.
#   make -f pipelines/crush.mk [SIZE=small|medium|large]
# Carroll & Holt (1972), J. Appl. Phys. 43, 1626: alpha = 1 + (alpha_0 - 1) ((p_s - p)/(p_s - p_e))^2 between p_e and p_s.

# particles of the rod, of 1 m
N = $(call by_size,50,200,1000)
# speed of the piston [m/s]: far below that of sound, for waves to even out, and as a shock
SPEEDS = 20 200
# how far it goes in: pores are gone after a quarter
IN = 0.17
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/crush.png
runs = $(SPEEDS:%=$(OUT)/v%)

$(OUT)/porous.cfg: $(firstword $(wildcard $(here)../materials/basalt.cfg $(here)../../materials/basalt.cfg))
	@mkdir -p $(@D)
	{ sed -e 's/^name = .*/name = "porous";/' $<; echo 'porosity = { form = "p_alpha"; alpha_0 = 1.25; p_e = "2e8 Pa"; p_s = "2e9 Pa"; };'; } > $@
# Body 1 is the piston, body 2 the end; eight particles each.
$(call from,$(runs:%=%/start.h5),$(N) $(IN))
$(runs:%=%/start.h5): $(OUT)/v%/start.h5: $(OUT)/porous.cfg | $(programs)
	@mkdir -p $(@D)
	mkshape -d 1 --shape rod --size 1m --spacing $$(awk 'BEGIN { printf "%.9g", 1/$(N) }')m --lattice grid -l $<:pores=0.2 | \
	  alter -s 'BodyID=if(Coordinates.x < -0.5m + 8m/$(N), 1, if(Coordinates.x > 0.5m - 8m/$(N), 2, 0))' -s 'Velocities.x=if(BodyID == 1, $*, 0)*1m/s' -o $@
	$(remember)
# In by IN of what is between piston and end, 30 snapshots; then the piston goes back by a fifth of that at the same speed.
way = $$(awk 'BEGIN { printf "%.9g", $1*$(IN)*(1 - 16/$(N))/$* }')
settings = $(call sets,gravity.method=none strength.on=false $(SET))
of = columns -d 12 -f Pressure -f PeakPressure -f Distention -f Density -f ParticleIDs -w 'BodyID == 0'
$(call from,$(runs:%=%/in.tsv),$(settings))
$(runs:%=%/in.tsv): $(OUT)/v%/in.tsv: $(OUT)/v%/start.h5
	@rm -rf $(@D)/in $(@D)/out
	t=$(call way,1); e=$(call way,1/30); \
	solver -o $(@D)/in --end $$t --every $$e $(vars) --set walls.body1=$*,0,0 --set walls.body2=held $<
	for s in $(@D)/in/snap_*.h5; do $(of) $$s; done > $@
	$(remember)
$(runs:%=%/back.h5): %/back.h5: %/in.tsv
	alter -s 'Velocities.x=if(BodyID == 1, -1, 1)*Velocities.x' -t 0s -o $@ $*/in/snap_0030.h5
$(call from,$(runs:%=%/out.tsv),$(settings))
$(runs:%=%/out.tsv): $(OUT)/v%/out.tsv: $(OUT)/v%/back.h5
	t=$(call way,1/5); e=$(call way,1/50); \
	solver -o $(@D)/out --end $$t --every $$e $(vars) --set walls.body1=-$*,0,0 --set walls.body2=held $<
	for s in $(@D)/out/snap_*.h5; do $(of) $$s; done > $@
	$(remember)

tables = $(foreach r,$(runs),$r/in.tsv $r/out.tsv)
$(OUT)/verdict.tsv: $(here)crush.awk $(tables)
	$(call judge,crush.awk) -v n=$(N) $(tables) > $@
$(OUT)/crush.png: $(here)crush.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(tables) $@
