"""Sparse symmetric indefinite systems: MKL Pardiso where it exists, SciPy elsewhere.

Both stand behind :class:`LinearSolver`: analyse the pattern once, factorise as
often as the values change, solve as often as the right-hand side does.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Sequence
from functools import cache
from importlib.metadata import PackageNotFoundError, PackagePath, files
from pathlib import Path
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem.clock import Clock

FloatArray = NDArray[np.float64]
Int32Array = NDArray[np.int32]


class SingularMatrixError(ArithmeticError):
    """The matrix cannot be factorised."""


class LinearSolver(Protocol):
    """Solves A x = b for the upper triangle of A in CSR form."""

    name: str
    clock: Clock
    """Where its time goes: ``analysis``, ``factorisation``, ``solution``."""

    factorisations: int
    """How many there have been."""

    @property
    def negative_pivots(self) -> int | None:
        """Negative pivots of the matrix factorised last; none where the solver cannot tell.

        As many as the matrix has negative eigenvalues (Sylvester's law of inertia).
        """
        ...

    @property
    def factor_nonzeros(self) -> int | None:
        """Non-zeros of the factors; none where the solver cannot tell."""
        ...

    def analyse(self, starts: Int32Array, columns: Int32Array, *, is_ring: bool = False) -> None:
        """Take a pattern: row starts (m + 1,) and sorted columns (z,), the diagonal included.

        Of a body whose ends are tied to each other it ``is_ring``: no chain, and no slender body.
        What is known of the same two arrays already need not be found anew.
        """
        ...

    def solve(self, values: FloatArray, right: FloatArray) -> FloatArray:
        """Factorise the matrix of ``values`` (z,) and solve for ``right`` (m,).

        Raises ``SingularMatrixError``.
        """
        ...

    def solve_again(self, right: FloatArray) -> FloatArray:
        """Solve for another right-hand side (m,) with the matrix factorised last."""
        ...

    def free(self) -> None:
        """Give the memory back."""
        ...


#: Tells pypardiso where MKL is.
_LIBRARY = "PYPARDISO_MKL_RT"


def _files_of(package: str) -> Sequence[PackagePath]:
    """The files of an installed package; none where it is not installed by pip."""
    try:
        return files(package) or ()
    except PackageNotFoundError:
        return ()


@cache
def _pardiso_entry_point() -> Callable[..., None]:
    """The function ``pardiso`` of MKL; looking for the library once is enough."""
    if _LIBRARY not in os.environ:
        # Where it is told no place, pypardiso searches the whole environment: 0.2 to 2 s.
        places = [Path(str(f.locate())) for f in _files_of("mkl") if "mkl_rt" in f.name]
        found = [str(place) for place in places if place.is_file()]
        if found:
            os.environ[_LIBRARY] = found[0]
    from pypardiso import PyPardisoSolver

    entry: Callable[..., None] = PyPardisoSolver()._mkl_pardiso
    return entry


@cache
def _trimmer() -> Callable[[int], int] | None:
    """The function of the C library that gives free memory back; none where there is none."""
    return getattr(ctypes.CDLL(None), "malloc_trim", None) if os.name == "posix" else None


def _trim() -> None:
    """Give free memory back: among what is still in use, new factors would find no room in it."""
    trimmer = _trimmer()
    if trimmer is not None:
        trimmer(0)


class PardisoSolver:
    """MKL Pardiso through the library that pypardiso finds.

    The entry point is called directly: pypardiso's own ``solve`` takes no
    symmetric matrices and copies and compares the matrix at every call.
    """

    name = "pardiso"

    # Indices of Pardiso's parameters, counted from zero (oneMKL reference, "pardiso
    # iparm Parameter").
    _PARAMETERS: ClassVar[dict[int, int]] = {
        0: 1,  # the values below, not the defaults
        7: 0,  # refine only where pivots were perturbed
        9: 8,  # perturb pivots below 1e-8: the default of symmetric indefinite matrices
        10: 1,  # scaling: the block of the pressures has a tiny diagonal
        12: 0,  # no weighted matching: it doubles the analysis, and no pivot needs it
        23: 0,  # one-level factorisation: the other is for many threads
        34: 1,  # zero-based indices
    }
    # Minimum degree has 5 to 25 % fewer operations than nested dissection (METIS) on slender
    # bodies; where their ends are tied to each other, it has half as many again.
    _ORDERING, _MINIMUM_DEGREE, _NESTED_DISSECTION = 1, 0, 2
    _SYMMETRIC_INDEFINITE = -2
    _PERTURBED_PIVOTS, _FACTOR_NONZEROS, _NEGATIVE_PIVOTS = 13, 17, 22  # numbers, outputs
    _RELEASE, _ANALYSE, _FACTORISE, _SOLVE = -1, 11, 22, 33

    def __init__(self) -> None:
        self.clock, self.factorisations = Clock(), 0
        self._call = _pardiso_entry_point()
        self._handle = np.zeros(64, np.int64)
        self._parameters = np.zeros(64, np.int32)
        for index, value in self._PARAMETERS.items():
            self._parameters[index] = value
        self._analysed = False
        self._starts = self._columns = np.zeros(0, np.int32)
        self._values: FloatArray = np.zeros(0)

    def _phase(self, phase: int, values: FloatArray, right: FloatArray) -> FloatArray:
        result = np.zeros_like(right)
        error = ctypes.c_int32(0)
        one, size = ctypes.c_int32(1), ctypes.c_int32(len(self._starts) - 1)
        kind, silent = ctypes.c_int32(self._SYMMETRIC_INDEFINITE), ctypes.c_int32(0)
        number = ctypes.POINTER(ctypes.c_int32)
        self._call(
            self._handle.ctypes.data_as(ctypes.POINTER(ctypes.c_int64)),
            ctypes.byref(one),
            ctypes.byref(one),
            ctypes.byref(kind),
            ctypes.byref(ctypes.c_int32(phase)),
            ctypes.byref(size),
            values.ctypes.data,
            self._starts.ctypes.data_as(number),
            self._columns.ctypes.data_as(number),
            ctypes.byref(ctypes.c_int32(0)),
            ctypes.byref(one),
            self._parameters.ctypes.data_as(number),
            ctypes.byref(silent),
            right.ctypes.data,
            result.ctypes.data,
            ctypes.byref(error),
        )
        if error.value:
            raise SingularMatrixError(f"Pardiso ended phase {phase} with error {error.value}")
        return result

    def analyse(self, starts: Int32Array, columns: Int32Array, *, is_ring: bool = False) -> None:
        """Take a new pattern; the symbolic factorisation waits for the first values.

        What is known of the same arrays is kept.
        """
        ordering = self._NESTED_DISSECTION if is_ring else self._MINIMUM_DEGREE
        is_same = starts is self._starts and columns is self._columns
        if self._analysed and is_same and ordering == self._parameters[self._ORDERING]:
            return
        self.free()
        self._parameters[self._ORDERING] = ordering
        self._starts, self._columns = starts, columns

    def solve(self, values: FloatArray, right: FloatArray) -> FloatArray:
        """Factorise and solve; the first call after :meth:`analyse` orders the matrix too."""
        if not np.isfinite(values).all():
            raise SingularMatrixError("the matrix has entries that are not finite")
        if not self._analysed:
            # Scaling looks at the values, so the analysis needs them.
            self._parameters[self._FACTOR_NONZEROS] = -1  # asks for the number
            with self.clock.part("analysis"):
                self._phase(self._ANALYSE, values, right)
            self._analysed = True
        with self.clock.part("factorisation"):
            self._phase(self._FACTORISE, values, right)
        self.factorisations += 1
        self._values = values
        return self.solve_again(right)

    def solve_again(self, right: FloatArray) -> FloatArray:
        """Solve with the factors of the last call of :meth:`solve`, and its values unchanged."""
        with self.clock.part("solution"):
            result = self._phase(self._SOLVE, self._values, right)
        if self._parameters[self._PERTURBED_PIVOTS]:
            self._check(self._values, right, result)
        return result

    @property
    def negative_pivots(self) -> int | None:
        """Number of negative eigenvalues of the matrix factorised last."""
        return int(self._parameters[self._NEGATIVE_PIVOTS])

    @property
    def factor_nonzeros(self) -> int | None:
        """Non-zeros of the factors of the pattern analysed last."""
        return int(self._parameters[self._FACTOR_NONZEROS]) or None

    def _check(self, values: FloatArray, right: FloatArray, result: FloatArray) -> None:
        """Pardiso replaces vanishing pivots and goes on: see whether the result is a solution."""
        from scipy.sparse import csr_array

        size = len(right)
        upper = csr_array((values, self._columns, self._starts), shape=(size, size))
        residual = upper @ result + upper.T @ result - upper.diagonal() * result - right
        if not np.linalg.norm(residual) <= 1e-6 * np.linalg.norm(right):
            raise SingularMatrixError("the matrix is singular")

    def free(self) -> None:
        """Give the memory of the factors back."""
        if self._analysed:
            empty = np.zeros(1)
            self._phase(self._RELEASE, empty, empty)
            self._analysed = False
            _trim()


class SuperLUSolver:
    """SciPy's SuperLU; works everywhere, several times slower."""

    name = "superlu"
    # Rows are exchanged without the columns: the pivots have other signs than the eigenvalues.
    negative_pivots: int | None = None
    factor_nonzeros: int | None = None

    def __init__(self) -> None:
        self.clock, self.factorisations = Clock(), 0
        self._starts = self._columns = np.zeros(0, np.int32)
        self._factors: Any = None

    def analyse(self, starts: Int32Array, columns: Int32Array, *, is_ring: bool = False) -> None:
        """Take a pattern; SuperLU orders it anew at each factorisation."""
        self._starts, self._columns = starts, columns

    def solve(self, values: FloatArray, right: FloatArray) -> FloatArray:
        """Factorise and solve."""
        from scipy.sparse import csc_array, csr_array
        from scipy.sparse.linalg import splu

        size = len(self._starts) - 1
        upper = csr_array((values, self._columns, self._starts), shape=(size, size))
        diagonal = csr_array((upper.diagonal(), (np.arange(size), np.arange(size))))
        full = csc_array(upper + upper.T - diagonal)
        try:
            with self.clock.part("factorisation"):
                self._factors = splu(full, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from None
        self.factorisations += 1
        return self.solve_again(right)

    def solve_again(self, right: FloatArray) -> FloatArray:
        """Solve with the factors of the last call of :meth:`solve`."""
        with self.clock.part("solution"):
            return np.asarray(self._factors.solve(right))

    def free(self) -> None:
        """Give the memory of the factors back."""
        self._factors = None


_SOLVERS: dict[str, Callable[[], LinearSolver]] = {
    "pardiso": PardisoSolver,
    "superlu": SuperLUSolver,
}


def linear_solver(name: str = "auto") -> LinearSolver:
    """Make a solver by name; ``auto`` takes Pardiso where MKL can be loaded."""
    if name == "auto":
        try:
            return PardisoSolver()
        except ImportError:
            return SuperLUSolver()
    if name not in _SOLVERS:
        raise InputError(
            f"linear_solver is {name!r}, but must be one of auto, {', '.join(sorted(_SOLVERS))}"
        )
    return _SOLVERS[name]()
