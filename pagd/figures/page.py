"""The page of results: one HTML file that needs neither a network nor any other file."""

from __future__ import annotations

import base64
import html
import importlib.resources
import io
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from string import Template
from typing import Any

from pagd.figures.load import (
    has_states,
    has_trajectory,
    load_records,
    load_states,
    load_trajectory,
)
from pagd.figures.style import STRAIN_COLOURS, STRAIN_LABEL, design_colours, number
from pagd.figures.viewer import path_data, viewer_data
from pagd.files import write_text
from pagd.record import Record

__all__ = ["write_page"]

#: Pictures of a design, and of all designs together, with their captions.
_OF_DESIGN = {
    "deformed": "Deformed shapes at rising pressure.",
    "geometry": "Geometry, cut open, with its dimensions.",
    "mesh": "Mesh, cut open.",
}
_TOGETHER = {
    "gallery": "The designs at their highest pressure, undeformed shapes in grey.",
    "trajectories": "Where centre lines and tips go.",
    "angles": "Bending and twist, of the tip and of every chamber.",
}
# Wide enough for a large screen; WebP at this quality shows no loss.
_PIXELS, _QUALITY = 1650, 85


def write_page(design_folders: Sequence[Path], out: Path, pictures: Path | None = None) -> None:
    """Write the page of some designs.

    Parameters
    ----------
    design_folders
        Folders with the stages' folders, ``figures`` among them if there are pictures. A design
        that failed appears with what there is of it, its status and its reason.
    out
        The HTML file; it appears complete or not at all.
    pictures
        Folder with gallery.png, trajectories.png and angles.png; None leaves them out.
    """
    records = {folder: _last_record(folder) for folder in design_folders}
    colours = design_colours([folder.name for folder in design_folders])
    content = {
        "strain": {"colours": STRAIN_COLOURS, "label": STRAIN_LABEL},
        "designs": [_design_data(f, colours[f.name]) for f in design_folders],
    }
    text = Template(_asset("page.html")).substitute(
        style=_asset("page.css"),
        overview=_pictures(pictures, ("gallery",)),
        table=_table(records),
        more=_pictures(pictures, ("trajectories", "angles")),
        cards="\n".join(_card(folder, record) for folder, record in records.items()),
        data=_json(content),
        plotly=_plotly(),
        script=_asset("page.js"),
    )
    write_text(out, text)


def _design_data(folder: Path, colour: str) -> dict[str, Any]:
    return {
        "name": folder.name,
        "colour": colour,
        "viewer": viewer_data(load_states(folder)) if has_states(folder) else None,
        "path": path_data(load_trajectory(folder)) if has_trajectory(folder) else None,
    }


def _last_record(folder: Path) -> Record | None:
    """Return the record of the last stage that ran: each passes on what came before."""
    records = list(load_records(folder).values())
    return records[-1] if records else None


def _number(digits: int, factor: float = 1.0) -> Callable[[Any], str]:
    return lambda value: number(factor * value, digits)


#: Columns of the table: heading, unit, key in the record's figures, how to write the value.
_COLUMNS: tuple[tuple[str, str, str, Callable[[Any], str]], ...] = (
    ("pressure", "kPa", "pressure_kPa", _number(0)),
    ("bending", "°", "bending_deg", _number(1)),
    ("twist", "°", "twist_deg", _number(1)),
    ("measured mode", "", "measured_mode", str),
    ("drawn for", "", "mode", str),
    ("tip x", "mm", "tip_x_mm", _number(1)),
    ("tip y", "mm", "tip_y_mm", _number(1)),
    ("tip z", "mm", "tip_z_mm", _number(1)),
    ("work density", "kJ/m³", "work_density_kJ_m3", _number(2)),
    ("energy balance", "%", "energy_balance", _number(2, 100.0)),
    ("strain", "99 %", "strain_p99", _number(3)),
    ("mesh size", "mm", "size_mm", str),
    ("tetrahedra", "", "tets", _number(0)),
    ("iterations", "", "newton_iterations", _number(0)),
    ("time", "s", "wall_s", _number(1)),
    ("material", "", "material", str),
)


def _table(records: Mapping[Path, Record | None]) -> str:
    head = "".join(
        f"<th>{html.escape(name)}<br><small>{unit}</small></th>" for name, unit, _, _ in _COLUMNS
    )
    rows = "\n".join(_row(folder.name, record) for folder, record in records.items())
    return f"<thead><tr><th>design</th><th>status</th>{head}</tr></thead><tbody>{rows}</tbody>"


def _row(name: str, record: Record | None) -> str:
    figures = record.figures if record else {}
    cells = "".join(f"<td>{_cell(figures.get(key), write)}</td>" for _, _, key, write in _COLUMNS)
    return f'<tr><th><a href="#design-{name}">{name}</a></th><td>{_status(record)}</td>{cells}</tr>'


def _cell(value: Any, write: Callable[[Any], str]) -> str:
    return "–" if value is None else html.escape(write(value))


def _status(record: Record | None) -> str:
    if record is None:
        return '<span class="status failed">not run</span>'
    kind = "ok" if record.reason is None else "failed"
    return f'<span class="status {kind}">{record.status.value.replace("_", " ")}</span>'


def _card(folder: Path, record: Record | None) -> str:
    """Return the section of one design: viewer, angles, pictures."""
    name, reason = folder.name, record.reason if record else "No stage has left a record."
    parts = [f"<h2>{name} {_status(record)}</h2>"]
    if reason:
        parts.append(f'<p class="reason">{html.escape(reason)}</p>')
    if has_states(folder):
        parts.append(_VIEWER)
    shown = _pictures(folder / "figures", tuple(_OF_DESIGN))
    if shown:
        parts.append(f"<details><summary>Pictures</summary>{shown}</details>")
    return f'<section class="card" id="design-{name}">{"".join(parts)}</section>'


_VIEWER = """
<div class="bench">
  <div>
    <div class="shape"><p class="hint">Loading the deformed shape …</p></div>
    <div class="control">
      <button type="button" aria-label="play">▶</button>
      <input type="range" min="0" max="0" value="0" step="1" aria-label="pressure">
      <output>0 kPa</output>
    </div>
  </div>
  <div class="angles"></div>
</div>
"""


def _pictures(folder: Path | None, names: Sequence[str]) -> str:
    """Return the pictures that the folder holds, embedded."""
    captions = _OF_DESIGN | _TOGETHER
    found = [n for n in names if folder is not None and (folder / f"{n}.png").is_file()]
    return "\n".join(
        f'<figure><img loading="lazy" src="{_embedded(folder / f"{n}.png")}" '
        f'alt="{html.escape(captions[n])}"><figcaption>{captions[n]}</figcaption></figure>'
        for n in found
        if folder is not None
    )


def _embedded(path: Path) -> str:
    """Return a picture as a data address, in a third of the space of PNG."""
    from PIL import Image

    with Image.open(path) as image, io.BytesIO() as buffer:
        image.thumbnail((_PIXELS, 10 * _PIXELS))
        image.convert("RGB").save(buffer, format="WEBP", quality=_QUALITY)
        return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"


def _asset(name: str) -> str:
    file = importlib.resources.files("pagd.figures") / "assets" / name
    return file.read_text(encoding="utf-8")


def _plotly() -> str:
    file = importlib.resources.files("plotly") / "package_data" / "plotly.min.js"
    return file.read_text(encoding="utf-8")


def _json(content: Mapping[str, Any]) -> str:
    # "</" would end the script element that holds it.
    return json.dumps(content, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
