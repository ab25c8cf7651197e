# From a scan to a page, as rules of make: every intermediate is a file, and only what changed is made again.
# Include this from a Makefile of your own; docs/how-to/plants.md shows a short one.
#
#   out/NAME/cropped.ply → filled.ply → sampled.ply → walls.mcap → run.mcap → page.html, picture.png
#
# A stage is a variable that holds a command: CROP, FILL, SAMPLE and WALLS read stdin and write stdout, DEM is called as
#   DEM SCENE WALLS -o RUN
# and VIEW as VIEW RUN -o PAGE. NAME.SAMPLE sets the stage of one plant, SAMPLE that of all; what is given to make wins.

PLANTS ?= plant
OUT ?= out
# Where the tools lie, if they are not on the PATH; empty where this file is installed.
BIN ?= $(wildcard $(abspath $(dir $(lastword $(MAKEFILE_LIST)))..)/target/release)
# What must be made before any stage, such as the tools.
TOOLS ?=

SHELL := /bin/bash
.SHELLFLAGS := -o pipefail -ec
ifneq ($(BIN),)
export PATH := $(abspath $(BIN)):$(PATH)
endif
.DELETE_ON_ERROR:
.SECONDEXPANSION:
.PHONY: plants clean-run FORCE $(PLANTS) $(PLANTS:%=%-pipe)

plants: $(PLANTS)

standard.CROP := cloud-crop
standard.FILL := cloud-fill
standard.DEM := dem-run
standard.VIEW := dem-view

# $(call at,PLANT,STAGE): what was given to make, else the plant's own, else that of all plants, else the standard. Nothing is taken from the environment.
set = $(filter file command override,$(firstword $(origin $(1))))
at = $(strip $(if $(filter command,$(firstword $(origin $(2)))),$($(2)),$(if $(call set,$(1).$(2)),$($(1).$(2)),$(if $(call set,$(2)),$($(2)),$(standard.$(2))))))
# A stage that is set to nothing passes its input on; one without a standard must be set.
stage = $(or $(call at,$(1),$(2)),$(if $(or $(call set,$(1).$(2)),$(call set,$(2))),cat,$(error plant $(1): $(2) is not set: give its command, such as $(1).$(2) := $(example.$(2)))))
example.SAMPLE := bluenoise-sample --spacing 0.012
example.WALLS := wallgen --roughness 0.0015 --radius uniform --material steel
scene = $(or $(call at,$(1),SCENE),$(error plant $(1): SCENE is not set: name its scene, such as $(1).SCENE := $(1).toml))

# The commands, as they run and as they are remembered.
in = $(OUT)/$(1)
do.cropped.ply = < $(call at,$(1),SCAN) $(call stage,$(1),CROP)
do.filled.ply = < $(in)/cropped.ply $(call stage,$(1),FILL)
do.sampled.ply = < $(in)/filled.ply $(call stage,$(1),SAMPLE)
do.walls.mcap = < $(in)/sampled.ply $(call stage,$(1),WALLS)
do.run.mcap = $(call at,$(1),DEM) $(call scene,$(1)) $(if $(call at,$(1),SCAN),$(in)/walls.mcap)
do.page.html = $(call at,$(1),VIEW) $(in)/run.mcap $(call at,$(1),PAGE)
do.picture.png = $(call at,$(1),VIEW) $(in)/run.mcap $(call at,$(1),PICTURE)
# In one pipe; a plant without a scan has no walls to read.
do.piped.mcap = $(if $(call at,$(1),SCAN),$(do.cropped.ply) | $(call stage,$(1),FILL) | $(call stage,$(1),SAMPLE) | $(call stage,$(1),WALLS) | )$(call at,$(1),DEM) $(call scene,$(1)) $(if $(call at,$(1),SCAN),-)

