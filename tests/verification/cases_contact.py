"""Contact: two blocks that act as one, but for the known give of the penalty; a narrow row."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from actuators import default_elastomer, default_paper, mesh_of_design, trajectory_of_design
from closed_forms import YEOH
from figure import Figure
from scipy.optimize import brentq
from solving import elastomer, held, solid_of, solve

from pagd.actuation import Actuation, ActuationResult, Body, blocked_force, free_actuation
from pagd.design import Design
from pagd.fem.contact import ContactLaw, FaceContact
from pagd.fem.contact_kernels import pressure_law
from pagd.materials import Elastomer
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh
from pagd.metrics import energy_balance, work_of_pressure

#: Thin walls 1 mm apart, which touch at a few kPa.
NARROW = Design(
    L=7, W=14, H=13, t=1.5, t_n=1, t_h=2, t_ab=1.2, t_b=2.5, N=3, theta=0, alpha=0
)  # fmt: skip
SETTINGS = Actuation(maximum_pressure_kPa=50.0, recorded_step_kPa=10.0, tolerance_mm=1e-3)
#: A third of the default law's width, and three times its stiffness.
SHARP = ContactLaw(stiffness=3 * ContactLaw().stiffness, width=ContactLaw().width / 3)

BLOCKS = "closed form: uniaxial compression, gap by the contact law"
SIDE, HEIGHT, GAP, PRESSED = 4.0, 3.0, 0.1, 0.4


def pair() -> Mesh:
    """Two blocks one above the other, of meshes that do not match, a gap between them."""
    lower, upper = box((SIDE, SIDE, HEIGHT), (2, 2, 2)), box((SIDE, SIDE, HEIGHT), (3, 3, 2))
    raised = upper.points + np.array([0.0, 0.0, HEIGHT + GAP])
    offset = len(lower.points)
    surfaces = {
        "x0": np.vstack([lower.surfaces["x0"], upper.surfaces["x0"] + offset]),
        "y0": np.vstack([lower.surfaces["y0"], upper.surfaces["y0"] + offset]),
        "bottom": lower.surfaces["z0"],
        "master": lower.surfaces["z1"],
        "slave": upper.surfaces["z0"] + offset,
        "top": upper.surfaces["z1"] + offset,
    }
    return Mesh(
        points=np.vstack([lower.points, raised]),
        tets=np.vstack([lower.tets, upper.tets + offset]),
        surfaces=surfaces,
    )


def two_blocks() -> list[Figure]:
    """The upper block is moved down by 0.4 mm: closes the gap of 0.1 mm, compresses both.

    Expected, in each block: uniaxial stress at the stretch that is left, with the gap that the
    penalty keeps open at that pressure.
    """
    mesh, material, law = pair(), elastomer(YEOH), ContactLaw(stiffness=20.0, width=0.04)
    fixed = held(mesh, x0="x", y0="y", bottom="z", top="z")
    top = mesh.nodes_of("top")

    def pressed(load: float) -> np.ndarray:
        field = np.zeros(mesh.points.shape)
        field[top, 2] = -load * PRESSED
        return field

    contact = FaceContact(mesh.points, mesh.surfaces["slave"], mesh.surfaces["master"], law)
    (solved,) = solve(
        mesh.points, [solid_of(mesh, material), contact], fixed, [1.0], pressed, first=0.1
    )
    force, gap = _expected(material, law)
    return [
        Figure(
            name="two blocks pressed together: force",
            source=BLOCKS,
            reference=force,
            value=float(-solved.reactions[top, 2].sum()),
            tolerance=5e-3,
            unit="N",
        ),
        Figure(
            name="two blocks pressed together: force on the lower one",
            source=BLOCKS,
            reference=force,
            value=float(solved.reactions[mesh.nodes_of("bottom"), 2].sum()),
            tolerance=5e-3,
            unit="N",
        ),
        Figure(
            name="two blocks pressed together: smallest gap",
            source=BLOCKS,
            reference=gap,
            value=contact.smallest_gap,
            tolerance=0.02,
            unit="mm",
            scale=law.width,
        ),
    ]


def _expected(material: Elastomer, law: ContactLaw) -> tuple[float, float]:
    """Force in N and gap in mm; the slave's undeformed area carries the pressure."""
    c10, c20 = YEOH

    def nominal(stretch: float) -> float:
        # Incompressible to within the 0.1 % that ν = 0.499 leaves.
        excess = stretch**2 + 2 / stretch - 3
        return -2 * (c10 + 2 * c20 * excess) * (stretch - 1 / stretch**2)

    def unbalanced(gap: float) -> float:
        stretch = 1 - (PRESSED - GAP + gap) / (2 * HEIGHT)
        return nominal(stretch) + pressure_law(gap, law.stiffness, law.width)[1]

    gap = float(brentq(unbalanced, -law.width, law.width))
    return -pressure_law(gap, law.stiffness, law.width)[1] * SIDE**2, gap


