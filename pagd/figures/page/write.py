"""The whole page: its sections in the order of the method, its data and its scripts."""

from __future__ import annotations

import importlib.resources
from collections.abc import Mapping, Sequence
from pathlib import Path
from string import Template
from typing import Any, Final
from urllib.parse import quote

from pagd.figures.captions import TOGETHER
from pagd.figures.curves import steps_data
from pagd.figures.groups import (
    FEW,
    Entry,
    by_mode,
    line_looks,
    read_entries,
    refuse_equal_names,
)
from pagd.figures.load import (
    has_blocked_force,
    has_trajectory,
    load_blocked_force,
    load_trajectory,
)
from pagd.figures.page.cards import card, json_text, write_card
from pagd.figures.page.claims import claims
from pagd.figures.page.explorer import explorer, explorer_data
from pagd.figures.page.generative import SHOWN_ELSEWHERE, generative_sections
from pagd.figures.page.libraries import datatables, datatables_style, plotly
from pagd.figures.page.markup import Section, escaped, folded, numbered, section
from pagd.figures.page.mechanics import contact_note
from pagd.figures.page.pictures import pictures as embedded
from pagd.figures.page.rows import Row, rows_of
from pagd.figures.page.run import what_was_run
from pagd.figures.page.screening import screening
from pagd.figures.page.study import Study, captions_of, performance_of, record_in
from pagd.figures.style import (
    BLOCKED,
    FREE,
    MODE_LOOKS,
    STRAIN_COLOURS,
    STRAIN_LABEL,
    design_colours,
)
from pagd.figures.viewer import tip_data
from pagd.files import write_text
from pagd.record import Record

__all__ = ["cards_beside", "write_page"]

_SCRIPTS: Final = (
    "plots.js",
    "paths.js",
    "steps.js",
    "shape.js",
    "boxes.js",
    "cards.js",
    "explorer.js",
    "compare.js",
    "page.js",
)


def write_page(
    design_folders: Sequence[Path],
    out: Path,
    pictures: Path | None = None,
    study: Study | None = None,
    cards: Path | None = None,
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
    cards
        Folder below that of ``out`` with NAME/card.js of every design, as :mod:`pagd.stages.export`
        leaves it. None: they are written anew, beside the page, without files to take away.

    Raises
    ------
    InputError
        If two designs have the same name, or a file of the study is there and cannot be read.
    """
    study = study or Study()
    entries = read_entries(design_folders)
    refuse_equal_names(design_folders, [entry.name for entry in entries])
    rows = rows_of(entries, performance_of(study))
    cards = cards or _cards_beside(entries, out)
    addresses = {entry.name: _address(cards / entry.name, out) for entry in entries}
    sections = numbered(_sections(entries, rows, pictures, study, addresses))
    text = Template(_asset("page.html")).substitute(
        style=f"{datatables_style()}\n{_asset('page.css')}",
        navigation="".join(f'<a href="#{s.name}">{escaped(s.title)}</a>' for s in sections),
        sections="\n".join(section(part) for part in sections),
        data=json_text(_content(entries) | {"explorer": explorer_data(rows, study)}),
        libraries=f"{plotly()}\n{datatables()}",
        script="\n".join(_asset(name) for name in _SCRIPTS),
    )
    write_text(out, text)


def cards_beside(page: Path) -> Path:
    """Return the folder of the cards of a page that has none of its own: PAGE_files."""
    return page.with_name(f"{page.stem}_files")


def _cards_beside(entries: Sequence[Entry], out: Path) -> Path:
    folder = cards_beside(out)
    for entry in entries:
        write_card(entry.folder, folder / entry.name)
    return folder


def _address(folder: Path, page: Path) -> str:
    return quote(folder.relative_to(page.parent).as_posix())


def _sections(
    entries: Sequence[Entry],
    rows: Sequence[Row],
    pictures: Path | None,
    study: Study,
    addresses: Mapping[str, str],
) -> list[Section]:
    """Return the sections in the order of the method, a few designs before all; some are empty."""
    few = len(entries) <= FEW
    cards = [card(entry, addresses[entry.name], is_open=few) for entry in entries]
    sections = [
        Section("run", "What was run", what_was_run(entries, rows, _records(study))),
        Section("paper", "Beside the paper", claims(study, rows)),
        Section("explorer", "Explorer", explorer() if rows else ""),
        *generative_sections(study),
        Section("screening", "What the designs can do", screening(study)),
        Section("performance", "Performance", _performance(entries, study)),
        Section("shapes", "Deformed shapes", embedded(pictures, ("gallery",), TOGETHER)),
        Section("paths", "Trajectories, angles and forces", _paths(entries, pictures)),
    ]
    designs = Section("designs", "Each design", "\n".join(cards))
    # Whoever asks for a few designs wants to see them.
    return [designs, *sections] if few else [*sections, designs]


def _records(study: Study) -> list[Record | None]:
    return [record_in(folder) for folder in (study.dataset, study.embedding, study.generated)]


def _performance(entries: Sequence[Entry], study: Study) -> str:
    contact = contact_note(entries)
    return "".join(
        [
            f'<p class="note">{escaped(contact)}</p>' if contact else "",
            embedded(study.simulated, SHOWN_ELSEWHERE, captions_of(study.simulated)),
        ]
    )


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


def _content(entries: Sequence[Entry]) -> dict[str, Any]:
    """Return what the scripts draw from, but for what only the cards show."""
    groups = by_mode(entries)
    return {
        "strain": {"colours": STRAIN_COLOURS, "label": STRAIN_LABEL},
        "analyses": {"free": FREE, "held": BLOCKED},
        "modes": {mode: look.colour for mode, look in MODE_LOOKS.items()},
        "palette": list(design_colours(["a", "b", "c", "d"]).values()),
        "groups": list(groups) if len(entries) > FEW else [],
        "designs": _designs(entries, groups),
    }


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
            "held": _held(entry),
        }
        for entry in entries
    ]


def _path(entry: Entry) -> dict[str, Any] | None:
    return tip_data(load_trajectory(entry.folder)) if has_trajectory(entry.folder) else None


def _held(entry: Entry) -> dict[str, Any] | None:
    if not has_blocked_force(entry.folder):
        return None
    steps = steps_data(load_blocked_force(entry.folder))
    # Without a force at any step there is nothing to draw.
    return {key: steps[key] for key in ("pressure_kPa", "force_N")} if "force_N" in steps else None


def _asset(name: str) -> str:
    file = importlib.resources.files("pagd.figures") / "assets" / name
    return file.read_text(encoding="utf-8")
