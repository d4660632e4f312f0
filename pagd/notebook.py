"""Notebooks: designs as pictures there, and a bar while an analysis runs.

A design knows nothing of pictures. Here IPython is told what to draw for one, by the name of its
class, so that nothing is imported before the first picture is wanted.
"""

from __future__ import annotations

import functools
import html
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from pagd.catalogue import NamedDesign
    from pagd.design import Design
    from pagd.families import Actuator
    from pagd.long_work import Shown

__all__ = ["bar", "is_notebook", "load_ipython_extension", "show_pictures"]


def show_pictures() -> None:
    """Let the IPython that runs, if any, show designs as pictures.

    ``import pagd`` does so by itself. Where it came before IPython: ``%load_ext pagd``.
    """
    shell = _shell()
    if shell is not None:
        load_ipython_extension(shell)


def load_ipython_extension(shell: Any) -> None:
    """Register the pictures with an IPython shell; IPython calls this at ``%load_ext pagd``."""
    # Libraries that draw bars of their own complain of widgets that nothing here uses.
    warnings.filterwarnings("ignore", message="IProgress not found")
    for (module, name), by_format in _PICTURES.items():
        for mimetype, drawn in by_format.items():
            formatter = shell.display_formatter.formatters[mimetype]
            formatter.for_type_by_name(module, name, drawn)


@contextmanager
def bar(what: str, whole: float, unit: str, even: bool = True) -> Iterator[Shown]:
    """Show a bar under the cell that runs, which goes at the end; a display of long work."""
    from IPython.display import HTML, display

    place: Any = display(HTML(""), display_id=True)  # type: ignore[no-untyped-call]
    shown = _Bar(what, whole, unit, lambda line: place.update(HTML(line)))  # type: ignore[no-untyped-call]
    shown.reach(0.0)
    try:
        yield shown
    finally:
        place.update(HTML(""))  # type: ignore[no-untyped-call]


class _Bar:
    def __init__(self, what: str, whole: float, unit: str, show: Callable[[str], object]) -> None:
        self._what, self._whole, self._unit, self._show = what, whole, unit, show
        self._value = 0.0

    def reach(self, value: float) -> None:
        self._value = min(value, self._whole)  # a last step may go beyond
        self._draw()

    def name(self, part: str) -> None:
        self._what = part
        self._draw()

    def _draw(self) -> None:
        told = f"{self._value:.5g} of {self._whole:.5g} {self._unit}"
        bar = f'<progress max="{self._whole:g}" value="{self._value:g}"></progress>'
        self._show(f"{bar} {html.escape(self._what)}: {told}")


def is_notebook() -> bool:
    """Whether this process is a Jupyter kernel, behind which a person looks at outputs."""
    return getattr(_shell(), "kernel", None) is not None


def _shell() -> Any:
    """The IPython shell that runs in this process, or None."""
    ipython = sys.modules.get("IPython")
    get = getattr(ipython, "get_ipython", None)
    return get() if get else None


def _svg_of_design(design: Design | Actuator) -> str | None:
    """Sections of a design; None, which leaves it to another format, where it has no picture."""
    from pagd.errors import PagdError

    try:
        return _drawn(design)
    except PagdError:
        return None


def _html_of_design(design: Design | Actuator) -> str | None:
    """For a design that has no picture: why."""
    from pagd.errors import PagdError

    try:
        _drawn(design)
    except PagdError as error:
        told = f"{html.escape(repr(design))}<br>No picture: {html.escape(str(error))}"
        return f"<div>{told}</div>"
    return None


# A notebook asks for each format, and for the same design again and again.
@functools.lru_cache(maxsize=32)
def _drawn(design: Design | Actuator) -> str:
    """Return the sections of a design as SVG, of the surfaces that OpenSCAD makes of it.

    Raises
    ------
    PagdError
        If it cannot be built, or OpenSCAD does not make it.
    """
    import pyvista as pv

    from pagd.design import GeometryRules
    from pagd.figures.sections import sections_as_svg
    from pagd.geometry import Part, render

    parts: tuple[Part, ...] = ("body", "base")
    with tempfile.TemporaryDirectory(prefix="pagd-") as folder:
        files = [Path(folder) / f"{part}.stl" for part in parts]
        for part, file in zip(parts, files, strict=True):
            render(design, GeometryRules(), part, file)
        # STL keeps every triangle to itself.
        body, base = (pv.read(file).merge_points() for file in files)
    return sections_as_svg(body, base, design)


def _of_named(
    drawn: Callable[[Design | Actuator], str | None],
) -> Callable[[NamedDesign], str | None]:
    return lambda named: drawn(named.design)


_OF_DESIGN: Final = {"image/svg+xml": _svg_of_design, "text/html": _html_of_design}
#: Module and name of a class to what is shown for its objects, by format.
_PICTURES: Final[dict[tuple[str, str], dict[str, Callable[[Any], str | None]]]] = {
    ("pagd.design.model", "Design"): {**_OF_DESIGN},
    ("pagd.families.interface", "Actuator"): {**_OF_DESIGN},
    ("pagd.catalogue", "NamedDesign"): {key: _of_named(f) for key, f in _OF_DESIGN.items()},
}
