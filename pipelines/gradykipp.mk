# SPDX-License-Identifier: GPL-3.0-or-later
# Basalt with flaws is stretched at a constant rate: stress and damage of each particle, against its flaws integrated one by one.
#   make -f pipelines/gradykipp.mk [SIZE=small|medium|large]
# Grady & Kipp (1980), Int. J. Rock Mech. 17, 147; explicit flaws as in Benz & Asphaug (1995), Comput. Phys. Commun. 87, 253.

# particles along the bar, 1 cm apart, periodic across (78 neighbours: there the sum of r grad W is 1 to 4e-4 on this lattice); rates of strain [1/s]; Weibull pair
N = $(call by_size,32,64,128)
ACROSS = $(call by_size,8,12,12)
RATES = 1e2 3e2 1e3
K = 5e34
M = 8.5
# further settings of the solver, KEY=VALUE: steps are short beside the growth of cracks
SET = step.cfl=0.02

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/gradykipp.png
runs = $(RATES:%=$(OUT)/r%)

$(call from,$(OUT)/bar.h5,$(N) $(ACROSS) $(K) $(M))
$(OUT)/bar.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --shape box --size $(N)cm,$(ACROSS)cm,$(ACROSS)cm --spacing 1cm --lattice grid --neighbours 78 -l basalt | weibull -k basalt:$(K) -m basalt:$(M) -o $@
	$(remember)
# Number of flaws of each particle, and all of them in their order.
numbers = { h5dump -d /PartType0/$1 -y -w 1 -m %.9g -o /dev/fd/3 $< > /dev/null; } 3>&1 | tr -d ' ,' | grep .
$(OUT)/count.tsv $(OUT)/flaws.tsv: $(OUT)/%.tsv: $(OUT)/bar.h5
	$(call numbers,$(if $(filter count,$*),FlawCount,FlawThresholds)) > $@
$(runs:%=%/start.h5): $(OUT)/r%/start.h5: $(OUT)/bar.h5
	@mkdir -p $(@D)
	alter -s 'Velocities.x=$*/1s*Coordinates.x' -o $@ $<
# Until strains are at 1.5 of the greatest threshold and cracks had 4 microseconds.
half = $$(awk 'BEGIN { print $(ACROSS)/200 }')
$(call from,$(runs:%=%/states.tsv),$(call sets,gravity.method=none kernel=cubic_spline smoothing.mode=fixed viscosity.alpha=0 viscosity.beta=0 \
  boundary.y=periodic boundary.z=periodic $(SET)))
$(runs:%=%/states.tsv): $(OUT)/r%/states.tsv: $(OUT)/r%/start.h5 $(OUT)/flaws.tsv
	@rm -rf $(@D)/run
	t=$$(sort -g $(OUT)/flaws.tsv | tail -1 | awk '{ print 1.5*$$1/$*/1.07 + 4e-6 }'); \
	solver -o $(@D)/run --end $$t --every $$(awk "BEGIN { print $$t/80 }") $(vars) \
	  --set boundary.low=-1,-$(half),-$$(awk 'BEGIN { print $(ACROSS)/100 }') --set boundary.high=1,$(half),0 $<; \
	n=0; for s in $(@D)/run/snap_*.h5; do columns -f Coordinates.x -f Damage -f '(1 - Damage)*(DeviatoricStress.xx - Pressure)' -f SmoothingLength $$s | \
	  awk -v t=$$(awk "BEGIN { print $$n*$$t/80 }") '!/^#/ { print t "\t" $$0 }'; n=$$((n + 1)); done > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)gradykipp.awk $(OUT)/count.tsv $(OUT)/flaws.tsv $(runs:%=%/states.tsv)
	$(call judge,gradykipp.awk) -v length_=$(N)e-2 -v across=$(ACROSS) -v k=$(K) -v m=$(M) -v curves=$(OUT)/curves.tsv $(filter %.tsv,$^) > $@
$(OUT)/gradykipp.png: $(here)gradykipp.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/curves.tsv $@
