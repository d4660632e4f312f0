"""The card of one design: a line of the page, and a file of its own that is read when it is opened.

With the shapes of all designs inside it, a page of a thousand would be a gigabyte.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from pagd.figures.captions import captions_of_design
from pagd.figures.curves import curves_of
from pagd.figures.groups import Entry, read_entries
from pagd.figures.load import has_states, has_trajectory, load_states, load_trajectory
from pagd.figures.page.downloads import downloads
from pagd.figures.page.markup import badge, escaped, folded
from pagd.figures.page.mechanics import mechanics_of
from pagd.figures.page.pictures import CARD_PIXELS, pictures
from pagd.figures.page.records import key_figures, mesh_quality, stage_records
from pagd.figures.style import number
from pagd.figures.viewer import path_data, viewer_data
from pagd.files import write_text

__all__ = ["CARD_NAME", "card", "card_content", "json_text", "write_card"]

CARD_NAME: Final = "card.js"


def card(entry: Entry, address: str, *, is_open: bool) -> str:
    """Return the line of a design as markup; the script fills in the card when it is opened.

    ``address``: where its file lies, seen from the page.
    """
    state = " open" if is_open else ""
    return (
        f'<details class="card" id="design-{escaped(entry.name)}"'
        f' data-address="{escaped(address)}"{state}>'
        f"<summary><h3>{escaped(entry.name)}</h3> {badge(entry.status, ok=entry.is_ok)}"
        f' <span class="about">{escaped(_about(entry))}</span></summary></details>'
    )


def write_card(design: Path, folder: Path) -> None:
    """Write card.js of a design to a folder, in which files to offer may lie already.

    A script and no JSON: a page that is opened from a disk may load the one, and not the other.

    Parameters
    ----------
    design
        Folder with the folders of the design's stages.
    folder
        Where to write it; what else lies there is offered for download.
    """
    entry = read_entries([design])[0]
    content = card_content(entry, downloads(folder))
    write_text(folder / CARD_NAME, f"takeCard({json_text({'name': entry.name, **content})});\n")


def card_content(entry: Entry, offered: str = "") -> dict[str, Any]:
    """Return what the card of a design shows.

    Keys: ``markup``, with what is ``offered`` for download; ``shape`` of
    :func:`pagd.figures.viewer.viewer_data`, ``path`` of :func:`pagd.figures.viewer.path_data` and
    ``steps`` of :func:`pagd.figures.curves.curves_of`, None or empty where there are none.
    """
    captions = captions_of_design()
    # First what was drawn, in sections with its dimensions.
    names = sorted(captions, key=lambda name: name != "geometry")
    body = [
        _reason(entry),
        '<div class="place"></div>',
        key_figures(entry),
        _mechanics(entry),
        folded("Mesh", mesh_quality(entry)),
        folded("Downloads", offered),
        folded("Record", stage_records(entry)),
        pictures(entry.folder / "figures", names, captions, CARD_PIXELS, entry.name),
    ]
    return {
        "markup": "".join(body),
        "shape": viewer_data(load_states(entry.folder)) if has_states(entry.folder) else None,
        "path": path_data(load_trajectory(entry.folder)) if has_trajectory(entry.folder) else None,
        "steps": curves_of(entry.folder),
    }


def json_text(content: Mapping[str, Any]) -> str:
    """Return JSON that can stand in a script element."""
    # "</" would end the element.
    return json.dumps(content, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")


def _about(entry: Entry) -> str:
    figures = entry.figures
    words = [entry.origin, entry.mode]
    for word, key in (("bends", "bending_deg"), ("twists", "twist_deg")):
        if figures.get(key) is not None:
            words.append(f"{word} {number(figures[key], 0)}°")
    return ", ".join(words)


def _reason(entry: Entry) -> str:
    reason = entry.record.reason if entry.record else "No stage has left a record."
    return f'<p class="reason">{escaped(reason)}</p>' if reason else ""


def _mechanics(entry: Entry) -> str:
    told = mechanics_of(entry)
    return f'<p class="note">{escaped(told)}</p>' if told else ""
