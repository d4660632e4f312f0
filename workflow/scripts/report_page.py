"""Glue of the rule report_page."""

import sys
from pathlib import Path

from pagd.figures.page import Study, write_page


def main(designs: list[Path], pictures: Path, page: Path, study: Study) -> None:
    """Write the page of the designs whose folders are given, and of the study they belong to."""
    write_page(designs, page, pictures, study, cards=page.parent / "designs")


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    # Places of the generative half by their names in Study; a run without it has none.
    places = snakemake.params.get("study", {})
    main(
        designs=[Path(folder) for folder in snakemake.params.designs],
        pictures=Path(snakemake.input.pictures),
        page=Path(snakemake.output.page),
        study=Study(**{name: Path(place) for name, place in places.items()}),
    )
