"""The whole page: its sections in the order of the method, its data and its scripts."""

from __future__ import annotations

import importlib.resources
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from string import Template
from typing import Any, Final

from pagd.figures.captions import TOGETHER
from pagd.figures.curves import curves_of
from pagd.figures.groups import FEW, Entry, by_mode, line_looks, read_entries
from pagd.figures.load import has_blocked_force, has_trajectory, load_trajectory
from pagd.figures.page.cards import card, json_text
from pagd.figures.page.generative import SHOWN_ELSEWHERE, generative_sections
from pagd.figures.page.markup import Section, escaped, folded, numbered, section
from pagd.figures.page.mechanics import contact_note
from pagd.figures.page.pictures import pictures as embedded
from pagd.figures.page.rows import Row, rows_of
from pagd.figures.page.run import what_was_run
from pagd.figures.page.screening import screening
from pagd.figures.page.study import Study, captions_of, performance_of, record_in
from pagd.figures.page.table import results_table
from pagd.figures.style import BLOCKED, FREE, MODE_LOOKS, STRAIN_COLOURS, STRAIN_LABEL
from pagd.figures.viewer import path_data
from pagd.files import write_text
from pagd.record import Record

__all__ = ["write_page"]

_SCRIPTS: Final = (
    "plots.js",
    "paths.js",
    "scatter.js",
    "steps.js",
    "shape.js",
    "table.js",
    "page.js",
)
# What a point of the plots of all designs tells of its design.
_OF_POINT: Final = (
    "design_id",
    "origin",
    "mode",
    "status",
    "link",
    "bending_deg",
    "twist_deg",
    "novelty",
    "pressure_kPa",
    "blocked_force_N",
)


def write_page(
    design_folders: Sequence[Path],
    out: Path,
    pictures: Path | None = None,
    study: Study | None = None,
) -> None:
    """Write the page of some designs.

    Parameters
    ----------
    design_folders
        Folders with the stages' folders, ``figures`` among them if there are pictures. A design
        that failed appears with what there is of it, its status and its reason.
    out
        The HTML file; it appears complete or not at all.
    pictures
        Folder with gallery.png, trajectories.png, angles.png and forces.png; None leaves them out.
    study
        Where the results of the generative half lie; None leaves them out.

    Raises
    ------
    InputError
        If a file of the study is there and cannot be read.
    """
    study = study or Study()
    entries = read_entries(design_folders)
    rows = rows_of(entries, performance_of(study))
    sections = numbered(_sections(entries, rows, pictures, study))
    text = Template(_asset("page.html")).substitute(
        style=_asset("page.css"),
        navigation="".join(f'<a href="#{s.name}">{escaped(s.title)}</a>' for s in sections),
        sections="\n".join(section(part) for part in sections),
        data=json_text(_content(entries, rows)),
        plotly=_plotly(),
        script="\n".join(_asset(name) for name in _SCRIPTS),
    )
    write_text(out, text)


def _sections(
    entries: Sequence[Entry], rows: Sequence[Row], pictures: Path | None, study: Study
) -> list[Section]:
    """Return the sections in the order of the method; those without content are empty."""
    cards = [card(entry, is_open=len(entries) <= FEW) for entry in entries]
    return [
        Section("run", "What was run", what_was_run(entries, rows, _records(study))),
        *generative_sections(study),
        Section("screening", "What the designs can do", screening(study)),
        Section("performance", "Performance", _performance(entries, rows, study)),
        Section("shapes", "Deformed shapes", embedded(pictures, ("gallery",), TOGETHER)),
        Section("paths", "Trajectories, angles and forces", _paths(entries, pictures)),
        Section("designs", "Each design", "\n".join(cards)),
    ]


def _records(study: Study) -> list[Record | None]:
    return [record_in(folder) for folder in (study.dataset, study.embedding, study.generated)]


