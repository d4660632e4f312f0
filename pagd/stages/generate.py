"""New designs: valid ones, none twice, none a copy of a training design."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.config import part
from pagd.dataset import write_frame
from pagd.design import Mode
from pagd.diversity.novelty import nearest_distances, unit_square
from pagd.embedding import Embedding
from pagd.errors import InputError
from pagd.files import write_text
from pagd.generators import Generated, Generator, generate, make_generator
from pagd.record import Meter, Record
from pagd.stages import dataset as dataset_stage
from pagd.stages import embedding as embedding_stage
from pagd.stages.dataset import DESIGNS_NAME, digest_of
from pagd.stages.embedding import POINTS_NAME, load_embedding
from pagd.stages.geometry import rules_of
from pagd.stages.stage import ALL_DESIGNS, Outcome, run_stage
from pagd.tables import GENERATED

__all__ = ["MIXTURE_NAME", "run"]

MIXTURE_NAME = "mixture.json"

FloatArray = NDArray[np.float64]


def run(
    out: Path,
    config: Mapping[str, Any],
    *,
    dataset: Path | None = None,
    embedding: Path | None = None,
    mode: Mode | None = None,
    threads: int = 1,
) -> Record:
    """Generate designs: designs.parquet, and mixture.json for a mixture of Gaussians.

    Parameters
    ----------
    out
        Folder of the stage.
    config
        Completed configuration; uses ``channel``, ``limits`` and ``generator``.
    dataset, embedding
        Folders of the stages before. Without them the stages are run for this one, with
        ``dataset`` and ``embedding`` of the configuration, in ``out/dataset``, ``out/embedding``.
    mode
        Take designs of this mode only.
    threads
        Threads of an embedding.

    Raises
    ------
    InputError
        If there is an embedding without its data set, or next to no usable design.
    """
    if embedding and not dataset:
        raise InputError(f"embedding = {embedding} needs the data set that it was made of.")

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        data = dataset or _made_dataset(folder, config)
        plane = embedding or _made_embedding(data, folder, config, threads)
        with meter.part("read"):
            space = load_embedding(data, plane, threads=threads)
        generator, generated = _generated(space, config, mode, meter)
        with meter.part("novelty"):
            frame = _measured(generated, space)
        write_frame(folder / DESIGNS_NAME, frame, GENERATED)
        _write_mixture(generator, folder)
        digests = {
            "dataset_sha256": digest_of(data),
            "embedding_sha256": digest_of(plane / POINTS_NAME),
        }
        outcome.figures |= generated.report | _means(frame) | digests

    return run_stage(
        "generate",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=part(config, "generate") | {"mode": mode},
        libraries=("numpy", "openTSNE", "pandas", "scikit-learn", "scipy"),
    )


def _made_dataset(folder: Path, config: Mapping[str, Any]) -> Path:
    dataset_stage.run(folder / "dataset", config)
    return folder / "dataset"


def _made_embedding(dataset: Path, folder: Path, config: Mapping[str, Any], threads: int) -> Path:
    embedding_stage.run(dataset, folder / "embedding", config, threads=threads)
    return folder / "embedding"


def _generated(
    space: Embedding, config: Mapping[str, Any], mode: Mode | None, meter: Meter
) -> tuple[Generator, Generated]:
    settings, rules = config["generator"], rules_of(config)
    with meter.part("fit"):
        generator = make_generator(settings, rules).fit(space, settings["seed"])
    with meter.part("draw"):
        generated = generate(
            generator,
            settings["designs"],
            training=space.designs,
            rules=rules,
            seed=settings["seed"],
            mode=mode,
            least_novelty=settings["least_novelty"],
        )
    return generator, generated


def _measured(generated: Generated, space: Embedding) -> pd.DataFrame:
    """Return the generated designs with novelty, Gaussian and place."""
    frame = generated.designs.copy()
    encoded = space.encoder.transform(frame)
    frame["novelty"] = nearest_distances(encoded, space.encoder.transform(space.designs))
    frame["novelty_plane"] = _novelty_plane(generated.points, space.points)
    # None: a column of nulls, where the generator knows no Gaussians or places.
    frame["component"] = generated.components
    for i, name in enumerate(("z1", "z2")):
        places = generated.points
        frame[name] = places[:, i] if places is not None and i < places.shape[1] else None
    return frame


def _novelty_plane(points: FloatArray | None, training: FloatArray) -> FloatArray | None:
    if points is None:
        return None
    return nearest_distances(unit_square(points, training), unit_square(training, training))


def _means(frame: pd.DataFrame) -> dict[str, float]:
    columns = {"novelty": "novelty_mean", "novelty_plane": "novelty_plane_mean"}
    return {
        name: float(frame[column].mean())
        for column, name in columns.items()
        if frame[column].notna().any()
    }


def _write_mixture(generator: Generator, folder: Path) -> None:
    mixture = getattr(generator, "mixture", None)
    if mixture is None:
        return
    bic = {str(count): value for count, value in cast(Any, generator).bic.items()}
    content = {"generator": generator.name, **mixture.as_dict(), "bic": bic}
    write_text(folder / MIXTURE_NAME, json.dumps(content, indent=2) + "\n")
