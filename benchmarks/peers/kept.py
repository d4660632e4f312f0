"""Results of single runs, kept by all that made them: an interrupted study goes on with them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from robustness.machine import machine
from robustness.study import commit

import pagd
from pagd.files import write_text

__all__ = ["Keeper", "digest", "source_digest"]

Result = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Keeper:
    """The folder of kept results.

    Attributes
    ----------
    folder
        Holds a JSON file a run.
    fresh
        Whether to run again what is kept.
    """

    folder: Path
    fresh: bool = False

    def result(
        self,
        name: str,
        made_of: Mapping[str, Any],
        run: Callable[[], Result],
        is_enough: Callable[[Result], bool] = lambda _: True,
    ) -> Result:
        """Return the kept result of a run, or run it and keep what it returns.

        Parameters
        ----------
        name
            For the file, and to be told.
        made_of
            All that the result depends on; the machine is added.
        run
            Makes the result; ``commit`` is added.
        is_enough
            Tells whether a kept result answers what is asked for now.
        """
        key = {**made_of, "machine": _machine()}
        path = self.folder / f"{name}-{digest(key)[:12]}.json"
        kept = None if self.fresh else _read(path, key)
        if kept is not None and is_enough(kept):
            print(f"{name}: kept", flush=True)
            return kept
        print(f"{name}: runs", flush=True)
        result = {**run(), "commit": commit()}
        content = {"made_of": key, "result": result}
        write_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
        return result


def digest(content: Any) -> str:
    """Return a digest of anything that JSON can hold."""
    text = json.dumps(content, sort_keys=True, ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()


@lru_cache
def source_digest() -> str:
    """Return a digest of the sources of pagd: what its times depend on."""
    folder = Path(pagd.__file__).parent
    files = sorted(p for p in folder.rglob("*") if p.suffix in (".py", ".scad", ".yaml"))
    contents = {str(p.relative_to(folder)): p.read_text(encoding="utf-8") for p in files}
    return digest(contents)[:16]


def _read(path: Path, key: Mapping[str, Any]) -> Result | None:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return content["result"] if content.get("made_of") == json.loads(json.dumps(key)) else None


@lru_cache
def _machine() -> str:
    here = machine((), 1)
    return f"{here['processor']}, {here['cores']} cores"
