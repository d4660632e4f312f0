"""Metrics of a path whose figures are known: rates, blocked force, first contact, chambers."""

from itertools import pairwise

import numpy as np
import pytest

from pagd.design import Design
from pagd.metrics import (
    blocked_force_at,
    first_contact_pressure,
    strain_columns,
    strain_rate,
)

WIDTH = 0.04
MIXED = Design(
    L=8.0, W=15.0, H=13.0, t=1.5, t_n=2.8, t_h=4.0, t_ab=2.0, t_b=2.0, N=4, theta=20.0, alpha=0.5
)


def test_rate_of_a_parabola_is_exact_on_uneven_steps():
    pressure = np.array([0.0, 5.0, 12.0, 15.0, 17.5])
    rate = strain_rate(pressure, 0.02 * pressure + 1e-3 * pressure**2)
    np.testing.assert_allclose(rate, 0.02 + 2e-3 * pressure, rtol=1e-12)


def test_rate_converges_with_the_square_of_the_step():
    errors = []
    for count in (11, 21, 41):
        pressure = np.linspace(0.0, 50.0, count)
        found = strain_rate(pressure, np.exp(0.04 * pressure))
        errors.append(np.abs(found - 0.04 * np.exp(0.04 * pressure)).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.3)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.3)


def test_there_is_no_rate_across_a_fall_of_the_pressure():
    pressure = np.array([0.0, 5.0, 10.0, 8.0, 12.0, 12.0])
    rate = strain_rate(pressure, np.array([0.0, 0.1, 0.2, 0.5, 0.9, 1.0]))
    np.testing.assert_allclose(rate[:5], [0.02, 0.02, 0.02, 0.1, 0.1])
    # Alone behind the stay at 12 kPa.
    assert np.isnan(rate[5])
    assert np.isnan(strain_rate(np.zeros(1), np.zeros(1))).all()


def test_rate_in_time_needs_a_ramp():
    pressure, strain = np.array([0.0, 5.0, 10.0]), np.array([0.0, 0.05, 0.1])
    without = strain_columns(pressure, 2.0 * strain, strain)
    assert np.isnan(without["strain_rate_per_s"]).all()
    with_ramp = strain_columns(pressure, 2.0 * strain, strain, ramp_kPa_per_s=20.0)
    np.testing.assert_allclose(with_ramp["strain_rate_per_kPa"], 0.01)
    np.testing.assert_allclose(with_ramp["strain_rate_per_s"], 0.2)
    np.testing.assert_array_equal(with_ramp["strain_max"], 2.0 * strain)


def test_blocked_force_at_the_pressures_that_it_reached():
    blocked = {
        "pressure_kPa": np.array([0.0, 2.5, 5.0, 10.0, 12.0, 11.0, 12.0]),
        "blocked_force_N": np.array([0.0, np.nan, 0.5, 1.0, 1.3, np.nan, 1.6]),
        "recorded": np.array([True, False, True, True, True, False, True]),
    }
    found = blocked_force_at(np.array([0.0, 2.5, 5.0, 10.0, 12.0, 15.0]), blocked)
    # 2.5 kPa is a step but not recorded; the second state at 12 kPa does not count.
    np.testing.assert_array_equal(found, [0.0, np.nan, 0.5, 1.0, 1.3, np.nan])
    nothing = {key: values[:0] for key, values in blocked.items()}
    assert np.isnan(blocked_force_at(np.array([0.0, 5.0]), nothing)).all()


def touching(pressure, at, start=2.8, power=2.0):
    """Gap that closes to the width faster and faster, and that contact then holds."""
    free = WIDTH + (start - WIDTH) * (1.0 - (pressure / at) ** power)
    return np.where(free < WIDTH, WIDTH * np.exp(-0.5 * (WIDTH - free)), free)


