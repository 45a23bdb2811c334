# Each target does all its own set-up: Python >= 3.11 and make are enough.
VENV := .venv
BIN := $(VENV)/bin
ROBOT ?= minibiped

# The first Python on the PATH that is new enough (a shim that cannot start does not count).
PYTHON ?= $(shell for p in python3.13 python3.12 python3.11 python3 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; \
	done)

.PHONY: setup walk test lint docs check bench clean

setup: $(VENV)/.walk

walk: $(VENV)/.walk
	$(BIN)/stride walk $(ROBOT) --duration 20

test: $(VENV)/.dev
	$(BIN)/python -m pytest -n 2 --dist loadgroup

lint: $(VENV)/.dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

docs: $(VENV)/.dev
	$(BIN)/python docs/site/build.py

check: lint docs test

bench: $(VENV)/.walk
	$(BIN)/stride bench

# pip is upgraded first: the one that comes with an old Python may not know editable installs.
$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "make: Python >= 3.11 is needed, none found" >&2; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade pip

$(VENV)/.walk: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable .
	@touch $@

$(VENV)/.dev: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --editable ".[dev]"
	@touch $@ $(VENV)/.walk

clean:
	rm -rf $(VENV) build dist runs
