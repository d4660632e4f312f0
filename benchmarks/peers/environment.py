"""The virtual environment of the other programs, apart from that of pagd."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from pagd.errors import InputError
from pagd.files import write_text

__all__ = ["REQUIREMENTS", "peer_python", "pinned"]

REQUIREMENTS = Path(__file__).parents[1] / "peer-requirements.txt"

_STAMP = "requirements-installed.txt"


def pinned() -> dict[str, str]:
    """Return the versions of ``peer-requirements.txt`` by package."""
    lines = REQUIREMENTS.read_text(encoding="utf-8").splitlines()
    pairs = [line.split("==") for line in lines if line.strip() and not line.startswith("#")]
    return {name.strip(): version.strip() for name, version in pairs}


def peer_python(folder: Path) -> Path:
    """Return the interpreter of the environment in ``folder``, which is made if it is not there.

    It is made anew where it was left half made, or of other versions.

    Raises
    ------
    InputError
        If the packages cannot be installed.
    """
    python, stamp = folder / "bin" / "python", folder / _STAMP
    wanted = REQUIREMENTS.read_text(encoding="utf-8")
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted and python.exists():
        return python
    print(f"{folder}: installs {REQUIREMENTS.name} (a minute)", flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    _run([sys.executable, "-m", "venv", str(folder)])
    pip = [str(python), "-m", "pip", "--disable-pip-version-check", "--quiet", "install"]
    _run([*pip, "--requirement", str(REQUIREMENTS)])
    write_text(stamp, wanted)
    return python


def _run(command: list[str]) -> None:
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    if answer.returncode:
        said = (answer.stderr or answer.stdout).strip().splitlines()[-1:] or ["no message"]
        raise InputError(f"peer environment: {' '.join(command[:4])} … failed ({said[0]}).")
