import numpy as np
import pytest

from pagd.dataset import interpolated_designs, jittered_designs
from pagd.dataset.category import CATEGORIES, Category, free_parameters, values_of
from pagd.design import Design, GeometryRules, Limits, violations
from pagd.errors import InputError

RULES = GeometryRules()
# Both lie outside the sampling box, as published actuators do: H and t_b; t_b.
TALL = Design(L=10.4, W=19, H=29, t=2, t_n=2.5, t_h=4, t_ab=1.2, t_b=2, N=7, theta=0, alpha=0)
THICK = Design(L=10, W=20, H=28.5, t=1.5, t_n=4, t_h=1.5, t_ab=1.5, t_b=10, N=6, theta=0, alpha=0)
TWISTING = Design(L=9, W=16.5, H=12, t=2, t_n=3, t_h=3, t_ab=1.9, t_b=2.4, N=8, theta=27.2, alpha=1)
KNOWN: dict[Category, list[Design]] = {"bending": [TALL, THICK], "twisting": [TWISTING]}


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def widths(mode: Category) -> np.ndarray:
    return np.array([p.high - p.low for p in free_parameters(mode)])


@pytest.mark.parametrize("draw", [jittered_designs, interpolated_designs])
@pytest.mark.parametrize("mode", CATEGORIES)
def test_designs_are_new_valid_and_of_their_category(draw, mode: Category) -> None:  # type: ignore[no-untyped-def]
    known = KNOWN[mode]
    found = draw(200, known, mode, RULES, rng(), taken=set(known))
    assert len({*found.designs, *known}) == 200 + len(known)
    for design in found.designs:
        assert (design.mode, design.alpha) == (mode, float(mode == "twisting"))
        assert (design.theta == 0) == (mode == "bending")
        assert violations(design, RULES) == ()
        assert isinstance(design.N, int)


def test_jitter_has_the_deviation_asked_for_around_what_is_known() -> None:
    found = jittered_designs(2000, [TWISTING], "twisting", RULES, rng(), jitter=0.01)
    assert found.rate > 0.95  # so that rejection cuts off next to nothing
    steps = (values_of(found.designs, "twisting") - values_of([TWISTING], "twisting")) / widths(
        "twisting"
    )
    chambers = [p.symbol for p in free_parameters("twisting")].index("N")
    others = np.delete(steps, chambers, axis=1)
    np.testing.assert_allclose(others.std(axis=0), 0.01, rtol=0.1)
    np.testing.assert_allclose(others.mean(axis=0), 0, atol=4 * 0.01 / np.sqrt(2000))
    # 0.01 of 8 chambers is six times less than the half that is needed to round to another number.
    assert set(steps[:, chambers]) == {0.0}


def test_each_known_design_is_jittered_and_left_outside_the_box() -> None:
    designs = jittered_designs(300, [TALL, THICK], "bending", RULES, rng()).designs
    tall = [d for d in designs if d.t_b < 6]
    assert 110 < len(tall) < 190
    assert min(d.H for d in designs) > 24
    assert {d.N for d in tall} >= {6, 7, 8}


def test_a_jitter_out_of_the_rules_is_rejected_and_drawn_again() -> None:
    edge = Design(**TWISTING.as_dict() | {"theta": 45.0})  # type: ignore[arg-type]
    found = jittered_designs(200, [edge], "twisting", RULES, rng())
    assert found.rejected["theta: must lie between 0 and 45 degrees"] > 100
    assert found.rate == pytest.approx(0.5, abs=0.15)
    assert max(d.theta for d in found.designs) <= 45


def test_interpolation_stays_between_its_ends() -> None:
    designs = interpolated_designs(400, [TALL, THICK], "bending", RULES, rng()).designs
    free = free_parameters("bending")
    corners = values_of([TALL, THICK], "bending")
    low = np.minimum([p.low for p in free], corners.min(axis=0))
    high = np.maximum([p.high for p in free], corners.max(axis=0))
    values = values_of(designs, "bending")
    assert (values >= low).all()
    assert (values <= high).all()


def test_half_of_the_lines_join_two_known_designs() -> None:
    designs = interpolated_designs(400, [TALL, THICK], "bending", RULES, rng()).designs
    start, end = values_of([TALL, THICK], "bending")
    values = values_of(designs, "bending")
    base = [p.symbol for p in free_parameters("bending")].index("t_b")
    share = (values[:, base] - start[base]) / (end[base] - start[base])
    line = start + share[:, None] * (end - start)
    # Off the line by no more than the rounding, which for N is half a chamber.
    slack = np.array([0.51 if p.whole else 0.02 for p in free_parameters("bending")])
    on_it = (np.abs(values - line) <= slack).all(axis=1)
    assert 160 < on_it.sum() < 240
    assert share[on_it].min() < 0.1
    assert share[on_it].max() > 0.9
    assert share[on_it].mean() == pytest.approx(0.5, abs=0.1)


def test_with_one_known_design_lines_lead_into_the_box() -> None:
    designs = interpolated_designs(2000, [TWISTING], "twisting", RULES, rng()).designs
    steps = values_of(designs, "twisting") - values_of([TWISTING], "twisting")
    theta = steps[:, [p.symbol for p in free_parameters("twisting")].index("theta")]
    # The other end is uniform over 10 … 45, its mean 0.3 degrees off; the share has mean 1/2.
    assert theta.mean() == pytest.approx((27.5 - 27.2) / 2, abs=1.0)
    assert theta.min() < -10
    assert theta.max() > 10


@pytest.mark.parametrize("draw", [jittered_designs, interpolated_designs])
def test_fewer_designs_are_the_beginning_of_more(draw) -> None:  # type: ignore[no-untyped-def]
    more = draw(60, KNOWN["bending"], "bending", RULES, rng(2)).designs
    assert draw(20, KNOWN["bending"], "bending", RULES, rng(2)).designs == more[:20]


def test_what_gives_nothing_new_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pagd.dataset.rejection._FAIR_TRIAL", 2_000)
    with pytest.raises(InputError, match=r"jitter of 1e-09.* 2,\d{3} are duplicates"):
        jittered_designs(90, [TALL], "bending", RULES, rng(), jitter=1e-9, taken={TALL})
    with pytest.raises(InputError, match=r"interpolation.* break 'L: .* at least 60 mm'"):
        interpolated_designs(90, [TALL], "bending", GeometryRules(limits=Limits(cavity=60)), rng())
