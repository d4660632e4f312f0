from collections.abc import Iterator
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from pagd import validation
from pagd.errors import InputError
from pagd.validation import check, check_each, defaults, faults, schema


@pytest.mark.parametrize(
    ("document", "sentence"),
    [
        ({"mash": {}}, "mash is not a known key (did you mean mesh?)"),
        ({"mesh": {"qqqqq": 1}}, "mesh.qqqqq is not a known key (known are meshers, block_mm"),
        ({"mesh": 3}, "mesh = 3 must be a table of keys and values"),
        ({"mesh": {"size_mm": "3"}}, "mesh.size_mm = '3' must be a number"),
        ({"mesh": {"size_mm": True}}, "mesh.size_mm = True must be a number"),
        ({"mesh": {"size_mm": float("nan")}}, "mesh.size_mm = nan must be finite"),
        ({"limits": {"theta_deg": float("inf")}}, "limits.theta_deg = inf must be finite"),
        ({"limits": {"theta_deg": -float("inf")}}, "limits.theta_deg = -inf must be finite"),
        ({"mesh": {"size_mm": 10**400}}, "mesh.size_mm = 1000"),
        ({"mesh": {"size_mm": 0}}, "mesh.size_mm = 0 must be greater than 0"),
        (
            {"mesh": {"meshers": ["tet gen"]}},
            "mesh.meshers[0] = 'tet gen' must be structured, gmsh, ",
        ),
        ({"mesh": {"meshers": []}}, "mesh.meshers must not be empty"),
        (
            {"solve": {"element": "C3D10"}},
            "solve.element = 'C3D10' must be one of auto, hexahedron, t",
        ),
        ({"limits": {"gap_mm": -1}}, "limits.gap_mm = -1 must be at least 0"),
        ({"limits": {"theta_deg": 91}}, "limits.theta_deg = 91 must be at most 60"),
        ({"designs": {}}, "designs must not be empty"),
        (
            {"solve": {"gravity_m_s2": [0, -9.81]}},
            "solve.gravity_m_s2 = [0, -9.81] must have 3 numbers",
        ),
        (
            {"solve": {"gravity_m_s2": [0, 0, 0, 1]}},
            "solve.gravity_m_s2 = [0, 0, 0, 1] must have 3 numbers",
        ),
        ({"solve": {"gravity_m_s2": []}}, "solve.gravity_m_s2 = [] must have 3 numbers"),
        ({"material": 7}, "material = 7 must be text"),
    ],
)
def test_a_fault_names_key_value_and_rule(document: dict[str, object], sentence: str) -> None:
    (found,) = faults(document, "config")
    assert found.startswith(sentence)


@pytest.mark.parametrize(
    ("rules", "document", "sentence"),
    [
        ({"minItems": 2}, ["a"], "['a'] must have at least 2 entries"),
        ({"maxItems": 2}, ["a", "b", "c"], "['a', 'b', 'c'] must have at most 2 entries"),
        ({"minItems": 2, "maxItems": 2}, ["a"], "['a'] must have 2 entries"),
        ({"minItems": 1, "maxItems": 2}, [1, 2, 3], "[1, 2, 3] must have at most 2 entries"),
    ],
)
def test_the_length_of_any_list_is_told(
    rules: dict[str, int],
    document: list[object],
    sentence: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rule = Draft202012Validator({"type": "array", **rules})
    monkeypatch.setattr(validation, "_validator", lambda name: rule)
    assert list(faults(document, "config")) == [sentence]


def patterns(of: Any) -> Iterator[dict[str, Any]]:
    """Every part of a schema that asks for a pattern."""
    if isinstance(of, dict):
        if isinstance(of.get("pattern"), str):
            yield of
        for part in of.values():
            yield from patterns(part)


@pytest.mark.parametrize("name", ["config", "designs", "record"])
def test_every_pattern_is_put_in_words(name: str) -> None:
    found = list(patterns(schema(name)))
    assert found
    for part in found:
        assert len(part["words"]) > 10


def test_a_design_that_is_not_finite_is_left_to_the_rules() -> None:
    row = dict.fromkeys(schema("designs")["required"], 1.0) | {"name": "a", "L": float("nan")}
    assert list(faults(row, "designs")) == []


def test_every_fault_is_told_once() -> None:
    row = {"name": "two words", "L": "x", "W": 1}
    found = list(faults(row, "designs"))
    assert len(found) == len(set(found)) == 3
    assert "H, t, t_n, t_h, t_ab, t_b, N, theta, alpha missing" in found


def test_check_names_the_place() -> None:
    with pytest.raises(
        InputError, match=r"^my.yaml: mesh = 3 must be .*; paper = 0 must be text\.$"
    ):
        check({"mesh": 3, "paper": 0}, "config", "my.yaml")


def test_check_each_finds_the_one_that_is_broken() -> None:
    row = dict.fromkeys(schema("designs")["required"], 1.0) | {"name": "a"}
    check_each([("row 2", row)], "designs")
    with pytest.raises(InputError, match=r"^row 3: N = 1\.5 must be a whole number\.$"):
        check_each([("row 2", row), ("row 3", row | {"N": 1.5})], "designs")


def test_defaults_pass_the_schema_they_come_from() -> None:
    config = defaults(schema("config"))
    assert list(faults(config, "config")) == []
    assert config["mesh"]["meshers"] == ["structured", "gmsh", "ftetwild"]
