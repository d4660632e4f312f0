"""What the data set says of itself to people: a card, and a dictionary of its columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import pandas as pd

from pagd import __version__
from pagd.archive.splits import SPLITS
from pagd.archive.tables import TABLES
from pagd.tables import Column

__all__ = ["CARD", "DESCRIPTION", "DICTIONARY", "NAME", "card", "dictionary"]

CARD: Final = "README.md"
DICTIONARY: Final = "COLUMNS.md"
NAME: Final = "pagd-pneu-nets"
DESCRIPTION: Final = (
    "Parametric pneu-net actuators: bending, twisting and mixed designs, drawn at random, around "
    "published actuators and by a Gaussian mixture, with what finite-element analysis says that "
    "they do under pressure: trajectories, bending and twist, blocked forces, strains, work, "
    "contact, and how and why an analysis ended."
)

_HEAD: Final = """\
---
license: mit
pretty_name: Pneu-net actuators and what they do
tags: [soft robotics, pneumatic actuators, finite elements, generative design, tabular]
configs:
"""


def card(
    frames: Mapping[str, pd.DataFrame], made_of: Mapping[str, Any], drawn: Sequence[str] = ()
) -> str:
    """Return the card of the data set, in Markdown with the head that data hubs read.

    Parameters
    ----------
    frames
        Its tables by name, all splits together.
    made_of
        What made it, by name, as text: see :func:`pagd.archive.origin.made_of`.
    drawn
        Ids of the designs that there are pictures of.
    """
    return f"""{_HEAD}{_configs()}---

# {NAME}

{DESCRIPTION}

Made with pagd {__version__}, which implements *Performance-augmented Generative Design* (Ghosh and
Roy). The designs of that paper were not published; these are drawn by its rules, and analysed with
other software than its own.
{_pictures(frames, drawn)}
## What is in it

{_table(["set", "designs", "by a chamber", "in full"], _counts(frames))}

A design has an `id`, the first 16 digits of the SHA-256 of its parameters, which is the same
wherever it comes from; all tables have it. The id alone tells the split, so that a design never
changes it: {_shares()}. Every table is a folder of `data/`, with a Parquet file a split:

{_table(["table", "a row is", "rows"], _rows(frames))}

What columns mean, and their units, is in `{DICTIONARY}`, in the metadata of the files, and in
`croissant.json`.

An analysis has one of these fidelities, in the column `fidelity`: `cells`, one chamber that a screw
motion repeats; `pieces`, with the ends as well; `full`, the whole actuator. `doubt` tells why a
simpler one is not to be trusted. Designs that failed are in the tables too:

{_table(["status", "by a chamber", "in full"], _statuses(frames))}

## How it was made

{_table(["what", "is"], [[key, str(value)] for key, value in made_of.items()])}

Every analysis names what made it in the column `provenance`: `provenance.json` tells the whole
configuration with its SHA-256, the versions, and the class of the machine. `CHECKS.md` is the
report of the checks, `SHA256SUMS` has the checksums of all files, `datacite.json` the metadata that
a DOI is registered with.

## What to bear in mind

- One material, one pressure, one air channel; no gravity, no friction, no rate of loading.
- Analyses were verified against closed forms and other programs, not against measured actuators.
- Random designs fill the sampling box evenly. They are no sample of actuators that are in use.
- `blocked_force_N` is at `blocked_force_pressure_kPa`, which may be lower than `pressure_kPa`.

## Loading it

```python
import pandas

designs = pandas.read_parquet("data/designs/train.parquet")
performance = pandas.read_parquet("data/performance/train.parquet")
full = performance[performance.fidelity == "full"].merge(designs, on="id", suffixes=("", "_drawn"))
```

```python
import polars

polars.read_parquet("data/performance/*.parquet").group_by("fidelity", "status").len()
```

```python
from datasets import load_dataset

load_dataset("parquet", data_files={{"train": "data/performance/train.parquet"}})
```

```python
import mlcroissant

mlcroissant.Dataset("croissant.json").records("performance/train")
```

The geometry of a design follows from its parameters: `pagd geometry --design '{{"L": …}}' --out
geometry` writes it as OpenSCAD and STL.
"""


def _pictures(frames: Mapping[str, pd.DataFrame], drawn: Sequence[str]) -> str:
    """The picture of a sample, and where those of its designs are."""
    if not drawn:
        return ""
    names = frames["designs"].set_index("id")["design_id"]
    one_by_one = ", ".join(f"[{names[one]}](pictures/{one}.png)" for one in drawn)
    return f"""
![Some of the designs that were analysed in full, drawn at random](pictures/sample.png)

One by one, as the pressure rises: {one_by_one}.
"""


def dictionary() -> str:
    """Return the columns of all tables with type, unit and meaning, in Markdown."""
    parts = ["# Columns"]
    for name, table in TABLES.items():
        rows = [_described(column) for column in table.columns]
        head = ["column", "type", "unit", "meaning"]
        parts += [f"## {name}", f"A row is {table.row}.", _table(head, rows)]
    return "\n\n".join([*parts, ""])


def _described(column: Column) -> list[str]:
    text = column.description.replace("|", "\\|")
    return [f"`{column.name}`", column.type, column.unit or "–", text]


def _configs() -> str:
    lines = []
    for name in TABLES:
        lines += [f"  - config_name: {name}", "    data_files:"]
        for split in SPLITS:
            lines += [f"      - split: {split}", f"        path: data/{name}/{split}.parquet"]
    return "\n".join([*lines, ""])


def _shares() -> str:
    return ", ".join(f"{100 * share:.0f} % {name}" for name, share in SPLITS.items())


def _counts(frames: Mapping[str, pd.DataFrame]) -> list[list[str]]:
    designs = frames["designs"]
    analysed = {
        which: set(table["id"]) for which, table in _by_fidelity(frames["performance"]).items()
    }
    return [
        [str(name), f"{len(ids):,}", *(f"{len(set(ids) & some):,}" for some in analysed.values())]
        for name, ids in designs.groupby("set", sort=False)["id"]
    ]


def _rows(frames: Mapping[str, pd.DataFrame]) -> list[list[str]]:
    return [[f"`{name}`", TABLES[name].row, f"{len(frame):,}"] for name, frame in frames.items()]


def _statuses(frames: Mapping[str, pd.DataFrame]) -> list[list[str]]:
    parts = _by_fidelity(frames["performance"])
    counts = {which: table["status"].value_counts() for which, table in parts.items()}
    names = dict.fromkeys(name for some in counts.values() for name in some.index)
    return [[f"`{name}`", *(f"{c.get(name, 0):,}" for c in counts.values())] for name in names]


def _by_fidelity(performance: pd.DataFrame) -> dict[str, pd.DataFrame]:
    full = performance["fidelity"] == "full"
    return {"reduced": performance[~full], "full": performance[full]}


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
