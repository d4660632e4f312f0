from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pyvista

from pagd.mesh.types import TET_EDGES, Mesh
from pagd.states import States
from pagd.vtu import write_vtu


def one_tetrahedron() -> Mesh:
    corners = np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]])
    points = np.vstack([corners, corners[TET_EDGES].mean(axis=1)])
    return Mesh(points=points, tets=np.arange(10, dtype=np.int64)[None], surfaces={})


def test_paraview_gets_every_state_at_its_pressure(tmp_path: Path) -> None:
    moved = np.arange(60.0).reshape(2, 10, 3)
    pressure = np.array([0.0, 2.5])
    states = States(pressure_kPa=pressure, displacement=moved, strain=moved[..., 0])
    collection = ElementTree.parse(write_vtu(one_tetrahedron(), states, tmp_path)).getroot()
    listed = {float(e.attrib["timestep"]): e.attrib["file"] for e in collection.iter("DataSet")}
    assert sorted(listed) == [0.0, 2.5]
    grid = pyvista.read(tmp_path / listed[2.5])
    np.testing.assert_allclose(grid.point_data["displacement"], moved[1])
    np.testing.assert_allclose(grid.point_data["strain"], moved[1, :, 0])


def test_edge_nodes_lie_where_vtk_expects_them(tmp_path: Path) -> None:
    states = States(
        pressure_kPa=np.zeros(1), displacement=np.zeros((1, 10, 3)), strain=np.zeros((1, 10))
    )
    write_vtu(one_tetrahedron(), states, tmp_path)
    cell = pyvista.read(tmp_path / "state_000.vtu").get_cell(0)
    vtk_edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    for node, (a, b) in enumerate(vtk_edges, start=4):
        np.testing.assert_allclose(cell.points[node], (cell.points[a] + cell.points[b]) / 2)
