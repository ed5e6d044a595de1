# The two commands most people need: make demo, make test. Everything lives in .venv/.
PYTHON ?= python3
PORT ?= 8080
BIN := .venv/bin

.PHONY: demo test bench pictures lint clean

demo: .venv/product
	@$(BIN)/fairyring demo demo
	@$(BIN)/fairyring serve demo --port $(PORT)

test: .venv/development
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	$(BIN)/node --test --test-reporter=dot "tests/js/**/*.test.js"
	$(BIN)/python -m pytest $(ARGS)

bench: .venv/development
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	$(BIN)/fairyring bench store
	$(BIN)/fairyring bench editor
	$(BIN)/node tests/js/benchmark.js

pictures: .venv/development
	@$(BIN)/python -m fairyring.app.bench.browser.chromium
	$(BIN)/python -m docs.take_screenshots

lint: .venv/development .venv/typing
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/basedpyright
	$(BIN)/npx --yes -p typescript@5 tsc -p static/jsconfig.json

clean:
	rm -rf .venv demo

.venv/pip:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Fairyring needs Python 3.11 or newer: make PYTHON=python3.12")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --upgrade pip
	@touch $@

.venv/product: .venv/pip pyproject.toml
	$(BIN)/python -m pip install --quiet --editable .
	@touch $@

.venv/development: .venv/product
	$(BIN)/python -m pip install --quiet --group dev
	@touch $@

# The type checker finds fairyring.app in app/ through these links.
.venv/typing: .venv/pip
	@mkdir -p $@/fairyring
	@for room in app model storage static; do ln -sfn ../../../$$room $@/fairyring/$$room; done
