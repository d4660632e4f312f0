"""The designs of the study, drawn as those of the data set are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import chain
from typing import Any, Final

import numpy as np

from pagd.catalogue import NamedDesign
from pagd.dataset import sample_designs
from pagd.dataset.category import CATEGORIES
from pagd.design import Design, violations
from pagd.stages.geometry import rules_of

__all__ = ["THIN_MM", "drawn_designs", "is_thin_walled", "mixed_designs"]

#: A side wall or a wall between chambers below this, in mm, makes a design thin-walled.
THIN_MM: Final = 1.5


def drawn_designs(count: int, seed: int, config: Mapping[str, Any]) -> list[NamedDesign]:
    """Return valid random designs of the sampling box, bending and twisting ones in turn.

    Parameters
    ----------
    count
        How many; fewer designs of an equal seed are the beginning of more.
    seed
        Each category has a stream of its own.
    config
        Completed configuration; uses ``channel`` and ``limits``, the rules of the geometry.
    """
    rules = rules_of(config)
    sequences = np.random.SeedSequence(seed).spawn(len(CATEGORIES))
    each = -(-count // len(CATEGORIES))
    categories = [
        sample_designs(each, category, rules, np.random.default_rng(sequence)).designs
        for category, sequence in zip(CATEGORIES, sequences, strict=True)
    ]
    in_turn = list(chain.from_iterable(zip(*categories, strict=True)))[:count]
    return [
        NamedDesign(name=f"r{number:04d}", origin="random", design=design)
        for number, design in enumerate(in_turn, start=1)
    ]


def mixed_designs(count: int, seed: int, config: Mapping[str, Any]) -> list[NamedDesign]:
    """Return valid random mixed rows: twisting designs of which a share of chambers is straight.

    Parameters
    ----------
    count
        How many; fewer designs of an equal seed are the beginning of more.
    seed, config
        As of :func:`drawn_designs`. The share α is uniform between those of one slanted chamber
        and of one straight one.
    """
    rules = rules_of(config)
    random = np.random.default_rng([seed, len(CATEGORIES)])
    found: list[Design] = []
    while len(found) < count:
        (slanted,) = sample_designs(1, "twisting", rules, random).designs
        share = round(float(random.uniform(1.0, slanted.N - 1.0)) / slanted.N, 4)
        mixed = replace(slanted, alpha=share)
        if mixed.mode == "mixed" and not violations(mixed, rules):
            found.append(mixed)
    return [
        NamedDesign(name=f"m{number:04d}", origin="random", design=design)
        for number, design in enumerate(found, start=1)
    ]


def is_thin_walled(design: Design) -> bool:
    """Whether a wall under pressure is thinner than :data:`THIN_MM`; such designs balloon."""
    return min(design.t, design.t_ab) < THIN_MM
