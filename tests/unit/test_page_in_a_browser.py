"""The page as people use it: in Chromium, without a network."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from figure_samples import path_only, solved
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright

from pagd.figures.page import Study, write_page
from pagd.figures.page.cards import write_card
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
    """Twelve designs: two with a shape, three with a path alone, seven of a table alone."""
    root = tmp_path_factory.mktemp("explored")
    folders = [
        solved(root / "d0", mode="mixed", origin="generated"),
        path_only(root / "d1", mode="twisting", origin="published"),
        solved(root / "d2", mode="bending", origin="generated"),
        *(path_only(root / f"d{i}", mode="twisting", origin="generated") for i in (3, 4)),
    ]
    rows = [
        {"design_id": f"d{i}", "origin": "generated", "status": "ok" if i % 4 else "buckled"}
        | {"mode": ("mixed", "twisting", "bending")[i % 3], "reason": None if i % 4 else "<why>"}
        | {"bending_deg": 10.0 * i, "twist_deg": 50.0 - i, "novelty": 0.1 * ((7 * i) % 12)}
        for i in range(12)
    ]
    write_rows(root / "performance.parquet", PERFORMANCE, rows)
    for folder in folders:
        card = root / "cards" / folder.name
        card.mkdir(parents=True)
        (card / "body.stl").write_text("of " + folder.name)
        write_card(folder, card)
    (root / "cards" / "d3" / "card.js").unlink()
    study = Study(performance=root / "performance.parquet")
    write_page(folders, root / "index.html", study=study, cards=root / "cards")
    return root / "index.html"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A Chromium that is the system's own."""
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield found
        found.close()


#: What a folder may be called.
ODD = '50% "a" #b'
#: By day, by night, and in a hand.
everywhere = pytest.mark.parametrize("page", ["light", "dark", "phone"], indirect=True)


@pytest.fixture
def page(browser: Browser, page_file: Path, request: pytest.FixtureRequest) -> Iterator[Page]:
    """The page, opened from the disk; what it says in the console is an error."""
    look = getattr(request, "param", "light")
    phone = look == "phone"
    context = browser.new_context(
        viewport={"width": 390, "height": 844} if phone else {"width": 1280, "height": 1000},
        color_scheme="dark" if look == "dark" else "light",
        offline=True,
    )
    found = context.new_page()
    said: list[str] = []
    found.expected = [SAID_BY_PLOTLY]  # type: ignore[attr-defined]
    found.on("console", lambda message: said.append(message.text))
    found.on("pageerror", lambda error: said.append(str(error)))
    found.goto(page_file.as_uri())
    yield found
    context.close()
    expected = found.expected  # type: ignore[attr-defined]
    assert [text for text in said if not any(one in text for one in expected)] == []


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
    assert page.locator("#explorer-table tbody a").all_inner_texts() == [f"d{i}" for i in range(5)]
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


def click(page: Page, name: str) -> None:
    """Click on the row of a design, beside its name."""
    first = page.locator("td:first-child", has_text=name)
    page.locator("#explorer-table tbody tr", has=first).locator("td").nth(1).click()


def opened(page: Page, name: str) -> Locator:
    """Open the card of a design by its name in the table, and return it."""
    page.locator("#explorer-table tbody a", has_text=name).click()
    card = page.locator(f"#design-{name}")
    expect(card).to_have_attribute("open", "")
    return card


def height(card: Locator) -> float:
    """The lowest point of the shape that is drawn."""
    script = "e => Math.min(...e.querySelector('.shape').data[0].z)"
    found: float = card.evaluate(script)
    return found


@everywhere
def test_a_click_on_a_name_opens_the_card_and_marks_nothing(page: Page) -> None:
    assert page.locator(".card canvas").count() == 0
    card = opened(page, "d0")
    card.locator(".shape canvas").first.wait_for()
    # Angles and trajectory; force, gap and volume.
    expect(card.locator(".plot-container")).to_have_count(1 + 2 + 3)
    assert "selected" not in count(page)
    card.locator("summary", has_text="Record").click()
    card.locator(".stage summary", has_text="solve").click()
    assert '"status": "ok"' in card.locator(".stage pre:visible").inner_text()


