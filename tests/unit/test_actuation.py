"""Free actuation of the smallest thing that has all surfaces of an actuator."""

from __future__ import annotations

import os
from dataclasses import replace

import numba
import numpy as np
import pytest
from fem_checks import PAPER, elastomer
from numpy.typing import NDArray

from pagd.actuation import Actuation, ActuationResult, Body, free_actuation, use_threads
from pagd.errors import InputError, Status
from pagd.mesh.primitives import grid, hollow_block
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.tagging import name_surfaces
from pagd.mesh.types import Mesh
from pagd.validation import schema

FloatArray = NDArray[np.float64]

MATERIAL = elastomer("yeoh", C10=0.11, C20=0.02)
SHORT = Actuation(maximum_pressure_kPa=12.0, recorded_step_kPa=5.0)


def block(half: bool = False) -> Mesh:
    """12 × 6 × 6 mm with a void of 6 × 3 × 2 mm above the paper, or the half of it with y ≥ 0."""
    cells = (4, 2, 3) if half else (4, 4, 3)
    across = (0, 1) if half else (1, 3)
    width = 3.0 if half else 6.0
    mesh = hollow_block((12.0, width, 6.0), cells, ((1, 3), across, (1, 2)), 1, half)
    return mesh if half else replace(mesh, points=mesh.points - [0, 3, 0])


@pytest.fixture(scope="module")
def result() -> ActuationResult:
    return free_actuation(block(), MATERIAL, PAPER, SHORT)


@pytest.mark.parametrize(
    ("maximum", "step", "expected"),
    [
        (50.0, 5.0, [5, 10, 15, 20, 25, 30, 35, 40, 45, 50]),
        (12.0, 5.0, [5, 10, 12]),
        (3.0, 5.0, [3]),
        (5.0, 5.0, [5]),
        (0.3, 0.1, [0.1, 0.2, 0.3]),
        (2.1, 0.7, [0.7, 1.4, 2.1]),
    ],
)
def test_recorded_pressures(maximum: float, step: float, expected: list[float]) -> None:
    found = Actuation(maximum_pressure_kPa=maximum, recorded_step_kPa=step).recorded_kPa()
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert found[-1] == maximum  # not a rounding error beside it
    assert (np.diff(found) > 0).all()


def test_states_at_the_recorded_pressures(result: ActuationResult) -> None:
    assert (result.status, result.reason) == (Status.ok, None)
    assert [s.pressure_kPa for s in result.states] == pytest.approx([0, 5, 10, 12])
    assert not result.states[0].displacement.any()
    assert result.states[0].strain_max == pytest.approx(0.0, abs=1e-12)
    strains = [s.strain_p99 for s in result.states]
    assert strains == sorted(strains)
    assert all(s.strain_max >= s.strain_p99 for s in result.states)


def test_fixed_nodes_stay_and_the_rest_moves(result: ActuationResult) -> None:
    mesh = block()
    last = result.states[-1].displacement
    assert last.shape == mesh.points.shape
    assert not last[mesh.nodes_of("fixed")].any()
    assert np.abs(last[mesh.nodes_of("cavity")]).max() > 0.05


def test_history(result: ActuationResult) -> None:
    history = result.history
    assert set(history) == {
        "pressure_kPa",
        "cavity_volume_mm3",
        "stored_energy_mJ",
        "newton_iterations",
        "recorded",
        "smallest_gap_mm",
    }
    assert len({len(column) for column in history.values()}) == 1
    assert (np.diff(history["pressure_kPa"]) > 0).all()
    assert (np.diff(history["cavity_volume_mm3"]) > 0).all()
    assert (np.diff(history["stored_energy_mJ"]) > 0).all()
    assert history["cavity_volume_mm3"][0] == pytest.approx(6 * 3 * 2)
    assert history["stored_energy_mJ"][0] == pytest.approx(0.0, abs=1e-12)
    assert set(np.round([5, 10, 12], 9)) <= set(np.round(history["pressure_kPa"], 9))


def test_figures(result: ActuationResult) -> None:
    mesh, figures = block(), result.figures
    assert figures["tets"] == len(mesh.tets)
    corners = len(np.unique(mesh.tets[:, :4]))
    held = 3 * len(mesh.nodes_of("fixed"))
    assert figures["unknowns"] == 3 * len(mesh.points) + corners - held
    assert figures["pressure_kPa"] == 12.0
    assert figures["solid_volume_mm3"] == pytest.approx(12 * 6 * 6 - 6 * 3 * 2)
    # States at rest and interpolated ones are no steps.
    assert figures["steps"] == (result.history["newton_iterations"] > 0).sum()
    # Iterations of tries that failed count too.
    assert figures["newton_iterations"] >= result.history["newton_iterations"].sum() > 0


