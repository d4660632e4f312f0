"""Pictures of a sample of the simulated designs of a data set."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from pagd.figures.deformed import draw_deformed
from pagd.figures.gallery import draw_gallery
from pagd.figures.load import has_states
from pagd.inventory import read_sound_record
from pagd.long_work import counted

__all__ = ["GALLERY", "draw_sample", "sample_of"]

#: Picture of the whole sample, in the data set.
GALLERY: Final = "pictures/sample.png"
# Stages whose files are drawn.
_DRAWN: Final = ("mesh", "solve")


def sample_of(folders: Mapping[str, Path], count: int) -> dict[str, Path]:
    """Return a random sample of the designs that have deformed shapes, always the same one.

    Parameters
    ----------
    folders
        Folders of simulated designs by id.
    count
        How many are wanted; fewer where there are not so many.
    """
    drawable = [identity for identity in folders if has_states(folders[identity])]
    # The first digits of a hash tell the split: by the last ones, all splits have their share.
    chosen = sorted(drawable, key=lambda identity: identity[::-1])[:count]
    return {identity: folders[identity] for identity in chosen}


def draw_sample(sample: Mapping[str, Path], archive: Path) -> None:
    """Draw the designs of a sample together, and the deformed shapes of each by its id.

    Raises
    ------
    InputError
        If a file that is drawn is not what its record says.
    """
    if not sample:
        return
    for folder in sample.values():
        for stage in _DRAWN:
            read_sound_record(folder / stage)
    (archive / GALLERY).parent.mkdir()
    draw_gallery(list(sample.values()), archive / GALLERY)
    for identity, folder in counted(sample.items(), "drawing", len(sample), "designs"):
        draw_deformed(folder, (archive / GALLERY).with_name(f"{identity}.png"))
