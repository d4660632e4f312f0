"""A piece of a row along the path of the cells beyond its cuts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import State
from pagd.fem.continuation import Continuation, LoadPath, Step, StepControl
from pagd.fem.linear_solver import linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.reduced.piece import Piece
from pagd.reduced.shape import CellPath

FloatArray = NDArray[np.float64]

_KPA = 1e-3  # MPa

# Steps by what the shapes beyond the cuts foretell: a first correction in mm.
_CONTROL = StepControl(
    first=2.5e-4, smallest=5e-5, growth=5.0, wanted_correction=0.1, patience=6, dense=True
)

__all__ = ["FollowedPiece", "follow_piece"]


@dataclass(frozen=True, eq=False, slots=True)
class FollowedPiece:
    """How far a piece came.

    rows: (p, n, 3) at the pressures that were reached, 0 first. volumes: (p,) of air, in mm³, and
    energies: (p,) stored, in mJ, both of the whole piece.
    """

    piece: Piece
    rows: FloatArray
    volumes: FloatArray
    energies: FloatArray
    states: list[State]
    path: LoadPath
    factorisations: int


def follow_piece(
    piece: Piece,
    before: CellPath | None,
    behind: CellPath | None,
    pressures_kPa: Sequence[float],
    settings: NewtonSettings,
    solver_name: str = "auto",
) -> FollowedPiece:
    """Solve a piece at rising pressures, as far as it goes.

    Parameters
    ----------
    piece
        The piece.
    before, behind
        The paths of the cells beyond its cuts, where there are any.
    pressures_kPa
        Pressures, 0 not among them.
    settings
        Tolerance and limits of Newton's method.
    solver_name
        See :func:`pagd.fem.linear_solver.linear_solver`.
    """
    rows: list[FloatArray] = []
    volumes: list[float] = []
    energies: list[float] = []
    states: list[State] = []

    def observe(step: Step) -> None:
        if not step.wanted:
            return
        unknowns = step.state.unknowns
        states.append(step.state)
        rows.append(piece.displacement(unknowns))
        volumes.append(piece.volume(unknowns))
        energies.append(piece.stored_energy(unknowns, step.state.load))

    def boundary(load: float, unknowns: FloatArray) -> None:
        pressure = load / _KPA
        piece.prescribe(
            before.at(pressure) if before else None,
            behind.at(pressure) if behind else None,
            unknowns,
        )

    solver = linear_solver(solver_name)
    assembly = piece.assembly()
    newton = Newton(assembly, solver, 3 * piece.nodes, settings, piece.pressure)
    start = assembly.at_rest()
    assembly.look_around(start)
    observe(Step(start, 0, True))
    continuation = Continuation(newton, _CONTROL, boundary)
    path = continuation.follow([p * _KPA for p in pressures_kPa], observe, start)
    count = solver.factorisations
    solver.free()
    return FollowedPiece(
        piece, np.stack(rows), np.array(volumes), np.array(energies), states, path, count
    )
