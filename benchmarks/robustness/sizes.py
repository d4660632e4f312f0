"""One size for whichever mesher takes a design."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["size_of", "sized"]


def sized(config: Mapping[str, Any], size_mm: float) -> dict[str, Any]:
    """Return a configuration with the same element size (mm) for blocks and for tetrahedra."""
    return {**config, "mesh": config["mesh"] | {"size_mm": size_mm, "block_mm": size_mm}}


def size_of(config: Mapping[str, Any]) -> float:
    """Return the element size (mm) of the mesher that is tried first."""
    mesh = config["mesh"]
    key = "block_mm" if mesh["meshers"][0] == "structured" else "size_mm"
    return float(mesh[key])
