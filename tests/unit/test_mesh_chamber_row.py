"""The structured mesh of a row of chambers: exact, conforming, and the same as its tetrahedra."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from design_samples import TABLE2

from pagd.catalogue import read_designs
from pagd.design import Channel, Design, GeometryRules, base_volume, body_volume, cavity_volume
from pagd.errors import InputError, StageFailure
from pagd.fem.cells import reference_geometry
from pagd.fem.follower_pressure import FollowerPressure
from pagd.mesh.blocks import (
    HEXAHEDRON_TETS,
    WEDGE_TETS,
    block_faces,
    check_blocks,
    hexahedra,
    wedges,
)
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.checks import check_actuator
from pagd.mesh.msh import read_msh, write_msh
from pagd.mesh.quality import mesh_quality

DESIGNS = {name: d.design for name, d in read_designs({"table2": str(TABLE2)}).items()}
BENDING, TWISTING, MIXED = (DESIGNS[name] for name in ("bending", "twisting", "mixed"))
each_design = pytest.mark.parametrize("design", DESIGNS.values(), ids=DESIGNS)


def volume_of(design: Design) -> float:
    return body_volume(design, GeometryRules()) + base_volume(design)


@each_design
def test_volume_and_cavity_are_exact(design: Design) -> None:
    mesh = chamber_row(design, Channel(), 8.0)
    check_actuator(mesh)
    assert mesh_quality(mesh).volume_mm3 == pytest.approx(volume_of(design), rel=1e-12)
    four, three = block_faces(mesh, "cavity")
    assert 2 * len(four) + len(three) == len(mesh.surfaces["cavity"])
    assert len(four) > 0
    for cavity in (
        FollowerPressure(mesh.points, mesh.surfaces["cavity"]),
        FollowerPressure(mesh.points, three, quadrilaterals=four),
    ):
        held = cavity.volume(np.zeros(mesh.points.size))
        assert held == pytest.approx(cavity_volume(design, GeometryRules()), rel=1e-12)


@each_design
def test_blocks_fill_what_their_tetrahedra_do(design: Design) -> None:
    mesh = chamber_row(design, Channel(), 6.0)
    six, three = hexahedra(mesh), wedges(mesh)
    assert (len(six), len(three)) == (mesh.hexahedra, mesh.wedges)
    assert (mesh.wedges > 0) == (not design.is_straight)
    volumes = [reference_geometry(mesh.points, nodes)[1] for nodes in (six, three) if len(nodes)]
    assert sum(v.sum() for v in volumes) == pytest.approx(volume_of(design), rel=1e-12)
    # Each node of the mesh is one of a block, and the other way round.
    used = np.unique(np.concatenate([six.ravel(), three.ravel()]))
    np.testing.assert_array_equal(used, np.arange(len(mesh.points)))


def test_half_of_a_straight_row() -> None:
    mesh = chamber_row(BENDING, Channel(), 8.0, half=True)
    check_actuator(mesh)
    assert mesh_quality(mesh).volume_mm3 == pytest.approx(volume_of(BENDING) / 2, rel=1e-12)
    assert (mesh.points[mesh.nodes_of("symmetry"), 1] == 0).all()
    with pytest.raises(StageFailure, match="slanted row has no plane of symmetry"):
        chamber_row(TWISTING, Channel(), 8.0, half=True)


def test_no_edge_is_longer_than_a_quarter_more_than_the_size() -> None:
    mesh = chamber_row(BENDING, Channel(), 3.0)
    corners = mesh.points[hexahedra(mesh)[:, [0, 18, 6, 2]]]
    edges = np.linalg.norm(corners[:, 1:] - corners[:, :1], axis=2)
    assert edges.max() <= 1.25 * 3.0
    assert mesh.hexahedra > 1.5 * chamber_row(BENDING, Channel(), 6.0).hexahedra


@pytest.mark.parametrize("binary", [True, False])
def test_blocks_survive_the_file(tmp_path: Path, binary: bool) -> None:
    mesh = chamber_row(MIXED, Channel(), 12.0)
    write_msh(mesh, tmp_path / "m.msh", binary)
    read = read_msh(tmp_path / "m.msh")
    assert (read.hexahedra, read.wedges) == (mesh.hexahedra, mesh.wedges)
    np.testing.assert_array_equal(hexahedra(read), hexahedra(mesh))
    np.testing.assert_array_equal(wedges(read), wedges(mesh))
    np.testing.assert_allclose(read.points, mesh.points, atol=1e-12)


def test_blocks_that_are_torn_are_refused() -> None:
    mesh = chamber_row(TWISTING, Channel(), 12.0)
    swapped = mesh.tets.copy()
    swapped[[0, 6]] = swapped[[6, 0]]
    with pytest.raises(InputError, match="2 blocks of the mesh are not made up"):
        check_blocks(replace(mesh, tets=swapped))
    with pytest.raises(InputError, match="6 and 3 tetrahedra for each"):
        check_blocks(replace(mesh, wedges=mesh.wedges + 1))


def test_tables_cut_the_reference_cells() -> None:
    """Six tetrahedra of 1/6 in the cube, three of 1/6 in the wedge; each node is used."""
    assert set(HEXAHEDRON_TETS.ravel()) == set(range(27))
    for table in WEDGE_TETS:
        assert set(table.ravel()) == set(range(18))
