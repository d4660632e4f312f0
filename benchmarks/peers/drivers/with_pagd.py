"""Newton iterations of pagd, through its public calls."""

from __future__ import annotations

from job import Job, Measured, read_job


def run(job: Job) -> None:
    """Iterate at the pressure of the job, from rest, and print the seconds."""
    from pagd.actuation import Actuation, Body, use_threads

    settings = job.settings
    use_threads(settings["threads"])

    import numpy as np

    from pagd.fem.assembly import State
    from pagd.fem.linear_solver import linear_solver
    from pagd.materials import elastomer, sheet
    from pagd.mesh.types import Mesh

    surfaces = dict(job.surfaces)
    if settings["paper"] is None:
        surfaces.pop("paper", None)
    mesh = Mesh(points=job.points, tets=job.tets, surfaces=surfaces)
    wanted = Actuation(element=settings["element"], contact=False, blocked_force="none")
    materials = elastomer("elastomer", settings["material"]), sheet("paper", settings["sheet"])
    assembly = (body := Body(mesh, *materials, wanted)).assembly()
    solver, measured = linear_solver(), Measured()
    solver.analyse(assembly.pattern.starts, assembly.pattern.columns)
    rest = assembly.at_rest()
    # Compiles the kernels where that has not been done before.
    assembly.linearize(rest)
    state = State(settings["pressure_MPa"], rest.unknowns, rest.internal)
    free = assembly.free
    for _ in range(settings["iterations"]):
        with measured.assembly():
            _, residual, values = assembly.linearize(state)
        correction = np.zeros(assembly.size)
        with measured.solve():
            correction[free] = solver.solve(values, -residual[free])
        measured.correction_mm.append(float(np.abs(correction[: 3 * len(mesh.points)]).max()))
        state = assembly.advance(state, correction)
    tip = body.displacement(state.unknowns)[job.tip_node()]
    measured.tell(len(free), tip, solver=solver.name)


if __name__ == "__main__":
    run(read_job())
