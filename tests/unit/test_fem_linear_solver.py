"""Both linear solvers on symmetric indefinite systems, and what they say of singular ones."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csr_array, eye_array, random_array, triu

import pagd.fem.linear_solver as module
from pagd.errors import InputError
from pagd.fem.linear_solver import (
    LinearSolver,
    PardisoSolver,
    SingularMatrixError,
    SuperLUSolver,
    linear_solver,
)

FloatArray = NDArray[np.float64]

NAMES = ["pardiso", "superlu"]


@pytest.fixture(params=NAMES)
def solver(request: pytest.FixtureRequest) -> Iterator[LinearSolver]:
    if request.param == "pardiso":
        pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    made = linear_solver(request.param)
    yield made
    made.free()


def saddle_point(displacements: int = 120, pressures: int = 15, seed: int = 0) -> csr_array:
    """A matrix as of P2–P1: stiff block, coupling, tiny negative block."""
    random = np.random.default_rng(seed)
    factor = random_array((displacements, displacements), density=0.03, rng=random)
    coupling = random_array((displacements, pressures), density=0.2, rng=random).toarray()
    matrix = np.zeros((displacements + pressures,) * 2)
    matrix[:displacements, :displacements] = (factor @ factor.T).toarray() + np.eye(displacements)
    matrix[:displacements, displacements:] = coupling
    matrix[displacements:, :displacements] = coupling.T
    matrix[displacements:, displacements:] = -1e-5 * np.eye(pressures)
    return csr_array(matrix)


def analyse(solver: LinearSolver, matrix: csr_array) -> FloatArray:
    """Hand over the pattern of the upper triangle; its values."""
    upper = csr_array(triu(matrix, format="csr"))
    upper.sort_indices()
    solver.analyse(upper.indptr.astype(np.int32), upper.indices.astype(np.int32))
    return np.asarray(upper.data)


def test_negative_pivots_are_as_many_as_negative_eigenvalues() -> None:
    pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    for shift in (0.0, 2.0, 20.0):
        matrix = csr_array(saddle_point() - shift * eye_array(135))
        made = PardisoSolver()
        values = analyse(made, matrix)
        made.solve(values, np.ones(135))
        expected = int((np.linalg.eigvalsh(matrix.toarray()) < 0).sum())
        assert made.negative_pivots == expected
        assert expected > 15 or shift == 0.0
        made.free()
    assert SuperLUSolver().negative_pivots is None


def test_another_right_hand_side_takes_the_same_factors(solver: LinearSolver) -> None:
    matrix = saddle_point()
    values = analyse(solver, matrix)
    first, second = np.linspace(-1, 2, matrix.shape[0]), np.cos(np.arange(matrix.shape[0]))
    solver.solve(values, first)
    np.testing.assert_allclose(matrix @ solver.solve_again(second), second, atol=1e-9)
    np.testing.assert_allclose(matrix @ solver.solve_again(first), first, atol=1e-9)


def test_solution_of_an_indefinite_system(solver: LinearSolver) -> None:
    matrix = saddle_point()
    values, right = analyse(solver, matrix), np.linspace(-1, 2, matrix.shape[0])
    exact = np.linalg.solve(matrix.toarray(), right)
    np.testing.assert_allclose(solver.solve(values, right), exact, rtol=1e-7, atol=1e-9)


def test_new_values_on_the_same_pattern(solver: LinearSolver) -> None:
    matrix = saddle_point()
    values, right = analyse(solver, matrix), np.ones(matrix.shape[0])
    solver.solve(values, right)
    exact = np.linalg.solve(3.0 * matrix.toarray(), right)
    np.testing.assert_allclose(solver.solve(3.0 * values, right), exact, rtol=1e-7, atol=1e-9)


def test_new_pattern(solver: LinearSolver) -> None:
    for seed, pressures in ((0, 15), (1, 10)):
        matrix = saddle_point(pressures=pressures, seed=seed)
        values, right = analyse(solver, matrix), np.ones(matrix.shape[0])
        exact = np.linalg.solve(matrix.toarray(), right)
        np.testing.assert_allclose(solver.solve(values, right), exact, rtol=1e-7, atol=1e-9)


def test_what_is_known_of_a_pattern_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    solver, matrix = PardisoSolver(), saddle_point()
    upper = csr_array(triu(matrix, format="csr"))
    upper.sort_indices()
    pattern = upper.indptr.astype(np.int32), upper.indices.astype(np.int32)
    right = np.ones(matrix.shape[0])
    analyses: list[int] = []
    phase = PardisoSolver._phase

    def counted(self: PardisoSolver, number: int, *more: FloatArray) -> FloatArray:
        analyses.extend([1] * (number == PardisoSolver._ANALYSE))
        return phase(self, number, *more)

    monkeypatch.setattr(PardisoSolver, "_phase", counted)
    for (starts, columns), is_ring, wanted in (
        (pattern, False, 1),
        (pattern, False, 1),
        (pattern, True, 2),
        ((pattern[0].copy(), pattern[1]), True, 3),
    ):
        solver.analyse(starts, columns, is_ring=is_ring)
        found = solver.solve(upper.data, right)
        np.testing.assert_allclose(matrix @ found, right, atol=1e-8)
        assert len(analyses) == wanted
    solver.free()
    solver.analyse(*pattern, is_ring=True)
    solver.solve(upper.data, right)
    assert len(analyses) == 4
    solver.free()


def test_inputs_are_left_alone(solver: LinearSolver) -> None:
    matrix = saddle_point()
    values, right = analyse(solver, matrix), np.ones(matrix.shape[0])
    before = values.copy(), right.copy()
    solver.solve(values, right)
    np.testing.assert_array_equal(values, before[0])
    np.testing.assert_array_equal(right, before[1])


def test_singular_matrix(solver: LinearSolver) -> None:
    """A body that is not held: the stiffness of a free chain of springs."""
    count = 30
    chain = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    chain[0, 0] = chain[-1, -1] = 1.0
    values = analyse(solver, csr_array(chain))
    with pytest.raises(SingularMatrixError):
        solver.solve(values, np.linspace(0, 1, count))


def test_zero_matrix(solver: LinearSolver) -> None:
    values = analyse(solver, csr_array(np.eye(5)))
    with pytest.raises(SingularMatrixError):
        solver.solve(0 * values, np.ones(5))


def test_entries_that_are_not_finite(solver: LinearSolver) -> None:
    matrix = saddle_point()
    values = analyse(solver, matrix)
    values[3] = np.nan
    with pytest.raises(SingularMatrixError):
        solver.solve(values, np.ones(matrix.shape[0]))


def test_solver_by_name() -> None:
    assert linear_solver("superlu").name == "superlu"
    assert isinstance(linear_solver("superlu"), SuperLUSolver)


def test_auto_takes_pardiso_where_there_is_mkl() -> None:
    pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    assert isinstance(linear_solver("auto"), PardisoSolver)


def test_auto_does_without_mkl(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pypardiso", None)
    module._pardiso_entry_point.cache_clear()
    assert linear_solver("auto").name == "superlu"


def test_unknown_solver_is_refused() -> None:
    with pytest.raises(InputError, match=r"linear_solver is 'mumps'.*auto, pardiso, superlu"):
        linear_solver("mumps")


def test_the_solution_does_not_depend_on_the_ordering() -> None:
    pytest.importorskip("pypardiso")
    random = np.random.default_rng(5)
    matrix = csr_array(np.diag(np.full(40, 9.0)))
    dense = random.normal(size=(40, 40)) * (random.random((40, 40)) < 0.1)
    matrix = csr_array(matrix.toarray() + dense + dense.T)
    upper = csr_array(np.triu(matrix.toarray()))
    upper.sort_indices()
    right, solutions = random.normal(size=40), []
    for is_ring in (False, True):
        solver = linear_solver("pardiso")
        starts, columns = upper.indptr.astype(np.int32), upper.indices.astype(np.int32)
        solver.analyse(starts, columns, is_ring=is_ring)
        solutions.append(solver.solve(upper.data, right))
        solver.free()
    assert solutions[0] == pytest.approx(solutions[1], rel=1e-9)
    assert matrix @ solutions[1] == pytest.approx(right)
