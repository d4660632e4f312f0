"""Design and simulate soft pneumatic actuators, from parameters to trajectories.

    from pagd import TSNE, ReducedSpaceMixture, generate, make_dataset

    data = make_dataset(size=2000, seed=1)
    plane = TSNE().fit(data.designs)
    generated = generate(ReducedSpaceMixture().fit(plane), 100, training=data.designs)
    generated.designs["mode"].value_counts()

What is listed in ``__all__`` is imported when it is asked for: ``import pagd`` alone costs nothing.
"""

from __future__ import annotations

import importlib

# As `typing` has it, whose import would take as long as all else that a served command imports.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from pagd.catalogue import read_designs
    from pagd.dataset.frame import designs_of, frame_of, read_frame, write_frame
    from pagd.dataset.make import Dataset, make_dataset
    from pagd.dataset.sampling import sample_designs
    from pagd.design import Design, GeometryRules
    from pagd.diversity import novelty
    from pagd.embedding.linear import FullSpace, PrincipalComponents
    from pagd.embedding.quality import quality_of
    from pagd.embedding.tsne import TSNE
    from pagd.encoding import Encoder
    from pagd.generators.baselines import RandomSampling, Resampling
    from pagd.generators.gaussian import FullSpaceMixture, PlainMixture, ReducedSpaceMixture
    from pagd.generators.generate import Generated, generate
    from pagd.generators.kernel_density import KernelDensityGenerator
    from pagd.selection import choose

__version__ = "0.1.0"

_HOMES = {
    "pagd.catalogue": ("read_designs",),
    "pagd.dataset.frame": ("designs_of", "frame_of", "read_frame", "write_frame"),
    "pagd.dataset.make": ("Dataset", "make_dataset"),
    "pagd.dataset.sampling": ("sample_designs",),
    "pagd.design": ("Design", "GeometryRules"),
    "pagd.diversity": ("novelty",),
    "pagd.embedding.linear": ("FullSpace", "PrincipalComponents"),
    "pagd.embedding.quality": ("quality_of",),
    "pagd.embedding.tsne": ("TSNE",),
    "pagd.encoding": ("Encoder",),
    "pagd.generators.baselines": ("RandomSampling", "Resampling"),
    "pagd.generators.gaussian": ("FullSpaceMixture", "PlainMixture", "ReducedSpaceMixture"),
    "pagd.generators.generate": ("Generated", "generate"),
    "pagd.generators.kernel_density": ("KernelDensityGenerator",),
    "pagd.selection": ("choose",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "TSNE",
    "Dataset",
    "Design",
    "Encoder",
    "FullSpace",
    "FullSpaceMixture",
    "Generated",
    "GeometryRules",
    "KernelDensityGenerator",
    "PlainMixture",
    "PrincipalComponents",
    "RandomSampling",
    "ReducedSpaceMixture",
    "Resampling",
    "choose",
    "designs_of",
    "frame_of",
    "generate",
    "make_dataset",
    "novelty",
    "quality_of",
    "read_designs",
    "read_frame",
    "sample_designs",
    "write_frame",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'pagd' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME_OF[name]), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
