# SPDX-License-Identifier: GPL-3.0-or-later
# What every experiment that judges itself shares: `include $(here)lab.mk` after its variables. It ends with OUT/verdict.tsv, one row a
# claim (verdict.awk), printed, and OUT/report.html, the same with the pictures; `all` fails when a claim does. `make validate` runs
# them all.

include $(here)common.mk

# small: under a minute on two cores; medium; large: a GPU, the numbers of record. $(call by_size,A,B,C) is the one for SIZE,
# $(call up_to,A,B,C) all up to it.
SIZE ?= small
ifeq ($(filter $(SIZE),small medium large),)
$(error SIZE is '$(SIZE)', not small, medium or large)
endif
experiment := $(basename $(notdir $(firstword $(MAKEFILE_LIST))))
OUT ?= out/$(experiment)/$(SIZE)
by_size = $(strip $(if $(filter small,$(SIZE)),$1,$(if $(filter medium,$(SIZE)),$2,$3)))
up_to = $(strip $1 $(if $(filter small,$(SIZE)),,$2) $(if $(filter large,$(SIZE)),$3))
sets = $(patsubst %,--set %,$1)
set = $(patsubst %,--set %,$(SET))

# $(call run,DIR): the solver on the first prerequisite with the settings in vars; a run of the same start and settings is continued.
define run
@made="$$(cksum < $<) $(vars)"; \
[ "$$(cat $1/made 2> /dev/null)" = "$$made" ] || { rm -rf $1; mkdir -p $1; echo "$$made" > $1/made; }
solver --restart -o $1 $(vars) $<
endef

# A table judged: $(call judge,FILE.awk) FILES in a recipe for OUT/verdict.tsv.
judge = awk -f $(here)verdict.awk -f $(here)$1

.SECONDEXPANSION:
drawn = $(if $(shell command -v gnuplot),$(pictures))
all: $(OUT)/verdict.tsv $$(drawn) $(OUT)/report.html
	@awk -f $(here)verdict.awk -v show=1 $<
$(OUT)/report.html: $(OUT)/verdict.tsv $$(drawn)
	@report -o $@ -t '$(experiment), $(SIZE)' -r 100 -T $<:Claims $(patsubst %,-p %,$(filter %.png,$^))

clean:
	rm -rf $(OUT)
.PHONY: all clean
