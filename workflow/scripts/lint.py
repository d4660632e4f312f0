"""Run Snakemake's linter, and fail on what it finds, but for one point.

It wants a conda environment or a container for every rule. All rules run pagd itself, with the
packages that requirements.lock pins: there is nothing else to deploy.
"""

from __future__ import annotations

import re
import subprocess
import sys

ACCEPTED = "Specify a conda environment or container for each rule."
CLEAN = "Congratulations, your workflow is in a good condition!"


def lints(report: str) -> list[str]:
    """Return what a report of the linter finds, each as ``place: title``, but for ACCEPTED."""
    found = []
    for place, points in re.findall(r"^Lints for (.+):\n((?:    .*\n)*)", report, re.MULTILINE):
        titles = re.findall(r"^    \* (.+):$", points, re.MULTILINE)
        found += [f"{place}: {title}" for title in titles if title != ACCEPTED]
    return found


def main(arguments: list[str]) -> int:
    """Run the linter and return the exit code."""
    command = [sys.executable, "-m", "snakemake", "--lint", *arguments]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    report = answer.stdout + answer.stderr
    found = lints(report)
    # Neither clean nor a list of lints: the workflow cannot be read at all.
    broken = CLEAN not in report and "Lints for " not in report
    if found or broken:
        print(report)
    print(*found, sep="\n", end="")
    return 1 if found or broken else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
