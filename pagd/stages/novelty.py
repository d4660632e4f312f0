"""How far simulated designs lie from the training designs, whatever became of them."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from pagd.dataset import frame_of
from pagd.design import Design
from pagd.diversity.novelty import nearest_distances
from pagd.encoding import Encoder
from pagd.stages.dataset import load_dataset
from pagd.stages.geometry import DESIGN_NAME, read_design

__all__ = ["novelty_of"]


def novelty_of(geometries: Sequence[Path], dataset: Path) -> dict[str, float]:
    """Return the distance to the nearest training design, in the encoded space, by design_id.

    Parameters
    ----------
    geometries
        Folders of the stage geometry. Those without a design, designs that are no pneu-nets, and
        designs whose numbers say nothing (not finite, no chamber), are left out.
    dataset
        Folder of the stage dataset.
    """
    drawn = [read_design(folder) for folder in geometries if (folder / DESIGN_NAME).is_file()]
    # Designs of other families have no place among the training designs.
    found = [(n, n.design) for n in drawn if isinstance(n.design, Design) and _is_vector(n.design)]
    if not found:
        return {}
    training = load_dataset(dataset)
    encoder = Encoder().fit(training)
    names = [named.name for named, _ in found]
    frame = frame_of([design for _, design in found], names, [n.origin for n, _ in found])
    distances = nearest_distances(encoder.transform(frame), encoder.transform(training))
    return dict(zip(names, distances.tolist(), strict=True))


def _is_vector(design: Design) -> bool:
    return all(isfinite(value) for value in design.as_dict().values()) and design.N >= 1
