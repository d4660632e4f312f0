"""Run ``snakemake --lint`` without its demand for a Conda environment or container in every rule.

All rules share one environment, which requirements.lock pins and the Makefile builds.
"""

from snakemake.cli import main
from snakemake.linting.rules import RuleLinter

del RuleLinter.lint_missing_software_definition
main(["--lint"])
