"""Glue of the rule report_page."""

import sys
from pathlib import Path

from pagd.figures.page import write_page


def main(designs: list[Path], pictures: Path, page: Path) -> None:
    """Write the page of the designs whose folders are given."""
    write_page(designs, page, pictures)


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    main(
        designs=[Path(folder) for folder in snakemake.params.designs],
        pictures=Path(snakemake.input.pictures),
        page=Path(snakemake.output.page),
    )
