# SPDX-License-Identifier: GPL-3.0-or-later
# The Gresho-Chan vortex, 2D, periodic: pressure balances rotation, so it should stay as it is. Shows what viscosity takes where none is needed.
#   make -f pipelines/gresho.mk [SIZE=small|medium|large]
# Gresho & Chan (1990), Int. J. Numer. Meth. Fluids 11, 621; Liska & Wendroff (2003), SIAM J. Sci. Comput. 25, 995.

# particles along an edge of the box of edge 1; all of these are run
N = $(call up_to,32 64,128,256 512)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/gresho.png $(OUT)/convergence.png

runs = $(N:%=$(OUT)/n%)
r = |Coordinates|/1m
speed = if($r < 0.2, 5, if($r < 0.4, 2/max($r, 0.1) - 5, 0))
pressure = if($r < 0.2, 5 + 12.5*($r)^2, if($r < 0.4, 9 + 12.5*($r)^2 - 20*$r + 4*log(max($r, 0.1)/0.2), 3 + 4*log(2)))
$(runs:%=%/start.h5): $(OUT)/n%/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape box --size 1m,1m --spacing $$(awk 'BEGIN { printf "%.12g", 1/$* }')m --neighbours 80 --lattice grid -l gas:rho=1 | \
	  alter -s 'Coordinates.y=Coordinates.y + 0.5m' -s 'InternalEnergy=1.5J/kg*($(pressure))' \
	    -s 'Velocities.x=-Coordinates.y/1s*($(speed))' -s 'Velocities.y=Coordinates.x/1s*($(speed))' > $@
$(call from,$(runs:%=%/end.tsv),--end 1 --every 0.1 $(call sets,gravity.method=none precision=double density=sum kernel=wendland_c4 viscosity.balsara=true \
  boundary.x=periodic boundary.y=periodic boundary.low=-0.5$(,)-0.5$(,)0 boundary.high=0.5$(,)0.5$(,)0 $(SET)))
$(runs:%=%/end.tsv): $(OUT)/n%/end.tsv: $(OUT)/n%/start.h5
	$(call run,$(@D)/run)
	for k in 09 10; do columns -f '|Coordinates|' -f '(Coordinates.x*Velocities.y-Coordinates.y*Velocities.x)/max(|Coordinates|, 1e-6m)' -f $$k \
	  -f $* $(@D)/run/snap_00$$k.h5; done > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)gresho.awk $(runs:%=%/end.tsv)
	$(call judge,gresho.awk) -v errors=$(OUT)/errors.tsv $(vars:%=%/end.tsv) $(vars:%=%/run/conserved.tsv) > $@
	$(remember)
$(OUT)/gresho.png: $(here)gresho.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(firstword $(runs))/end.tsv $(lastword $(runs))/end.tsv $@
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative L1 error of the speed' spacing $@
