"""Tests of first guesses from cells: in the stage solve, and of a path that guesses lead along."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from fem_checks import PAPER
from reduced_samples import ACTUATION, CHANNEL, ELASTOMER, SIZE, STRAIGHT, solved

from pagd import config as configuration
from pagd.actuation import Body, free_actuation
from pagd.actuation.model import Model
from pagd.catalogue import NamedDesign
from pagd.errors import Status
from pagd.fem.assembly import State
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.types import Mesh
from pagd.reduced.guide import RowGuide
from pagd.reduced.transfer import guess
from pagd.stages import chain
from pagd.stages.solve import materials_of
from pagd.states import read_states


class Misled:
    """Good guesses up to a number, and nonsense from there on."""

    def __init__(self, good: int) -> None:
        self._good = good
        self._reduced = solved(STRAIGHT, pieces=True)
        self._row = self._reduced.row(mesh().points, CHANNEL)
        self.pressure_kPa = self._reduced.pressure_kPa[1:]
        self.between_kPa = np.array([7.0])

    def state(self, body: Model, pressure_kPa: float) -> State:
        assert isinstance(body, Body)
        found = guess(body, self._reduced, self._row, pressure_kPa)
        if np.searchsorted(self.pressure_kPa, pressure_kPa) < self._good:
            return found
        return State(found.load, found.unknowns * 1.7, found.internal)


def mesh() -> Mesh:
    return chamber_row(STRAIGHT, CHANNEL, SIZE, half=True)


@pytest.mark.parametrize("good", [0, 1, 3])
def test_where_guesses_lead_no_further_the_path_goes_on(good: int) -> None:
    whole = free_actuation(mesh(), ELASTOMER, PAPER, ACTUATION)
    found = free_actuation(mesh(), ELASTOMER, PAPER, ACTUATION, guide=Misled(good))
    assert found.status is Status.ok
    assert [s.pressure_kPa for s in found.states] == [s.pressure_kPa for s in whole.states]
    np.testing.assert_allclose(
        found.states[-1].displacement, whole.states[-1].displacement, atol=0.02
    )
    recorded = found.history["recorded"]
    assert (np.diff(found.history["pressure_kPa"]) > 0).all()
    assert recorded.sum() == len(whole.states)
    if good > 1:
        between = found.history["pressure_kPa"][~recorded]
        assert 7.0 in between.tolist()


def test_guesses_end_where_the_analysis_would() -> None:
    def stop(pressure_kPa: float, moved: np.ndarray) -> tuple[Status, str] | None:
        return (Status.bending_limit, "enough") if pressure_kPa > 9 else None

    guide = RowGuide(STRAIGHT, CHANNEL, mesh(), SIZE, ELASTOMER, PAPER, ACTUATION, stop)
    assert guide.pressure_kPa.tolist() == [5.0, 10.0]
    found = free_actuation(mesh(), ELASTOMER, PAPER, ACTUATION, stop, guide=guide)
    assert found.status is Status.bending_limit
    assert found.states[-1].pressure_kPa == 10.0


def test_the_stage_solve_begins_with_cells(tmp_path: Path) -> None:
    given = {
        "mesh": {"block_mm": 12.0},
        "solve": {
            "maximum_pressure_kPa": 10.0,
            "recorded_step_kPa": 2.0,
            "blocked_force": "none",
        },
    }
    found = {}
    for way in ("cells", "path"):
        given["solve"]["first_guess"] = way  # type: ignore[index]
        config = configuration.load(json.dumps(given))
        named = NamedDesign(name="row", origin="own", design=STRAIGHT)
        chain.run(named, tmp_path / way, config, materials_of(config))
        found[way] = (
            json.loads((tmp_path / way / "solve" / "record.json").read_text("utf-8"))["figures"],
            read_states(tmp_path / way / "solve" / "states.parquet"),
        )
    (by_cells, states), (by_path, wanted) = found["cells"], found["path"]
    assert by_cells["cells"]["status"] == "ok"
    assert by_cells["guided_to_kPa"] == 10.0
    assert "cells" not in by_path
    assert by_cells["factorisations"] < by_path["factorisations"]
    np.testing.assert_allclose(states.pressure_kPa, wanted.pressure_kPa)
    np.testing.assert_allclose(states.displacement, wanted.displacement, atol=0.02)
