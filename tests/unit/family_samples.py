"""A family of a user's own, as three files that are no part of pagd, and designs of families."""

from __future__ import annotations

from pathlib import Path

#: A half-bellows of two convolutions.
BELLOWS = {
    "name": "bellows", "family": "half_bellows", "N": 2, "q": 11.0, "w": 4.0, "R": 7.0, "L_c": 5.0,
    "L_r": 2.0, "t": 2.0, "t_e": 2.0, "t_b": 3.0, "b_f": 1.0,
}  # fmt: skip

#: A bar with a square channel along it.
BAR = {"name": "bar", "family": "hollow_bar:HollowBar", "a": 8.0, "L": 30.0, "wall": 2.0}

TABLE = """\
symbol,unit,low,high,whole,description
a,mm,4,20,no,side of the bar
L,mm,20,60,no,length of the bar
wall,mm,1,4,no,thickness of every wall
"""

MODEL = """\
a = 10; // [4:0.1:20]
L = 40; // [20:1:60]
wall = 2; // [1:0.1:4]
part = "body";
half = false;

module body() {
    difference() {
        translate([0, -a / 2, 0]) cube([L, a, a]);
        translate([wall, wall - a / 2, wall]) cube([L - 2 * wall, a - 2 * wall, a - 2 * wall]);
    }
}
module base() { translate([0, -a / 2, -wall]) cube([L, a, wall]); }

intersection() {
    if (part == "body") body(); else base();
    translate([-L, half ? 0 : -2 * a, -2 * a]) cube([3 * L, 4 * a, 4 * a]);
}
"""

MODULE = '''\
"""A bar with a square channel: thin roof, paper below."""

from pagd.design import Violation
from pagd.families import TabledActuator


class HollowBar(TabledActuator):
    """A hollow bar on a base as thick as its walls."""

    @property
    def L_T(self):
        """Total length, mm."""
        return self["L"]

    @property
    def is_symmetric(self):
        """It always is."""
        return True

    def broken(self, rules):
        """Yield what is broken: the channel must have room."""
        room = self["a"] - 2 * self["wall"]
        if room < rules.limits.cavity:
            yield Violation("wall", self["wall"], f"leaves {room:g} mm for the channel")
'''


def write_family(folder: Path, **texts: str) -> None:
    """Write the three files of the hollow bar; texts replace those of an ending (py, csv, scad)."""
    for ending, text in ({"py": MODULE, "csv": TABLE, "scad": MODEL} | texts).items():
        (folder / f"hollow_bar.{ending}").write_text(text)