def narrow_row() -> list[Figure]:
    """Three chambers 1 mm apart at 50 kPa, free and with the tip held: how exactly walls touch.

    The pressure of the contact law begins at a gap of 0.06 mm, so that walls stand off, at its
    fringe by 6 % of the initial gap here, before they penetrate. What this give matters: the
    deepest penetration on the way; the distance where walls press hardest; and how a law with a
    third of the width and three times the stiffness changes the bending angle and the blocked
    force. With contact too the actuator stores the work of its pressure.
    """
    half = mesh_of_design(NARROW, 4.0, half=True)
    body, sharp = _body(half), _body(half, SHARP)
    free, blocked = _free(body), _blocked(body)
    return [
        *_gaps(free, blocked),
        _sharper("bending", "°", _bending(half, free), _bending(half, _free(sharp))),
        _sharper("blocked force", "N", _force(blocked), _force(_blocked(sharp))),
        _balance(free),
    ]


def _body(mesh: Mesh, law: ContactLaw | None = None) -> Body:
    return Body(mesh, default_elastomer(), default_paper(), SETTINGS, law=law)


def _free(body: Body) -> ActuationResult:
    return _reached(free_actuation(body, default_elastomer(), default_paper(), SETTINGS))


def _blocked(body: Body) -> ActuationResult:
    return _reached(blocked_force(body, default_elastomer(), default_paper(), SETTINGS))


def _reached(result: ActuationResult) -> ActuationResult:
    assert result.reason is None, result.reason
    return result


def _bending(mesh: Mesh, result: ActuationResult) -> float:
    """Bending angle of the tip at the last state, in degrees."""
    last = result.states[-1]
    pressures = np.array([0.0, last.pressure_kPa])
    states = np.array([0 * last.displacement, last.displacement])
    return float(trajectory_of_design(NARROW, mesh, pressures, states).bending_deg[-1, -1])


def _force(result: ActuationResult) -> float:
    return float(result.figures["blocked_force_N"])


def _gaps(free: ActuationResult, blocked: ActuationResult) -> list[Figure]:
    """How far from each other walls are that press each other; 0 by a law without give."""
    deepest = max(float(r.figures["deepest_penetration_mm"]) for r in (free, blocked))
    row = Figure(
        name="narrow row: deepest penetration / initial gap, free or blocked",
        source="rule: no deeper than 2 % of the gap",
        reference=0.0,
        value=deepest / NARROW.t_n,
        tolerance=0.02,
        scale=1.0,
    )
    hardest = replace(
        row,
        name="narrow row, free: distance where walls press hardest / initial gap",
        source="limit: walls that touch",
        value=abs(float(free.figures["smallest_gap_mm"])) / NARROW.t_n,
        tolerance=0.03,
    )
    return [row, hardest]


def _sharper(what: str, unit: str, ours: float, sharp: float) -> Figure:
    return Figure(
        name=f"narrow row: {what}, what the give of the law changes",
        source="ours with a third of the width, three times the stiffness",
        reference=sharp,
        value=ours,
        tolerance=5e-3,
        unit=unit,
    )


def _balance(free: ActuationResult) -> Figure:
    history = free.history
    work = work_of_pressure(history["pressure_kPa"], history["cavity_volume_mm3"])
    return Figure(
        name="narrow row: energy balance",
        source="identity: a conservative load stores its work",
        reference=0.0,
        value=float(energy_balance(work, history["stored_energy_mJ"])[-1]),
        tolerance=5e-3,
        scale=1.0,
    )
