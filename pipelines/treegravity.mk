# SPDX-License-Identifier: GPL-3.0-or-later
# How good the gravity of the tree is, and how much faster than direct sums: a sphere of particles at random places.
#   make -f pipelines/treegravity.mk [SIZE=small|medium|large]
# After Reufer (2011), figure 2.10. The usual criterion has 90 % of the errors below 1e-3 at theta 0.45 only; ours opens heavy nodes sooner.

# particles
N = $(call by_size,10000,100000,1000000)
# opening angles
THETA = 0.3 0.5 0.7
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/treegravity.png

# Uniform in the unit ball; mass 1 in all, G = 1; supports so small that nothing else acts. u(k): numbers in 0..1 out of the id.
hash = mod(|sin((ParticleIDs + 1)*$1)*43758.5453123|, 1)
$(call from,$(OUT)/start.h5,$(N))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape --size 1m,1m,1m -n $(vars) -l gas:rho=1 | \
	  alter -s 'r=cbrt($(call hash,12.9898))' -s 'c=2*$(call hash,78.233) - 1' -s 'f=2*3.14159265358979*$(call hash,37.719)' \
	    -s 'Coordinates.x=r*sqrt(1 - c^2)*cos(f)' -s 'Coordinates.y=r*sqrt(1 - c^2)*sin(f)' -s 'Coordinates.z=r*c' \
	    -s 'Masses=1/$(vars)' -s 'SmoothingLength=1e-5' > $@
	$(remember)

ways = $(OUT)/direct $(THETA:%=$(OUT)/tree%)
method = $(if $(filter direct,$(notdir $*)),gravity.method=direct,gravity.theta=$(patsubst tree%,%,$(notdir $*)))
$(call from,$(ways:%=%/pull.tsv),--end 1e-8 --every 1e-8 $(call sets,gravity.G=1 energy=frozen density=continuity smoothing.mode=fixed precision=double $(SET)))
$(ways:%=%/pull.tsv): %/pull.tsv: $(OUT)/start.h5
	@rm -rf $*/run; mkdir -p $*
	solver --profile -o $*/run $(vars) --set $(method) $< 2> $*.profile || { cat $*.profile >&2; exit 1; }
	columns -d 17 -f ParticleIDs $(foreach c,x y z,-f Acceleration.$c) $*/run/checkpoint.h5 | tail -n +2 | sort -n > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)treegravity.awk $(ways:%=%/pull.tsv)
	$(call judge,treegravity.awk) -v errors=$(OUT)/errors.tsv $(ways:%=%/pull.tsv) $(ways:%=%.profile) > $@
$(OUT)/treegravity.png: $(here)treegravity.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv '$(THETA)' $@
