"""What generated designs can do beside training designs, as a chamber each tells it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from pagd.figures.page.generative import counted
from pagd.figures.page.markup import data_table, escaped, facts
from pagd.figures.page.pictures import pictures
from pagd.figures.page.study import Study, captions_of, fronts_of, record_in
from pagd.figures.style import number
from pagd.fronts import OBJECTIVES

__all__ = ["answer_of", "screening"]

_NOTE: Final = """<p class="note">Every design is one chamber of an endless row, which costs
seconds, not a minute; how far that is from the full analysis tells docs/reduced-order.md.
Mixed designs, all of them generated, have errors of their own, where chambers change. A
gate tells whose blocked force is doubtful: of rows held far from their free shape, which
those that curl most are. Where forces are compared such designs are left out of both kinds,
so that it is of those that curl moderately. The volume is that of all combinations of the
objectives that a design of a draw reaches or exceeds; in brackets the middle 95 % of the
draws. p is how often labels given at random make as much of a difference. Designs that fail
count as designs that do nothing, unless the gate doubts that they do.</p>"""
# Differences are called certain if labels given at random make any of them more rarely.
_CERTAIN: Final = 0.05
_FORCE: Final = "blocked_force_N"


def screening(study: Study) -> str:
    """Return the section as markup, empty without results."""
    record = record_in(study.screened)
    if record is None:
        return ""
    found, fronts = record.figures, fronts_of(study)
    captions = captions_of(study.screening_pictures)
    return "".join(
        [
            facts(
                [
                    ("generated designs by a chamber each", f"{found['designs']:,}"),
                    ("how they ended", counted(found["statuses"])),
                    ("core-seconds each, median", number(found["cpu_s_median"], 2)),
                    ("doubtful, by the gate", f"{found.get('doubted', 0):,}"),
                    ("training designs compared", f"{fronts.get('training', 0):,}"),
                ]
            ),
            f"<p><strong>{escaped(answer_of(fronts))}</strong></p>" if fronts else "",
            _NOTE,
            _table(fronts),
            pictures(study.screening_pictures, captions, captions),
        ]
    )


def answer_of(fronts: Mapping[str, Any]) -> str:
    """Whether generated designs are better than training designs, in a few sentences.

    First by what cells are sure of, bending and twist, then with the blocked force.

    Parameters
    ----------
    fronts
        What :func:`pagd.fronts.compare` returns.
    """
    if not fronts["comparisons"]:
        return "Too few designs came to their end to compare generated and training designs."
    several = len(fronts["comparisons"])
    told = [_sentence(each, several) for each in _of_answer(fronts["comparisons"])]
    whole = fronts["comparisons"][0]
    share = number(100.0 * whole["share"], 0)
    return f"{' '.join(told)} Of the front of such a draw {share} % are generated."


def _of_answer(comparisons: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The comparison of what cells are sure of, and that of everything."""
    free = [each for each in comparisons if _FORCE not in each["objectives"]]
    return [*free[:1], *([comparisons[0]] if comparisons[0] not in free[:1] else [])]


def _sentence(comparison: Mapping[str, Any], several: int) -> str:
    """One comparison in words; certain is what is so among ``several`` (Bonferroni)."""
    objectives = ", ".join(OBJECTIVES[name] for name in comparison["objectives"])
    better = "more" if comparison["ratio"] > 1.0 else "less"
    of = comparison["compared"]
    how = (
        f"{number(100.0 * abs(comparison['ratio'] - 1.0), 0)} % {better} in volume, "
        f"{comparison['drawn']:,} designs of either kind, drawn from {of['generated']:,} generated "
        f"and {of['training']:,} training designs, p = {number(comparison['p'], 3)}"
    )
    if several * comparison["p"] > _CERTAIN:
        return f"By {objectives} at once no difference is certain: {how}."
    return f"By {objectives} at once, generated designs do {better}: {how}."


def _table(fronts: Mapping[str, Any]) -> str:
    if not fronts or not fronts["comparisons"]:
        return ""
    head = [
        "objectives",
        "volume, generated / training",
        "p",
        "share of the front",
        "front of all: generated",
        "front of all: training",
    ]
    return data_table(head, [_row(each) for each in fronts["comparisons"]])


def _row(comparison: Mapping[str, Any]) -> list[str]:
    low, ratio, high = (number(comparison[key], 2) for key in ("low", "ratio", "high"))
    front = comparison["front"]
    return [
        ", ".join(OBJECTIVES[name] for name in comparison["objectives"]),
        f"{ratio} [{low}, {high}]",
        number(comparison["p"], 3),
        f"{number(100.0 * comparison['share'], 0)} %",
        *(_modes(front[kind]) for kind in ("generated", "training")),
    ]


def _modes(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {mode}" for mode, count in sorted(counts.items())) or "none"
