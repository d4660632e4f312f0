"""Planes, gravity, blocked force."""

from __future__ import annotations

import pytest
from catalogue import quick
from figure import Case, Group
from written_page import check_case


@pytest.mark.parametrize("case", quick(Group.supports), ids=lambda case: case.name)
def test_supports(case: Case) -> None:
    check_case(case)
