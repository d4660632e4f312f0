"""The training designs: random ones, and some around known ones."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from pagd.catalogue import NamedDesign, read_pneunets
from pagd.config import known_tables, part
from pagd.dataset import make_dataset, read_frame, write_frame
from pagd.errors import InputError
from pagd.files import must_exist
from pagd.inventory import read_sound_record
from pagd.record import Meter, Record
from pagd.stages.geometry import rules_of
from pagd.stages.stage import ALL_DESIGNS, Outcome, run_stage

__all__ = ["DESIGNS_NAME", "digest_of", "load_dataset", "record_of", "run"]

DESIGNS_NAME = "designs.parquet"


def run(out: Path, config: Mapping[str, Any]) -> Record:
    """Make the data set: designs.parquet, the same bytes for the same configuration.

    Parameters
    ----------
    out
        Folder of the stage.
    config
        Completed configuration; uses ``channel``, ``limits`` and ``dataset``.
    """
    settings = dict(config["dataset"])
    settings.pop("known")
    known = _known(config)

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        with meter.part("draw"):
            made = make_dataset(published=known, rules=rules_of(config), **settings)
        write_frame(folder / DESIGNS_NAME, made.designs)
        outcome.figures |= made.report | {"sha256": _digest(folder / DESIGNS_NAME)}

    return run_stage(
        "dataset",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=part(config, "dataset"),
        libraries=("numpy", "pandas", "pyarrow", "scipy"),
    )


def load_dataset(dataset: Path) -> pd.DataFrame:
    """Read the training designs from the folder of this stage, or from a Parquet file.

    Raises
    ------
    InputError
        If there is no such table.
    """
    return read_frame(_file(dataset))


def digest_of(dataset: Path) -> str:
    """Return what tells one data set from another: a digest of its file.

    Raises
    ------
    InputError
        If there is no such file.
    """
    return _digest(_file(dataset))


def record_of(name: str, stage: str, folder: Path, dataset: Path) -> Record:
    """Return the record of a stage that was made of a data set.

    Parameters
    ----------
    name
        What the folder is called in the message of an error.
    stage
        The stage it must be of.
    folder, dataset
        Its folder, and that of the data set.

    Raises
    ------
    InputError
        If the folder is of another stage, or made of another data set.
    """
    record = read_sound_record(folder)
    if record.stage != stage:
        raise InputError(
            f"{name} = {folder} must be a folder of the stage {stage}, "
            f"but is one of the stage {record.stage}."
        )
    if record.figures.get("dataset_sha256") != digest_of(dataset):
        raise InputError(
            f"{name} = {folder} must be made of the data set {dataset}, "
            "but was made of another one."
        )
    return record


def _known(config: Mapping[str, Any]) -> list[NamedDesign]:
    return list(read_pneunets(known_tables(config)).values())


def _file(dataset: Path) -> Path:
    return dataset if dataset.suffix == ".parquet" else dataset / DESIGNS_NAME


def _digest(file: Path) -> str:
    must_exist(file)
    return hashlib.sha256(file.read_bytes()).hexdigest()[:16]
