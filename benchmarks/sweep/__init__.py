"""The sweep over generated designs: a sample of them run, costs read, the whole extrapolated.

The command is ``benchmarks/sweep.py``.
"""
