"""What generated designs can do beside training designs, as a chamber each tells it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from pagd.figures.page.generative import counted
from pagd.figures.page.markup import data_table, escaped, facts
from pagd.figures.page.pictures import pictures
from pagd.figures.page.study import Study, captions_of, fronts_of, record_in
from pagd.figures.style import number
from pagd.fronts import OBJECTIVES

__all__ = ["answer_of", "screening"]

_NOTE: Final = """<p class="note">Every design is one chamber of an endless row, which costs a
second, not a minute, and tells bending, twist and force to some percent. The volume is that of all
combinations of the objectives that a design of a set reaches or exceeds, as many designs of either
kind; in brackets the middle 95 % of it when the designs are drawn again and again. Whatever errors
chambers have, both kinds have them.</p>"""


def screening(study: Study) -> str:
    """Return the section as markup, empty without results."""
    record = record_in(study.screened)
    if record is None:
        return ""
    found, fronts = record.figures, fronts_of(study)
    return "".join(
        [
            facts(
                [
                    ("generated designs by a chamber each", f"{found['designs']:,}"),
                    ("how they ended", counted(found["statuses"])),
                    ("core-seconds each, median", number(found["cpu_s_median"], 2)),
                    ("training designs compared", f"{fronts.get('training', 0):,}"),
                ]
            ),
            f"<p><strong>{escaped(answer_of(fronts))}</strong></p>" if fronts else "",
            _NOTE,
            _table(fronts),
            pictures(
                study.screening_pictures,
                captions_of(study.screening_pictures),
                captions_of(study.screening_pictures),
            ),
        ]
    )


def answer_of(fronts: Mapping[str, Any]) -> str:
    """Whether generated designs are better than training designs, in a sentence or two.

    Parameters
    ----------
    fronts
        What :func:`pagd.fronts.compare` returns.
    """
    whole = fronts["comparisons"][0]
    told = {key: number(100.0 * (whole[key] - 1.0), 0) for key in ("ratio", "low", "high")}
    volume = f"{told['ratio']} % ({told['low']} to {told['high']} %)"
    if whole["low"] > 1.0:
        answer = f"By all objectives at once, generated designs do more: by {volume} in volume."
    elif whole["high"] < 1.0:
        answer = f"By all objectives at once, generated designs do less: by {volume} in volume."
    else:
        answer = f"By all objectives at once no difference is certain: {volume} in volume."
    new, old = (sum(whole["front"][kind].values()) for kind in ("generated", "training"))
    return f"{answer} Of the {new + old} designs that none exceeds, {new} are generated."


def _table(fronts: Mapping[str, Any]) -> str:
    if not fronts:
        return ""
    head = ["objectives", "volume, generated / training", "draws above 1", "front: generated", ""]
    head[-1] = "front: training"
    return data_table(head, [_row(each) for each in fronts["comparisons"]])


def _row(comparison: Mapping[str, Any]) -> list[str]:
    low, ratio, high = (number(comparison[key], 2) for key in ("low", "ratio", "high"))
    front = comparison["front"]
    return [
        ", ".join(OBJECTIVES[name] for name in comparison["objectives"]),
        f"{ratio} [{low}, {high}]",
        f"{number(100.0 * comparison['likely'], 0)} %",
        *(_modes(front[kind]) for kind in ("generated", "training")),
    ]


def _modes(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {mode}" for mode, count in sorted(counts.items())) or "none"
