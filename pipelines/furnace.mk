# A bell-less blast furnace, from conveyor to burden: docs/how-to/furnace.md.
#
#   scan → chute.mcap;  plant.toml → upstream.toml, downstream.toml
#   seed-N: upstream.mcap → inlet.mcap → one downstream run for each tilt programme, and one on the chute that the first has worn

FURNACE := $(OUT)/furnace
# Seeds of what the conveyor brings; intervals need several.
FURNACE_SEEDS ?= 1
PROGRAMMES := inwards outwards apart
FURNACE_FOLDERS := $(FURNACE_SEEDS:%=$(FURNACE)/seed-%)
# The flow gate is at z = 0.72 m, and what hangs below it is at 0.62 m free.
FURNACE_CUT := 0,0,0.62,0,0,-1
CHUTE_WALL := cloud-crop $(SAMPLES)/chute/chute.ply --remove halfspace:0,0,0,-0.766,0,0.643 --remove halfspace:1.11,0,-0.932,0.766,0,-0.643 \
	| cloud-fill --for-spacing 0.05 | bluenoise-sample --spacing 0.05 \
	| wallgen --radius solve --facing 0.643,0,0.766 --material steel --smallest-particle 0.08
RADIAL := --radial 0,0,-2.6,0,0,1 --bins 6 --outer 1.8
FURNACE_BUILD := build-furnace

.PHONY: furnace furnace-study furnace-explain furnace-full build-furnace
# Long runs are kept, also those that another file is made from.
.SECONDARY: $(foreach f,$(FURNACE_FOLDERS),$(patsubst %,$(f)/%.mcap,upstream inlet undivided $(PROGRAMMES) worn) $(f)/wear.csv)
build-furnace:
	$(call cargo,the tools of the furnace,$(addprefix -p ,$(MAIN_JOB) stage-split stage-replay dem-measure))
furnace: $(FURNACE)/profile.md $(FURNACE)/page.html $(FURNACE)/picture.png ## a blast furnace charged from conveyor to burden: one run upstream, three tilt programmes downstream, a worn chute (a few minutes)
	@cat $(FURNACE)/profile.md
	@echo "page     $(abspath $(FURNACE))/page.html"
	@echo "picture  $(abspath $(FURNACE))/picture.png"

$(FURNACE)/chute.mcap: $(SAMPLES)/chute/chute.ply | $(FURNACE_BUILD)
	@mkdir -p $(FURNACE)
	$(CHUTE_WALL) --roughness 0.008 -o $@
