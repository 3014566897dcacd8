# SPDX-License-Identifier: GPL-3.0-or-later
# All experiments that judge themselves (those that include lab.mk), at one size; then OUT/validation.html: what each claims, what came
# out, pictures, time. Exit 1 when a claim does not hold.
#   make -f pipelines/validate.mk [SIZE=small|medium|large] [ONLY='sod sedov']

SIZE = small
ONLY =
OUT = out/validate/$(SIZE)

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)common.mk
experiments := $(or $(ONLY),$(patsubst $(here)%.mk,%,$(shell grep -l '^include .*lab[.]mk$$' $(here)*.mk)))
unknown := $(filter-out $(patsubst $(here)%.mk,%,$(wildcard $(here)*.mk)),$(experiments))
$(if $(unknown),$(error no experiment '$(unknown)': there are $(patsubst $(here)%.mk,%,$(wildcard $(here)*.mk))))
done := $(experiments:%=$(OUT)/%/done)

all: $(OUT)/validation.html
	@cat $(done) | awk -F'\t' '{ ok += $$2 == "ok"; n++ } END { print ok " passed, " n - ok " failed"; exit ok < n }'

# `done`: name, ok or FAILED, wall time of the last time that anything was made, claims that hold, claims that do not.
$(done): $(OUT)/%/done: FORCE | $(programs)
	@mkdir -p $(@D); \
	if $(MAKE) -q -f $(here)$*.mk SIZE=$(SIZE) OUT=$(@D) $(@D)/verdict.tsv 2> /dev/null && [ -f $@ ]; \
	then time=$$(cut -f 3 $@); fi; \
	start=$$(date +%s%N); status=ok; \
	$(MAKE) -s -f $(here)$*.mk SIZE=$(SIZE) OUT=$(@D) > $(@D)/log 2>&1 || status=FAILED; \
	time=$${time:-$$(awk "BEGIN { printf \"%.1f\", ($$(date +%s%N) - $$start)/1e9 }")}; \
	touch $(@D)/verdict.tsv; \
	awk -F'\t' -v name=$* -v status=$$status -v time=$$time '{ ok += $$5 == "ok"; bad += $$5 == "FAILED" } \
	  END { printf "%s\t%s\t%s\t%d\t%d\n", name, ok ? status : "FAILED", time, ok, bad }' $(@D)/verdict.tsv > $@; \
	[ -s $(@D)/verdict.tsv ] || rm $(@D)/verdict.tsv; \
	awk -F'\t' '{ printf "%-6s %-16s %8.1f s  %2d of %2d claims hold\n", $$2, $$1, $$3, $$4, $$4 + $$5 }' $@; \
	[ $$status = ok ] || { grep -E '^FAILED|[Ee]rror' $(@D)/log || tail -5 $(@D)/log; } | sed 's/^/       /'

$(OUT)/validation.html: $(here)validation $(done)
	@bash $< $(OUT) '$(SIZE)' $(experiments) > $@

.PHONY: all
