"""Sections of a page that commands fill: between ``<!-- begin NAME -->`` and ``<!-- end NAME -->``.

Everything else on the page is written by hand and stays as it is.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path

from pagd.errors import InputError
from pagd.files import must_exist, write_text

__all__ = ["must_have_section", "publish", "read_section", "table", "wrapped", "write_section"]

_WIDTH = 100


def write_section(page: Path, name: str, text: str) -> None:
    """Replace a section of a page; the page is never seen half written.

    Parameters
    ----------
    page
        Markdown file with the markers of the section, each on a line of its own.
    name
        Of the section, as in its markers.
    text
        What is to stand between the markers, without them.

    Raises
    ------
    InputError
        If there is no such page, if it lacks a marker of the section, has one twice or the end
        before the beginning, or if the text itself holds a marker.
    """
    before, _, after = _split(page, name)
    if "<!-- begin " in text or "<!-- end " in text:
        raise InputError(f"{page}: the text of section '{name}' must not hold markers of sections.")
    write_text(page, f"{before}\n\n{text.strip()}\n\n{after}")


def read_section(page: Path, name: str) -> str:
    """Return what stands in a section; ``InputError`` as of :func:`write_section`."""
    return _split(page, name)[1].strip()


def must_have_section(page: Path | None, name: str) -> None:
    """Refuse a page without the section before anything is measured; None is no page."""
    if page is not None:
        _split(page, name)


def publish(page: Path | None, name: str, text: str) -> None:
    """Write a section to the page, or print it where there is none: what ``--page`` stands for."""
    if page is None:
        print(text.strip())
    else:
        write_section(page, name, text)
        print(f"{page}: section '{name}' is written.")


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table: first column to the left, the others, numbers, to the right."""
    lines = [headings, ["---"] + ["---:"] * (len(headings) - 1), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def wrapped(text: str, indent: str = "") -> str:
    """Return a paragraph in lines of a hundred characters at most; ``indent`` from the second."""
    return textwrap.fill(
        text, _WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def _split(page: Path, name: str) -> tuple[str, str, str]:
    """What is before a section, with its first marker; in it; and after it, with its last."""
    must_exist(page)
    content = page.read_text(encoding="utf-8")
    lines = content.split("\n")
    begin, end = (_line_of(lines, f"<!-- {which} {name} -->", page) for which in ("begin", "end"))
    if end < begin:
        raise InputError(f"{page}: section '{name}' must begin before it ends.")
    parts = lines[: begin + 1], lines[begin + 1 : end], lines[end:]
    before, between, after = ("\n".join(part) for part in parts)
    return before, between, after


def _line_of(lines: Sequence[str], marker: str, page: Path) -> int:
    found = [number for number, line in enumerate(lines) if line.strip() == marker]
    if len(found) != 1:
        raise InputError(f"{page}: must hold the line {marker} once, not {len(found)} times.")
    return found[0]
