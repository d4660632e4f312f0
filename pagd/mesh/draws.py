"""Several draws from a mesher: a sliver is chance, and a slightly different size another draw."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from pagd.errors import PagdError, StageFailure, Status
from pagd.mesh.quality import scaled_jacobians
from pagd.mesh.types import Mesh

__all__ = ["first_good_mesh"]


def first_good_mesh(make: Callable[[float], Mesh], sizes: Iterable[float], wanted: float) -> Mesh:
    """Return the first mesh without a worse scaled Jacobian than wanted, or else the best one.

    Parameters
    ----------
    make
        Makes a mesh of a size (mm); may raise PagdError.
    sizes
        Sizes to try, in this order.
    wanted
        Scaled Jacobian of the worst element at which no further size is tried.

    Raises
    ------
    StageFailure
        ``mesh_failed``, with the last reason, if none of the sizes gives a mesh.
    """
    best: tuple[float, Mesh] | None = None
    reason = "No size was tried."
    for size in sizes:
        try:
            mesh = make(size)
        except PagdError as error:
            reason = str(error)
            continue
        worst = float(scaled_jacobians(mesh.points, mesh.tets).min())
        if best is None or worst > best[0]:
            best = (worst, mesh)
        if worst >= wanted:
            break
    if best is None:
        raise StageFailure(Status.mesh_failed, reason)
    return best[1]