def test_the_slider_sets_the_pressure_of_the_shape(page: Page) -> None:
    card = opened(page, "d0")
    card.locator(".shape canvas").first.wait_for()
    slider, told = card.locator("input[type=range]"), card.locator("output")
    expect(told).to_have_text("30 kPa")
    last = height(card)
    slider.fill("0")
    expect(told).to_have_text("0 kPa")
    assert height(card) > last + 1.0
    # The line of the pressure, and the centre line of the trajectory, go with it.
    assert card.evaluate("e => e.querySelector('.angles').layout.shapes[0].x0") == 0
    line = "e => { const z = e.querySelector('.course').data[1].y; return z.at(-1) - z[0]; }"
    assert card.evaluate(line) == 0.0
    card.locator("button[aria-label=play]").click()
    expect(told).to_have_text("30 kPa")
    assert height(card) == pytest.approx(last)
    assert card.evaluate(line) < -1.0


def test_a_shape_can_be_turned(page: Page) -> None:
    card = opened(page, "d0")
    card.locator(".shape canvas").first.wait_for()
    eye = "e => Object.values(e.querySelector('.shape').layout.scene.camera.eye)"
    before = card.evaluate(eye)
    shape = card.locator(".shape")
    shape.scroll_into_view_if_needed()
    box: Any = shape.bounding_box()
    x, y = box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 20, steps=5)
    page.mouse.up()
    page.wait_for_function(
        "([card, eye]) => Object.values(document.querySelector(card + ' .shape')"
        ".layout.scene.camera.eye).some((value, i) => Math.abs(value - eye[i]) > 0.05)",
        arg=["#design-d0", before],
    )


def test_a_card_offers_files_that_are_there(page: Page, page_file: Path) -> None:
    card = opened(page, "d2")
    card.locator("summary", has_text="Downloads").click()
    link = card.locator("a[download]")
    assert (page_file.parent / str(link.get_attribute("href"))).read_text() == "of d2"
    with page.expect_download() as waited:
        link.click()
    assert waited.value.suggested_filename == "body.stl"


def test_a_card_whose_file_is_missing_says_so(page: Page) -> None:
    card = opened(page, "d3")
    expect(card).to_contain_text("cards/d3/card.js cannot be read: it must lie beside this page.")
    page.expected.append("ERR_FILE_NOT_FOUND")  # type: ignore[attr-defined]


def test_a_link_to_a_design_opens_its_card(page: Page) -> None:
    page.evaluate("location.hash = '#design-d1'")
    expect(page.locator("#design-d1")).to_have_attribute("open", "")


@everywhere
def test_designs_are_compared_side_by_side(page: Page) -> None:
    button = page.locator("#explorer-compare")
    expect(button).to_be_disabled()
    for name in ("d0", "d2", "d4", "d9"):
        click(page, name)
    expect(page.locator("#explorer-count")).to_contain_text("4 selected")
    button.click()
    box = page.locator("#compare[data-shown]")
    box.wait_for()
    assert box.locator("article h3").all_inner_texts() == ["d0", "d2"]
    for i in range(2):
        box.locator("article").nth(i).locator("canvas").first.wait_for()
    # Bending, twist, force and volume against the pressure, of those that have them.
    traces = box.evaluate("e => [...e.querySelectorAll('.grid .plot')].map((p) => p.data.length)")
    assert traces == [3, 3, 2, 2]
    table = box.locator("tbody tr").filter(has=page.locator("th", has_text="bending,"))
    assert table.locator("td").all_inner_texts() == ["0.0", "20.0", "40.0", "90.0"]
    box.locator(".together input").fill("0")
    assert box.locator("article output").all_inner_texts() == ["0 kPa"] * 2
    box.locator(".close").click()
    expect(page.locator("#compare")).to_be_hidden()


def test_more_than_four_designs_are_not_compared(page: Page) -> None:
    for name in ("d0", "d2", "d4", "d9", "d5"):
        click(page, name)
    expect(page.locator("#explorer-compare")).to_be_disabled()
    click(page, "d5")
    expect(page.locator("#explorer-compare")).to_be_enabled()


