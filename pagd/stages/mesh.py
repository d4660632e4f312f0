"""Stage 3: quadratic tetrahedra with named surfaces."""

from __future__ import annotations

from pathlib import Path

__all__ = ["MESH_NAME", "mesh_file"]

MESH_NAME = "mesh.msh"


def mesh_file(mesh: Path) -> Path:
    """Return the mesh of the stage's folder, or the .msh file of one's own that is given."""
    return mesh / MESH_NAME if mesh.is_dir() else mesh
