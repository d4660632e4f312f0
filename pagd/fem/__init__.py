"""Quasi-static finite-strain finite elements: energy terms, assembly, Newton, continuation.

A body is a sum of energy terms (:mod:`~pagd.fem.term`) over one vector of
unknowns. :class:`~pagd.fem.assembly.Assembly` adds them up,
:class:`~pagd.fem.newton.Newton` finds equilibrium at a load and
:class:`~pagd.fem.continuation.Continuation` follows it as the load rises.
"""
