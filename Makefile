# The two commands most people need: make demo, make test. Everything lives in .venv/.
PORT ?= 8080
# The environment's own Python where there is one, so that PYTHON= need be given only once.
PYTHON ?= $(firstword $(wildcard .venv/bin/python) python3)
BIN := .venv/bin

# Empty files that say what the environment was made from: which Python, where, and which pyproject.toml.
# One made by another Python, or moved, is made anew; one made for another pyproject.toml is brought up to date.
IDENTITY := $(shell $(PYTHON) -c 'import os, sys; print(*sys.version_info[:2], sys.base_prefix, os.getcwd())' \
	| cksum | cut -d ' ' -f 1)
NEEDS := $(shell cksum < pyproject.toml | cut -d ' ' -f 1)
PYTHON_READY := .venv/python-$(IDENTITY)
PRODUCT := .venv/product-$(NEEDS)
DEVELOPMENT := .venv/development-$(NEEDS)

.PHONY: demo test faults bench pictures lint clean

demo: $(PRODUCT)
	@$(BIN)/fairyring demo demo --serve --port $(PORT)

test: $(DEVELOPMENT)
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	$(BIN)/node --test --test-reporter=dot "tests/js/**/*.test.js"
	$(BIN)/python -m pytest --numprocesses auto $(ARGS)

# Kills, full disks, locks, cut lines, and inputs that nobody means: many minutes, and with LONG=1 well over an hour.
# A short form of it is part of `make test`.
faults: $(DEVELOPMENT)
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	FAULTS=$(if $(LONG),long,usual) $(BIN)/python -m pytest --log-cli-level=INFO --log-disable=alembic.runtime.migration \
		tests/faults tests/browser/test_nothing_is_lost.py tests/unit/app/gateway/test_read_only.py $(ARGS)

bench: $(DEVELOPMENT)
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	$(BIN)/fairyring bench store
	$(BIN)/fairyring bench editor
	$(BIN)/node tests/js/benchmark.js
	$(BIN)/fairyring bench page

pictures: $(DEVELOPMENT)
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	$(BIN)/python -m docs.take_screenshots

lint: $(DEVELOPMENT) .venv/typing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/basedpyright
	$(BIN)/npx --yes -p typescript@5 tsc -p static/jsconfig.json

clean:
	rm -rf .venv demo

$(PYTHON_READY):
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Fairyring needs Python 3.11 or newer: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(if $(wildcard .venv/python-*),--clear) .venv
	$(BIN)/python -m pip install --quiet --upgrade pip
	@touch $@

$(PRODUCT): $(PYTHON_READY)
	@echo "Installing what Fairyring needs into .venv/; the first time this takes minutes (README.md says how much it downloads)."
	@# setuptools warns at length of folders called fairyring, of which there are none.
	PYTHONWARNINGS="ignore:Editable installation" $(BIN)/python -m pip install --quiet --editable .
	@rm -f .venv/product-* && touch $@

$(DEVELOPMENT): $(PRODUCT)
	$(BIN)/python -m pip install --quiet --group dev
	@rm -f .venv/development-* && touch $@

# The type checker finds fairyring.app in app/ through these links.
.venv/typing: $(PYTHON_READY)
	@mkdir -p $@/fairyring
	@for room in app model storage static; do ln -sfn ../../../$$room $@/fairyring/$$room; done
	@touch $@