def test_paper_stiffens() -> None:
    mesh = block()
    bare = replace(mesh, surfaces={k: v for k, v in mesh.surfaces.items() if k != "paper"})
    end = Actuation(maximum_pressure_kPa=5.0)
    with_paper = free_actuation(mesh, MATERIAL, PAPER, end)
    without = free_actuation(bare, MATERIAL, PAPER, end)
    tip = mesh.nodes_of("tip")
    stiff, soft = (r.states[-1].displacement[tip, 0].mean() for r in (with_paper, without))
    assert 0 < stiff < 0.9 * soft


def test_half_model_doubles_its_sums() -> None:
    """Volume and energy are those of the whole actuator."""
    half, whole = (
        Body(block(half=True), MATERIAL, PAPER),
        Body(block(), MATERIAL, PAPER),
    )
    assert half.solid_volume == pytest.approx(whole.solid_volume)
    volumes = [b.volume(np.zeros(b.size)) for b in (half, whole)]
    assert volumes == pytest.approx([36.0, 36.0])


def test_symmetry_plane_is_held_across() -> None:
    mesh = block(half=True)
    found = free_actuation(mesh, MATERIAL, PAPER, Actuation(maximum_pressure_kPa=5.0))
    moved = found.states[-1].displacement[mesh.nodes_of("symmetry")]
    assert not moved[:, 1].any()
    assert np.abs(moved[:, 2]).max() > 0.01


def test_element_with_constant_pressure_is_close() -> None:
    """Two elements, one body: a few per cent on a coarse mesh, and not the same number."""
    last = []
    for element in ("taylor_hood", "element_pressure"):
        wanted = replace(SHORT, maximum_pressure_kPa=5.0, element=element)
        last.append(free_actuation(block(half=True), MATERIAL, PAPER, wanted))
    volumes = [r.history["cavity_volume_mm3"][-1] - 36.0 for r in last]
    assert volumes[1] == pytest.approx(volumes[0], rel=0.1)
    assert volumes[1] != pytest.approx(volumes[0], rel=1e-6)


def test_stop_ends_the_analysis(result: ActuationResult) -> None:
    def stop(pressure: float, displacement: FloatArray) -> tuple[Status, str] | None:
        assert displacement.shape == block().points.shape
        return (Status.self_collision, "Two walls met.") if pressure > 6 else None

    found = free_actuation(block(), MATERIAL, PAPER, SHORT, stop)
    assert (found.status, found.reason) == (Status.self_collision, "Two walls met.")
    assert 6 < found.figures["pressure_kPa"] < 12
    recorded = [s.pressure_kPa for s in found.states]
    assert recorded[:2] == pytest.approx([0, 5])
    assert recorded[-1] == pytest.approx(found.figures["pressure_kPa"])
    assert found.history["pressure_kPa"][-1] == pytest.approx(found.figures["pressure_kPa"])


def test_progress_is_told_every_step(result: ActuationResult) -> None:
    told: list[tuple[float, int]] = []
    found = free_actuation(
        block(), MATERIAL, PAPER, SHORT, progress=lambda p, n: told.append((p, n))
    )
    np.testing.assert_allclose([p for p, _ in told], found.history["pressure_kPa"])
    np.testing.assert_allclose([n for _, n in told], found.history["newton_iterations"])


def test_overstretched() -> None:
    limited = replace(MATERIAL, largest_stretch=1.05)
    found = free_actuation(block(), limited, PAPER, replace(SHORT, maximum_pressure_kPa=50))
    assert found.status is Status.overstretched
    assert found.reason is not None
    assert "exceeds 1.05, the limit of yeoh, in " in found.reason
    assert 0 < found.figures["pressure_kPa"] < 50


def test_no_step_at_all() -> None:
    wanted = replace(SHORT, maximum_pressure_kPa=500.0, first_step_kPa=500, smallest_step_kPa=400)
    found = free_actuation(block(), MATERIAL, PAPER, replace(wanted, recorded_step_kPa=500.0))
    assert found.status is Status.not_converged
    assert found.reason is not None
    assert found.reason.startswith("Beyond 0 kPa no step of the pressure converged (")
    assert [state.pressure_kPa for state in found.states] == [0.0]


def test_beyond_a_limit_point_the_pressure_falls() -> None:
    """A soft neo-Hookean block blows up: no equilibrium at 50 kPa, but ever larger volumes."""
    soft = replace(elastomer("neo_hookean", C10=0.004), largest_stretch=4.0)
    found = free_actuation(block(), soft, PAPER)
    assert found.status is Status.overstretched
    pressure, volume = (found.history[f"{k}"] for k in ("pressure_kPa", "cavity_volume_mm3"))
    assert found.figures["limit_points"] == 1
    assert pressure[-1] < 0.95 * pressure.max()
    assert (np.diff(volume) > 0).all()
    assert found.figures["volume_controlled_from_kPa"] == pytest.approx(pressure.max(), rel=0.02)
    # The last state is recorded, at a pressure that was passed before.
    assert found.states[-1].pressure_kPa == pressure[-1] == found.figures["pressure_kPa"]
    recorded = found.history["recorded"]
    assert recorded.sum() == len(found.states)
    # Nothing is wanted on the falling branch, but the cavity grows: by a quarter from state to
    # state, but for a step that goes further.
    falling = np.flatnonzero(recorded & (np.arange(len(pressure)) > pressure.argmax()))
    assert len(falling) > 2
    assert (volume[falling[1:-1]] / volume[falling[:-2]] > 1.25).all()
    np.testing.assert_array_equal(pressure[recorded], [s.pressure_kPa for s in found.states])


