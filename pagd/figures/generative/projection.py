"""From the reduced space of a run, of whatever dimension, to the plane that is drawn.

Two coordinates are the plane. Of more principal components the first two are shown. Where no
reduction was asked for, the coordinates are the encoded parameters, two of which tell little:
these are shown in their own first two principal components.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.encoding import Encoder
from pagd.figures.generative.plane import Gaussian, in_plane
from pagd.figures.generative.results import (
    GenerativePaths,
    NothingToDraw,
    load_generated,
    load_mixture,
    load_training,
    settings_of,
)

__all__ = [
    "Plane",
    "gaussians_of",
    "load_gaussians",
    "load_generated_plane",
    "load_plane",
    "principal_axes",
]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Plane:
    """What is drawn: designs with z1 and z2, and how points of the reduced space come there.

    training: the training designs that have a point.
    method: of the embedding; None where unknown.
    axes: (d, 2), from points of the reduced space to the plane, once ``origin`` (d,) is taken off.
    encoder: makes points of designs where the reduced space is that of the encoded parameters.
    """

    training: pd.DataFrame
    method: str | None
    axes: FloatArray
    origin: FloatArray
    encoder: Encoder | None = None


def load_plane(paths: GenerativePaths) -> Plane:
    """Return the plane of the training designs.

    Raises
    ------
    NothingToDraw
        If there is no data set, or no two coordinates.
    """
    training = load_training(paths)
    method = settings_of(paths.embedding).get("embedding", {}).get("method")
    dimensions = sum(name[:1] == "z" and name[1:].isdigit() for name in training.columns)
    found = in_plane(training)
    if method != "none" or dimensions < 3:
        return Plane(found, method, np.eye(dimensions, 2), np.zeros(dimensions))
    points = found[[f"z{i + 1}" for i in range(dimensions)]].to_numpy(dtype=np.float64)
    origin, axes = points.mean(axis=0), principal_axes(points)
    return Plane(
        _placed(found, (points - origin) @ axes), method, axes, origin, Encoder().fit(found)
    )


def load_generated_plane(paths: GenerativePaths, plane: Plane) -> pd.DataFrame:
    """Return the generated designs in the plane.

    Raises
    ------
    NothingToDraw
        If there are none, or none has a place there.
    """
    generated = load_generated(paths)
    if plane.encoder is not None:
        points = plane.encoder.transform(generated)
        return _placed(generated, (points - plane.origin) @ plane.axes)
    try:
        return in_plane(generated)
    except NothingToDraw:
        raise NothingToDraw("The generated designs were not drawn in the plane.") from None


def gaussians_of(mixture: Mapping[str, Any], plane: Plane) -> list[Gaussian]:
    """Return the Gaussians of a mixture as the plane sees them; none if it is of another space.

    The projection of a Gaussian is a Gaussian, with mean m A and covariance A^T S A.
    """
    if not mixture.get("weights"):
        return []
    means = np.asarray(mixture["means"], dtype=np.float64)
    if means.ndim != 2 or means.shape[1] != len(plane.axes):
        return []
    covariances = np.asarray(mixture["covariances"], dtype=np.float64)
    return [
        Gaussian(
            (means[k] - plane.origin) @ plane.axes,
            plane.axes.T @ covariances[k] @ plane.axes,
            float(weight),
            k == mixture.get("bridge"),
        )
        for k, weight in enumerate(mixture["weights"])
    ]


def load_gaussians(paths: GenerativePaths, plane: Plane) -> list[Gaussian]:
    """Return the Gaussians of the mixture that was used; none for a generator without any."""
    return gaussians_of(load_mixture(paths), plane)


def principal_axes(points: FloatArray) -> FloatArray:
    """Return the first two principal axes (d, 2) of points (n, d).

    Each points to where its largest entry is positive, so that no picture is mirrored by chance.
    """
    _, _, rows = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    axes = rows[:2].T
    largest = axes[np.abs(axes).argmax(axis=0), np.arange(axes.shape[1])]
    signed: FloatArray = axes * np.where(largest < 0.0, -1.0, 1.0)
    return signed


def _placed(frame: pd.DataFrame, places: FloatArray) -> pd.DataFrame:
    return frame.assign(z1=places[:, 0], z2=places[:, 1])
