"""Faults done to a small sweep on purpose, and what is left of it after them."""
