import dataclasses
from pathlib import Path

import numpy as np
import pytest

from pagd.errors import InputError
from pagd.states import States, read_states, write_states
from pagd.tables import STATES, read_table, write_table


@pytest.fixture
def states() -> States:
    rng = np.random.default_rng(1)
    moved = rng.normal(0.0, 50.0, (3, 7, 3))
    return States.stacked([5.0, 10.0, 12.5], list(moved), list(np.abs(moved[..., 0])))


def test_states_survive_the_file(states: States, tmp_path: Path) -> None:
    write_states(states, tmp_path / "states.parquet")
    read = read_states(tmp_path / "states.parquet")
    np.testing.assert_array_equal(read.pressure_kPa, states.pressure_kPa)
    np.testing.assert_allclose(read.displacement, states.displacement, rtol=1e-7)
    np.testing.assert_allclose(read.strain, states.strain, rtol=1e-7)


def test_states_keep_the_order_of_the_path(states: States, tmp_path: Path) -> None:
    """A path that is followed by its volume ends below, or comes to a pressure again."""
    falling = dataclasses.replace(states, pressure_kPa=np.array([10.0, 5.0, 10.0]))
    write_states(falling, tmp_path / "states.parquet")
    read = read_states(tmp_path / "states.parquet")
    np.testing.assert_array_equal(read.pressure_kPa, [10.0, 5.0, 10.0])
    np.testing.assert_allclose(read.displacement, states.displacement, rtol=1e-7)


def test_the_file_is_a_plain_table(states: States, tmp_path: Path) -> None:
    write_states(states, tmp_path / "states.parquet")
    table = read_table(tmp_path / "states.parquet")
    row = (table["pressure_kPa"] == 10.0) & (table["node"] == 4)
    assert table["uy"][row] == pytest.approx(states.displacement[1, 4, 1])


@pytest.mark.parametrize(
    "nodes",
    [[0, 1, 0], [0, 1, 1, 0], [0, 1, 0, 2], [0, 1, 2, 3]],
    ids=["short", "order", "other", "two pressures"],
)
def test_states_of_different_nodes_are_refused(tmp_path: Path, nodes: list[int]) -> None:
    path = tmp_path / "states.parquet"
    zeros = np.zeros(len(nodes))
    write_table(
        path,
        STATES,
        {
            "pressure_kPa": [5.0, 5.0, 10.0, 10.0][: len(nodes)],
            "node": nodes,
            **dict.fromkeys(("ux", "uy", "uz", "strain"), zeros),
        },
    )
    with pytest.raises(InputError, match="same nodes in order"):
        read_states(path)
