# Every target first prepares what it needs. The sentence after ## is what `make help` says of it.

SHELL := bash
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

# Overridable: make CORES=8, make PYTHON=/path/to/python3
CORES ?= $(shell nproc)
export PYTHON

# Rules and tests find `pagd`, `python` and `snakemake` of the environment by their names.
export PATH := $(CURDIR)/.venv/bin:$(PATH)

.PHONY: help install run dataset sweep screen test verify drill peers docs notebooks lint clean distclean system-packages

help: ## List the targets (the default).
	@sed -nE 's/^([a-z]+):.*## (.*)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 18

install: .venv/pagd-installed ## Install pagd into .venv with what it needs; minutes, once.
	@echo "Installed. Go on with: . .venv/bin/activate"

run: .venv/pagd-installed ## Do all of it: training designs, generated designs, simulation, pictures, page; into results/.
	python workflow/scripts/run_alone.py --profile profiles/default --cores $(CORES)

dataset: .venv/pagd-installed ## Make a public data set of what a run has left, and check it: results/archive/, and a ZIP file.
	pagd archive results --out results/archive --zip results/pagd-pneu-nets.zip
	pagd check-archive results/pagd-pneu-nets.zip

sweep: .venv/pagd-installed ## Do all of it with all generated designs simulated, 1,000 of them: hours.
	python workflow/scripts/run_alone.py --profile profiles/sweep --cores $(CORES)

screen: .venv/pagd-installed ## Do all of it with all training designs, 11,000 of them, by a chamber each: hours.
	python workflow/scripts/run_alone.py --profile profiles/screening --cores $(CORES)

# One solver thread a test process: the processes already fill the cores.
test: lint ## Check the style, then run all tests.
	@setup/system.sh slurm-packages.txt || echo "Without Slurm, its test is left out."
	@setup/system.sh browser-packages.txt || echo "Without Chromium, the tests of the page are left out."
	OMP_NUM_THREADS=1 MKL_NUM_THREADS=1 pytest --hypothesis-profile ci --numprocesses $(CORES) --dist loadscope

verify: .venv/pagd-installed ## Compute every row of the verification: docs/verification.md; half an hour at most.
	@setup/system.sh verification-packages.txt || echo "Without CalculiX, its cases are left out."
	python tests/verification --processes $(CORES) --out results/verification --page docs/verification.md

drill: .venv/pagd-installed ## Do to small sweeps what happens to large ones, and count what is left; minutes.
	python benchmarks/drill.py --page docs/sweeps.md

peers: .venv/pagd-installed ## Compare with CalculiX, FElupe and NGSolve: sections of docs/performance.md; hours.
	@setup/system.sh ../benchmarks/peer-packages.txt
	python benchmarks/peers.py converged
	python benchmarks/peers.py same-mesh --time-limit 900 --page docs/performance.md
	python benchmarks/peers.py equal-error --mesher structured --half-model --time-limit 600 \
		--finer 3 --page docs/performance.md
	python benchmarks/peers.py iteration --page docs/performance.md

docs: .venv/pagd-installed ## Write the documentation as a site for any browser: build/docs/index.html.
	python -m sphinx -c docs/site -W --keep-going -q . build/docs
	@echo "Open build/docs/index.html."

notebooks: .venv/pagd-installed ## Execute docs/notebooks, to look at with their pictures: build/notebooks/*.html.
	python -m nbconvert --execute --to html --output-dir build/notebooks docs/notebooks/*.ipynb

lint: .venv/pagd-installed ## Check style, types and workflow.
	ruff check .
	ruff format --check .
	mypy
	snakefmt --check Snakefile workflow
	python .ci/lint_workflow.py

clean: ## Remove results and caches; the environment stays.
	find results -mindepth 1 ! -name README.md -delete
	rm -rf .snakemake .pytest_cache .mypy_cache .ruff_cache .hypothesis build
	find . -path ./.venv -prune -o -name __pycache__ -exec rm -rf {} +

distclean: clean ## Remove the environment too.
	rm -rf .venv *.egg-info

# Looked at every time (some 50 ms), since packages come and go without the repository knowing.
system-packages:
	@setup/system.sh

# The two stamps lie inside the environment, so that they vanish with it.
.venv/packages-installed: requirements.lock setup/python.sh | system-packages
	@setup/python.sh
	@touch $@

.venv/pagd-installed: pyproject.toml .venv/packages-installed
	@pip --disable-pip-version-check -qq install --no-deps --no-build-isolation --editable .
	@pip --quiet check
	@touch $@
