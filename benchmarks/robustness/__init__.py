"""Random designs through the whole chain: drawing, running each on its own, and what comes of it.

The command is ``benchmarks/random_designs.py``.
"""
