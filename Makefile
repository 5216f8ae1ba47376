# Drives everything; `make help` lists the targets.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
PYTHON := .venv/bin/python

MPM := target/release/mpm
MPM_BUILD := $(MPM)
include pipeline/mpm.mk

SECONDS := 600

# Only what building pages and their search needs.
MDBOOK_VERSION := 0.5.4
MDBOOK := target/tools/mdbook-$(MDBOOK_VERSION)/bin/mdbook

.PHONY: help setup build wheel wheel-try demo gallery pile pile-variants pile-schemes pipeline pipeline-study test test-quick fuzz sanitize campaign check fmt clean bench bench-block peer-wall constants sbom stress everyday verification book keys

help: ## List the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  %-14s %s\n", $$1, $$2}' $(firstword $(MAKEFILE_LIST))
	@printf '  %-14s %s\n' '<case>' 'The four stages of a case, stale ones only: $(notdir $(CASES))' \
	  '<case>-clean' 'Remove the output of a case; also -mesh, -seed, -solve, -export for single stages'

setup: ## Install what is missing beside Rust: system packages (as root) and the wheels in .venv
	@pipeline/setup.sh

build: $(MPM) ## Build the program (target/release/mpm)

# Cargo decides what is to be built; where nothing is, the program keeps its time and no result goes stale.
$(MPM): setup
	cargo build --release

demo: seabed_slope ## From nothing to a ParaView series and a picture: the slope that fails and runs out
	$(PYTHON) paraview/seabed_slope.py

gallery: build ## Run the offshore cases with their variants beside known values; writes docs/gallery.md (ARGS='mudmat trench' for some)
	$(PYTHON) benches/gallery/run.py $(ARGS)

# A case like the others (pipeline/mpm.mk), that ends with its picture.
pile: ## From nothing to the pile that is pushed into clay, and the picture of the stress around it
	$(PYTHON) paraview/pile.py

pile-variants: build ## The pile smooth, rough, as it is, and by mpm and ddmp: pictures, curves, tables of noise and ripple
	$(PYTHON) cases/pile/variants.py $(if $(THREADS),--threads $(THREADS))
	$(PYTHON) paraview/pile.py $(addprefix cases/pile/,out-smooth out out-rough) -o cases/pile/out/adhesion.png
	$(PYTHON) paraview/pile.py $(addprefix cases/pile/,out-mpm out-ddmp out) -o cases/pile/out/schemes.png
	$(PYTHON) cases/pile/study.py

pile-schemes: build ## The pile over a regular grid by mpm, ddmp, cpgimp, composite and bspline: the noise of the stress below the base, side by side
	$(PYTHON) cases/pile/schemes.py $(if $(THREADS),--threads $(THREADS))
	$(PYTHON) paraview/pile.py $(addprefix cases/pile/out-regular,-mpm -ddmp -cpgimp -composite -bspline) cases/pile/out-regular -o cases/pile/out-regular/schemes.png
	$(PYTHON) cases/pile/study.py $(addprefix cases/pile/out-regular,-mpm -ddmp -cpgimp -composite -bspline) cases/pile/out-regular -o cases/pile/out-regular/curves.svg

# A case like the others, that goes on with its variants and their pictures.
pipeline: build ## The pipe pressed into the seabed and pulled across it, α = 0.5, 0 and 1: pictures, curves, a table
	$(PYTHON) cases/pipeline/variants.py smooth rough $(if $(THREADS),--threads $(THREADS))
	for out in out out-smooth out-rough; do $(PYTHON) paraview/pipeline.py cases/pipeline/$$out; done
	$(PYTHON) cases/pipeline/study.py

pipeline-study: build ## The same with all variants: softening clay, no parting, a rigid pipe, one that may turn, half the step, a coarse mesh
	$(PYTHON) cases/pipeline/variants.py $(if $(THREADS),--threads $(THREADS))
	$(PYTHON) cases/pipeline/study.py

