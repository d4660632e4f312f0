"""From the solved parts of a row to a first guess of the whole actuator, node for node.

Displacements alone would not do: pressures of nearly incompressible elements, forces of the stiff
paper and contact pressures are far more sensitive than they are. None of them changes where a part
is carried by a rigid motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.body import Body
from pagd.fem.assembly import State
from pagd.fem.contact import FaceContact
from pagd.fem.dense_output import at_load
from pagd.fem.membrane import Membrane
from pagd.fem.solid import ElementPressureSolid
from pagd.fem.term import EnergyTerm
from pagd.reduced.row import Group, Row
from pagd.reduced.segment import Segment
from pagd.reduced.shape import around
from pagd.reduced.solve import ReducedRow

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["guess"]

_KPA = 1e-3  # MPa


def guess(body: Body, reduced: ReducedRow, row: Row, pressure_kPa: float) -> State:
    """The state of a whole actuator by its parts at a pressure.

    Parameters
    ----------
    body
        The actuator, in the mesh whose nodes are the points of ``row``.
    reduced, row
        The solved parts, and where its nodes are among them.
    pressure_kPa
        Up to the last recorded one. Between recorded ones everything is of polynomials.
    """
    unknowns = np.zeros(body.size)
    unknowns[: 3 * body.nodes] = reduced.displacement(row, pressure_kPa).ravel()
    parts = list(_parts(reduced, row, pressure_kPa, body.nodes))
    internal = tuple(_internal(term, unknowns, parts) for term in body.terms)
    return State(pressure_kPa * _KPA, unknowns, internal)


#: Where a node of the row is among those of the part, −1 if it is not; the part, and its state.
_Part = tuple[IntArray, Segment, State]


def _parts(reduced: ReducedRow, row: Row, pressure_kPa: float, nodes: int) -> Iterator[_Part]:
    """Cells first, then pieces, which know better."""

    def numbers(group: Group) -> IntArray:
        result = np.full(nodes, -1, np.int64)
        result[group.points] = group.nodes
        return result

    load = pressure_kPa * _KPA
    states = {kind: _at(cell.states, load) for kind, cell in reduced.cells.items()}
    for chamber, skew in enumerate(reduced.design.chamber_skews()):
        cell = reduced.cells[bool(skew)]
        yield numbers(row.group_of_cell(chamber)), cell.model, states[bool(skew)]
    for piece in reduced.pieces:
        group = row.group_of(piece.at(pressure_kPa))
        yield numbers(group), piece.followed.piece, _at(piece.followed.states, load)


def _at(states: Sequence[State], load: float) -> State:
    """The state at a load, between the known ones by a polynomial through four."""
    return at_load(states[around([state.load for state in states], load)], load)


def _internal(term: EnergyTerm, unknowns: FloatArray, parts: list[_Part]) -> FloatArray:
    """The internal variables of a term, from those of the parts' terms of its kind."""
    if isinstance(term, ElementPressureSolid):
        at_rest = term.pressures_of(term.internal_at_rest())
        pressures = _gathered(
            term.nodes,
            at_rest,
            parts,
            lambda other, internal: (
                (other.nodes, other.pressures_of(internal))
                if isinstance(other, ElementPressureSolid)
                else None
            ),
        )
        return term.internal_at(unknowns, pressures)
    if isinstance(term, Membrane):
        return _gathered(
            term.faces,
            term.internal_at_rest(),
            parts,
            lambda other, internal: (
                (other.faces, internal) if isinstance(other, Membrane) else None
            ),
        )
    if isinstance(term, FaceContact):
        return _gathered(
            term.slaves,
            term.internal_at_rest(),
            parts,
            lambda other, internal: (
                (other.slaves, internal) if isinstance(other, FaceContact) else None
            ),
        )
    return term.internal_at_rest()


_Known = Callable[[EnergyTerm, FloatArray], "tuple[IntArray, FloatArray] | None"]


def _gathered(
    elements: IntArray, at_rest: FloatArray, parts: list[_Part], known: _Known
) -> FloatArray:
    """Values (E, m) of ``elements`` (E, n), from those of the same nodes among the parts'."""
    result = at_rest.copy()
    for numbers, segment, state in parts:
        nodes = numbers[elements]
        inside = np.flatnonzero((nodes >= 0).all(axis=1))
        for other, internal in zip(segment.terms, state.internal, strict=True):
            found = known(other, internal)
            if found is None or found[0].shape[1] != elements.shape[1]:
                continue
            place = _matches(nodes[inside], found[0])
            hit = place >= 0
            result[inside[hit]] = found[1][place[hit]]
    return result


def _matches(wanted: IntArray, known: IntArray) -> IntArray:
    """Rows (k,) of ``known`` (m, n) that are the rows ``wanted`` (k, n); −1 where none is."""
    both = np.vstack([known, wanted])
    _, codes = np.unique(both, axis=0, return_inverse=True)
    codes = codes.ravel()
    where = np.full(codes.max(initial=-1) + 1, -1, np.int64)
    where[codes[: len(known)]] = np.arange(len(known))
    return np.asarray(where[codes[len(known) :]])
