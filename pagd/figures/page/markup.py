"""Pieces of HTML. What is given as text is escaped, what is given as markup is not."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from typing import NamedTuple

__all__ = ["Section", "badge", "data_table", "escaped", "facts", "folded", "numbered", "section"]


def escaped(text: object) -> str:
    """Return text as it can stand in HTML, in attributes too."""
    return html.escape(str(text))


class Section(NamedTuple):
    """A section of the page: name of its anchor, title (text) and body (markup)."""

    name: str
    title: str
    body: str


def numbered(sections: Iterable[Section]) -> list[Section]:
    """Return the sections that have a body, with their numbers in the titles."""
    found = [s for s in sections if s.body]
    return [s._replace(title=f"{i}. {s.title}") for i, s in enumerate(found, start=1)]


def section(part: Section) -> str:
    """Return a section as markup."""
    return f'<section id="{part.name}"><h2>{escaped(part.title)}</h2>{part.body}</section>'


def facts(rows: Iterable[tuple[str, str]]) -> str:
    """Return a list of names (text) and values (markup); rows without a value are left out."""
    found = [f"<div><dt>{escaped(k)}</dt><dd>{v}</dd></div>" for k, v in rows if v]
    return f'<dl class="facts">{"".join(found)}</dl>' if found else ""


def badge(word: str, *, ok: bool) -> str:
    """Return a word in a coloured ring: how something ended."""
    return f'<span class="status {"ok" if ok else "failed"}">{escaped(word)}</span>'


def folded(title: str, body: str) -> str:
    """Return markup that a click on its title opens."""
    return f"<details><summary>{escaped(title)}</summary>{body}</details>" if body else ""


def data_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table of texts whose first column names the rows."""
    top = "".join(f"<th>{escaped(cell)}</th>" for cell in head)
    body = "".join(
        f"<tr><th>{escaped(row[0])}</th>"
        + "".join(f"<td>{escaped(cell)}</td>" for cell in row[1:])
        + "</tr>"
        for row in rows
    )
    return (
        f'<div class="scroll"><table><thead><tr>{top}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )
