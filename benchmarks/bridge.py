"""Ways to a mixed mode from a data set that has none, in one plane: what each of them gives.

    python benchmarks/bridge.py [--size 11000] [--designs 4000]

- EM with K Gaussians and nothing else;
- EM with two Gaussians, and with a third of the weight a bridge between the categories: the
  barycentre of their Gaussians, or a Gaussian with mean and covariance of the whole transport path
  from the one to the other;
- the barycentre again, each of its samples drawn until it decodes to a mixed design: pagd's way.

Printed, of samples of the whole mixture: the share of mixed designs; and of the mixed ones, how
evenly the share of helical chambers spreads over the fifths of 0…1, and how far two of them are
apart on average, in standard deviations of the training designs.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.distance import pdist

from pagd import TSNE, PlainMixture, ReducedSpaceMixture, make_dataset
from pagd.dataset.frame import INDEPENDENT, completed
from pagd.generators.mixture import Mixture, transport

COMPARED = [symbol for symbol in INDEPENDENT if symbol != "alpha"]

FloatArray = NDArray[np.float64]


def main() -> None:
    """Print one row a way."""
    options = _options()
    plane = TSNE().fit(make_dataset(options.size).designs)
    print(f"{'way':<30}  mixed   alpha in fifths of 0…1        mean distance")
    for name, parameters in _ways(plane, options.designs):
        print(_row(name, completed(parameters, map(str, range(len(parameters))), ""), plane))


def _ways(plane: TSNE, count: int) -> Iterator[tuple[str, pd.DataFrame]]:
    for components in (2, 3, 6, 10):
        plain = PlainMixture(components).fit(plane)
        yield f"EM, K = {components}", plain.propose(count, np.random.default_rng(1)).parameters
    bridged = ReducedSpaceMixture(3, largest_components=1).fit(plane)
    for name, mixture in (
        ("EM and barycentre", bridged.mixture),
        ("EM and whole path", _with_path(bridged.mixture, plane)),
    ):
        points, _ = mixture.sample(count, np.random.default_rng(1))
        yield name, plane.decode(points).parameters
    again = bridged.propose(count, np.random.default_rng(1))
    yield "EM and barycentre, drawn again", again.parameters


def _with_path(mixture: Mixture, plane: TSNE) -> Mixture:
    """The mixture with another bridge: all points x + s (A x − x), s even in 0…1."""
    slanted = (plane.designs["N1"] > 0).to_numpy()
    first, second = (plane.points[kind] for kind in (~slanted, slanted))
    covariance = np.cov(first, rowvar=False)
    a = transport(covariance, np.cov(second, rowvar=False))
    once = a @ covariance
    spread = covariance / 3 + (once + once.T) / 6 + a @ covariance @ a / 3
    gap = second.mean(axis=0) - first.mean(axis=0)
    covariances = mixture.covariances.copy()
    covariances[mixture.bridge] = spread + np.outer(gap, gap) / 12
    return replace(mixture, covariances=covariances)


def _row(name: str, designs: pd.DataFrame, plane: TSNE) -> str:
    mixed = designs[designs["mode"] == "mixed"]
    share = f"{100 * len(mixed) / len(designs):5.1f} %"
    if len(mixed) < 2:
        return f"{name:<30} {share}"
    fifths = np.histogram(mixed["alpha"], bins=5, range=(0, 1))[0] / len(mixed)
    spread = plane.encoder.spreads[COMPARED].to_numpy()
    distance = pdist(mixed[COMPARED].to_numpy(np.float64)[:1000] / spread).mean()
    return f"{name:<30} {share}   {' '.join(f'{f:.2f}' for f in fifths)}      {distance:.2f}"


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=11_000, help="designs (default: %(default)s)")
    parser.add_argument("--designs", type=int, default=4000, help="samples (default: %(default)s)")
    return parser.parse_args()


if __name__ == "__main__":
    main()
