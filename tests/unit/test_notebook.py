"""What IPython shows for designs, asked through its own display formatter."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import matplotlib as mpl
import pytest
from design_samples import TABLE2_BENDING as BENDING
from design_samples import TABLE2_MIXED as MIXED
from IPython.core.formatters import DisplayFormatter

from pagd import notebook
from pagd.catalogue import NamedDesign

Shown = Callable[[Any], dict[str, Any]]


@pytest.fixture
def shown() -> Shown:
    """What a shell that has loaded the extension shows for an object, by format."""
    formatter = DisplayFormatter()
    notebook.load_ipython_extension(SimpleNamespace(display_formatter=formatter))
    return lambda thing: formatter.format(thing)[0]


def texts(svg: str) -> list[str]:
    """All that is written in a picture."""
    root = ElementTree.fromstring(svg)
    found = root.iter("{http://www.w3.org/2000/svg}text")
    return ["".join(one.itertext()).strip() for one in found]


def test_a_design_is_a_picture_with_its_dimensions(shown: Shown) -> None:
    data = shown(MIXED)
    svg = data["image/svg+xml"]
    written = " ".join(texts(svg))
    for value in (MIXED.L, MIXED.H, MIXED.t_h, MIXED.W, MIXED.t):
        assert f"{value:g}" in written
    assert "27.2" in written
    # In a narrow notebook it is not cut off.
    assert ElementTree.fromstring(svg).get("width") == "100%"
    # Outlines of twelve chambers and of their cavities, at least.
    assert svg.count("<path") > 24
    assert data["text/plain"] == repr(MIXED)
    assert "text/html" not in data


def test_a_named_design_is_the_same_picture(shown: Shown) -> None:
    named = NamedDesign(name="one", origin="own", design=MIXED)
    assert shown(named)["image/svg+xml"] == shown(MIXED)["image/svg+xml"]


def test_another_design_is_another_picture(shown: Shown) -> None:
    other = dataclasses.replace(BENDING, t_h=3.5)
    assert shown(other)["image/svg+xml"] != shown(BENDING)["image/svg+xml"]


def test_a_design_that_cannot_be_built_says_why(shown: Shown) -> None:
    data = shown(dataclasses.replace(MIXED, t_h=20.0, N=2))
    assert "image/svg+xml" not in data
    assert "t_h=20.0" in data["text/html"]
    assert "the cavity, H - t_h" in data["text/html"]


def test_without_openscad_it_says_so(shown: Shown, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    data = shown(dataclasses.replace(MIXED, t_h=3.21))
    assert "image/svg+xml" not in data
    assert "install OpenSCAD" in data["text/html"]


def test_pictures_leave_the_look_of_others_alone(shown: Shown) -> None:
    before = dict(mpl.rcParams)
    shown(dataclasses.replace(MIXED, t_h=3.33))
    assert dict(mpl.rcParams) == before


def test_a_bar_goes_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []

    def display(thing: Any, display_id: bool) -> Any:
        shown.append(thing.data)
        return SimpleNamespace(update=lambda thing: shown.append(thing.data))

    monkeypatch.setattr("IPython.display.display", display)
    with notebook.bar("a<b", 20.0, "kPa") as bar:
        bar.reach(5.0)
        bar.name("blocked force")
        bar.reach(25.0)
    assert shown[0] == shown[-1] == ""
    assert '<progress max="20" value="5"></progress> a&lt;b: 5 of 20 kPa' in shown
    assert shown[-2] == '<progress max="20" value="20"></progress> blocked force: 20 of 20 kPa'


_SESSION = """
from IPython.core.interactiveshell import InteractiveShell
{before}
shell = InteractiveShell.instance()
{after}
from pagd import Design
design = Design(L=9, W=15, H=13, t=3, t_n=2, t_h=3, t_ab=2, t_b=2, N=2, theta=0, alpha=0)
print(*sorted(shell.display_formatter.format(design)[0]))
"""


@pytest.mark.parametrize(
    ("before", "after"),
    [
        pytest.param("", "import pagd", id="imported in a session"),
        pytest.param(
            "import pagd", "shell.run_line_magic('load_ext', 'pagd')", id="imported first"
        ),
    ],
)
def test_a_session_shows_pictures_by_itself(before: str, after: str) -> None:
    command = [sys.executable, "-c", _SESSION.format(before=before, after=after)]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    assert answer.stdout.splitlines()[-1] == "image/svg+xml text/plain"


def test_registering_imports_nothing_of_pictures() -> None:
    code = (
        "from IPython.core.interactiveshell import InteractiveShell\n"
        "import sys\nInteractiveShell.instance()\nimport pagd\n"
        "print({'numpy', 'pandas', 'pyvista', 'pagd.design', 'pagd.figures'} & set(sys.modules))"
    )
    command = [sys.executable, "-c", code]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    assert answer.stdout.splitlines()[-1] == "set()"
