# SPDX-License-Identifier: GPL-3.0-or-later
# A proto-Earth of iron and granite at rest, with the density summed over neighbours (standard SPH) and over their number (miscible):
# what each makes of the pressure at the core-mantle boundary, after Reufer (2011), section 2.1.11 and figure 2.1.
#   make -f pipelines/protoearth.mk             bodies, relaxation, figure, report
#   make -f pipelines/protoearth.mk N=20000
# The figure is OUT/protoearth.png, the numbers are in OUT/report.txt.

# particles
N = $(if $(gpu),100000,3000)
# mass, and its share of iron
MASS = 5.375e24kg
CORE = 0.3
# further settings of the solver, KEY=VALUE
SET =
# where everything goes
OUT = out/protoearth/N$(N)

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)common.mk
all: $(OUT)/report.txt $(if $(shell command -v gnuplot),$(OUT)/protoearth.png)
	@cat $<

$(call from,$(OUT)/raw.h5,-n $(N) -m $(MASS) -l iron:$(CORE) -l granite)
$(OUT)/raw.h5: | $(programs)
	@mkdir -p $(@D)
	mksphere $(vars) --hydrostatic -o $@
	$(remember)
$(OUT)/profile.tsv: $(OUT)/raw.h5
	relax --profile-only $< > $@
$(call from,$(OUT)/standard.h5,--set density=sum $(patsubst %,--set %,$(SET)))
$(call from,$(OUT)/miscible.h5,--set density=miscible $(patsubst %,--set %,$(SET)))
$(OUT)/standard.h5 $(OUT)/miscible.h5: %.h5: $(OUT)/raw.h5
	relax $(vars) --checkpoint $*.checkpoint -o $@ $< 2> $*.log || { cat $*.log >&2; exit 1; }
	$(remember)

# Material, radius, pressure, density, support of each particle.
numbers = { h5dump -d /PartType0/$1 -y -w 1 -m %.9g -o /dev/fd/3 $< > /dev/null; } 3>&1 | tr -d ' ,' | grep .
$(OUT)/standard.tsv $(OUT)/miscible.tsv: %.tsv: %.h5
	@{ printf '# mat\tr[m]\tp[Pa]\trho[kg/m^3]\th[m]\n'; \
	paste <($(call numbers,MaterialID)) <($(call numbers,Coordinates) | paste - - -) <($(call numbers,Pressure)) \
	  <($(call numbers,Density)) <($(call numbers,SmoothingLength)) | \
	  awk -v OFS='\t' '{ print $$1, sqrt($$2^2 + $$3^2 + $$4^2), $$5, $$6, $$7 }'; } > $@

$(OUT)/protoearth.png: $(OUT)/profile.tsv $(OUT)/standard.tsv $(OUT)/miscible.tsv
	gnuplot -c $(here)protoearth.gp $^ $@
$(OUT)/report.txt: $(here)protoearth.awk $(OUT)/profile.tsv $(OUT)/standard.tsv $(OUT)/miscible.tsv
	@awk -f $< $(filter %.tsv,$^) > $@
	@grep -h 'run' $(OUT)/standard.log $(OUT)/miscible.log | sed 's/^/# /' >> $@

clean:
	rm -rf $(OUT)

.PHONY: all clean
