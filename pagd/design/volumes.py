"""Exact volumes of a design, in closed form: what a mesh is measured against.

They hold for valid designs. A shear keeps volumes, so a slanted chamber has the volume of a
straight one; and the length of the channel between two cavities varies linearly over y, so its
mean is its length at y = 0, also at the wedge where helical chambers give way to straight ones.
"""

from __future__ import annotations

import numpy as np

from pagd.design.model import Design
from pagd.design.rules import GeometryRules

__all__ = ["base_volume", "body_volume", "cavity_volume", "solid_volume"]


def base_volume(design: Design) -> float:
    """Volume (mm^3) of the part below the paper, z from -t_b to -t_b / 2."""
    return design.L_T * design.W * design.t_b / 2


def body_volume(design: Design, rules: GeometryRules) -> float:
    """Volume (mm^3) of the part above the paper: half the base, gap floor and chambers, hollow."""
    floor = rules.channel.gap_floor
    slab = design.L_T * design.W * (design.t_b / 2 + floor)
    chambers = design.N * design.L * design.W * (design.H - floor)
    return slab + chambers - cavity_volume(design, rules)


def cavity_volume(design: Design, rules: GeometryRules) -> float:
    """Volume (mm^3) of the air: the chambers' cavities and the channel between them."""
    walls = design.end_wall_lengths()
    starts = design.chamber_starts()
    section = (design.W - 2 * design.t) * (design.H - design.t_h)
    chambers = section * np.sum(design.L - 2 * walls)
    between = (starts[1:] + walls[1:]) - (starts[:-1] + design.L - walls[:-1])
    return float(chambers + rules.channel.width * rules.channel.height * between.sum())


def solid_volume(design: Design, rules: GeometryRules) -> float:
    """Volume (mm^3) of the elastomer: body and base."""
    return body_volume(design, rules) + base_volume(design)
