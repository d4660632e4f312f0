"""The reduced space of the training designs, and how much of them it keeps."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.config import part
from pagd.embedding import Embedding, make_embedding
from pagd.embedding.quality import quality_of
from pagd.errors import InputError
from pagd.record import Meter, Record
from pagd.stages.dataset import digest_of, load_dataset, record_of
from pagd.stages.stage import ALL_DESIGNS, Outcome, run_stage
from pagd.tables import read_table, reduced_space, write_table

__all__ = ["POINTS_NAME", "check_perplexity", "load_embedding", "run"]

POINTS_NAME = "points.parquet"


def run(dataset: Path, out: Path, config: Mapping[str, Any], *, threads: int = 1) -> Record:
    """Embed the training designs: points.parquet, a row a design in the order of the data set.

    Parameters
    ----------
    dataset
        Folder of the stage dataset, or a Parquet file of designs.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``embedding``.
    threads
        Threads; the points do not depend on their number.

    Raises
    ------
    InputError
        If there is no data set, or too small a one for the perplexity.
    """
    designs = load_dataset(dataset)
    settings = config["embedding"]
    check_perplexity(settings, len(designs), "the number of designs")

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        with meter.part("fit"):
            embedding = make_embedding(settings, threads).fit(designs, settings["seed"])
        _write(embedding, folder)
        with meter.part("quality"):
            quality = quality_of(embedding, seed=settings["seed"])
        outcome.figures |= {
            "dataset_sha256": digest_of(dataset),
            "size": len(designs),
            "dimensions": embedding.points.shape[1],
            **quality.as_dict(),
        }

    return run_stage(
        "embedding",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=part(config, "embedding"),
        libraries=("numpy", "openTSNE", "scikit-learn", "scipy"),
    )


def load_embedding(dataset: Path, embedding: Path, *, threads: int = 1) -> Embedding:
    """Take up the embedding of a data set again from the folders of both stages.

    Raises
    ------
    InputError
        If there is none, or it is that of another data set or stage.
    """
    record = record_of("embedding", "embedding", embedding, dataset)
    columns = read_table(embedding / POINTS_NAME)
    points = np.column_stack([values for name, values in columns.items() if name != "design_id"])
    made = make_embedding(record.configuration["embedding"], threads)
    return made.restore(load_dataset(dataset), _contiguous(points))


def check_perplexity(settings: Mapping[str, Any], count: int, what: str) -> None:
    """Refuse a perplexity that is too large for a number of designs; ``what`` names it."""
    # Beyond that, t-SNE would quietly take a smaller one.
    if settings["method"] == "tsne" and settings["perplexity"] > count / 3:
        raise InputError(
            f"embedding.perplexity = {settings['perplexity']:g} must be at most a third of "
            f"{what}, {count}."
        )


def _contiguous(points: NDArray[Any]) -> NDArray[np.float64]:
    return np.ascontiguousarray(points, dtype=np.float64)


def _write(embedding: Embedding, folder: Path) -> None:
    ids: pd.Series[str] = embedding.designs["design_id"]
    points = {f"z{i}": values for i, values in enumerate(embedding.points.T, start=1)}
    columns = reduced_space(len(points))
    write_table(folder / POINTS_NAME, columns, {"design_id": ids, **points})