@pytest.mark.parametrize("power", [0.8, 1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("at", [8.0, 11.0, 23.0, 29.9, 47.0])
def test_first_contact_is_found_to_a_few_per_cent(at, power):
    """Steps grow from 0.25 kPa by a half each to 2.5 kPa, as an adaptive path's do."""
    steps = np.minimum(0.25 * 1.5 ** np.arange(40), 2.5)
    pressure = np.concatenate([[0.0], np.cumsum(steps)])
    pressure = pressure[pressure < 60.0]
    found = first_contact_pressure(pressure, touching(pressure, at, power=power), WIDTH)
    assert found == pytest.approx(at, rel=0.05)


def test_first_contact_of_a_straight_line_is_exact_on_any_steps():
    pressure = np.array([0.0, 1.0, 7.0, 12.0, 20.0, 21.0])
    gap = np.maximum(3.0 + WIDTH - 0.2 * pressure, -0.002)
    assert first_contact_pressure(pressure, gap, WIDTH) == pytest.approx(15.0)


def test_first_contact_rises_with_the_gap():
    pressure = np.linspace(0.0, 50.0, 21)
    starts = np.linspace(0.5, 3.0, 200)
    gaps = (np.maximum(start - 5e-2 * pressure - 1e-3 * pressure**2, -0.01) for start in starts)
    found = [first_contact_pressure(pressure, gap, WIDTH) for gap in gaps]
    assert all(earlier <= later for earlier, later in pairwise(found))
    assert found[0] < 10.0 < 25.0 < found[-1]


def test_first_contact_lies_between_the_steps_around_it():
    # Slow, then suddenly shut: the line through the first steps would end at 30 kPa.
    pressure, gap = np.array([0.0, 5.0, 10.0, 15.0]), np.array([3.0, 2.5, 2.0, -0.01])
    assert first_contact_pressure(pressure, gap, WIDTH) == 15.0
    # Shutting fast, then slowly: not before the last step that was open.
    gap = np.array([3.0, 2.9, WIDTH + 1e-3, WIDTH - 1e-3])
    found = first_contact_pressure(pressure, gap, WIDTH)
    assert 10.0 <= found <= 10.1


def test_first_contact_where_the_last_open_steps_do_not_lead_to_it():
    # The gap opens a little before it shuts: the line through the two steps that shut it.
    pressure = np.array([0.0, 5.0, 10.0, 15.0, 20.0])
    gap = WIDTH + np.array([2.0, 0.5, 0.6, -0.02, -0.02])
    found = first_contact_pressure(pressure, gap, WIDTH)
    assert found == pytest.approx(10.0 + 5.0 * 0.6 / 0.62)


def test_without_walls_that_meet_there_is_no_first_contact():
    pressure = np.array([0.0, 10.0, 20.0])
    assert first_contact_pressure(pressure, WIDTH + np.array([2.0, 1.0, 0.01]), WIDTH) is None
    assert first_contact_pressure(pressure, np.full(3, np.nan), WIDTH) is None


def test_first_contact_is_known_exactly_where_a_step_is_pushed():
    """What the page calls touching and what has a first contact are the same designs."""
    pressure, gap = np.array([0.0, 30.0, 40.0, 50.0]), np.array([1.0, 0.3, 0.2, 0.0])
    gap[-1] = np.nextafter(WIDTH, 0.0)
    assert first_contact_pressure(pressure, gap, WIDTH) == pytest.approx(50.0)
    gap[-1] = WIDTH
    assert first_contact_pressure(pressure, gap, WIDTH) is None


def test_first_contact_with_gaps_that_are_unknown_or_shut_at_first():
    pressure = np.array([0.0, 5.0, 10.0, 15.0, 20.0])
    unknown = WIDTH + np.array([np.nan, np.nan, 0.5, 0.25, -0.01])
    assert first_contact_pressure(pressure, unknown, WIDTH) == pytest.approx(20.0)
    alone = WIDTH + np.array([np.nan, np.nan, np.nan, 0.25, -0.25])
    assert first_contact_pressure(pressure, alone, WIDTH) == pytest.approx(17.5)
    shut = np.array([0.01, -0.01, -0.02, -0.02, -0.02])
    assert first_contact_pressure(pressure, shut, WIDTH) == 0.0


def test_first_contact_behind_a_limit_point_lies_on_the_falling_branch():
    pressure = np.array([0.0, 10.0, 12.0, 11.0, 10.0, 9.4])
    gap = WIDTH + np.array([3.0, 2.0, 1.5, 0.9, 0.3, -0.005])
    # 0.6 mm a kPa, downwards from 0.3 mm at 10 kPa.
    assert first_contact_pressure(pressure, gap, WIDTH) == pytest.approx(9.5)
    assert first_contact_pressure(pressure, gap + 0.1, WIDTH) is None
