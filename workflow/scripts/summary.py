"""Glue of the rule summary_tables."""

import sys
from pathlib import Path

from pagd.summary import write_summary, write_trajectories


def main(metrics: list[Path], performance: Path, trajectories: Path, table: Path) -> None:
    """Write the tables of all designs."""
    write_summary(metrics, performance, table)
    write_trajectories(metrics, trajectories)


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    main(
        metrics=[Path(folder) for folder in snakemake.input.metrics],
        performance=Path(snakemake.output.performance),
        trajectories=Path(snakemake.output.trajectories),
        table=Path(snakemake.output.table),
    )
