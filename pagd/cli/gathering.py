"""What the subcommands do that gather designs: tables, and a page of them."""

from __future__ import annotations

import logging
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from pagd.cli.answer import Answer
from pagd.errors import InputError
from pagd.long_work import counted
from pagd.record import RECORD_NAME

__all__ = ["report", "summary", "view"]

# Where the workflow puts designs, if the command is given in its folder.
_OF_WORKFLOW = Path("results/designs")

log = logging.getLogger(__name__)


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
    """Write the page of designs, and their cards beside it."""
    count = _write_page(options.design_folders, options.out)
    return Answer(0, {"file": options.out, "designs": count})


def view(options: Namespace) -> Answer:
    """Write the page of designs beside the first of them, and show it in the browser."""
    import webbrowser

    folders = options.design_folders or _designs_of_workflow()
    first = options.design_folders[0] if options.design_folders else _OF_WORKFLOW
    page = options.out or first.resolve().with_name(f"{first.resolve().name}.html")
    count = _write_page(folders, page)
    print(page)
    if not options.no_browser and not webbrowser.open(page.resolve().as_uri()):
        print("pagd: no browser was found; open the page in one.", file=sys.stderr)
    return Answer(0, {"file": page, "designs": count})


def _write_page(folders: Sequence[Path], page: Path) -> int:
    """Write the page of the designs that have results, and their cards; how many they are."""
    found = _with_results(folders)
    from pagd.figures.groups import refuse_equal_names
    from pagd.figures.page import cards_beside, write_page

    whole = [folder.resolve() for folder in found]  # "." has no name
    refuse_equal_names(found, [folder.name for folder in whole])
    cards = cards_beside(page)
    shown = _with_cards(whole, cards)
    write_page(shown, page, cards=cards)
    return len(shown)


def _with_cards(folders: Sequence[Path], cards: Path) -> list[Path]:
    """Export the designs, but for those that are as they were; those that have a card then."""
    from pagd.config import load
    from pagd.figures.page.cards import CARD_NAME
    from pagd.stages import export as stage

    config, shown, reasons = load(None), [], []
    for folder in counted(folders, "cards", len(folders), "designs"):
        out = cards / folder.name
        record = stage.kept(folder, out, config) or stage.run(folder, out, config)
        reason = record.figures["left_out"].get(CARD_NAME)
        if reason is None:
            shown.append(folder)
        else:
            log.warning("%s is not on the page: %s", folder, reason)
            reasons.append(reason)
    if not shown:
        raise InputError(reasons[0])
    return shown


def _designs_of_workflow() -> list[Path]:
    """The designs of a run of the workflow in this folder."""
    if not _OF_WORKFLOW.is_dir():
        return []
    return sorted(path for path in _OF_WORKFLOW.iterdir() if path.is_dir() and path.name[0] != ".")


def _with_results(folders: Sequence[Path]) -> list[Path]:
    """The folders that there is something to show of; how to come by some, if none has."""
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"{folder}: there is no such folder.")
    from pagd.figures.load import load_records

    found, errors = [], []
    for folder in folders:
        try:
            found += [folder] if load_records(folder) else []
        except InputError as error:
            log.warning("%s is not on the page: %s", folder, error)
            errors.append(error)
    if not found and errors:
        raise errors[0]
    if not found:
        where = folders[0] if folders else _OF_WORKFLOW
        raise InputError(
            f"{where}: no results to show; `pagd run DESIGN.yaml --out FOLDER` makes some of a "
            "design, and `pagd view FOLDER` shows them."
        )
    if len(found) < len(folders):
        # As in a run under way: designs that have been begun, but have no stage yet.
        log.info("%d of %d designs have results", len(found), len(folders))
    return found
