"""Records: what a stage leaves behind for one design, whatever happened to it."""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import json
import platform
import resource
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from pagd import __version__
from pagd.errors import InputError, Status
from pagd.files import must_exist, replaced_folder, write_text
from pagd.machine import Machine
from pagd.validation import check, faults

__all__ = [
    "RECORD_NAME",
    "Meter",
    "Record",
    "configuration_hash",
    "read_record",
    "stage_folder",
    "versions",
    "write_record",
]

RECORD_NAME = "record.json"
SCHEMA_VERSION = 1
_HASH = "configuration_sha256"


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """How one stage ended for one design, what it measured and what made it.

    ``figures`` carries units in its keys; ``timings_s`` is in seconds and holds at least
    ``wall`` and ``cpu`` (children included); ``peak_memory_MB`` is in 10⁶ bytes. ``files`` are
    those of the folder, see :mod:`pagd.inventory`; ``machine`` is of
    :func:`pagd.machine.machine_class`. Older records have neither.
    """

    stage: str
    design_id: str
    status: Status
    reason: str | None
    figures: dict[str, Any]
    configuration: dict[str, Any]
    versions: dict[str, str | int | None]
    timings_s: dict[str, float]
    peak_memory_MB: float
    files: dict[str, dict[str, str | int]] = field(default_factory=dict)
    machine: Machine = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """Return the record as it stands in the file, which has the configuration's hash too."""
        return {
            "schema": SCHEMA_VERSION,
            **asdict(self),
            "status": self.status.value,
            _HASH: configuration_hash(self.configuration),
        }


def configuration_hash(configuration: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a configuration: of its JSON text, with sorted keys and no blanks."""
    text = json.dumps(
        configuration, sort_keys=True, separators=(",", ":"), ensure_ascii=False, default=_plain
    )
    return hashlib.sha256(text.encode()).hexdigest()


def write_record(record: Record, folder: Path) -> None:
    """Write ``record`` to ``folder``.

    Raises
    ------
    ValueError
        If the record breaks its schema or holds a number that JSON has no word for.
    """
    content = record.as_dict()
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False, default=_plain)
    found = list(faults(json.loads(text), "record"))
    if found:
        raise ValueError(f"record of stage '{record.stage}': {'; '.join(found)}")
    write_text(folder / RECORD_NAME, text + "\n")


def read_record(folder: Path) -> Record:
    """Read the record of a stage from its ``folder``.

    Raises
    ------
    InputError
        If there is none, it is not a record, or its configuration is not what its hash says.
    """
    path = folder / RECORD_NAME
    must_exist(path)
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: not a readable record ({error}).") from error
    check(content, "record", f"{path}: not a record")
    del content["schema"]
    told = content.pop(_HASH, None)
    if told is not None and told != configuration_hash(content["configuration"]):
        raise InputError(f"{path}: its configuration is not the one it was made by (SHA-256).")
    return Record(**{**content, "status": Status(content["status"])})


def stage_folder(path: Path) -> AbstractContextManager[Path]:
    """Yield a temporary sibling of ``path`` that takes its place when the block ends well.

    A block that raises leaves nothing behind and an older ``path`` untouched.
    """
    return replaced_folder(path, RECORD_NAME)


def versions(
    stage: int, libraries: Mapping[str, str | None] | tuple[str, ...] = ()
) -> dict[str, str | int | None]:
    """Return the versions for a record; ``sources`` tells one state of pagd's code from another.

    Parameters
    ----------
    stage
        Version of the stage's meaning.
    libraries
        Names of installed Python packages, or a mapping of names to versions (None: unknown).
    """
    found = libraries if isinstance(libraries, Mapping) else {n: _installed(n) for n in libraries}
    return {
        "pagd": __version__,
        "sources": _sources(),
        "stage": stage,
        "python": platform.python_version(),
        **found,
    }


@dataclass(slots=True)
class Meter:
    """Clock of a stage: wall and processor seconds since its start, and of named parts.

    >>> meter = Meter()
    >>> with meter.part("read"):
    ...     _ = sum(range(10))
    >>> sorted(meter.timings_s())
    ['cpu', 'read', 'read_cpu', 'wall']
    """

    wall_start: float = field(default_factory=time.perf_counter)
    cpu_start: float = field(default_factory=lambda: _cpu_seconds())
    parts: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Add the wall time of the block to the part ``name``, processor time to ``name_cpu``."""
        wall, cpu = time.perf_counter(), _cpu_seconds()
        try:
            yield
        finally:
            for key, spent in (
                (name, time.perf_counter() - wall),
                (f"{name}_cpu", _cpu_seconds() - cpu),
            ):
                self.parts[key] = self.parts.get(key, 0.0) + spent

    def timings_s(self) -> dict[str, float]:
        """Return the seconds so far, rounded to milliseconds."""
        wall = time.perf_counter() - self.wall_start
        cpu = _cpu_seconds() - self.cpu_start
        return {k: round(v, 3) for k, v in {"wall": wall, "cpu": cpu, **self.parts}.items()}

    @staticmethod
    def peak_memory_MB() -> float:
        """Return the largest resident memory so far of this process or a finished child, in MB."""
        child = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        return round(max(_own_peak_kB(), child / _RSS_PER_KB) * 1024 / 1e6, 1)


# ru_maxrss counts bytes on macOS and kibibytes elsewhere.
_RSS_PER_KB = 1024 if sys.platform == "darwin" else 1


def _own_peak_kB() -> float:
    # ru_maxrss survives exec: a small program started by a large one would be charged with the
    # memory of the large one. The high-water mark of the address space starts afresh.
    try:
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
        return next(float(line.split()[1]) for line in lines if line.startswith("VmHWM"))
    except (OSError, StopIteration):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / _RSS_PER_KB


def _cpu_seconds() -> float:
    own = resource.getrusage(resource.RUSAGE_SELF)
    child = resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + child.ru_utime + child.ru_stime


@functools.cache
def _sources() -> str:
    """Sixteen digits of the SHA-256 of the package's own files, without those Python adds."""
    root, digest = Path(__file__).parent, hashlib.sha256()
    for path in sorted(root.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _installed(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def _plain(value: Any) -> Any:
    # numpy scalars and arrays, paths: JSON knows neither.
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"{type(value).__name__} has no place in a record")
