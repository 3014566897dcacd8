# SPDX-License-Identifier: GPL-3.0-or-later
# Hugoniot curves of basalt and aluminium: of the equation of state itself, and of plates of aluminium that collide in the solver (1D).
#   make -f pipelines/hugoniot.mk [SIZE=small|medium|large]
# References: roots of the Rankine-Hugoniot equations, tests/data/hugoniot.tsv; Al 6061: Us = 5350 m/s + 1.34 up (Marsh 1980).

# particles of each plate; speeds of the matter behind the shock [m/s]: the plates close with twice that
N = $(call by_size,400,2000,10000)
SPEEDS = 500 2000 3500
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/hugoniot.png
reference = $(firstword $(wildcard $(here)../tests/data/hugoniot.tsv $(here)data/hugoniot.tsv))

$(OUT)/eos.tsv: $(reference) | $(programs)
	@mkdir -p $(@D)
	for m in basalt aluminium; do \
	  eos --material $$m --hugoniot "$$(awk -F'\t' -v m=$$m '$$1 == m { printf s $$2; s = "," }' $<)" | awk -v m=$$m -v OFS='\t' '!/^#/ { print m, $$5, $$6, $$3/1e9, $$1 }'; \
	done > $@

runs = $(SPEEDS:%=$(OUT)/up%)
$(call from,$(runs:%=%/start.h5),$(N))
$(runs:%=%/start.h5): $(OUT)/up%/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape -d 1 --shape rod --size 2m --spacing $$(awk 'BEGIN { printf "%.9g", 1/$(vars) }')m --lattice grid -l aluminium | \
	  alter -s 'Velocities.x=if(Coordinates.x < 0m, $*m/s, -$*m/s)' -s 'BodyID=Coordinates.x > 0m' > $@
	$(remember)
# Until the shocks are half way through.
$(call from,$(runs:%=%/end.tsv),$(call sets,gravity.method=none strength.on=false $(SET)))
$(runs:%=%/end.tsv): $(OUT)/up%/end.tsv: $(OUT)/up%/start.h5
	@rm -rf $(@D)/run
	t=$$(awk 'BEGIN { printf "%.6g", 0.5/(5413 + 0.358*$*) }'); solver -o $(@D)/run --end $$t --every $$t $(vars) $<
	columns -f Coordinates.x -f Pressure -f Velocities.x $(@D)/run/snap_0001.h5 > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)hugoniot.awk $(reference) $(OUT)/eos.tsv $(runs:%=%/end.tsv)
	$(call judge,hugoniot.awk) -v n=$(N) -v points=$(OUT)/points.tsv $(filter %.tsv,$^) > $@
$(OUT)/hugoniot.png: $(here)hugoniot.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(reference) $(OUT)/points.tsv $(lastword $(runs))/end.tsv $@
