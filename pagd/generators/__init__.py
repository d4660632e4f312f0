"""Generators of designs: mixtures of Gaussians, kernel density, and baselines."""

from pagd.generators.generate import Generated, generate
from pagd.generators.interface import Generator, Proposal
from pagd.generators.registry import GENERATORS, make_generator

__all__ = ["GENERATORS", "Generated", "Generator", "Proposal", "generate", "make_generator"]
