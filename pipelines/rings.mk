# SPDX-License-Identifier: GPL-3.0-or-later
# Two rings of rubber collide in a plane: with artificial stress they bounce, without they break. After Schaefer et al. (2016), section
# 4.1, figures 1 and 2; Monaghan (2000), J. Comput. Phys. 159, 290; Gray, Monaghan & Swift (2001), CMAME 190, 6641.
#   make -f pipelines/rings.mk [SIZE=small|medium|large]
# Units: density and sound speed of the rubber (852 m/s), centimetre. Radii 3 and 4, each ring moves at 0.059 of the speed of sound.

# spacing of the particles: 4392, 7800 (the paper's), 17 600 of them
DX = $(call by_size,0.1,0.075,0.05)
# end (the rings part at 120), times of the pictures
END = $(call by_size,140,200,200)
FRAMES = 0 60 120 $(END)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/speed.png $(OUT)/rings.png $(OUT)/bounce.png
runs = $(OUT)/with $(OUT)/without

# A square lattice, h of three spacings (pi 3^2 neighbours) that stays: with 2.5 the artificial stress of 0.2 does not hold them.
$(call from,$(OUT)/start.h5,$(DX))
$(OUT)/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape ring --size 3m,4m --spacing $(DX)m --lattice grid --neighbours 28.2743 -l rubber -o $(OUT)/ring.h5
	alter -j $(OUT)/ring.h5 -s 'Coordinates.x=Coordinates.x + if(BodyID == 0, -1, 1)*(4m + $(DX)m/2)' \
	  -s 'Velocities.x=if(BodyID == 0, 0.059m/s, -0.059m/s)' -o $@ $(OUT)/ring.h5
	$(remember)
settings = --end $(END) --every 5 $(call sets,gravity.method=none precision=double kernel=cubic_spline smoothing.mode=fixed form.xsph=0.5 \
  viscosity.alpha=1 viscosity.beta=2 $(SET))
$(call from,$(OUT)/with/motion.tsv,$(settings) --set stress.artificial=0.2)
$(call from,$(OUT)/without/motion.tsv,$(settings))
# Over time: mean velocity and extent of the left ring.
$(runs:%=%/motion.tsv): %/motion.tsv: $(OUT)/start.h5
	@mkdir -p $*
	$(call run,$*/run)
	for s in $*/run/snap_*.h5; do columns -f Coordinates.x -f Velocities.x -w 'BodyID == 0' $$s | \
	  awk '/^#/ { next } { v += $$2; if (!n++ || $$1 < low) low = $$1; if (n == 1 || $$1 > high) high = $$1 } END { print v/n/0.059 "\t" high - low }'; done | \
	  awk '{ print (NR - 1)*5 "\t" $$0 }' > $@
	$(remember)
frame = $*/run/snap_$$(printf %04d $$(($1/5))).h5
# Closest pair while they touch and at the end; pieces of two and more particles at the end.
$(runs:%=%/pairs.tsv): %/pairs.tsv: %/motion.tsv
	for t in 60 $(END); do columns -f Coordinates.x -f Coordinates.y $(call frame,$$t) | awk -v dx=$(DX) -f $(here)closest.awk; done > $@
$(runs:%=%/pieces.tsv): %/pieces.tsv: %/motion.tsv
	fof --length $$(awk 'BEGIN { print 1.6*$(DX) }')m --min-particles 2 $(call frame,$(END)) > $@

results = $(foreach r,$(runs),$(addprefix $r/,motion.tsv pairs.tsv pieces.tsv run/conserved.tsv))
$(OUT)/verdict.tsv: $(here)rings.awk $(foreach r,$(runs),$(addprefix $r/,motion.tsv pairs.tsv pieces.tsv))
	$(call judge,rings.awk) -v dx=$(DX) $(results) > $@
# Upper row with, lower row without artificial stress.
rows = $(foreach r,$(runs),$(foreach t,$(FRAMES),$r/run/snap_$(shell printf %04d $$(($t/5))).h5))
$(OUT)/speed.png: $(OUT)/verdict.tsv
	render --color '|Velocities|' --range 0:0.1 --label 'speed [speed of sound]' --extent 18m --size 1600x800 --panels 4x2 -o $@ $(rows)
# The same as particles, each ring in a colour.
$(OUT)/rings.png: $(here)rings.gp $(OUT)/verdict.tsv
	for r in $(runs); do for t in $(FRAMES); do columns -f Coordinates.x -f Coordinates.y -f BodyID $$r/run/snap_$$(printf %04d $$((t/5))).h5 > $$r/t$$t.tsv; done; done
	gnuplot -c $< $(OUT) '$(FRAMES)' $@
$(OUT)/bounce.png: $(here)bounce.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(runs:%=%/motion.tsv) $@
