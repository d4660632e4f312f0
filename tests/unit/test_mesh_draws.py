import numpy as np
import pytest

from pagd.errors import InputError, StageFailure
from pagd.mesh.draws import first_good_mesh
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh


def flattened(size: float) -> Mesh:
    """A cube of that height: the flatter, the worse its elements."""
    if size > 4.0:
        raise InputError(f"{size:g} is too large.")
    return box((1.0, 1.0, size), (1, 1, 1))


def height(*sizes: float, wanted: float) -> float:
    mesh = first_good_mesh(flattened, sizes, wanted)
    return float(np.ptp(mesh.points[:, 2]))


def test_first_mesh_that_is_good_enough_is_taken() -> None:
    assert height(0.5, 1.0, wanted=0.3) == 0.5


def test_later_sizes_are_tried_where_the_first_fails_or_is_poor() -> None:
    assert height(9.0, 0.01, 0.5, 1.0, wanted=0.3) == 0.5


def test_best_of_poor_meshes_is_kept() -> None:
    assert height(0.01, 0.2, 9.0, 0.1, wanted=0.9) == 0.2


def test_last_reason_is_given_where_nothing_succeeds() -> None:
    with pytest.raises(StageFailure, match="6 is too large"):
        first_good_mesh(flattened, [9.0, 6.0], 0.1)
