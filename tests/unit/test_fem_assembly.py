"""Pattern and assembly against a dense assembly."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import PAPER, elastomer, linearized
from numpy.typing import NDArray
from scipy.sparse import csr_array

from pagd.fem.assembly import Assembly, State
from pagd.fem.bending import bending_terms
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.membrane import Membrane
from pagd.fem.pattern import build_pattern
from pagd.fem.solid import TaylorHoodSolid
from pagd.fem.term import ElementSystem, EnergyTerm, node_dofs
from pagd.mesh.primitives import hollow_block

FloatArray = NDArray[np.float64]
LOAD = 0.02


def body() -> tuple[list[EnergyTerm], int, NDArray[np.bool_]]:
    """All terms of an actuator on the smallest mesh that has all its surfaces."""
    mesh = hollow_block((3.0, 3.0, 3.0), (3, 3, 3), ((1, 2), (1, 2), (1, 2)), 1)
    solid = TaylorHoodSolid(mesh.points, mesh.tets, elastomer("yeoh"), 3 * len(mesh.points))
    size = 3 * len(mesh.points) + solid.pressures
    held = mesh.nodes_of("fixed")
    paper = mesh.surfaces["paper"]
    fixed = np.zeros(size, np.bool_)
    fixed[(3 * held[:, None] + np.arange(3)).ravel()] = True
    terms: list[EnergyTerm] = [
        solid,
        FollowerPressure(mesh.points, mesh.surfaces["cavity"]),
        Membrane(mesh.points, paper, PAPER),
        *bending_terms(mesh.points, paper, PAPER, clamped=held),
    ]
    return terms, size, fixed


def state_of(terms: list[EnergyTerm], size: int) -> State:
    """A random state with consistent internal variables."""
    random = np.random.default_rng(0)
    unknowns = 0.05 * random.normal(size=size)
    internal = []
    for term in terms:
        term.linearize(unknowns, term.internal_at_rest(), LOAD, ElementSystem.of(term.dofs))
        internal.append(term.advance(np.zeros(size)))
    return State(LOAD, unknowns, tuple(internal))


def test_matrix_and_residual_are_those_of_a_dense_assembly() -> None:
    terms, size, fixed = body()
    assembly = Assembly(terms, size, fixed)
    state = state_of(terms, size)
    energy, residual, values = assembly.linearize(state)
    parts = [linearized(term, state.unknowns, LOAD) for term in terms]
    dense = sum(part[2] for part in parts)[np.ix_(assembly.free, assembly.free)]
    pattern, free = assembly.pattern, len(assembly.free)
    found = csr_array((values, pattern.columns, pattern.starts), shape=(free, free)).toarray()
    size_of_entries = np.abs(dense).max()
    np.testing.assert_allclose(found, np.triu(dense), atol=1e-13 * size_of_entries)
    np.testing.assert_allclose(residual, sum(p[1] for p in parts), atol=1e-13)
    assert energy == pytest.approx(sum(p[0] for p in parts), rel=1e-12)
    assert assembly.free.tolist() == np.flatnonzero(~fixed).tolist()


def test_second_linearisation_starts_afresh() -> None:
    terms, size, fixed = body()
    assembly = Assembly(terms, size, fixed)
    state = state_of(terms, size)
    first = [np.copy(part) for part in assembly.linearize(state)]
    assembly.linearize(assembly.at_rest())
    for before, after in zip(first, assembly.linearize(state), strict=True):
        np.testing.assert_array_equal(before, after)


def test_pattern_is_sorted_upper_and_has_the_diagonal() -> None:
    terms, size, fixed = body()
    pattern = Assembly(terms, size, fixed).pattern
    assert pattern.starts[-1] == pattern.entries
    for row, (start, end) in enumerate(zip(pattern.starts[:-1], pattern.starts[1:], strict=True)):
        columns = pattern.columns[start:end]
        assert columns[0] == row
        assert (np.diff(columns) > 0).all()


def test_pattern_of_two_terms_with_held_unknowns() -> None:
    """Unknowns 0…4, number 2 held; elements (0, 2), (3, 1) and (4, 3, 0)."""
    numbering = np.array([0, 1, -1, 2, 3])
    pattern = build_pattern([np.array([[0, 2], [3, 1]]), np.array([[4, 3, 0]])], numbering)
    rows = np.repeat(np.arange(4), np.diff(pattern.starts))
    entries = list(zip(rows.tolist(), pattern.columns.tolist(), strict=True))
    assert entries == [(0, 0), (0, 2), (0, 3), (1, 1), (1, 2), (2, 2), (2, 3), (3, 3)]
    place = {entry: k for k, entry in enumerate(entries)}
    outside = len(entries)
    np.testing.assert_array_equal(
        pattern.maps[0],
        [[place[0, 0], outside, outside], [place[2, 2], place[1, 2], place[1, 1]]],
    )
    expected = [(3, 3), (2, 3), (0, 3), (2, 2), (0, 2), (0, 0)]
    np.testing.assert_array_equal(pattern.maps[1], [[place[e] for e in expected]])


def test_rest_has_no_energy_and_no_residual() -> None:
    terms, size, fixed = body()
    assembly = Assembly(terms, size, fixed)
    energy, residual, _ = assembly.linearize(assembly.at_rest())
    assert energy == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose(residual, 0.0, atol=1e-12)


def test_energies_by_name() -> None:
    terms, size, fixed = body()
    assembly, state = Assembly(terms, size, fixed), state_of(terms, size)
    energies = assembly.energies(state)
    assert set(energies) == {"solid", "pressure", "membrane", "bending", "hinges", "held edges"}
    assert sum(energies.values()) == pytest.approx(assembly.linearize(state)[0], rel=1e-12)
    twice = Assembly([terms[0], terms[0]], size, fixed).energies(state)
    assert twice["solid"] == pytest.approx(2 * energies["solid"], rel=1e-12)


def test_inadmissible_states_have_infinite_energy() -> None:
    terms, size, fixed = body()
    assembly = Assembly(terms, size, fixed)
    unknowns = np.zeros(size)
    unknowns[: 3 * 100] = 50 * np.random.default_rng(1).normal(size=300)
    rest = assembly.at_rest()
    assert assembly.linearize(State(0.0, unknowns, rest.internal))[0] == np.inf


def test_correction_advances_unknowns_and_internal_variables() -> None:
    terms, size, fixed = body()
    assembly, state = Assembly(terms, size, fixed), state_of(terms, size)
    assembly.linearize(state)
    correction = 1e-3 * np.random.default_rng(6).normal(size=size)
    after = assembly.advance(state, correction)
    assert after.load == state.load
    np.testing.assert_array_equal(after.unknowns, state.unknowns + correction)
    np.testing.assert_array_equal(after.internal[2], terms[2].advance(correction))


def test_numbers_of_displacements() -> None:
    np.testing.assert_array_equal(node_dofs(np.array([[2, 0]])), [[6, 7, 8, 0, 1, 2]])
