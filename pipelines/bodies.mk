# SPDX-License-Identifier: GPL-3.0-or-later
# Bodies at rest, ready to collide, kept in a library that all studies share (recipes.mk): a body is made once.
#   make -f pipelines/bodies.mk                                       one of each recipe; what was reached, and checks of that
#   make -f pipelines/bodies.mk BODIES='vesta moon' N=20000 SEED='1 2'
#   make -f pipelines/bodies.mk out/bodies/ceres-n5000-s3.flaws.h5    one by its name, with flaws
#   make -f pipelines/bodies.mk list                                  the recipes
# A recipe of your own: RECIPE='mksphere -m 1e21kg -l iron:0.2 -l basalt' BODIES=mine, or a line `recipe.mine = ...` in recipes.mk.

# particles of a body
N = $(if $(gpu),100000,3000)
# which recipes
BODIES = ceres vesta moon protoearth rubble
# orientation of the lattice, boulders, flaws
SEED = 1
# of the solver: pressure_form product or squares with the density by continuity, or density sum or miscible
FORM = product
# a recipe of your own, under the name mine
RECIPE =
# where everything goes
OUT = out/bodies

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)common.mk
LIBRARY = $(OUT)
include $(here)recipes.mk
ifneq ($(RECIPE),)
recipe.mine = $(RECIPE)
endif

form := $(filter-out -product,-$(FORM))
wanted := $(foreach b,$(BODIES),$(foreach s,$(SEED),$b-n$(N)-s$s$(if $(filter mkshape,$(firstword $(recipe.$b))),,$(form))))
named := $(patsubst %.flaws,%,$(patsubst $(LIBRARY)/%.h5,%,$(filter $(LIBRARY)/%.h5,$(MAKECMDGOALS))))
$(call library,$(sort $(wanted) $(named)))

all: $(call body,$(wanted))
	@awk -f $(here)bodies.awk $(call reports,$(wanted)) /dev/null
flaws: $(call with_flaws,$(wanted))
list:
	@printf '%-12s %s\n' $(foreach r,$(recipes),$r '$(recipe.$r)')

clean:
	rm -rf $(LIBRARY)

.PHONY: all flaws list clean
