"""Foretelling where stability is lost, on a spring and a column whose paths are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_fem_conjugate import CONTROL, FIRST_LIMIT, Balloon, Column, force

from pagd.fem.assembly import Assembly, State
from pagd.fem.continuation import Continuation, LoadPath
from pagd.fem.linear_solver import SuperLUSolver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.stability import StabilityWatch, critical_load, smallest_stiffness
from pagd.fem.term import NO_INTERNAL

LIMIT = float(force(FIRST_LIMIT))


def newton(term: Balloon) -> Newton:
    settings = NewtonSettings(tolerance=1e-9, iterations=20, largest_correction=0.3)
    assembly = Assembly([term], 2, np.zeros(2, bool))
    return Newton(assembly, SuperLUSolver(), 2, settings, load_term=term)


def shortened(place: float) -> State:
    """The straight column."""
    return State(place, np.array([place, 0.0]), (NO_INTERNAL,))


def stretched(place: float) -> State:
    """The spring, in equilibrium."""
    return State(float(force(place)), np.full(2, place), (NO_INTERNAL,))


def test_before_a_limit_point_the_square_of_the_stiffness_is_linear() -> None:
    loads = [3.0, 4.0]
    stiffnesses = [np.array([0.2 * np.sqrt(7.0 - load), 9.0]) for load in loads]
    assert critical_load(loads, stiffnesses) == pytest.approx(7.0)


def test_the_mode_that_vanishes_first_counts_not_the_softest_one() -> None:
    stiffnesses = [np.array([1.0, np.sqrt(6.0)]), np.array([1.0, np.sqrt(3.0)])]
    assert critical_load([1.0, 2.0], stiffnesses) == pytest.approx(3.0)


def test_what_grows_stiffer_or_is_not_known_foretells_nothing() -> None:
    soft, stiff = np.array([1.0, 2.0]), np.array([1.5, 2.5])
    assert critical_load([1.0, 2.0], [soft, stiff]) is None
    assert critical_load([1.0, 2.0], [None, soft]) is None


@pytest.mark.parametrize("place", [0.0, 0.3, 0.55])
def test_the_smallest_stiffness_is_an_eigenvalue_of_the_tangent(place: float) -> None:
    diagonal = 3 * place**2 - 6 * place + 2.5
    exact = np.linalg.eigvalsh([[diagonal + 1, -1.0], [-1.0, 1.0]])
    found = smallest_stiffness(newton(Balloon()), stretched(place))
    assert found == pytest.approx(exact[:1], rel=0.01)


def test_with_the_conjugate_held_only_the_rest_can_move() -> None:
    """Of the spring u is held, and v follows it with a stiffness of 1."""
    found = smallest_stiffness(newton(Balloon()), stretched(0.5), under_conjugate=True)
    assert found == pytest.approx([1.0])


def test_a_singular_tangent_has_no_stiffness_to_tell() -> None:
    assert smallest_stiffness(newton(Column()), shortened(1.0)) is None


def test_a_limit_point_is_one_of_the_load_alone() -> None:
    states = [stretched(FIRST_LIMIT - distance) for distance in (0.1, 0.05)]
    found = StabilityWatch(newton(Balloon())).critical(states)
    assert found is not None
    assert found.load == pytest.approx(LIMIT, rel=1e-3)
    assert not found.under_conjugate


def test_a_bifurcation_is_one_of_the_conjugate_too() -> None:
    found = StabilityWatch(newton(Column())).critical([shortened(0.9), shortened(0.95)])
    assert found is not None
    # Too early by a third of what is left: λ is linear here.
    assert found.load == pytest.approx(1.0 - 0.05 * 2 / 3, rel=1e-2)
    assert found.under_conjugate


def test_one_state_foretells_nothing() -> None:
    assert StabilityWatch(newton(Balloon())).critical([stretched(0.5)]) is None


def path_to_the_limit(foresight: float) -> LoadPath:
    control = replace(CONTROL, first=0.2, growth=1.0, foresight=foresight, patience=20)
    return Continuation(newton(Balloon()), control).follow([2 * LIMIT], lambda step: None)


def test_what_is_foretold_saves_tries_beyond_it() -> None:
    """Where it is not, tries are halved until the steps are the smallest ones."""
    blind, foreseeing = path_to_the_limit(0.0), path_to_the_limit(0.01)
    assert foreseeing.is_unstable
    assert foreseeing.critical is not None
    assert foreseeing.critical.load == pytest.approx(LIMIT, rel=0.01)
    assert 0.98 * LIMIT < foreseeing.load < LIMIT
    assert foreseeing.rejected < blind.rejected
    assert blind.critical is None
