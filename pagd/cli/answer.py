"""What a subcommand answers: an exit code for the shell, a document for machines."""

from __future__ import annotations

import contextlib
import json
import math
import os
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pagd.record import Record

__all__ = ["Answer", "answer_of", "json_text", "only_answer_on_stdout"]


@dataclass(frozen=True, slots=True)
class Answer:
    """Exit code, and what ``--json`` prints: plain data, numbers of numpy and paths included."""

    code: int
    document: Mapping[str, Any]


def answer_of(record: Record, folder: Path, code: int = 0) -> Answer:
    """Return a record as an answer: as it stands in the file, with the folder that has it."""
    return Answer(code, {"folder": folder, **record.as_dict()})


def json_text(document: Mapping[str, Any]) -> str:
    """Return a document as JSON; a number that JSON has no word for is null.

    >>> print(json_text({"share": float("nan")}))
    {
      "share": null
    }
    """
    return json.dumps(_plain(document), indent=2, ensure_ascii=False, allow_nan=False)


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):  # numpy's scalars and arrays
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value


@contextlib.contextmanager
def only_answer_on_stdout(wanted: bool) -> Iterator[None]:
    """Send to stderr what the block, its libraries and programs print, where that is ``wanted``."""
    if not wanted:
        yield
        return
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
