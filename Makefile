# Handloom: `make demo` serves the studio with a sample project, `make test` runs the tests, `make proofs` the slow ones. Everything else hangs on `setup`.
# Stamps lie inside what they stand for (.venv, node_modules, dist): delete the folder and it is made again.

# Bytecode is kept: without it every process compiles 4,000 modules anew, which made a worker's start twice as long.
unexport PYTHONDONTWRITEBYTECODE

# A Python 3.11 where there is one (for pybullet), else python3; `make PYTHON=python3.13` takes another.
PYTHON ?= $(shell scripts/require.sh choose)
BIN := .venv/bin
DEPENDENCIES := .venv/.stamp-dependencies
PROJECT := .venv/.stamp-project
COMPILED := .venv/.stamp-compiled
NODE_MODULES := web/node_modules/.stamp
WEB := web/dist/.stamp
TRACKER_SOURCES := $(shell find tracker -name '*.py')
WEB_SOURCES := $(shell find web -type f -not -path '*/node_modules/*' -not -path '*/dist/*' -not -path '*/test-results/*' -not -name '*.tsbuildinfo')

.PHONY: setup demo test test-python test-rooms test-browser test-web wheel proofs proofs-rooms proofs-browser lint lint-ruff lint-format lint-types lint-imports lint-web lint-api api bench studies real house clean
.DELETE_ON_ERROR:

setup: $(PROJECT) $(WEB) $(COMPILED)

$(DEPENDENCIES): requirements.lock
	@scripts/require.sh python $(PYTHON)
	@echo "setup: Python packages, as locked with hashes in requirements.lock ..."
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	@touch $@

$(PROJECT): $(DEPENDENCIES) pyproject.toml
	@echo "setup: handloom itself ..."
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps -e .
	@touch $@

$(NODE_MODULES): web/package-lock.json
	@scripts/require.sh node
	@echo "setup: packages of the browser app, as locked in web/package-lock.json ..."
	cd web && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

$(WEB): $(NODE_MODULES) $(WEB_SOURCES)
	@echo "setup: building the browser app ..."
	cd web && npm run --silent build
	@touch $@

$(COMPILED): $(PROJECT) $(TRACKER_SOURCES)
	@echo "setup: compiling the tracker's kernels (about a minute, only after they change) ..."
	$(BIN)/handloom warm-up
	@touch $@

demo: setup
	$(BIN)/handloom demo

# One file to install anywhere, the browser app in it: dist/handloom-*.whl.
wheel: $(PROJECT) $(WEB)
	$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir dist .
	@ls dist/handloom-*.whl

# Each process of a test run has one thread for linear algebra. OpenBLAS takes one a core otherwise, and those of two
# processes wait for each other: beside other work such a product took ten times as long.
test-rooms test-browser proofs-rooms proofs-browser: export OPENBLAS_NUM_THREADS = 1

# All suites run even if one fails; pytest last, so that its closing line closes. Two browsers at once: each has a studio and a worker.
test: setup
	@status=0; $(MAKE) --no-print-directory test-web || status=1; $(MAKE) --no-print-directory test-python || status=1; exit $$status

test-python: setup
	@status=0; $(MAKE) --no-print-directory test-rooms || status=1; $(MAKE) --no-print-directory test-browser || status=1; exit $$status

test-rooms: setup
	$(BIN)/python -m pytest -rs -m "not browser and not slow" --numprocesses auto --maxprocesses 4 --dist worksteal

test-browser: setup
	$(BIN)/python -m pytest tests/web -rs -m "browser and not slow" --numprocesses auto --maxprocesses 2 --dist loadfile

# What takes minutes: a loop of two rounds whose worker is killed, the demo, scans that become a model in the browser,
# every request of the API right and wrong, every page by axe.
proofs: setup
	@status=0; $(MAKE) --no-print-directory proofs-rooms || status=1; $(MAKE) --no-print-directory proofs-browser || status=1; exit $$status

proofs-rooms: setup
	$(BIN)/python -m pytest -rs -m "slow and not browser" --numprocesses auto --maxprocesses 4 --dist worksteal

proofs-browser: setup
	$(BIN)/python -m pytest tests/web -rs -m "slow and browser"

test-web: setup
	cd web && npm test --silent

lint: lint-ruff lint-format lint-types lint-imports lint-web lint-api

lint-ruff: setup
	$(BIN)/ruff check .

lint-format: setup
	$(BIN)/ruff format --check .

lint-types: setup
	$(BIN)/pyright

lint-imports: setup
	$(BIN)/lint-imports

lint-web: setup
	cd web && npm run --silent types && npm run --silent lint

# The browser's types come from the server's OpenAPI document; both are committed and must be what the code says.
lint-api: setup
	$(BIN)/python scripts/write_openapi.py --check
	cd web && npm run --silent check:api

api: $(PROJECT) $(NODE_MODULES)
	$(BIN)/python scripts/write_openapi.py
	cd web && npm run --silent generate

bench: setup
	$(BIN)/handloom bench tracking

# T16's tables and figures on twins of its public sequences, and every bar: benchmarks/results/studies.md. DATA is the authors' folder.
studies: setup
	@test -n "$(DATA)" || { echo "studies: say where the data of T16 is: make studies DATA=FOLDER"; exit 2; }
	$(BIN)/python -m benchmarks.studies $(DATA) --write
	@test ! -d $(DATA)/../uvr_cube_white || $(MAKE) real DATA=$(DATA)/..

# Real recordings against marks: benchmarks/results/real_marks.md. DATA holds the folders that benchmarks/real_marks/recordings names.
real: setup
	@test -n "$(DATA)" || { echo "real: say where the recordings are: make real DATA=FOLDER"; exit 2; }
	$(BIN)/python -m benchmarks.real_marks $(DATA) --write

# How large, how tangled and how tested each room is.
house: $(PROJECT)
	$(BIN)/python scripts/measure_house.py

clean:
	rm -rf .venv web/node_modules web/dist
