# SPDX-License-Identifier: GPL-3.0-or-later
# A pressure wave in mercury, 2D: a beam heats the middle of a square at once; the wave runs out, and comes back from the free edges as tension.
#   make -f pipelines/mercury.mk [SIZE=small|medium|large]
# Armando's benchmark (Massidda, THINS report on the parallelization of SPH, section 6.2) with the law made linear, so that acoustics have the exact solution:
# u = u0 exp(-r^2/(2 s^2)), s = 4 mm, 10 MPa at the centre of 10 x 10 cm whose edges bear no pressure.

# particles along an edge; all of these are run, and the pressure is followed closely in the finest up to 400
N = $(call up_to,125 250,400,1000)
# linear artificial viscosity: the 0.1 of codes whose h is half the support
ALPHA = 0.05
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/mercury.png $(OUT)/frames.png $(OUT)/convergence.png

runs = $(N:%=$(OUT)/n%)
near = $(OUT)/n$(lastword $(filter 125 250 400,$(N)))
frames = 1 2 3
settings = $(call sets,gravity.method=none smoothing.mode=fixed kernel=cubic_spline \
  viscosity.alpha=$(ALPHA) viscosity.beta=0 $(SET))

# h is 2.5 spacings. rho0 G u0 = 10 MPa.
$(runs:%=%/start.h5): $(OUT)/n%/start.h5: | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape box --size 10cm,10cm --spacing $$(awk 'BEGIN { print 0.1/$* }')m --neighbours 19.635 --lattice grid -l mercury | \
	  alter -s 'Coordinates.y=Coordinates.y + 5cm' -s 'InternalEnergy=270.65J/kg*exp(-(|Coordinates|/4mm)^2/2)' > $@
# x, y, p/1 MPa, time, spacing of every particle, at 20, 40, 60 us
$(call from,$(runs:%=%/end.tsv),--end 60us --every 20us $(settings))
$(runs:%=%/end.tsv): $(OUT)/n%/end.tsv: $(OUT)/n%/start.h5
	$(call run,$(@D)/run)
	for k in $(frames); do \
	  columns -f Coordinates.x -f Coordinates.y -f Pressure/1MPa -f $$((20*k)) -f $$(awk 'BEGIN { print 0.1/$* }') $(@D)/run/snap_000$$k.h5; done > $@
	$(remember)
# t in us, r, p/1 MPa along the x axis every microsecond until the wave is at the edge
$(call from,$(near)/near.tsv,--end 30us --every 1us $(settings))
$(near)/near.tsv: $(near)/start.h5
	$(call run,$(@D)/axis)
	for f in $(@D)/axis/snap_*.h5; do t=$${f##*_}; t=$${t%.h5}; \
	  columns -w 'abs(Coordinates.y) < 1.2mm && abs(Coordinates.x) < 45mm' -f $$((10#$$t)) -f 'abs(Coordinates.x)' -f Pressure/1MPa $$f; done > $@
	rm $(@D)/axis/snap_*.h5
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)mercury.awk $(near)/near.tsv $(runs:%=%/end.tsv)
	$(call judge,mercury.awk) -v errors=$(OUT)/errors.tsv -v axis=$(OUT)/axis.tsv $(near)/near.tsv $(vars:%=%/end.tsv) \
	  $(vars:%=%/run/conserved.tsv) > $@
	$(remember)
$(OUT)/mercury.png: $(here)mercury.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/axis.tsv $@
$(OUT)/frames.png: $(lastword $(runs))/end.tsv
	render -v slice -c Pressure/1MPa -r -1:1 -m polar -e 10.4cm -L 'pressure [MPa]' -P 3x1 -s 1380x480 -o $@ \
	  $(foreach k,$(frames),$(lastword $(runs))/run/snap_000$k.h5)
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative L2 error of the pressure' 'spacing [m]' $@
