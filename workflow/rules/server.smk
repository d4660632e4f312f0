# One process that has everything loaded runs the stages of all designs, each in a fork of its own:
# imports and compiled kernels are paid once a run, not five times a design. Without it, on other
# machines of a cluster or by hand, the same commands run by themselves.

from pagd.cli import server


onstart:
    server.start()
