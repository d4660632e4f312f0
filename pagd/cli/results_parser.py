"""The arguments of the subcommands of results: pages, tables, runs looked after, data sets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pagd.cli.arguments import add_command, add_config, add_out, add_verbose
from pagd.errors import Status

__all__ = ["add_results"]


def add_results(commands: Any) -> None:
    """Add the subcommands that work on what a run has left."""
    _add_gathering(commands)
    _add_keeping(commands)
    _add_archiving(commands)


def _add_gathering(commands: Any) -> None:
    summary = add_command(
        commands, "summary", "gathering:summary", "tables of designs: one row a design"
    )
    report = add_command(
        commands, "report", "gathering:report", "page of designs, as an HTML file for any browser"
    )
    view = add_command(
        commands, "view", "gathering:view", "page of designs, opened in the browser at once"
    )
    for command in (summary, report, view):
        command.add_argument(
            "design_folders",
            type=Path,
            nargs="*" if command is view else "+",
            metavar="FOLDER",
            help="folder with a design's stage folders"
            + (" (default: all of results/designs)" if command is view else ""),
        )
        add_verbose(command)
    summary.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder of the tables"
    )
    report.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help="HTML file to write"
    )
    view.add_argument(
        "--out", type=Path, metavar="FILE", help="HTML file to write (default: beside the folder)"
    )
    view.add_argument("--no-browser", action="store_true", help="write the page, and show nothing")
    summary.add_argument(
        "--dataset",
        type=Path,
        metavar="DIR",
        help="folder of stage dataset: also tell how far each design is from the nearest in it",
    )


def _add_keeping(commands: Any) -> None:
    status = add_command(
        commands, "status", "keeping:status", "how far a run is: counts, rate, what failed"
    )
    audit = add_command(
        commands, "audit", "keeping:audit", "whether the files of a run are still what they were"
    )
    for command in (status, audit):
        command.add_argument(
            "results",
            type=Path,
            nargs="?",
            default=Path("results"),
            metavar="FOLDER",
            help="folder of the run (default: %(default)s)",
        )
        add_verbose(command)
    add_config(status)
    audit.add_argument("--quick", action="store_true", help="compare the sizes of files alone")
    audit.add_argument(
        "--discard",
        action="store_true",
        help="remove what is damaged, with what was made of it: the next run makes it again",
    )
    audit.add_argument(
        "--again",
        nargs="+",
        choices=[one.value for one in Status],
        default=[],
        metavar="STATUS",
        help="treat designs that ended so as damaged: crashed, timed_out, …",
    )


def _add_archiving(commands: Any) -> None:
    archive = add_command(
        commands, "archive", "archiving:archive", "write a public data set of what a run has left"
    )
    archive.add_argument("results", type=Path, metavar="FOLDER", help="folder of the run")
    archive.add_argument(
        "--more",
        type=Path,
        nargs="+",
        default=[],
        metavar="DIR",
        help="folders of designs that were simulated elsewhere",
    )
    archive.add_argument("--date", metavar="DATE", help="of publication (default: today)")
    archive.add_argument(
        "--pictures", type=int, default=12, metavar="N", help="simulated designs to draw (12)"
    )
    archive.add_argument(
        "--zip", type=Path, metavar="FILE", help="write all of it to a ZIP file as well"
    )
    add_out(archive)
    check = add_command(
        commands,
        "check-archive",
        "archiving:check_archive",
        "whether a public data set is sound",
    )
    check.add_argument(
        "archive", type=Path, metavar="FOLDER", help="folder of the data set, or its ZIP file"
    )
    for command in (archive, check):
        add_verbose(command)
