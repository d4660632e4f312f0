"""Sections of the paper plane of a mesh, with or without a design behind it."""

from __future__ import annotations

import numpy as np

from pagd.mesh.types import Mesh
from pagd.sections import Sections, Stations, even_stations, place_sections

__all__ = ["even_stations_of", "sections_of"]


def even_stations_of(mesh: Mesh, count: int) -> Stations:
    """Return ``count`` evenly spaced stations over the length of the mesh's paper."""
    x = mesh.points[mesh.nodes_of("paper"), 0]
    return even_stations(float(np.ptp(x)), count, float(x.min()))


def sections_of(mesh: Mesh, stations: Stations) -> Sections:
    """Place stations in the paper of a mesh, be it whole or a half model."""
    mirrored = "symmetry" in mesh.surfaces
    return place_sections(mesh.points, mesh.surfaces["paper"], stations, mirrored=mirrored)
