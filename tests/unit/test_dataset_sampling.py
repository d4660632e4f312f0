import warnings
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

from pagd.dataset import METHODS, sample_designs
from pagd.dataset.category import (
    CATEGORIES,
    Category,
    designs_from,
    free_parameters,
    in_box,
    values_of,
)
from pagd.dataset.rejection import draw, name_of
from pagd.dataset.sampling import Method, unit_points
from pagd.design import PARAMETERS, Design, GeometryRules, Limits, violations
from pagd.errors import InputError

RULES = GeometryRules()
# Nothing in the sampling box breaks these.
EASY = GeometryRules(limits=Limits(cavity=1e-6))


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def in_unit_cube(designs: list[Design], mode: Category) -> np.ndarray:
    free = free_parameters(mode)
    low, high = np.array([p.low for p in free]), np.array([p.high for p in free])
    return (values_of(designs, mode) - low) / (high - low)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("mode", CATEGORIES)
def test_designs_are_valid_of_their_mode_rounded_and_in_the_box(
    mode: Category, method: Method
) -> None:
    found = sample_designs(300, mode, RULES, rng(), method)
    assert len(set(found.designs)) == 300
    for design in found.designs:
        assert design.mode == mode
        assert violations(design, RULES) == ()
        assert isinstance(design.N, int)
        for parameter in free_parameters(mode):
            value = getattr(design, parameter.symbol)
            assert parameter.low <= value <= parameter.high
            assert value == round(value, 2)
    assert {(d.alpha, d.theta == 0) for d in found.designs} == {
        (float(mode == "twisting"), mode == "bending")
    }


@pytest.mark.parametrize("method", METHODS)
def test_rejected_designs_are_counted_and_drawn_again(method: Method) -> None:
    tight = GeometryRules(limits=Limits(cavity=6.0))
    found = sample_designs(200, "twisting", tight, rng(), method)
    rule = "L: the cavity, L cos(theta) - 2 t_ab, must be at least 6 mm"
    assert len(found.designs) == 200
    assert found.rejected[rule] > 100
    # A design can break more than one rule, but none is rejected without breaking any.
    assert max(found.rejected.values()) <= found.drawn - 200 <= found.rejected.total()
    assert found.rate == 200 / found.drawn < 0.6


def test_the_share_that_is_accepted_is_the_valid_share_of_the_box() -> None:
    points = rng(5).random((4000, len(free_parameters("twisting"))))
    drawn = designs_from(in_box(points, "twisting"), "twisting")
    valid = np.mean([not violations(design, RULES) for design in drawn])
    found = sample_designs(4000, "twisting", RULES, rng(6))
    # Four standard deviations of the difference of two such shares.
    assert found.rate == pytest.approx(valid, abs=4 * np.sqrt(2 * valid * (1 - valid) / 4000))


def test_every_number_of_chambers_is_equally_likely() -> None:
    counts = Counter(d.N for d in sample_designs(9000, "bending", EASY, rng()).designs)
    assert sorted(counts) == list(range(6, 15))
    assert all(abs(n - 1000) < 5 * np.sqrt(1000) for n in counts.values())


def test_the_corners_of_the_unit_cube_are_those_of_the_box() -> None:
    points = np.array([[0.0], [np.nextafter(1, 0)]]) * np.ones(10)
    low, high = designs_from(in_box(points, "twisting"), "twisting")
    for symbol, parameter in PARAMETERS.items():
        if symbol != "alpha":
            assert (getattr(low, symbol), getattr(high, symbol)) == (parameter.low, parameter.high)


def test_each_margin_of_a_latin_hypercube_is_stratified() -> None:
    points = unit_points("latin_hypercube", 9, rng())
    for count in (50, 7):
        strata = np.floor(points(count) * count).astype(int)
        assert (np.sort(strata, axis=0) == np.arange(count)[:, None]).all()


def test_designs_of_a_latin_hypercube_are_stratified_where_nothing_is_rejected() -> None:
    # 60 strata of L, each of 0.1 mm: rounding moves a design by less than a tenth of one.
    designs = sample_designs(60, "bending", EASY, rng(), "latin_hypercube").designs
    lengths = np.sort([design.L for design in designs])
    edges = 6 + 0.1 * np.arange(61)
    assert (lengths >= edges[:-1] - 0.0051).all()
    assert (lengths <= edges[1:] + 0.0051).all()