$(FURNACE)/upstream.toml $(FURNACE)/downstream.toml: $(FURNACE)/%.toml: furnace/plant.toml $(wildcard furnace/*.ply) $(FURNACE)/chute.mcap | $(FURNACE_BUILD)
	stage-split $< --at $(FURNACE_CUT) --keep $* -o $@
$(FURNACE)/seed-%/upstream.mcap: $(FURNACE)/upstream.toml
	@mkdir -p $(@D)
	dem-run $< --set insert.0.seed=$* --set insert.1.seed=$* --threads 1 -o $@
$(FURNACE)/seed-%/inlet.mcap: $(FURNACE)/seed-%/upstream.mcap
	stage-replay $< --keep-times -o $@

# The chute among the walls of the downstream stage; a tilt programme is one key of it.
CHUTE = wall.$(shell awk '/^\[\[wall\]\]/ { n++ } /^name = "chute"/ { print n - 1 }' $(FURNACE)/downstream.toml)
TILT = --set $(CHUTE).motion.0.path.source=$(abspath furnace)/tilt-$(1).csv
define programme
$(FURNACE)/seed-%/$(1).mcap: $(FURNACE)/seed-%/inlet.mcap $(FURNACE)/downstream.toml furnace/tilt-$(1).csv
	dem-run $(FURNACE)/downstream.toml $$< $$(call TILT,$(1)) $(2) --threads 1 -o $$@
endef
$(eval $(call programme,inwards,--set output.contacts=true))
$(eval $(call programme,outwards))
$(eval $(call programme,apart))

# Wear of the chute → roughness → walls → the next charge.
$(FURNACE)/seed-%/wear.csv: $(FURNACE)/seed-%/inwards.mcap
	dem-measure $< --wear all --wall chute -o $@ --plot $(@D)/wear.png
$(FURNACE)/chute-worn.mcap: $(FURNACE)/seed-1/wear.csv furnace/roughness.toml furnace/wear-table.csv
	$(CHUTE_WALL) --roughness furnace/roughness.toml -o $@
$(FURNACE)/seed-%/worn.mcap: $(FURNACE)/seed-%/inlet.mcap $(FURNACE)/chute-worn.mcap
	dem-run $(FURNACE)/downstream.toml $< $(call TILT,inwards) --set $(CHUTE).source=$(abspath $(FURNACE))/chute-worn.mcap --threads 1 -o $@
# The undivided plant, to compare with.
$(FURNACE)/seed-%/undivided.mcap: furnace/plant.toml $(FURNACE)/chute.mcap
	@mkdir -p $(@D)
	dem-run $< --set insert.0.seed=$* --set insert.1.seed=$* --threads 1 -o $@

$(FURNACE)/seed-%.csv: $(FURNACE)/seed-%.mcap
	dem-measure $< $(RADIAL) -o $@ --plot $(@:.csv=.svg)
FURNACE_RUNS := $(PROGRAMMES) worn
$(FURNACE)/profile.md: $(foreach f,$(FURNACE_FOLDERS),$(FURNACE_RUNS:%=$(f)/%.csv)) furnace/profile.sh
	furnace/profile.sh $(FURNACE_RUNS) -- $(FURNACE_FOLDERS) > $@
$(FURNACE)/page.html: $(FURNACE)/seed-1/inwards.mcap
	dem-view $< --colour material -o $@
$(FURNACE)/picture.png: $(FURNACE)/seed-1/upstream.mcap $(FURNACE)/seed-1/inwards.mcap
	dem-view $^ --time 9.5 --camera front --cut --colour material --size 700x1000 -o $@

furnace-study: $(foreach f,$(FURNACE_FOLDERS),$(patsubst %,$(f)/%.csv,undivided $(FURNACE_RUNS))) ## the same with the undivided plant beside it; writes the tables of docs/how-to/furnace.md (FURNACE_SEEDS="1 2 3")
	furnace/profile.sh undivided $(FURNACE_RUNS) -- $(FURNACE_FOLDERS) > $(FURNACE)/study.md
	stages/section.sh ../docs/how-to/furnace.md profile < $(FURNACE)/study.md

# The full form: its drawings, its chute, and what it takes.
FULL := $(OUT)/furnace-full
$(FULL)/hopper-A.ply: RINGS := -0.45,0,5.40,0.30 -0.45,0,5.55,0.30 -1.70,0,7.6,1.62 -1.75,0,9.9,1.68
$(FULL)/hopper-B.ply: RINGS := 0.45,0,5.40,0.30 0.45,0,5.55,0.30 1.70,0,7.6,1.62 1.75,0,9.9,1.68
$(FULL)/storage.ply: RINGS := 0,0,0.80,0.30 0,0,1.0,0.30 0,0,2.9,1.7 0,0,5.0,1.7
$(FULL)/throat.ply: RINGS := 0,0,-5.2,4.6 0,0,-1.8,4.6
$(FULL)/stock-line.ply: RINGS := 0,0,-4.5,4.7 0,0,-5.4,0.001
$(FULL)/%.ply: furnace/geometry.sh
	@mkdir -p $(FULL)
	furnace/geometry.sh $(RINGS) > $@
$(FULL)/chute.mcap: $(SAMPLES)/chute/chute.ply | $(FURNACE_BUILD)
	@mkdir -p $(FULL)
	cloud-crop $< --remove halfspace:0,0,0,-0.766,0,0.643 | cloud-fill --for-spacing 0.012 | bluenoise-sample --spacing 0.012 \
	  | wallgen --radius uniform --roughness 0.0015 --facing 0.643,0,0.766 --material steel --smallest-particle 0.015 -o $@
FULL_PARTS := $(FULL)/chute.mcap $(patsubst %,$(FULL)/%.ply,hopper-A hopper-B storage throat stock-line)
furnace-explain: $(FULL_PARTS) ## print what the full form, a million grains, would take
	dem-run furnace/full.toml --explain
furnace-full: $(FULL_PARTS) ## run the full form, upstream and downstream at once (a GPU or weeks; see furnace-explain)
	for k in upstream downstream; do stage-split furnace/full.toml --at 0,0,0.64,0,0,-1 --keep $$k -o $(FULL)/$$k.toml; done
	dem-run $(FULL)/upstream.toml | tee $(FULL)/upstream.mcap | stage-replay --keep-times | dem-run $(FULL)/downstream.toml - -o $(FULL)/downstream.mcap
