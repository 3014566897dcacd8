# SPDX-License-Identifier: GPL-3.0-or-later
# Two bodies of the mass of Ceres collide, one of them with a mantle of ice: after Schaefer et al. (2016), A&A 590, A19, section 5.
#   make -f pipelines/ceres.mk                                     bodies, run, fragments, pictures, report, checks
#   make -f pipelines/ceres.mk ANGLE='15 48' SPEED='1.2 1.7' -j2   a sweep; the bodies are shared
#   make -f pipelines/ceres.mk post                                only the analysis, again, on the dumps that are there
#   make -f pipelines/ceres.mk N=200000 THETA=0.5                  as in the paper
# Killed at any point, the same command goes on. A result's path says what it is: OUT/N3000-s1/a48-v1.7/report.txt.

# particles in both bodies together: the paper's number where there is a GPU
N = $(if $(gpu),200000,3000)
# impact angle [degrees], 0 is head-on
ANGLE = 48
# impact speed [mutual escape speed at contact]
SPEED = 1.7
# distance of the centres at the start [km]
DISTANCE = 11369
# end of the run and time between snapshots [minutes], counted from the start, which lies 239 minutes before the contact
END = 2000
EVERY = 20
# of the orientation of the lattices and of the flaws
SEED = 1
# mantle: ice (flaws of Benz & Asphaug 1999) or ice_lange (the paper's, which break more easily)
ICE = ice
# opening angle of the gravity tree, or direct sums: tree, direct
THETA = 0.7
GRAVITY = tree
# steps from one evaluation of gravity to the next: with 200 000 particles four are 0.3 % of a free-fall time, with few they are too long
GRAVITY_EVERY = $(if $(gpu),$(shell [ $(N) -ge 20000 ] && echo 4 || echo 1),1)
# further settings of the solver, KEY=VALUE (solver --parameters lists them)
SET =
# fragments of fewer particles are not listed; by default the mass of the paper's 20 of 200 000, and never fewer than 5
LEAST = $(shell awk 'BEGIN { n = int(20*$(N)/200000 + 0.5); print n < 5 ? 5 : n }')
# width of the pictures of the impact [km]
EXTENT = 4500
# where everything goes
OUT = out/ceres

# ------------------------------------------------------------------------------------------------------------------------------

this := $(lastword $(MAKEFILE_LIST))
here := $(dir $(this))
include $(here)common.mk
include $(here)recipes.mk
runs := $(foreach a,$(ANGLE),$(foreach v,$(SPEED),$(OUT)/N$(N)-s$(SEED)/a$a-v$v))
pictures := cut.png damage.png end-1.png $(if $(shell command -v gnuplot),conserved.png spectrum.png masses.png)
analysis := dumps.tsv frames.txt before.tsv after.tsv fragments.h5 fragments.tsv clumps.tsv report.txt checked report.html $(pictures) end-2.png

all: $(foreach r,$(runs),$(addprefix $r/,$(pictures) checked report.html))
check: $(runs:%=%/checked)

# Both bodies, from the library, have the mass of Ceres; their particles have the same volume: (0.7/2700 + 0.3/917) to 1/2700 m^3/kg.
share = $(shell awk 'BEGIN { print int($1*$(N) + 0.5) }')
icy := ceres$(if $(filter-out ice,$(ICE)),_$(subst -,_,$(notdir $(basename $(ICE)))))
recipe.$(icy) = $(call ceres_with,$(ICE))
target := $(icy)-n$(call share,0.6129)-s$(SEED)1-squares
impactor := ceres_rock-n$(call share,0.3871)-s$(SEED)2-squares
bodies := $(call with_flaws,$(target) $(impactor))
$(call library,$(target) $(impactor))

# On the way to each other; angle and speed are read from the name a48-v1.7.
name = $(subst -v, ,$(patsubst a%,%,$(notdir $(@D))))
orbit = --angle $(firstword $(name))deg --speed $(lastword $(name))vesc $(vars)
$(call from,$(runs:%=%/start.h5),--distance $(DISTANCE)km $(bodies))
$(runs:%=%/start.h5): $(bodies)
	@mkdir -p $(@D)
	collide $(orbit) --dry-run > $(@D)/geometry.tsv
	collide $(orbit) -o $@
	$(remember)

# The run. It continues from its checkpoint when that is of the same start and the same settings, also to a later end.
settings := $(strip --every $(EVERY)min $(patsubst %,--set %,gravity.method=$(GRAVITY) gravity.theta=$(THETA) \
  gravity.every=$(GRAVITY_EVERY) output.checkpoint_every=60 $(SET)))
beyond = awk '!/^\#/ { if (!n++) t = $$2; last = $$2 } END { exit !(last > t + $(END)*60 + 1) }'
$(call from,$(runs:%=%/run/end),$(settings) --end +$(END)min)
$(runs:%=%/run/end): %/run/end: %/start.h5
	@made="$$(cksum < $<) $(settings)"; cd $*; \
	if [ "$$(cat run/made 2>/dev/null)" != "$$made" ] || $(beyond) run/conserved.tsv 2>/dev/null; \
	then rm -rf run; mkdir run; echo "$$made" > run/made; fi
	solver --restart -o $(@D) $(vars) $<
	@touch $@
	$(remember)

