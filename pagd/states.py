"""Deformed states of a design in one compact file: displacement and strain at every node."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.tables import STATES, read_table, write_table

__all__ = ["States", "read_states", "write_states"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class States:
    """States at the recorded pressures.

    pressure_kPa: (p,) pressures in the order of the path, where they may fall and come again.
    displacement: (p, n, 3) displacements of the mesh's nodes in mm.
    strain: (p, n) largest principal logarithmic strain at the nodes.
    """

    pressure_kPa: FloatArray
    displacement: FloatArray
    strain: FloatArray

    @classmethod
    def stacked(
        cls,
        pressure_kPa: Sequence[float],
        displacement: Sequence[FloatArray],
        strain: Sequence[FloatArray],
    ) -> States:
        """Make one of single states; there must be at least one."""
        return cls(
            pressure_kPa=np.asarray(pressure_kPa, dtype=np.float64),
            displacement=np.stack(displacement),
            strain=np.stack(strain),
        )


def write_states(states: States, path: Path) -> None:
    """Write states to a Parquet file; lengths and strains keep seven digits (single precision)."""
    p, n, _ = states.displacement.shape
    ux, uy, uz = states.displacement.reshape(-1, 3).astype(np.float32).T
    columns = {
        "pressure_kPa": np.repeat(states.pressure_kPa, n),
        "node": np.tile(np.arange(n, dtype=np.int32), p),
        "ux": ux,
        "uy": uy,
        "uz": uz,
        "strain": states.strain.ravel().astype(np.float32),
    }
    write_table(path, STATES, columns)


def read_states(path: Path) -> States:
    """Read states; ``InputError`` if the file does not hold the same nodes for every state."""
    table = read_table(path)
    # A state begins at node 0: two may have the same pressure.
    p = int(np.count_nonzero(table["node"] == 0))
    n = len(table["node"]) // max(p, 1)
    if not _is_regular(table, p, n):
        raise InputError(f"{path}: the states do not all hold the same nodes in order.")
    displacement = np.column_stack([table[key] for key in ("ux", "uy", "uz")])
    return States(
        pressure_kPa=table["pressure_kPa"].reshape(p, n)[:, 0],
        displacement=displacement.reshape(p, n, 3).astype(np.float64),
        strain=table["strain"].reshape(p, n).astype(np.float64),
    )


def _is_regular(table: dict[str, NDArray[Any]], p: int, n: int) -> bool:
    """Tell whether a table holds p states of one pressure each, of nodes 0 to n - 1 in order."""
    if len(table["node"]) != p * n:
        return False
    node, pressure = (table[key].reshape(p, n) for key in ("node", "pressure_kPa"))
    return bool(np.all(node == np.arange(n)) and np.all(pressure == pressure[:, :1]))
