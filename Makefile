# What can be done here: `make help`. Needs a Rust toolchain and make.

# With no folder named, the gallery's scenes are rendered too.
ifeq ($(origin SCENES),undefined)
GALLERY := $(wildcard scenes/gallery)
endif
SCENES ?= scenes
OUT    ?= renders
CARGO  ?= cargo
FLAGS  ?=
SELF   := $(firstword $(MAKEFILE_LIST))

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:
.PHONY: all build renders images names gallery turntable test hard faults crosscheck lint bench yardstick honesty study assets schema install clean help FORCE

# The program: built here, unless another one is named.
ifeq ($(origin TERRARIUM),undefined)
TERRARIUM := $(or $(CARGO_TARGET_DIR),target)/release/terrarium
$(TERRARIUM): FORCE
	@$(CARGO) build --release --locked
endif

## all: build, and render scenes/terrarium.ron to renders/terrarium.png and .exr
all: build
	+@$(MAKE) -f '$(SELF)' --no-print-directory SCENES=scenes OUT='$(OUT)' '$(OUT)/terrarium.exr' '$(OUT)/terrarium.png'

## build: build the program
build: $(TERRARIUM)

## renders: render every scene of SCENES (default: scenes and scenes/gallery) to OUT (default: renders), only what changed
renders: build names
	@rm -rf '$(OUT)/.failed'
	+@$(MAKE) -f '$(SELF)' --no-print-directory -k images || { \
	    echo >&2; \
	    for scene in '$(OUT)'/.failed/*; do \
	        if [ -e "$$scene" ]; then echo "failed: $$(cat "$$scene")" >&2; fi; \
	    done; \
	    exit 1; }

# Scenes are the .ron and .toml files of the folder itself; subfolders hold what scenes include.
FOUND  := $(sort $(foreach folder,$(SCENES) $(GALLERY),$(wildcard $(folder)/*.ron $(folder)/*.toml)))
STEMS  := $(sort $(basename $(notdir $(FOUND))))
IMAGES := $(foreach stem,$(STEMS),$(OUT)/$(stem).exr $(OUT)/$(stem).png)

## images: the same without the list of failed scenes at the end; stops at the first of them
images: $(IMAGES)

# Refuses what make can't handle: names with special characters, and two scenes for one image.
names:
	@case '$(SCENES)$(OUT)' in *[!A-Za-z0-9._/+@,=-]*) \
	    echo "make: SCENES and OUT may hold letters, digits and . _ - + @ , = only: rename the folder" >&2; \
	    exit 2;; esac
	@[ -d '$(SCENES)' ] || { echo "make: there is no folder $(SCENES)" >&2; exit 2; }
	@[ -n '$(FOUND)' ] || echo "make: no scene (.ron, .toml) is in $(SCENES)" >&2
	@twins=; for scene in $(foreach folder,$(SCENES) $(GALLERY),'$(folder)'/*.ron '$(folder)'/*.toml); do \
	    [ -e "$$scene" ] || continue; \
	    case "$${scene##*/}" in *[!A-Za-z0-9._+@,=-]*) \
	        echo "make: $$scene: a scene's name may hold letters, digits and . _ - + @ , = only: rename it" >&2; \
	        exit 2;; esac; \
	    case "$$scene" in *.ron) if [ -e "$${scene%.ron}.toml" ]; then twins="$$twins $$scene"; fi;; esac; \
	done; \
	for scene in $$twins; do \
	    echo "make: $$scene and $${scene%.ron}.toml would be the same image: rename one" >&2; \
	done; [ -z "$$twins" ] || exit 2
	@for stem in $(filter $(basename $(notdir $(wildcard $(SCENES)/*.ron $(SCENES)/*.toml))),$(if $(GALLERY),$(basename $(notdir $(wildcard $(GALLERY)/*.ron $(GALLERY)/*.toml))))); do \
	    echo "make: $$stem of $(SCENES) and of $(GALLERY) would be the same image: rename one" >&2; exit 2; \
	done

# Several renders at once share the terminal: no bars then.
PROGRESS = $(if $(filter -j% --jobserver%,$(MAKEFLAGS)),--progress none)

# Renders scene $< to both images. A failing scene is remembered by name.
define render
	@mkdir -p '$(OUT)/.deps' && rm -f '$(OUT)/.failed/$(notdir $<)'
	@'$(TERRARIUM)' render '$<' -o '$(OUT)/$*.exr' -o '$(OUT)/$*.png' \
	    --depfile '$(OUT)/.deps/$*.d' $(PROGRESS) $(FLAGS) \
	|| { code=$$?; mkdir -p '$(OUT)/.failed' && echo '$<' > '$(OUT)/.failed/$(notdir $<)'; exit $$code; }
endef

$(OUT)/%.exr: $(SCENES)/%.ron $(TERRARIUM)
	$(render)

$(OUT)/%.exr: $(SCENES)/%.toml $(TERRARIUM)
	$(render)

ifneq ($(GALLERY),)
$(OUT)/%.exr: $(GALLERY)/%.ron $(TERRARIUM)
	$(render)

$(OUT)/%.exr: $(GALLERY)/%.toml $(TERRARIUM)
	$(render)
endif

# The PNG comes with the EXR; alone only if it was deleted alone.
$(OUT)/%.png: $(OUT)/%.exr
	@if [ ! -e '$@' ] || [ '$@' -ot '$<' ]; then \
	    '$(TERRARIUM)' render '$(firstword $(filter %/$*.ron %/$*.toml,$(FOUND)))' -o '$@' \
	        $(PROGRESS) $(FLAGS); fi

# Which meshes, textures and included files each image depends on.
-include $(wildcard $(OUT)/.deps/*.d)

## gallery: render the pictures of docs/gallery.md that have changed, and write that page; DRAFT=1 for small ones to renders/draft, AGAIN=1 for all
gallery: build
	@command -v python3 >/dev/null || { echo "make gallery needs python3" >&2; exit 2; }
	@TERRARIUM="$(abspath $(TERRARIUM))" PYTHONDONTWRITEBYTECODE=1 python3 benches/gallery.py \
	    $(if $(DRAFT),--draft) $(if $(AGAIN),--again)

# The frames of the turntable, how they are rendered, and the kind of the film.
FRAMES ?= 1-48
TURN   ?= --set image.width=320 --set image.height=180 --set photons.count=200000 --passes 24
FORMAT ?= gif
TURNTABLE  := $(OUT)/turntable

## turntable: the frames of the terrarium as it turns, small, and a film of them where ffmpeg or Python's PIL is; FORMAT=webp or mp4, TURN='--passes 64' for how they are rendered
turntable: build
	@mkdir -p '$(TURNTABLE)'
	'$(TERRARIUM)' render scenes/terrarium.ron --frames '$(FRAMES)' -o '$(TURNTABLE)/####.png' $(TURN) $(FLAGS)
	@if command -v ffmpeg >/dev/null; then \
	    ffmpeg -nostdin -loglevel error -y -framerate 12 -pattern_type glob -i '$(TURNTABLE)/*.png' \
	        $(if $(filter mp4,$(FORMAT)),-pix_fmt yuv420p,-loop 0) '$(TURNTABLE).$(FORMAT)' && echo 'wrote $(TURNTABLE).$(FORMAT)'; \
	elif [ '$(FORMAT)' != mp4 ] && python3 -c 'import PIL' 2>/dev/null; then \
	    python3 '$(dir $(SELF))benches/film.py' '$(TURNTABLE)' '$(TURNTABLE).$(FORMAT)' 12; \
	else \
	    echo "the frames are in $(TURNTABLE); a film of them needs ffmpeg$(if $(filter mp4,$(FORMAT)),, or Python's PIL)"; \
	fi

## test: build and run every test
test:
	$(CARGO) test --release --locked --lib --bins --tests

# Where the rows of the hard cases are gathered.
HARD := $(or $(CARGO_TARGET_DIR),target)/hard-cases

## hard: every hard case at full size, and docs/hard-cases.md from what was measured; and `make faults`; takes a while
hard:
	@rm -rf '$(HARD)' && mkdir -p '$(HARD)'
	-HARD_CASES=full HARD_CASES_OUT='$(abspath $(HARD))' \
	    $(CARGO) test --release --locked --test all -- hard_cases:: --test-threads=2 \
	    --skip table:: --skip record::
	@HARD_CASES_OUT='$(abspath $(HARD))' \
	    $(CARGO) test --release --locked --test all -- --ignored --exact hard_cases::table::write_the_page
	@$(MAKE) --no-print-directory faults

## faults: renders killed 200 times at random moments, and at each of their writes (needs strace); shards 1 to 7
faults: build
	KILLS=200 $(CARGO) test --release --locked --test all -- batch::resume::a_render_that_is_killed batch::merge::
	@command -v python3 >/dev/null || { echo "make faults: the writes are skipped: no python3"; exit 0; }; \
	    TERRARIUM="$(abspath $(TERRARIUM))" PYTHONDONTWRITEBYTECODE=1 python3 tests/faults.py

## crosscheck: scenes rendered by Mitsuba 3 too, and docs/crosscheck.md; needs python3 with mitsuba (PYTHON=...), else it is skipped
PYTHON ?= python3
crosscheck: build
	@command -v '$(PYTHON)' >/dev/null || { echo "make crosscheck: skipped: there is no $(PYTHON)"; exit 0; }; \
	    TERRARIUM="$(abspath $(TERRARIUM))" PYTHONDONTWRITEBYTECODE=1 '$(PYTHON)' benches/crosscheck.py

## lint: formatting and clippy, without a warning
lint:
	$(CARGO) fmt --check
	$(CARGO) clippy --release --locked --all-targets -- -D warnings

## bench: time the kernels and compare with other renderers, where they are installed
bench:
	$(CARGO) bench --locked
	@if [ -x benches/run ]; then benches/run; fi

## yardstick: the error of two scenes against time, with the goals that are met and missed
yardstick: build
	@command -v python3 >/dev/null || { echo "make yardstick needs python3" >&2; exit 2; }
	@TERRARIUM="$(abspath $(TERRARIUM))" PYTHONDONTWRITEBYTECODE=1 python3 benches/yardstick.py

## honesty: whether renders tell the truth about their error; takes long
honesty: build
	@command -v python3 >/dev/null || { echo "make honesty needs python3" >&2; exit 2; }
	@TERRARIUM="$(abspath $(TERRARIUM))" PYTHONDONTWRITEBYTECODE=1 python3 benches/honesty.py

# Time for each scene.
STUDY_TIME ?= 10min
STUDY = '$(TERRARIUM)' study --time $(STUDY_TIME)

## study: accuracy against time in six studies, to study/, and their plots to docs/images/; takes an hour
study: build
	$(STUDY) scenes/yardstick/caustic-sphere.ron -o study/caustic-sphere --set image.width=128 --set image.height=128
	$(STUDY) scenes/yardstick/caustic-sphere.ron -o study/caustic --set image.width=128 --set image.height=128 \
	    --only caustics --knobs passes
	$(STUDY) scenes/gallery/soft_shadows.ron -o study/direct --set image.width=200 --set image.height=113 \
	    --without caustics --knobs passes,antialiasing
	$(STUDY) scenes/terrarium.ron -o study/terrarium --set image.width=240 --set image.height=135 \
	    --set 'photons=progressive(count:50000)'
	$(STUDY) scenes/gallery/antialiasing.ron -o study/antialiasing --without caustics --seeds 2 \
	    --knobs antialiasing,threshold,depth
	$(STUDY) scenes/yardstick/primitives.ron -o study/primitives --set 'antialiasing=adaptive(threshold:0.05,depth:2)' \
	    --seeds 2 --knobs antialiasing,threshold,depth
	@mkdir -p docs/images
	@for name in caustic-sphere caustic direct terrarium antialiasing primitives; do \
	    cp "study/$$name/plot.png" "docs/images/study-$$name.png" || exit 1; done
	@if command -v python3 >/dev/null; then python3 benches/study_pages.py; fi

## assets: make the meshes and textures anew, by assets/generator
assets:
	$(CARGO) run --release --locked --example assets

## schema: write terrarium.schema.json, for completion in editors
schema: build
	@'$(TERRARIUM)' schema > terrarium.schema.json.tmp && mv terrarium.schema.json.tmp terrarium.schema.json

## install: install the program with cargo
install:
	$(CARGO) install --path . --locked

## clean: remove what was rendered and built
clean:
	@rm -rf '$(OUT)'/*.exr '$(OUT)'/*.png '$(OUT)'/.*.tmp-* '$(OUT)/.deps' '$(OUT)/.failed' '$(OUT)/draft' '$(OUT)'/turntable*
	$(CARGO) clean

## help: this list
help:
	@sed -n 's/^## //p' '$(SELF)'
	@echo
	@echo "variables: SCENES=folder OUT=folder FLAGS='--passes 16' TERRARIUM=program; -j 2 for two scenes at once"
