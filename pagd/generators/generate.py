"""From proposals to designs: valid ones, none twice, none a copy of a training design."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial import KDTree

from pagd.dataset.frame import completed, designs_of, frame_of
from pagd.design import MODES, Design, GeometryRules, Mode, violations
from pagd.encoding import Encoder
from pagd.errors import InputError
from pagd.generators.interface import Generator, Proposal
from pagd.long_work import long_work

__all__ = ["Generated", "generate"]

FloatArray = NDArray[np.float64]

# A generator that gives no usable design in so many proposals on end is given up.
_HOPELESS = 10_000
_SMALLEST_ROUND = 100
# Designs that differ, by 0.01 mm at least, are farther apart than this.
_EQUAL = 1e-6


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Generated:
    """Generated designs.

    designs: table of n designs g0001 … in the order they were drawn.
    points: (n, d) their places in the reduced space, None where the generator has none.
    components: (n,) index of the Gaussian each was drawn from, or None.
    report: how many were proposed, and why others were not taken; share of each mode.
    """

    designs: pd.DataFrame
    points: FloatArray | None
    components: NDArray[np.int64] | None
    report: dict[str, Any]


def generate(
    generator: Generator,
    count: int,
    *,
    training: pd.DataFrame,
    rules: GeometryRules | None = None,
    seed: int = 1,
    mode: Mode | None = None,
    least_novelty: float = 0.1,
) -> Generated:
    """Draw designs until there are ``count`` usable ones.

    Parameters
    ----------
    generator
        A fitted generator.
    count
        Number of designs.
    training
        Table of the training designs, of which no copy is taken unless the generator's nature is
        to copy.
    rules
        What makes a design valid; the same as in the geometry.
    seed
        Of the draw.
    mode
        Take designs of this mode only.
    least_novelty
        What is nearer than this to a training design, in the encoded space, counts as a copy of
        it: 0.1 of a standard deviation is some tenths of a millimetre in one size.

    Raises
    ------
    InputError
        If count or mode is unusable, or the generator gives (nearly) no usable designs, and why
        they were refused.
    """
    _check(count, mode)
    sieve = _Sieve(generator, training, rules or GeometryRules(), mode, least_novelty)
    rng = np.random.default_rng(seed)
    with long_work(generator.name, count, "designs") as shown:
        while (left := count - len(sieve.taken)) > 0:
            sieve.take(generator.propose(max(left, _SMALLEST_ROUND), rng), count)
            shown.reach(len(sieve.taken))
            if sieve.in_vain >= _HOPELESS:
                raise InputError(_complaint(generator, count, sieve, mode))
    return sieve.result()


def _check(count: int, mode: str | None) -> None:
    if count < 1:
        raise InputError(f"generator.designs = {count} must be at least 1.")
    if mode is not None and mode not in MODES:
        raise InputError(f"mode = {mode!r} must be one of {', '.join(MODES)}.")


@dataclass(slots=True)
class _Sieve:
    """Takes what is usable of proposals, and counts the rest by reason."""

    generator: Generator
    training: pd.DataFrame
    rules: GeometryRules
    mode: Mode | None
    least_novelty: float
    taken: list[Design] = field(default_factory=list)
    points: list[FloatArray] = field(default_factory=list)
    components: list[int] = field(default_factory=list)
    seen: set[Design] = field(default_factory=set)
    tally: Counter[str] = field(default_factory=Counter)
    in_vain: int = 0
    redrawn: int = 0
    broken: Counter[str] = field(default_factory=Counter)
    corrections: Counter[str] = field(default_factory=Counter)

    encoder: Encoder = field(init=False)
    tree: KDTree = field(init=False)

    def __post_init__(self) -> None:
        self.encoder = Encoder().fit(self.training)
        self.tree = KDTree(self.encoder.transform(self.training))

    def take(self, proposal: Proposal, count: int) -> None:
        """Take what is usable of a proposal, as long as there are fewer than ``count``."""
        designs = designs_of(proposal.parameters)
        far = self._is_new(designs)
        for i, design in enumerate(designs):
            self.tally["proposed"] += 1
            self._note(proposal, i)
            reason = self._refusal(design, bool(far[i]))
            if reason is not None:
                self.tally[reason] += 1
                self.in_vain += 1
                continue
            self.in_vain = 0
            self.seen.add(design)
            self.taken.append(design)
            if proposal.points is not None:
                self.points.append(proposal.points[i])
            if proposal.components is not None:
                self.components.append(int(proposal.components[i]))
            if len(self.taken) == count:
                return

    def _note(self, proposal: Proposal, row: int) -> None:
        """Count what it took to make a row of a proposal."""
        if proposal.corrected is not None:
            self.corrections.update(proposal.corrected.columns[proposal.corrected.iloc[row]])
        if proposal.redrawn is not None:
            self.redrawn += int(proposal.redrawn[row])

    def _is_new(self, designs: list[Design]) -> NDArray[np.bool_]:
        """Whether each design is at least so far from every training design as is asked for."""
        if self.generator.copies_training:
            return np.ones(len(designs), dtype=np.bool_)
        frame = frame_of(designs, map(str, range(len(designs))), "generated")
        distances, _ = self.tree.query(self.encoder.transform(frame))
        return np.asarray(distances >= max(self.least_novelty, _EQUAL))

    def _refusal(self, design: Design, is_new: bool) -> str | None:
        if self.mode not in (None, design.mode):
            return "other_mode"
        keys = {violation.key for violation in violations(design, self.rules)}
        if keys:
            self.broken.update(keys)
            return "invalid"
        if not is_new:
            return "copies_of_training"
        return "duplicates" if design in self.seen else None

    def result(self) -> Generated:
        """Return what was taken."""
        ids = (f"g{i:04d}" for i in range(1, len(self.taken) + 1))
        parameters = pd.DataFrame([design.as_dict() for design in self.taken])
        designs = completed(parameters, ids, "generated")
        return Generated(
            designs=designs,
            points=np.array(self.points) if self.points else None,
            components=np.array(self.components, dtype=np.int64) if self.components else None,
            report=self.report(designs),
        )

    def report(self, designs: pd.DataFrame) -> dict[str, Any]:
        """Return the counts of a run, for its record."""
        reasons = ("invalid", "copies_of_training", "duplicates", "other_mode")
        modes = designs["mode"].value_counts()
        return {
            "designs": len(designs),
            "proposed": self.tally["proposed"],
            "refused": {reason: self.tally[reason] for reason in reasons},
            "refused_by_parameter": dict(sorted(self.broken.items())),
            "redrawn_by_generator": self.redrawn,
            "corrections": dict(sorted(self.corrections.items())),
            "mode_share": {mode: float(modes.get(mode, 0) / len(designs)) for mode in MODES},
        }


def _complaint(generator: Generator, count: int, sieve: _Sieve, mode: Mode | None) -> str:
    wanted = f"{mode} designs" if mode else "designs"
    reasons = {
        "invalid": "cannot be built",
        "copies_of_training": "are copies of training designs",
        "duplicates": "are there already",
        "other_mode": "have another mode",
    }
    why = [f"{sieve.tally[key]} {text}" for key, text in reasons.items() if sieve.tally[key]]
    return (
        f"generator.method = {generator.name} must give {count} {wanted}, but gave "
        f"{len(sieve.taken)} in {sieve.tally['proposed']} proposals: {', '.join(why)}."
    )
