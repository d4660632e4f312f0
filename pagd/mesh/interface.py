"""The seam behind which meshers sit, and the ones there are."""

from __future__ import annotations

from importlib import import_module
from typing import Protocol, cast

from pagd.errors import InputError
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.types import Mesh

__all__ = ["MESHERS", "STRUCTURED", "Mesher", "mesher_named"]

#: The mesher that divides a design itself into blocks; it takes no surfaces.
STRUCTURED = "structured"

#: Meshers by name, as module:attribute, so that only the one that is used is imported.
MESHERS = {
    "gmsh": "pagd.mesh.gmsh_mesher:GmshMesher",
    "ftetwild": "pagd.mesh.ftetwild_mesher:FTetWildMesher",
}


class Mesher(Protocol):
    """Makes a mesh with named surfaces of the solid that a pair of surfaces encloses."""

    @property
    def name(self) -> str:
        """Name for records."""

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        """Mesh the solid with elements of about ``size`` (mm).

        Raises
        ------
        StageFailure
            ``mesh_failed``, with the reason, if it does not succeed.
        """


def mesher_named(name: str) -> Mesher:
    """Return the mesher of that name; one of one's own is named as ``module:class``.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    module, _, attribute = MESHERS.get(name, name).partition(":")
    try:
        return cast(Mesher, getattr(import_module(module), attribute)())
    except (ImportError, AttributeError, ValueError) as error:
        raise InputError(
            f"mesher = {name!r}: must be {' or '.join(MESHERS)}, or a module:class that can be "
            f"imported ({error})."
        ) from error
