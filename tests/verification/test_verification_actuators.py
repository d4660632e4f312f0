"""Whole actuators."""

from __future__ import annotations

import pytest
from catalogue import quick
from figure import Case, Group
from written_page import check_case

GROUPS = (Group.pressure, Group.symmetry, Group.programs, Group.meshes)


@pytest.mark.parametrize("case", quick(*GROUPS), ids=lambda case: case.name)
def test_actuators(case: Case) -> None:
    check_case(case)
