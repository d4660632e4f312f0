"""The public data set that a run leaves: its tables by id and split, and what describes them."""
