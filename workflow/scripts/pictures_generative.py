"""Glue of the rules pictures_generative, pictures_simulated and pictures_screened."""

import sys
from collections.abc import Collection
from dataclasses import fields
from pathlib import Path

from pagd.figures.generative.draw import MODES, PICTURES, draw_generative
from pagd.figures.generative.results import GenerativePaths


def main(paths: GenerativePaths, out: Path, resolution_dpi: int, names: Collection[str]) -> None:
    """Draw the named pictures as far as the given results allow."""
    out.mkdir(parents=True)
    draw_generative(paths, out, resolution_dpi, names)


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    # What is no input of a rule is no part of its pictures, even if it lies there.
    places = {part.name: Path("no input of this rule") for part in fields(GenerativePaths)}
    places |= {name: Path(place) for name, place in snakemake.input.items()}
    main(
        paths=GenerativePaths(**places),
        out=Path(snakemake.output.pictures),
        resolution_dpi=snakemake.params.resolution_dpi,
        names=snakemake.params.get("pictures", (*PICTURES, MODES)),
    )
