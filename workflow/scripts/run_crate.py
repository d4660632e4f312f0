"""Glue of the rule run_crate."""

import json
import sys
from pathlib import Path

from pagd.run_crate import write_run_crate

if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    write_run_crate(
        results=Path(snakemake.output.metadata).parent,
        # Of workflow/scripts: the folder of the Snakefile, wherever the run is.
        project=Path(snakemake.scriptdir).resolve().parents[1],
        configuration=json.loads(snakemake.params.configuration),
        tables=[Path(table) for table in snakemake.params.tables],
    )
