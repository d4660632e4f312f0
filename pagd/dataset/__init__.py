"""The data set: designs drawn at random, and around published ones."""

from pagd.dataset.augmentation import interpolated_designs, jittered_designs
from pagd.dataset.frame import (
    CATEGORICAL,
    DEPENDENT,
    INDEPENDENT,
    completed,
    designs_of,
    frame_of,
    read_frame,
    write_frame,
)
from pagd.dataset.make import Dataset, make_dataset
from pagd.dataset.rejection import Sampled
from pagd.dataset.sampling import METHODS, sample_designs

__all__ = [
    "CATEGORICAL",
    "DEPENDENT",
    "INDEPENDENT",
    "METHODS",
    "Dataset",
    "Sampled",
    "completed",
    "designs_of",
    "frame_of",
    "interpolated_designs",
    "jittered_designs",
    "make_dataset",
    "read_frame",
    "sample_designs",
    "write_frame",
]
