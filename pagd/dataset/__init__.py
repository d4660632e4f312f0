"""The data set: designs drawn at random, and around published ones."""
