"""The generated designs as later stages take them up, and what they were made of."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from pagd.dataset import read_frame
from pagd.errors import InputError
from pagd.record import Record
from pagd.stages.dataset import DESIGNS_NAME, digest_of, record_of
from pagd.stages.embedding import POINTS_NAME

__all__ = ["load_generated"]


def load_generated(
    dataset: Path, generated: Path, embedding: Path | None = None
) -> tuple[pd.DataFrame, Record]:
    """Read generated designs and their record, from the folder of the stage generate.

    Raises
    ------
    InputError
        If it is the folder of another stage or none, or made of another data set, or, where an
        embedding is given, drawn in another one.
    """
    record = record_of("generated", "generate", generated, dataset)
    if embedding and record.figures.get("embedding_sha256") != digest_of(embedding / POINTS_NAME):
        raise InputError(
            f"generated = {generated} must be drawn in the embedding {embedding}, "
            "but was drawn in another one."
        )
    return read_frame(generated / DESIGNS_NAME), record
