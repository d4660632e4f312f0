"""A family of a user's own, the three files of docs/extending.md, and designs of families."""

from __future__ import annotations

from pathlib import Path

#: A half-bellows of two convolutions.
BELLOWS = {
    "name": "bellows", "family": "half_bellows", "N": 2, "q": 11.0, "w": 4.0, "R": 7.0, "L_c": 5.0,
    "L_r": 2.0, "t": 2.0, "t_e": 2.0, "t_b": 3.0, "b_f": 1.0,
}  # fmt: skip

#: A bar with a square channel along it.
BAR = {"name": "bar", "family": "hollow_bar:HollowBar", "a": 8.0, "L": 30.0, "wall": 2.0}


def _example(language: str) -> str:
    """The one block of a language among the examples of a family in the documentation."""
    page = (Path(__file__).parents[2] / "docs" / "extending.md").read_text(encoding="utf-8")
    section = page.partition("## A family of actuators")[2].partition("\n## ")[0]
    return section.partition(f"```{language}\n")[2].partition("```")[0]


#: The three files, as docs/extending.md has them.
TABLE, MODEL, MODULE = (_example(language) for language in ("text", "openscad", "python"))


def write_family(folder: Path, **texts: str) -> None:
    """Write the three files of the hollow bar; texts replace those of an ending (py, csv, scad)."""
    for ending, text in ({"py": MODULE, "csv": TABLE, "scad": MODEL} | texts).items():
        (folder / f"hollow_bar.{ending}").write_text(text)
