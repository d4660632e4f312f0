import numpy as np
import pytest

from pagd.errors import StageFailure
from pagd.mesh.primitives import grid
from pagd.mesh.tagging import name_surfaces
from pagd.mesh.topology import boundary_faces
from pagd.mesh.types import FloatArray, IntArray


def hollow(*voids: tuple[slice, slice, slice]) -> tuple[FloatArray, IntArray]:
    """A row of 9 x 4 x 4 cells of 1 mm without those in the voids."""
    solid = np.ones((9, 4, 4), dtype=np.bool_)
    for void in voids:
        solid[void] = False
    return grid((9.0, 4.0, 4.0), solid)


FIRST = (slice(1, 4), slice(1, 3), slice(2, 3))
SECOND = (slice(5, 8), slice(1, 3), slice(2, 3))


def counts(points: FloatArray, tets: IntArray, half: bool = False) -> dict[str, int]:
    named = name_surfaces(points, tets, 1.0, half, 1e-9)
    on_boundary = np.vstack([faces for name, faces in named.items() if name != "paper"])
    assert len(on_boundary) == len(boundary_faces(tets))
    assert len(np.unique(np.sort(on_boundary, axis=1), axis=0)) == len(on_boundary)
    return {name: len(faces) for name, faces in named.items()}


def test_every_boundary_face_gets_one_name() -> None:
    # Two triangles a square: 4 x 4 at the ends, 9 x 4 in the paper, 3 x 2 x 1 around the void.
    found = counts(*hollow(FIRST))
    assert found["fixed"] == found["tip"] == 32
    assert found["paper"] == 72
    assert found["cavity"] == 2 * (2 * 6 + 2 * 3 + 2 * 2)


def test_separate_cavities_are_one_surface() -> None:
    assert counts(*hollow(FIRST, SECOND))["cavity"] == 2 * counts(*hollow(FIRST))["cavity"]


def test_cavity_cut_open_by_the_symmetry_plane_is_still_the_cavity() -> None:
    cut = (slice(1, 4), slice(0, 1), slice(2, 3))
    found = counts(*hollow(cut), half=True)
    assert found["cavity"] == 2 * (2 * 3 + 3 + 2)
    assert found["symmetry"] == 2 * (9 * 4 - 3)


def test_air_that_can_get_out_is_refused() -> None:
    with pytest.raises(StageFailure, match="has no cavity"):
        counts(*hollow((slice(1, 4), slice(0, 3), slice(2, 3))))


def test_paper_that_is_not_where_it_should_be_is_refused() -> None:
    points, tets = hollow(FIRST)
    with pytest.raises(StageFailure, match=r"lie up to 0\.\d+ mm off it"):
        name_surfaces(points, tets, 1.4, False, 1e-9)
    with pytest.raises(StageFailure, match="no face on surface paper"):
        name_surfaces(points, tets, -3.0, False, 1e-9)
