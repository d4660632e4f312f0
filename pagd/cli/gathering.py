"""What the subcommands do that gather designs: tables, and a page of them."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from pagd.cli.answer import Answer
from pagd.errors import InputError
from pagd.record import RECORD_NAME

__all__ = ["report", "summary", "view"]

# Where the workflow puts designs, if the command is given in its folder.
_OF_WORKFLOW = Path("results/designs")


def summary(options: Namespace) -> Answer:
    """Write the tables of designs, of those that came as far as the metrics."""
    from pagd.summary import write_gathered, write_summary

    folders = options.design_folders
    there = [folder for folder in folders if (folder / "metrics" / RECORD_NAME).is_file()]
    measured = [folder / "metrics" for folder in there]
    novelty: dict[str, float] = {}
    if options.dataset:
        from pagd.stages.novelty import novelty_of

        novelty = novelty_of([folder / "geometry" for folder in there], options.dataset)
    performance, table = options.out / "performance.parquet", options.out / "summary.csv"
    write_summary(measured, performance, table, novelty)
    write_gathered(measured, options.out)
    print(f"{len(measured)} of {len(folders)} designs have a record of their metrics.")
    return Answer(0, {"folder": options.out, "designs": len(folders), "measured": len(measured)})


def report(options: Namespace) -> Answer:
    """Write the page of designs."""
    _check_results(options.design_folders)
    from pagd.figures.page import write_page

    write_page(options.design_folders, options.out)
    return Answer(0, {"file": options.out, "designs": len(options.design_folders)})


def view(options: Namespace) -> Answer:
    """Write the page of designs beside the first of them, and show it in the browser."""
    import webbrowser

    folders = options.design_folders or _designs_of_workflow()
    _check_results(folders)
    from pagd.figures.page import write_page

    first: Path = folders[0]
    page = options.out or first.resolve().with_name(f"{first.resolve().name}.html")
    if not options.design_folders and not options.out:
        page = _OF_WORKFLOW.resolve().with_suffix(".html")
    write_page(folders, page)
    print(page)
    if not options.no_browser and not webbrowser.open(page.resolve().as_uri()):
        print("pagd: no browser was found; open the page in one.", file=sys.stderr)
    return Answer(0, {"file": page, "designs": len(folders)})


def _designs_of_workflow() -> list[Path]:
    """The designs of a run of the workflow in this folder."""
    if not _OF_WORKFLOW.is_dir():
        return []
    return sorted(path for path in _OF_WORKFLOW.iterdir() if _has_results(path))


def _check_results(folders: Sequence[Path]) -> None:
    """Refuse folders of which there is nothing to show, and tell how to come by something."""
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"{folder}: there is no such folder.")
    # A design that has not been begun has its place on a page of others.
    if not any(_has_results(folder) for folder in folders):
        where = folders[0] if folders else _OF_WORKFLOW
        raise InputError(
            f"{where}: no results to show; `pagd run DESIGN.yaml --out FOLDER` makes some of a "
            "design, and `pagd view FOLDER` shows them."
        )


def _has_results(folder: Path) -> bool:
    return any(folder.glob(f"*/{RECORD_NAME}"))
