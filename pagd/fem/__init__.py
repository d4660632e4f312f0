"""Quasi-static finite-strain finite elements: energy terms, assembly, Newton, continuation.

A body is a sum of energy terms (:mod:`~pagd.fem.term`) over one vector of
unknowns. :class:`~pagd.fem.assembly.Assembly` adds them up,
:class:`~pagd.fem.newton.Newton` finds equilibrium at a load and
:class:`~pagd.fem.continuation.Continuation` follows it as the load rises;
:class:`~pagd.fem.conjugate.ConjugatePath` goes on past limit points of the load.
"""

import os

# Left to itself Numba tries TBB first, and warns where it finds one that is too old. It reads the
# environment when it is first imported, which the modules of this package do.
os.environ.setdefault("NUMBA_THREADING_LAYER_PRIORITY", "omp workqueue tbb")
