"""A small data set for tests: as many bending as twisting designs, in one table."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pandas as pd

from pagd.catalogue import read_designs
from pagd.dataset.frame import frame_of
from pagd.dataset.sampling import sample_designs
from pagd.design import GeometryRules
from pagd.embedding.tsne import TSNE

TABLE2 = Path(__file__).parents[2] / "config" / "table2.csv"
TABLE2_BENDING, TABLE2_MIXED = (
    read_designs({"table2": str(TABLE2)})[name].design for name in ("bending", "mixed")
)


@functools.cache
def training() -> pd.DataFrame:
    """Return a data set of 240 designs; do not change it."""
    count, rng, rules = 240, np.random.default_rng(5), GeometryRules()
    designs = [
        *sample_designs(count // 2, "bending", rules, rng).designs,
        *sample_designs(count // 2, "twisting", rules, rng).designs,
    ]
    return frame_of(designs, [f"d{i:05d}" for i in range(count)], "random")


@functools.cache
def plane() -> TSNE:
    """Return the t-SNE plane of :func:`training`; do not change it."""
    return TSNE(perplexity=15, threads=1).fit(training(), seed=3)
