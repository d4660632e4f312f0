"""Compute every row of the verification: ``python tests/verification --help``."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from catalogue import CASES, find
from report import write_data, write_page
from running import Outcome, run


def main(arguments: list[str] | None = None) -> int:
    """Print the rows as they come, write what is asked for; 1 if a row does not pass."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.list:
        print("\n".join(f"{case.name:24} {case.group}" for case in CASES))
        return 0
    if options.page and options.only:
        parser.error("a page has all cases: --page and --only do not go together")
    try:
        cases = find(options.only)
    except ValueError as error:
        parser.error(str(error))
    start = time.perf_counter()
    found: dict[str, Outcome] = {}
    for outcome in run(cases, options.processes):
        found[outcome.case] = outcome
        _print(outcome, len(found), len(cases))
    outcomes, seconds = [found[case.name] for case in cases], time.perf_counter() - start
    if options.out:
        write_data(outcomes, options.processes, seconds, options.out / "verification.json")
    if options.page:
        write_page(outcomes, options.processes, seconds, options.page)
    return _conclusion(outcomes, seconds)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("python tests/verification", description=__doc__)
    parser.add_argument("--only", metavar="CASE", action="append", default=[])
    parser.add_argument("--list", action="store_true", help="name the cases")
    parser.add_argument("--processes", type=int, default=1, help="cases at a time")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="for verification.json")
    parser.add_argument("--page", type=Path, metavar="FILE", help="the page, in Markdown")
    return parser


def _print(outcome: Outcome, done: int, cases: int) -> None:
    print(f"[{done}/{cases}] {outcome.case}, {outcome.seconds:.1f} s", flush=True)
    if outcome.missing:
        print(f"  left out: the program {outcome.missing} is not there", flush=True)
    if outcome.fault:
        print(f"  BROKEN OFF: {outcome.fault}", flush=True)
    for figure in outcome.figures:
        print("  passes" if figure.passes else "  FAILS ", figure, flush=True)


def _conclusion(outcomes: list[Outcome], seconds: float) -> int:
    """Print how many rows pass; the exit code."""
    figures = [figure for outcome in outcomes for figure in outcome.figures]
    passing = sum(figure.passes for figure in figures)
    left_out = sum(bool(outcome.missing) for outcome in outcomes)
    broken = sum(bool(outcome.fault) for outcome in outcomes)
    print(
        f"{passing} of {len(figures)} rows pass; {left_out} cases left out, {broken} broken off; "
        f"{seconds / 60:.1f} min"
    )
    return int(not all(outcome.passes for outcome in outcomes))


if __name__ == "__main__":
    sys.exit(main())