def test_beyond_two_limit_points_the_pressure_rises_again() -> None:
    """With a material that stiffens, the last pressure lies on the branch beyond both.

    With half of C30 the branch is so long that the last digits tell whether it is followed.
    """
    stiffening = elastomer("yeoh", C10=0.004, C20=1e-5, C30=2e-6)
    wanted = Actuation(maximum_pressure_kPa=7.7, recorded_step_kPa=3.85)
    found = free_actuation(block(), replace(stiffening, largest_stretch=100), PAPER, wanted)
    assert (found.status, found.figures["limit_points"]) == (Status.ok, 1)
    recorded = np.array([s.pressure_kPa for s in found.states])
    assert recorded[:2] == pytest.approx([0, 3.85])
    assert recorded[-1] == pytest.approx(7.7)
    # Between the limit points the pressure is below the first of them.
    assert (recorded[2:-1] < found.figures["largest_pressure_kPa"]).all()
    pressure, work = found.history["pressure_kPa"], found.history["stored_energy_mJ"][-1]
    steps = np.diff(found.history["cavity_volume_mm3"])
    done = (0.5 * (pressure[1:] + pressure[:-1]) * steps).sum() * 1e-3
    assert done == pytest.approx(work, rel=0.01)


@pytest.mark.parametrize("missing", ["fixed", "cavity"])
def test_missing_surfaces(missing: str) -> None:
    mesh = block()
    less = replace(mesh, surfaces={k: v for k, v in mesh.surfaces.items() if k != missing})
    with pytest.raises(InputError, match=missing):
        free_actuation(less, MATERIAL, PAPER, SHORT)


def test_unknown_element() -> None:
    wanted = replace(SHORT, element="brick")
    with pytest.raises(InputError, match=r"element is 'brick'.* taylor_hood, element_pressure"):
        free_actuation(block(), MATERIAL, PAPER, wanted)


def test_unknown_linear_solver() -> None:
    with pytest.raises(InputError, match="linear_solver is 'mumps'"):
        free_actuation(block(), MATERIAL, PAPER, replace(SHORT, linear_solver="mumps"))


def test_linear_solvers_agree() -> None:
    pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    wanted = Actuation(maximum_pressure_kPa=5.0)
    ends = [
        free_actuation(block(half=True), MATERIAL, PAPER, replace(wanted, linear_solver=name))
        .states[-1]
        .displacement
        for name in ("pardiso", "superlu")
    ]
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-6)


def test_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("MKL_NUM_THREADS", "OMP_NUM_THREADS"):
        monkeypatch.setenv(variable, "7")
    before = numba.get_num_threads()
    try:
        use_threads(1)
        assert numba.get_num_threads() == 1
        assert os.environ["MKL_NUM_THREADS"] == os.environ["OMP_NUM_THREADS"] == "1"
    finally:
        numba.set_num_threads(before)


LIMITS = schema("config")["properties"]["limits"]["properties"]


@pytest.mark.parametrize("slant_deg", [0.0, 45.0, LIMITS["theta_deg"]["maximum"]])
def test_walls_face_each_other_up_to_the_largest_slant(slant_deg: float) -> None:
    """A notch of 2 mm along x between a chamber and a block, sheared as slanted walls are."""
    solid = np.ones((8, 4, 4), np.bool_)
    solid[1:3, 1:3, 2:3] = False
    solid[5:6, :, 2:] = False
    size = (16.0, 8.0, 8.0)
    points, tets = grid(size, solid)
    mesh = quadratic_mesh(points, tets, name_surfaces(points, tets, 2.0, False, 1e-9))
    # Files of surfaces are rounded: a wall may be slanted by that much more.
    skew = (1 + 1e-6) * np.tan(np.radians(slant_deg))
    sheared = mesh.points + np.outer(mesh.points[:, 1], [skew, 0, 0])
    body = Body(replace(mesh, points=sheared), MATERIAL, PAPER)
    assert body.contact is not None
    assert body.initial_gap == pytest.approx(2.0 * np.cos(np.radians(slant_deg)), rel=1e-5)


def test_products_in_kernels_are_of_one_thread_too() -> None:
    from threadpoolctl import threadpool_info, threadpool_limits

    with threadpool_limits(None):
        use_threads(1)
        assert {
            pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"
        } == {1}
