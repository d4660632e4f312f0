"""Print every figure of the verification: ``python tests/verification``."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from cases_actuators import balance_of_energy, element_table, other_library, resultants, symmetries
from cases_contact import narrow_row, two_blocks
from cases_inflation import inflation
from cases_paper import paper
from cases_solid import (
    ELEMENTS,
    block_bending,
    convergence,
    cook_membrane,
    patch_test,
    rigid_rotation,
)
from figure import Case, Figure


def on_both_elements() -> list[Figure]:
    """Patch test and rigid rotation."""
    return [f for element in ELEMENTS for f in patch_test(element) + rigid_rotation(element)]


CASES: tuple[Case, ...] = (
    on_both_elements,
    inflation,
    convergence,
    block_bending,
    cook_membrane,
    paper,
    element_table,
    other_library,
    balance_of_energy,
    resultants,
    symmetries,
    two_blocks,
    narrow_row,
)


def main() -> int:
    """Print the figures as they come; 1 if one does not hold."""
    wrong = 0
    for case in CASES:
        for figure in case():
            print("holds " if figure.holds else "WRONG ", figure, flush=True)
            wrong += not figure.holds
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
