"""Deformed states for ParaView: one VTU file a state, and a PVD file that lists them."""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from pagd.files import replaced_file, write_text
from pagd.mesh.types import Mesh
from pagd.states import States

__all__ = ["write_state", "write_vtu"]

# VTK numbers the edges (1, 3) and (2, 3) of a tetrahedron the other way round.
_ORDER = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]


def write_vtu(mesh: Mesh, states: States, folder: Path) -> Path:
    """Write every state on the undeformed mesh; ParaView's filter "Warp By Vector" deforms it.

    Fields at the nodes: ``displacement`` in mm and ``strain``, the largest principal
    logarithmic one.

    Returns
    -------
    Path
        The PVD file, to be opened in ParaView; its time is the pressure in kPa.
    """
    names = [f"state_{i:03d}.vtu" for i in range(len(states.pressure_kPa))]
    for i, name in enumerate(names):
        write_state(mesh, states, i, folder / name)
    listed = "".join(
        f"<DataSet timestep={quoteattr(f'{p:g}')} file={quoteattr(name)}/>\n"
        for p, name in zip(states.pressure_kPa, names, strict=True)
    )
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n'
    write_text(folder / "states.pvd", f"{head}{listed}</Collection>\n</VTKFile>\n")
    return folder / "states.pvd"


def write_state(mesh: Mesh, states: States, state: int, path: Path) -> None:
    """Write one state, by its number, as :func:`write_vtu` does, to a file NAME.vtu."""
    import pyvista

    cells = {pyvista.CellType.QUADRATIC_TETRA: mesh.tets[:, _ORDER]}
    grid = pyvista.UnstructuredGrid(cells, mesh.points)
    grid.point_data["displacement"] = states.displacement[state].astype(np.float32)
    grid.point_data["strain"] = states.strain[state].astype(np.float32)
    with replaced_file(path) as temporary:
        grid.save(temporary)
