"""All pictures of the generative half that the results of a run allow."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Final

from pagd.figures.generative.bending_twist import draw_bending_twist
from pagd.figures.generative.captions import captions
from pagd.figures.generative.comparison import draw_comparison
from pagd.figures.generative.distributions import draw_distributions
from pagd.figures.generative.embedding import draw_embedding
from pagd.figures.generative.facts import facts_of
from pagd.figures.generative.feasibility import draw_feasibility
from pagd.figures.generative.force_bending import draw_force_bending
from pagd.figures.generative.hull import draw_hull
from pagd.figures.generative.mixture import draw_mixture
from pagd.figures.generative.modes import draw_modes
from pagd.figures.generative.novelty_performance import draw_novelty_performance
from pagd.figures.generative.results import GenerativePaths, NothingToDraw
from pagd.figures.generative.screened import (
    draw_screened,
    draw_screened_beside_full,
    draw_screened_novelty,
)
from pagd.figures.style import set_resolution
from pagd.files import write_text

__all__ = ["CAPTIONS_NAME", "PICTURES", "draw_generative"]

log = logging.getLogger(__name__)

CAPTIONS_NAME: Final = "captions.json"

#: Name of a picture to the function that draws it, in the order of the page.
PICTURES: Final[Mapping[str, Callable[[GenerativePaths, Path], None]]] = {
    "embedding": draw_embedding,
    "mixture": draw_mixture,
    "hull": draw_hull,
    "comparison": draw_comparison,
    "distributions": draw_distributions,
    "feasibility": draw_feasibility,
    "bending_twist": draw_bending_twist,
    "force_bending": draw_force_bending,
    "novelty_performance": draw_novelty_performance,
    "screened": draw_screened,
    "screened_novelty": draw_screened_novelty,
    "screened_beside_full": draw_screened_beside_full,
}
#: The picture of the documentation: text, so that it can be kept under version control.
MODES: Final = "modes"


def draw_generative(
    results: Path | GenerativePaths,
    out: Path,
    resolution_dpi: int = 150,
    names: Collection[str] = (*PICTURES, MODES),
) -> dict[str, str]:
    """Draw every picture that has data, and write captions.json for those that were drawn.

    Parameters
    ----------
    results
        Folder of results, or where its parts lie.
    out
        Folder of the pictures, NAME.png each, and modes.svg, a small one of the three modes.
    resolution_dpi
        Dots per inch.
    names
        The pictures to draw.

    Returns
    -------
    dict
        Name of each picture that was left out, with the reason.
    """
    paths = results if isinstance(results, GenerativePaths) else GenerativePaths.under(results)
    set_resolution(resolution_dpi)
    missing: dict[str, str] = {}
    files = {name: (draw, out / f"{name}.png") for name, draw in PICTURES.items()}
    files[MODES] = draw_modes, out / f"{MODES}.svg"
    for name, (draw, file) in files.items():
        if name not in names:
            continue
        try:
            draw(paths, file)
        except NothingToDraw as reason:
            missing[name] = str(reason)
            log.info("%s is not drawn: %s", file.name, reason)
    _write_captions(paths, out, [n for n in PICTURES if n in names and n not in missing])
    return missing


def _write_captions(paths: GenerativePaths, out: Path, names: list[str]) -> None:
    written = captions(facts_of(paths))
    content = {name: written[name] for name in names}
    text = json.dumps(content, indent=2, ensure_ascii=False)
    write_text(out / CAPTIONS_NAME, text + "\n")
