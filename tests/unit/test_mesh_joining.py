from dataclasses import replace

import numpy as np
import pytest
from mesh_samples import BLOCK_VOLUME, HALF_VOLUME, block_pair, box_surface, half_pair

from pagd.errors import StageFailure, Status
from pagd.mesh.joining import Complex, Patch, join
from pagd.mesh.surfaces import Surface, SurfacePair
from pagd.mesh.topology import doubled_areas, open_edges


def volume_of(joined: Complex, patch: Patch) -> float:
    """Volume the patch encloses together with the paper, which must close it."""
    own = joined.triangles[joined.patches == patch]
    paper = joined.triangles[joined.patches == Patch.paper]
    shell = np.vstack((own, paper if patch is Patch.above else paper[:, ::-1]))
    assert len(open_edges(shell)) == 0
    return Surface(joined.points, shell).volume()


@pytest.mark.parametrize(
    ("pair", "volume"), [(block_pair(), BLOCK_VOLUME), (half_pair(), HALF_VOLUME)]
)
def test_both_regions_are_closed_by_one_paper(pair: SurfacePair, volume: float) -> None:
    joined = join(pair)
    assert joined.plane_z == 2.0
    assert volume_of(joined, Patch.above) + volume_of(joined, Patch.below) == pytest.approx(volume)
    paper = joined.triangles[joined.patches == Patch.paper]
    assert (doubled_areas(joined.points, paper)[:, 2] < 0).all()
    assert joined.half == pair.half


def test_vertices_on_the_outline_of_one_side_split_the_other() -> None:
    # The body of the half pair has vertices every 2 mm along the outline, its base has none.
    joined = join(half_pair())
    below = np.unique(joined.triangles[joined.patches == Patch.below])
    on_outline = joined.points[below][:, 2] == 2.0
    assert on_outline.sum() == 2 * (10 + 5)


def test_rounding_apart_is_bridged() -> None:
    pair = block_pair()
    rng = np.random.default_rng(1)
    shaken = pair.base.points + rng.uniform(-5e-5, 5e-5, pair.base.points.shape)
    joined = join(replace(pair, base=replace(pair.base, points=shaken)))
    assert volume_of(joined, Patch.below) == pytest.approx(400.0, rel=1e-4)


def refusal(body: Surface, base: Surface) -> str:
    with pytest.raises(StageFailure) as caught:
        join(SurfacePair(body, base))
    assert caught.value.status is Status.mesh_failed
    return caught.value.reason


def test_surfaces_that_do_not_meet_are_refused() -> None:
    body = box_surface((0, 0, 0), (20, 10, 8))
    assert "base ends at z = -1 mm" in refusal(body, box_surface((0, 0, -2), (20, 10, -1)))
    assert "covers 200 mm² and the base 180 mm²" in refusal(
        body, box_surface((0, 0, -2), (18, 10, 0))
    )
    assert "same outline" in refusal(body, box_surface((5, 0, -2), (25, 10, 0)))


def test_open_and_inverted_surfaces_are_refused() -> None:
    body, base = box_surface((0, 0, 0), (2, 2, 2)), box_surface((0, 0, -1), (2, 2, 0))
    cut = Surface(body.points, body.triangles[1:])
    assert "body is not closed: 3 edges" in refusal(cut, base)
    assert "base is inside out" in refusal(body, Surface(base.points, base.triangles[:, ::-1]))