def _performance(entries: Sequence[Entry], rows: Sequence[Row], study: Study) -> str:
    plots = [
        _plot("bending_twist", rows, "twist_deg"),
        _plot("novelty_bending", rows, "novelty"),
        _plot("force_bending", rows, "blocked_force_N"),
    ]
    contact = contact_note(entries)
    return "".join(
        [
            _NOTE,
            f'<p class="note">{escaped(contact)}</p>' if contact else "",
            results_table(rows),
            f'<div class="grid wide">{"".join(plots)}</div>' if any(plots) else "",
            embedded(study.simulated, SHOWN_ELSEWHERE, captions_of(study.simulated)),
        ]
    )


_NOTE: Final = """<p class="note">At the last pressure reached. Bending is positive towards the
paper (down), twist by the right hand about the axis from the fixed end to the tip; both are summed
over the chambers, so that they pass 180°. Energy balance: |∫p&nbsp;dV&nbsp;−&nbsp;U|&nbsp;/&nbsp;U.
Strain: 99th percentile of the largest principal logarithmic strain. A click on a heading sorts.</p>
"""


def _plot(name: str, rows: Iterable[Row], key: str) -> str:
    """Return the place of a plot of all designs, if one of them knows the key."""
    if not any(row.get(key) is not None for row in rows):
        return ""
    caption = f"<figcaption>{escaped(TOGETHER[name])}</figcaption>"
    return f'<figure><div class="plot tall" id="plot-{name}"></div>{caption}</figure>'


def _paths(entries: Sequence[Entry], pictures: Path | None) -> str:
    shown = embedded(pictures, ("trajectories", "angles", "forces"), TOGETHER)
    if not any(has_trajectory(entry.folder) for entry in entries):
        return shown
    held = any(has_blocked_force(entry.folder) for entry in entries)
    names = ("side", "front", "bending", "twist", *(("force",) if held else ()))
    plots = "".join(f'<div class="plot" id="plot-{name}"></div>' for name in names)
    return (
        '<div class="choice" id="groups" role="group" aria-label="designs shown"></div>'
        f'<ul id="key"></ul><div class="grid">{plots}</div>'
        f'<p class="note">{escaped(TOGETHER["paths"])}</p>'
        f"{folded('Pictures', shown) if len(entries) <= FEW else shown}"
    )


def _content(entries: Sequence[Entry], rows: Sequence[Row]) -> dict[str, Any]:
    """Return what the scripts draw from, but for the shapes, which stand in the cards."""
    groups = by_mode(entries)
    return {
        "strain": {"colours": STRAIN_COLOURS, "label": STRAIN_LABEL},
        "analyses": {"free": FREE, "held": BLOCKED},
        "modes": {mode: look.colour for mode, look in MODE_LOOKS.items()},
        "groups": list(groups) if len(entries) > FEW else [],
        "designs": _designs(entries, groups),
        "points": [{key: _shown(row.get(key)) for key in _OF_POINT} for row in rows],
    }


def _shown(value: Any) -> Any:
    """Return a value without what is round-off: a twist of 1e-14° would have an axis of its own."""
    return round(value, 6) + 0.0 if isinstance(value, float) else value


def _designs(
    entries: Sequence[Entry], groups: Mapping[str, Sequence[Entry]]
) -> list[dict[str, Any]]:
    """Return the designs with their paths; their lines are as in the pictures."""
    if len(entries) <= FEW:
        lines = line_looks([e.name for e in entries])
    else:
        parts = [line_looks([e.name for e in group]) for group in groups.values()]
        lines = {name: line for part in parts for name, line in part.items()}
    return [
        {
            "name": entry.name,
            "mode": entry.mode,
            "colour": lines[entry.name].colour,
            "dash": lines[entry.name].script,
            "path": _path(entry),
            "steps": curves_of(entry.folder),
        }
        for entry in entries
    ]


def _path(entry: Entry) -> dict[str, Any] | None:
    return path_data(load_trajectory(entry.folder)) if has_trajectory(entry.folder) else None


def _asset(name: str) -> str:
    file = importlib.resources.files("pagd.figures") / "assets" / name
    return file.read_text(encoding="utf-8")


def _plotly() -> str:
    file = importlib.resources.files("plotly") / "package_data" / "plotly.min.js"
    return file.read_text(encoding="utf-8")
