"""Materials: derived moduli, and what is said of unusable entries."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pagd.errors import InputError
from pagd.materials import (
    GENT,
    LAWS,
    OGDEN,
    POLYNOMIAL,
    elastomer,
    find_material,
    read_materials,
    sheet,
)

FILE = Path(__file__).parents[2] / "config" / "materials.yaml"

COEFFICIENTS: dict[str, dict[str, Any]] = {
    "neo_hookean": {"C10": 0.11},
    "mooney_rivlin": {"C10": 0.26, "C01": 0.1, "C20": 0.06},
    "yeoh": {"C10": 0.09, "C20": 0.009, "C30": -3e-4},
    "gent": {"mu": 0.2, "Jm": 12},
    "ogden": {"mu": [0.19, 0.02], "alpha": [-3.8, 4.2]},
}
YEOH = {"law": "yeoh", "coefficients": {"C10": 0.11, "C20": 0.02}}
SHEET = {"youngs_modulus": 6500, "poisson_ratio": 0.2, "thickness": 0.1}


def test_every_law_has_an_example_here() -> None:
    assert set(COEFFICIENTS) == set(LAWS)


@pytest.mark.parametrize(
    ("law", "kind", "parameters", "shear_modulus"),
    [
        ("neo_hookean", POLYNOMIAL, [0.11, 0, 0, 0], 0.22),
        ("mooney_rivlin", POLYNOMIAL, [0.26, 0.06, 0, 0.1], 0.72),
        ("yeoh", POLYNOMIAL, [0.09, 0.009, -3e-4, 0], 0.18),
        ("gent", GENT, [0.2, 12], 0.2),
        ("ogden", OGDEN, [0.19, -3.8, 0.02, 4.2], 0.21),
    ],
)
def test_parameters_and_shear_modulus(
    law: str, kind: int, parameters: list[float], shear_modulus: float
) -> None:
    made = elastomer("m", {"law": law, "coefficients": COEFFICIENTS[law]})
    assert made.kind == kind
    assert made.parameters.tolist() == parameters
    assert made.shear_modulus == pytest.approx(shear_modulus)


def test_bulk_modulus_of_the_default_elastomer() -> None:
    """K = 2µ(1 + ν)/(3 (1 − 2ν)) with µ = 0.22 MPa, ν = 0.499: 109.9 MPa."""
    made = elastomer("m", YEOH)
    assert made.poisson_ratio == 0.499
    assert made.bulk_modulus == pytest.approx(2 * 0.22 * 1.499 / (3 * 0.002), rel=1e-10)


def test_stiffnesses_of_the_paper() -> None:
    """E h/(1 − ν²) and E h³/12(1 − ν²); the latter is 0.56 N·mm."""
    made = sheet("paper", SHEET)
    assert made.membrane_stiffness == pytest.approx(6500 * 0.1 / 0.96)
    assert made.bending_stiffness == pytest.approx(0.564, abs=1e-3)


def test_values_that_are_not_given() -> None:
    made = elastomer("m", YEOH)
    assert (made.density_kg_m3, made.largest_stretch, made.source) == (1100.0, 4.0, "")
    assert sheet("p", SHEET).density_kg_m3 == 750.0


def test_every_entry_of_the_material_file_can_be_used() -> None:
    entries = read_materials(FILE)
    made = [
        (sheet if entry["law"] == "linear_shell" else elastomer)(name, entry)
        for name, entry in entries.items()
    ]
    assert len(made) == len(entries) >= 10
    assert all(m.source for m in made), "every entry says where it comes from"


def test_default_materials() -> None:
    """The values of the paper's designs."""
    made = elastomer("elastosil_m4601", find_material(FILE, "elastosil_m4601"))
    assert (made.law, made.coefficients, made.density_kg_m3) == (
        "yeoh",
        {"C10": 0.11, "C20": 0.02},
        1130,
    )
    paper = sheet("paper", find_material(FILE, "paper", "paper"))
    assert (paper.youngs_modulus, paper.poisson_ratio, paper.thickness) == (6500, 0.2, 0.1)


def entry(**changes: Any) -> dict[str, Any]:
    """The Yeoh entry with changes; None removes a key."""
    changed = {**YEOH, **changes}
    return {key: value for key, value in changed.items() if value is not None}


