"""One figure of the verification: what was expected, what was found, what may differ."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """A computed value beside its reference.

    Attributes
    ----------
    name
        What was computed: body, material, mesh, load.
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
    def holds(self) -> bool:
        """Whether the error is within the tolerance; a value that is no number is not."""
        return abs(self.error) <= self.tolerance

    def __str__(self) -> str:
        error, allowed = (_percent(value) for value in (self.error, self.tolerance))
        return (
            f"{self.name}: {self.value:.6g} {self.unit}".rstrip()
            + f", expected {self.reference:.6g} (error {error}, allowed {allowed})"
        )


def _percent(value: float) -> str:
    return f"{value:.2%}" if abs(value) >= 1e-4 else f"{value:.0e}"


Case = Callable[[], list[Figure]]


def check(figures: Iterable[Figure]) -> None:
    """Raise AssertionError with every figure that does not hold."""
    found = list(figures)
    assert found, "the case gives no figures"
    wrong = [str(figure) for figure in found if not figure.holds]
    assert not wrong, "\n".join(wrong)
