"""pagd beside other programs: CalculiX for whole analyses, FElupe and NGSolve for one iteration.

The command is ``benchmarks/peers.py``.
"""
