"""Picture of a mesh: cut open, its named surfaces in colours, and how good its elements are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pagd.figures.load import load_mesh
from pagd.figures.scene import Camera, Image, Sheet, Wire, render
from pagd.figures.style import BASE, CAVITY, CUT, ELASTOMER, INK, PAPER, new_figure, save
from pagd.figures.surface import cut_faces, is_half
from pagd.mesh.quality import element_jacobians, mesh_quality
from pagd.mesh.types import Mesh

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_mesh", "mesh_figure"]

BoolArray = NDArray[np.bool_]

_VIEW = (-0.35, -1.0, 0.62)
_COLOURS = {
    "outer": ELASTOMER,
    "cut": CUT,
    "symmetry": BASE,
    "cavity": CAVITY,
    "paper": PAPER,
    "fixed": "#b3362c",
    "tip": "#3f8f5b",
}
_LABELS = {"cut": "cut (elastomer)", "symmetry": "plane of symmetry"}
# The end of a half model from which everything above the paper is taken away, to show it.
_BARE_SHARE = 0.18


def draw_mesh(design_folder: Path, out: Path) -> None:
    """Draw the mesh of a design to a PNG file; InputError if there is none."""
    save(mesh_figure(design_folder.name, load_mesh(design_folder)), out)


def mesh_figure(title: str, mesh: Mesh) -> Figure:
    """Return the picture of a mesh."""
    faces = cut_faces(mesh, _kept(mesh))
    image = _picture(mesh, faces)
    heights = [11.0 * image.shape[0] / image.shape[1] + 0.3, 1.7]
    figure = new_figure(11.0, sum(heights))
    rows = figure.add_gridspec(2, 2, height_ratios=heights, width_ratios=[1.5, 1.0])
    space = figure.add_subplot(rows[0, :])
    space.imshow(image)
    space.set_axis_off()
    half = "half model, y ≥ 0, " if is_half(mesh) else ""
    space.set_title(f"{title}: {half}cut open down to the paper")
    _draw_legend(figure.add_subplot(rows[1, 0]), mesh, faces)
    _draw_quality(figure.add_subplot(rows[1, 1]), mesh)
    return figure


def _kept(mesh: Mesh) -> BoolArray:
    """Tell which tetrahedra (m,) to draw: what lies below the paper, and the half y > 0."""
    middles = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    length = float(mesh.points[:, 0].max())
    shown = middles[:, 1] > 0.0
    if is_half(mesh):
        shown = middles[:, 0] < (1.0 - _BARE_SHARE) * length
    if "paper" not in mesh.surfaces:
        return np.asarray(shown)
    level = float(mesh.points[mesh.nodes_of("paper"), 2].mean())
    return np.asarray(shown | (middles[:, 2] < level))


def _picture(mesh: Mesh, faces: dict[str, NDArray[np.int64]]) -> Image:
    parts: list[Sheet | Wire] = []
    for name, named in faces.items():
        if len(named) == 0:
            continue
        corners = named[:, :3]
        edges = np.unique(np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
        parts += [
            Sheet(points=mesh.points, triangles=corners, colour=_COLOURS[name], smooth=False),
            Wire(points=mesh.points, edges=edges, width=1.0, opacity=0.55),
        ]
    camera = Camera(_VIEW)
    return render(parts, camera, camera.box(mesh.points).widened(0.01), 12.0)


def _draw_legend(axes: Axes, mesh: Mesh, faces: dict[str, NDArray[np.int64]]) -> None:
    from matplotlib.patches import Patch

    # The tip faces away from the eye.
    names = [name for name, named in faces.items() if len(named) and name != "tip"]
    patches = [
        Patch(facecolor=_COLOURS[n], edgecolor=INK, linewidth=0.5, label=_LABELS.get(n, n))
        for n in sorted(names, key=list(_COLOURS).index)
    ]
    quality = mesh_quality(mesh)
    axes.legend(handles=patches, loc="upper left", ncols=3)
    axes.text(
        0.015,
        0.42,
        f"{quality.tets:,} quadratic tetrahedra, {quality.nodes:,} nodes, "
        f"{quality.volume_mm3:,.0f} mm³ of elastomer\n"
        f"scaled Jacobian: least {quality.scaled_jacobian_min:.2f}, "
        f"median {quality.scaled_jacobian_median:.2f}",
        va="top",
        linespacing=1.5,
        transform=axes.transAxes,
    )
    axes.set_axis_off()


def _draw_quality(axes: Axes, mesh: Mesh) -> None:
    axes.hist(element_jacobians(mesh), bins=40, range=(0.0, 1.0), color=ELASTOMER)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("scaled Jacobian")
    axes.set_ylabel("elements")
