"""Glue of the rule summary_tables."""

from pathlib import Path

from pagd.summary import write_summary, write_trajectories


def main(metrics: list[Path], performance: Path, trajectories: Path, table: Path) -> None:
    """Write the tables of all designs."""
    write_summary(metrics, performance, table)
    write_trajectories(metrics, trajectories)


if "snakemake" in globals():
    main(
        metrics=[Path(folder) for folder in snakemake.input.metrics],
        performance=Path(snakemake.output.performance),
        trajectories=Path(snakemake.output.trajectories),
        table=Path(snakemake.output.table),
    )
