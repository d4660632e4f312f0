"""Free actuation: the tip goes where the pressure takes it."""

from __future__ import annotations

from pagd.actuation.body import Body
from pagd.actuation.follow import follow
from pagd.actuation.recorder import Recorder
from pagd.actuation.result import ActuationResult, Guide, Progress, Stop
from pagd.actuation.settings import Actuation
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import Mesh


def free_actuation(
    mesh: Mesh | Body,
    material: Elastomer,
    paper: Sheet,
    actuation: Actuation | None = None,
    stop: Stop | None = None,
    progress: Progress | None = None,
    guide: Guide | None = None,
) -> ActuationResult:
    """Raise the pressure from zero, as far as the actuator goes.

    Parameters
    ----------
    mesh
        The actuator; ``fixed`` is held, ``cavity`` carries the pressure. A :class:`Body` made of
        the same material, paper and settings before saves making it again.
    material, paper
        The elastomer and the paper.
    actuation
        Pressures, element and tolerances.
    stop
        Called with the pressure in kPa and the displacement (n, 3) of each converged step;
        a status and a reason end the analysis.
    progress
        Called with the pressure in kPa and the iterations of each converged step.
    guide
        First guesses at the recorded pressures; where they lead no further, and without any, the
        path is followed step by step. Not used under gravity.

    Returns
    -------
    ActuationResult
        Not reaching the last pressure is a result: its status and reason say why.

    Raises
    ------
    InputError
        Where the mesh or the settings cannot be used.
    """
    wanted = actuation or Actuation()
    body = mesh if isinstance(mesh, Body) else Body(mesh, material, paper, wanted)
    return follow(body, body.assembly(), wanted, Recorder(body, stop, progress), guide=guide)
