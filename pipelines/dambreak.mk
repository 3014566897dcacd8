# SPDX-License-Identifier: GPL-3.0-or-later
# Breaking dams, 2D, in tanks of particles: a column of 2 m x 1 m in a tank of 5.37 m (front, height, pressure at the wall), and one of 1 m x 2 m
# (front, height), against potential flow (tests/test_dambreak.c) and against measurements by Martin & Moyce (1952), Phil. Trans. R. Soc. A 244, 312.
#   make -f pipelines/dambreak.mk [SIZE=small|medium|large]
# Massidda, THINS report on the parallelization of SPH, section 6.1; slow_water: c = 50 m/s. Balsara's switch: else viscosity holds the water at the walls.

# spacing [m]
DX = $(call by_size,0.04,0.01,0.005)
# until [s]: the 5.37 m tank, the other
END = $(call by_size,1.2,2.6,2.6)
END_FRONT = 0.8
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/dambreak.png $(OUT)/frames.png
reference = $(firstword $(wildcard $(here)../tests/data/dambreak.tsv $(here)data/dambreak.tsv))
cases = long front

# The tank is full at first; the water above and right of the column is taken away, and the density is the one at rest. The walls are body 1, four
# spacings thick. $(call tank,WIDTH,L,H)
tank = mkshape -d 2 --shape tank --size $1m,2.4m,$$(awk 'BEGIN { print 4*$(DX) }')m --spacing $(DX)m --neighbours 21.237 --lattice grid \
    -l slow_water -l slow_water | \
  alter -s 'Coordinates.x=Coordinates.x + $1m/2' -s 'Coordinates.y=Coordinates.y + 2.4m' \
    -s 'BodyID=max(Coordinates.y < 0m, max(Coordinates.x < 0m, Coordinates.x > $1m))' \
    -s 'Density=Density*(1 + 7*9.81m/s^2*(1 - BodyID)*max(0m, $3m - Coordinates.y)/(50m/s)^2)^(1/7)' \
    -k 'BodyID + (Coordinates.x < $2m)*(Coordinates.y < $3m)'
case.long = $(call tank,5.37,2,1)
case.front = $(call tank,4,1,2)
$(call from,$(cases:%=$(OUT)/%.h5),$(DX))
$(cases:%=$(OUT)/%.h5): $(OUT)/%.h5: | $(programs)
	@mkdir -p $(@D)
	$(case.$*) > $@
	$(remember)
settings = $(call sets,gravity.method=none force.y=-9.81 walls.body1=held kernel=cubic_spline smoothing.mode=fixed viscosity.alpha=0.05 viscosity.beta=0 viscosity.balsara=true \
  form.diffusion=0.05 $(SET))
$(call from,$(OUT)/long.tsv,--end $(END) --every 0.02 $(settings))
$(call from,$(OUT)/front.tsv,--end $(END_FRONT) --every 0.02 $(settings))
# t, tip, front (where the water is 0.05 m deep: its capillary length, 2.7 mm, at the size of the experiment), height at the left wall (without
# drops above the water: gaps of two spacings), pressure at the right wall 0.2 m up, water outside, largest change of density, mass; a row a snapshot.
# Depths are those of bins two spacings wide.
$(cases:%=$(OUT)/%.tsv): $(OUT)/%.tsv: $(OUT)/%.h5
	$(call run,$(OUT)/$*)
	for f in $(OUT)/$*/snap_*.h5; do t=$${f##*_}; t=$${t%.h5}; \
	  columns -f Coordinates.x -f Coordinates.y -f BodyID -f Pressure -f Density -f Masses $$f | \
	    awk -F'\t' -v t=$$((10#$$t)) -v dx=$(DX) -v W=$(if $(filter long,$*),5.37,4) '/^#/ { next } \
	      $$3 { if ($$1 > W && $$1 < W + dx && $$2 > 0.2 - 1.5*dx && $$2 < 0.2 + 1.5*dx) { p += $$4; n++ } next } \
	      { m += $$6; x = $$1 > x ? $$1 : x; if ($$1 < 2.5*dx) { k = int($$2/(2*dx)); if ($$2 > top[k]) top[k] = $$2 } if ($$1 < -dx || $$1 > W + dx || $$2 < -dx) out++; \
	        depth[int($$1/(2*dx))] += $$6/$$5/(2*dx); d = $$5/1000 - 1; d = d < 0 ? -d : d; if (d > worst) worst = d } \
	      END { for (k = 0; k in top; k++) y = top[k]; k = int(x/(2*dx)); while (k && depth[k] < 0.05) k--; \
	        front = 2*dx*(k + 0.5 + (depth[k] - 0.05)/(depth[k] - depth[k + 1])); \
	        printf "%.2f\t%.6g\t%.6g\t%.6g\t%.6g\t%d\t%.6g\t%.12g\n", 0.02*t, x + dx/2, front, y + dx/2, p/n, out, worst, m }'; done > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)dambreak.awk $(reference) $(cases:%=$(OUT)/%.tsv)
	$(call judge,dambreak.awk) -v dx=$(DX) $(reference) $(cases:%=$(OUT)/%.tsv) > $@
$(OUT)/dambreak.png: $(here)dambreak.gp $(reference) $(cases:%=$(OUT)/%.tsv)
	gnuplot -c $^ $@
$(OUT)/frames.png: $(OUT)/long.tsv
	render -v slice -c Pressure/1kPa -L 'pressure [kPa]' -r 0:10 -S 'BodyID == 0' -C 2.685m,0.8m,0m -e 5.6m -P 1x4 -s 1000x1500 -o $@ \
	  $(foreach k,0010 0030 0045 0060,$(OUT)/long/snap_$k.h5)
