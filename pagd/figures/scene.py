"""Shaded pictures of triangles, rendered offscreen with VTK: no display is needed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkLogger

from pagd.figures.style import INK, STRAIN_MAP

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Image = NDArray[np.uint8]

__all__ = ["Box", "Camera", "Sheet", "Wire", "render"]

# Without a display VTK tries X first, complains, and takes EGL or OSMesa. Errors still show.
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Sheet:
    """Triangles (t, 3) over points (v, 3), in one colour or coloured by values (v,)."""

    points: FloatArray
    triangles: IntArray
    colour: str = "white"
    values: FloatArray | None = None
    limits: tuple[float, float] = (0.0, 1.0)
    opacity: float = 1.0
    smooth: bool = True


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Wire:
    """Straight lines between the points (v, 3) of every pair (e, 2)."""

    points: FloatArray
    edges: IntArray
    colour: str = INK
    width: float = 1.0
    opacity: float = 1.0


@dataclass(frozen=True, slots=True)
class Box:
    """Rectangle on the screen in mm, to the right and up from the origin's image."""

    left: float
    right: float
    low: float
    high: float

    @property
    def width(self) -> float:
        """Width in mm."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """Height in mm."""
        return self.high - self.low

    def widened(self, share: float) -> Box:
        """Return the box with a margin, as a share of its larger side, all around."""
        m = share * max(self.width, self.height)
        return Box(self.left - m, self.right + m, self.low - m, self.high + m)


class Camera:
    """Parallel projection along a direction, with z upwards on the screen.

    Parameters
    ----------
    towards
        Direction (3,) from the object to the eye.
    """

    def __init__(self, towards: Sequence[float]) -> None:
        eye = np.asarray(towards, dtype=np.float64)
        self.eye = eye / np.linalg.norm(eye)
        right = np.cross([0.0, 0.0, 1.0], self.eye)
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.eye, self.right)

    def project(self, points: FloatArray) -> FloatArray:
        """Return the images (…, 2) of points (…, 3): mm to the right and up."""
        return np.asarray(np.stack([points @ self.right, points @ self.up], axis=-1))

    def box(self, points: FloatArray) -> Box:
        """Return the smallest box around the images of points (…, 3)."""
        flat = self.project(points).reshape(-1, 2)
        (left, low), (right, high) = flat.min(axis=0), flat.max(axis=0)
        return Box(float(left), float(right), float(low), float(high))


def render(parts: Sequence[Sheet | Wire], camera: Camera, box: Box, pixels_per_mm: float) -> Image:
    """Return the picture (height, width, 4) of what lies in a box of the screen, RGBA.

    The background is transparent.
    """
    size = tuple(max(round(side * pixels_per_mm), 16) for side in (box.width, box.height))
    plotter = pv.Plotter(off_screen=True, window_size=list(size), lighting="none")
    try:
        _add_lights(plotter, camera)
        for part in parts:
            _add(plotter, part)
        _aim(plotter, camera, box, parts)
        plotter.enable_anti_aliasing("ssaa")
        return np.asarray(plotter.screenshot(transparent_background=True, return_img=True))
    finally:
        plotter.close()


def _add(plotter: pv.Plotter, part: Sheet | Wire) -> None:
    if isinstance(part, Wire):
        lines = np.insert(part.edges, 0, 2, axis=1).ravel()
        plotter.add_mesh(
            pv.PolyData(part.points, lines=lines),
            color=part.colour,
            line_width=part.width,
            opacity=part.opacity,
            lighting=False,
        )
        return
    surface = pv.PolyData(part.points, faces=np.insert(part.triangles, 0, 3, axis=1).ravel())
    paint: dict[str, Any] = {"color": part.colour}
    if part.values is not None:
        surface["values"] = part.values
        paint = {"scalars": "values", "cmap": STRAIN_MAP, "clim": part.limits}
    actor = plotter.add_mesh(
        surface,
        opacity=part.opacity,
        smooth_shading=part.smooth,
        split_sharp_edges=part.smooth,
        feature_angle=35.0,
        show_scalar_bar=False,
        ambient=0.5,
        diffuse=0.7,
        specular=0.08,
        **paint,
    )
    # A little behind its own edges, which would otherwise come out dashed.
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0)


def _add_lights(plotter: pv.Plotter, camera: Camera) -> None:
    """Light from above the eye's left shoulder, and weaker ones from the eye and the right."""
    for towards, intensity in (
        (camera.eye + 1.2 * camera.up - 0.8 * camera.right, 0.5),
        (camera.eye, 0.45),
        (camera.eye - 0.4 * camera.up + 1.5 * camera.right, 0.2),
    ):
        light = pv.Light(position=tuple(towards), light_type="scene light", intensity=intensity)
        light.positional = False
        plotter.add_light(light)


def _aim(plotter: pv.Plotter, camera: Camera, box: Box, parts: Sequence[Sheet | Wire]) -> None:
    points = np.vstack([part.points for part in parts])
    depth = points @ camera.eye
    reach = 1.0 + float(np.ptp(depth))
    middle = (
        0.5 * (box.left + box.right) * camera.right
        + 0.5 * (box.low + box.high) * camera.up
        + float(depth.max()) * camera.eye
    )
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = tuple(middle)
    plotter.camera.position = tuple(middle + reach * camera.eye)
    plotter.camera.up = tuple(camera.up)
    plotter.camera.parallel_scale = 0.5 * box.height
    plotter.camera.clipping_range = (0.5 * reach, 3.0 * reach)