@pytest.mark.parametrize(
    ("bad", "said"),
    [
        (entry(law="hooke"), r"law is 'hooke', but must be one of gent, .*yeoh"),
        (entry(law=None), "law is missing"),
        (entry(coefficients=None), "coefficients is missing"),
        (entry(colour="red"), "unknown key colour; known are coefficients"),
        (entry(coefficients=[0.1]), "coefficients must be a table"),
        (entry(coefficients={"C20": 0.1}), "C10 is missing"),
        (entry(coefficients={"C10": 0.1, "C40": 1}), "unknown key C40; known are C10, C20, C30"),
        (entry(coefficients={"C10": "soft"}), "C10 is 'soft', but must be a number"),
        (entry(coefficients={"C10": True}), "C10 is True, but must be a number"),
        (entry(coefficients={"C10": float("nan")}), "C10 is nan, but must be a number"),
        (entry(coefficients={"C10": -0.1}), r"shear modulus is -0.2, but must be .*greater than 0"),
        (
            entry(law="gent", coefficients={"mu": 0.2, "Jm": -1}),
            "Jm is -1, but must be a number greater than 0",
        ),
        (
            entry(law="ogden", coefficients={"mu": [0.1, 0.2], "alpha": [2.0]}),
            r"mu is \[0.1, 0.2\] and alpha is \[2.0\], but both must be lists of the same length",
        ),
        (
            entry(law="ogden", coefficients={"mu": 0.1, "alpha": 2.0}),
            "mu is 0.1 and alpha is 2.0, but both must be lists",
        ),
        (
            entry(law="ogden", coefficients={"mu": [0.1] * 4, "alpha": [2.0] * 4}),
            "lists of the same length, 1 to 3",
        ),
        (
            entry(law="ogden", coefficients={"mu": [0.1], "alpha": [0.0]}),
            "alpha is 0, but must not be zero",
        ),
        (
            entry(law="ogden", coefficients={"mu": ["a"], "alpha": [2.0]}),
            "mu is 'a', but must be a number",
        ),
        (
            entry(poisson_ratio=0.5),
            "poisson_ratio is 0.5, but must be a number greater than 0 and less than 0.5",
        ),
        (entry(poisson_ratio=-0.1), "poisson_ratio is -0.1, but must be"),
        (entry(density_kg_m3=0), "density_kg_m3 is 0, but must be a number greater than 0"),
        (entry(largest_stretch=0.9), "largest_stretch is 0.9, but must be .*greater than 1"),
    ],
)
def test_unusable_elastomers(bad: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=f"^material 'rubber': .*{said}"):
        elastomer("rubber", bad)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"thickness": 0}, "thickness is 0, but must be a number greater than 0"),
        ({"youngs_modulus": "stiff"}, "youngs_modulus is 'stiff', but must be a number"),
        ({"poisson_ratio": 0.5}, "poisson_ratio is 0.5, but must be .*less than 0.5"),
        ({"density_kg_m3": -1}, "density_kg_m3 is -1, but must be"),
        ({"width": 3}, "unknown key width"),
    ],
)
def test_unusable_sheets(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=f"^material 'card': .*{said}"):
        sheet("card", {**SHEET, **changes})


def test_messages_are_one_line() -> None:
    with pytest.raises(InputError) as caught:
        elastomer("rubber", entry(law="ogden", coefficients={"mu": 1, "alpha": [2]}))
    assert "\n" not in str(caught.value)


def test_a_missing_sheet_key() -> None:
    with pytest.raises(InputError, match="material 'card': thickness is missing"):
        sheet("card", {"youngs_modulus": 1, "poisson_ratio": 0.2})


def test_an_unknown_name_lists_those_there_are() -> None:
    with pytest.raises(InputError, match=r"material is 'granite'.*elastosil_m4601"):
        find_material(FILE, "granite")
    for use, name in (("material", "paper"), ("paper", "elastosil_m4601")):
        with pytest.raises(InputError, match=rf"^{use} is '{name}', but must be one of") as caught:
            find_material(FILE, name, use)
        listed = str(caught.value).partition("one of ")[2].partition(" (in")[0].split(", ")
        assert ("paper" in listed, "dragon_skin_30" in listed) == (use == "paper", use != "paper")


def test_exponents_without_a_point_are_numbers(tmp_path: Path) -> None:
    """YAML 1.1 takes 1e-4 for a string."""
    path = tmp_path / "materials.yaml"
    path.write_text("m: {law: yeoh, coefficients: {C10: 1e-1, C20: 2E-4}}")
    made = elastomer("m", find_material(path, "m"))
    assert made.parameters.tolist() == [0.1, 2e-4, 0, 0]


def test_unreadable_files(tmp_path: Path) -> None:
    path = tmp_path / "materials.yaml"
    with pytest.raises(InputError, match="cannot be read"):
        read_materials(path)
    path.write_text("a: [1,")
    with pytest.raises(InputError, match="cannot be read") as caught:
        read_materials(path)
    assert "\n" not in str(caught.value)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="cannot be read"):
        read_materials(path)
    for text in ("- a\n- b\n", "paper: 3\n", ""):
        path.write_text(text)
        with pytest.raises(InputError, match="must be a table of materials by name"):
            read_materials(path)
