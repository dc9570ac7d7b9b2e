# Every target does the set-up that it needs: `make demo` and `make test` work from a fresh clone.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
DEMO := out/owl-wing-static
VIEWER := out/viewer

# One thread per process: the tests fill the cores with processes of their own.
ONE_THREAD := OMP_NUM_THREADS=1 MKL_NUM_THREADS=1
# Compiled modules are kept, whatever the environment says: hundreds of processes would compile alula anew.
PYTEST := $(ONE_THREAD) PYTHONDONTWRITEBYTECODE= $(BIN)/pytest --numprocesses auto --dist worksteal

.DEFAULT_GOAL := help
.PHONY: help setup libraries demo docs test lint tests verify bench coverage numbers fuzz golden planted texts viewer dist clean distclean

help: ## show this list
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## (.*)/  make \1\t\2/' | expand -t 18

setup: $(INSTALLED) ## system libraries, .venv, locked packages, alula itself

demo: setup ## check the built-in owl wing, all links as solids, and say where its report is
	@$(BIN)/alula check owl-wing-static --fidelity solid --fresh -o $(DEMO); status=$$?; \
	case $$status in \
	  0|1|3) echo "The report: $(CURDIR)/$(DEMO)/report.html" ;; \
	  *) exit $$status ;; \
	esac

docs: setup ## the site in out/site, without network (GALLERY=all: slow examples are run, too)
	@rm -rf out/site
	@GALLERY=$(GALLERY) $(ONE_THREAD) $(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet --fresh-env --doctree-dir out/site-cache docs out/site
	@echo "The site: $(CURDIR)/out/site/index.html"

# The types are checked beside the tests: by themselves they would keep one core alone busy.
test: setup ## lint, types and every test but the converged studies
	@$(MAKE) --no-print-directory --jobs=2 --keep-going lint tests

lint: setup
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

tests: setup
	$(PYTEST) -m "not converged"

verify: setup ## the converged studies, on fine meshes
	$(PYTEST) -m converged

bench: setup ## measure speed, accuracy and growth: an hour or so (BENCH="--quick": minutes)
	$(BIN)/python -m benchmarks.run $(BENCH)

coverage: setup ## how many error bands of drawn links hold the truth, and how wide they are: a quarter of an hour
	$(ONE_THREAD) $(BIN)/python -m benchmarks.coverage $(or $(COVERAGE),--anew)

numbers: setup ## which printed numbers are older than the code (RENEW=stale, all or a name: measures them anew)
	@$(BIN)/python -m benchmarks.renew $(RENEW)

golden: setup ## renew the golden results, after a change that is meant (GOLDEN="hand-*": only those)
	PYTHONPATH=$(CURDIR):$(CURDIR)/tests $(ONE_THREAD) $(BIN)/python -m golden $(GOLDEN)

texts: setup ## renew geometry/base/entry_texts.toml, after a change of what stands below an entry of a record
	PYTHONPATH=$(CURDIR):$(CURDIR)/tests $(BIN)/python -m entry_texts

# In a copy of the checkout; some ten seconds for each mistake.
planted: setup ## plant kept mistakes one at a time: which tests notice? (PLANTED="--all clearance": all tests, those)
	PYTHONPATH=$(CURDIR)/tests $(ONE_THREAD) $(BIN)/python -m planted $(PLANTED)

# The fuzzer has wheels for x86-64 Linux alone and is needed for nothing else, so set-up leaves it out.
fuzz: setup ## a million hostile inputs for all that reads a case (FUZZ="--share 0.01": fewer)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --requirement tests/fuzz/requirements.lock
	PYTHONPATH=$(CURDIR):$(CURDIR)/tests $(ONE_THREAD) $(BIN)/python -m fuzz --output out/fuzz $(FUZZ)

# Needs node 20 and npm; the packages are locked, and the same sources give the same bytes.
viewer: ## build reports/turnable/viewer.js, which draws the models in a report, from its sources
	@mkdir -p $(VIEWER) && cp reports/turnable/package.json reports/turnable/package-lock.json $(VIEWER)
	@npm ci --prefix $(VIEWER) --ignore-scripts --no-audit --no-fund --silent
	@node reports/turnable/build.js $(VIEWER)

# The wheel is built from the archive of sources, so that what this leaves out is missed at once.
dist: setup ## archive of sources and wheel, in dist
	@rm -rf build dist && mkdir dist
	@$(BIN)/python -c "from setuptools.build_meta import build_sdist; build_sdist('dist')" >/dev/null
	@$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation --wheel-dir dist dist/*.tar.gz
	@rm -rf build alula.egg-info && ls -l dist

clean: ## remove results and caches
	rm -rf out build dist docs/generated alula.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +

distclean: clean ## remove .venv as well
	rm -rf $(VENV)

# Asked every time, since it takes a tenth of a second and a missing library ends in a crash.
libraries:
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' || \
	  { echo "alula needs Python 3.11 to 3.13, and $(PYTHON) is another: make PYTHON=python3.12 $(MAKECMDGOALS)" >&2; exit 1; }
	@missing=$$($(PYTHON) geometry/base/system_libraries.py) || exit 1; \
	if [ -z "$$missing" ]; then exit 0; fi; \
	if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
	  echo "Installing system libraries: $$missing"; \
	  export DEBIAN_FRONTEND=noninteractive; \
	  apt-get update -qq && apt-get install -qq --yes --no-install-recommends $$missing >/dev/null; \
	else \
	  echo "System libraries are missing. Run this once, then make again:" >&2; \
	  $(PYTHON) geometry/base/system_libraries.py --advice >&2; \
	  exit 1; \
	fi

$(INSTALLED): requirements.lock pyproject.toml setup.py | libraries
	@$(BIN)/python -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(VENV)
	@echo "Installing the locked packages into $(VENV): some 2 GB, a minute or more"
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --requirement requirements.lock
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
# What type checkers and editors look through, which do not ask the finder of an editable install.
	@rm -rf $(VENV)/types && mkdir -p $(VENV)/types/alula
	@for one in alula/*.py alula/py.typed geometry loads fea reports; do \
	  ln -s "$(CURDIR)/$$one" $(VENV)/types/alula/ || exit 1; \
	done
	@touch $@
# Other users of the machine may run it, whatever the umask: pip keeps to that.
	@chmod -R a+rX $(VENV)
