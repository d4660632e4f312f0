"""Cells that a screw motion repeats."""

from __future__ import annotations

import pytest
from catalogue import quick
from figure import Case, Group
from written_page import check_case


@pytest.mark.parametrize("case", quick(Group.cells), ids=lambda case: case.name)
def test_cells(case: Case) -> None:
    check_case(case)
