"""Maxima of the pressure along a path."""

from __future__ import annotations

import numpy as np
import pytest

from pagd.actuation.limit_points import limit_points


@pytest.mark.parametrize(
    ("pressure", "expected"),
    [
        ([], []),
        ([0.0, 1.0, 2.0], []),
        ([0.0, 1.0, 3.0, 2.0, 2.5], [2]),
        ([0.0, 3.0, 1.0, 4.0, 2.0], [1, 3]),
        ([0.0, 3.0, 3.0, 1.0], [1]),
        # The last digits of an iteration are no limit point.
        ([0.0, 8.0, 17.0, 8.2342, 8.2343, 8.23425, 8.2344], [2]),
    ],
)
def test_limit_points(pressure: list[float], expected: list[int]) -> None:
    assert limit_points(np.array(pressure)).tolist() == expected
