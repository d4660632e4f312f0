"""The example designs."""

from __future__ import annotations

import cases_actuators
import pytest
from figure import Rows, check


@pytest.mark.slow
def test_element_table() -> None:
    check(cases_actuators.element_table())


@pytest.mark.parametrize(
    "case",
    [
        cases_actuators.other_library,
        cases_actuators.balance_of_energy,
        cases_actuators.resultants,
        cases_actuators.mirror,
        cases_actuators.no_twist,
        cases_actuators.half_and_whole,
    ],
    ids=lambda case: case.__name__,
)
def test_actuators(case: Rows) -> None:
    check(case())
