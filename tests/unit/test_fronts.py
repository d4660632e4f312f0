"""Tests of the comparison of Pareto fronts."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from pagd.fronts import compare, known, not_dominated, values_of

ALL = ["bending_deg", "twist_deg", "blocked_force_N"]


def table(rows: list[tuple[float, ...]] | np.ndarray, status: str = "ok") -> pd.DataFrame:
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


def random_table(count: int, seed: int, size: float = 1.0) -> pd.DataFrame:
    return table(size * np.random.default_rng(seed).random((count, 3)))


def test_what_none_is_better_than_is_the_front() -> None:
    values = np.array([[3.0, 1.0], [1.0, 3.0], [2.0, 2.0], [1.0, 1.0], [2.0, 1.5]])
    assert not_dominated(values).tolist() == [True, True, True, False, False]


def test_twist_counts_to_either_side_and_what_goes_the_other_way_is_nothing() -> None:
    rows = table([(-3, -2, None), (3, 2, -1)])
    assert values_of(rows, ALL) == pytest.approx(np.array([[0.0, 2.0, 0.0], [3.0, 2.0, 0.0]]))
    assert not values_of(rows.assign(status="not_converged"), ALL).any()


def test_a_doubted_force_of_cells_is_none_and_the_rest_stays() -> None:
    rows = table([(3, 2, 1), (3, 2, 1), (3, 2, 1)]).assign(
        doubt=["Far.", None, "Far."], fidelity=["cells", "cells", "pieces"]
    )
    assert values_of(rows, ALL) == pytest.approx(np.array([[3, 2, 0], [3, 2, 1], [3, 2, 1]]))
    assert known(rows, ALL).tolist() == [False, True, True]
    assert known(rows, ALL[:2]).all()
    assert known(table([(1, None, 2)]), ALL).tolist() == [False]


def test_designs_that_are_all_alike_have_the_ratio_of_their_boxes() -> None:
    found = compare(table([(10, 10, 1)] * 9), table([(20, -10, 2)] * 6), seed=1, repeats=19)
    by = {tuple(each["objectives"]): each for each in found["comparisons"]}
    whole = by[tuple(ALL)]
    assert whole["ratio"] == whole["low"] == whole["high"] == pytest.approx(4.0)
    assert by["bending_deg", "twist_deg"]["ratio"] == pytest.approx(2.0)
    assert whole["share"] == 1.0
    assert whole["front"]["training"] == {}
    assert set(whole["front"]["generated"]) == {"mixed"}
    assert (len(by), whole["drawn"]) == (4, 2)
    assert whole["compared"] == {"training": 9, "generated": 6}


def test_doubts_of_one_kind_alone_make_no_difference() -> None:
    """Those whose force, or whose failure, is doubted are left out; those that fail are not."""
    old, new = table([(10, 10, 1)] * 60), table([(10, 10, 1)] * 60)
    new["doubt"], new["fidelity"] = [None] * 20 + ["Far."] * 40, "cells"
    new.loc[58:, "status"] = "buckled"
    new.loc[59, "doubt"] = None
    by = {tuple(c["objectives"]): c for c in compare(old, new, seed=1, repeats=19)["comparisons"]}
    whole = by[tuple(ALL)]
    assert whole["compared"] == {"training": 60, "generated": 21}
    assert (whole["drawn"], whole["ratio"]) == (7, 1.0)
    assert by["bending_deg", "twist_deg"]["compared"] == {"training": 60, "generated": 59}


@pytest.mark.parametrize("sizes", [(500, 1000), (1500, 150)])
def test_a_larger_set_is_no_better_for_its_size(sizes: tuple[int, int]) -> None:
    chances, ratios, shares = [], [], []
    for seed in range(12):
        old, new = (random_table(n, 2 * seed + k) for k, n in enumerate(sizes))
        found = compare(old, new, seed=seed, repeats=39)
        whole = found["comparisons"][0]
        chances.append(whole["p"])
        ratios.append(whole["ratio"])
        shares.append(whole["share"])
    assert sum(p <= 0.05 for p in chances) <= 3
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.06)
    assert np.mean(shares) == pytest.approx(0.5, abs=0.05)


def test_what_is_better_is_told_to_be() -> None:
    whole = compare(random_table(300, 1), random_table(300, 2, 1.2), seed=1, repeats=99)
    first = whole["comparisons"][0]
    assert first["p"] <= 0.02
    assert first["ratio"] == pytest.approx(1.2**3, rel=0.1)


def test_designs_that_fail_are_designs_that_do_nothing() -> None:
    good, lost = random_table(100, 1), random_table(100, 2).assign(status="not_converged")
    found = compare(good, pd.concat([good.head(10), lost.head(90)]), seed=1, repeats=99)
    assert found["generated"] == 100
    assert found["comparisons"][0]["ratio"] < 0.9
    assert found["comparisons"][0]["p"] <= 0.05


def test_objectives_that_nobody_has_are_left_out() -> None:
    free = random_table(30, 1).assign(blocked_force_N=None)
    found = compare(free, random_table(30, 2), seed=1, repeats=9)
    assert [each["objectives"] for each in found["comparisons"]] == [ALL[:2]]


@pytest.mark.parametrize("lost", [random_table(0, 1), random_table(9, 1, 0.0)])
def test_of_nothing_there_is_no_comparison(lost: pd.DataFrame) -> None:
    lost = lost.reindex(columns=["design_id", "mode", "status", *ALL])
    assert compare(lost, random_table(9, 2), seed=1, repeats=9)["comparisons"] == []


def test_the_same_seed_gives_the_same_interval() -> None:
    a, b = random_table(50, 5), random_table(50, 6)
    assert compare(a, b, seed=4, repeats=20) == compare(a, b, seed=4, repeats=20)
