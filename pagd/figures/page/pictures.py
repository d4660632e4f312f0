"""Pictures inside the page, each with its caption."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

from pagd.figures.alternatives import alternative
from pagd.figures.page.markup import escaped

__all__ = ["CARD_PIXELS", "PIXELS", "picture", "pictures"]

#: Width of a picture in pixels, and of one among the many of single designs.
PIXELS: Final = 1650
CARD_PIXELS: Final = 1200
# WebP at this quality shows no loss.
_QUALITY = 82
# A small picture is not blown up: its text would be larger than the page's.
_REM_PER_INCH, _DPI = 6.8, 150.0


def pictures(
    folder: Path | None,
    names: Iterable[str],
    captions: Mapping[str, str],
    pixels: int = PIXELS,
    subject: str = "",
) -> str:
    """Return the pictures NAME.png that the folder holds, in the order of the names.

    Whoever does not see them is told what they show, and of which subject.
    """
    if folder is None:
        return ""
    found = [
        picture(folder / f"{name}.png", captions.get(name, ""), alternative(name, subject), pixels)
        for name in names
    ]
    return "\n".join(filter(None, found))


def picture(path: Path, caption: str, instead: str, pixels: int = PIXELS) -> str:
    """Return a picture with its caption and the text instead of it; nothing without the file."""
    if not path.is_file():
        return ""
    address, (width, height), inches = _embedded(path, pixels)
    image = (
        f'<img loading="lazy" decoding="async" width="{width}" height="{height}"'
        f' style="max-width: {_REM_PER_INCH * inches:.0f}rem"'
        f' src="{address}" alt="{escaped(instead)}">'
    )
    return f"<figure>{image}<figcaption>{escaped(caption)}</figcaption></figure>"


def _embedded(path: Path, pixels: int) -> tuple[str, tuple[int, int], float]:
    """Return a picture as a data address, in a third of the space of PNG, its size and inches."""
    from PIL import Image

    with Image.open(path) as image, io.BytesIO() as buffer:
        inches = image.width / image.info.get("dpi", (_DPI,))[0]
        image.thumbnail((pixels, 10 * pixels))
        image.convert("RGB").save(buffer, format="WEBP", quality=_QUALITY)
        text = base64.b64encode(buffer.getvalue()).decode("ascii")
        return f"data:image/webp;base64,{text}", image.size, inches
