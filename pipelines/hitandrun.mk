# SPDX-License-Identifier: GPL-3.0-or-later
# The collision of two bodies of the mass of Ceres (ceres.mk) on the orbit of the paper, judged: orbit, survivors, ice, damage, drifts.
#   make -f pipelines/hitandrun.mk [SIZE=small|medium|large]
# Schaefer et al. (2016), A&A 590, A19, section 5 and table 3. Its start (11 369 km, b 819 km, 744 m/s) leads to 46.2 degrees and 1.731
# v_esc at contact (it prints 48 and 1.7); its ice breaks more easily than that of Benz & Asphaug (1999).

# particles in both bodies
N = $(call by_size,800,20000,200000)
# end [minutes after the start; contact is at 234], opening angle of the gravity tree
END = 2000
THETA = 0.5
# further settings of the solver, KEY=VALUE
SET =

# ------------------------------------------------------------------------------------------------------------------------------

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)lab.mk
pictures = $(OUT)/cut.png $(OUT)/damage.png $(OUT)/masses.png $(OUT)/spectrum.png
study = N$(N)-s1/a46.2-v1.731
results = geometry.tsv fragments.tsv after.tsv run/conserved.tsv
copies = $(if $(shell command -v gnuplot),cut.png damage.png masses.png spectrum.png)

$(call from,$(OUT)/report.txt,N=$(N) END=$(END) THETA=$(THETA) SET="$(strip $(SET))" ANGLE=46.2 SPEED=1.731 ICE=ice_lange)
$(OUT)/report.txt: | $(programs)
	@mkdir -p $(@D)
	$(MAKE) --no-print-directory -f $(here)ceres.mk OUT=$(OUT)/ceres $(vars) $(patsubst %,$(OUT)/ceres/$(study)/%,report.txt $(copies))
	cp $(patsubst %,$(OUT)/ceres/$(study)/%,report.txt $(copies)) $(OUT)
	$(remember)
$(OUT)/verdict.tsv: $(here)hitandrun.awk $(OUT)/report.txt
	$(call judge,hitandrun.awk) -v n=$(N) $(results:%=$(OUT)/ceres/$(study)/%) > $@
$(pictures): $(OUT)/verdict.tsv
