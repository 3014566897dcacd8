# SPDX-License-Identifier: GPL-3.0-or-later
# Elastic waves in basalt: longitudinal and transverse (periodic box), along a strip and a rod with free sides. Speeds and convergence.
#   make -f pipelines/waves.mk [SIZE=small|medium|large]
# Exact: c_l^2 = (K + 4/3 mu)/rho, c_t^2 = mu/rho; strip (plane strain): E/((1 - nu^2) rho), thin rod: E/rho.

# particles along a wave in a plane, all of these are run; in space; along strip and rod;
# across each wave, and across strip and rod
N = $(call up_to,25 50 100,200,400)
N3 = $(call by_size,40,100,200)
N_FREE = 60
ACROSS = 8
ACROSS_FREE = 12
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/waves.png $(OUT)/convergence.png

# KIND-dD-nN: a standing wave 1 m long, v = 1e-4 c sin(2 pi x), 20 snapshots a period, for five of them (in space two).
# h is 3.09 spacings in a plane, 2.65 in space: there the kernel's sum of r grad W on this lattice is 1 to 3e-4, elsewhere off by up to 2 %, which
# makes the bulk modulus so much softer or stiffer at every resolution.
runs = $(foreach n,$(N),l-d2-n$n t-d2-n$n) l-d3-n$(N3) t-d3-n$(N3) strip-d2-n$(N_FREE) rod-d3-n$(N_FREE)
tables = $(runs:%=$(OUT)/%/wave.tsv)
c.l = 4593.288
c.t = 2899.553
c.strip = 4497.71
c.rod = 4433.08
part = $(word $1,$(subst -, ,$*))
plane = $(filter d2,$(call part,2))
speed = $(c.$(call part,1))
along = $(if $(filter t,$(call part,1)),y,x)
free = $(filter strip rod,$(call part,1))
across = $(if $(free),$(ACROSS_FREE),$(ACROSS))
count = $(patsubst n%,%,$(call part,3))
$(call from,$(runs:%=$(OUT)/%/start.h5),$(ACROSS) $(ACROSS_FREE))
$(runs:%=$(OUT)/%/start.h5): $(OUT)/%/start.h5: | $(programs)
	@mkdir -p $(@D)
	dx=$$(awk 'BEGIN { printf "%.9g", 1/$(count) }'); side=$$(awk 'BEGIN { printf "%.9g", $(across)/$(count) }')m; \
	mkshape --shape box --size 1m,$$side$(if $(plane),,$(,)$$side) -d $(if $(plane),2 --neighbours 30,3 --neighbours 78) --spacing $${dx}m --lattice grid -l basalt | \
	  alter -s 'Velocities.$(along)=1e-4*$(speed)*1m/s*sin(6.28318530718*Coordinates.x/1m)' -o $@
	$(remember)
# The box is 0 deep at the top; in a plane that is y, in space z.
faces = boundary.x=periodic $(if $(free),,boundary.y=periodic $(if $(plane),,boundary.z=periodic))
$(call from,$(tables),$(call sets,gravity.method=none strength.damage=false kernel=cubic_spline viscosity.alpha=0 viscosity.beta=0 $(SET)))
$(tables): $(OUT)/%/wave.tsv: $(OUT)/%/start.h5
	@rm -rf $(@D)/run
	w=$$(awk 'BEGIN { printf "%.9g", $(across)/$(count) }'); h=$$(awk 'BEGIN { printf "%.9g", 0.5*$(across)/$(count) }'); \
	t=$$(awk 'BEGIN { printf "%.12g", 1/$(speed)/20 }'); e=$$(awk 'BEGIN { printf "%.12g", $(if $(plane),5,2)/$(speed) }'); \
	solver -o $(@D)/run --end $$e --every $$t $(vars) $(call sets,$(faces)) \
	  --set boundary.low=-0.5,$(if $(plane),-$$w$(,)0,-$$h$(,)-$$w) --set boundary.high=0.5,$(if $(plane),0$(,)0,$$h$(,)0) $<
	for s in $(@D)/run/snap_*.h5; do columns -d 12 -f Coordinates.x -f Velocities.$(along) $$s | \
	  awk '/^#/ { next } { a += $$2*sin(6.28318530718*$$1); n++ } END { printf "%.9g\n", 2e4*a/n/$(speed) }'; done | \
	  awk '{ print (NR - 1)/20 "\t" $$1 }' > $@
	$(remember)

$(OUT)/verdict.tsv: $(here)waves.awk $(tables)
	$(call judge,waves.awk) -v errors=$(OUT)/errors.tsv $(tables) > $@
$(OUT)/waves.png: $(here)waves.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(foreach k,l-d2-n$(lastword $(N)) t-d2-n$(lastword $(N)) strip-d2-n$(N_FREE) rod-d3-n$(N_FREE),$(OUT)/$k/wave.tsv) $@
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative error of the speed' 'spacing over the wave length' $@
