"""Glue of the rule fronts."""

import json
import sys
from pathlib import Path

import pandas as pd

from pagd.files import write_text
from pagd.fronts import compare
from pagd.tables import read_table


def main(training: Path, generated: Path, seed: int, out: Path) -> None:
    """Write the comparison of what generated and training designs can do."""
    tables = (pd.DataFrame(read_table(f / "performance.parquet")) for f in (training, generated))
    write_text(out, json.dumps(compare(*tables, seed), indent=2) + "\n")


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    main(
        training=Path(snakemake.input.training),
        generated=Path(snakemake.input.generated),
        seed=snakemake.params.seed,
        out=Path(snakemake.output.fronts),
    )
