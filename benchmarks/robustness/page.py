"""The report of a study as a Markdown page; lines of text of a hundred characters at most."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final

from robustness.drawing import THIN_MM
from robustness.results import PHYSICAL_STOPS
from robustness.summary import GOAL, PENETRATION_LIMIT

__all__ = ["as_markdown"]

_WIDTH = 100

#: Rows of the table of figures: heading, key of the summary's spreads, format of a value.
_FIGURES: Final = (
    ("Newton iterations, free", "newton_iterations_free", ".0f"),
    ("Newton iterations, blocked", "newton_iterations_blocked", ".0f"),
    ("rejected steps, free", "rejected_steps_free", ".0f"),
    ("rejected steps, blocked", "rejected_steps_blocked", ".0f"),
    ("time of the free actuation, s", "free_s", ".1f"),
    ("time of the blocked force, s", "blocked_s", ".1f"),
    ("free actuation, core-s", "free_cpu_s", ".1f"),
    ("blocked force, core-s", "blocked_cpu_s", ".1f"),
    ("everything outside of both, core-s", "outside_cpu_s", ".1f"),
    ("time of the whole chain, s", "chain_s", ".1f"),
    ("processor time of the stages, s", "chain_cpu_s", ".1f"),
    ("unknowns", "unknowns", ",.0f"),
    ("memory, MB", "peak_memory_MB", ",.0f"),
    ("penetration, free, % of the gap", "penetration_share", ".2%"),
    ("penetration, blocked, % of the gap", "blocked_penetration_share", ".2%"),
    ("energy balance, %", "energy_balance", ".3%"),
)


def as_markdown(report: Mapping[str, Any]) -> str:
    """Return the page of a report, as ``random_designs.py`` writes it to JSON."""
    summary = report["summary"]
    parts = [
        "# Random designs through the whole chain",
        *_introduction(report),
        "## How the designs end",
        *_endings(summary),
        "## What it takes",
        *_costs(summary),
        "## Contact and limit points",
        *_events(summary),
        "## Free actuation that did not go all the way",
        *_cases(summary["others"], "None: every design went all the way in free actuation."),
    ]
    if summary["spreads"]["newton_iterations_blocked"]:
        nothing = "None of those that were begun."
        parts += ["## Blocked force that did not go all the way"]
        parts += _cases(summary["blocked_others"], nothing)
    parts += ["## Machine", *_machine(report["machine"], summary)]
    return "\n\n".join(parts) + "\n"


def _introduction(report: Mapping[str, Any]) -> list[str]:
    study, designs = report["study"], report["summary"]["designs"]
    text = (
        f"{designs['asked']} designs drawn at random from the sampling box, half of them bending "
        "and half twisting, all within the rules of the geometry (the designs of the data set are "
        "drawn by the same functions). Each goes through geometry, repair, mesh, solve and "
        f"metrics in a process and on a core of its own, with a mesh size of {study['size_mm']:g} "
        f"mm; after {study['time_limit_s']:g} s it is ended. This page is what the command prints:"
    )
    parts = [_wrapped(text), "```sh\n" + report["command"] + "\n```"]
    if designs["done"] < designs["asked"]:
        parts.append(f"**{designs['done']} of {designs['asked']} designs are done so far.**")
    return parts + _mixture(report["summary"]["commits"])


def _mixture(commits: Mapping[str, int]) -> list[str]:
    """Say so where the study went on after the repository had changed."""
    if len(commits) < 2:
        return []
    text = (
        f"**Designs of more than one commit: {_counts(commits)}.** All are of the same versions of "
        "the stages, but the figures below are of no single state of the program."
    )
    return [_wrapped(text)]


def _counts(commits: Mapping[str, int]) -> str:
    return ", ".join(f"{commit} ({count})" for commit, count in commits.items())


def _endings(summary: Mapping[str, Any]) -> list[str]:
    groups = summary["groups"]
    stops = ", ".join(f"`{stop}`" for stop in PHYSICAL_STOPS)
    whole = groups["all"]
    text = (
        f"**{whole['reached']} of {whole['valid']} valid designs ({_share(whole)}) reached the "
        f"last pressure or a physical stop** ({stops}) in free actuation; the goal is "
        f"{_percent(GOAL, 0)}. {_blocked(whole)}Thin-walled are those with t or t_ab below "
        f"{THIN_MM:g} mm."
    )
    rows = [
        ("designs", _of_groups(groups, lambda g: str(g["designs"]))),
        ("last pressure or physical stop, free", _of_groups(groups, _share)),
        *_blocked_rows(groups),
        *_status_rows(groups, "statuses", "final status"),
        *_status_rows(groups, "blocked_statuses", "blocked force"),
    ]
    return [_wrapped(text), _table(["", *groups], [[name, *cells] for name, cells in rows])]


def _of_groups(groups: Mapping[str, Any], cell: Callable[[Any], str]) -> list[str]:
    return [cell(group) for group in groups.values()]


def _share(group: Mapping[str, Any], key: str = "share") -> str:
    return "–" if group[key] is None else _percent(group[key])


def _blocked(whole: Mapping[str, Any]) -> str:
    if whole["blocked_share"] is None:
        return ""
    count = f"{whole['blocked_reached']} of {whole['valid']} ({_share(whole, 'blocked_share')})"
    return f"The analysis of the blocked force did so for **{count}**. "


def _blocked_rows(groups: Mapping[str, Any]) -> Iterable[tuple[str, list[str]]]:
    if groups["all"]["blocked_share"] is not None:
        cells = _of_groups(groups, lambda group: _share(group, "blocked_share"))
        yield "last pressure or physical stop, blocked", cells


def _status_rows(
    groups: Mapping[str, Any], key: str, heading: str
) -> Iterable[tuple[str, list[str]]]:
    for status in groups["all"][key]:
        cells = [str(group[key].get(status, 0)) for group in groups.values()]
        yield f"{heading} `{status}`", cells


def _costs(summary: Mapping[str, Any]) -> list[str]:
    rows = [
        [heading, *(_value(spread[key], form) for key in ("median", "p90", "max"))]
        for heading, name, form in _FIGURES
        if (spread := summary["spreads"][name])
    ]
    stages = [
        [stage, *(f"{one[key]:.1f}" for key in ("median", "p90", "max")), _percent(one["share"])]
        for stage, one in summary["stages"].items()
    ]
    slowest = [_slow_row(design) for design in summary["slowest"]]
    spread = ["median", "90th percentile", "largest"]
    return [
        _table(["per design", *spread], rows),
        _table(["time by stage, s", *spread, "share of all"], stages),
        "The slowest:",
        _table(["design", "mode", "status", "s", "Newton iterations", "unknowns"], slowest),
    ]


def _slow_row(design: Mapping[str, Any]) -> list[str]:
    names = [design[key] for key in ("design_id", "mode", "status")]
    size = "–" if design["unknowns"] is None else f"{design['unknowns']:,}"
    return [*names, f"{design['seconds']:.0f}", str(design["newton_iterations"]), size]


def _percent(share: float, digits: int = 1) -> str:
    return f"{100 * share:.{digits}f} %"


def _value(value: float, form: str) -> str:
    # The heading names the unit.
    return format(value, form).removesuffix("%")


def _events(summary: Mapping[str, Any]) -> list[str]:
    contact, limits = summary["contact"], summary["limit_points"]
    shares = ("penetration_share", "blocked_penetration_share")
    deepest = [spread["max"] for key in shares if (spread := summary["spreads"][key])]
    sentences = []
    if contact["known"]:
        sentences.append(f"Walls touch in {contact['touched']} of {contact['known']} designs.")
    if deepest:
        sentences.append(
            f"The deepest penetration is {_percent(max(deepest), 2)} of the gap; "
            f"designs that exceed {_percent(PENETRATION_LIMIT, 0)}: {contact['over_limit']}."
        )
    if limits["known"]:
        sentences.append(
            f"The pressure passes a maximum in {limits['designs']} of {limits['known']} designs, "
            f"{limits['limit_points']} times in all."
        )
    return [_wrapped(" ".join(sentences) or "The records do not tell.")]


def _cases(cases: Sequence[Mapping[str, Any]], nothing: str) -> list[str]:
    return ["\n".join(_case(case) for case in cases)] if cases else [nothing]


def _case(case: Mapping[str, Any]) -> str:
    thin = ", thin-walled" if case["thin_walled"] else ""
    pressure = case["pressure_kPa"]
    reached = "" if pressure is None else f" at {pressure:.4g} kPa"
    text = f"{case['design_id']} ({case['mode']}{thin}): `{case['status']}`{reached}."
    return _wrapped(f"- {text} {case['cause'] or ''}".rstrip(), "  ")


def _machine(machine: Mapping[str, Any], summary: Mapping[str, Any]) -> list[str]:
    versions = ", ".join(f"{name} {version}" for name, version in machine["versions"].items())
    return [
        _wrapped(
            f"{machine['processor']}, {machine['cores']} cores, {machine['memory_GB']:.0f} GB, "
            f"{machine['system']}. {machine['processes']} designs at a time. {versions}. "
            f"Commit (designs): {_counts(summary['commits'])}."
        )
    ]


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [headings, ["---"] + ["---:"] * (len(headings) - 1), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _wrapped(text: str, indent: str = "") -> str:
    return textwrap.fill(
        text, _WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
