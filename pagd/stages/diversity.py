"""How new and how varied generated designs are, beside those of every other generator."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.config import completed, part
from pagd.diversity import (
    METRICS,
    TRAINING,
    Candidate,
    Comparison,
    Settings,
    compare,
    places_of_mode,
    plane_novelty_over_seeds,
)
from pagd.embedding import Embedding, make_embedding
from pagd.errors import InputError
from pagd.files import write_text
from pagd.generators import GENERATORS, Generated, generate, make_generator
from pagd.long_work import counted
from pagd.record import Meter, Record, read_record
from pagd.stages.embedding import check_perplexity, load_embedding
from pagd.stages.generated import load_generated
from pagd.stages.geometry import rules_of
from pagd.stages.stage import ALL_DESIGNS, Outcome, run_stage
from pagd.tables import COMPARISON, HULL_POINTS, HULLS, write_rows

__all__ = ["COMPARISON_NAME", "DIVERSITY_NAME", "HULL_NAME", "run"]

DIVERSITY_NAME = "diversity.json"
COMPARISON_NAME = "comparison.parquet"
HULL_NAME = "hull.parquet"
POINTS_NAME = "hull_points.parquet"

FloatArray = NDArray[np.float64]


def run(
    dataset: Path,
    embedding: Path,
    generated: Path,
    out: Path,
    config: Mapping[str, Any],
    *,
    threads: int = 1,
) -> Record:
    """Compare the generators: diversity.json, and tables for its pictures.

    Parameters
    ----------
    dataset, embedding, generated
        Folders of the stages before. What made ``generated`` (generator, rules) is taken from
        its record; every other generator draws as many designs in the same way.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``diversity``.
    threads
        Threads of the embeddings.

    Raises
    ------
    InputError
        If a stage before is missing or of another data set, or its designs are of one mode
        because no other was wanted.
    """
    settings = config["diversity"]
    space = load_embedding(dataset, embedding, threads=threads)
    method = read_record(embedding).configuration["embedding"]
    frame, record = load_generated(dataset, generated, embedding)
    config = part(config, "diversity") | _made_with(record, generated)
    own = config["generator"]["method"]
    _check(config, method, len(space.designs))

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        with meter.part("generate"):
            others = [name for name in GENERATORS if name != own]
            asked = counted(others, "other generators", len(others), "generators", even=False)
            drawn = _draw(asked, space, config, len(frame), config["generator"]["seed"])
        with meter.part("place"):
            candidates = {own: _candidate(space, frame, _places(frame))}
            candidates |= {
                n: _candidate(space, d.designs, d.points) for n, d in drawn.given.items()
            }
        with meter.part("compare"):
            found = _compared(space, candidates, settings)
        with meter.part("seeds"):
            plane = _PlaneOfFew(space.designs, method, config, len(frame), threads)
            found.rows.extend(plane.rows() if _is_plane(space) else [])
        _write(found, folder, own)
        outcome.figures |= _figures(found, own, frame, drawn)

    return run_stage(
        "diversity",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=config,
        libraries=("numpy", "openTSNE", "pandas", "scikit-learn", "scipy"),
    )


def _made_with(record: Record, generated: Path) -> dict[str, Any]:
    """Return the sections of the configuration that the generated designs were made with."""
    mode = record.configuration.get("mode")
    if mode is not None:
        # Beside generators that draw as they come, its figures would say little of its own.
        raise InputError(
            f"generated = {generated} must hold the designs as they come, but has only those "
            f"of mode = {mode}."
        )
    return part(completed(record.configuration), "generate")


def _check(config: Mapping[str, Any], method: Mapping[str, Any], size: int) -> None:
    few = config["diversity"]["plane_designs"]
    if few > size:
        raise InputError(
            f"diversity.plane_designs = {few} must be at most the number of training designs, "
            f"{size}."
        )
    check_perplexity(method, few, "diversity.plane_designs")
    for key in ("components", "largest_components"):
        # The plane of a few designs would be without the very generator it is made for.
        if (value := config["generator"][key]) != "bic" and value > few:
            raise InputError(
                f"diversity.plane_designs = {few} must be at least generator.{key} = {value}, "
                "with which the designs were generated."
            )


@dataclass(frozen=True, eq=False, slots=True)
class _Drawn:
    """What each generator gave, and why others gave nothing."""

    given: dict[str, Generated] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)


def _draw(
    names: Iterable[str], space: Embedding, config: Mapping[str, Any], count: int, seed: int
) -> _Drawn:
    drawn, rules = _Drawn(), rules_of(config)
    for name in names:
        section = {**config["generator"], "method": name}
        try:
            generator = make_generator(section, rules).fit(space, seed)
            drawn.given[name] = generate(
                generator,
                count,
                training=space.designs,
                rules=rules,
                seed=seed,
                least_novelty=section["least_novelty"],
            )
        except InputError as error:
            # Resampling, for one, cannot give more designs than there are.
            drawn.left_out[name] = str(error)
    return drawn


def _is_plane(space: Embedding) -> bool:
    return bool(space.points.shape[1] == 2)


def _places(frame: pd.DataFrame) -> FloatArray | None:
    """Return where generated designs were drawn in the plane, if they were."""
    found = frame[["z1", "z2"]].to_numpy(np.float64)
    return found if np.isfinite(found).all() else None


def _candidate(space: Embedding, frame: pd.DataFrame, points: FloatArray | None) -> Candidate:
    if not _is_plane(space):
        points = None
    elif points is None:
        points = space.transform(frame)
    modes = frame["mode"].to_numpy()
    return Candidate(encoded=space.encoder.transform(frame), modes=modes, plane=points)


def _compared(
    space: Embedding, candidates: Mapping[str, Candidate], settings: Mapping[str, Any]
) -> Comparison:
    counts = {name.name: settings[name.name] for name in fields(Settings) if name.name in settings}
    training = _candidate(space, space.designs, space.points)
    places = places_of_mode(space.encoder.get_feature_names_out())
    return compare(candidates, training, Settings(**counts), settings["seed"], places)


@dataclass(frozen=True, eq=False, slots=True)
class _PlaneOfFew:
    """The paper's own measure: designs generated in the plane of a few training designs."""

    designs: pd.DataFrame
    method: Mapping[str, Any]
    config: Mapping[str, Any]
    count: int
    threads: int

    def rows(self) -> list[dict[str, Any]]:
        """Return the novelty over seeds: the configured generator, plain EM, random designs."""
        settings = self.config["diversity"]
        seeds = range(settings["seed"], settings["seed"] + settings["plane_seeds"])
        return plane_novelty_over_seeds(self._one, seeds).rows()

    def _one(self, seed: int) -> tuple[FloatArray, dict[str, FloatArray]]:
        rng = np.random.default_rng(seed)
        few = rng.choice(len(self.designs), self.config["diversity"]["plane_designs"], False)
        training = self.designs.iloc[np.sort(few)].reset_index(drop=True)
        space = make_embedding(self.method, self.threads).fit(training, seed)
        names = dict.fromkeys((self.config["generator"]["method"], "gmm_plain", "random"))
        drawn = _draw(names, space, self.config, self.count, seed).given
        return space.points, {
            name: space.transform(each.designs) if each.points is None else each.points
            for name, each in drawn.items()
        }


