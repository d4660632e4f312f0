"""Picture of a design's deformed shapes under pressure, coloured by strain."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pagd.figures.load import States, load_states
from pagd.figures.scene import Box, Camera, Image, Sheet, Wire, render
from pagd.figures.style import FAINT, INK, STRAIN_LABEL, STRAIN_MAP, kilopascals, new_figure, save
from pagd.figures.surface import Skin, sharp_edges, skin_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = [
    "VIEW",
    "Shapes",
    "add_strain_bar",
    "deformed_figure",
    "draw_deformed",
    "draw_triad",
    "strain_limit",
]

# From the side and the fixed end: a helix opens to this eye, an arc stays an arc.
VIEW = Camera((-0.4, -1.0, 0.4))
# At most so many pressures are drawn, in so many columns.
_MOST, _COLUMNS = 6, 3


@dataclass(frozen=True, eq=False, slots=True)
class Shapes:
    """The outer skin of a design in all its states, ready to draw.

    pressure_kPa: (p,); points: (p, v, 3) in mm; strain: (p, v).
    triangles: (t, 3); edges: (e, 2), sharp in the undeformed state.
    """

    pressure_kPa: FloatArray
    points: FloatArray
    strain: FloatArray
    triangles: IntArray
    edges: IntArray

    @classmethod
    def of(cls, states: States) -> Shapes:
        """Return the shapes of all states, a half model doubled."""
        skin: Skin = skin_of(states.mesh)
        rest = skin.vectors(states.mesh.points)
        points = np.stack([rest + skin.vectors(u) for u in states.displacement])
        strain = np.stack([skin.scalars(e) for e in states.strain])
        edges = sharp_edges(rest, skin.triangles)
        return cls(states.pressure_kPa, points, strain, skin.triangles, edges)

    def picture(self, state: int, camera: Camera, box: Box, scale: float, top: float) -> Image:
        """Return one state, coloured by strain from 0 to `top`; `scale` in pixels per mm."""
        points = self.points[state]
        shape = Sheet(
            points=points,
            triangles=self.triangles,
            values=self.strain[state],
            limits=(0.0, top),
        )
        lines = Wire(points=points, edges=self.edges, width=1.2, opacity=0.45)
        return render([shape, lines], camera, box, scale)

    def ghost(self, camera: Camera, box: Box, scale: float) -> Image:
        """Return the undeformed state in faint grey, to lie behind a deformed one."""
        rest = self.points[0]
        shape = Sheet(points=rest, triangles=self.triangles, colour=FAINT, opacity=0.12)
        lines = Wire(points=rest, edges=self.edges, colour=FAINT, opacity=0.4)
        return render([shape, lines], camera, box, scale)


def draw_deformed(design_folder: Path, out: Path) -> None:
    """Draw the deformed shapes of a design to a PNG file; InputError if it was not solved."""
    save(deformed_figure(design_folder.name, Shapes.of(load_states(design_folder))), out)


def deformed_figure(title: str, shapes: Shapes) -> Figure:
    """Return the picture of up to six states in small multiples of one camera and scale."""
    chosen = _chosen(shapes.pressure_kPa)
    box = VIEW.box(shapes.points[chosen]).widened(0.02)
    top = strain_limit([shapes])
    columns = min(_COLUMNS, len(chosen))
    rows = -(-len(chosen) // columns)
    width = 11.0 / columns
    figure = new_figure(11.0, rows * (width * box.height / box.width + 0.25) + 0.9)
    panels = figure.subplots(rows, columns, squeeze=False)
    # 150 dots an inch on paper, and half as many again for the eye that zooms in.
    scale = 225.0 * width / box.width
    ghost = shapes.ghost(VIEW, box, scale)
    for axes in panels.flat:
        axes.set_axis_off()
    for axes, state in zip(panels.flat, chosen, strict=False):
        axes.imshow(ghost)
        axes.imshow(shapes.picture(int(state), VIEW, box, scale, top))
        axes.set_title(kilopascals(shapes.pressure_kPa[state]))
    figure.suptitle(f"{title}: deformed shapes under pressure", fontweight="bold")
    add_strain_bar(figure, list(panels.flat), top)
    draw_triad(figure, VIEW)
    return figure


def strain_limit(designs: Sequence[Shapes]) -> float:
    """Return the top of the colour bar: what 99 % of the nodes do not pass in any last state.

    Corners are singular: their strain only tells how fine the mesh is.
    """
    top = max(float(np.percentile(shapes.strain[-1], 99.0)) for shapes in designs)
    return float(np.ceil(20.0 * top) / 20.0) or 0.05


def add_strain_bar(figure: Figure, axes: Sequence[Axes], top: float) -> None:
    """Add a colour bar of strain, 0…`top`, below the axes."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    bar = figure.colorbar(
        ScalarMappable(Normalize(0.0, top), STRAIN_MAP),
        ax=list(axes),
        location="bottom",
        shrink=0.5,
        aspect=40,
        pad=0.02,
        extend="max",
    )
    bar.set_label(STRAIN_LABEL)
    bar.outline.set_edgecolor(INK)


def draw_triad(figure: Figure, camera: Camera, left: float = 0.01, height: float = 0.1) -> None:
    """Draw the directions x, y and z at the lower edge of the figure.

    They begin at `left`, a share of its width; the lowest `height` of the figure is theirs.
    """
    length = 24.0  # points
    axes = figure.add_axes((left, 0.2 * height, 0.08, height))
    axes.set_axis_off()
    for image, name in zip(length * camera.project(np.eye(3)), "xyz", strict=True):
        axes.annotate(
            name,
            xy=(0.5, 0.2),
            xycoords="axes fraction",
            xytext=tuple(1.3 * image),
            textcoords="offset points",
            arrowprops={"arrowstyle": "<-", "color": FAINT, "shrinkA": 5, "shrinkB": 0},
            ha="center",
            va="center",
            fontsize=8,
        )


def _chosen(pressure_kPa: FloatArray) -> IntArray:
    """Return the states to draw: the unloaded one, the last, and evenly spaced ones between.

    Spaced by the way that the pressure has gone, up or, past a limit point, down.
    """
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(pressure_kPa)))])
    wanted = np.linspace(0.0, way[-1], min(_MOST, len(way)))
    return np.unique(np.abs(way - wanted[:, None]).argmin(axis=1))
