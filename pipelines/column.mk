# SPDX-License-Identifier: GPL-3.0-or-later
# Columns of dry sand collapse, 2D, against a wall: how far they run, how high they stay, and that they come to rest.
#   make -f pipelines/column.mk [SIZE=small|medium|large]
# Set-up of Bui et al. (2008), Int. J. Numer. Anal. Meth. Geomech. 32, 1537; laws of Lube et al. (2005), Phys. Rev. E 72, 041301.

# particles across the column of 0.1 m
N = $(call by_size,30,60,200)
# heights over width
ASPECTS = 0.5 1
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/frames.png

runs = $(ASPECTS:%=$(OUT)/a%)
# A tank 0.5 m wide with walls of sand that is held (body 1), the column at its left one, at rest under its weight.
$(call from,$(runs:%=%/start.h5),$(N))
$(runs:%=%/start.h5): $(OUT)/a%/start.h5: | $(programs)
	@mkdir -p $(@D)
	dx=$$(awk 'BEGIN { print 0.1/$(vars) }'); wall=$$(awk "BEGIN { print 4*$$dx }"); top=$$(awk 'BEGIN { print 0.1*$* }'); \
	mkshape -d 2 --shape tank --size 0.5m,0.2m,$${wall}m --spacing $${dx}m --neighbours 21.237 --lattice grid -l sand -l sand | \
	  alter -s 'Coordinates.x=Coordinates.x + 0.25m' -s 'Coordinates.y=Coordinates.y + 0.2m' \
	    -s 'BodyID=max(Coordinates.y < 0m, max(Coordinates.x < 0m, Coordinates.x > 0.5m))' \
	    -s "Density=Density*(1 + 9.81m/s^2*(1 - BodyID)*max(0m, $${top}m - Coordinates.y)*2650kg/m^3/0.7MPa)" \
	    -k "BodyID + (Coordinates.x < 0.1m)*(Coordinates.y < $${top}m)" > $@
	$(remember)
$(call from,$(runs:%=%/end.tsv),--end 0.8 --every 0.1 $(call sets,gravity.method=none force.y=-9.81 walls.body1=held kernel=cubic_spline pressure_form=product \
  smoothing.mode=fixed viscosity.alpha=0.05 viscosity.beta=0 $(SET)))
# Grains that touch are up to 1.5 spacings apart; fragment 1 is the largest heap of them, the main mass.
$(runs:%=%/end.tsv): $(OUT)/a%/end.tsv: $(OUT)/a%/start.h5
	$(call run,$(@D)/run)
	alter -k 'BodyID == 0' $(@D)/run/snap_0008.h5 | fof --length $$(awk 'BEGIN { print 1.5*0.1/$(N) }')m -o $(@D)/grains.h5 > $(@D)/heaps.tsv
	columns -f $* -f Coordinates.x -f Coordinates.y -f '|Velocities|' -f FragmentID $(@D)/grains.h5 > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)column.awk $(runs:%=%/end.tsv)
	$(call judge,column.awk) -v n=$(N) $(vars:%=%/end.tsv) > $@
	$(remember)
$(OUT)/frames.png: $(OUT)/verdict.tsv
	render -v slice -c '|Velocities|' -r 0:1 -C 0.17m,0.05m,0m -e 0.4m -S 'BodyID == 0' -P 1x4 -s 1000x1200 -o $@ \
	  $(foreach k,0 1 2 8,$(lastword $(runs))/run/snap_000$k.h5)