def test_a_sobol_sequence_goes_on_where_it_stopped_without_a_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        points = unit_points("sobol", 9, rng())
        parts = np.concatenate([points(100), points(11), points(401)])
    whole = qmc.Sobol(9, rng=rng()).random(512)
    np.testing.assert_array_equal(parts, whole)


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_low_discrepancy_survives_rounding_and_rejection(method: Method) -> None:
    def discrepancy(of: Method, seed: int) -> float:
        designs = sample_designs(500, "bending", RULES, rng(seed), of).designs
        return float(qmc.discrepancy(np.clip(in_unit_cube(designs, "bending"), 0, 1)))

    even = [discrepancy(method, seed) for seed in range(3)]
    assert max(even) < min(discrepancy("random", seed) for seed in range(3))


@pytest.mark.parametrize("method", ["random", "sobol"])
def test_fewer_designs_are_the_beginning_of_more(method: Method) -> None:
    more = sample_designs(150, "twisting", RULES, rng(3), method).designs
    assert sample_designs(40, "twisting", RULES, rng(3), method).designs == more[:40]


def test_what_is_taken_does_not_come_again() -> None:
    first = sample_designs(30, "bending", RULES, rng(1)).designs
    taken = set(first[:10])
    again = sample_designs(30, "bending", RULES, rng(1), taken=taken)
    assert (again.duplicates, again.designs[:20]) == (10, first[10:])
    assert taken == set(first[:10]) | set(again.designs)


def test_rules_that_leave_nothing_are_told_in_one_sentence() -> None:
    nothing = GeometryRules(limits=Limits(cavity=50.0))
    with pytest.raises(
        InputError,
        match=r"^Hardly any bending design can be drawn \(random\): only 0 of"
        r" 100,\d{3} are valid and new; 100,\d{3} break 'L: the cavity, .* at least 50 mm'\.$",
    ):
        sample_designs(300, "bending", nothing, rng())


def test_endless_duplicates_are_told_as_well() -> None:
    only = sample_designs(1, "bending", RULES, rng()).designs
    with pytest.raises(InputError, match=r"only 1 of 101,950 .*; 101,949 are duplicates\.$"):
        draw(2000, lambda missing: only * missing, "bending", RULES)


def test_a_twisting_design_without_slant_is_refused() -> None:
    slanted, straight = (
        Design(L=10, W=15, H=13, t=2, t_n=2, t_h=3, t_ab=2, t_b=2, N=8, theta=theta, alpha=1)
        for theta in (20.0, 0.0)
    )
    rest = iter([straight, slanted])
    found = draw(1, lambda missing: [next(rest)], "twisting", RULES)
    assert (found.designs, found.drawn) == ([slanted], 2)
    assert found.rejected == {"theta: must be greater than 0 in a twisting design": 1}


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"mode": "mixed"}, "mode = 'mixed' must be one of bending, twisting"),
        ({"method": "halton"}, "method = 'halton' must be one of random, sobol, latin_hypercube"),
    ],
)
def test_unknown_words_are_refused(given: dict[str, str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        sample_designs(1, **({"mode": "bending", "rules": RULES, "rng": rng()} | given))  # type: ignore[arg-type]


SIZES = st.floats(-100, 100, allow_nan=False)


@settings(max_examples=200)
@given(st.lists(SIZES, min_size=9, max_size=9), st.integers(-5, 50), st.floats(0, 1), SIZES)
def test_names_of_rules_are_free_of_the_values_of_designs(
    sizes: list[float], N: int, alpha: float, theta: float
) -> None:
    symbols = ("L", "W", "H", "t", "t_n", "t_h", "t_ab", "t_b")
    values = dict(zip(symbols, sizes, strict=False))
    design = Design(**values, N=N, theta=theta, alpha=alpha)
    for violation in violations(design, RULES):
        assert " = " not in name_of(violation)
        assert name_of(violation).startswith(f"{violation.key}: ")
