"""What stands in the place of a picture for those who do not see it: one sentence each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

__all__ = ["ALTERNATIVES", "alternative"]

#: Name of the picture to what it shows.
ALTERNATIVES: Final[Mapping[str, str]] = {
    "deformed": "Views of the actuator at rising pressure, coloured by strain",
    "geometry": "View of the actuator cut open along its middle, with its dimensions",
    "mesh": "View of the tetrahedra cut open down to the paper, and histogram of their quality",
    "gallery": "All simulated actuators side by side, deformed and coloured by strain",
    "trajectories": "Paths of the tips and centre lines of all simulated actuators",
    "angles": "Curves of bending and twist against pressure, and of every chamber",
    "forces": "Curves of blocked force against pressure of all simulated actuators",
    "pressure_volume": "Curve of pressure against cavity volume, with the recorded states",
    "contact": "Curve of the smallest gap between walls against pressure, and view of the deformed"
    " actuator with the places where walls touch",
    "blocked_force": "Curve of blocked force against pressure, and views of the actuator free and"
    " held",
    "embedding": "Two scatter plots of the training designs in the plane: by category, by origin",
    "mixture": "Scatter plot of the generated designs in the plane with the Gaussians' ellipses,"
    " curve of the information criterion, histogram of the share of helical chambers",
    "hull": "Convex hulls of training and generated designs in the plane, and histogram of areas",
    "comparison": "Dot plots of every measure of novelty and diversity, one row a generator",
    "distributions": "Histograms of the eleven parameters of generated and training designs",
    "feasibility": "Bars of how the simulated designs ended, by mode and by origin, and table of"
    " modes drawn against modes measured",
    "bending_twist": "Scatter plot of bending against twist of all simulated designs, by mode",
    "force_bending": "Scatter plot of blocked force against bending of all simulated designs",
    "novelty_performance": "Scatter plots of performance against novelty of all simulated designs",
    "screened": "Scatter plots of bending, twist and blocked force of screened designs, generated"
    " and training, with their Pareto fronts",
    "screened_novelty": "Scatter plots of performance against novelty of screened designs",
    "screened_beside_full": "Scatter plots of performance by cells against the full analysis",
}


def alternative(name: str, subject: str = "") -> str:
    """Return the text for a picture by its name, and whose picture it is if that is given.

    >>> alternative("mesh", "bending").endswith("quality: bending.")
    True
    """
    text = ALTERNATIVES.get(name, name.replace("_", " "))
    return f"{text}: {subject}." if subject else f"{text}."
