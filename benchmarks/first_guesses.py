"""What first guesses from cells save the full analysis, on random designs solved both ways.

    python benchmarks/first_guesses.py [--study results/random_designs]
        [--path results/random_designs_path] [--page docs/reduced-order.md]

Both folders are those of benchmarks/random_designs.py, the second with

    --config '{"solve": {"first_guess": "path"}}' --out results/random_designs_path

Compared are designs with the same mesh in both. --page writes the section of first guesses.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from performance.origin import origin_lines
from performance.page import must_have_section, publish
from reduction.guesses import both_ways, text_of

from pagd.errors import InputError

_SECTION = "guesses"


def main() -> None:
    """Compare, and print the tables or write them to a page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--study", type=Path, default=Path("results/random_designs"))
    parser.add_argument("--path", type=Path, default=Path("results/random_designs_path"))
    parser.add_argument("--page", type=Path)
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        pairs = both_ways(options.study / "designs", options.path / "designs")
        if not pairs:
            raise InputError(f"--path = {options.path}: no design of it is in {options.study}.")
        command = "python benchmarks/first_guesses.py"
        command += f" --page {options.page}" if options.page else ""
        publish(options.page, _SECTION, f"{origin_lines(command)}\n\n{text_of(pairs)}")
    except InputError as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
