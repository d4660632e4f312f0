from __future__ import annotations

from cases_supports import block_on_plane, own_weight
from figure import check


def test_a_block_on_a_rigid_plane() -> None:
    check(block_on_plane())


def test_bars_under_their_own_weight() -> None:
    check(own_weight())
