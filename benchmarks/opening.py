"""How long the page of many designs takes until a browser has loaded it.

    python benchmarks/opening.py results [--designs 1000] [--page docs/report.md]

The simulated designs of a run are repeated, by links, until there are enough; all else of the page
is that of the run, without and with the designs that it has analysed by a chamber each. Chromium
opens it from the disk, without a network and without a graphics card, --times times. The page with
one of the designs is the peer: what is the same for all takes as long.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

sys.path.insert(0, str(Path(__file__).parent))

from performance.page import must_have_section, publish, table

from pagd.errors import InputError
from pagd.figures.load import has_trajectory
from pagd.figures.page import Study, write_page
from pagd.tables import read_rows

_SECTION = "opening"
_FLAGS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader")
_FLAGS += ("--enable-unsafe-swiftshader",)
#: What a run has for the page beside single designs, as in workflow/rules/common.smk.
_PLACES = {
    "dataset": "dataset",
    "embedding": "embedding",
    "generated": "generated",
    "selection": "selection",
    "diversity": "summary/diversity.json",
    "comparison": "diversity",
    "pictures": "figures/generative",
    "simulated": "figures/simulated",
    "fronts": "summary/fronts.json",
    "screening_pictures": "figures/screening",
}
_SCREENED = {"screened": "screening/generated", "screened_training": "screening/training"}
_LOADED_MS = "performance.timing.loadEventEnd - performance.timing.navigationStart"


def repeated(results: Path, count: int, folder: Path) -> list[Path]:
    """Return so many folders of designs: links to those of a run that have a trajectory."""
    there = [one for one in sorted((results / "designs").glob("*")) if has_trajectory(one)]
    if not there:
        raise InputError(f"{results}: holds no simulated design.")
    links = [folder / f"d{i:04d}" for i in range(count)]
    for i, link in enumerate(links):
        link.symlink_to(there[i % len(there)].resolve(), target_is_directory=True)
    return links


def written(designs: Sequence[Path], page: Path, results: Path, *, screened: bool) -> float:
    """Write the page, without its cards, which are read when they are opened; its size in MB."""
    places = _PLACES | (_SCREENED if screened else {})
    study = Study(**{name: results / place for name, place in places.items()})
    cards = page.parent / "cards"
    write_page(designs, page, results / "figures" / "together", study, cards=cards)
    return page.stat().st_size / 1e6


def opened_s(page: Path, times: int) -> list[float]:
    """Return the seconds that each of some loads took, in a browser that has been started."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=list(_FLAGS)
        )
        found = []
        for _ in range(times):
            context = browser.new_context(offline=True, viewport={"width": 1280, "height": 1000})
            tab = context.new_page()
            tab.goto(page.as_uri(), wait_until="load")
            found.append(float(tab.evaluate(_LOADED_MS)) / 1000.0)
            context.close()
        browser.close()
    return found


def by_a_chamber(results: Path) -> int:
    """Return how many designs of a run were analysed by a chamber each."""
    tables = (results / place / "performance.parquet" for place in _SCREENED.values())
    return sum(len(read_rows(table)) for table in tables if table.is_file())


def measured(results: Path, count: int, times: int) -> str:
    """Return a table: designs, size of the page, seconds until it is loaded."""
    rows, cells = [], by_a_chamber(results)
    for designs, screened in [(1, False), (count, False), *([(count, True)] if cells else [])]:
        with tempfile.TemporaryDirectory(prefix="pagd-") as name:
            folder = Path(name)
            page = folder / "index.html"
            links = repeated(results, designs, folder)
            size = written(links, page, results, screened=screened)
            seconds = np.array(opened_s(page, times))
        told = [f"{np.median(seconds):.2f}", f"{seconds.min():.2f}", f"{seconds.max():.2f}"]
        rows.append([f"{designs:,}", f"{cells if screened else 0:,}", f"{size:.1f}", *told])
    headings = ["designs", "by a chamber", "page, MB", "loaded after s, median", "least", "most"]
    return table(headings, rows)


def main() -> int:
    """Print the table, or write it to a page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--designs", type=int, default=1000)
    parser.add_argument("--times", type=int, default=5)
    parser.add_argument("--page", type=Path)
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        text = measured(options.results, options.designs, options.times)
    except (InputError, OSError) as error:
        parser.error(str(error))
    command = f"python benchmarks/opening.py {options.results}"
    command += "".join(
        f" --{key} {getattr(options, key)}"
        for key in ("designs", "times")
        if getattr(options, key) != parser.get_default(key)
    )
    command += f" --page {options.page}" if options.page else ""
    publish(options.page, _SECTION, f"`{command}`\n\n{text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
