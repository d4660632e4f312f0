"""The blocked force of a row by its cells: the tip's lower edge keeps its height."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pagd.design import Channel
from pagd.fem.assembly import State
from pagd.reduced.compliance import Answers, Compliance, Loaded
from pagd.reduced.rod import Rod, held_force
from pagd.reduced.row import Row
from pagd.reduced.solve import ReducedRow, SolvedCell

FloatArray = NDArray[np.float64]

__all__ = ["Blocked", "blocked_forces"]

# Compliances change slowly: they are computed at so many recorded pressures, evenly spread from the
# first to the last.
_PRESSURES = 3
# A pressure at which no equilibrium is found is come to by so many halvings of the way there.
_HALVINGS = 4


@dataclass(frozen=True, eq=False, slots=True)
class Blocked:
    """What holds the tip at all pressures; not a number from where on no equilibrium was found.

    force_N: (p,) on the support, positive towards −z.
    turned_deg: (p,) by how much the moments turn the joint that they turn most.
    """

    force_N: FloatArray
    turned_deg: FloatArray


def blocked_forces(reduced: ReducedRow, channel: Channel) -> Blocked:
    """The force on the support of the held tip, and how far cells are turned against their shape.

    Factors that the cells have kept are used, and freed.

    Raises
    ------
    ValueError
        Where the row was solved without keeping them.
    SingularMatrixError
        Where the tangent of a cell is singular.
    """
    row = reduced.row(_edge(reduced), channel)
    answers = {kind: _answers(cell) for kind, cell in reduced.cells.items()}
    try:
        known = _compliances(reduced, row, answers)
    finally:
        reduced.free()
    forces, turned = np.full((2, len(reduced.pressure_kPa)), np.nan)
    forces[0] = turned[0] = 0.0
    held = _Held(reduced, row, known)
    for number, pressure in enumerate(reduced.pressure_kPa[1:], 1):
        if not held.go_on_to(float(pressure)):
            break
        forces[number], turned[number] = held.force, np.degrees(held.turned)
    return Blocked(forces, turned)


def _answers(cell: SolvedCell) -> Answers:
    if cell.kept is None:
        raise ValueError("to hold the tip of a row its cells have to keep their factors")
    return Answers(cell.model, cell.kept.assembly, cell.kept.solver)


class _Held:
    """The row with its tip held, at rising pressures.

    force: in N, moments: (N − 1, 3) between the cells in N mm, and turned: the largest rotation of
    a joint by its moment in radians, of the last equilibrium found.
    """

    def __init__(self, reduced: ReducedRow, row: Row, known: Mapping[bool, Loaded]) -> None:
        self._reduced, self._row, self.known = reduced, row, known
        self._pressure = 0.0
        self._unknowns: FloatArray | None = None
        self.force = self.turned = 0.0
        self.moments = np.zeros((reduced.design.N - 1, 3))

    def go_on_to(self, pressure_kPa: float, halvings: int = _HALVINGS) -> bool:
        """Find the equilibrium at a pressure, if need be by pressures in between.

        Where it is not found, the last one in between stays.
        """
        rod = self._rod(pressure_kPa)
        start = None
        if self._unknowns is not None:
            start = self._unknowns * (pressure_kPa / self._pressure)
        found = held_force(rod, start)
        if found is not None:
            self._pressure, (self.force, self._unknowns) = pressure_kPa, found
            self.turned = rod.turned_most(self._unknowns)
            self.moments = rod.moments(self._unknowns)[-len(self.moments) :]
            return True
        between = 0.5 * (self._pressure + pressure_kPa)
        return (
            halvings > 0
            and self.go_on_to(between, halvings - 1)
            and self.go_on_to(pressure_kPa, halvings - 1)
        )

    def _rod(self, pressure_kPa: float) -> Rod:
        known = {kind: one.at(pressure_kPa) for kind, one in self.known.items()}
        return _rod(self._reduced, self._row, known, pressure_kPa)


def _edge(reduced: ReducedRow) -> FloatArray:
    """Both ends (2, 3) of the tip's lower edge, of a half row's half."""
    design = reduced.design
    sides = [0.0, design.W / 2] if design.is_straight else [-design.W / 2, design.W / 2]
    return np.array([[design.L_T, y, -design.t_b] for y in sides])


def _compliances(
    reduced: ReducedRow, row: Row, answers: Mapping[bool, Answers]
) -> dict[bool, Loaded]:
    """The compliances of all kinds of cells.

    The moment that a cell is loaded with is the mean one of its kind in the row that answers
    moments as cells without one do. What one does not bear changes it as that before did.
    """
    last = len(reduced.pressure_kPa) - 1
    chosen = sorted({int(k) for k in np.linspace(0, last, _PRESSURES).round()})
    constant: dict[bool, list[Compliance]] = {kind: [] for kind in answers}
    found: dict[bool, list[Compliance]] = {kind: [] for kind in answers}
    held = _Held(reduced, row, {})
    for number in chosen:
        states = {kind: reduced.cells[kind].states[number] for kind in answers}
        for kind, each in answers.items():
            constant[kind].append(Compliance.constant(each.at(states[kind])))
        held.known = {kind: _between(reduced, chosen, one) for kind, one in constant.items()}
        is_held = number > 0 and held.go_on_to(float(reduced.pressure_kPa[number]))
        for kind, each in answers.items():
            moments = held.moments[(reduced.design.chamber_skews()[:-1] != 0.0) == kind]
            one, before = constant[kind][-1], (found[kind] or constant[kind])[-1]
            loaded = _loaded(each, states[kind], one, moments) if is_held else None
            found[kind].append(loaded or one.changed_as(before))
    return {kind: _between(reduced, chosen, one) for kind, one in found.items()}


def _between(reduced: ReducedRow, chosen: Sequence[int], known: list[Compliance]) -> Loaded:
    """Compliances known at the first of the chosen pressures, by their numbers."""
    return Loaded(reduced.pressure_kPa[list(chosen[: len(known)])], known)


def _loaded(
    answers: Answers, state: State, without: Compliance, moments: FloatArray
) -> Compliance | None:
    """The compliance with that under the mean of the moments (k, 3); none where that is too much.

    The factors of the state without a moment are still there.
    """
    moment = moments.mean(axis=0) if len(moments) else np.zeros(3)
    if not moment.any():
        return without
    loaded = answers.under(state, moment)
    return None if loaded is None else Compliance(without.without, loaded, moment)


def _rod(reduced: ReducedRow, row: Row, known: Mapping[bool, Compliance], pressure: float) -> Rod:
    design = reduced.design
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
    rod = Rod(
        base=places[0],
        rotations=np.stack([joint.rotation for joint in joints]),
        displacements=np.stack([joint.displacement for joint in joints]),
        centres=np.stack(centres),
        compliances=[known[kind] for kind in kinds[:-1]],
        edge=places[-1].inverse()(edge),
        height=-design.t_b,
        is_planar=design.is_straight,
    )
    if not kinds[0]:
        return rod
    # The half that no joint stands for is the one at the clamp, where hardly anything has moved.
    middle = np.array([design.L / 4, 0.0, -design.t_b])
    return rod.with_joint_in_front(middle, known[True].of_half_a_chamber())
