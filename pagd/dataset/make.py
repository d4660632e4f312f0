"""The data set: random designs of both categories, known ones, and designs around those.

Row 1 of the paper's method: 11,000 designs of 16 parameters, of random sampling within bounds
and augmentation around published designs.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from numbers import Real
from typing import Any, Final

import numpy as np
import pandas as pd

from pagd.catalogue import NamedDesign, read_pneunets
from pagd.config import packaged_tables
from pagd.dataset.augmentation import interpolated_designs, jittered_designs
from pagd.dataset.category import CATEGORIES, Category, category_of
from pagd.dataset.frame import frame_of
from pagd.dataset.rejection import Sampled
from pagd.dataset.sampling import METHODS, Method, sample_designs
from pagd.design import Design, GeometryRules, violations
from pagd.errors import InputError

__all__ = ["PARTS", "Dataset", "make_dataset"]

#: How designs are drawn, in the order of the rows; also their origin.
PARTS: Final = ("random", "jitter", "interpolation")

_DEFAULT_RULES: Final = GeometryRules()


@dataclass(frozen=True, slots=True)
class Dataset:
    """The training designs.

    Attributes
    ----------
    designs
        A row a design, with the columns :data:`pagd.tables.DESIGNS` (lengths in mm, theta in
        degrees). First the known designs in the order given, then the bending and then the
        twisting ones, in either by :data:`PARTS`, and in these in the order drawn.
    report
        How they came about, ready for a record: see :func:`make_dataset`.
    """

    designs: pd.DataFrame
    report: dict[str, Any]


@dataclass(frozen=True, slots=True)
class _Plan:
    """How many designs of a category are drawn how, and what they are drawn around."""

    category: Category
    known: tuple[Design, ...]
    counts: Mapping[str, int]


def make_dataset(
    size: int = 11_000,
    *,
    published: Sequence[NamedDesign] | None = None,
    rules: GeometryRules = _DEFAULT_RULES,
    sampling: Method = "random",
    twisting_share: float = 0.5,
    augmented_share: float = 0.1,
    interpolated_share: float = 0.5,
    jitter: float = 0.05,
    seed: int = 1,
) -> Dataset:
    """Make the data set: exactly ``size`` valid designs, no two equal.

    Parameters
    ----------
    size
        Number of designs.
    published
        Known designs; None: the paper's own (Table 2) and the published actuators that come
        with pagd; an empty sequence: none. Those that bend or twist are rows themselves, with
        their own origin (a parameter that has no effect, as theta where nothing is slanted, set
        as in the rest of the category), and designs are drawn around them. Mixed ones are no
        category of the data set and are left out, as is what the rules refuse.
    rules
        The rules of the geometry, which every design keeps to.
    sampling
        How the box is sampled; see :func:`pagd.dataset.sample_designs`.
    twisting_share
        Share of twisting designs; the rest bends.
    augmented_share
        Share of the designs, in either category, that is drawn around known ones. A category
        without any is sampled at random instead.
    interpolated_share
        Share of those that is interpolated; the rest is jittered.
    jitter
        Standard deviation of the jitter, as a share of the width of the sampling box.
    seed
        Equal seeds give equal data sets. Each part of each category has a stream of its own,
        so that the size of one changes no design of another.

    Returns
    -------
    Dataset
        With a report of ``size``, ``seed`` and ``sampling``; by category and origin, of
        ``counts``, and of the designs ``drawn``, their ``acceptance`` (accepted by drawn), those
        ``rejected`` by rule, and ``duplicates`` drawn again; known designs ``left_out``, by name
        with the reason; and ``notes``, sentences on what could not be done as asked.

    Raises
    ------
    InputError
        Naming key, value and rule of what cannot be, or if the rules leave nothing to draw.
    """
    _check_numbers(size, jitter, seed)
    size, seed = int(size), int(seed)
    _check_shares(twisting_share, augmented_share, interpolated_share)
    if sampling not in METHODS:
        raise InputError(f"dataset.sampling = {sampling!r} must be one of {', '.join(METHODS)}.")
    sizes = _split(size, twisting_share, ("twisting", "bending"))
    if published is None:
        published = list(read_pneunets(packaged_tables()).values())
    known, left_out = _usable(published, rules, sizes)
    plans = [_plan(c, sizes[c], known, augmented_share, interpolated_share) for c in CATEGORIES]
    parts = _drawn(plans, known, rules, sampling, jitter, seed)
    report = {
        "size": size,
        "seed": seed,
        "sampling": sampling,
        **_tally(parts),
        "left_out": left_out,
        "notes": [
            _no_augmentation(plan)
            for plan in plans
            if augmented_share > 0 and sizes[plan.category] and not plan.known
        ],
    }
    frame = _frame(known, parts)
    return Dataset(frame, report | {"counts": _counts(frame)})


def _check_numbers(size: float, jitter: float, seed: float) -> None:
    _check_types({"size": size, "jitter": jitter, "seed": seed})
    for key, number, least in (("size", size, 1), ("seed", seed, 0)):
        # YAML and JSON may spell a whole number 1e4.
        if not float(number).is_integer() or number < least:
            raise InputError(
                f"dataset.{key} = {number!r} must be a whole number of at least {least}."
            )
    if not (math.isfinite(jitter) and jitter > 0):
        raise InputError(f"dataset.jitter = {jitter!r} must be a finite number greater than 0.")


def _check_shares(twisting: float, augmented: float, interpolated: float) -> None:
    shares = {"twisting": twisting, "augmented": augmented, "interpolated": interpolated}
    _check_types({f"{name}_share": share for name, share in shares.items()})
    for name, share in shares.items():
        if not 0 <= share <= 1:
            raise InputError(f"dataset.{name}_share = {share!r} must lie between 0 and 1.")


def _check_types(numbers: Mapping[str, object]) -> None:
    for key, number in numbers.items():
        if isinstance(number, bool) or not isinstance(number, Real):
            raise InputError(f"dataset.{key} = {number!r} must be a number.")


def _split(count: int, share: float, names: tuple[str, str]) -> dict[str, int]:
    """Split a number in two: the share for the first name, rounded, and the rest."""
    first = math.floor(share * count + 0.5)
    return {names[0]: first, names[1]: count - first}


def _usable(
    published: Sequence[NamedDesign], rules: GeometryRules, sizes: Mapping[str, int]
) -> tuple[list[NamedDesign], dict[str, str]]:
    """Return the known designs that belong in the data set, and why the others do not."""
    usable: dict[Design, NamedDesign] = {}
    left_out: dict[str, str] = {}
    for given in published:
        named = replace(given, design=_plain(given.pneunet))
        reason = _reason_against(named.pneunet, rules, sizes)
        if reason is None and named.pneunet in usable:
            reason = f"is the same design as {usable[named.pneunet].name}"
        if reason is None:
            usable[named.pneunet] = named
        else:
            left_out[named.name] = reason
    return list(usable.values()), left_out


def _plain(design: Design) -> Design:
    """Return the same actuator with what has no effect set as all of its category have it."""
    match category_of(design):
        case "bending":
            return replace(design, theta=0.0, alpha=0.0)
        case "twisting":
            return replace(design, alpha=1.0)
        case _:
            return design


def _reason_against(design: Design, rules: GeometryRules, sizes: Mapping[str, int]) -> str | None:
    broken = violations(design, rules)
    if broken:
        return "; ".join(map(str, broken))
    category = category_of(design)
    if category is None:
        return "is mixed, which is no category of the data set"
    return None if sizes[category] else f"the data set has no {category} designs"


def _plan(
    category: Category,
    size: int,
    named: Sequence[NamedDesign],
    augmented_share: float,
    interpolated_share: float,
) -> _Plan:
    known = tuple(n.pneunet for n in named if n.pneunet.mode == category)
    if size < len(known):
        raise InputError(
            f"dataset.size and dataset.twisting_share leave room for {size} {category} designs,"
            f" which must be at least the {len(known)} known ones."
        )
    drawn = size - len(known)
    augmented = min(math.floor(augmented_share * size + 0.5), drawn) if known else 0
    around = _split(augmented, interpolated_share, ("interpolation", "jitter"))
    return _Plan(category, known, {"random": drawn - augmented, **around})


def _drawn(
    plans: Sequence[_Plan],
    known: Sequence[NamedDesign],
    rules: GeometryRules,
    sampling: Method,
    jitter: float,
    seed: int,
) -> dict[tuple[Category, str], Sampled]:
    """Draw every part of every category that has any design, each of a stream of its own."""
    sequences = np.random.SeedSequence(seed).spawn(len(plans) * len(PARTS))
    taken = {named.pneunet for named in known}
    parts: dict[tuple[Category, str], Sampled] = {}
    for (plan, part), sequence in zip(product(plans, PARTS), sequences, strict=True):
        count, rng = plan.counts[part], np.random.default_rng(sequence)
        mode, around = plan.category, plan.known
        if not count:
            continue
        if part == "random":
            found = sample_designs(count, mode, rules, rng, sampling, taken=taken)
        elif part == "jitter":
            found = jittered_designs(count, around, mode, rules, rng, jitter=jitter, taken=taken)
        else:
            found = interpolated_designs(count, around, mode, rules, rng, taken=taken)
        parts[mode, part] = found
    return parts


def _frame(
    known: Sequence[NamedDesign], parts: Mapping[tuple[Category, str], Sampled]
) -> pd.DataFrame:
    rows = [(named.pneunet, named.origin) for named in known]
    rows += [(design, origin) for (_, origin), part in parts.items() for design in part.designs]
    return frame_of([design for design, _ in rows], _ids(len(rows)), [origin for _, origin in rows])


def _ids(count: int) -> Iterator[str]:
    digits = max(5, len(str(count)))
    return (f"d{number:0{digits}d}" for number in range(1, count + 1))


def _counts(frame: pd.DataFrame) -> dict[str, dict[str, int]]:
    pairs = Counter(zip(frame["mode"], frame["origin"], strict=True))
    return {
        category: {origin: n for (mode, origin), n in pairs.items() if mode == category}
        for category in CATEGORIES
    }


def _tally(parts: Mapping[tuple[Category, str], Sampled]) -> dict[str, Any]:
    """Return, for each thing to report, its value by category and origin."""
    report: dict[str, dict[str, dict[str, Any]]] = {
        key: {category: {} for category in CATEGORIES}
        for key in ("drawn", "acceptance", "rejected", "duplicates")
    }
    for (category, origin), part in parts.items():
        report["drawn"][category][origin] = part.drawn
        report["acceptance"][category][origin] = part.rate
        report["rejected"][category][origin] = dict(part.rejected.most_common())
        report["duplicates"][category][origin] = part.duplicates
    return report


def _no_augmentation(plan: _Plan) -> str:
    return (
        f"No known design is a {plan.category} one, so that all {plan.category} designs are"
        " sampled at random."
    )
