# SPDX-License-Identifier: GPL-3.0-or-later
# What every pipeline begins with: `include $(dir $(lastword $(MAKEFILE_LIST)))common.mk`, after its variables.
# Steps stop at their first error, a failed one leaves no result, what is there is not made again, and a change of the variables
# that a result was made with makes it again (from, changed, remember).

SHELL = bash
.SHELLFLAGS = -e -o pipefail -c
.DEFAULT_GOAL = all
.DELETE_ON_ERROR:
.SECONDARY:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
# Sorting and numbers are the same everywhere.
export LC_ALL = C

# The programs: those of the checkout or prefix that this file lies in, else those on PATH. A checkout without is built first.
root := $(abspath $(dir $(lastword $(MAKEFILE_LIST)))..)
ifneq ($(wildcard $(root)/Makefile),)
BIN ?= $(root)/bin
programs := $(BIN)/solver
build = $(MAKE)
$(BIN)/solver:
	MAKEFLAGS= $(build) -C $(root) -j$(shell nproc)
else
BIN ?= $(abspath $(root)/../../bin)
programs :=
endif
export PATH := $(BIN):$(PATH)

# Not empty where a driver shows a GPU and the solver can use it (one that is to be built: where nvcc is).
nvcc = $(firstword $(shell command -v nvcc) $(wildcard $(CUDA_HOME:%=%/bin/nvcc) /usr/local/cuda/bin/nvcc))
knows = $(if $(wildcard $(BIN)/solver),$(shell $(BIN)/solver --help | grep -o 'auto|cpu|cuda'),$(nvcc))
gpu := $(and $(shell nvidia-smi -L 2>/dev/null | grep '^GPU'),$(knows))

# With -j K each job gets its share of the cores. Threads that wait sleep: on a machine with other work, spinning ones hold it up.
jobs = $(or $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS))),1)
ifndef OMP_NUM_THREADS
export OMP_NUM_THREADS = $(shell n=$$(($$(nproc)/$(jobs))); echo $$((n > 0 ? n : 1)))
endif
OMP_WAIT_POLICY ?= passive
export OMP_WAIT_POLICY

# TARGETS made with the values in TEXT: $(eval $(call from,TARGETS,TEXT)); $(remember) ends the recipe. The values lie beside the
# target, in TARGET.vars; when those differ it is made again.
from = $(foreach t,$1,$(eval $t: private vars = $2)$(if $(call same,$(file <$t.vars),$2),,$(eval $t: FORCE)))
same = $(if $(subst x$1,,x$2)$(subst x$2,,x$1),,yes)
remember = @echo '$(vars)' > $@.vars
, := ,
FORCE:
.PHONY: FORCE
