import numpy as np
import pandas as pd
import pytest

from pagd.selection import choose, farthest_points


def _table(bending: int, twisting: int, mixed: int) -> tuple[pd.DataFrame, np.ndarray]:
    counts = {"bending": bending, "twisting": twisting, "mixed": mixed}
    modes = [mode for mode, count in counts.items() for _ in range(count)]
    rng = np.random.default_rng(1)
    order = rng.permutation(len(modes))
    return pd.DataFrame({"mode": np.array(modes)[order]}), rng.normal(size=(len(modes), 4))


def _counts(frame: pd.DataFrame, rows: np.ndarray) -> dict[str, int]:
    return frame["mode"].iloc[rows].value_counts().to_dict()


def test_farthest_points_on_a_line_by_hand() -> None:
    line = np.array([[0.0], [1.0], [4.0], [5.5], [10.0]])
    # From 0: 10 is farthest; 5.5 is 4.5 from 10, 4 is 4 from 0; 4 is 1.5 from 5.5, 1 is 1 from 0.
    expected = {
        0: [0, 4, 3, 2],
        # From 1: 10; 5.5 and its 4.5 from both; 4 and its 1.5 from 5.5.
        1: [1, 4, 3, 2],
        # From 4: 10; 0 and its 4 from 4; 5.5 and its 1.5 from 4.
        2: [2, 4, 0, 3],
        # From 5.5: 0, 5.5 away; 10, 4.5 away; 4, 1.5 away.
        3: [3, 0, 4, 2],
        # From 10: 0; 5.5 and its 4.5 from 10; 4.
        4: [4, 0, 3, 2],
    }
    found = [list(farthest_points(line, 4, np.random.default_rng(seed))) for seed in range(40)]
    assert {rows[0] for rows in found} == set(expected)
    assert all(rows == expected[rows[0]] for rows in found)


def test_equal_shares_of_each_mode() -> None:
    frame, vectors = _table(40, 30, 20)
    rows = choose(frame, vectors, 12)
    assert _counts(frame, rows) == {"bending": 4, "twisting": 4, "mixed": 4}
    assert len(set(rows)) == 12


@pytest.mark.parametrize(
    ("count", "expected"),
    [
        (1, {"bending": 1}),
        (5, {"bending": 2, "twisting": 2, "mixed": 1}),
        (13, {"bending": 6, "twisting": 5, "mixed": 2}),
    ],
)
def test_remainders_go_to_the_first_modes_and_gaps_to_the_others(
    count: int, expected: dict[str, int]
) -> None:
    frame, vectors = _table(20, 20, 2)
    assert _counts(frame, choose(frame, vectors, count)) == expected


def test_the_order_of_modes_is_the_callers() -> None:
    frame, vectors = _table(20, 20, 20)
    rows = choose(frame, vectors, 4, modes=("mixed", "bending", "twisting"))
    assert list(frame["mode"].iloc[rows]) == ["mixed", "mixed", "bending", "twisting"]


def test_a_missing_mode_passes_its_share_on() -> None:
    frame, vectors = _table(20, 20, 0)
    assert _counts(frame, choose(frame, vectors, 9)) == {"bending": 5, "twisting": 4}


def test_modes_that_are_not_asked_for_are_not_chosen() -> None:
    frame, vectors = _table(3, 20, 20)
    assert _counts(frame, choose(frame, vectors, 10, modes=["bending"])) == {"bending": 3}


@pytest.mark.parametrize("count", [9, 10, 1000])
def test_all_are_taken_in_order_where_there_are_no_more(count: int) -> None:
    frame, vectors = _table(3, 3, 3)
    np.testing.assert_array_equal(choose(frame, vectors, count), np.arange(9))


def test_none_are_taken_where_none_are_wanted() -> None:
    frame, vectors = _table(3, 3, 3)
    assert choose(frame, vectors, 0).shape == (0,)
    assert choose(frame.iloc[:0], vectors[:0], 5).shape == (0,)


def test_the_seed_decides() -> None:
    frame, vectors = _table(60, 60, 60)
    np.testing.assert_array_equal(choose(frame, vectors, 12, 1), choose(frame, vectors, 12, 1))
    assert {tuple(choose(frame, vectors, 3, seed)) for seed in range(5)} != {
        tuple(choose(frame, vectors, 3, 0))
    }


def test_doubles_come_once_each() -> None:
    rows = farthest_points(np.zeros((6, 2)), 6, np.random.default_rng(1))
    assert sorted(rows) == list(range(6))


def test_a_smaller_choice_is_the_beginning_of_a_larger_one() -> None:
    points = np.random.default_rng(1).normal(size=(50, 3))
    small, large = (farthest_points(points, n, np.random.default_rng(7)) for n in (6, 20))
    np.testing.assert_array_equal(small, large[:6])


def test_every_point_is_within_the_last_gap_of_the_choice() -> None:
    # What Gonzalez's proof rests on: the chosen are at least as far apart as the covering radius.
    points = np.random.default_rng(1).normal(size=(80, 3))
    rows = farthest_points(points, 10, np.random.default_rng(1))
    gaps = np.linalg.norm(points[:, None] - points[rows], axis=2)
    apart = gaps[rows][~np.eye(10, dtype=bool)].min()
    assert gaps.min(axis=1).max() <= apart


def test_misuse_is_refused() -> None:
    frame, vectors = _table(3, 3, 3)
    with pytest.raises(ValueError, match="-1"):
        choose(frame, vectors, -1)
    with pytest.raises(ValueError, match="9 designs"):
        choose(frame, vectors[:4], 2)
    with pytest.raises(ValueError, match="7 of 6"):
        farthest_points(np.zeros((6, 2)), 7, np.random.default_rng(1))
