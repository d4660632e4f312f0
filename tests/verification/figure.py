"""One row of the verification: what was expected, what was found, what may differ."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum

from pagd.fem.linear_solver import linear_solver


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """A computed value beside its reference.

    Attributes
    ----------
    name
        What was computed: body, material, mesh, load.
    source
        Where the reference comes from: a formula by its name, a paper, another program with its
        version, an identity.
    reference, value
        In the unit given.
    tolerance
        Largest error allowed.
    unit
        Empty for numbers without one.
    scale
        What the error is relative to: the reference unless given, e.g. where that is zero.
    """

    name: str
    source: str
    reference: float
    value: float
    tolerance: float
    unit: str = ""
    scale: float | None = None

    @property
    def error(self) -> float:
        """(value − reference) / scale."""
        return (self.value - self.reference) / abs(self.scale or self.reference)

    @property
    def passes(self) -> bool:
        """Whether the error is within the tolerance; a value that is no number is not."""
        return bool(abs(self.error) <= self.tolerance)

    def __str__(self) -> str:
        error, allowed = (percent(value) for value in (self.error, self.tolerance))
        return (
            f"{self.name}: {self.value:.6g} {self.unit}".rstrip()
            + f", expected {self.reference:.6g} (error {error}, allowed {allowed})"
        )


def percent(value: float) -> str:
    """A share in percent, in scientific notation where it is tiny."""
    return f"{value:.2%}" if value == 0 or abs(value) >= 1e-4 else f"{value:.0e}"


class Group(StrEnum):
    """What a case is about, in the order of the page."""

    solids = "Elements and material"
    rates = "Rates of convergence"
    paper = "Paper"
    pressure = "Pressure and energy"
    contact = "Contact"
    supports = "Supports and gravity"
    symmetry = "Symmetries"
    cells = "Cells of rows"
    programs = "Other programs"
    meshes = "Mesh convergence of the examples"


Rows = Callable[[], list[Figure]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Rows that are computed together.

    Attributes
    ----------
    rows
        Computes them; its docstring says what is compared, and why the tolerance is what it is.
    group
        Where they stand on the page.
    costly
        Whether they take too long for the tests.
    program
        A program they need, on the path, or "MKL"; without it they are left out.
    """

    rows: Rows
    group: Group
    costly: bool = False
    program: str | None = None

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.rows.__name__

    @property
    def is_possible(self) -> bool:
        """Whether the program they need is there."""
        if self.program == "MKL":
            return linear_solver().name == "pardiso"
        return self.program is None or shutil.which(self.program) is not None


def check(figures: Iterable[Figure]) -> None:
    """Raise AssertionError with every figure that does not pass."""
    found = list(figures)
    assert found, "the case gives no figures"
    wrong = [str(figure) for figure in found if not figure.passes]
    assert not wrong, "\n".join(wrong)
