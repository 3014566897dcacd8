# SPDX-License-Identifier: GPL-3.0-or-later
# A viscous ring spreads around a mass it circles, 2D: surface density against the exact solution, for a constant viscosity and alpha c H.
#   make -f pipelines/ring.mk [SIZE=small|medium|large]
# Lynden-Bell & Pringle (1974), MNRAS 168, 603; Speith & Kley (2003), A&A 399, 395. G = M = R = 1, ring of mass 1 without a pull of its own.
# nu = 3e-4 r^g: tau = 12 nu t (g = 0) from 0.018 to 0.05, or 3 nu t (alpha c H, g = 1) over a quarter of that: 1.4 turns.

# spacing of the particles; all of these are run
DX = $(call up_to,0.04 0.028,0.02,0.01)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/ring.png $(OUT)/frames.png $(OUT)/convergence.png

laws = constant alpha
runs = $(foreach l,$(laws),$(DX:%=$(OUT)/$l-%))
part = $(word $1,$(subst -, ,$*))
# Cold gas (c = 0.02: particles keep their distances, and its pressure bears 1 % at the edges), and the mass in the middle.
$(OUT)/gas.cfg:
	@mkdir -p $(@D)
	echo 'name = "cold_gas"; eos = { form = "isothermal"; c = "0.02 m/s"; };' > $@
$(OUT)/run.cfg:
	@mkdir -p $(@D)
	echo 'point_masses = ( { mass = 1.0; fixed = true; } );' > $@
# Surface density of the solution (Bessel functions of order 1/4 for large arguments; of order 1/2, which is sinh) its slope, radial velocity
# at the start.
r = (Radius/1m)
shape.constant = exp(-($r - 1)^2/0.018)/(3.14159265358979*0.018)/sqrt(4*3.14159265358979*$r/0.018)/$r^0.25*(1 + 0.75*0.018/(16*$r) + 3.28125*(0.018/(16*$r))^2)
slope.constant = (2*(1 - $r)/0.018 - 0.75/$r)
inward.constant = 3*3e-4*(2*(1 - $r)/0.018 - 0.25/$r - 0.75*0.018/(16*$r^2))
shape.alpha = exp(-(sqrt($r) - 1)^2/0.0045)/(4*3.14159265358979*0.0045)*sqrt(0.0045/3.14159265358979)/$r^1.5
slope.alpha = ((1/sqrt($r) - 1)/0.0045 - 1.5/$r)
inward.alpha = 3*3e-4*(sqrt($r) - $r)/0.0045
$(runs:%=%/start.h5): $(OUT)/%/start.h5: $(OUT)/gas.cfg | $(programs)
	@mkdir -p $(@D)
	mkshape -d 2 --shape ring --size 0.68m,1.34m --spacing $(call part,2)m --lattice grid --neighbours 40 -l $<:rho=1 | \
	  alter -s 'Radius=|Coordinates|' -s 'Density=$(shape.$(call part,1))*1kg/m^3' -s 'Masses=Masses*Density/1kg*1m^3' -s 'w=sqrt(max($r^(-3) + 0.0004*$(slope.$(call part,1))/$r, 0))/1s' -s 'inward=($(inward.$(call part,1)))/$r/1s' \
	    -s 'Velocities.x=-w*Coordinates.y - inward*Coordinates.x' -s 'Velocities.y=w*Coordinates.x - inward*Coordinates.y' > $@
# The light particles at the edges feel the viscosity of heavy ones: steps are half as long as else.
viscosity.constant = viscosity.kinematic=3e-4
viscosity.alpha = viscosity.shakura_sunyaev=0.15 viscosity.aspect=0.1
$(foreach l,$(laws),$(call from,$(DX:%=$(OUT)/$l-%/end.tsv),--end 8.888889 --every 2.222222 $(call sets,gravity.method=none gravity.G=1 energy=frozen kernel=wendland_c4 \
  step.cfl=0.2 viscosity.alpha=0.03 viscosity.beta=0 $(viscosity.$l) $(SET))))
$(runs:%=%/end.tsv): $(OUT)/%/end.tsv: $(OUT)/%/start.h5 $(OUT)/run.cfg
	@rm -rf $(@D)/run
	solver -c $(OUT)/run.cfg -o $(@D)/run $(vars) $<
	for k in 0 2 4; do columns -f $$k/4 -f $(call part,2) -f '|Coordinates|' -f Masses $(@D)/run/snap_000$$k.h5; done > $@
	$(remember)

$(call from,$(OUT)/verdict.tsv,$(runs))
$(OUT)/verdict.tsv: $(here)ring.awk $(runs:%=%/end.tsv)
	$(call judge,ring.awk) -v errors=$(OUT)/errors.tsv -v curves=$(OUT)/curves.tsv $(foreach r,$(vars),$r/end.tsv $r/run/conserved.tsv) > $@
	$(remember)
$(OUT)/ring.png: $(here)ring.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/curves.tsv $@
$(OUT)/frames.png: $(OUT)/verdict.tsv
	render -v slice -c Density -r 0:2 -e 3m -P 3x1 -s 1440x480 -o $@ $(foreach k,0 2 4,$(OUT)/constant-$(lastword $(DX))/run/snap_000$k.h5)
$(OUT)/convergence.png: $(here)convergence.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/errors.tsv 'relative L1 error of the surface density' spacing $@
