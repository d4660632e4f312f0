"""Generated designs against the training designs, with one method for all generators."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.diversity.comparison import TRAINING, Comparison
from pagd.diversity.hull import HullComparison
from pagd.diversity.measuring import Subject, hulls_of, known, newcomer, rows_of
from pagd.diversity.spaces import Counts, Space, encoded_space, plane_space
from pagd.diversity.spread import JITTER
from pagd.errors import InputError
from pagd.long_work import counted

__all__ = ["Candidate", "Settings", "compare", "places_of_mode"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Candidate:
    """Designs to judge: vectors (n, d), modes (n,), places (n, 2) in the plane if they have any.

    Places are those of the embedding; they are scaled to the unit square here.
    """

    encoded: FloatArray
    modes: Sequence[str] | NDArray[Any]
    plane: FloatArray | None = None

    def __post_init__(self) -> None:
        lengths = {len(self.encoded), len(self.modes)}
        lengths |= set() if self.plane is None else {len(self.plane)}
        if len(lengths) > 1:
            raise ValueError(f"vectors, modes and places are not of one length: {sorted(lengths)}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """How a comparison is made.

    hull_designs, hull_repeats: size and number of the random sets for hulls and spread.
    neighbours: k of density and coverage.
    sample: most designs taken of each generator for density, coverage and discrepancy.
    components: principal components that hulls of encoded designs are taken in.
    """

    hull_designs: int = 50
    hull_repeats: int = 200
    neighbours: int = 5
    sample: int = 1000
    components: int = 4


def places_of_mode(names: Sequence[str] | NDArray[Any]) -> list[int]:
    """Return which places of an encoded vector tell the mode, from the names of all places."""
    return [
        place
        for place, name in enumerate(names)
        if name in {"alpha", "N1", "N2"} or str(name).startswith("mode_")
    ]


def compare(
    candidates: Mapping[str, Candidate],
    training: Candidate,
    settings: Settings | None = None,
    seed: int = 1,
    mode_places: Sequence[int] = (),
) -> Comparison:
    """Measure the designs of every generator, and the training designs as the yardstick.

    The nearest training design is looked for among all of them. For the rest, all generators are
    compared by equal counts: as many as the smallest has, at most ``settings.sample`` and half of
    the training designs; the other half stands for the yardstick. Every generator meets the same
    random training designs.

    Parameters
    ----------
    candidates
        Generator to its designs.
    training
        The training designs; with places, if there is to be a comparison in the plane.
    settings
        Counts.
    seed
        Of all random sets.
    mode_places
        Which places of an encoded vector tell the mode (`places_of_mode`), for the metric
        ``mode_part``; none: it is left out.

    Raises
    ------
    InputError
        If there are too few designs.
    ValueError
        If a candidate has the name of the yardstick.
    """
    if TRAINING in candidates:
        raise ValueError(f"{TRAINING!r} is the name of the yardstick")
    settings = settings or Settings()
    counts = _counts(candidates, training, settings)
    spaces = [encoded_space(training.encoded, settings.components, counts, seed, mode_places)]
    if training.plane is not None:
        spaces.append(plane_space(training.plane, counts, seed))
    rows: list[dict[str, Any]] = []
    hulls: dict[str, HullComparison] = {}
    for space in spaces:
        subjects = _subjects(space, candidates, training, counts, seed)
        whole = 1 + len(candidates)
        for name, subject in counted(subjects, f"{space.name} space", whole, "generators"):
            found = hulls_of(space, subject, counts, seed)
            measured = rows_of(space, subject, found, counts, settings.neighbours, seed)
            rows += [{"generator": name, "space": space.name, **row} for row in measured]
            if space.name == "plane" and name != TRAINING:
                hulls[name] = found
    facts = asdict(settings) | counts._asdict() | {"seed": seed, "dpp_jitter": JITTER}
    return Comparison(rows, hulls, facts | {space.name: space.facts for space in spaces})


def _counts(candidates: Mapping[str, Candidate], training: Candidate, settings: Settings) -> Counts:
    sizes = {name: len(candidate.encoded) for name, candidate in candidates.items()}
    sizes["half of the training designs"] = len(training.encoded) // 2
    fewest = min(sizes, key=lambda name: sizes[name])
    sample = min(settings.sample, sizes[fewest])
    if sample <= settings.neighbours:
        raise InputError(
            f"diversity.neighbours = {settings.neighbours}: must be smaller than the number of"
            f" designs compared, {sample} ({fewest})."
        )
    return Counts(sample, min(settings.hull_designs, sample), settings.hull_repeats)


def _subjects(
    space: Space,
    candidates: Mapping[str, Candidate],
    training: Candidate,
    counts: Counts,
    seed: int,
) -> Iterator[tuple[str, Subject]]:
    yield TRAINING, known(space, np.asarray(training.modes))
    for name, candidate in candidates.items():
        given = candidate.plane if space.name == "plane" else candidate.encoded
        if given is not None:
            modes = np.asarray(candidate.modes)
            yield name, newcomer(space, given, modes, counts.sample, seed)
