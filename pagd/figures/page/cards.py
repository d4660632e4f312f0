"""The card of one design: shape to turn, angles, pictures; it is closed where there are many."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from pagd.figures.captions import captions_of_design
from pagd.figures.groups import Entry
from pagd.figures.load import has_history, has_states, load_states
from pagd.figures.page.markup import badge, escaped, folded
from pagd.figures.page.mechanics import mechanics_of
from pagd.figures.page.pictures import CARD_PIXELS, PIXELS, pictures
from pagd.figures.style import number
from pagd.figures.viewer import viewer_data

__all__ = ["card", "json_text"]

_VIEWER = """
<div class="bench">
  <div>
    <div class="shape"><p class="hint">Loading the deformed shape …</p></div>
    <div class="control">
      <button type="button" aria-label="play">▶</button>
      <input type="range" min="0" max="0" value="0" step="1" aria-label="pressure">
      <output></output>
    </div>
  </div>
  <div class="angles"></div>
</div>
"""

# Filled by the script with what there is: blocked force, gap, volume.
_CURVES = '<div class="curves"></div>'


def card(entry: Entry, *, is_open: bool) -> str:
    """Return the card of a design as markup; the data of its shape are read when it is seen."""
    pixels = PIXELS if is_open else CARD_PIXELS
    captions = captions_of_design()
    shown = pictures(entry.folder / "figures", captions, captions, pixels, entry.name)
    body = [
        _reason(entry),
        _mechanics(entry),
        _viewer(entry),
        folded("Pictures", shown) if is_open else shown,
    ]
    state = " open" if is_open else ""
    return (
        f'<details class="card" id="design-{escaped(entry.name)}"{state}>'
        f"<summary><h3>{escaped(entry.name)}</h3> {badge(entry.status, ok=entry.is_ok)}"
        f' <span class="about">{escaped(_about(entry))}</span></summary>'
        f"{''.join(body)}</details>"
    )


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


def _viewer(entry: Entry) -> str:
    if not has_states(entry.folder):
        return ""
    data = json_text(viewer_data(load_states(entry.folder)))
    curves = _CURVES if has_history(entry.folder) else ""
    return f'{_VIEWER}{curves}<script type="application/json" class="shape-data">{data}</script>'
