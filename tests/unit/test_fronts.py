"""Tests of the comparison of Pareto fronts."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from pagd.errors import InputError
from pagd.fronts import compare, not_dominated, values_of


def table(rows: list[tuple[float, float, float | None]], status: str = "ok") -> pd.DataFrame:
    return pd.DataFrame(
        [
            {
                "design_id": f"d{k}",
                "mode": "mixed" if twist else "bending",
                "status": status,
                "bending_deg": bending,
                "twist_deg": twist,
                "blocked_force_N": force,
            }
            for k, (bending, twist, force) in enumerate(rows)
        ]
    )


def test_what_none_is_better_than_is_the_front() -> None:
    values = np.array([[3.0, 1.0], [1.0, 3.0], [2.0, 2.0], [1.0, 1.0], [2.0, 1.5]])
    assert not_dominated(values).tolist() == [True, True, True, False, False]


def test_sizes_count_whatever_their_sign_and_no_force_is_none() -> None:
    assert values_of(table([(-3, -2, None)]), ["bending_deg", "twist_deg", "blocked_force_N"]) == (
        pytest.approx(np.array([[3.0, 2.0, 0.0]]))
    )


def test_one_design_against_one_has_the_ratio_of_their_boxes() -> None:
    found = compare(table([(10, 10, 1)]), table([(20, -10, 2)]), seed=1, repeats=5)
    by = {tuple(each["objectives"]): each for each in found["comparisons"]}
    whole = by["bending_deg", "twist_deg", "blocked_force_N"]
    assert whole["ratio"] == whole["low"] == whole["high"] == pytest.approx(4.0)
    assert by["bending_deg", "twist_deg"]["ratio"] == pytest.approx(2.0)
    assert whole["likely"] == 1.0
    assert whole["front"] == {"training": {}, "generated": {"mixed": 1}}
    assert len(by) == 4


def test_sets_alike_are_told_to_be_alike() -> None:
    random = np.random.default_rng(0)

    def drawn() -> pd.DataFrame:
        return table([tuple(row) for row in random.random((300, 3))])

    whole = compare(drawn(), drawn(), seed=2, repeats=200)["comparisons"][0]
    assert whole["low"] < 1 < whole["high"]
    assert 0.9 < whole["ratio"] < 1.1


def test_what_did_not_come_to_its_end_does_not_count() -> None:
    good, lost = table([(1, 1, 1)]), table([(100, 100, 100)], status="not_converged")
    found = compare(good, pd.concat([good, lost]), seed=1, repeats=3)
    assert found["generated"] == 1
    with pytest.raises(InputError, match="No generated design"):
        compare(good, lost, seed=1)


def test_the_same_seed_gives_the_same_interval() -> None:
    random = np.random.default_rng(3)
    a, b = (table([tuple(row) for row in random.random((50, 3))]) for _ in range(2))
    assert compare(a, b, seed=4, repeats=20) == compare(a, b, seed=4, repeats=20)
