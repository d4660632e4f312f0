"""Data set, embedding, generator, novelty and diversity: facts and pictures in sections."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, Final

from pagd.diversity.comparison import TRAINING
from pagd.figures.generative.names import metric_name, space_name
from pagd.figures.page.markup import Section, data_table, escaped, facts
from pagd.figures.page.pictures import pictures
from pagd.figures.page.study import Study, captions_of, comparison_of, record_in
from pagd.figures.style import number

__all__ = ["SHOWN_ELSEWHERE", "comparison_table", "counted", "generative_sections"]

#: Pictures of simulated designs, which the section on performance shows.
SHOWN_ELSEWHERE: Final = (
    "feasibility",
    "bending_twist",
    "force_bending",
    "novelty_performance",
)
# Measures below are rounding errors.
_NOTHING: Final = 1e-9
_OF_EMBEDDING: Final = ("embedding",)
_OF_GENERATOR: Final = ("mixture",)
# What is counted: one of it, and more.
_WORDS: Final = {
    "table2": ("of Table 2", "of Table 2"),
    "copies_of_training": ("copy of a training design", "copies of training designs"),
    "duplicates": ("duplicate", "duplicates"),
    "other_mode": ("of another mode", "of other modes"),
}


def generative_sections(study: Study) -> list[Section]:
    """Return the sections, empty where there are no results."""
    captions = captions_of(study.pictures)

    def shown(names: Iterable[str]) -> str:
        return pictures(study.pictures, names, captions)

    placed = (*_OF_EMBEDDING, *_OF_GENERATOR, *SHOWN_ELSEWHERE)
    others = [name for name in captions if name not in placed]
    return [
        Section(
            "dataset",
            "Data set and embedding",
            "".join([facts(_of_dataset(study) + _of_embedding(study)), shown(_OF_EMBEDDING)]),
        ),
        Section(
            "generator",
            "Generator and modes",
            "".join([facts(_of_generator(study)), shown(_OF_GENERATOR)]),
        ),
        Section(
            "diversity",
            "Novelty and diversity",
            "".join(
                [facts(_of_novelty(study)), comparison_table(comparison_of(study)), shown(others)]
            ),
        ),
    ]


def comparison_table(content: Mapping[str, Any]) -> str:
    """Return the comparison of generators as tables, one a space, generators in rows.

    Parameters
    ----------
    content
        ``generator``, the configured one; ``rows`` with generator, space, mode, metric, value,
        low and high; ``metrics`` and ``spaces``, what their names mean.
    """
    rows = [row for row in content.get("rows", []) if row.get("mode", "all") == "all"]
    there = dict.fromkeys(str(row["space"]) for row in rows)
    spaces = [*(s for s in content.get("spaces", {}) if s in there), *there]
    return "".join(_of_space(space, rows, content) for space in dict.fromkeys(spaces))


def _of_space(space: str, rows: Iterable[Mapping[str, Any]], content: Mapping[str, Any]) -> str:
    found = {(r["generator"], r["metric"]): r for r in rows if r["space"] == space}
    own = content.get("generator")
    # The configured generator first, the yardstick last.
    generators = sorted(
        dict.fromkeys(generator for generator, _ in found),
        key=lambda name: (name != own, name == TRAINING),
    )
    metrics = dict.fromkeys(metric for _, metric in found)
    head = ["generator", *(metric_name(str(metric)) for metric in metrics)]
    body = [
        [_generator(generator), *(_value(found.get((generator, m))) for m in metrics)]
        for generator in generators
    ]
    meaning = content.get("spaces", {}).get(space, "")
    name = space_name(space)
    title = f"<h3>{escaped(name[:1].upper() + name[1:])}</h3>"
    note = f'<p class="note">{escaped(meaning)}.</p>' if meaning else ""
    return title + note + data_table(head, body) + _meanings(metrics, content)


def _generator(name: str) -> str:
    """Return a generator by its name in the configuration, the yardstick by what it is."""
    return "training designs" if name == TRAINING else name


def _meanings(metrics: Iterable[str], content: Mapping[str, Any]) -> str:
    known = content.get("metrics", {})
    rows = [(metric_name(m), _meaning(known[m])) for m in metrics if m in known]
    return (
        f"<details><summary>How they are computed</summary>{facts(rows)}</details>" if rows else ""
    )


def _meaning(metric: Mapping[str, Any]) -> str:
    better = metric.get("better")
    words = [str(metric.get("description", ""))]
    words += [f"{better} is better"] if better in ("higher", "lower") else []
    interval = metric.get("interval")
    words += [f"in brackets: {interval}"] if interval and interval != "none" else []
    words += [f"source: {metric['source']}"] if metric.get("source") else []
    return escaped("; ".join(words))


def _value(row: Mapping[str, Any] | None) -> str:
    if row is None or row.get("value") is None:
        return "–"
    low, high = row.get("low"), row.get("high")
    interval = "" if low is None or high is None else f" [{_short(low)}, {_short(high)}]"
    return _short(row["value"]) + interval


def _short(value: float) -> str:
    """Return three significant digits, or so many whole ones as there are."""
    if not value or abs(value) < _NOTHING:
        return "0"
    return number(value, max(2 - math.floor(math.log10(abs(value))), 0))


def _of_dataset(study: Study) -> list[tuple[str, str]]:
    record = record_in(study.dataset)
    if record is None:
        return []
    found, setting = record.figures, record.configuration.get("dataset", {})
    counts: Mapping[str, Mapping[str, int]] = found.get("counts", {})
    kinds = {kind: sum(parts.values()) for kind, parts in counts.items()}
    sources: dict[str, int] = {}
    for parts in counts.values():
        for source, count in parts.items():
            sources[source] = sources.get(source, 0) + count
    return [
        ("training designs", _whole(found.get("size"))),
        ("of each category", counted(kinds)),
        ("where from", counted(sources)),
        ("sampling", escaped(str(found.get("sampling", "")).replace("_", " "))),
        ("valid at first draw", _acceptance(found)),
        ("seed of the data set", str(setting.get("seed", ""))),
    ]


def _acceptance(figures: Mapping[str, Any]) -> str:
    """Return the share of random designs that pass the rules, by category."""
    rates = {kind: parts.get("random") for kind, parts in figures.get("acceptance", {}).items()}
    return escaped(", ".join(f"{k} {_percent(v)}" for k, v in rates.items() if v is not None))


def _of_embedding(study: Study) -> list[tuple[str, str]]:
    record = record_in(study.embedding)
    if record is None:
        return []
    found, setting = record.figures, record.configuration.get("embedding", {})
    method = str(setting.get("method", ""))
    perplexity = f", perplexity {setting['perplexity']:g}" if method == "tsne" else ""
    names = {"tsne": "t-SNE", "pca": "principal components", "none": "none (full space)"}
    return [
        ("embedding", escaped(names.get(method, method) + perplexity)),
        ("trustworthiness", _decimal(found.get("trustworthiness"))),
        ("decoder: error of training designs", _decimal(found.get("round_trip_error"))),
        ("decoder: error of designs left out", _decimal(found.get("left_out_error"))),
        ("seed of the embedding", str(setting.get("seed", ""))),
    ]


def _of_generator(study: Study) -> list[tuple[str, str]]:
    record = record_in(study.generated)
    if record is None:
        return []
    found, setting = record.figures, record.configuration.get("generator", {})
    shares = {mode: _percent(share) for mode, share in found.get("mode_share", {}).items()}
    chosen = record_in(study.selection)
    return [
        ("generator", escaped(str(setting.get("method", "")))),
        ("generated designs", _whole(found.get("designs"))),
        ("share of each mode", escaped(", ".join(f"{m} {s}" for m, s in shares.items()))),
        ("proposed", _whole(found.get("proposed"))),
        ("refused", counted(found.get("refused", {}))),
        ("corrected by the limits", counted(found.get("corrections", {}))),
        ("chosen for simulation", counted(chosen.figures.get("modes", {})) if chosen else ""),
        ("seed of the generator", str(setting.get("seed", ""))),
    ]


def _of_novelty(study: Study) -> list[tuple[str, str]]:
    record = record_in(study.generated)
    found = record.figures if record else {}
    return [
        ("mean novelty, all parameters", _decimal(found.get("novelty_mean"))),
        ("mean novelty, plane", _decimal(found.get("novelty_plane_mean"), 4)),
    ]


def counted(counts: Mapping[str, int]) -> str:
    """Return what was counted, in words."""
    words = (f"{n:,} {_word(name, n)}" for name, n in counts.items() if n)
    return escaped(", ".join(words) or ("none" if counts else ""))


def _word(name: str, count: int) -> str:
    """Return what is counted, in the singular for one."""
    one, many = _WORDS.get(name, (name.replace("_", " "),) * 2)
    return one if count == 1 else many


def _whole(value: int | None) -> str:
    return "" if value is None else f"{value:,}"


def _decimal(value: float | None, digits: int = 3) -> str:
    return "" if value is None else number(value, digits)


def _percent(share: float) -> str:
    return f"{number(100.0 * share, 0)} %"
