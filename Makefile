# `make run` and `make test` need Python >= 3.11, make and git, nothing else.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
THREADS := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1
WAITING = $(PYTHON) .ci/waiting.py "installing the libraries of .constraints.txt, which takes minutes" $(VENV)
PYTEST := $(THREADS) $(BIN)/python -m pytest -n auto --dist worksteal -q

.PHONY: run test test-all results coverage mutation docs figures bench fuzz platforms peers lint format setup clean

run: setup
	@echo "comparing all models on ks-cantilever"
	@$(THREADS) $(BIN)/crossval compare ks-cantilever --out out/ks-cantilever
	@echo "the page is out/ks-cantilever/report.html; other commands: $(BIN)/crossval --help"

test: lint
	$(PYTEST) -m "not slow"

test-all: lint
	$(PYTEST) --durations=40

# measures every number that the pages state, and writes those that have changed
results: setup
	$(PYTEST) --write-results

# branches of elements, contact, stepping and exact answers, by the tests of both tiers; the modules and the bar are in pyproject.toml
coverage: setup
	$(PYTEST) --cov tests/tsm tests/verification tests/comparisons/exact tsm comparisons/exact

# forty faults, drawn over all three packages, and whether the tests find them; a fault may collect without end, so memory has a limit
mutation: setup
	ulimit -v 6000000; $(BIN)/python -m tests.mutation --slow

docs: setup
	rm -rf out/docs
	$(THREADS) $(BIN)/python -m sphinx -W --keep-going -n -q -d out/docs/doctrees docs out/docs/html

# the pictures of the README, the tutorial and the pages, by the commands that they show
figures: setup
	$(THREADS) $(BIN)/python -m docs.extensions.figures

bench: setup
	$(THREADS) $(BIN)/python -m tests.benchmarks.bench --out bench.json

fuzz: setup
	$(THREADS) $(BIN)/python -m tests.fuzz files 0 40
	$(THREADS) $(BIN)/python -m tests.fuzz world 0 5000
	$(THREADS) $(BIN)/python -m tests.fuzz friction 0 1000

platforms: setup
	$(BIN)/nox -f tests/platforms/noxfile.py --envdir $(CURDIR)/.nox

# the programs of others that have wheels; a wheel that is missing leaves the rest as it was
peers: setup
	@if command -v uv >/dev/null 2>&1; then \
	  uv pip install --quiet --python $(BIN)/python --constraint .constraints.txt --editable '.[peers]'; \
	else \
	  $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint .constraints.txt --editable '.[peers]'; \
	fi

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: setup
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

setup: $(STAMP)

$(STAMP): pyproject.toml .constraints.txt
	@echo "making $(VENV), once and when the requirements have changed"
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Python >= 3.11 is needed; set PYTHON=..."; exit 1; }
	@if command -v uv >/dev/null 2>&1; then \
	  uv venv --quiet --allow-existing --python $(PYTHON) $(VENV) && \
	  $(WAITING) uv pip install --python $(BIN)/python --constraint .constraints.txt --editable '.[dev]'; \
	else \
	  $(PYTHON) -m venv $(VENV) && \
	  $(WAITING) $(BIN)/python -m pip install --disable-pip-version-check --constraint .constraints.txt --editable '.[dev]'; \
	fi
	@touch $@
	@echo "crossval is $(BIN)/crossval: $(BIN)/crossval scenes"

clean:
	rm -rf $(VENV) .nox out docs/_generated bench.json .mypy_cache .ruff_cache .import_linter_cache
