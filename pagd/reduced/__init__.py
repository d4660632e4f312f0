"""The reduced-order tier: one chamber instead of a whole row."""
