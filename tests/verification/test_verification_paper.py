"""The paper shell as an elastica."""

from __future__ import annotations

import numpy as np
import pytest
from catalogue import quick
from closed_forms import elastica_tip
from figure import Case, Group
from scipy.special import ellipk, ellipkinc
from written_page import check_case


def test_elastica_by_elliptic_integrals() -> None:
    """√(P L²/EI) = K(k) − F(arcsin(1/(k√2)), k), 2 k² = 1 + sin of the tip's slope."""
    for load in (0.5, 5.0, 12.0):
        slope = elastica_tip(load)[2]
        modulus = (1 + np.sin(slope)) / 2
        root = ellipk(modulus) - ellipkinc(np.arcsin(1 / np.sqrt(2 * modulus)), modulus)
        assert root**2 == pytest.approx(load, rel=1e-7)


def test_small_loads_bend_as_a_beam() -> None:
    """w = P L³/3EI."""
    _, z, slope = elastica_tip(1e-3)
    assert z == pytest.approx(1e-3 / 3, rel=1e-5)
    assert slope == pytest.approx(1e-3 / 2, rel=1e-5)


@pytest.mark.parametrize("case", quick(Group.paper), ids=lambda case: case.name)
def test_paper(case: Case) -> None:
    check_case(case)
