"""Small rows of chambers and their cells, in as few blocks as their walls allow."""

from __future__ import annotations

import functools
from dataclasses import replace

from fem_checks import PAPER, elastomer

from pagd.actuation import Actuation
from pagd.design import Channel, Design
from pagd.reduced.cell import Cell
from pagd.reduced.cell_mesh import cell_mesh
from pagd.reduced.solve import ReducedRow, solve_row

#: A straight row: chambers of 8 mm behind gaps of 2 mm.
STRAIGHT = Design(L=8, W=14, H=10, t=2, t_n=2, t_h=3, t_ab=2, t_b=2, N=5, theta=0, alpha=0)
SLANTED = replace(STRAIGHT, theta=20, alpha=1)
MIXED = replace(STRAIGHT, theta=20, alpha=0.5, N=8)

CHANNEL, SIZE = Channel(), 12.0
ACTUATION = Actuation(maximum_pressure_kPa=20.0, recorded_step_kPa=5.0)
ELASTOMER = elastomer("yeoh")


def cell(design: Design, *, half: bool = False, actuation: Actuation = ACTUATION) -> Cell:
    """The cell of a design's first chamber."""
    helical = bool(design.chamber_skews()[0])
    mesh = cell_mesh(design, CHANNEL, SIZE, helical=helical, half=half)
    return Cell(mesh, ELASTOMER, PAPER, actuation)


@functools.cache
def solved(design: Design, *, pieces: bool) -> ReducedRow:
    """A row by cells alone or with pieces; do not change it."""
    from pagd.mesh.chamber_row import chamber_row

    mesh = chamber_row(design, CHANNEL, SIZE, half=design.is_straight) if pieces else None
    return solve_row(design, CHANNEL, SIZE, ELASTOMER, PAPER, ACTUATION, mesh, keeps_factors=True)
