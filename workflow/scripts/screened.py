"""Glue of the rule screened."""

import sys
from pathlib import Path

from pagd.stages.screening import gather

if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    gather([Path(part) for part in snakemake.input.parts], Path(snakemake.output.screened))
