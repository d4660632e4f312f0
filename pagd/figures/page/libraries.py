"""Kept libraries of JavaScript that stand in the page, as their Python packages bring them."""

from __future__ import annotations

import importlib.resources
import re
from typing import Final

__all__ = ["datatables", "datatables_style", "plotly"]

#: The last statement of a module: what it exports, by the names that it has inside.
_EXPORT: Final = re.compile(r"export\s*\{(?P<names>[^{}]*)\};?")
_WANTED: Final = "default"


def plotly() -> str:
    """Return Plotly as a script, which defines ``Plotly``."""
    return _read("plotly", "package_data/plotly.min.js")


def datatables() -> str:
    """Return DataTables with its extensions as a script, which defines ``DataTable``.

    The package itables has it as a module. A module cannot be a script of a page that is opened
    from a disk, so that its last statement, the export, is turned into an assignment.

    Raises
    ------
    ValueError
        If the module does not end with such a statement: another version of itables.
    """
    module = _read("itables", "html/dt_bundle.js")
    found = list(_EXPORT.finditer(module))
    names = dict(_pair(one) for one in found[-1]["names"].split(",")) if found else {}
    if _WANTED not in names:
        raise ValueError("itables: its module no longer exports DataTables by default.")
    last = found[-1]
    body = f"{module[: last.start()]}window.DataTable={names[_WANTED]};{module[last.end() :]}"
    # What would end the element that the script stands in.
    return f'(()=>{{"use strict";{body}\n}})();'.replace("</script", "<\\/script")


def _pair(text: str) -> tuple[str, str]:
    inside, _, outside = text.strip().partition(" as ")
    return outside or inside, inside


def datatables_style() -> str:
    """Return the style sheet of DataTables and its extensions."""
    return _read("itables", "html/dt_bundle.css")


def _read(package: str, path: str) -> str:
    return (importlib.resources.files(package) / path).read_text(encoding="utf-8")
