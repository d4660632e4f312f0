"""Tables of how far the reduced-order analysis is from the full one."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence

import numpy as np
import pandas as pd
from performance.page import table, wrapped
from scipy.stats import spearmanr

from pagd.stages.reduced import CELLS, PIECES
from reduction.pairs import Pair

__all__ = ["text_of"]

_WORDS = {CELLS: "cells alone", PIECES: "cells and pieces"}
_FORCES = "blocked_force_N"


def text_of(pairs: Sequence[Pair], wanted: int, *, brief: bool = False) -> str:
    """The section: all designs, by mode, by pressure, by number of chambers, statuses, worst.

    A ``brief`` one has all designs, how they end, and what the gate makes of them.
    """
    introduction = wrapped(
        f"{len({pair.name for pair in pairs})} of {wanted} random designs that were solved in "
        "full; errors are those of the last recorded pressure that both reached, unless it is "
        "told. The error of a tip is its distance from that of the full model by the latter's "
        "displacement; those of forces are of so many designs as have one in both."
    )
    ends = ["How designs end, in full and reduced:", _statuses(pairs)]
    gate = [
        wrapped(
            "What the gate makes of them. Gated: cells where they are trusted, else pieces where "
            "they are, else the full analysis, whose errors count as none and whose seconds are "
            "those of the study:"
        ),
        _gate(pairs),
        "Why cells alone, and pieces, are not trusted:",
        _doubts(pairs),
    ]
    if brief:
        return "\n\n".join([introduction, _all(pairs), *ends, *gate])
    parts = [
        introduction,
        _all(pairs),
        "By mode, last pressure, median and 90th percentile of the tip's error:",
        _groups(pairs, lambda pair: pair.mode),
        "By number of chambers:",
        _groups(pairs, _chambers),
        "By pressure:",
        _by_pressure(pairs),
        wrapped(
            "What is lacking at the ends: how much further the row turns in full than reduced, "
            "from the clamp to the first gap and from the last gap to the tip, as a share of what "
            "a chamber in the middle turns by; 10th percentile, median and 90th:"
        ),
        _ends(pairs),
        *ends,
        *gate,
        "The ten tips that are farthest off, cells and pieces:",
        _worst([pair for pair in pairs if pair.fidelity == PIECES]),
    ]
    return "\n\n".join(parts)


def _all(pairs: Sequence[Pair]) -> str:
    rows = []
    for fidelity, words in _WORDS.items():
        some = [pair for pair in pairs if pair.fidelity == fidelity]
        last = _last(some)
        seconds = np.array([pair.cpu_s for pair in some])
        rows.append(
            [
                words,
                _both(last["tip_error"], percent=True),
                _both(_off(last, "bending_deg"), percent=False),
                _both(_off(last, "twist_deg"), percent=False),
                _rank(last, "bending_deg"),
                _rank(last[last["mode"] != "bending"], "twist_deg"),
                _forces(last),
                f"{np.median(seconds):.2f} / {np.percentile(seconds, 90):.2f}",
            ]
        )
    return table(
        [
            "median / 90th percentile",
            "tip error",
            "bending, °",
            "twist, °",
            "rank correlation, bending",
            "twist",
            "blocked force",
            "core-s",
        ],
        rows,
    )


def _last(pairs: Iterable[Pair]) -> pd.DataFrame:
    rows = [
        pair.rows.iloc[-1].to_dict()
        | {"mode": pair.mode, "chambers": pair.chambers, "name": pair.name}
        for pair in pairs
        if len(pair.rows)
    ]
    return pd.DataFrame(rows)


def _off(rows: pd.DataFrame, name: str) -> pd.Series:
    return (rows[name] - rows[f"{name}_full"]).abs()


def _force_errors(rows: pd.DataFrame) -> pd.Series:
    known = rows.dropna(subset=[_FORCES, f"{_FORCES}_full"])
    return (known[_FORCES] / known[f"{_FORCES}_full"] - 1.0).abs()


def _both(values: pd.Series, *, percent: bool) -> str:
    known = values.dropna().to_numpy(float)
    if not len(known):
        return "–"
    pair = np.median(known), np.percentile(known, 90)
    return " / ".join(f"{100 * v:.2f} %" if percent else f"{v:.2f}" for v in pair)


def _forces(rows: pd.DataFrame) -> str:
    """Errors of the force, and of how many designs: those that have one in both analyses."""
    errors = _force_errors(rows)
    return f"{_both(errors, percent=True)} ({len(errors)})"


def _rank(rows: pd.DataFrame, name: str) -> str:
    if len(rows) < 3:
        return "–"
    return f"{spearmanr(rows[name], rows[f'{name}_full']).statistic:.4f}"


def _chambers(pair: Pair) -> str:
    low = pair.chambers - pair.chambers % 3
    return f"{low} to {low + 2}"


def _groups(pairs: Sequence[Pair], of: Callable[[Pair], str]) -> str:
    names = sorted({of(pair) for pair in pairs}, key=lambda name: (len(name), name))
    rows = []
    for name in names:
        mine = [pair for pair in pairs if of(pair) == name]
        cells = [name, str(len({pair.name for pair in mine}))]
        for fidelity in _WORDS:
            last = _last(pair for pair in mine if pair.fidelity == fidelity)
            cells.append(_both(last["tip_error"], percent=True) if len(last) else "–")
            cells.append(_forces(last) if len(last) else "–")
        rows.append(cells)
    return table(
        ["", "designs", "cells: tip", "cells: force", "pieces: tip", "pieces: force"], rows
    )


def _by_pressure(pairs: Sequence[Pair]) -> str:
    rows = []
    every = pd.concat(
        [pair.rows.assign(fidelity=pair.fidelity) for pair in pairs if len(pair.rows)]
    )
    for pressure, group in every.groupby("pressure_kPa"):
        cells = [f"{pressure:g} kPa", str(len(group[group["fidelity"] == CELLS]))]
        for fidelity in _WORDS:
            mine = group[group["fidelity"] == fidelity]
            cells.append(_both(mine["tip_error"], percent=True))
            cells.append(_forces(mine))
        rows.append(cells)
    return table(
        ["", "designs", "cells: tip", "cells: force", "pieces: tip", "pieces: force"], rows
    )


def _ends(pairs: Sequence[Pair]) -> str:
    rows = []
    for mode in sorted({pair.mode for pair in pairs}):
        for fidelity, words in _WORDS.items():
            ends = [p.ends for p in pairs if p.mode == mode and p.fidelity == fidelity]
            known = np.array([pair for pair in ends if np.isfinite(pair).all()]).reshape(-1, 2)
            if not len(known):
                continue
            parts = np.percentile(known, [10, 50, 90], axis=0).T
            cells = (" / ".join(f"{share:+.2f}" for share in part) for part in parts)
            rows.append([f"{mode}, {words}", *cells])
    return table(["", "first chamber", "last chamber"], rows)


def _statuses(pairs: Sequence[Pair]) -> str:
    rows = []
    counts = Counter((pair.status_full, pair.status, pair.fidelity) for pair in pairs)
    for full, reduced in sorted({(a, b) for a, b, _ in counts}):
        cells = [str(counts[full, reduced, fidelity]) for fidelity in _WORDS]
        rows.append([full, reduced, *cells])
    return table(["full", "reduced", *_WORDS.values()], rows)


def _gate(pairs: Sequence[Pair]) -> str:
    rows = []
    for fidelity, words in _WORDS.items():
        mine = [pair for pair in pairs if pair.fidelity == fidelity]
        for told, some in (
            ("trusted", [pair for pair in mine if pair.doubt is None]),
            ("not trusted", [pair for pair in mine if pair.doubt is not None]),
        ):
            rows.append([f"{words}, {told}", *_errors(some, len(mine))])
    by = {(pair.name, pair.fidelity): pair for pair in pairs}
    names = dict.fromkeys(pair.name for pair in pairs)
    last = {name: _trusted(by[name, CELLS], by[name, PIECES]) for name in names}
    seconds = np.array([s for _, s in last.values()])
    reduced = [pair for pair, _ in last.values() if pair is not None]
    told = _errors(reduced, len(names), exact=len(names) - len(reduced))
    counts = Counter("full" if pair is None else pair.fidelity for pair, _ in last.values())
    share = ", ".join(f"{counts[k]} {k}" for k in (CELLS, PIECES, "full"))
    rows.append([f"gated: {share}", *told[:-1], f"{np.median(seconds):.2f} / {seconds.mean():.2f}"])
    headings = ["", "designs", "tip: median / 90th / largest", "force: median / 90th / largest"]
    return table([*headings, "core-s: median / mean"], rows)


def _trusted(cells: Pair, pieces: Pair) -> tuple[Pair | None, float]:
    """The result that the gate ends with, none for the full one, and the seconds of all."""
    if cells.doubt is None:
        return cells, cells.cpu_s
    if pieces.doubt is None:
        return pieces, cells.cpu_s + pieces.cpu_s
    return None, cells.cpu_s + pieces.cpu_s + pieces.cpu_full_s


def _errors(pairs: Sequence[Pair], count: int, exact: int = 0) -> list[str]:
    """Errors of some of ``count`` designs, and of ``exact`` ones that have none."""
    if not pairs:
        return [f"0 of {count}", "–", "–", "–"]
    last = _last(pairs)
    seconds = np.array([pair.cpu_s for pair in pairs])
    return [
        f"{len(pairs) + exact} of {count}",
        _three(last["tip_error"], exact),
        f"{_three(_force_errors(last), exact)} ({len(_force_errors(last)) + exact})",
        f"{np.median(seconds):.2f} / {seconds.mean():.2f}",
    ]


def _three(values: pd.Series, exact: int) -> str:
    known = np.concatenate([values.dropna().to_numpy(float), np.zeros(exact)])
    if not len(known):
        return "–"
    three = np.median(known), np.percentile(known, 90), known.max()
    return " / ".join(f"{100 * v:.2f} %" for v in three)


def _doubts(pairs: Sequence[Pair]) -> str:
    found = {
        fidelity: Counter(
            re.sub(r"\d+(\.\d+)?", "…", pair.doubt)
            for pair in pairs
            if pair.fidelity == fidelity and pair.doubt
        )
        for fidelity in _WORDS
    }
    reasons = sorted({reason for counts in found.values() for reason in counts})
    rows = [[reason, *(str(found[f][reason]) for f in _WORDS)] for reason in reasons]
    return table(["", *_WORDS.values()], rows)


def _worst(pairs: Sequence[Pair]) -> str:
    known = [pair for pair in pairs if len(pair.rows)]
    known.sort(key=lambda pair: -float(pair.rows["tip_error"].iloc[-1]))
    rows = []
    for pair in known[:10]:
        last = pair.rows.iloc[-1]
        contact = pair.first_contact_kPa
        rows.append(
            [
                pair.name,
                pair.mode,
                f"{last['pressure_kPa']:g}",
                f"{last['tip_error']:.2%}",
                f"{last['bending_deg_full']:.0f}",
                f"{last['twist_deg_full']:.0f}",
                "–" if contact is None else f"{contact:.1f}",
                pair.status_full,
                pair.status,
            ]
        )
    headings = ["design", "mode", "kPa", "tip error", "bending, °", "twist, °"]
    return table([*headings, "first contact, kPa", "full", "reduced"], rows)
