"""Glue of the rule summary_tables."""

import sys
from pathlib import Path

from pagd.stages.novelty import novelty_of
from pagd.summary import write_gathered, write_summary


def main(
    geometry: list[Path],
    metrics: list[Path],
    dataset: Path | None,
    performance: Path,
    table: Path,
) -> None:
    """Write the tables of all designs, with their novelty where there is a data set."""
    novelty = novelty_of(geometry, dataset) if dataset else {}
    write_summary(metrics, performance, table, novelty)
    write_gathered(metrics, performance.parent)


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    main(
        geometry=[Path(folder) for folder in snakemake.input.geometry],
        metrics=[Path(folder) for folder in snakemake.input.metrics],
        # None or one: a run without the generative half has no data set.
        dataset=next(map(Path, snakemake.input.dataset), None),
        performance=Path(snakemake.output.performance),
        table=Path(snakemake.output.table),
    )
