# SPDX-License-Identifier: GPL-3.0-or-later
# An elastic sphere that rotates, once around: angular momentum, shape; on a lattice, and on one that is disturbed by 10 % of the spacing;
# and, as a negative control, a tenth of a turn without the correction of the velocity gradient, which must lose what the others keep.
#   make -f pipelines/spin.mk [SIZE=small|medium|large]
# Radius, density, sound speed, bulk and shear modulus are 1; a turn takes 100. Exact: it goes on, flattened by less than (omega R/c)^2.

# spacing of the particles: 485, 4157, 33 000 of them
DX = $(call by_size,0.2,0.1,0.05)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/spin.png $(OUT)/stress.png
runs = $(OUT)/lattice $(OUT)/disturbed
control = $(OUT)/raw

# Moduli of 1: rubber of another shear modulus. Disturbed by what sines of the number make, which is close to uniform.
$(OUT)/elastic.cfg: $(firstword $(wildcard $(here)../materials/rubber.cfg $(here)../../materials/rubber.cfg))
	@mkdir -p $(@D)
	sed -e 's/^name = .*/name = "elastic";/' -e 's/0.22 Pa/1 Pa/' $< > $@
disturb = Coordinates.$1=Coordinates.$1 + 0.1*$(DX)*1m*sin($2*ParticleIDs^2)
turn = -s 'Velocities.x=-0.0628318530718*Coordinates.y/1s' -s 'Velocities.y=0.0628318530718*Coordinates.x/1s'
shift.disturbed = -s '$(call disturb,x,12.9898)' -s '$(call disturb,y,78.233)' -s '$(call disturb,z,37.719)'
$(call from,$(runs:%=%/start.h5) $(control)/start.h5,$(DX))
$(runs:%=%/start.h5) $(control)/start.h5: $(OUT)/%/start.h5: $(OUT)/elastic.cfg | $(programs)
	@mkdir -p $(@D)
	mkshape --size 1m,1m,1m --spacing $(DX)m --lattice cubic -l $< | alter $(shift.$*) $(turn) -o $@
	$(remember)
common = gravity.method=none viscosity.beta=0.5 $(SET)
settings = --end 100 --every 5 $(call sets,$(common))
$(call from,$(runs:%=%/shape.tsv),$(settings))
$(runs:%=%/shape.tsv): %/shape.tsv: %/start.h5
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do columns -f Coordinates.x -f Coordinates.y -f Coordinates.z -f '|DeviatoricStress|' $$s | \
	  awk '/^#/ { next } { x += $$1^2; y += $$2^2; z += $$3^2; if ($$4 > s) s = $$4 } END { print sqrt(x/z) "\t" sqrt(y/z) "\t" s }'; done | \
	  awk '{ print (NR - 1)*5 "\t" $$0 }' > $@
	$(remember)

without = --end 10 --every 10 $(call sets,$(common) form.gradient=raw)
$(call from,$(control)/run/conserved.tsv,$(without))
$(control)/run/conserved.tsv: $(control)/start.h5
	$(call run,$(@D))
	$(remember)

$(OUT)/verdict.tsv: $(here)spin.awk $(runs:%=%/shape.tsv) $(control)/run/conserved.tsv
	$(call judge,spin.awk) -v dx=$(DX) $(foreach r,$(runs),$r/shape.tsv $r/run/conserved.tsv) $(control)/run/conserved.tsv > $@
$(OUT)/spin.png: $(here)spin.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(runs:%=%/run/conserved.tsv) $@
$(OUT)/stress.png: $(OUT)/verdict.tsv
	render --color '|DeviatoricStress|' --label 'deviatoric stress' --panels 2x1 --size 1200x600 -o $@ $(runs:%=%/run/snap_0020.h5)
