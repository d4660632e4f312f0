"""Solids against closed forms and published results."""

from __future__ import annotations

import cases_inflation
import pytest
from cases_material import STATES
from catalogue import quick
from closed_forms import (
    NEO_HOOKE,
    YEOH,
    Coefficients,
    bending_moment,
    cylinder_pressure,
    limit_point,
    sphere_pressure,
)
from figure import Case, Group
from written_page import check_case

LISTED = [
    (sphere_pressure, NEO_HOOKE, (48.458, 77.330, 107.399, 100.343)),
    (sphere_pressure, YEOH, (49.316, 82.273, 142.102, 206.116)),
    (cylinder_pressure, NEO_HOOKE, (20.854, 36.082, 62.426, 78.933)),
    (cylinder_pressure, YEOH, (21.008, 37.086, 71.818, 119.320)),
]


@pytest.mark.parametrize(("pressure", "material", "listed"), LISTED)
def test_closed_forms_give_the_listed_pressures(
    pressure: type, material: Coefficients, listed: tuple[float, ...]
) -> None:
    """In kPa at λa = 1.1, 1.2, 1.5 and 2, to the digits listed."""
    found = [1e3 * pressure(material, 10.0, 15.0, s) for s in cases_inflation.STRETCHES]
    assert found == pytest.approx(listed, abs=6e-4)


def test_limit_point_of_the_sphere() -> None:
    stretch, pressure = limit_point(NEO_HOOKE, 10.0, 15.0)
    assert 1e3 * pressure == pytest.approx(108.574, abs=6e-4)
    assert stretch == pytest.approx(1.6034, abs=1e-4)


def test_homogeneous_states_have_the_listed_stresses() -> None:
    """In kPa at λ = 1.5 and 2."""
    listed = [(281.48, 665.0), (486.85, 1230.47), (331.69, 750.0)]
    for state, stresses in zip(STATES, listed, strict=True):
        found = [1e3 * state.stress(stretch, *YEOH) for stretch in (1.5, 2.0)]
        assert found == pytest.approx(stresses, abs=6e-3)


def test_closed_form_gives_the_listed_moments() -> None:
    """Per width in N at 45, 90 and 180°; and a small angle as a beam of E/(1 − ν²) = 4 µ."""
    angles = (0.7853981634, 1.5707963268, 3.1415926536)
    found = [bending_moment(0.22, 4.0, 20.0, angle) for angle in angles]
    assert found == pytest.approx([0.18296, 0.358242, 0.664684], abs=6e-6)
    small = 1e-2
    assert bending_moment(0.22, 4.0, 20.0, small) == pytest.approx(
        4 * 0.22 * 4**3 / 12 * small / 20, rel=1e-4
    )


@pytest.mark.parametrize("case", quick(Group.solids, Group.rates), ids=lambda case: case.name)
def test_solids(case: Case) -> None:
    check_case(case)