# The dumps, and how long after the contact each was written [min]; `post` takes those that are there.
$(runs:%=%/dumps.tsv): %/dumps.tsv: $(if $(POST),,%/run/end)
	@[ -s $*/run/snap_0000.h5 ] || { echo 'ceres.mk: no dumps in $*/run' >&2; exit 1; }
	@awk '/^snap_/ { t[$$1] = $$(NF - 1)/60 } END { for (f in t) print f "\t" t[f] }' $*/run/run.log | sort > $@
dump = $*/run/$$(awk '$1 { f = $$1 } END { print f }' $<)
title = N $(N), $(subst -v, deg$(,) ,$(patsubst a%,%,$(notdir $*))) v_esc

# Fragments: well before the contact, when the survivors have parted, at the end. Bound bodies at the end.
$(call from,$(runs:%=%/fragments.tsv),--min-particles $(LEAST))
%/before.tsv: %/dumps.tsv
	fof $(call dump,NR == 1 || $$2 < -30) > $@
%/after.tsv: %/dumps.tsv
	fof $(call dump,$$2 < 95) > $@
$(runs:%=%/fragments.tsv): %/fragments.tsv: %/dumps.tsv
	fof $(vars) -o $*/fragments.h5 $(call dump,1) > $@
	$(remember)
%/clumps.tsv: %/dumps.tsv
	clumps $(call dump,1) > $@

# The impact cut open along the plane of the orbit, in at most nine frames; the survivors at the end.
%/frames.txt: %/dumps.tsv
	@awk '$$2 > -1.2*$(EVERY) && $$2 < 95 { f[n++] = $$1 } \
	  END { for (i = 0; i < n; i += 1 + int((n - 1)/9)) print f[i] }' $< > $@
	@[ -s $@ ] || tail -n 6 $< | cut -f 1 > $@
%/cut.png: %/frames.txt
	cd $*/run; render -t '$(title)' -e $(EXTENT)km -o ../cut.png $$(cat ../frames.txt)
%/damage.png: %/frames.txt
	cd $*/run; render -t '$(title)' -e $(EXTENT)km --color Damage --range 0:1 -o ../damage.png $$(cat ../frames.txt)
%/end-1.png: %/fragments.tsv
	cd $*; for k in $$(awk '$$1 == 1 || $$1 == 2 { print $$1 }' fragments.tsv); do \
	  render -t '$(title)' -C fragment:$$k -e 1400km -s 640x480 -o end-$$k.png fragments.h5; done
%/conserved.png: %/dumps.tsv
	conserved -o $@ -t '$(title)' $*/run > $*/drifts.tsv

# The cumulative mass spectrum at the end, without the largest fragment (001 fig. 8).
%/spectrum.png: %/fragments.tsv
	histo --skip 1 -o $@ -t '$(title)' $< > $*/spectrum.tsv

# The largest bodies against time, and where in the two bodies the matter of the survivors was.
$(call from,$(runs:%=%/masses.png),--min-particles $(LEAST))
$(runs:%=%/masses.png): %/masses.png: %/dumps.tsv
	cd $*/run; track $(vars) -c ../masses.tsv -m ../provenance.h5 -o ../origin.h5 -p ../masses.png --title '$(title)' \
	  $$(cut -f 1 ../dumps.tsv) > ../objects.tsv
	$(remember)

# Dumps that were moved here without what they were made from know their orbit themselves (angles in radians).
ifdef POST
$(runs:%=%/geometry.tsv):
	info --show collision $(@D)/run/snap_0000.h5 | awk -F'\t' -v OFS='\t' \
	  '$$1 == "Collision" { print $$2, $$2 ~ /Angle|Anomaly|Obliquity/ ? $$3*45/atan2(1, 1) : $$3 }' > $@
$(runs:%=%/report.txt): %/report.txt: %/geometry.tsv
endif

# What came out, beside the paper's numbers, and what must hold. `checked` is there when it holds.
report = geometry.tsv before.tsv after.tsv fragments.tsv clumps.tsv run/conserved.tsv
%/report.txt: $(here)ceres.awk %/before.tsv %/after.tsv %/fragments.tsv %/clumps.tsv
	@awk -v run=$* -v n=$(N) -v least=$(LEAST) -v gravity=$(GRAVITY) -f $< $(report:%=$*/%) > $@
%/checked: %/report.txt
	@rm -f $@
	@cat $<
	@! grep -q '^FAILED' $<
	@touch $@

# One page with all of it, also when a check fails.
%/report.html: %/report.txt %/clumps.tsv $(addprefix %/,$(pictures))
	@cd $*; all=(); add() { [ ! -e "$$1" ] || all+=(-p "$$1:$$2"); }; \
	add cut.png 'The impact, cut open along the plane of the orbit.'; add damage.png 'Damage: 0 intact, 1 fully damaged.'; \
	add end-1.png 'The largest fragment at the end.'; add end-2.png 'The second.'; add masses.png 'The largest bodies against time.'; \
	add spectrum.png 'How many fragments are at least that massive, without the largest.'; \
	report -o report.html -t '$(title)' "$${all[@]}" -x report.txt:'Beside the numbers of the paper' \
	  -T fragments.tsv:Fragments -T clumps.tsv:'Bound bodies' run

post:
	@rm -f $(foreach r,$(runs),$(addprefix $r/,$(analysis)))
	@$(MAKE) --no-print-directory -f $(this) POST=1 all

clean:
	rm -rf $(OUT)

.PHONY: all check post clean
