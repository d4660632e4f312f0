"""What the subcommands do that look after a run: how far it is, and whether it is sound."""

from __future__ import annotations

import shutil
from argparse import Namespace
from pathlib import Path

from pagd.catalogue import read_designs
from pagd.cli.answer import Answer
from pagd.cli.options import config_of
from pagd.errors import InputError, Status
from pagd.progress import Ended, Progress

__all__ = ["audit", "status"]

# What the workflow runs by, where the command is given in the same folder.
_OF_WORKFLOW = Path("config/config.yaml")
# Failed designs are named up to so many; --json has all.
_NAMED = 10


def status(options: Namespace) -> Answer:
    """Tell how far a run is."""
    from pagd.progress import progress_of

    results: Path = options.results
    if not results.is_dir():
        raise InputError(f"{results}: there is no such folder.")
    if options.config is None and _OF_WORKFLOW.is_file():
        options.config = str(_OF_WORKFLOW)
    found = progress_of(results, _asked_for(results, config_of(options)))
    if not options.json:
        _print_progress(found)
    return Answer(0, found.as_dict())


def _asked_for(results: Path, config: dict[str, object]) -> list[str]:
    """Names of the designs of the configuration's tables, and of the selected ones."""
    tables = dict(config["designs"])  # type: ignore[call-overload]
    selection = results / "selection" / "designs.csv"
    own = read_designs({k: v for k, v in tables.items() if Path(v).is_file()})
    selected = read_designs({"generated": str(selection)}) if selection.is_file() else {}
    return list(own | selected)


def _print_progress(found: Progress) -> None:
    share = f" ({100 * found.done / found.designs:.0f} %)" if found.designs else ""
    print(f"{found.done:,} of {found.designs:,} designs are done{share}{_counts(found.statuses)}")
    if found.at_work:
        print(f"At work: {_some(found.at_work)}.")
    if found.per_hour is not None and found.hours_left:
        print(f"{found.per_hour:.0f} an hour: {_duration(found.hours_left)} left.")
    for table, part in found.screened.items():
        told = f"{part.designs:,} {table} designs, {part.core_s:.2f} core-s each"
        print(f"By a chamber each: {told} in the mean.")
    if found.slowest:
        print("Slowest: " + ", ".join(f"{d.design_id} {d.seconds:.0f} s" for d in found.slowest))
    if found.failed:
        _print_failed(found.failed)
    if found.without_result:
        print("Begun, but without a result (a run goes on with them):")
        _print_some([f"{name}: {line}" for name, line in found.without_result.items()])


def _print_failed(failed: tuple[Ended, ...]) -> None:
    print("Failed:")
    _print_some([f"{one.design_id}: {one.status}: {one.reason}" for one in failed])


def _print_some(lines: list[str]) -> None:
    width = shutil.get_terminal_size((160, 24)).columns - 2
    for line in lines[:_NAMED]:
        print(f"  {line if len(line) <= width else line[: width - 1] + '…'}")
    if len(lines) > _NAMED:
        print(f"  … and {len(lines) - _NAMED} more: --json names all")


def _counts(statuses: dict[str, int]) -> str:
    told = ", ".join(f"{name} {count:,}" for name, count in statuses.items())
    return f": {told}." if told else "."


def _some(names: tuple[str, ...]) -> str:
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return ", ".join(names[:_NAMED]) + more


def _duration(hours: float) -> str:
    minutes = max(1, round(60 * hours))
    return f"{minutes // 60} h {minutes % 60:02d} min" if minutes >= 60 else f"{minutes} min"


def audit(options: Namespace) -> Answer:
    """Tell what is damaged in a run, and remove it where that is wanted; 1 if there is any."""
    from pagd.audit import abandoned, discard, findings, wanted_again

    results: Path = options.results
    again = {Status(name).value for name in options.again}
    found = list(findings(results, thorough=not options.quick))
    if again:
        found += wanted_again(results, again)
    for finding in found:
        print(f"{finding.folder}: {finding.why}")
    left = abandoned(results)
    document: dict[str, object] = {
        "findings": [{"folder": one.folder, "why": one.why} for one in found],
        "abandoned": left,
        "removed": [],
    }
    if not options.discard:
        print(f"{len(found)} folders to make again, {len(left)} left by killed processes.")
        return Answer(1 if found else 0, document)
    gone = discard(results, found)
    for path in left:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)
    print(f"{len(gone)} folders removed, and {len(left)} left by killed processes.")
    return Answer(0, document | {"removed": gone})
