"""Hyperelastic laws: stress and tangent against differences of the energy, known states."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import LAWS, elastomer
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pagd.fem.hyperelastic import deviatoric_response, responses, stresses
from pagd.materials import Elastomer

FloatArray = NDArray[np.float64]

_FIRST, _SECOND = np.array([0, 1, 2, 0, 1, 2]), np.array([0, 1, 2, 1, 2, 0])

CASES = [
    *(pytest.param(elastomer(law), id=law) for law in LAWS),
    pytest.param(elastomer("yeoh", C10=0.11), id="yeoh, 1 term"),
    pytest.param(elastomer("yeoh", C10=0.11, C20=0.02), id="yeoh, 2 terms"),
    pytest.param(elastomer("mooney_rivlin", C10=0.1, C01=0.05), id="mooney_rivlin, 2 terms"),
    pytest.param(elastomer("ogden", mu=[0.07], alpha=[2.77]), id="ogden, 1 term"),
    pytest.param(elastomer("ogden", mu=[0.1, -0.02], alpha=[1.3, -2.0]), id="ogden, 2 terms"),
]
TURN = Rotation.from_rotvec([0.4, 1.2, -0.8]).as_matrix()
GRADIENTS = [
    pytest.param(np.eye(3), id="undeformed"),
    pytest.param(np.array([[1.3, 0.4, -0.2], [0.1, 0.8, 0.3], [-0.3, 0.2, 1.1]]), id="general"),
    pytest.param(TURN @ np.diag([1.6, 1.6, 0.5]), id="two equal stretches"),
    pytest.param(TURN @ np.diag([1.4, 1.4 + 1e-8, 0.6]) @ TURN.T, id="nearly equal stretches"),
    pytest.param(1.2 * TURN, id="three equal stretches"),
]
each_law = pytest.mark.parametrize("material", CASES)
each_gradient = pytest.mark.parametrize("gradient", GRADIENTS)


def response(material: Elastomer, gradient: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    """Energy, Kirchhoff stress (3, 3) and tangent (6, 6) of the isochoric law."""
    b = gradient @ gradient.T / np.linalg.det(gradient) ** (2 / 3)
    stress, tangent = np.empty(6), np.empty((6, 6))
    energy = deviatoric_response(
        material.kind, material.parameters, np.ascontiguousarray(b), stress, tangent
    )
    full = np.empty((3, 3))
    full[_FIRST, _SECOND] = full[_SECOND, _FIRST] = stress
    return energy, full, tangent


def rates() -> list[FloatArray]:
    """The six unit rates of deformation, engineering shears of one."""
    result = []
    for i, j in zip(_FIRST, _SECOND, strict=True):
        rate = np.zeros((3, 3))
        rate[i, j] += 0.5
        rate[j, i] += 0.5
        result.append(rate)
    return result


@each_law
@each_gradient
def test_stress_is_the_derivative_of_the_energy(material: Elastomer, gradient: FloatArray) -> None:
    """τ : d = dW/dt along F(t) = (I + t d) F; central differences, to 1e-8 of the modulus."""
    step = 1e-5
    _, stress, _ = response(material, gradient)
    for rate in rates():
        plus, _, _ = response(material, (np.eye(3) + step * rate) @ gradient)
        minus, _, _ = response(material, (np.eye(3) - step * rate) @ gradient)
        slope = (plus - minus) / (2 * step)
        assert (stress * rate).sum() == pytest.approx(slope, abs=1e-8 * material.shear_modulus)


@each_law
@each_gradient
def test_tangent_is_the_derivative_of_the_stress(material: Elastomer, gradient: FloatArray) -> None:
    """c : d = dτ/dt − d τ − τ d; central differences, to 1e-6 of the modulus."""
    step = 1e-5
    _, stress, tangent = response(material, gradient)
    for column, rate in enumerate(rates()):
        _, plus, _ = response(material, (np.eye(3) + step * rate) @ gradient)
        _, minus, _ = response(material, (np.eye(3) - step * rate) @ gradient)
        slope = (plus - minus) / (2 * step) - rate @ stress - stress @ rate
        np.testing.assert_allclose(
            tangent[:, column], slope[_FIRST, _SECOND], atol=1e-6 * material.shear_modulus
        )


@each_law
@each_gradient
def test_stress_is_deviatoric_and_tangent_symmetric(
    material: Elastomer, gradient: FloatArray
) -> None:
    _, stress, tangent = response(material, gradient)
    assert np.trace(stress) == pytest.approx(0.0, abs=1e-13)
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-13)


@each_law
def test_many_points_at_once(material: Elastomer) -> None:
    """What the kernels call for all points of an element is the response of each of them."""
    gradients = [np.asarray(case.values[0]) for case in GRADIENTS]
    lefts = np.array([g @ g.T / np.linalg.det(g) ** (2 / 3) for g in gradients])
    energy, stress, tangent = np.empty(5), np.empty((5, 6)), np.empty((5, 6, 6))
    responses(material.kind, material.parameters, lefts, energy, stress, tangent)
    for q, gradient in enumerate(gradients):
        single = response(material, gradient)
        assert energy[q] == pytest.approx(single[0], rel=1e-13, abs=1e-16)
        np.testing.assert_allclose(stress[q], single[1][_FIRST, _SECOND], atol=1e-14)
        np.testing.assert_allclose(tangent[q], single[2], atol=1e-13)
    energy_alone, stress_alone = np.empty(5), np.empty((5, 6))
    stresses(material.kind, material.parameters, lefts, energy_alone, stress_alone)
    np.testing.assert_allclose(energy_alone, energy, rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(stress_alone, stress, atol=1e-14)


@each_law
def test_small_strains_have_the_shear_modulus(material: Elastomer) -> None:
    """Undeformed, c = 2µ (𝕀 − ⅓ I ⊗ I): µ on the shears, 4µ/3 and −2µ/3 on the stretches."""
    energy, stress, tangent = response(material, np.eye(3))
    shear = material.shear_modulus
    expected = np.zeros((6, 6))
    expected[:3, :3] = 2 * shear * (np.eye(3) - 1 / 3)
    expected[3:, 3:] = shear * np.eye(3)
    assert energy == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose(stress, 0.0, atol=1e-14)
    np.testing.assert_allclose(tangent, expected, atol=1e-12)


@each_law
def test_energy_does_not_see_rotations_and_volume(material: Elastomer) -> None:
    gradient = np.array([[1.3, 0.4, -0.2], [0.1, 0.8, 0.3], [-0.3, 0.2, 1.1]])
    energy, stress, _ = response(material, gradient)
    turned, turned_stress, _ = response(material, TURN @ gradient)
    grown, _, _ = response(material, 1.7 * gradient)
    assert turned == pytest.approx(energy, rel=1e-12)
    assert grown == pytest.approx(energy, rel=1e-12)
    np.testing.assert_allclose(turned_stress, TURN @ stress @ TURN.T, atol=1e-13)


# The stretch λ along x, what the others are, and the nominal stresses in kPa of
# Elastosil M4601 (Yeoh, C10 = 0.11, C20 = 0.02 MPa) at λ = 1.5 and 2 that are known for it.
STATES = {
    "uniaxial": (lambda s: (s, s**-0.5, s**-0.5), (281.48, 665.0)),
    "equibiaxial": (lambda s: (s, s, s**-2), (486.85, 1230.47)),
    "planar": (lambda s: (s, 1.0, 1 / s), (331.69, 750.0)),
}


def nominal_stress(material: Elastomer, stretches: tuple[float, float, float]) -> float:
    """Nominal stress along the first axis of an incompressible body, the last axis being free."""
    _, stress, _ = response(material, np.diag(stretches))
    return float((stress[0, 0] - stress[2, 2]) / stretches[0])


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("index", [0, 1])
def test_homogeneous_states_of_yeoh(state: str, index: int) -> None:
    """P = 2 (λ − λ_z²/λ) (C10 + 2 C20 (I₁ − 3)), recomputed; and the listed figures."""
    material = elastomer("yeoh", C10=0.11, C20=0.02)
    stretch = (1.5, 2.0)[index]
    x, y, z = STATES[state][0](stretch)
    slope = 0.11 + 2 * 0.02 * (x**2 + y**2 + z**2 - 3)
    exact = 2 * (x - z**2 / x) * slope
    found = nominal_stress(material, (x, y, z))
    assert found == pytest.approx(exact, rel=1e-12)
    assert 1e3 * found == pytest.approx(STATES[state][1][index], abs=6e-3)


def test_gent_in_tension() -> None:
    """P = µ (λ − 1/λ²) Jm/(Jm − I₁ + 3)."""
    stretch = 2.0
    room = 12.0 / (12.0 - (stretch**2 + 2 / stretch) + 3)
    exact = 0.2 * (stretch - stretch**-2) * room
    state = (stretch, stretch**-0.5, stretch**-0.5)
    assert nominal_stress(elastomer("gent"), state) == pytest.approx(exact, rel=1e-12)


def test_ogden_in_tension() -> None:
    """P = Σ 2µ/α (λ^(α−1) − λ^(−α/2−1))."""
    material, stretch = elastomer("ogden"), 1.8
    pairs = zip(LAWS["ogden"]["mu"], LAWS["ogden"]["alpha"], strict=True)
    exact = sum(2 * m / a * (stretch ** (a - 1) - stretch ** (-a / 2 - 1)) for m, a in pairs)
    state = (stretch, stretch**-0.5, stretch**-0.5)
    assert nominal_stress(material, state) == pytest.approx(exact, rel=1e-12)


SAME = [
    pytest.param(
        elastomer("ogden", mu=[0.22], alpha=[2.0]), elastomer("neo_hookean"), id="neo-Hookean"
    ),
    pytest.param(
        elastomer("ogden", mu=[0.2, 0.1], alpha=[2.0, -2.0]),
        elastomer("mooney_rivlin", C10=0.1, C01=0.05),
        id="Mooney-Rivlin",
    ),
]


@pytest.mark.parametrize(("ogden", "other"), SAME)
@each_gradient
def test_ogden_contains_the_polynomial_laws(
    ogden: Elastomer, other: Elastomer, gradient: FloatArray
) -> None:
    """W = µ/2 (I₁ − 3) is Ogden with α = 2, and I₂ − 3 comes with α = −2."""
    assert ogden.shear_modulus == pytest.approx(other.shear_modulus)
    for found, expected in zip(response(ogden, gradient), response(other, gradient), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-9)


def test_gent_locks_at_its_limit() -> None:
    """I₁ − 3 = Jm cannot be reached: infinite energy there and beyond, finite just below."""
    material = elastomer("gent", mu=0.2, Jm=12.0)

    def energy(excess: float) -> float:
        roots = np.roots([1.0, 0.0, -(excess + 3), 2.0])  # λ² + 2/λ = excess + 3
        stretch = roots.real.max()
        return response(material, np.diag([stretch, stretch**-0.5, stretch**-0.5]))[0]

    assert np.isfinite(energy(11.99))
    assert energy(12.0) == np.inf
    assert energy(20.0) == np.inf
