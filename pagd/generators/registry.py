"""Generators by their names in the configuration. A new one: a class, and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from pagd.design import GeometryRules
from pagd.generators.baselines import RandomSampling, Resampling
from pagd.generators.gaussian import FullSpaceMixture, PlainMixture, ReducedSpaceMixture
from pagd.generators.interface import Generator
from pagd.generators.kernel_density import KernelDensityGenerator

__all__ = ["GENERATORS", "make_generator"]

Section = Mapping[str, Any]


def _mixture_options(given: Section) -> dict[str, Any]:
    return {key: given[key] for key in ("components", "largest_components", "bridge_share")}


#: Name to a function that makes the generator from the section ``generator`` of a configuration
#: and the rules of the geometry.
GENERATORS: Final[Mapping[str, Callable[[Section, GeometryRules], Generator]]] = {
    "gmm": lambda given, rules: ReducedSpaceMixture(**_mixture_options(given)),
    "gmm_plain": lambda given, rules: PlainMixture(
        given["components"], given["largest_components"]
    ),
    "gmm_full": lambda given, rules: FullSpaceMixture(**_mixture_options(given)),
    "kde": lambda given, rules: KernelDensityGenerator(given["bandwidth"]),
    "random": lambda given, rules: RandomSampling(rules),
    "resample": lambda given, rules: Resampling(),
}


def make_generator(section: Section, rules: GeometryRules) -> Generator:
    """Return the generator, not fitted, that the section ``generator`` asks for."""
    return GENERATORS[section["method"]](section, rules)
