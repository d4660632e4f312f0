"""Blocked force of the smallest thing that bends: variants, halves, refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fem_checks import PAPER, elastomer

from pagd.actuation import Actuation, Body, blocked_force, free_actuation
from pagd.actuation.blocked import tip_edge
from pagd.errors import InputError, Status
from pagd.mesh.primitives import hollow_block
from pagd.mesh.types import Mesh

MATERIAL = elastomer("yeoh", C10=0.11, C20=0.02)
WANTED = Actuation(maximum_pressure_kPa=10.0, recorded_step_kPa=5.0)


def beam(half: bool = False) -> Mesh:
    """24 × 6 × 6 mm with thin walls over a base of 2 mm, or the half of it with y ≥ 0."""
    across, cells = ((0, 2), 3) if half else ((1, 5), 6)
    width = 3.0 if half else 6.0
    mesh = hollow_block((24.0, width, 6.0), (8, cells, 6), ((1, 7), across, (2, 5)), 1, half)
    return mesh if half else replace(mesh, points=mesh.points - [0, 3, 0])


def test_the_edge_is_the_lower_one_of_the_tip() -> None:
    mesh = beam()
    places = mesh.points[tip_edge(mesh)]
    np.testing.assert_allclose(places[:, 0], 24.0)
    np.testing.assert_allclose(places[:, 2], 0.0)
    assert np.ptp(places[:, 1]) == pytest.approx(6.0)


def test_the_edge_stays_and_presses() -> None:
    found = blocked_force(beam(), MATERIAL, PAPER, WANTED)
    assert (found.status, found.figures["variant"]) == (Status.ok, "edge")
    assert not found.states[-1].displacement[tip_edge(beam()), 2].any()
    force, recorded = found.history["blocked_force_N"], found.history["recorded"]
    assert force[0] == pytest.approx(0.0, abs=1e-12)
    assert (np.diff(force) > 0).all()
    assert len(force) > recorded.sum() == len(found.states)
    assert found.figures["blocked_force_N"] == force[-1]


def test_the_force_is_as_good_at_every_recorded_pressure() -> None:
    """Displacements of some micrometres off are forces of some percent, where walls are stiff."""
    many = replace(WANTED, recorded_step_kPa=1.0)
    found = blocked_force(beam(), MATERIAL, PAPER, many)
    exact = blocked_force(beam(), MATERIAL, PAPER, replace(many, tolerance_mm=1e-6))
    forces = [r.history["blocked_force_N"][r.history["recorded"]] for r in (found, exact)]
    np.testing.assert_allclose(forces[0], forces[1], rtol=0.01, atol=1e-12)
    interpolated = found.history["newton_iterations"][1:] == 0
    assert 0 < interpolated.sum() < len(interpolated)


def test_the_force_of_a_half_is_that_of_the_whole() -> None:
    forces = [
        float(blocked_force(beam(half), MATERIAL, PAPER, WANTED).figures["blocked_force_N"])
        for half in (False, True)
    ]
    assert forces[1] == pytest.approx(forces[0], rel=0.02)  # two meshes


def test_a_body_can_be_used_for_both_analyses() -> None:
    body = Body(beam(), MATERIAL, PAPER, WANTED)
    free = free_actuation(body, MATERIAL, PAPER, WANTED)
    held = blocked_force(body, MATERIAL, PAPER, WANTED)
    alone = blocked_force(beam(), MATERIAL, PAPER, WANTED)
    assert free.states[-1].displacement[tip_edge(beam()), 2].max() < -0.01
    assert held.figures["blocked_force_N"] == pytest.approx(alone.figures["blocked_force_N"])


def test_a_plate_out_of_reach_takes_no_force() -> None:
    far = replace(WANTED, blocked_force="plate", plate_distance_mm=20.0)
    found = blocked_force(beam(), MATERIAL, PAPER, far)
    assert found.figures["variant"] == "plate"
    assert float(found.figures["blocked_force_N"]) == pytest.approx(0.0, abs=1e-7)


def test_the_support_carries_weight_before_there_is_pressure() -> None:
    heavy = replace(WANTED, gravity_m_s2=(0.0, 0.0, -9.81), maximum_pressure_kPa=5.0)
    found = blocked_force(beam(), MATERIAL, PAPER, heavy)
    body = Body(beam(), MATERIAL, PAPER, heavy)
    weight = -float(body.gravity.weight[2]) if body.gravity else 0.0
    assert 0.2 * weight < found.history["blocked_force_N"][0] < 0.5 * weight


def test_gravity_that_nothing_can_bear_is_named() -> None:
    crushing = replace(WANTED, gravity_m_s2=(0.0, 0.0, -1e7))
    found = free_actuation(beam(), MATERIAL, PAPER, crushing)
    assert found.status is Status.not_converged
    assert found.reason is not None
    assert "of gravity was found, before any pressure" in found.reason


def test_nothing_that_holds_the_tip_is_refused() -> None:
    with pytest.raises(InputError, match="blocked_force is 'none', but must be one of edge, plate"):
        blocked_force(beam(), MATERIAL, PAPER, replace(WANTED, blocked_force="none"))


def test_a_plate_needs_an_outside() -> None:
    mesh = beam()
    less = replace(mesh, surfaces={k: v for k, v in mesh.surfaces.items() if k != "outer"})
    with pytest.raises(InputError, match="has no surface 'outer'"):
        blocked_force(less, MATERIAL, PAPER, replace(WANTED, blocked_force="plate"))
