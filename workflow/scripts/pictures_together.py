"""Glue of the rule pictures_together."""

import sys
from pathlib import Path

from pagd.figures.angles import draw_angles
from pagd.figures.drawing import draw_side_by_side
from pagd.figures.forces import draw_forces
from pagd.figures.gallery import draw_gallery
from pagd.figures.load import has_blocked_force, has_states, has_trajectory
from pagd.figures.style import set_resolution
from pagd.figures.trajectories import draw_trajectories


def main(designs: list[Path], out: Path, resolution_dpi: int) -> None:
    """Draw what there is of the designs whose folders are given; nothing if all have failed."""
    set_resolution(resolution_dpi)
    out.mkdir(parents=True)
    if any(has_states(folder) for folder in designs):
        draw_gallery(designs, out / "gallery.png")
        draw_side_by_side(designs, out / "designs.svg")
    if any(has_trajectory(folder) for folder in designs):
        draw_trajectories(designs, out / "trajectories.png")
        draw_angles(designs, out / "angles.png")
    if any(has_blocked_force(folder) for folder in designs):
        draw_forces(designs, out / "forces.png")


if "snakemake" in globals():
    sys.stderr = Path(snakemake.log[0]).open("w", encoding="utf-8")
    main(
        designs=[Path(folder) for folder in snakemake.params.designs],
        out=Path(snakemake.output.pictures),
        resolution_dpi=snakemake.params.resolution_dpi,
    )
