"""Picture of a design's geometry: cut open, and in three sections with dimensions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from pagd.design import Design
from pagd.errors import InputError
from pagd.families import Actuator, PneuNet, actuator_of
from pagd.figures.details import draw_details
from pagd.figures.load import load_design, stl_paths
from pagd.figures.overall import draw_overall
from pagd.figures.scene import Camera, Image, Sheet, Wire, render
from pagd.figures.style import BASE, CAVITY, CUT, ELASTOMER, PAPER, new_figure, save
from pagd.figures.surface import sharp_edges
from pagd.figures.views import draw_plan, draw_side

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_geometry", "geometry_figure", "read_geometry_figure"]

_VIEW = (0.35, -1.0, 0.62)
# Largest plan and side view, inches.
_WIDEST, _HIGHEST = 10.0, 3.0


def draw_geometry(design_folder: Path, out: Path) -> None:
    """Draw :func:`read_geometry_figure` to a PNG file."""
    save(read_geometry_figure(design_folder), out)


def read_geometry_figure(design_folder: Path) -> Figure:
    """Return the picture of a design's geometry, from its surfaces in geometry/ or repair/.

    Raises
    ------
    InputError
        If there are no surfaces: the geometry was refused.
    """
    pair = stl_paths(design_folder)
    if pair is None:
        raise InputError(f"{design_folder}: holds no surfaces of a body and a base to draw.")
    body, base = (_surface(path) for path in pair)
    return geometry_figure(design_folder.name, body, base, load_design(design_folder))


def geometry_figure(
    title: str, body: pv.PolyData, base: pv.PolyData, of: Design | Actuator | None
) -> Figure:
    """Return the picture of a body above the paper plane and a base below it (mm).

    Without a design, as for surfaces of one's own, the dimensions are left out.
    """
    design = actuator_of(of) if of else None
    length, width, height = (body.bounds[i + 1] - body.bounds[i] for i in (0, 2, 4))
    # Plan and side view on one scale: across the whole width, unless the body is short.
    scale = min(_WIDEST / length, _HIGHEST / max(width, height))
    heights = [3.8, *(scale * side + 0.6 for side in (width, height)), 2.8]
    heights = heights if design else heights[:3]
    figure = new_figure(11.0, sum(heights))
    rows = figure.add_gridspec(len(heights), 1, height_ratios=heights)
    space, plan, side = (figure.add_subplot(rows[i]) for i in range(3))
    space.imshow(_cut_open(body, base))
    space.set_axis_off()
    space.set_title(f"{title}: cut open along the middle; paper between body and base")
    draw_plan(plan, body, base, design)
    draw_side(side, body, base, design)
    if isinstance(design, PneuNet):
        draw_details(figure, rows[3], body, base, design.design)
    elif design:
        draw_overall(figure, rows[3], body, base, design)
    return figure


def _surface(path: Path) -> pv.PolyData:
    mesh = pv.read(path)
    if not isinstance(mesh, pv.PolyData) or mesh.n_points == 0:
        raise InputError(f"{path}: holds no triangles.")
    # STL keeps every triangle to itself.
    merged: pv.PolyData = mesh.merge_points()
    return merged


def _cut_open(body: pv.PolyData, base: pv.PolyData) -> Image:
    """Return a view of the half y > 0 of the body on the whole base, with the paper on it."""
    outside, cavity = _outside_and_cavity(body)
    capped = body.clip_closed_surface(normal="y", origin=(0.0, 0.0, 0.0))
    on_cut = np.abs(np.asarray(capped.cell_centers().points)[:, 1]) < 1e-6
    x0, x1, y0, y1, _, _ = body.bounds
    level = body.bounds[4]
    sheet = pv.Plane(
        center=((x0 + x1) / 2, (y0 + y1) / 2, level + 0.02), i_size=x1 - x0, j_size=y1 - y0
    )
    parts: list[Sheet | Wire] = []
    for surface, colour in (
        (outside.clip(normal="-y", origin=(0.0, 0.0, 0.0)), ELASTOMER),
        (cavity.clip(normal="-y", origin=(0.0, 0.0, 0.0)), CAVITY),
        (capped.extract_cells(on_cut).extract_surface(algorithm=None), CUT),
        (base, BASE),
        (sheet, PAPER),
    ):
        parts += _with_edges(surface, colour)
    camera = Camera(_VIEW)
    corners = np.array([[x, y, z] for x in (x0, x1) for y in (y0, y1) for z in base.bounds[4:]])
    points = np.vstack([corners, np.asarray(outside.points)])
    return render(parts, camera, camera.box(points).widened(0.01), 12.0)


def _outside_and_cavity(body: pv.PolyData) -> tuple[pv.PolyData, pv.PolyData]:
    """Return the component of the surface that surrounds all, and the rest."""
    labelled = body.connectivity()
    region = np.asarray(labelled.cell_data["RegionId"])
    x = np.asarray(labelled.cell_centers().points)[:, 0]
    outside = region[int(np.argmin(x))]
    split = [
        labelled.extract_cells(mask).extract_surface(algorithm=None)
        for mask in (region == outside, region != outside)
    ]
    return split[0], split[1]


def _with_edges(surface: pv.PolyData, colour: str) -> list[Sheet | Wire]:
    """Return a surface and its sharp edges; nothing for an empty one."""
    triangles = surface.triangulate().clean()
    if triangles.n_cells == 0:
        return []
    points = np.asarray(triangles.points, dtype=np.float64)
    faces = np.asarray(triangles.regular_faces, dtype=np.int64)
    return [
        Sheet(points=points, triangles=faces, colour=colour, smooth=False),
        Wire(points=points, edges=sharp_edges(points, faces), width=1.2, opacity=0.8),
    ]
