"""The generated designs to simulate: as many of each mode, far from each other."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from pagd.config import part
from pagd.dataset import INDEPENDENT
from pagd.design import MODES
from pagd.encoding import Encoder
from pagd.files import write_text
from pagd.record import Meter, Record
from pagd.selection import choose
from pagd.stages.dataset import load_dataset
from pagd.stages.generated import load_generated
from pagd.stages.stage import ALL_DESIGNS, Outcome, run_stage

__all__ = ["SELECTION_NAME", "run"]

SELECTION_NAME = "designs.csv"


def run(dataset: Path, generated: Path, out: Path, config: Mapping[str, Any]) -> Record:
    """Choose generated designs: designs.csv, a table of designs like those of the configuration.

    Parameters
    ----------
    dataset, generated
        Folders of the stages before; distances are those of the encoded training designs.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``selection``.

    Raises
    ------
    InputError
        If the generated designs are missing, or made of another data set.
    """
    settings = config["selection"]
    candidates, _ = load_generated(dataset, generated)
    encoder = Encoder().fit(load_dataset(dataset))

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        encoded = encoder.transform(candidates)
        rows = choose(candidates, encoded, settings["designs"], settings["seed"])
        chosen = candidates.iloc[rows]
        write_text(folder / SELECTION_NAME, _as_csv(chosen))
        counts = chosen["mode"].value_counts()
        modes = {mode: int(counts[mode]) for mode in MODES if mode in counts}
        outcome.figures |= {"designs": len(chosen), "candidates": len(candidates), "modes": modes}

    return run_stage(
        "selection",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=part(config, "selection"),
        libraries=("numpy", "pandas", "scikit-learn", "scipy"),
    )


def _as_csv(designs: pd.DataFrame) -> str:
    # repr of a float is the shortest text that reads back as the same number.
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["name", *INDEPENDENT])
    columns = [designs[name].tolist() for name in ("design_id", *INDEPENDENT)]
    writer.writerows(zip(*columns, strict=True))
    return text.getvalue()
