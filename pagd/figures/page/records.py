"""What the records of a design say: its key figures, its mesh, and all of them as they stand."""

from __future__ import annotations

import json
from typing import Any, Final

from pagd.figures.groups import Entry
from pagd.figures.load import load_records
from pagd.figures.page.markup import badge, escaped, facts
from pagd.figures.page.shown import FIGURES, Shown
from pagd.figures.style import number

__all__ = ["key_figures", "mesh_quality", "stage_records"]

# What a card tells elsewhere, or is told of many designs only.
_ELSEWHERE: Final = ("design_id", "status", "analysis", "origin", "mode", "novelty", "reason")
_OF_MESH: Final = (
    Shown("mesher", "", "mesher"),
    Shown("half model", "", "half"),
    Shown("tetrahedra", "", "tets", 0),
    Shown("hexahedra", "", "hexahedra", 0),
    Shown("wedges", "", "wedges", 0),
    Shown("nodes", "", "nodes", 0),
    Shown("scaled Jacobian, smallest", "", "scaled_jacobian_min", 3),
    Shown("scaled Jacobian, 1 % below", "", "scaled_jacobian_p01", 3),
    Shown("scaled Jacobian, median", "", "scaled_jacobian_median", 3),
    Shown("volume", "mm³", "volume_mm3", 1),
    Shown("error of the volume", "%", "volume_error", 4, 100.0),
)


def key_figures(entry: Entry) -> str:
    """Return the figures of a design at its last pressure, those that are known."""
    return facts(_told(entry.figures, [one for one in FIGURES if one.key not in _ELSEWHERE]))


def mesh_quality(entry: Entry) -> str:
    """Return what the record of the mesh says of its size and quality, and who made it."""
    record = load_records(entry.folder).get("mesh")
    if record is None:
        return ""
    faces = ", ".join(f"{n} {number(k, 0)}" for n, k in record.figures.get("surfaces", {}).items())
    tried = "; ".join(_attempt(one) for one in record.figures.get("attempts", ()))
    rows = _told(record.figures, _OF_MESH)
    return facts([*rows, ("faces by surface", escaped(faces)), ("meshers tried", escaped(tried))])


def stage_records(entry: Entry) -> str:
    """Return the records of all stages, each folded: how it ended, and all of it as JSON."""
    return "".join(
        f'<details class="stage"><summary>{escaped(stage)} '
        f"{badge(record.status.value.replace('_', ' '), ok=record.status.value == 'ok')}"
        f" {number(record.timings_s['wall'], 1)} s, {number(record.peak_memory_MB, 0)} MB</summary>"
        f"<pre>{escaped(json.dumps(record.as_dict(), indent=1, ensure_ascii=False))}</pre>"
        "</details>"
        for stage, record in load_records(entry.folder).items()
    )


def _told(figures: dict[str, Any], wanted: list[Shown] | tuple[Shown, ...]) -> list[Any]:
    known = [(one, figures[one.key]) for one in wanted if figures.get(one.key) is not None]
    return [(one.heading, escaped(one.in_words(_plain(value)))) for one, value in known]


def _plain(value: Any) -> Any:
    return ("yes" if value else "no") if isinstance(value, bool) else value


def _attempt(attempt: dict[str, Any]) -> str:
    reason = attempt.get("reason")
    ended = f"failed: {reason}" if reason else "taken"
    return f"{attempt.get('mesher')} in {number(attempt.get('seconds') or 0.0, 1)} s, {ended}"
