# `make run` and `make test` need Python >= 3.11, make and git, nothing else.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
THREADS := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1
WAITING = $(PYTHON) .ci/waiting.py "installing the libraries of .constraints.txt, which takes minutes" $(VENV)
PYTEST := $(THREADS) $(BIN)/python -m pytest -n auto --dist worksteal -q

.PHONY: run test test-all docs bench lint setup clean

run: setup
	@echo "comparing all models on ks-cantilever"
	@$(THREADS) $(BIN)/crossval compare ks-cantilever --out out/ks-cantilever
	@echo "the page is out/ks-cantilever/report.html; other commands: $(BIN)/crossval --help"

test: lint
	$(PYTEST) -m "not slow"

test-all: lint
	$(PYTEST) --durations=40

docs: setup
	rm -rf out/docs
	$(THREADS) $(BIN)/python -m sphinx -W --keep-going -n -q -d out/docs/doctrees docs out/docs/html

bench: setup
	$(THREADS) $(BIN)/python -m tests.benchmarks.bench

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

setup: $(STAMP)

$(STAMP): pyproject.toml .constraints.txt
	@echo "making $(VENV), once and when the requirements have changed"
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Python >= 3.11 is needed; set PYTHON=..."; exit 1; }
	@if command -v uv >/dev/null 2>&1; then \
	  uv venv --quiet --seed --allow-existing --python $(PYTHON) $(VENV) && \
	  $(WAITING) uv pip install --python $(BIN)/python --constraint .constraints.txt --editable '.[dev]'; \
	else \
	  $(PYTHON) -m venv $(VENV) && \
	  $(WAITING) $(BIN)/python -m pip install --disable-pip-version-check --constraint .constraints.txt --editable '.[dev]'; \
	fi
	@touch $@
	@echo "crossval is $(BIN)/crossval: $(BIN)/crossval scenes"

clean:
	rm -rf $(VENV) .nox out docs/_generated .mypy_cache .ruff_cache .import_linter_cache
