"""The notebooks of the documentation: each runs from its first cell to its last."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))


def executed(path: Path, folder: Path) -> Any:
    """A notebook with its outputs, executed by this Python in another folder than its own."""
    notebook = nbformat.read(path, as_version=4)
    resources = {"metadata": {"path": str(folder)}}
    client = NotebookClient(notebook, timeout=600, kernel_name="python3", resources=resources)
    return client.execute()


def outputs(notebook: Any) -> Iterator[Any]:
    for cell in notebook.cells:
        yield from cell.get("outputs", [])


def data(notebook: Any, mimetype: str) -> list[str]:
    """All outputs of one format, in order."""
    found = (output.get("data", {}) for output in outputs(notebook))
    return [each[mimetype] for each in found if mimetype in each]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_nothing_that_a_run_has_made_is_kept(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert not list(outputs(notebook))
    assert {cell.execution_count for cell in notebook.cells if cell.cell_type == "code"} == {None}
    # Of the machine it was written on neither.
    assert notebook.metadata.language_info == {"name": "python"}
    assert set(notebook.metadata) == {"kernelspec", "language_info"}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_begins_with_a_title_and_its_lines_are_short(path: Path) -> None:
    cells = nbformat.read(path, as_version=4).cells
    assert cells[0].source.startswith("# ")
    lines = [line for cell in cells for line in cell.source.splitlines()]
    assert [line for line in lines if len(line) > 100] == []


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """All notebooks, executed; none leaves anything in the folder it is run in."""
    folder = tmp_path_factory.mktemp("notebooks")
    found = {path.stem: executed(path, folder) for path in NOTEBOOKS}
    assert not list(folder.iterdir())
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", [path.stem for path in NOTEBOOKS])
def test_there_is_nothing_but_results(run: dict[str, Any], name: str) -> None:
    told = [output.text for output in outputs(run[name]) if output.get("name") == "stderr"]
    assert told == []
    # Nor is a bar left that has come to its end.
    assert "<progress" not in "".join(data(run[name], "text/html"))


@pytest.mark.slow
def test_an_own_actuator_is_drawn_and_simulated(run: dict[str, Any]) -> None:
    notebook = run["own_actuator"]
    (drawing,) = data(notebook, "image/svg+xml")
    assert drawing.count("<path") > 12
    # The deformed shapes, and the curves.
    assert len(data(notebook, "image/png")) == 2
    shown = " ".join(data(notebook, "text/html"))
    assert "invalid_geometry" in shown
    assert "dragon_skin_30" in shown
    assert "body.stl" in " ".join(output.get("text", "") for output in outputs(notebook))


@pytest.mark.slow
def test_the_paper_s_method_gives_mixed_designs_and_a_bent_and_twisted_actuator(
    run: dict[str, Any],
) -> None:
    notebook = run["paper_to_figures"]
    texts = "\n".join(data(notebook, "text/plain"))
    share = next(line for line in texts.splitlines() if line.startswith("mixed"))
    assert 0.25 < float(share.split()[-1]) < 0.5
    # As the whole model gives it at 20 kPa: tests/verification tells how exact that is.
    result = next(text for text in data(notebook, "text/plain") if text.startswith("<Result"))
    assert "mixed: ok, bends by 122" in result
    assert "twists by 41" in result


@pytest.mark.slow
def test_generators_are_compared_with_intervals(run: dict[str, Any]) -> None:
    notebook = run["compare_generators"]
    table = next(text for text in data(notebook, "text/plain") if "hull_ratio" in text)
    for name in ("training", "gmm", "gmm_plain", "gmm_full", "kde", "random"):
        assert name in table
    assert table.count(" to ") >= 6 * 3
    assert len(data(notebook, "image/png")) == 1
