"""The generative half of a run as the page needs it: where its results lie, and what they say."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pagd.errors import InputError
from pagd.record import RECORD_NAME, Record, read_record
from pagd.tables import read_rows

__all__ = ["Study", "captions_of", "comparison_of", "fronts_of", "performance_of", "record_in"]

# Beside the pictures of the generative half: name of a picture to its caption.
_CAPTIONS = "captions.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Where the results of the generative half lie; whatever is None or missing is left out.

    dataset, embedding, generated, selection: folders of these stages, with their record.json.
    diversity: JSON file of the comparison of generators; comparison: folder of its stage.
    performance: Parquet table of all simulated designs, with their novelty.
    pictures: folder with NAME.png and captions.json, of data set, generator and diversity.
    simulated, screening_pictures: the same of simulated designs, and of screened ones.
    screened, screened_training: folders of the screening of generated and of training designs.
    fronts: JSON file of the comparison of their Pareto fronts with those of training designs.
    """

    dataset: Path | None = None
    embedding: Path | None = None
    generated: Path | None = None
    selection: Path | None = None
    diversity: Path | None = None
    comparison: Path | None = None
    performance: Path | None = None
    pictures: Path | None = None
    simulated: Path | None = None
    screened: Path | None = None
    screened_training: Path | None = None
    fronts: Path | None = None
    screening_pictures: Path | None = None


def record_in(folder: Path | None) -> Record | None:
    """Return the record of a stage, or None if there is none."""
    if folder is None or not (folder / RECORD_NAME).is_file():
        return None
    return read_record(folder)


def performance_of(study: Study) -> list[dict[str, Any]]:
    """Return the rows of all simulated designs, none without the table."""
    path = study.performance
    return read_rows(path) if path is not None and path.is_file() else []


def comparison_of(study: Study) -> dict[str, Any]:
    """Return the comparison of generators, empty if there is none."""
    return _read(study.diversity)


def fronts_of(study: Study) -> dict[str, Any]:
    """Return the comparison of Pareto fronts, empty if there is none."""
    return _read(study.fronts)


def captions_of(pictures: Path | None) -> dict[str, str]:
    """Return the captions of the pictures in a folder, by name."""
    return _read(pictures / _CAPTIONS if pictures else None)


def _read(path: Path | None) -> dict[str, Any]:
    if path is None or not path.is_file():
        return {}
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(f"{path}: not readable as JSON ({error}).") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: must hold a JSON object.")
    return content