test: setup ## Set up and run all tests
	cargo test --release --no-fail-fast
	@$(MAKE) --no-print-directory wheel-try

# Slow tests are in modules named `slow`.
test-quick: setup ## Set up and run the tests that take less than three seconds each, in two minutes after the build
	cargo test --release --no-fail-fast -- --skip slow::

wheel: setup ## Build the wheel for pip: writes target/wheels
	rm -rf target/wheels
	$(PYTHON) -m pip wheel --quiet --disable-pip-version-check --no-deps -w target/wheels .

wheel-try: wheel ## Install the wheel into a clean environment and run a template with it
	@pipeline/try_wheel.sh

fuzz: ## Mutated files through every reader for a time: make fuzz SECONDS=600 (SEED=1; tests/fuzz/README.md)
	FUZZ_SECONDS=$(SECONDS) FUZZ_SEED=$(or $(SEED),$(shell date +%s)) cargo test --release --config profile.release.package.mpm.overflow-checks=true --test fuzz -- --nocapture

sanitize: build ## The boundary to Gmsh under valgrind, where that is installed: reads and writes out of bounds end it
	@command -v valgrind >/dev/null || { echo "sanitize: valgrind is missing; install it and run this again" >&2; exit 3; }
	for case in cases/* tests/data/*; do out=$$(mktemp -d); echo "$$case"; \
	  valgrind -q --trace-children=yes --undef-value-errors=no --error-exitcode=9 $(MPM) mesh $$case -o $$out >/dev/null; rm -rf $$out; done

campaign: setup ## Kills, signals, full disks and pairs of processes in every stage, hostile folders: 25 times as many as in the tests
	CAMPAIGN=25 cargo test --release --test all campaign:: -- --nocapture

verification: build ## Run every verification; writes docs/verification.md and the output of the tests beside it
	$(PYTHON) benches/verification/run.py $(ARGS)

bench: build ## Error against seconds for every scheme, beside Kratos; writes docs/benchmarks.md (ARGS=--quick for a few runs)
	$(PYTHON) benches/work_precision/run.py $(ARGS)

bench-block: build ## Time the block of 102 400 points beside Kratos; writes docs/benchmarks-block.md
	$(PYTHON) benches/block/run.py --large --write $(ARGS)

peer-wall: build ## Run the anchored wall of the template beside Kratos; prints forces and displacements, stage by stage
	$(PYTHON) benches/peers/wall.py $(ARGS)

constants: setup ## Run scenes with each numerical constant of the solver halved and doubled, an hour; writes docs/constants.md
	$(PYTHON) benches/constants/run.py --write $(ARGS)

stress: build ## Random scenes, each to end converged or with a statement; writes docs/stress.md
	$(PYTHON) benches/stress/run.py --write $(ARGS)

everyday: build ## Ordinary random scenes with known answers and relations, some minutes: make everyday SEED=1; writes docs/everyday.md
	$(PYTHON) benches/everyday/run.py --write --seed $(or $(SEED),1) $(ARGS)

check: setup ## Formatting, lints, documentation and manual, without warnings
	cargo fmt --check
	cargo clippy --release --all-targets -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --release --no-deps
	$(MAKE) --no-print-directory book

book: setup $(MDBOOK) ## Build the manual, with search and a page to print: target/book/index.html
	$(PYTHON) pipeline/book.py $(MDBOOK)

$(MDBOOK):
	cargo install mdbook --version $(MDBOOK_VERSION) --locked --no-default-features --features search --root target/tools/mdbook-$(MDBOOK_VERSION)

keys: build ## Write the tables of keys in docs/reference from the schema of case.yaml
	$(MPM) schema > target/schema.json
	$(PYTHON) pipeline/keys.py target/schema.json

sbom: setup ## List what is linked into the program; writes docs/sbom.cdx.json
	$(PYTHON) pipeline/sbom.py

fmt: ## Format the sources
	cargo fmt

clean: $(addsuffix -clean,$(notdir $(CASES))) ## Remove the output of all cases (`cargo clean` removes the build)
