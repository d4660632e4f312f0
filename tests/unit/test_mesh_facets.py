import numpy as np
import pytest
from mesh_samples import ball_pair, block_pair, half_pair

from pagd.mesh.facets import Facets, coplanar_groups, facets_of, is_finely_curved
from pagd.mesh.joining import Complex, Patch, join
from pagd.mesh.topology import edge_neighbours


def corners_of(facets: Facets, loop: list[int]) -> list[int]:
    """Corners along a loop, checking that each edge starts where the last one ended."""
    ends = [facets.edges[abs(e) - 1][:: 1 if e > 0 else -1] for e in loop]
    for one, following in zip(ends, ends[1:] + ends[:1], strict=True):
        assert one[1] == following[0]
    return [int(end[0]) for end in ends]


def test_block_with_void_is_seventeen_rectangles() -> None:
    facets = facets_of(join(block_pair()))
    assert np.bincount(facets.patches).tolist() == [5 + 6, 5, 1]
    assert all(len(loops) == 1 for loops in facets.loops)
    assert all(len(set(corners_of(facets, loops[0]))) == 4 for loops in facets.loops)
    assert len(np.unique(facets.shells)) == 4  # outside above, void, below, paper


def test_fine_triangles_and_vertices_along_straight_edges_leave_no_trace() -> None:
    # The body of the half pair comes as a fine grid. Its symmetry plane is cut by the void.
    facets = facets_of(join(half_pair()))
    assert np.bincount(facets.patches).tolist() == [5 + 5, 5, 1]
    assert len(facets.edges) == 12 + 8 + 12


def test_every_edge_is_walked_once_each_way_within_a_closed_patch() -> None:
    facets = facets_of(join(block_pair()))
    for patch in (Patch.above, Patch.below):
        walks = [
            e if facets.patches[i] == patch or patch is Patch.above else -e
            for i, loops in enumerate(facets.loops)
            if facets.patches[i] in (patch, Patch.paper)
            for loop in loops
            for e in loop
        ]
        assert sorted(walks) == sorted(-e for e in walks)
        assert len(walks) == len(set(walks))


def test_face_with_a_window_has_the_outer_loop_first() -> None:
    facets = facets_of(join(half_pair()))
    windowed = [loops for loops in facets.loops if len(loops) == 2]
    assert len(windowed) == 1
    spans = [np.ptp(facets.points[corners_of(facets, loop)], axis=0)[0] for loop in windowed[0]]
    assert spans == [20.0, 12.0]


def test_needles_join_the_facet_they_lie_in() -> None:
    """A vertex a rounding error off a straight edge makes a triangle with any normal."""
    points = np.array([[0.0, 0, 0], [10, 0, 0], [5, 0, 1e-5], [5, 5, 0], [5, 0, -8]])
    triangles = np.array([[0, 2, 3], [2, 1, 3], [0, 1, 2], [1, 0, 4]])
    flat = Complex(points, triangles, np.zeros(4, np.int64), 0.0, 1e-4, False)
    groups = coplanar_groups(flat, edge_neighbours(triangles))
    assert groups[0] == groups[1]
    assert groups[2] in (groups[0], groups[3])
    assert groups[3] != groups[0]


@pytest.mark.parametrize(("size", "expected"), [(3.0, True), (0.1, False)])
def test_curved_surfaces_count_only_where_they_are_finer_than_the_mesh(
    size: float, expected: bool
) -> None:
    assert is_finely_curved(join(ball_pair()), size) is expected


def test_polyhedra_are_not_curved_even_if_finely_divided() -> None:
    assert not is_finely_curved(join(half_pair()), 100.0)
    assert not is_finely_curved(join(block_pair()), 100.0)


def test_facet_whose_windows_touch_at_a_corner_is_traced_completely() -> None:
    """A sheet of 4 x 4 cells without two that share a corner."""
    cells = [(i, j) for i in range(4) for j in range(4) if (i, j) not in ((1, 1), (2, 2))]
    quads = [[5 * i + j, 5 * i + j + 5, 5 * i + j + 6, 5 * i + j + 1] for i, j in cells]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    points = np.array([(i, j, 0.0) for i in range(5) for j in range(5)])
    sheet = Complex(points, triangles, np.zeros(len(triangles), np.int64), 0.0, 1e-6, False)
    (loops,) = facets_of(sheet).loops
    assert len(loops[0]) == 4
    assert sorted(abs(e) for loop in loops for e in loop) == list(range(1, 4 + 8 + 1))
    for loop in loops:
        corners_of(facets_of(sheet), loop)
