"""From rest to the last pressure, by control of the pressure and where that fails of the volume."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.limit_points import limit_points
from pagd.actuation.model import Model
from pagd.actuation.recorder import Recorder
from pagd.actuation.result import ActuationResult, Figures, Guide
from pagd.actuation.settings import Actuation
from pagd.errors import Status
from pagd.fem.assembly import Assembly, State
from pagd.fem.conjugate import ConjugatePath
from pagd.fem.contact import FaceContact
from pagd.fem.continuation import Begun, Continuation, LoadPath, Step, StepControl
from pagd.fem.guided import GuidedPath
from pagd.fem.linear_solver import LinearSolver, linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.plane_contact import PlaneContact

FloatArray = NDArray[np.float64]

_KPA = 1e-3  # MPa

# Where points come into contact or leave it, corrections need not shrink at once, and more of them
# with the same factors are worth their while.
_PATIENT: dict[str, Any] = {"iterations": 14, "growth": 2.0, "contraction": 0.55, "reuses": 8}

# Largest factor from one step to the next: rows of chambers have smooth paths until walls touch.
_GROWTH = 5.0

# So near, as a share of the pressure, an actuator is followed to where it is foretold to buckle,
# and a held one to a pressure that it does not reach.
_RESOLUTION = 0.01

# Pressures that differ by less than this share are the same.
_SAME = 1e-9

# Gravity is raised in so many steps at first, and by no less than so many of these.
_GRAVITY_STEP, _SMALLEST_GRAVITY_STEP = 0.25, 1e-3


@dataclass(frozen=True, slots=True)
class _Followed:
    """How a path ended, and how it was followed.

    guided_to: pressure (kPa) up to which first guesses led. volume_controlled_from: the one from
    which on the volume was controlled.
    """

    path: LoadPath
    volume_controlled_from: float | None = None
    guided_to: float | None = None


def follow(
    body: Model,
    assembly: Assembly,
    actuation: Actuation,
    recorder: Recorder,
    wanted_correction: float = 1.0,
    guide: Guide | None = None,
    solver: LinearSolver | None = None,
) -> ActuationResult:
    """Raise the pressure through the recorded ones, as far as it goes.

    Parameters
    ----------
    body
        The actuator.
    assembly
        Its terms, with all that is held.
    actuation
        Pressures and tolerances.
    recorder
        Is called with every converged step, the unloaded one first.
    wanted_correction
        First correction of a node, in mm, that steps are chosen for; see :class:`StepControl`.
    guide
        First guesses, if there are any.
    solver
        The linear solver, which then keeps its factors; without it, one as ``actuation`` names it
        is made, and freed at the end.
    """
    kept, solver = solver, solver or linear_solver(actuation.linear_solver)
    touches = any(isinstance(term, FaceContact | PlaneContact) for term in assembly.terms)
    settings = NewtonSettings(tolerance=actuation.tolerance_mm, **(_PATIENT if touches else {}))
    newton = Newton(assembly, solver, 3 * body.nodes, settings, body.pressure, recorder.force)
    followed = _follow(body, newton, actuation, recorder, wanted_correction, guide)
    # Where the path ends early, how far it came is a result too.
    recorder.record_last()
    if kept is None:
        solver.free()
    history = recorder.history()
    profile = _profile(assembly, solver, recorder)
    status, reason = _ending(followed, recorder, history["pressure_kPa"])
    figures = _figures(body, assembly, followed, solver) | _limits(history) | _gaps(body, history)
    figures["profile_s"] = profile
    return ActuationResult(status, reason, recorder.states, history, figures)


def _follow(
    body: Model,
    newton: Newton,
    actuation: Actuation,
    recorder: Recorder,
    wanted_correction: float,
    guide: Guide | None,
) -> _Followed:
    start, failure = _at_rest(body, newton)
    recorder(Step(start, 0, True))
    if failure:
        recorder.ending = failure
        return _Followed(LoadPath(0.0, 0, 0, 0, failure=failure[1]))
    held = recorder.force is not None
    control = StepControl(
        first=actuation.first_step_kPa * _KPA,
        smallest=actuation.smallest_step_kPa * _KPA,
        wanted_correction=wanted_correction,
        growth=_GROWTH,
        dense=True,
        # With the tip held, contact is hard to step into from afar.
        wary=held,
        foresight=_RESOLUTION,
        resolution=_RESOLUTION if held else 0.0,
    )
    pressures = list(actuation.recorded_kPa() * _KPA)
    begun, guided_to = Begun((start,)), None
    if guide is not None and len(guide.pressure_kPa) and body.gravity is None:
        begun = _guided(body, newton, guide, recorder, start)
        guided_to = begun.path.load / _KPA
        if begun.path.stopped:
            return _Followed(begun.path, guided_to=guided_to)
        pressures = [p for p in pressures if p > begun.path.load * (1 + _SAME)]
    continuation = Continuation(newton, control)
    path = continuation.follow(pressures, recorder, begun=begun)
    if not path.failure or len(continuation.states) < 2 or not _may_go_on(path, recorder):
        return _Followed(path, guided_to=guided_to)
    left = [pressure for pressure in pressures if pressure > path.load]
    # Limit points are where steps have to be small.
    careful = replace(control, growth=StepControl().growth, retry_again=control.retry)
    volumes = ConjugatePath(newton, careful)
    further = volumes.follow(continuation.states, left, recorder, path)
    if further.steps == path.steps:
        return _Followed(further, guided_to=guided_to)
    return _Followed(further, path.load / _KPA, guided_to)


def _guided(body: Model, newton: Newton, guide: Guide, recorder: Recorder, start: State) -> Begun:
    """How far the first guesses lead."""
    guided = GuidedPath(newton, lambda load: guide.state(body, load / _KPA))
    between = [float(pressure) * _KPA for pressure in guide.between_kPa]
    loads = sorted([*(float(pressure) * _KPA for pressure in guide.pressure_kPa), *between])
    path = guided.follow(loads, recorder, start, between)
    return Begun(guided.states, path)


def _may_go_on(path: LoadPath, recorder: Recorder) -> bool:
    """Whether a rising volume may lead on where a rising pressure does not.

    Past a limit point it does. With a held tip, nothing else of that kind has been seen.
    """
    if path.critical is not None:
        return not path.critical.under_conjugate
    return recorder.force is None


def _at_rest(body: Model, newton: Newton) -> tuple[State, tuple[Status, str] | None]:
    """The state without pressure, under gravity where there is any; why not all of gravity."""
    state = newton.assembly.at_rest()
    newton.assembly.look_around(state)
    if body.gravity is None:
        return _with_reaction(newton, state), None
    share, step, is_unstable = 0.0, _GRAVITY_STEP, False
    while share < 1.0:
        body.gravity.share = min(share + step, 1.0)
        result = newton.solve(state)
        if result.state is not None and not result.is_unstable:
            share, state = body.gravity.share, result.state
            continue
        step, is_unstable = step / 2, is_unstable or result.is_unstable
        if step < _SMALLEST_GRAVITY_STEP:
            body.gravity.share = share
            failure = _too_heavy(share, result.reason, is_unstable)
            return _with_reaction(newton, state), failure
    # Once more, from as near as that: the force on a plate shows every micrometre.
    return newton.solve(state).state or state, None


def _with_reaction(newton: Newton, state: State) -> State:
    newton.assembly.linearize(state)
    return newton.with_reaction(state)


def _too_heavy(share: float, failure: str, is_unstable: bool) -> tuple[Status, str]:
    """Why no more than a share of gravity can act; whether a try for more was unstable."""
    if is_unstable:
        reason = f"Before any pressure, at {share:.1%} of gravity, the actuator buckles."
        return Status.buckled, reason
    return Status.not_converged, (
        f"No equilibrium beyond {share:.1%} of gravity was found, before any pressure ({failure})."
    )


def _ending(
    followed: _Followed, recorder: Recorder, pressure_kPa: FloatArray
) -> tuple[Status, str | None]:
    path = followed.path
    if recorder.ending:
        return recorder.ending
    if not path.failure:
        return Status.ok, None
    limits = limit_points(pressure_kPa)
    highest = float(pressure_kPa[limits[-1]] if len(limits) else pressure_kPa.max())
    if path.critical is not None and path.critical.under_conjugate:
        return Status.buckled, (
            f"At {path.critical.load / _KPA:.4g} kPa, as its stiffness up to "
            f"{path.load / _KPA:.4g} kPa foretells, the equilibrium loses its stability: the "
            "actuator buckles."
        )
    if path.unstable_load < math.inf:
        return Status.buckled, (
            f"Between {path.load / _KPA:.4g} and {path.unstable_load / _KPA:.4g} kPa the "
            "equilibrium loses its stability: the actuator buckles."
        )
    if path.is_unstable:
        reason = f"At {highest:.4g} kPa the equilibrium loses its stability: the actuator buckles"
        if len(limits):
            reason += f"; by its volume it was followed down to {path.load / _KPA:.4g} kPa"
        return Status.buckled, f"{reason}. No further step was found."
    means = "no step of the pressure"
    if followed.volume_controlled_from is not None:
        means += f" and, from {followed.volume_controlled_from:.4g} kPa on, of the volume"
    beyond = f"Beyond {path.load / _KPA:.4g} kPa"
    if len(limits):
        beyond += f", behind a limit point at {highest:.4g} kPa,"
    return Status.not_converged, f"{beyond} {means} converged ({path.failure})."


def _figures(body: Model, assembly: Assembly, followed: _Followed, solver: LinearSolver) -> Figures:
    path = followed.path
    figures: Figures = {
        "tets": len(body.mesh.tets),
        "element": body.element,
        "unknowns": len(assembly.free),
        "newton_iterations": path.iterations,
        "factorisations": solver.factorisations,
        "corrections": path.corrections,
        "steps": path.steps,
        "rejected_steps": path.rejected,
        "pressure_kPa": path.load / _KPA,
        "solid_volume_mm3": body.solid_volume,
        "linear_solver": solver.name,
        "stability_checked": solver.negative_pivots is not None,
    }
    if solver.factor_nonzeros is not None:
        figures["factor_nonzeros"] = solver.factor_nonzeros
    if path.critical is not None:
        figures["critical_pressure_kPa"] = path.critical.load / _KPA
    if followed.guided_to is not None:
        figures["guided_to_kPa"] = followed.guided_to
    if followed.volume_controlled_from is not None:
        figures["volume_controlled_from_kPa"] = followed.volume_controlled_from
    return figures


def _profile(assembly: Assembly, solver: LinearSolver, recorder: Recorder) -> dict[str, float]:
    """Processor time by part, in s."""
    parts = assembly.clock.seconds | solver.clock.seconds | recorder.clock.seconds
    return {name: round(seconds, 3) for name, seconds in sorted(parts.items())}


def _limits(history: dict[str, FloatArray]) -> Figures:
    pressure = history["pressure_kPa"]
    return {
        "largest_pressure_kPa": float(pressure.max()),
        "limit_points": len(limit_points(pressure)),
    }


def _gaps(body: Model, history: dict[str, FloatArray]) -> Figures:
    """What the history says of gaps, where there is contact."""
    if body.contact is None:
        return {}
    gap = history["smallest_gap_mm"]
    known, initial = gap[np.isfinite(gap)], body.initial_gap
    depth = max(0.0, -float(known.min(initial=0.0)))
    figures: Figures = {
        "initial_gap_mm": initial,
        "deepest_penetration_mm": depth,
        "penetration_share": depth / initial,
    }
    if len(known):
        figures["smallest_gap_mm"] = float(known[-1])
    return figures
