from __future__ import annotations

from cases_contact import narrow_row, two_blocks
from figure import check


def test_two_blocks_act_as_one() -> None:
    check(two_blocks())


def test_walls_that_touch_push_each_other_apart() -> None:
    check(narrow_row())
