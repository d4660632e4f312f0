"""README and docs: no gap left to fill, and every link within the repository leads somewhere."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
LINK = re.compile(r"\]\(([^)\s]+)\)")
GAP = re.compile(r"@@|TODO")
#: A section that a program writes, and has not written.
EMPTY = re.compile(r"<!-- begin ([\w-]+) -->\s*<!-- end \1 -->")


def faults(document: Path) -> list[str]:
    """Return the gaps of a document, its empty sections, and its links that lead nowhere."""
    text = document.read_text(encoding="utf-8")
    gaps = [f"line {i}: {line}" for i, line in enumerate(text.splitlines(), 1) if GAP.search(line)]
    gaps += [f"section {match[1]} is empty" for match in EMPTY.finditer(text)]
    links = [link for link in LINK.findall(text) if not re.match(r"[a-z]+:", link)]
    return gaps + [link for link in links if not leads_somewhere(link, document)]


def leads_somewhere(link: str, document: Path) -> bool:
    path, _, anchor = link.partition("#")
    file = document.parent / path if path else document
    return file.exists() and (not anchor or anchor in anchors(file))


def anchors(document: Path) -> set[str]:
    """Return the anchors of the headings, as they are made of their text."""
    text = re.sub(r"^```.*?^```", "", document.read_text(encoding="utf-8"), flags=re.M | re.S)
    headings = re.findall(r"^#+ +(.+?) *$", text, flags=re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_nothing_is_left_open(document: Path) -> None:
    assert faults(document) == []


def test_what_is_left_open_is_found(tmp_path: Path) -> None:
    document = tmp_path / "d.md"
    document.write_text(
        "# A heading: one, two\n\n@@SHARE@@ of them\n\n```sh\n# no heading\n```\n"
        "[a](#a-heading-one-two) [b](d.md#nowhere) [c](absent.md) [d](https://example.org/x)\n"
        "[e](#no-heading)\nTODO\n"
        "<!-- begin full -->\n1 s\n<!-- end full -->\n"
        "<!-- begin bare -->\n\n<!-- end bare -->\n<!-- begin a-b --><!-- end a-b -->\n"
    )
    assert faults(document) == [
        *("line 3: @@SHARE@@ of them", "line 10: TODO"),
        *("section bare is empty", "section a-b is empty"),
        *("d.md#nowhere", "absent.md", "#no-heading"),
    ]
