"""Ways to a mixed mode from a data set that has none, in one plane: what each of them gives.

    python benchmarks/bridge.py [--size 11000] [--designs 4000]

- EM with K Gaussians and nothing else;
- the barycentre of the two categories' Gaussians as a third one, which pagd uses;
- a Gaussian with mean and covariance of the whole transport path from the one to the other;
- the barycentre, each point decoded not from the designs nearest to it, but from those nearest to
  the two points of the islands that the transport takes there.

Printed: the share of mixed designs in all, and of the mixed ones how evenly the share of helical
chambers spreads over five bins and how far two of them are apart on average, in standard deviations
of the training designs.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.distance import pdist

from pagd import TSNE, make_dataset
from pagd.catalogue import read_designs
from pagd.dataset.frame import INDEPENDENT, completed
from pagd.generators.mixture import Mixture, barycentre, fit_mixture

TABLES = {"table2": "config/table2.csv", "published": "config/published_designs.csv"}
COMPARED = [symbol for symbol in INDEPENDENT if symbol != "alpha"]

FloatArray = NDArray[np.float64]


def main() -> None:
    """Print one row a way."""
    options = _options()
    plane = TSNE().fit(
        make_dataset(options.size, published=[*read_designs(TABLES).values()]).designs
    )
    print("way                       mixed   alpha in fifths of 0…1        mean distance")
    for name, parameters in _ways(plane, options.designs):
        print(_row(name, completed(parameters, map(str, range(len(parameters))), ""), plane))


def _ways(plane: TSNE, count: int) -> Iterator[tuple[str, pd.DataFrame]]:
    rng, slanted = np.random.default_rng(1), (plane.designs["N1"] > 0).to_numpy()
    for components in (2, 3, 6, 10):
        plain = fit_mixture(plane.points, slanted, components, bridge_share=0.0)
        points, _ = plain.sample(count, rng)
        yield f"EM, K = {components}", plane.decode(points).parameters
    first, second = (_moments(plane.points[kind]) for kind in (~slanted, slanted))
    middle = barycentre(first, second)
    points = _sampled(*middle, count, rng)
    yield "barycentre", plane.decode(points).parameters
    yield (
        "whole transport path",
        plane.decode(_sampled(*_path(first, second), count, rng)).parameters,
    )
    yield "barycentre, transported", _transported(plane, points, middle, first, second)


def _moments(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    return points.mean(axis=0), np.cov(points, rowvar=False)


def _sampled(
    mean: FloatArray, covariance: FloatArray, count: int, rng: np.random.Generator
) -> FloatArray:
    one = Mixture(weights=np.ones(1), means=mean[None], covariances=covariance[None])
    return one.sample(count, rng)[0]


def _path(
    first: tuple[FloatArray, FloatArray], second: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Mean and covariance of the points x + s (A x − x), s even in 0…1, x of the first."""
    (mean_1, covariance_1), (mean_2, _) = first, second
    a = _map(first, second)
    once = a @ covariance_1
    covariance = covariance_1 / 3 + (once + once.T) / 6 + a @ covariance_1 @ a / 3
    gap = mean_2 - mean_1
    return (mean_1 + mean_2) / 2, covariance + np.outer(gap, gap) / 12


def _map(first: tuple[FloatArray, FloatArray], second: tuple[FloatArray, FloatArray]) -> FloatArray:
    """Matrix of the transport: the symmetric A with A S_1 A = S_2, of the barycentre's M."""
    # The barycentre is M S_1 M with M = (I + A) / 2, so that M is the transport to it.
    values, vectors = np.linalg.eigh(first[1])
    root, inverse = ((vectors * values**power) @ vectors.T for power in (0.5, -0.5))
    inner, turned = np.linalg.eigh(root @ second[1] @ root)
    return np.asarray(inverse @ (turned * np.sqrt(inner)) @ turned.T @ inverse)


def _transported(
    plane: TSNE,
    points: FloatArray,
    middle: tuple[FloatArray, FloatArray],
    first: tuple[FloatArray, FloatArray],
    second: tuple[FloatArray, FloatArray],
) -> pd.DataFrame:
    """Blend what decodes from either island's end of the transport, alpha as at the point."""
    found = plane.decode(points).parameters
    ends = [
        plane.decode((points - middle[0]) @ _map(middle, island) + island[0]).parameters
        for island in (first, second)
    ]
    alpha = found["alpha"].to_numpy()[:, None]
    blend = (1 - alpha) * ends[0][list(INDEPENDENT)] + alpha * ends[1][list(INDEPENDENT)]
    blend["N"] = np.floor(blend["N"] + 0.5).astype(int)
    return blend.assign(alpha=found["alpha"], theta=ends[1]["theta"])


def _row(name: str, designs: pd.DataFrame, plane: TSNE) -> str:
    mixed = designs[designs["mode"] == "mixed"]
    share = f"{100 * len(mixed) / len(designs):5.1f} %"
    if len(mixed) < 2:
        return f"{name:<24} {share}"
    fifths = np.histogram(mixed["alpha"], bins=5, range=(0, 1))[0] / len(mixed)
    spread = plane.encoder.spreads[COMPARED].to_numpy()
    distance = pdist(mixed[COMPARED].to_numpy(np.float64)[:1000] / spread).mean()
    return f"{name:<24} {share}   {' '.join(f'{f:.2f}' for f in fifths)}      {distance:.2f}"


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=11_000, help="designs (default: %(default)s)")
    parser.add_argument("--designs", type=int, default=4000, help="samples (default: %(default)s)")
    return parser.parse_args()


if __name__ == "__main__":
    main()
