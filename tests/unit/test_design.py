import csv
import dataclasses
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pagd.design import (
    PARAMETERS,
    Channel,
    Design,
    GeometryRules,
    Limits,
    base_volume,
    body_volume,
    cavity_volume,
    check,
    solid_volume,
    violations,
)
from pagd.errors import InputError, StageFailure, Status

TABLE_2 = Path(__file__).parents[2] / "config" / "table2.csv"
RULES = GeometryRules()


def table_2() -> dict[str, Design]:
    with TABLE_2.open(newline="") as file:
        return {row.pop("name"): Design.from_mapping(row) for row in csv.DictReader(file)}


BENDING, TWISTING, MIXED = (table_2()[name] for name in ("bending", "twisting", "mixed"))


def drawn(parameter: str) -> st.SearchStrategy[float]:
    bounds = PARAMETERS[parameter]
    if bounds.whole:
        return st.integers(int(bounds.low), int(bounds.high))
    return st.floats(bounds.low, bounds.high)


DESIGNS = st.builds(Design, **{symbol: drawn(symbol) for symbol in PARAMETERS})


@pytest.mark.parametrize(
    ("name", "length", "helical", "mode"),
    [
        ("bending", 130.6, 0, "bending"),
        ("twisting", 98.4, 8, "twisting"),
        ("mixed", 134.7, 6, "mixed"),
    ],
)
def test_table_2(name: str, length: float, helical: int, mode: str) -> None:
    design = table_2()[name]
    assert round(design.L_T, 1) == length
    counts = (design.N1, design.N2)
    assert counts == (helical, design.N - helical)
    assert design.mode == mode
    assert design.cross_section == "rectangular"
    assert violations(design, RULES) == ()


@pytest.mark.parametrize(
    ("alpha", "N", "N1"), [(0.5, 5, 3), (0.5, 7, 4), (0.3, 5, 2), (0.24, 10, 2)]
)
def test_halves_are_rounded_up(alpha: float, N: int, N1: int) -> None:
    assert dataclasses.replace(MIXED, alpha=alpha, N=N).N1 == N1


@pytest.mark.parametrize("change", [{"theta": 0.0}, {"alpha": 0.0}, {"alpha": 0.04}])
def test_without_slanted_chambers_the_design_is_straight(change: dict[str, Any]) -> None:
    design = dataclasses.replace(MIXED, **change)
    straight = dataclasses.replace(MIXED, theta=0.0, alpha=0.0)
    assert design.is_straight
    assert design.L_T == straight.L_T
    assert cavity_volume(design, RULES) == cavity_volume(straight, RULES)


@given(DESIGNS)
def test_the_row_spans_the_total_length(design: Design) -> None:
    starts, skews, half = design.chamber_starts(), design.chamber_skews(), design.W / 2
    assert starts[0] - skews[0] * half == pytest.approx(0, abs=1e-9)
    assert starts[-1] + design.L + skews[-1] * half == pytest.approx(design.L_T)
    at_lower, at_upper = (starts + skews * y for y in (-half, half))
    for edge in (at_lower, at_upper):
        assert np.all(np.diff(edge) >= design.pitch - 1e-9)
    # Parallel neighbours keep t_n everywhere; at the change the nearest corners do.
    assert np.min(np.diff(at_upper)) == pytest.approx(design.pitch)
    assert design.gaps().shape == (design.N - 1,)
    assert design.base_thicknesses().shape == (design.N,)


def test_volumes_against_numerical_integration() -> None:
    # Thin slices across y: each is a comb whose area is known at its y.
    design, channel = MIXED, RULES.channel
    y = (np.arange(2000) + 0.5) / 2000 * design.W / 2
    area = np.zeros_like(y)
    starts, walls = design.chamber_starts(), design.end_wall_lengths()
    for sign in (-1, 1):
        left = starts + walls + sign * y[:, None] * design.chamber_skews()
        right = left + design.L - 2 * walls
        inside = y < design.W / 2 - design.t
        area += inside * np.sum(right - left, axis=1) * (design.H - design.t_h)
        area += (
            (y < channel.width / 2) * channel.height * np.sum(left[:, 1:] - right[:, :-1], axis=1)
        )
    volume = area.mean() * design.W / 2
    assert cavity_volume(design, RULES) == pytest.approx(volume, rel=1e-3)


def test_volumes_add_up() -> None:
    for design in table_2().values():
        block = design.N * design.L * design.W * (design.H - RULES.channel.gap_floor)
        slab = design.L_T * design.W * (design.t_b + RULES.channel.gap_floor)
        total = solid_volume(design, RULES) + cavity_volume(design, RULES)
        assert total == pytest.approx(block + slab)
        assert solid_volume(design, RULES) == body_volume(design, RULES) + base_volume(design)


def test_mapping_round_trip() -> None:
    assert Design.from_mapping(MIXED.as_dict()) == MIXED
    assert Design.from_mapping({k: str(v) for k, v in MIXED.as_dict().items()}) == MIXED
    assert list(MIXED.as_dict()) == list(PARAMETERS)


def test_every_unusable_key_is_named() -> None:
    mapping: dict[str, object] = {**MIXED.as_dict(), "t": "thick", "W": True, "N": 7.5, "wide": 3}
    del mapping["t_b"]
    with pytest.raises(InputError) as caught:
        Design.from_mapping(mapping)
    for text in ("wide is not", "t_b is missing", "t = 'thick'", "W = True", "N = 7.5"):
        assert text in str(caught.value)


