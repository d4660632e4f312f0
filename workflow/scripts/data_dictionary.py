"""Write docs/data.md: every file of results/ for use elsewhere, every column of every table.

    python workflow/scripts/data_dictionary.py

The columns are those the files are written with (`pagd/tables`), the exports those that the page
offers (`pagd/figures/page/downloads.py`); a test keeps docs/data.md in step.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from pagd.figures.page.downloads import DESCRIPTIONS
from pagd.summary import FOR_PEOPLE
from pagd.tables import (
    BLOCKED,
    CHAMBERS,
    COMPARISON,
    DESIGNS,
    GENERATED,
    HISTORY,
    HULL_POINTS,
    HULLS,
    MEASURES,
    PERFORMANCE,
    STATES,
    TRAJECTORY,
    Column,
    reduced_space,
)

ROOT = Path(__file__).parents[2]


class Table(NamedTuple):
    """A table: files that have its columns, what a row is, the columns, and more to know."""

    title: str
    files: tuple[str, ...]
    row: str
    columns: Sequence[Column]
    remark: str = ""


TABLES = (
    Table(
        "Performance of all designs",
        (
            "summary/performance.parquet",
            "screening/*/performance.parquet",
        ),
        "a simulated design, whatever became of it",
        PERFORMANCE,
        """\
Angles, tip, work and strain are those of the last recorded state, at `pressure_kPa`: the last
pressure asked for, or that at which the free actuation ended early. The blocked force has an
analysis of its own, which may end elsewhere: at `blocked_force_pressure_kPa`, and with
`blocked_force_status`. `largest_pressure_kPa` is above `pressure_kPa` where the pressure has
fallen behind a limit point. `first_contact_pressure_kPa` is where the smallest gap passes the
width of the contact law; it is null where walls never came so near, or contact was off. A share
of penetration is the deepest one of all steps of its analysis by the smallest gap between facing
walls of the undeformed actuator, and null where contact was off.
`newton_iterations` are those of the free actuation, `blocked_force_iterations` those with the tip
held; the times cover all stages and both analyses.""",
    ),
    Table(
        "Performance by pressure",
        (
            "summary/by_pressure.parquet",
            "screening/*/by_pressure.parquet",
            "designs/*/metrics/performance.parquet",
        ),
        "a design and recorded pressure",
        MEASURES,
        """\
Rows are in the order of the path. Behind a limit point the pressure falls, so that the last one
of a design that ended early may be lower than the one before. The strain rate is taken by
differences of second order between recorded pressures, and is null where the pressure does not
rise from one to the next; per second it is that times `metrics.pressure_ramp_kPa_per_s`. What
the angles are is told in `pagd/metrics/trajectory.py`.""",
    ),
    Table(
        "Chambers",
        (
            "summary/chambers.parquet",
            "screening/*/chambers.parquet",
            "designs/*/metrics/chambers.parquet",
        ),
        "a design, recorded pressure and chamber",
        CHAMBERS,
        """\
A chamber has half of the gap on either side. All chambers of a row add up to the angles of the
tip. Where a mesh of one's own was solved, even sections are numbered instead.""",
    ),
    Table(
        "Trajectories",
        (
            "summary/trajectories.parquet",
            "screening/*/trajectories.parquet",
            "designs/*/metrics/trajectory.parquet",
        ),
        "a design, recorded pressure and section",
        TRAJECTORY,
        """\
Sections lie at the fixed end (0), in the middle of every gap, and at the tip (the last one).""",
    ),
    Table(
        "Steps of the free actuation",
        ("designs/*/solve/history.parquet",),
        "a step or an interpolated state, the state without pressure first",
        HISTORY,
        """\
Rows are in the order of the path, along which the pressure falls behind a limit point. Figures
of a half model are those of the whole actuator. The energy stored since the state without
pressure is that of elastomer, paper and contact, and under gravity its potential too.""",
    ),
    Table(
        "Steps with a held tip",
        ("designs/*/solve/blocked_force.parquet",),
        "a step, or an interpolated state, of the analysis of the blocked force",
        BLOCKED,
        """\
There is no such file where `solve.blocked_force` is `none`.""",
    ),
    Table(
        "Deformed states",
        (
            "designs/*/solve/states.parquet",
            "designs/*/solve/blocked_states.parquet",
        ),
        "a recorded state and node of `mesh.msh`",
        STATES,
        """\
The state without pressure comes first. A half model has the nodes at y ≥ 0 only.""",
    ),
    Table("Training designs", ("dataset/designs.parquet",), "a design", DESIGNS),
    Table(
        "Places in the reduced space",
        ("embedding/points.parquet",),
        "a training design",
        reduced_space(2),
        "A space of more dimensions has a column for each.",
    ),
    Table("Generated designs", ("generated/designs.parquet",), "a design", GENERATED),
    Table(
        "Comparison of generators",
        ("diversity/comparison.parquet",),
        "a generator, space, mode and metric",
        COMPARISON,
    ),
    Table("Areas of hulls", ("diversity/hull.parquet",), "a generator and draw", HULLS),
    Table("Hulls", ("diversity/hull_points.parquet",), "a generator and design", HULL_POINTS),
)

