"""Random designs through the whole chain: how they end, and what it takes.

    python benchmarks/random_designs.py [--designs 200] [--seed 1] [--size MM] [--processes 2]
        [--time-limit 1800] [--config JSON] [--out results/random_designs]
        [--error-designs 20] [--markdown FILE] [--page docs/performance.md] [--report-only]
        [--mixed]

Each design has a process of its own. Repeating the command runs only what is not finished yet by
stages of the same versions; designs of more than one commit are told in the report. To run all
anew, give another folder. Written to the folder: report.json, with a row a design, and report.md.
Meshers and elements are those of the configuration, and so is the mesh size unless --size gives
one for all meshers. --error-designs solves some designs with every edge of the mesh halved too,
for the error of their tips. --page writes the section of costs.
"""

from __future__ import annotations

import argparse
import json
import shlex
import sys
import time
from collections.abc import Mapping, Sequence
from datetime import timedelta
from pathlib import Path
from typing import Any

from performance.origin import origin_lines
from performance.page import must_have_section, write_section
from robustness.costs import COST_KEYS, as_section
from robustness.drawing import drawn_designs, mixed_designs
from robustness.errors import TipError, finer_study, tip_error
from robustness.machine import machine
from robustness.page import as_markdown
from robustness.processes import Ending, Task, run_tasks
from robustness.results import Result, result_of
from robustness.sizes import size_of, sized
from robustness.study import Study
from robustness.summary import summarize

from pagd import config as configuration
from pagd.errors import InputError
from pagd.files import write_text

#: Designs that are solved with every edge of the mesh halved too, with --page.
ERROR_DESIGNS = 20

_SECTION = "random"


