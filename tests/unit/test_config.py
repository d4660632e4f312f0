import json
from dataclasses import asdict
from pathlib import Path

import pytest
import yaml

from pagd import config
from pagd.actuation import Actuation
from pagd.design import GeometryRules
from pagd.errors import InputError
from pagd.mesh.interface import MESHERS, STRUCTURED
from pagd.mesh.run import MeshGate
from pagd.metrics import Thresholds
from pagd.stages import STAGE_VERSIONS
from pagd.stages.geometry import rules_of

ROOT = Path(__file__).parents[2]


def test_the_file_in_the_repository_holds_every_key_and_its_default() -> None:
    given = yaml.safe_load((ROOT / "config" / "config.yaml").read_text())
    assert given == config.load(None)


def test_defaults_are_those_of_the_library() -> None:
    defaults = config.load(None)
    assert rules_of(defaults) == GeometryRules()
    assert defaults["metrics"] == asdict(Thresholds()) | {"pressure_ramp_kPa_per_s": None}
    gate = {key: defaults["mesh"][key] for key in asdict(MeshGate())}
    assert gate == asdict(MeshGate())
    assert defaults["mesh"]["meshers"] == [STRUCTURED, *MESHERS]
    # What the stage takes, and no single analysis does.
    stage = {key: defaults["solve"][key] for key in ("bending_limit_deg", "first_guess")}
    solve = asdict(Actuation())
    gravity = {"gravity_m_s2": list(solve["gravity_m_s2"])}
    assert defaults["solve"] == solve | gravity | stage


def test_what_is_lacking_takes_its_default(tmp_path: Path) -> None:
    (tmp_path / "c.yaml").write_text("mesh: {size_mm: 5}\ndesigns: {own: mine.csv}\n")
    found = config.load(str(tmp_path / "c.yaml"))
    assert found["mesh"] == config.load(None)["mesh"] | {"size_mm": 5}
    assert found["designs"] == {"own": "mine.csv"}
    assert found["solve"] == config.load(None)["solve"]


def test_defaults_cannot_be_spoilt() -> None:
    config.load(None)["mesh"]["size_mm"] = 99
    assert config.load(None)["mesh"]["size_mm"] != 99


def test_numbers_may_be_written_as_powers(tmp_path: Path) -> None:
    (tmp_path / "c.yaml").write_text("solve: {maximum_pressure_kPa: 5e1}\n")
    assert config.load(str(tmp_path / "c.yaml"))["solve"]["maximum_pressure_kPa"] == 50.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("mesh: [1", "is not YAML"),
        ("- 1", "must be a table of keys and values"),
        ("mesh: {size_mm: .nan}", "mesh.size_mm = nan must be finite"),
        ("solve: {maximum_pressure_kPa: .inf}", "maximum_pressure_kPa = inf must be finite"),
        (
            "solve: {first_step_kPa: 0.01}",
            "solve.first_step_kPa = 0.01 must be at least solve.smallest_step_kPa = 0.05",
        ),
        ("mesh: {size_mm: -3}", "mesh.size_mm = -3 must be greater than 0"),
    ],
)
def test_a_bad_file_is_told_in_one_sentence(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "c.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=r"^configuration .*c\.yaml: ") as caught:
        config.load(str(path))
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"dataset": {"size": 500}}, "plane_designs = 1000 must be at most dataset.size = 500."),
        (
            {"generator": {"designs": 20}, "selection": {"designs": 30}},
            "diversity.hull_designs = 50 must be at most generator.designs = 20.",
        ),
        (
            {"diversity": {"plane_designs": 60}},
            "embedding.perplexity = 30 must be at most a third of diversity.plane_designs = 20.",
        ),
        (
            {"generator": {"components": 20_000}},
            "generator.components = 20000 must be at most dataset.size = 11000.",
        ),
        (
            {
                "embedding": {"perplexity": 10},
                "generator": {"components": "bic", "largest_components": 50},
                "diversity": {"plane_designs": 40},
            },
            "generator.largest_components = 50 must be at most diversity.plane_designs = 40.",
        ),
    ],
)
def test_what_sections_ask_of_each_other(given: dict[str, dict[str, object]], words: str) -> None:
    for fine in (None, '{"generator": {"components": "bic"}}'):
        config.check_study(config.load(fine), "configuration")
    with pytest.raises(InputError, match=r"^configuration: ") as caught:
        config.check_study(config.load(json.dumps(given)), "configuration")
    assert words in str(caught.value)


@pytest.mark.parametrize("components", [1, 3, "bic"])
def test_components_are_a_number_or_bic(components: int | str) -> None:
    found = config.load(json.dumps({"generator": {"components": components}}))
    assert found["generator"]["components"] == components


@pytest.mark.parametrize("components", [0, 2.5, "BIC", None])
def test_nothing_else_is_a_number_of_components(components: object) -> None:
    with pytest.raises(InputError, match=r"generator\.components = "):
        config.load(json.dumps({"generator": {"components": components}}))


def test_text_of_numbers_becomes_numbers_and_other_text_stays() -> None:
    given = {
        "material": "7",
        "mesh": {"size_mm": "4.5", "half_model": "false", "meshers": "[gmsh]"},
        "generator": {"bandwidth": "null", "components": "bic", "seed": 3},
        "selection": {"designs": "many", "unknown": "1"},
    }
    assert config.retyped(given) == {
        "material": "7",
        "mesh": {"size_mm": 4.5, "half_model": False, "meshers": ["gmsh"]},
        "generator": {"bandwidth": None, "components": "bic", "seed": 3},
        "selection": {"designs": "many", "unknown": "1"},
    }


def test_known_designs_come_with_pagd(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    tables = config.known_tables(config.load(None))
    assert set(tables) == {"table2", "published"}
    for path in tables.values():
        assert Path(path).read_text() == (ROOT / "config" / Path(path).name).read_text()
    own = config.load('{"dataset": {"known": {"own": "mine.csv"}}}')
    assert config.known_tables(own) == {"own": "mine.csv"}


def test_json_text_and_missing_files() -> None:
    assert config.load('{"paper": "card"}')["paper"] == "card"
    with pytest.raises(InputError, match=r"is not JSON"):
        config.load('{"paper"')
    with pytest.raises(InputError, match=r"absent\.yaml: cannot be read"):
        config.load("absent.yaml")


def test_every_stage_of_a_design_has_its_part_and_no_more() -> None:
    whole = config.load(None)
    assert set(config.SECTIONS) <= set(STAGE_VERSIONS)
    for stage in config.SECTIONS:
        text = config.part_as_json(whole, stage)
        assert json.loads(text) == config.part(whole, stage)
        # What a stage is handed must complete to the same configuration.
        assert config.part(config.load(text), stage) == config.part(whole, stage)


def test_a_material_has_its_name_and_no_citation() -> None:
    file = str(ROOT / "config" / "materials.yaml")
    entry = json.loads(config.material_as_json(file, "elastosil_m4601", "material"))
    assert entry["name"] == "elastosil_m4601"
    assert entry["coefficients"] == {"C10": 0.11, "C20": 0.02}
    assert "source" not in entry
    with pytest.raises(InputError, match=r"^paper is 'unobtainium', but must be one of paper \("):
        config.material_as_json(file, "unobtainium", "paper")
