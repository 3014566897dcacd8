# SPDX-License-Identifier: GPL-3.0-or-later
# The library of bodies: at rest, named by their recipe, made once and shared by all studies. Included after common.mk, with OUT set:
#   $(call library,ceres-n3000-s1 vesta-n20000-s2-miscible)   the study wants these,
#   $(call body,ceres-n3000-s1)                               and finds this one here; $(call with_flaws,...): with flaws
# RECIPE-nN-sSEED[-FORM]: a recipe below (or recipe.NAME of the study itself), particles, seed of the lattice's orientation, of
# boulders and flaws, and the solver's form: sum or miscible, its density; squares, its pressure_form. Without FORM: density by
# continuity and pressure_form product, which leaves layers of rock and ice at rest (squares, the solver's default, lets some lattices
# boil: Ceres with 3000 particles to 1.1e-2 v_esc in two free-fall times, against 2.6e-5). Beside NAME.h5 lie NAME.profile.tsv, its structure, and
# NAME.relax.tsv, what was reached; bodies.awk judges that. A recipe that was changed makes its bodies again.

# Ceres-like: two thirds of basalt, a mantle of ice (Schaefer et al. 2016, A&A 590, A19); and the same mass of basalt
recipe.ceres = $(call ceres_with,ice)
ceres_with = mksphere -m 9.43e20kg -l basalt:0.7 -l $1:0.3
recipe.ceres_rock = mksphere -m 9.43e20kg -l basalt
# Vesta-like: mass, mean radius, core and spin of Russell et al. (2012, Science 336, 684); olivine and crust follow from them
recipe.vesta = mksphere -m 2.59076e20kg -r 261.4km -l iron:0.18 -l olivine -l basalt --spin 5.342h --hydrostatic
# Moon-size: mass and radius of the Moon; the core is the iron that a mantle of basalt then needs
recipe.moon = mksphere -m 7.346e22kg -r 1737.4km -l iron -l basalt --hydrostatic
# 0.9 Earth masses of iron and silicate: a proto-Earth (Reufer 2011, section 2.1.11). With 57 neighbours its centre has 6.5 % too much pressure, whatever
# N, as sums over so few are not integrals (docs/theory.md 6.1).
recipe.protoearth = mksphere -m 0.9Mearth -l iron:0.3 -l granite --hydrostatic --neighbours 100
# A rubble pile 100 m long. Its own gravity (0.3 Pa) strains rock by 1e-11: it is at rest as it is placed.
recipe.rubble = mkshape --size 50m,45m,40m -l basalt --rubble 4m:18m --fill 0.6

# where they lie, for all studies whose OUT has the same parent
LIBRARY ?= $(patsubst %/,%,$(dir $(OUT)))/bodies
# further options of relax
RELAX =

body = $(1:%=$(LIBRARY)/%.h5)
with_flaws = $(1:%=$(LIBRARY)/%.flaws.h5)
reports = $(foreach b,$1,$(if $(filter mksphere,$(firstword $(call recipe_of,$b))),$(LIBRARY)/$b.relax.tsv))
library = $(foreach b,$1,$(call from,$(call body,$b),$(call made_by,$b)))

# The parts of a name, and the commands that make it.
part = $(word $2,$(subst -, ,$1))
recipe_of = $(or $(recipe.$(call part,$1,1)),$(error no recipe '$(call part,$1,1)'; there are: $(recipes)))
number_of = $(or $(patsubst n%,%,$(filter n%,$(call part,$1,2))),$(error body '$1' is not RECIPE-nN-sSEED[-FORM]))
seed_of = $(or $(patsubst s%,%,$(filter s%,$(call part,$1,3))),$(error body '$1' is not RECIPE-nN-sSEED[-FORM]))
placed = $(call recipe_of,$1) -n $(call number_of,$1) --rotate $(call seed_of,$1)
relaxed = relax --set $(if $(filter sum miscible,$(call part,$1,4)),density=,pressure_form=)$(or $(call part,$1,4),product) --proof 2tff$(if $(strip $(RELAX)), $(strip $(RELAX)))
made_by = $(placed)$(if $(filter mkshape,$(firstword $(recipe_of))), --seed $(seed_of), | $(relaxed))
recipes = $(sort $(patsubst recipe.%,%,$(filter recipe.%,$(.VARIABLES))))

# Studies may run at once: who comes second waits, and finds the body made. A killed relaxation goes on.
lock = $(if $(shell command -v flock),exec 9> $(@D)/.$(@F).lock; flock 9;)
beside = --profile $1.profile.tsv --report $1.relax.tsv --checkpoint $1.$$(cksum <<< '$(vars)' | cut -d' ' -f1).checkpoint
files = $(if $(findstring | relax,$(vars)),$(call beside,$(basename $@)) )-o $@
$(LIBRARY)/%.h5: | $(programs)
	@mkdir -p $(@D)
	@$(lock) if [ ! -s $@ ] || [ "$$(cat $@.vars 2>/dev/null)" != '$(vars)' ]; then \
	  echo '$(vars) -o $@'; $(vars) $(files); echo '$(vars)' > $@.vars; fi
$(LIBRARY)/%.flaws.h5: $(LIBRARY)/%.h5
	weibull --seed $(call seed_of,$*) -o $@ $<
