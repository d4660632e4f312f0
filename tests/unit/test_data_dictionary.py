import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from pagd import tables
from pagd.figures.page.downloads import DESCRIPTIONS
from pagd.summary import FOR_PEOPLE

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def script() -> ModuleType:
    path = ROOT / "workflow" / "scripts" / "data_dictionary.py"
    spec = importlib.util.spec_from_file_location("data_dictionary", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_in_step_with_the_columns(script: ModuleType) -> None:
    page = script.page()
    assert (ROOT / "docs" / "data.md").read_text(encoding="utf-8") == page
    assert "| `strain_rate_per_s` | double | 1/s |" in page
    assert "| energy balance | `energy_balance` |" in page
    assert "| `blocked_penetration_share` | double | 1 |" in page
    assert max(map(len, page.splitlines())) <= 100


def test_every_declared_table_has_its_section(script: ModuleType) -> None:
    declared = [
        columns for name in tables.__all__ if isinstance(columns := getattr(tables, name), tuple)
    ]
    assert len(declared) == 12
    told = [table.columns for table in script.TABLES]
    assert all(columns in told for columns in declared)


def test_every_file_that_a_card_offers_is_named(script: ModuleType) -> None:
    rows = script.exports().splitlines()
    assert all(f"| `{name}` | {meaning} |" in rows for name, meaning in DESCRIPTIONS.items())
    assert script.exports() in script.page()


def test_every_figure_of_the_table_for_people_is_named(script: ModuleType) -> None:
    rows = script.for_people().splitlines()
    assert all(f"| {heading} | `{key}` |" in rows for heading, key, _ in FOR_PEOPLE)


def test_no_cell_is_ended_by_a_stroke_within_it(script: ModuleType) -> None:
    rows = [line for line in script.page().splitlines() if "`energy_balance` | double" in line]
    assert rows
    for row in rows:
        assert row.replace("\\|", "").count("|") == 5