# What a command depends on: the files that it names, its program, and its words, which the stamp beside the output holds.
same = $(and $(findstring x$(1)x,x$(2)x),$(findstring x$(2)x,x$(1)x))
stamp = $(in)/.$(2).command
changed = $(if $(call same,$(strip $(call do.$(2),$(1))),$(strip $(shell cat $(stamp) 2> /dev/null))),,FORCE)
a-file = $(if $(wildcard $(1)/.),,$(wildcard $(1)))
words-of = $(filter-out < -%,$(subst =, ,$(subst ', ,$(1))))
named = $(foreach word,$(call words-of,$(1)),$(call a-file,$(word)) $(if $(BIN),$(call a-file,$(BIN)/$(word))))
# The drawings and tables that a scene reads lie beside it.
drawings = $(wildcard $(addprefix $(dir $(1)),$(shell grep -oE '"[^" :,]+\.(ply|stl|obj|csv|mcap|toml)"' $(1) 2> /dev/null | tr -d '"')))
needs = $(filter-out $(in)/$(2),$(call named,$(call do.$(2),$(1)))) $(call changed,$(1),$(2))

plant = $(notdir $(@D))
command = $(call do.$(@F),$(plant))
quoted = '$(subst ','\'',$(strip $(command)))'
remember = $(if $(call option,n),,printf '%s\n' $(quoted) > $(@D)/.$(@F).command)
# Several makes may share OUT: one makes a file, and the others wait and find it made, by the same rules as make has. The system ends the lock of
# a make that is killed, when the programs have ended that it has started (flock; a machine without it has no lock).
option = $(findstring $(1),$(firstword -$(MAKEFLAGS)))
made = [ -e $@ ] && printf '%s\n' $(quoted) | cmp -s - $(@D)/.$(@F).command $(foreach file,$(filter-out FORCE,$^),&& [ ! $(file) -nt $@ ])
# make -n shows the command alone.
once = $(if $(call option,n),,$(locked))
define locked
mkdir -p $(@D); exec 9>> $(@D)/.$(@F).lock; \
if command -v flock > /dev/null && ! flock -n 9; then echo '$@: another make makes it: waiting' >&2; flock 9; fi; \
$(if $(call option,B),,if $(made); then exit 0; fi;) $(if $(call option,s),,printf '%s\n' $(quoted);)
endef
all = $(PLANTS:%=$(OUT)/%/$(1))
SCANNED := $(foreach plant,$(PLANTS),$(if $(call at,$(plant),SCAN),$(plant)))
scanned = $(SCANNED:%=$(OUT)/%/$(1))
define to-stdout
@$(once) $(command) > $@.new; mv -f $@.new $@; $(remember)
endef
define to-file
@$(once) $(command) -o $@; $(remember)
endef

$(call scanned,cropped.ply): $(OUT)/%/cropped.ply: $$(call at,$$*,SCAN) $$(call needs,$$*,cropped.ply) | $(TOOLS)
	$(to-stdout)
$(call scanned,filled.ply): $(OUT)/%/filled.ply: $(OUT)/%/cropped.ply $$(call needs,$$*,filled.ply) | $(TOOLS)
	$(to-stdout)
$(call scanned,sampled.ply): $(OUT)/%/sampled.ply: $(OUT)/%/filled.ply $$(call needs,$$*,sampled.ply) | $(TOOLS)
	$(to-stdout)
$(call scanned,walls.mcap): $(OUT)/%/walls.mcap: $(OUT)/%/sampled.ply $$(call needs,$$*,walls.mcap) | $(TOOLS)
	$(to-stdout)

# A run that is stopped stays as unfinished.mcap, which --resume continues and dem-view shows.
$(call all,run.mcap): $(OUT)/%/run.mcap: $$(if $$(call at,$$*,SCAN),$(OUT)/$$*/walls.mcap) $$(call drawings,$$(call scene,$$*)) $$(call needs,$$*,run.mcap) | $(TOOLS)
	@$(once) $(command) -o $(@D)/unfinished.mcap; mv -f $(@D)/unfinished.mcap $@; $(remember)

$(call all,page.html): $(OUT)/%/page.html: $(OUT)/%/run.mcap $$(call needs,$$*,page.html) | $(TOOLS)
	$(to-file)

$(call all,picture.png): $(OUT)/%/picture.png: $(OUT)/%/run.mcap $$(call needs,$$*,picture.png) | $(TOOLS)
	$(to-file)

$(PLANTS): %: $(OUT)/%/page.html $(OUT)/%/picture.png

# The same in one pipe, with no file between: the same bytes.
$(PLANTS:%=%-pipe): %-pipe: | $(TOOLS)
	@mkdir -p $(OUT)/$*
	$(call do.piped.mcap,$*) -o $(OUT)/$*/piped.mcap

clean-run: ## remove the runs and their pages, and keep the walls
	rm -f $(foreach file,run.mcap piped.mcap unfinished.mcap page.html picture.png .run.mcap.command .page.html.command .picture.png.command,$(call all,$(file)))
