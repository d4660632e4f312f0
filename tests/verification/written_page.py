"""docs/verification.md as it was written: its cases and their rows."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

from figure import Case, check
from report import title

PAGE = Path(__file__).parents[2] / "docs" / "verification.md"


@lru_cache
def sections() -> dict[str, list[list[str]]]:
    """The cells of the rows of every case, by heading."""
    parts = re.split(r"^### (.+)\n", PAGE.read_text(encoding="utf-8"), flags=re.M)[1:]
    return {heading: _rows(text) for heading, text in zip(parts[::2], parts[1::2], strict=True)}


def _rows(section: str) -> list[list[str]]:
    """Rows of the table, without its two lines of heading."""
    lines = [line for line in section.splitlines() if line.startswith("|")][2:]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def names_on_page(case: Case) -> list[str]:
    """What the rows of a case are called on the page."""
    return [row[0].replace("\\|", "|") for row in sections().get(title(case.name), [])]


def check_case(case: Case) -> None:
    """Raise AssertionError unless every row passes and the page has these rows."""
    figures = case.rows()
    check(figures)
    assert names_on_page(case) == [figure.name for figure in figures], "make verify writes the page"
