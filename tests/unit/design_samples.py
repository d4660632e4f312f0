"""A small data set for tests: as many bending as twisting designs, in one table."""

from __future__ import annotations

import functools

import numpy as np
import pandas as pd

from pagd.dataset.frame import frame_of
from pagd.dataset.sampling import sample_designs
from pagd.design import Design, GeometryRules
from pagd.embedding.tsne import TSNE

TABLE2_MIXED = Design(
    L=8.01,
    W=15.12,
    H=12.98,
    t=1.49,
    t_n=2.8,
    t_h=4.07,
    t_ab=2.05,
    t_b=1.97,
    N=12,
    theta=27.2,
    alpha=0.5,
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
