"""Meshers that do what meshers should not, to be named as ``misbehaving_meshers:…``."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

from pagd.mesh.gmsh_mesher import GmshMesher
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.types import Mesh

#: Where the hanging mesher leaves the number of the process it starts.
CHILD_FILE = "PAGD_TEST_CHILD_FILE"


class Hanging:
    name = "hanging"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
        Path(os.environ[CHILD_FILE]).write_text(str(child.pid))
        time.sleep(600)
        raise AssertionError("it was to be killed")


class Crashing:
    name = "crashing"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        os.kill(os.getpid(), signal.SIGSEGV)
        raise AssertionError("it was to crash")


class Killed:
    """As the kernel does it where memory is short."""

    name = "killed"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError("it was to be killed")


class Raising:
    name = "raising"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        raise MemoryError("all gone")


class Shrinking:
    """Returns a sound mesh of something smaller."""

    name = "shrinking"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        mesh = GmshMesher()(surfaces, size)
        return replace(mesh, points=0.98 * mesh.points)
