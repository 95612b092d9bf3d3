# The one door to everything. `make` alone lists what it can do.
# Nothing is installed outside this folder: Python packages go to .venv/, Rust output to target/.

VENV := .venv
BIN := $(VENV)/bin
RUST_SOURCES := Cargo.toml Cargo.lock $(shell find crates -name '*.rs' -o -name 'Cargo.toml')
# Says what takes long before it begins, and how long it took: tools/step.sh "what" "command".
STEP := tools/step.sh
export PIP_DISABLE_PIP_VERSION_CHECK := 1
# mkdocs-material announces its plans for another major version of mkdocs; ours is pinned by the lock.
export NO_MKDOCS_2_WARNING := 1

.PHONY: help
help: ## list these targets
	@grep -hE '^[a-z][a-z-]*:.*## ' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | awk -F'\t' '{printf "make %-12s %s\n", $$1, $$2}'

# ---------------------------------------------------------------- build

.PHONY: build
build: $(VENV)/.built page ## make .venv with the package (release mode), .venv/bin/ulna and the page of ulna workbench

# Every package comes from the lock file and must have the hash written there.
$(VENV)/.locked: requirements-dev.lock
	@python=$$(tools/prerequisites.sh build) && $(STEP) "Making $(VENV)/ with $$(grep -c == $<) locked Python packages (one to five minutes)" \
		"$$python -m venv --clear $(VENV) && $(BIN)/python -m pip install --quiet --require-hashes --requirement $<"
	@touch $@

# Python sources are used where they stand (an editable install), so only Rust changes need a rebuild.
$(VENV)/.built: $(VENV)/.locked pyproject.toml $(RUST_SOURCES)
	@tools/prerequisites.sh build >/dev/null
	@$(STEP) "Compiling the core in release mode (two to five minutes the first time, then what changed)" \
		'PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .'
	@touch $@

PAGE := python/ulna/serve/page/index.html
PAGE_SOURCES := $(shell find page -path page/node_modules -prune -o -type f ! -name schema.d.ts -print)

.PHONY: page
page: $(PAGE) ## build the page of ulna workbench (needs Node)

$(PAGE): $(PAGE_SOURCES) tools/page.sh
	@$(STEP) "Building the page of ulna workbench (a minute the first time)" "tools/page.sh build"

.PHONY: workbench
workbench: build ## open the workbench in your browser, with a bench folder in out/bench
	$(BIN)/ulna workbench out/bench

.PHONY: demo
demo: build ## calibrate the shipped example, the virtual Platinum with its bent probe; result in out/demo
	@echo "Calibrating the example (a second or two):"
	$(BIN)/ulna calibrate examples/platinum/study.toml -o out/demo --force

WHEELS := target/wheels

.PHONY: wheel
wheel: build ## build the wheel, examples and all, into target/wheels/
	@rm -f $(WHEELS)/ulna-*.whl
	@$(STEP) "Building the wheel (seconds, as the core is compiled)" \
		"$(BIN)/maturin build --quiet --release --locked --interpreter $(BIN)/python --out $(WHEELS)"
	@ls $(WHEELS)/ulna-*.whl

# ---------------------------------------------------------------- test

.PHONY: test
test: prerequisites ## the suite: Rust, Python, lint, types, docs; `make test-long` has the rest
	@$(MAKE) --jobs=2 --output-sync=target build rust-test # one core is enough for linking
	@$(MAKE) --jobs=2 --output-sync=target lint types docs page-test # each is one process
	@$(MAKE) python-test

.PHONY: prerequisites
prerequisites:
	@tools/prerequisites.sh test >/dev/null

.PHONY: lint
lint: build ## formatting and lint, Rust and Python; changes nothing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	cargo fmt --all --check
	cargo clippy --locked --workspace --all-targets -- -D warnings

.PHONY: format
format: build ## put Rust and Python sources into the house format
	cargo fmt --all
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

.PHONY: types
types: build ## mypy --strict
	$(BIN)/mypy

.PHONY: rust-test
rust-test: ## tests of the core, and its documentation with warnings as errors
	cargo test --locked --profile checked --package ulna
	RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --workspace --quiet

.PHONY: page-test
page-test: page ## types, lint and tests of the page's own sources
	tools/page.sh check

.PHONY: python-test
python-test: build ## tests through the public door
	$(BIN)/python -m pytest -n 2 -m "not long"

.PHONY: test-long
test-long: build ## what takes minutes: reruns of the literature, coverage by hundreds of arms, pages made anew, kills
	$(BIN)/python -m pytest -n 2 -m long

.PHONY: wheel-test
wheel-test: wheel ## install the wheel into a fresh environment and run `ulna demo` there (a minute or two)
	ULNA_WHEEL="$$(ls $(WHEELS)/ulna-*.whl)" $(BIN)/python -m pytest -p no:xdist tests/wheel

.PHONY: docs
docs: build ## build the documentation into site/, strict
	$(BIN)/mkdocs build --strict --quiet

# ---------------------------------------------------------------- measure and regenerate

# The peers may live in an environment of their own: make bench PEERS_PYTHON=/path/to/python (benchmarks/requirements.txt).
PEERS_PYTHON ?= $(BIN)/python

.PHONY: bench
bench: build ## time the core and the peers that are installed, side by side; writes docs/benchmarks/results.md
	$(BIN)/python -m benchmarks --python $(PEERS_PYTHON)

FUZZ_SECONDS ?= 600
FUZZ_SEED ?= 1
FUZZ_JOBS ?= 1

.PHONY: fuzz
fuzz: build ## put hostile inputs to every door for FUZZ_SECONDS, from FUZZ_SEED; writes docs/benchmarks/fuzzing.md
	$(BIN)/python -m fuzzing --seconds $(FUZZ_SECONDS) --seed $(FUZZ_SEED) --jobs $(FUZZ_JOBS) --page docs/benchmarks/fuzzing.md

.PHONY: nist
nist: build ## NIST's reference problems and fits through the solver and the geometry; writes the tables of the docs
	ULNA_NIST="$(CURDIR)/docs/benchmarks" cargo test --locked --profile checked --package ulna --test nist

.PHONY: example-data
example-data: build ## make the readings of examples/platinum anew (fixed seed: nothing changes unless the generator did)
	$(BIN)/python examples/platinum/generate.py

.PHONY: docs-output
docs-output: build ## run what the docs show and write its output into docs/
	$(BIN)/python tools/docs_output.py
	$(BIN)/python tools/docs_evening.py # five minutes, as long as the hand takes

.PHONY: schemas
schemas: build ## write the JSON Schemas of all formats anew, and the contract of the page, from the models they are made of
	$(BIN)/python tools/schemas.py
	$(BIN)/python tools/openapi.py

.PHONY: lock
lock: ## choose dependencies anew and write their hashes to requirements-dev.lock (needs uv)
	@command -v uv >/dev/null || { echo "make lock: uv is not installed (pip install uv)" >&2; exit 1; }
	UV_CUSTOM_COMPILE_COMMAND="make lock" uv pip compile --quiet --upgrade --universal --python-version 3.11 \
		--generate-hashes --group dev --extra reports --extra tables --extra search --extra judge --extra laboratory --extra mqtt --extra ros --extra opcua pyproject.toml --output-file requirements-dev.lock

.PHONY: clean
clean: ## remove everything that was built
	rm -rf $(VENV) target site out python/ulna/examples python/ulna/serve/page page/node_modules .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find python tests examples benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +
	find python -name '*.so' -delete