def test_another_comparison_takes_the_place_of_the_first(page: Page) -> None:
    def compare(*wanted: str) -> Locator:
        page.locator("#explorer-clear").click()
        for name in wanted:
            click(page, name)
        page.locator("#explorer-compare").click()
        found = page.locator("#compare[data-shown]")
        found.wait_for()
        return found

    box = compare("d0", "d2")
    before = page.evaluate("redraws.size")
    box.locator("article").nth(1).locator("canvas").first.wait_for()
    # Two designs of a table alone: neither a shape nor a plot nor a slider.
    box = compare("d8", "d9")
    assert box.locator("article, .plot").count() == 0
    expect(box.locator(".together")).to_be_hidden()
    assert page.evaluate("redraws.size") == before - 6
    # One whose file is missing is told of.
    box = compare("d0", "d3")
    assert box.locator("article h3").all_inner_texts() == ["d0"]
    assert "cards/d3/card.js cannot be read" in box.locator(".missing").inner_text()
    # Closed while its files are read, it stays closed.
    page.evaluate("""() => { const found = new Comparison(new Explorer(content.explorer));
      found.explorer.table = null; found.show([0, 2]); found.close(); }""")
    page.wait_for_timeout(300)
    expect(page.locator("#compare")).to_be_hidden()
    assert page.locator("#compare article").count() == 0
    page.expected.append("ERR_FILE_NOT_FOUND")  # type: ignore[attr-defined]


@pytest.fixture
def moved(tmp_path: Path) -> Path:
    """A page of one design with an odd name, which was made elsewhere."""
    made = tmp_path / "made"
    folder = solved(tmp_path / "plain", mode="mixed", origin="own").rename(tmp_path / ODD)
    write_page([folder], made / "index.html")
    return made.rename(tmp_path / "sent to #1 & others") / "index.html"


def test_a_page_goes_elsewhere_with_its_cards(browser: Browser, moved: Path) -> None:
    with browser.new_context(offline=True) as context:
        page = context.new_page()
        page.goto(moved.as_uri())
        card = page.locator(".card")
        # A few designs are shown at once.
        card.locator(".shape canvas").first.wait_for()
        assert card.get_attribute("id") == f"design-{ODD}"
        card.locator("summary").first.click()
        expect(card).not_to_have_attribute("open", "")
        page.locator("#explorer-table tbody a").click()
        expect(card).to_have_attribute("open", "")


def test_paths_are_shown_by_mode(page: Page) -> None:
    page.locator("#plot-side").scroll_into_view_if_needed()
    key = page.locator("#key li")
    expect(key).to_have_text(["bending", "twisting", "mixed"])
    page.locator("#groups button", has_text="twisting").click()
    expect(key).to_have_text(["d1", "d3", "d4"])
    drawn = page.locator("#plot-bending").evaluate("e => e.data.map((trace) => trace.name)")
    assert drawn == ["d1", "d3", "d4"]


def test_many_lines_are_joined_by_mode(page: Page) -> None:
    script = """() => { const paths = Object.create(Paths.prototype);
      const line = (name, color) =>
        ({ name, mode: "lines", line: { color }, x: [0, 1], y: [2, 3] });
      const many = Array.from({ length: 60 }, (_, i) => line("d" + i, i % 2 ? "red" : "blue"));
      const joined = paths.joined(many);
      return [joined.length, joined[0].x.length, joined[0].x[2], joined[0].text[3],
              paths.joined(many.slice(0, 40)).length]; }"""
    assert page.evaluate(script) == [2, 90, None, "d2", 40]


def test_a_wide_table_fades_until_it_is_scrolled_to_its_end(page: Page) -> None:
    script = """(scrolled) => { const box = document.querySelector("#run .scroll");
      box.style.width = "100px"; box.scrollLeft = scrolled; fade(box);
      return box.classList.contains("more"); }"""
    assert [page.evaluate(script, left) for left in (0, 90, 5000)] == [True, True, False]


@everywhere
def test_a_page_is_dark_where_the_system_is(page: Page) -> None:
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    is_dark = page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    assert sum(int(part) for part in re.findall(r"\d+", ground)) < 150 or not is_dark
    assert page.evaluate("document.documentElement.classList.contains('dark')") == is_dark
    opened(page, "d0").locator(".shape canvas").first.wait_for()
    ink = page.locator("#design-d0 .shape").evaluate("e => e.layout.font.color")
    assert (ink.lower() == "#e6eaee") == is_dark


@everywhere
def test_nothing_is_wider_than_the_screen(page: Page) -> None:
    opened(page, "d0").locator(".shape canvas").first.wait_for()
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
