"""All designs of a run to look through: a table to sort and filter, and a plot of any two figures.

Rows are designs: those simulated in full, and those analysed by one chamber alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from pagd.dataset import read_frame
from pagd.figures.page.rows import Row
from pagd.figures.page.shown import FIGURES, Shown
from pagd.figures.page.study import Study
from pagd.tables import read_rows

__all__ = ["FULL", "ONE_CHAMBER", "explorer", "explorer_data"]

#: What the column ``analysis`` says.
FULL, ONE_CHAMBER = "full", "one chamber"


_MARKUP: Final = """
<div class="explorer">
  <div class="control">
    <label>across <select id="explorer-x"></select></label>
    <label>up <select id="explorer-y"></select></label>
    <button type="button" id="explorer-clear">Select none</button>
    <button type="button" id="explorer-compare" disabled>Compare</button>
    <output id="explorer-count"></output>
  </div>
  <div class="plot tall" id="plot-explorer"></div>
  <table id="explorer-table" class="display compact nowrap"></table>
</div>
<p class="note">Draw a box or a lasso around points: their rows come first. A click on a row marks
or unmarks its point; two to four are compared side by side. The funnel of a column filters by it,
and the plot shows what the filters leave. A click on a name or a point opens the card of a design
that was simulated in full. Bending
is positive towards the paper (down), twist by the right hand about the axis from the fixed end to
the tip; both are summed over the chambers, so that they pass 180°. Figures are those of the last
pressure reached. Energy balance: |∫p&nbsp;dV&nbsp;−&nbsp;U|&nbsp;/&nbsp;U. Strain: 99th percentile
of the largest principal logarithmic strain.</p>
<div id="compare" hidden>
  <header><h3>Side by side</h3><button type="button" class="close">Close</button></header>
  <div class="control together">
    <label>pressure of all</label>
    <input type="range" min="0" max="0" value="0" step="any" aria-label="pressure of all">
    <output></output>
  </div>
  <p class="reason missing"></p>
  <div class="columns"></div>
  <div class="grid"></div>
  <div class="scroll"><table><tbody></tbody></table></div>
</div>
"""


def explorer() -> str:
    """Return the section as markup; the script fills it."""
    return _MARKUP


def explorer_data(rows: Sequence[Row], study: Study) -> dict[str, Any]:
    """Return what the script shows.

    Parameters
    ----------
    rows
        Simulated designs, of :func:`pagd.figures.page.rows.rows_of`.
    study
        Where the designs lie that were analysed by a chamber each.

    Returns
    -------
    dict
        ``columns``, of which some design knows something: heading, unit, key, digits; ``rows``,
        lists of values in that order; ``links``, the numbers of the rows whose design has a card.
    """
    simulated = {row["design_id"] for row in rows}
    others = (row for row in _screened(study) if row["design_id"] not in simulated)
    found = [{"analysis": FULL, **row} for row in rows] + [*others]
    columns = [c for c in FIGURES if any(row.get(c.key) is not None for row in found)]
    return {
        "columns": [
            {"heading": c.heading, "unit": c.unit, "key": c.key, "digits": c.digits}
            for c in columns
        ],
        "rows": [[_shown(row.get(c.key), c) for c in columns] for row in found],
        "links": [number for number, row in enumerate(found) if row.get("link")],
    }


def _screened(study: Study) -> Iterator[dict[str, Any]]:
    """Designs by a chamber each, with the novelty that generated ones have."""
    novelty = _novelty_of(study.generated)
    for folder in (study.screened, study.screened_training):
        path = folder / "performance.parquet" if folder else None
        for row in read_rows(path) if path and path.is_file() else ():
            name = row["design_id"]
            yield {**row, "analysis": ONE_CHAMBER, "novelty": novelty.get(name)}


def _novelty_of(generated: Path | None) -> Mapping[str, float]:
    path = generated / "designs.parquet" if generated else None
    if path is None or not path.is_file():
        return {}
    frame = read_frame(path)
    return dict(zip(frame["design_id"], frame["novelty"].astype(float), strict=True))


def _shown(value: Any, column: Shown) -> Any:
    """Return a value as the page has it: without round-off, and without underscores."""
    if value is None or column.digits is None:
        plain = column.key in ("status", "origin")
        return value.replace("_", " ") if plain and isinstance(value, str) else value
    # A digit more than is shown, so that what is sorted differs where it should. No minus zero.
    return round(column.factor * float(value), column.digits + 1) + 0.0
