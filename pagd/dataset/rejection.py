"""Drawing until there are enough: what breaks a rule or is there already is drawn again."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from pagd.dataset.category import Category
from pagd.design import Design, GeometryRules, Violation, violations
from pagd.errors import InputError
from pagd.long_work import long_work

__all__ = ["Sampled", "draw", "name_of"]

# Fewer than one in so many, after a fair trial, is a fault of the rules and no bad luck.
_LEAST_ONE_IN = 1_000
_FAIR_TRIAL = 100_000


@dataclass(slots=True)
class Sampled:
    """Designs that keep to the rules, and what it took to find them.

    Attributes
    ----------
    designs
        The designs, in the order they were drawn; no two are equal.
    drawn
        How many were drawn in all.
    rejected
        How many broke each rule; a design that breaks two is counted in both.
    duplicates
        How many valid ones were dropped as equal to another design.
    """

    designs: list[Design] = field(default_factory=list)
    drawn: int = 0
    rejected: Counter[str] = field(default_factory=Counter)
    duplicates: int = 0

    @property
    def rate(self) -> float:
        """Share of the drawn designs that was accepted; NaN if none was drawn."""
        return len(self.designs) / self.drawn if self.drawn else float("nan")


def draw(
    count: int,
    propose: Callable[[int], Iterable[Design]],
    category: Category,
    rules: GeometryRules,
    *,
    taken: set[Design] | None = None,
    origin: str = "random",
) -> Sampled:
    """Return ``count`` valid designs of a category, all different.

    Parameters
    ----------
    count
        How many.
    propose
        Draws as many designs as it is asked for, going on where it stopped.
    category
        What they must be; a slant of 0 would make a twisting design a bending one.
    rules
        The rules of the geometry, which every design returned keeps to.
    taken
        Designs that must not come again; the new ones are added.
    origin
        What the drawing is called in the message of an error.

    Raises
    ------
    InputError
        If after 100,000 draws fewer than 1 in 1,000 could be used.
    """
    found, taken = Sampled(), set() if taken is None else taken
    with long_work(f"{category}, {origin}", count, "designs") as shown:
        while (missing := count - len(found.designs)) > 0:
            # Never more than are missing: then the draws counted end with the last one accepted.
            for design in propose(missing):
                _judge(design, category, rules, taken, found)
                shown.reach(len(found.designs))
            _refuse_a_hopeless(found, category, origin)
    return found


def name_of(violation: Violation) -> str:
    """Return the rule that was broken, without the value of the design that broke it.

    >>> name_of(Violation("L", 6.0, "the cavity, L - 2 t_ab = 0.4 mm, must be at least 1 mm"))
    'L: the cavity, L - 2 t_ab, must be at least 1 mm'
    """
    return f"{violation.key}: {re.sub(r' = [-+.e0-9]+ mm', '', violation.rule)}"


def _judge(
    design: Design, category: Category, rules: GeometryRules, taken: set[Design], found: Sampled
) -> None:
    found.drawn += 1
    # In the order of the rules, which a set would not keep from run to run.
    broken = list(dict.fromkeys(name_of(violation) for violation in violations(design, rules)))
    if not broken and design.mode != category:
        broken = [f"theta: must be greater than 0 in a {category} design"]
    if broken:
        found.rejected.update(broken)
    elif design in taken:
        found.duplicates += 1
    else:
        taken.add(design)
        found.designs.append(design)


def _refuse_a_hopeless(found: Sampled, category: Category, origin: str) -> None:
    if found.drawn < _FAIR_TRIAL or len(found.designs) * _LEAST_ONE_IN >= found.drawn:
        return
    reasons = [f"{n:,} break '{rule}'" for rule, n in found.rejected.most_common(1)]
    if found.duplicates:
        reasons.append(f"{found.duplicates:,} are duplicates")
    raise InputError(
        f"Hardly any {category} design can be drawn ({origin}): only"
        f" {len(found.designs):,} of {found.drawn:,} are valid and new; {', '.join(reasons)}."
    )
