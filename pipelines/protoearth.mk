# SPDX-License-Identifier: GPL-3.0-or-later
# A proto-Earth of iron and granite at rest, with the density by continuity, summed over neighbours (standard SPH) and over their
# number (miscible): whether it is at rest, and what each makes of the pressure at the core-mantle boundary, after Reufer (2011),
# section 2.1.11 and figure 2.1. The bodies are those of the library (recipes.mk).
#   make -f pipelines/protoearth.mk [SIZE=small|medium|large]        bodies, relaxation, figure, report, checks
#   make -f pipelines/protoearth.mk N=50000
#   make -f pipelines/protoearth.mk recipe.protoearth='mksphere -m 6e24kg -l iron:0.25 -l granite --hydrostatic'
# The figure is OUT/N5000-s1/protoearth.png, the numbers are in report.txt beside it; OUT/verdict.tsv has those of the last size.

# particles
N = $(call by_size,5000,50000,100000)
# of the lattice's orientation
SEED = 1
# where everything goes
OUT = out/protoearth

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
include $(here)recipes.mk
to := $(OUT)/N$(N)-s$(SEED)
planet := protoearth-n$(N)-s$(SEED)
forms := $(planet) $(planet)-sum $(planet)-miscible
tables := $(to)/standard.tsv $(to)/miscible.tsv
$(call library,$(forms))

figure := $(if $(shell command -v gnuplot),$(to)/protoearth.png)
pictures = $(OUT)/protoearth.png
all: $(to)/checked $(to)/report.html

# Material, radius, pressure, density, support of each particle.
$(to)/standard.tsv: $(call body,$(planet)-sum)
$(to)/miscible.tsv: $(call body,$(planet)-miscible)
numbers = { h5dump -d /PartType0/$1 -y -w 1 -m %.9g -o /dev/fd/3 $< > /dev/null; } 3>&1 | tr -d ' ,' | grep .
$(tables):
	@mkdir -p $(@D)
	@{ printf '# mat\tr[m]\tp[Pa]\trho[kg/m^3]\th[m]\n'; \
	paste <($(call numbers,MaterialID)) <($(call numbers,Coordinates) | paste - - -) <($(call numbers,Pressure)) \
	  <($(call numbers,Density)) <($(call numbers,SmoothingLength)) | \
	  awk -v OFS='\t' '{ print $$1, sqrt($$2^2 + $$3^2 + $$4^2), $$5, $$6, $$7 }'; } > $@

profile := $(LIBRARY)/$(planet).profile.tsv
$(to)/protoearth.png: $(call body,$(planet)) $(tables)
	gnuplot -c $(here)protoearth.gp $(profile) $(tables) $@

# What was reached, and what must hold. `checked` is there when it holds.
$(to)/report.txt: $(here)protoearth.awk $(here)bodies.awk $(tables) $(call body,$(planet))
	@{ awk -f $< $(profile) $(tables) && awk -f $(here)bodies.awk $(call reports,$(planet)) && \
	  awk -v judge=no -f $(here)bodies.awk $(call reports,$(planet)-sum $(planet)-miscible) || true; } > $@
$(to)/checked: $(to)/report.txt
	@rm -f $@
	@cat $<
	@! grep -q 'FAILED' $<
	@touch $@

# The claims; those of another size make them again.
$(call from,$(OUT)/verdict.tsv,$(N) $(SEED))
$(OUT)/verdict.tsv: $(here)protoearth_verdict.awk $(tables) $(call body,$(planet))
	$(call judge,protoearth_verdict.awk) -v n=$(N) $(profile) $(tables) $(call reports,$(planet)) > $@
	$(remember)
$(OUT)/protoearth.png: $(figure) $(OUT)/verdict.tsv
	cp $< $@

# One page with all of it.
$(to)/report.html: $(to)/report.txt $(figure) $(call body,$(planet)-miscible)
	@report -g -o $@ -t 'A proto-Earth of $(N) particles' -x $<:'What was reached' \
	  $(figure:%=-p %:'Pressure and density, standard and miscible SPH beside the structure in one dimension.') $(lastword $^)
