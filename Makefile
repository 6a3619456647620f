# make demo   sets everything up, then records, learns, runs and evaluates the pick-and-place task
# make test   sets everything up, then runs the tests
# make lint   sets everything up, then checks format, style and types
# make clean  removes the environment and caches; demonstrations, models and runs stay

PYTHON ?= python3.11
VENV := .venv
BIN := $(VENV)/bin

.DELETE_ON_ERROR:
.PHONY: demo test lint clean

demo: $(VENV)/.installed
	$(BIN)/cobot-lfd demo

test: $(VENV)/.installed-dev
	$(BIN)/python -m pytest -n auto --dist loadfile -m 'not browser' $(PYTEST_ARGS)
	$(BIN)/python -m pytest -m browser $(PYTEST_ARGS)

lint: $(VENV)/.installed-dev
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy

clean:
	rm -rf $(VENV) build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# Installed again only when pyproject.toml changes; our own files are used where they are.
$(VENV)/.installed: pyproject.toml | $(BIN)/pip
	$(BIN)/pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml | $(BIN)/pip
	$(BIN)/pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(VENV)/.installed $@

# Debian and Ubuntu ship python3.11 without ensurepip, which venv needs; hence the try.
$(BIN)/pip:
	@if $(PYTHON) -c 'import ensurepip, sys, venv; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null; then \
		$(PYTHON) -m venv $(VENV); \
	elif command -v uv >/dev/null; then \
		uv venv --python 3.11 --seed --clear $(VENV); \
	else \
		echo "Python 3.11 with venv is needed and '$(PYTHON)' is not it." >&2; \
		echo "Install it (Debian, Ubuntu: python3.11 and python3.11-venv), name it (make PYTHON=/path/to/python3.11)," >&2; \
		echo "or install uv (https://docs.astral.sh/uv), which fetches it." >&2; \
		exit 1; \
	fi
