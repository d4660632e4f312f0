"""What is written under the pictures of simulated designs: how each was made."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

__all__ = ["SUPPORTS", "TOGETHER", "captions_of_design"]

_ANGLES = (
    "Bending is the rotation about the width axis, positive towards the paper, and twist that about"
    " the axis of the actuator, both summed over the joints between chambers, so that they pass"
    " 180°."
)

#: Variant of the blocked force to what holds the actuator.
SUPPORTS: Final[Mapping[str, str]] = {
    "edge": "lower edge of the tip held",
    "plate": "on a rigid plate",
}

# Pictures of one design, in the order of the page.
_OF_DESIGN: Final[Mapping[str, str]] = {
    "deformed": "Deformed shapes at rising pressure, undeformed in grey, by finite elements at"
    " finite strain. Colour: largest principal logarithmic strain; its bar ends where 1 % of the"
    " nodes are beyond.",
    "contact": "Left: the smallest gap between walls that face each other; what is below zero is"
    " penetration, by which the penalty of frictionless contact works. Right: the actuator at the"
    " last pressure of each analysis, transparent; where walls touch, red: outside that is nearer"
    " than {touching} mm to another wall, where the contact law begins to push, both sides"
    " counted.",
    "blocked_force": "Left: the force of the actuator on what holds its tip from the start,"
    " positive downwards; large dots are recorded states. Right: the last shape so held, beside"
    " the free one at the nearest recorded pressure, undeformed in grey.",
    "pressure_volume": "Pressure over the volume of the cavity in free actuation. The shaded area"
    " is the work of the pressure. Where the pressure can rise no further, at a limit point, the"
    " volume is raised instead and the pressure falls.",
    "geometry": "The drawn geometry, cut open along its middle, with the dimensions it was drawn"
    " by.",
    "mesh": "Quadratic tetrahedra, cut open down to the paper, with the surfaces that supports and"
    " pressure act on, and the quality of the elements (scaled Jacobian).",
}

#: Pictures of all designs, in the order of the page.
TOGETHER: Final[Mapping[str, str]] = {
    "gallery": "Deformed shapes at the last pressure each design reached, undeformed in grey"
    " (Fig. 6 of the paper), all on one scale and seen from one side; each row has designs of one"
    " mode where there are many. Colour: largest principal logarithmic strain at the nodes; a few"
    " may be beyond the bar. What did not come to the full pressure is named below the angles.",
    "trajectories": "Where the tips go under rising pressure, and centre lines (the paper, section"
    " by section) at the last pressure (Fig. 7 of the paper). A section lies where the mean"
    " motion of its nodes takes it; equal scales in all panels.",
    "angles": f"Bending and twist of the tips against pressure, and of every chamber at the last"
    f" pressure. {_ANGLES}",
    "forces": "Blocked force against pressure: the force on the support of an actuator whose tip is"
    " held from the start. Each curve ends where its analysis did.",
    "paths": "Where the tips go under rising pressure, a marker at every recorded pressure; wide"
    " and pale: centre lines at the last pressure. Point at a marker for its pressure.",
}


def captions_of_design() -> dict[str, str]:
    """Return the captions of the pictures of one design by their names, in the page's order."""
    from pagd.figures.style import number  # imports Matplotlib
    from pagd.figures.touching import touching_mm  # imports SciPy

    touching = number(touching_mm(), 2)
    return {name: text.format(touching=touching) for name, text in _OF_DESIGN.items()}