OTHER_FILES = (
    ("summary/summary.csv", "performance of all designs for people, [below](#for-people)"),
    ("summary/diversity.json", "every measure of every generator, and what the measures mean"),
    ("generated/mixture.json", "Gaussians the designs come from: weights, means, covariances"),
    (
        "selection/designs.csv",
        "[designs](../config/README.md#tables-of-designs) to simulate",
    ),
    ("designs/*/geometry/design.json", "the design: its name, origin and parameters"),
    ("designs/*/geometry/design.scad", "the design for OpenSCAD"),
    ("designs/*/geometry/*.stl", "surfaces of body and base; `_half` of a half model"),
    ("designs/*/repair/*.stl", "the same, closed and oriented"),
    ("designs/*/mesh/mesh.msh", "quadratic tetrahedra with named surfaces, gmsh 4.1"),
    ("report/designs/*/", "a design for other programs, [file by file](#exports-of-a-design)"),
    ("verification/verification.json", "every row of `make verify`"),
    ("*/record.json", "[record](workflow.md#records) of a stage"),
)

INTRODUCTION = """\
# Data

Every file of `results/` that can be used elsewhere, and every column of every table. Pictures,
the page and logs are listed in [results/README.md](../results/README.md).

This page is made by `python workflow/scripts/data_dictionary.py` from what the files are written
with.

Tables are Parquet files, which pandas, R, MATLAB, DuckDB and others read. Types are those of
Arrow; the unit `1` is a pure number; a null says that there is no such figure. Unit and
description are in the metadata of every column as well:

```python
import pyarrow.parquet

field = pyarrow.parquet.read_schema("results/summary/performance.parquet").field("bending_deg")
print(field.metadata[b"unit"], field.metadata[b"description"])
```

x runs along the undeformed actuator from its fixed end, y across, z up, away from the base.
Bending is positive towards the base, twist by the right-hand rule about x.

## Files
"""

EXPORTS_TEXT = """\
`report/designs/*/`, and any folder that `pagd export` writes, has those of these files that can be
made of the design; its `record.json` says what could not be, and why (`left_out`). A mesh of half
of a design has a `last_state.vtu` of that half. The CSV files are tables of the design as they are,
rows and columns: [trajectory](#trajectories), [performance](#performance-by-pressure),
[free actuation](#steps-of-the-free-actuation) and [blocked force](#steps-with-a-held-tip).
"""

FOR_PEOPLE_TEXT = """\
`summary/summary.csv` has one row a design, with units in the headings. Cells are empty where
there is no such figure. The second column names the figure in `performance.parquet`, or else in
the `record.json` of the stage metrics.
"""


def lines(rows: Iterable[Sequence[str]]) -> str:
    """Return rows, the headings first, as a Markdown table."""
    head, *body = rows
    every = (head, ("---",) * len(head), *body)
    return "".join(f"| {' | '.join(row)} |\n" for row in every)


def anchor(title: str) -> str:
    """Return the anchor of a heading of plain words."""
    return title.lower().replace(" ", "-")


def files() -> str:
    """Return the table of all files."""
    tables = (
        (f"`{file}`", f"[{table.title}](#{anchor(table.title)})")
        for table in TABLES
        for file in table.files
    )
    others = ((f"`{file}`", meaning) for file, meaning in OTHER_FILES)
    return lines((("file", "what it is"), *tables, *others))


def section(table: Table) -> str:
    """Return the section of one table."""
    named = "".join(f"- `{file}`\n" for file in table.files)
    columns = (
        (f"`{column.name}`", column.type, column.unit or "–", _escaped(column.description))
        for column in table.columns
    )
    parts = [
        f"## {table.title}\n",
        f"One row {table.row}:\n",
        named,
        lines((("column", "type", "unit", "meaning"), *columns)),
    ]
    remark = [f"{table.remark}\n"] if table.remark else []
    return "\n".join(parts + remark)


def _escaped(text: str) -> str:
    # An upright stroke would end the cell.
    return text.replace("|", "\\|")


def for_people() -> str:
    """Return the section of the table for people."""
    rows = ((heading, f"`{key}`") for heading, key, _ in FOR_PEOPLE)
    named = (("design", "`design_id`"), *rows, ("status", "`status`"), ("reason", "`reason`"))
    return f"## For people\n\n{FOR_PEOPLE_TEXT}\n{lines((('heading', 'figure'), *named))}"


def exports() -> str:
    """Return the section of the files of a design for other programs."""
    rows = ((f"`{name}`", meaning) for name, meaning in DESCRIPTIONS.items())
    return f"## Exports of a design\n\n{EXPORTS_TEXT}\n{lines((('file', 'what it is'), *rows))}"


def page() -> str:
    """Return the whole page."""
    sections = "\n".join((*map(section, TABLES), exports(), for_people()))
    return f"{INTRODUCTION}\n{files()}\n{sections}"


if __name__ == "__main__":
    (ROOT / "docs" / "data.md").write_text(page(), encoding="utf-8")
