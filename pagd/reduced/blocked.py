"""The blocked force of a row by its cells: the tip's lower edge keeps its height."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pagd.design import Channel
from pagd.fem.assembly import State
from pagd.reduced.compliance import Answers, Compliance, Loaded
from pagd.reduced.rod import Rod, held_force
from pagd.reduced.row import Row
from pagd.reduced.solve import ReducedRow

FloatArray = NDArray[np.float64]

__all__ = ["blocked_forces"]

# Compliances are computed at every third recorded pressure, and the last; they change slowly.
_EVERY = 3


def blocked_forces(reduced: ReducedRow, channel: Channel, solver_name: str = "auto") -> FloatArray:
    """The force on the support in N, positive towards −z, at all pressures (p,).

    Not a number from where on no equilibrium of the held row was found.

    Raises
    ------
    SingularMatrixError
        Where the tangent of a cell is singular.
    """
    row = reduced.row(_edge(reduced), channel)
    answers = {kind: Answers(cell.model, solver_name) for kind, cell in reduced.cells.items()}
    try:
        known = _compliances(reduced, row, answers)
    finally:
        for each in answers.values():
            each.free()
    forces = np.full(len(reduced.pressure_kPa), np.nan)
    forces[0] = 0.0
    guess, before = None, 1.0
    for number in range(1, len(forces)):
        pressure = float(reduced.pressure_kPa[number])
        rod = _rod(reduced, row, {kind: one.at(pressure) for kind, one in known.items()}, number)
        start = None if guess is None else guess * (pressure / before)
        found = held_force(rod, start)
        if found is None:
            break
        forces[number], guess = found
        before = pressure
    return forces


def _edge(reduced: ReducedRow) -> FloatArray:
    """Both ends (2, 3) of the tip's lower edge, of a half row's half."""
    design = reduced.design
    sides = [0.0, design.W / 2] if design.is_straight else [-design.W / 2, design.W / 2]
    return np.array([[design.L_T, y, -design.t_b] for y in sides])


def _compliances(
    reduced: ReducedRow, row: Row, answers: Mapping[bool, Answers]
) -> dict[bool, Loaded]:
    """The compliances of all kinds of cells, as far as the row can be followed with its tip held.

    The moment that a cell is loaded with is the mean one of its kind in the row that answers
    moments as cells without one do.
    """
    count = len(reduced.pressure_kPa)
    chosen = sorted({*range(0, count, _EVERY), count - 1})
    found: dict[bool, list[Compliance]] = {kind: [] for kind in answers}
    joints = reduced.design.chamber_skews()[:-1] != 0.0
    guess, before = None, 1.0
    for number in chosen:
        pressure = float(reduced.pressure_kPa[number])
        without = {
            kind: Compliance(one, one, np.zeros(3))
            for kind, one in (
                (kind, each.at(reduced.cells[kind].states[number]))
                for kind, each in answers.items()
            )
        }
        held = None
        if number:
            rod = _rod(reduced, row, without, number)
            held = held_force(rod, None if guess is None else guess * (pressure / before))
        if held is not None:
            guess, before = held[1], pressure
            moments = rod.moments(guess)
        for kind, each in answers.items():
            one = without[kind]
            mine = joints == kind
            if held is not None and mine.any():
                one = _loaded(each, reduced.cells[kind].states[number], one, moments[mine])
            found[kind].append(one)
    pressures = reduced.pressure_kPa[chosen]
    return {kind: Loaded(pressures, known) for kind, known in found.items()}


def _loaded(answers: Answers, state: State, without: Compliance, moments: FloatArray) -> Compliance:
    """The compliance with that under the mean of the moments (k, 3).

    The factors of the state without a moment are still there.
    """
    moment = moments.mean(axis=0)
    loaded = answers.under(state, moment)
    return without if loaded is None else Compliance(without.without, loaded, moment)


def _rod(reduced: ReducedRow, row: Row, known: Mapping[bool, Compliance], number: int) -> Rod:
    pressure, design = float(reduced.pressure_kPa[number]), reduced.design
    shapes = {kind: cell.path.at(pressure) for kind, cell in reduced.cells.items()}
    pieces = [piece.at(pressure) for piece in reduced.pieces]
    places = row.places(shapes, pieces)
    kinds = [bool(skew) for skew in design.chamber_skews()]
    joints = [a.inverse() @ b for a, b in pairwise(places)]
    centres = [
        joint(reduced.cells[kind].path.tie.centre)
        for joint, kind in zip(joints, kinds[1:], strict=True)
    ]
    edge = row.points + row.displacement(shapes, pieces)
    return Rod(
        base=places[0],
        rotations=np.stack([joint.rotation for joint in joints]),
        displacements=np.stack([joint.displacement for joint in joints]),
        centres=np.stack(centres),
        compliances=[known[kind] for kind in kinds[:-1]],
        edge=places[-1].inverse()(edge),
        height=-design.t_b,
        is_planar=design.is_straight,
    )
