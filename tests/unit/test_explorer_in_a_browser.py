"""The explorer of the page as people use it: in Chromium, without a network."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from figure_samples import path_only, solved
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright

from pagd.figures.page import Study, write_page
from pagd.tables import PERFORMANCE, write_rows

CHROMIUM = shutil.which("chromium")

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="needs: chromium")

#: Graphics without a graphics card.
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
FLAGS += ["--enable-unsafe-swiftshader"]
#: An advice to Plotly, about the speed of its shapes.
SAID_BY_PLOTLY = "Canvas2D: Multiple readback operations"


@pytest.fixture(scope="module")
def page_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Twelve designs: one with a shape, one with a path, ten of a table alone."""
    root = tmp_path_factory.mktemp("explored")
    folders = [
        solved(root / "d0", mode="mixed", origin="generated"),
        path_only(root / "d1", mode="twisting", origin="published"),
    ]
    rows = [
        {"design_id": f"d{i}", "origin": "generated", "status": "ok" if i % 4 else "buckled"}
        | {"mode": ("mixed", "twisting", "bending")[i % 3], "reason": None if i % 4 else "<why>"}
        | {"bending_deg": 10.0 * i, "twist_deg": 50.0 - i, "novelty": 0.1 * ((7 * i) % 12)}
        for i in range(12)
    ]
    write_rows(root / "performance.parquet", PERFORMANCE, rows)
    write_page(folders, root / "index.html", study=Study(performance=root / "performance.parquet"))
    return root / "index.html"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A Chromium that is the system's own."""
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield found
        found.close()


@pytest.fixture(params=["light", "dark", "phone"])
def page(browser: Browser, page_file: Path, request: pytest.FixtureRequest) -> Iterator[Page]:
    """The page, opened from the disk; what it says in the console is an error."""
    phone = request.param == "phone"
    context = browser.new_context(
        viewport={"width": 390, "height": 844} if phone else {"width": 1280, "height": 1000},
        color_scheme="dark" if request.param == "dark" else "light",
        offline=True,
    )
    found = context.new_page()
    said: list[str] = []
    found.on("console", lambda message: said.append(message.text))
    found.on("pageerror", lambda error: said.append(str(error)))
    found.goto(page_file.as_uri())
    yield found
    context.close()
    assert [text for text in said if not text.startswith(SAID_BY_PLOTLY)] == []


def names(page: Page) -> list[str]:
    """The designs of the rows that are shown, in their order."""
    return page.locator("#explorer-table tbody tr td:first-child").all_inner_texts()


def points(page: Page) -> list[str]:
    """The designs of the points that are drawn."""
    script = """() => document.getElementById("plot-explorer").data
      .flatMap((trace) => trace.customdata.map((row) => content.explorer.rows[row][0])).sort()"""
    found: list[str] = page.evaluate(script)
    return found


def brush(page: Page, left: float, top: float, right: float, bottom: float) -> None:
    """Draw a box over the plot, in shares of its width and height."""
    area = page.locator("#plot-explorer .nsewdrag")
    area.scroll_into_view_if_needed()
    box: Any = area.bounding_box()
    x, y, width, height = (box[key] for key in ("x", "y", "width", "height"))
    page.mouse.move(x + left * width, y + top * height)
    page.mouse.down()
    page.mouse.move(x + right * width, y + bottom * height, steps=4)
    page.mouse.up()


def heading(page: Page, title: str) -> Locator:
    """The heading of a column, with its buttons."""
    return page.locator("#explorer .dt-scroll-head td", has_text=title).first


def count(page: Page) -> str:
    """What is told of how many there are."""
    return page.locator("#explorer-count").inner_text()


def test_all_designs_are_there(page: Page) -> None:
    assert count(page) == "12 of 12 designs"
    assert names(page) == [f"d{i}" for i in range(10)]
    assert points(page) == sorted(f"d{i}" for i in range(12))
    assert page.locator("#explorer-table tbody a").all_inner_texts() == ["d0", "d1"]
    # What a table holds is text, and no markup.
    assert page.evaluate("content.explorer.rows[0].includes('<why>')")
    assert page.locator("why").count() == 0


def test_a_click_on_a_heading_sorts(page: Page) -> None:
    order = heading(page, "novelty").locator(".dtcc-button_order")
    rows = page.locator("#explorer-table tbody tr td:first-child")
    by_novelty = sorted(range(12), key=lambda i: (7 * i) % 12)
    order.click()  # numbers from the largest on
    expect(rows).to_have_text([f"d{i}" for i in by_novelty[::-1][:10]])
    order.click()
    expect(rows).to_have_text([f"d{i}" for i in by_novelty[:10]])


def test_what_is_found_is_what_is_drawn(page: Page) -> None:
    page.locator(".dt-search input").fill("buckled")
    expect(page.locator("#explorer-count")).to_have_text("3 of 12 designs")
    assert names(page) == ["d0", "d4", "d8"]
    assert points(page) == ["d0", "d4", "d8"]


def test_a_column_filters_by_its_own_numbers(page: Page) -> None:
    heading(page, "bending").locator(".dtcc-button_dropdown").click()
    page.locator(".dtcc-dropdown select").select_option("greater")
    page.locator(".dtcc-dropdown input").fill("85")
    expect(page.locator("#explorer-count")).to_have_text("3 of 12 designs")
    assert points(page) == ["d10", "d11", "d9"]


def test_brushing_selects_rows_and_brings_them_first(page: Page) -> None:
    # Bending grows with the number of a design: the right third of the plot.
    brush(page, 0.7, 0.02, 0.98, 0.98)
    expect(page.locator("#explorer-count")).to_contain_text("selected")
    chosen = names(page)[: int(count(page).split(", ")[1].split()[0])]
    assert 2 <= len(chosen) <= 5
    assert chosen == [f"d{i}" for i in range(12 - len(chosen), 12)]
    assert page.locator("#explorer-table tbody tr.selected").count() == len(chosen)
    page.locator("#explorer-clear").click()
    assert count(page) == "12 of 12 designs"
    assert names(page)[0] == "d0"


def test_a_row_marks_its_point(page: Page) -> None:
    page.locator("#explorer-table tbody tr", has_text="d5").locator("td").nth(1).click()
    page.wait_for_function("document.querySelector('#explorer-count').textContent.includes('1 s')")
    script = """() => document.getElementById("plot-explorer").data.flatMap((trace) =>
      (trace.selectedpoints || []).map((i) => content.explorer.rows[trace.customdata[i]][0]))"""
    assert page.evaluate(script) == ["d5"]


def test_any_figure_is_drawn_against_any_other(page: Page) -> None:
    page.locator("#explorer-x").select_option("novelty")
    page.locator("#explorer-y").select_option("bending_deg")
    script = """() => { const plot = document.getElementById("plot-explorer");
      return [plot.layout.xaxis.title.text, plot.layout.yaxis.title.text,
              Math.max(...plot.data.flatMap((trace) => trace.y))]; }"""
    assert page.evaluate(script) == ["novelty", "bending, °", 110.0]


def test_a_click_on_a_design_opens_it(page: Page) -> None:
    page.locator("#explorer-table tbody a", has_text="d0").click()
    card = page.locator("#design-d0")
    assert card.get_attribute("open") is not None
    card.locator(".shape canvas").first.wait_for()
