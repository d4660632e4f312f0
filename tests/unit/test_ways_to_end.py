"""How a path ends, in words: buckling, failures of the iteration, too much weight."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fem_checks import PAPER, elastomer

from pagd.actuation import Actuation, free_actuation
from pagd.actuation.follow import _ending, _Followed
from pagd.actuation.recorder import Recorder
from pagd.errors import Status
from pagd.fem.continuation import LoadPath
from pagd.fem.linear_solver import PardisoSolver, linear_solver
from pagd.fem.stability import Critical
from pagd.mesh.primitives import hollow_block

RISING = np.array([0.0, 10.0, 20.0, 30.0])
FALLING = np.array([0.0, 10.0, 20.0, 30.0, 25.0, 22.0])


class Going(Recorder):
    """A recorder that nothing has told to end."""

    def __init__(self) -> None:
        self.ending = None


def path(load: float, failure: str = "", is_unstable: bool = False) -> LoadPath:
    return LoadPath(load, 10, 40, 5, failure=failure, is_unstable=is_unstable)


def ending(followed: _Followed, pressure_kPa: np.ndarray) -> tuple[Status, str | None]:
    return _ending(followed, Going(), pressure_kPa)


def test_what_reaches_the_last_pressure_is_ok() -> None:
    assert ending(_Followed(path(0.03)), RISING) == (Status.ok, None)


def test_what_is_unstable_at_its_end_buckles() -> None:
    status, reason = ending(_Followed(path(0.03, "it is unstable", True)), RISING)
    assert status is Status.buckled
    assert reason == (
        "At 30 kPa the equilibrium loses its stability: the actuator buckles. No further step was "
        "found."
    )


def test_what_is_foretold_to_become_unstable_buckles_there() -> None:
    foretold = replace(path(0.03, "it is unstable", True), critical=Critical(0.0302, True))
    status, reason = ending(_Followed(foretold), RISING)
    assert status is Status.buckled
    assert reason == (
        "At 30.2 kPa, as its stiffness up to 30 kPa foretells, the equilibrium loses its "
        "stability: the actuator buckles."
    )


def test_an_unstable_equilibrium_ahead_is_named() -> None:
    found = replace(path(0.03, "it is unstable", True), unstable_load=0.032)
    status, reason = ending(_Followed(found), RISING)
    assert status is Status.buckled
    assert reason == (
        "Between 30 and 32 kPa the equilibrium loses its stability: the actuator buckles."
    )


def test_where_the_pressure_fell_before_the_limit_point_is_named() -> None:
    status, reason = ending(_Followed(path(0.022, "corrections grow", True), 29.5), FALLING)
    assert status is Status.buckled
    assert reason == (
        "At 30 kPa the equilibrium loses its stability: the actuator buckles; by its volume it "
        "was followed down to 22 kPa. No further step was found."
    )


def test_a_fall_too_small_for_a_limit_point_leaves_the_largest_pressure() -> None:
    pressure = np.array([0.0, 10.0, 39.3406, 39.3390])
    status, reason = ending(_Followed(path(0.039339, "corrections grow", True), 39.0), pressure)
    assert status is Status.buckled
    assert reason is not None
    assert reason.startswith(
        "At 39.34 kPa the equilibrium loses its stability: the actuator buckles."
    )


def test_what_fails_while_it_is_stable_has_not_converged() -> None:
    status, reason = ending(_Followed(path(0.022, "corrections grow"), 29.5), FALLING)
    assert status is Status.not_converged
    assert reason == (
        "Beyond 22 kPa, behind a limit point at 30 kPa, no step of the pressure and, from "
        "29.5 kPa on, of the volume converged (corrections grow)."
    )


@pytest.mark.skipif(
    not isinstance(linear_solver(), PardisoSolver), reason="SuperLU does not count eigenvalues"
)
def test_a_column_that_its_weight_buckles() -> None:
    """Held at the lower end, without paper, symmetric: straight until it buckles.

    Solid, it would do so at q L³ = 7.84 E I, I = 4 · 6³/12 mm⁴, q = 0.027 N/mm: at 1,100 m/s² for
    1,000 kg/m³ in 24 mm².
    """
    mesh = hollow_block((24.0, 4.0, 6.0), (12, 2, 3), ((3, 9), (0, 1), (1, 2)), 1, True)
    less = replace(mesh, surfaces={k: v for k, v in mesh.surfaces.items() if k != "paper"})
    wanted = Actuation(maximum_pressure_kPa=2.0, gravity_m_s2=(-3000.0, 0.0, 0.0), contact=False)
    found = free_actuation(less, elastomer("yeoh", C10=0.11, C20=0.02), PAPER, wanted)
    assert found.status is Status.buckled
    assert found.reason is not None
    assert found.reason.startswith("Before any pressure, at ")
    share = float(found.reason.split("at ")[1].split("%")[0]) / 100
    assert 0.25 < share < 0.5
    assert [state.pressure_kPa for state in found.states] == [0.0]