def _write(found: Comparison, folder: Path, own: str) -> None:
    content = {"generator": own, **found.as_dict()}
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    write_text(folder / DIVERSITY_NAME, text + "\n")
    rows = [{**row, "better": METRICS[row["metric"]].better} for row in found.rows]
    # The configured generator first, the yardstick last.
    rows.sort(key=lambda row: (row["generator"] != own, row["generator"] == TRAINING))
    write_rows(folder / COMPARISON_NAME, COMPARISON, rows)
    for name, columns, parts in (
        (HULL_NAME, HULLS, found.hull_areas()),
        (POINTS_NAME, HULL_POINTS, found.hull_points()),
    ):
        write_rows(folder / name, columns, [row for row in parts if row["generator"] == own])


def _figures(found: Comparison, own: str, frame: pd.DataFrame, drawn: _Drawn) -> dict[str, Any]:
    """Return the figures that people ask for first; all others are in the tables."""
    first = {
        f"{metric}_{space}": {
            row["generator"]: row["value"]
            for row in found.rows
            if (row["metric"], row["space"], row["mode"]) == (metric, space, "all")
        }
        for metric, space in _FIRST
    }
    shares = {name: each.report["mode_share"] for name, each in drawn.given.items()}
    own_shares = frame["mode"].value_counts(normalize=True).to_dict()
    return {
        "generator": own,
        "designs": len(frame),
        **first,
        "mode_share": {own: own_shares} | shares,
        "reports": {name: each.report for name, each in drawn.given.items()},
        "left_out": drawn.left_out,
    }


_FIRST = (
    ("novelty", "plane_sample"),
    ("novelty", "plane"),
    ("novelty", "encoded"),
    ("hull_ratio", "plane"),
    ("coverage", "encoded"),
)
