"""Design and simulate soft pneumatic actuators, from parameters to trajectories."""

__version__ = "0.1.0"
