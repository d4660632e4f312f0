"""Design and simulate soft pneumatic actuators, from parameters to trajectories.

    from pagd import TSNE, ReducedSpaceMixture, generate, make_dataset

    data = make_dataset(size=2000, seed=1)
    plane = TSNE().fit(data.designs)
    generated = generate(ReducedSpaceMixture().fit(plane), 100, training=data.designs)
    generated.designs["mode"].value_counts()

In a notebook a design and the result of a simulation show themselves as pictures:

    pagd.simulate(pagd.read_designs({"table2": "config/table2.csv"})["mixed"], pressure_kPa=20)

What is listed in ``__all__`` is imported when it is asked for: ``import pagd`` alone costs nothing.
"""

from __future__ import annotations

import importlib
import sys

# As `typing` has it, whose import would take as long as all else that a served command imports.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from pagd.catalogue import read_designs
    from pagd.dataset.frame import designs_of, frame_of, read_frame, write_frame
    from pagd.dataset.make import Dataset, make_dataset
    from pagd.dataset.sampling import sample_designs
    from pagd.design import Design, GeometryRules, violations
    from pagd.diversity import novelty
    from pagd.embedding.linear import FullSpace, PrincipalComponents
    from pagd.embedding.quality import quality_of
    from pagd.embedding.tsne import TSNE
    from pagd.encoding import Encoder
    from pagd.generators.baselines import RandomSampling, Resampling
    from pagd.generators.gaussian import FullSpaceMixture, PlainMixture, ReducedSpaceMixture
    from pagd.generators.generate import Generated, generate
    from pagd.generators.kernel_density import KernelDensityGenerator
    from pagd.result import Result, read_result
    from pagd.selection import choose
    from pagd.simulation import simulate

__version__ = "0.1.0"

_HOMES = {
    "pagd.catalogue": ("read_designs",),
    "pagd.dataset.frame": ("designs_of", "frame_of", "read_frame", "write_frame"),
    "pagd.dataset.make": ("Dataset", "make_dataset"),
    "pagd.dataset.sampling": ("sample_designs",),
    "pagd.design": ("Design", "GeometryRules", "violations"),
    "pagd.diversity": ("novelty",),
    "pagd.embedding.linear": ("FullSpace", "PrincipalComponents"),
    "pagd.embedding.quality": ("quality_of",),
    "pagd.embedding.tsne": ("TSNE",),
    "pagd.encoding": ("Encoder",),
    "pagd.generators.baselines": ("RandomSampling", "Resampling"),
    "pagd.generators.gaussian": ("FullSpaceMixture", "PlainMixture", "ReducedSpaceMixture"),
    "pagd.generators.generate": ("Generated", "generate"),
    "pagd.generators.kernel_density": ("KernelDensityGenerator",),
    "pagd.notebook": ("load_ipython_extension",),
    "pagd.result": ("Result", "read_result"),
    "pagd.selection": ("choose",),
    "pagd.simulation": ("simulate",),
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
    "Result",
    "choose",
    "designs_of",
    "frame_of",
    "generate",
    "make_dataset",
    "novelty",
    "quality_of",
    "read_designs",
    "read_frame",
    "read_result",
    "sample_designs",
    "simulate",
    "violations",
    "write_frame",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'pagd' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME_OF[name]), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])


# In a notebook designs show themselves as pictures; elsewhere this is one look into a dictionary.
if "IPython" in sys.modules:
    importlib.import_module("pagd.notebook").show_pictures()
