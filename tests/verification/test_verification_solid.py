"""Solids against closed forms and published results."""

from __future__ import annotations

import cases_inflation
import cases_solid
import pytest
from cases_inflation import Body, Cylinder, Sphere
from closed_forms import (
    NEO_HOOKE,
    YEOH,
    Coefficients,
    bending_moment,
    cylinder_pressure,
    sphere_pressure,
)
from figure import check
from scipy.optimize import minimize_scalar

each_element = pytest.mark.parametrize("element", cases_solid.ELEMENTS)
each_body = pytest.mark.parametrize("body", [Sphere, Cylinder])
each_material = pytest.mark.parametrize("material", cases_inflation.MATERIALS)

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
    found = minimize_scalar(
        lambda s: -1e3 * sphere_pressure(NEO_HOOKE, 10.0, 15.0, s),
        bounds=(1.3, 1.9),
        method="bounded",
    )
    assert -found.fun == pytest.approx(108.574, abs=6e-4)
    assert found.x == pytest.approx(1.6034, abs=1e-4)


def test_closed_form_gives_the_listed_moments() -> None:
    """Per width in N at 45, 90 and 180°; and a small angle as a beam of E/(1 − ν²) = 4 µ."""
    angles = (0.7853981634, 1.5707963268, 3.1415926536)
    found = [bending_moment(0.22, 4.0, 20.0, angle) for angle in angles]
    assert found == pytest.approx([0.18296, 0.358242, 0.664684], abs=6e-6)
    small = 1e-2
    assert bending_moment(0.22, 4.0, 20.0, small) == pytest.approx(
        4 * 0.22 * 4**3 / 12 * small / 20, rel=1e-4
    )


@each_element
@each_body
@each_material
def test_inner_wall_moved(body: Body, material: str, element: str) -> None:
    check(cases_inflation.moved_wall(body, material, element))


@each_body
@each_material
def test_inner_wall_under_pressure(body: Body, material: str) -> None:
    check(cases_inflation.follower(body, material))


@each_element
def test_patch(element: str) -> None:
    check(cases_solid.patch_test(element))


@each_element
def test_rigid_rotation(element: str) -> None:
    check(cases_solid.rigid_rotation(element))


def test_order_of_convergence() -> None:
    check(cases_solid.convergence())


def test_block_bending() -> None:
    check(cases_solid.block_bending())


def test_cook_membrane() -> None:
    check(cases_solid.cook_membrane())
