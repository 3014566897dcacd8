# SPDX-License-Identifier: GPL-3.0-or-later
# Kelvin-Helmholtz instability, 2D, periodic: how fast a shear layer of uniform density rolls up; pictures of one of density 2 to 1.
#   make -f pipelines/kelvinhelmholtz.mk [SIZE=small|medium|large]
# Layers y = +-1/4 of half-width d between streams of +-1/2, pressure 2.5, gamma 5/3, disturbed with wave number 4 pi. Where v is linear across the
# layer, sigma = U/(2 d) sqrt(exp(-4 k d) - (1 - 2 k d)^2) (Rayleigh 1880; Chandrasekhar 1961, Hydrodynamic and Hydromagnetic Stability, ch. 11).

# particles along an edge of the box of edge 1
N = $(call by_size,64,192,512)
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/growth.png $(OUT)/contrast.png

d = 0.0317m
y = Coordinates.y
# v_x = -1/2 outside, 1/2 between the layers; the bumps are as wide as SWIFT's test has them
stream = max(-0.5, min(0.5, (0.25m - abs($y))/(2*$d)))
bumps = exp(-($y - 0.25m)^2/(32*($d)^2)) + exp(-($y + 0.25m)^2/(32*($d)^2))
box = mkshape -d 2 --shape box --size 1m,1m --spacing $$(awk 'BEGIN { printf "%.12g", 1/$(N) }')m --neighbours 60 --lattice grid -l gas:rho=1 | \
  alter -s 'Coordinates.y=Coordinates.y + 0.5m'
$(call from,$(OUT)/growth.h5 $(OUT)/contrast.h5,$(N))
$(OUT)/growth.h5: | $(programs)
	@mkdir -p $(@D)
	$(box) -s 'InternalEnergy=3.75J/kg' -s 'Velocities.x=1m/s*($(stream))' -s 'Velocities.y=0.01m/s*sin(4*3.14159265358979*Coordinates.x/1m)*($(bumps))' > $@
	$(remember)
$(OUT)/contrast.h5: | $(programs)
	@mkdir -p $(@D)
	$(box) -s 'BodyID=abs($y) < 0.25m' -s 'Density=Density*(1 + BodyID)' -s 'Masses=Masses*(1 + BodyID)' -s 'InternalEnergy=3.75J/kg/(1 + BodyID)' \
	  -s 'Velocities.x=1m/s*(BodyID - 0.5)' -s 'Velocities.y=0.1m/s*sin(4*3.14159265358979*Coordinates.x/1m)*($(bumps))' > $@
	$(remember)

settings = $(call sets,gravity.method=none precision=double kernel=wendland_c4 viscosity.balsara=true boundary.x=periodic boundary.y=periodic \
  boundary.low=-0.5$(,)-0.5$(,)0 boundary.high=0.5$(,)0.5$(,)0 $(SET))
# The disturbance: sums of v_y sin(kx), v_y cos(kx) within one half-width of the layers.
k = 4*3.14159265358979*Coordinates.x/1m
$(call from,$(OUT)/growth.tsv,--end 1.2 --every 0.05 $(call sets,density=sum) $(settings))
$(OUT)/growth.tsv: $(OUT)/growth.h5
	$(call run,$(@D)/growth)
	for f in $(@D)/growth/snap_*.h5; do t=$${f##*_}; t=$${t%.h5}; \
	  columns -w 'abs(abs($y) - 0.25m) < $d' -f 'Velocities.y*sin($k)' -f 'Velocities.y*cos($k)' $$f | \
	    awk -v t=$$((10#$$t)) '!/^#/ { s += $$1; c += $$2; n++ } END { printf "%.2f\t%.8g\n", 0.05*t, 2*sqrt(s*s + c*c)/n }'; done > $@
	$(remember)
forms = squares product miscible
form.squares = pressure_form=squares
form.product = pressure_form=product
form.miscible = density=miscible
contrasts = $(forms:%=$(OUT)/%/conserved.tsv)
$(foreach f,$(forms),$(call from,$(OUT)/$f/conserved.tsv,--end 2.122 --every 1.061 $(call sets,$(form.$f)) $(settings)))
$(contrasts): $(OUT)/contrast.h5
	$(call run,$(@D))
	$(remember)

$(OUT)/verdict.tsv: $(here)kelvinhelmholtz.awk $(OUT)/growth.tsv $(contrasts)
	$(call judge,kelvinhelmholtz.awk) -v n=$(N) $(OUT)/growth.tsv $(OUT)/growth/conserved.tsv $(contrasts) > $@
$(OUT)/growth.png: $(here)kelvinhelmholtz.gp $(OUT)/verdict.tsv
	gnuplot -c $< $(OUT)/growth.tsv $@
$(OUT)/contrast.png: $(OUT)/verdict.tsv
	render -v slice -c Density -r 0.9:2.1 -e 1m -P 3x2 -s 1440x960 -o $@ $(forms:%=$(OUT)/%/snap_0001.h5) $(forms:%=$(OUT)/%/snap_0002.h5)
