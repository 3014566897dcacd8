# SPDX-License-Identifier: GPL-3.0-or-later
# A nylon sphere of 0.2 g hits a basalt sphere of 6 cm at 3.2 km/s, 30 degrees: intact core, damage, fragments, for Weibull pairs and flaws.
#   make -f pipelines/nakamura.mk [SIZE=small|medium|large]
# Nakamura & Fujiwara (1991), Icarus 92, 132: the largest fragment has 0.31 of the mass. Schaefer et al. (2016), section 4.4, get 0.304 from
# 524 000 particles with (k, m) = (5e34, 8), chosen for it. Each pair runs with each seed.

# particles of the basalt sphere: 14 000, 113 000, 524 000 have volumes of (2, 1, 0.6 mm)^3
N = $(call by_size,14000,113000,524000)
# pairs KxM, the fitted one first; seeds of the flaws
PAIRS = 5e34x8 $(call by_size,1e61x16,5e34x8.5 4e35x9 1e61x16,5e34x8.5 4e35x9 1e61x16)
SEEDS = 1 2 3
# further settings of the solver, KEY=VALUE; alpha, beta = 1, 2 as in the paper
SET = viscosity.alpha=1 viscosity.beta=2

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/damage.png $(OUT)/spectrum.png
first = $(firstword $(PAIRS))
cases = $(foreach s,$(SEEDS),$(first)-s$s) $(foreach p,$(filter-out $(first),$(PAIRS)),$p-s$(firstword $(SEEDS)))
runs = $(cases:%=$(OUT)/%)

# The nylon as fine as the basalt, b = 15 mm, as they touch; in the frame of the common centre of mass the basalt is nearly at rest.
$(call from,$(OUT)/pair.h5,$(N))
$(OUT)/pair.h5: | $(programs)
	@mkdir -p $(@D)
	dx=$$(awk 'BEGIN { printf "%.6g", 30*(4.18879*sqrt(2)/$(N))^(1/3) }'); \
	mkshape --size 30mm,30mm,30mm --spacing $${dx}mm -l basalt -o $(OUT)/basalt.h5; \
	mkshape --size 3.433mm,3.433mm,3.433mm --spacing $${dx}mm -l lucite -o $(OUT)/nylon.h5
	collide --no-gravity -b 15mm --speed 3.2km/s --distance 34mm $(OUT)/basalt.h5 $(OUT)/nylon.h5 | alter -t 0s -o $@
	$(remember)
$(runs:%=%/start.h5): $(OUT)/%/start.h5: $(OUT)/pair.h5
	@mkdir -p $(@D)
	pair=$*; seed=$${pair##*-s}; pair=$${pair%-s*}; \
	weibull -k basalt:$${pair%x*} -m basalt:$${pair#*x} --seed $$seed -o $@ $<
# Fragments over time and at the end; of each particle of the basalt its first distance from the point of impact and from the one opposite,
# damage at 5 microseconds, speed away from the impact at the end.
fof = fof --max-damage 0.999 --link 1.01 --min-particles 3
of = columns -f ParticleIDs -f $1 -w 'BodyID == 0'
$(call from,$(runs:%=%/end.tsv),--end 50e-6 --every 5e-6 $(call sets,gravity.method=none $(SET)))
$(runs:%=%/end.tsv): %/end.tsv: %/start.h5
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do $(fof) $$s | awk '$$1 == 1 { m = $$3 } END { print m/0.305363 }'; done | awk '{ print (NR - 1)*5 "\t" $$1 }' > $*/core.tsv
	$(fof) $*/run/snap_0010.h5 > $@
	join -j 1 <($(call of,'sqrt((Coordinates.y - 30mm)^2 + Coordinates.x^2 + Coordinates.z^2)' -f 'sqrt((Coordinates.y + 30mm)^2 + Coordinates.x^2 + Coordinates.z^2)') $< | grep -v '^#' | sort) \
	  <(join -j 1 <($(call of,Damage) $*/run/snap_0001.h5 | grep -v '^#' | sort) <($(call of,-Velocities.y) $*/run/snap_0010.h5 | grep -v '^#' | sort)) | tr ' ' '\t' > $*/places.tsv
	$(remember)

results = $(foreach r,$(runs),$(addprefix $r/,end.tsv places.tsv run/conserved.tsv))
$(OUT)/verdict.tsv: $(here)nakamura.awk $(runs:%=%/end.tsv)
	$(call judge,nakamura.awk) -v n=$(N) -v spectrum=$(OUT)/spectrum.tsv $(results) > $@
$(OUT)/damage.png: $(OUT)/verdict.tsv
	render --view slice --color Damage --range 0:1 -C 0,0,0 --extent 75mm --size 1200x560 --panels 2x1 -o $@ $(firstword $(runs))/run/snap_0001.h5 $(firstword $(runs))/run/snap_0010.h5
$(OUT)/spectrum.png: $(here)nakamura.gp $(OUT)/verdict.tsv
	gnuplot -c $< '$(cases)' $(OUT) $@