def main() -> None:
    """Run what is not finished, print the report and write it."""
    parser = _parser()
    options = parser.parse_args()
    try:
        study = _study(options)
        must_have_section(options.page, _SECTION)
        finer = finer_study(study, _error_designs(options))
        if not options.report_only:
            for one in (study, finer):
                _run(one, options.processes, options.time_limit)
        _report(study, finer, options)
    except InputError as error:
        parser.error(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted; the same command goes on from here")


def _study(options: argparse.Namespace) -> Study:
    for name in ("designs", "size", "processes", "time_limit"):
        if getattr(options, name) is not None and not getattr(options, name) > 0:
            raise InputError(f"--{name.replace('_', '-')} must be greater than 0.")
    if options.error_designs is not None and options.error_designs < 0:
        raise InputError("--error-designs must be at least 0.")
    if options.seed < 0:
        raise InputError("--seed must be at least 0.")
    config = configuration.load(options.config)
    if options.size is not None:
        config = sized(config, options.size)
    draw = mixed_designs if options.mixed else drawn_designs
    return Study(options.out, draw(options.designs, options.seed, config), config)


def _error_designs(options: argparse.Namespace) -> int:
    """How many designs are solved with every edge of the mesh halved too."""
    if options.error_designs is None:
        return ERROR_DESIGNS if options.page else 0
    return int(options.error_designs)


def _run(study: Study, processes: int, limit_s: float) -> None:
    by_name = {named.name: named for named in study.designs}
    waiting = study.unfinished()
    progress = _Progress(len(study.designs), len(waiting))

    def ended(task: Task, ending: Ending) -> None:
        named = by_name[task.name]
        run = study.end(named, ending)
        progress.tell(result_of(named, study.folder(named), run))

    run_tasks((study.start(named) for named in waiting), processes, limit_s, ended)


class _Progress:
    """One line a design that has ended."""

    def __init__(self, designs: int, waiting: int) -> None:
        self._designs, self._waiting = designs, waiting
        self._start, self._ended = time.monotonic(), 0

    def tell(self, result: Result) -> None:
        """Say how a design ended, how long it took, and how long the others will."""
        self._ended += 1
        missing = self._waiting - self._ended
        left = missing * (time.monotonic() - self._start) / self._ended
        pressure = "" if result.pressure_kPa is None else f"{result.pressure_kPa:.4g} kPa"
        print(
            f"{self._designs - missing:4d}/{self._designs} {result.design_id} {result.mode:<8} "
            f"{result.status:<13} {pressure:>9} {result.newton_iterations:4d} iterations "
            f"{result.seconds:7.1f} s, left {timedelta(seconds=round(left))}",
            flush=True,
        )


def _report(study: Study, finer: Study, options: argparse.Namespace) -> None:
    runs = [(named, study.run_of(named)) for named in study.designs]
    results = [result_of(named, study.folder(named), run) for named, run in runs if run]
    if not results:
        raise InputError(f"{study.out}: none of the {len(runs)} designs is done.")
    folders = [study.folder(named) for named, run in runs if run]
    report = {
        "study": {
            "designs": options.designs,
            "seed": options.seed,
            "size_mm": size_of(study.config),
            "time_limit_s": options.time_limit,
            "config": study.config,
        },
        "command": _command(options),
        "machine": machine(folders, options.processes),
        "summary": summarize(results, len(runs)),
        "tip_errors": [error.as_dict() for error in _tip_errors(study, finer)],
        "results": [result.as_dict() for result in results],
    }
    page = as_markdown(report)
    text = json.dumps(report, indent=1, ensure_ascii=False, allow_nan=False)
    write_text(study.out / "report.json", text + "\n")
    for file in filter(None, (study.out / "report.md", options.markdown)):
        write_text(file, page)
    print(page, end="")
    if options.page:
        write_section(options.page, _SECTION, _section(report, results, options))


def _tip_errors(study: Study, finer: Study) -> list[TipError]:
    found = (
        tip_error(named, study.folder(named), finer.folder(named))
        for named in finer.designs
        if study.run_of(named) and finer.run_of(named)
    )
    return [error for error in found if error]


def _section(
    report: Mapping[str, Any], results: Sequence[Result], options: argparse.Namespace
) -> str:
    costs = [{key: getattr(one, key) for key in COST_KEYS} for one in results]
    command = _command(options).replace(" \\\n  ", " ")
    first = origin_lines(command, commits=report["summary"]["commits"])
    return f"{first}\n\n{as_section(report, costs)}"


#: Options that change what is on the page, or where it is written to.
_REPEATED = (
    *("designs", "seed", "mixed", "size", "time_limit", "config"),
    *("error_designs", "markdown", "page"),
)


def _command(options: argparse.Namespace) -> str:
    """The command that prints the same again: with every option that is not as by default."""
    usual = _parser().parse_args([])
    lines = ["python benchmarks/random_designs.py"]
    for name in _REPEATED:
        value = getattr(options, name)
        if value is True:
            lines.append(f"--{name}")
        elif value != getattr(usual, name):
            text = f"{value:.12g}" if isinstance(value, float) else str(value)
            lines.append(f"--{name.replace('_', '-')} {shlex.quote(text)}")
    return " \\\n  ".join(lines)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--designs", type=int, default=200, help="how many (default: %(default)s)")
    add("--seed", type=int, default=1, help="of the drawing (default: %(default)s)")
    add("--mixed", action="store_true", help="draw rows of slanted and straight chambers")
    add("--size", type=float, help="mesh size in mm (default: those of the configuration)")
    add("--processes", type=int, default=2, help="designs at a time (default: %(default)s)")
    add(
        "--time-limit",
        type=float,
        default=1800.0,
        metavar="SECONDS",
        help="a design that takes longer is ended and counts as failed (default: %(default)g)",
    )
    add("--config", help="file or JSON text; --size takes the place of its sizes")
    add(
        "--out",
        type=Path,
        default=Path("results/random_designs"),
        help="folder (default: %(default)s)",
    )
    add(
        "--error-designs",
        type=int,
        metavar="N",
        help="solve so many designs with every edge of the mesh halved too "
        f"(default: {ERROR_DESIGNS} with --page, else none)",
    )
    add("--markdown", type=Path, help="file that the report is written to as well")
    add("--page", type=Path, help=f"page whose section '{_SECTION}' is replaced")
    add("--report-only", action="store_true", help="run nothing; report what there is")
    return parser


if __name__ == "__main__":
    main()