@pytest.mark.parametrize("value", [math.nan, math.inf, "nan"])
def test_a_count_that_is_not_finite_is_refused(value: object) -> None:
    with pytest.raises(InputError, match="N = "):
        Design.from_mapping({**MIXED.as_dict(), "N": value})


BROKEN = [
    (BENDING, {"t_ab": 4.5}, "L", "0.51 mm, must be at least 1 mm"),
    (TWISTING, {"t_ab": 3.0}, "L", "L cos(theta) - 2 t_ab = 0.96"),
    (BENDING, {"W": 9.0}, "W", "must be at least 1 mm"),
    (BENDING, {"W": 9.9}, "W", "as wide as the channel, 2 mm"),
    (BENDING, {"H": 4.9}, "H", "must be at least 1 mm"),
    (BENDING, {"H": 6.9}, "H", "at least 3 mm high: 1 mm above the channel"),
    (BENDING, {"H": 3.9, "t_h": 0.8}, "H", "at least 4 mm, 0.5 mm above the gap floor"),
    (BENDING, {"t": 0.7}, "t", "at least 0.75 mm"),
    (BENDING, {"t_h": 0.7}, "t_h", "at least 0.75 mm"),
    (BENDING, {"t_ab": 0.7}, "t_ab", "at least 0.75 mm"),
    (BENDING, {"t_b": 0.7}, "t_b", "at least 0.75 mm"),
    (BENDING, {"t_b": 0.9}, "t_b", "the paper, at t_b / 2 = 0.45 mm, must lie at least 0.5 mm"),
    (BENDING, {"t_n": 0.4}, "t_n", "0.4 mm, must be at least 0.5 mm"),
    (TWISTING, {"t_n": 0.55}, "t_n", "t_n cos(theta) = 0.489"),
    (TWISTING, {"theta": 46.0}, "theta", "between 0 and 45 degrees"),
    (TWISTING, {"theta": -1.0}, "theta", "between 0 and 45 degrees"),
    (MIXED, {"alpha": 1.1}, "alpha", "between 0 and 1"),
    (MIXED, {"alpha": -0.1}, "alpha", "between 0 and 1"),
    (MIXED, {"N": 0}, "N", "at least 1"),
    (MIXED, {"L": math.nan}, "L", "finite"),
    (MIXED, {"theta": math.inf}, "theta", "finite"),
]


@pytest.mark.parametrize(("valid", "change", "key", "text"), BROKEN)
def test_a_broken_rule_is_reported(
    valid: Design, change: dict[str, Any], key: str, text: str
) -> None:
    found = violations(dataclasses.replace(valid, **change), RULES)
    matching = [violation for violation in found if text in violation.rule]
    assert [violation.key for violation in matching] == [key]
    expected = change.get(key, getattr(valid, key))
    assert matching[0].value == pytest.approx(expected, nan_ok=True)


def test_every_broken_rule_is_in_the_reason() -> None:
    design = dataclasses.replace(MIXED, t_b=0.6, t_n=0.2, theta=50.0, t=7.2)
    with pytest.raises(StageFailure) as caught:
        check(design, RULES)
    assert caught.value.status is Status.invalid_geometry
    reason = caught.value.reason
    assert all(f"{key} = " in reason for key in ("t_b", "t_n", "theta", "W"))
    assert len(violations(design, RULES)) == 6


def test_a_size_on_the_limit_is_valid_whatever_the_rounding() -> None:
    design = dataclasses.replace(BENDING, W=3.76, t=0.88)
    assert design.W - 2 * design.t < 2
    assert violations(design, RULES) == ()


def test_limits_and_channel_are_configuration() -> None:
    assert (
        violations(dataclasses.replace(BENDING, t_n=0.4), GeometryRules(limits=Limits(gap=0.3)))
        == ()
    )
    low_roof = GeometryRules(channel=Channel(roof=0.5))
    assert [violation.key for violation in violations(BENDING, low_roof)] == ["channel.roof"]
    tall = GeometryRules.from_mapping({"channel": {"height": 9}, "limits": {}})
    assert tall.channel == Channel(height=9)
    assert {violation.key for violation in violations(BENDING, tall)} == {"H"}


@pytest.mark.parametrize(
    ("mapping", "text"),
    [
        ({"walls": {}}, "walls"),
        ({"limits": {"gapp": 1}}, "limits.gapp"),
        ({"channel": {"width": -1}}, "channel.width = -1"),
        ({"channel": {"width": "wide", "roof": math.nan}}, "channel.roof = nan"),
    ],
)
def test_unusable_rules_are_named(mapping: dict[str, dict[str, object]], text: str) -> None:
    with pytest.raises(InputError, match=text):
        GeometryRules.from_mapping(mapping)


def test_the_sampling_box_brackets_table_2() -> None:
    for design in table_2().values():
        for symbol, value in design.as_dict().items():
            bounds = PARAMETERS[symbol]
            assert bounds.low <= value <= bounds.high or (symbol == "theta" and value == 0)


def test_a_failure_survives_another_process() -> None:
    failure = pickle.loads(pickle.dumps(StageFailure(Status.mesh_failed, "why")))
    assert (failure.status, failure.reason, str(failure)) == (Status.mesh_failed, "why", "why")
    with pytest.raises(ValueError, match="ok"):
        StageFailure(Status.ok, "nothing")
