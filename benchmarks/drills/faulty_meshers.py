"""Meshers that fail on slanted designs only, to be named as ``drills.faulty_meshers:…``."""

from __future__ import annotations

import time

import numpy as np

from pagd.mesh.gmsh_mesher import GmshMesher
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.types import Mesh

# Slanted designs of a drill are 16 mm wide, straight ones 15 mm, or half of it where they are cut.
_WIDE_MM = 15.5


def _is_slanted(surfaces: SurfacePair) -> bool:
    return float(np.ptp(surfaces.body.points[:, 1])) > _WIDE_MM


class Hanging:
    """Never comes back."""

    name = "hanging"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        """Mesh a straight design; wait for an hour on a slanted one."""
        if _is_slanted(surfaces):
            time.sleep(3600)
        return GmshMesher()(surfaces, size)


class Swelling:
    """Takes all the memory that there is."""

    name = "swelling"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        """Mesh a straight design; take 100 MB more ten times a second on a slanted one."""
        held = []
        while _is_slanted(surfaces):
            held.append(np.ones(12_500_000))
            time.sleep(0.1)
        return GmshMesher()(surfaces, size)
