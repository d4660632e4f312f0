"""The reduced-order analysis against the full one, on random designs that were solved in full.

    python benchmarks/reduced.py [--designs 200] [--seed 1] [--processes 2] [--config JSON]
        [--study results/random_designs] [--page docs/reduced-order.md]

The study is that of benchmarks/random_designs.py with the same designs, seed and configuration;
designs that it has not solved are left out. --page writes the section of the accuracy.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from performance.origin import origin_lines
from performance.page import must_have_section, publish
from reduction.page import text_of
from reduction.pairs import compared
from robustness.drawing import drawn_designs

from pagd import config as configuration
from pagd.errors import InputError
from pagd.stages.solve import materials_of

_SECTION = "accuracy"


def main() -> None:
    """Compare, and print the tables or write them to a page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        for name in ("designs", "processes"):
            if getattr(options, name) < 1:
                raise InputError(f"--{name} must be at least 1.")
        config = configuration.load(options.config)
        designs = drawn_designs(options.designs, options.seed, config)
        folders = {named.name: options.study / "designs" / named.name for named in designs}
        materials = materials_of(config)
        pairs = compared(designs, folders, config, materials, options.processes)
        if not pairs:
            raise InputError(f"--study = {options.study}: none of the designs is solved there.")
        origin = origin_lines(_command(options))
        publish(options.page, _SECTION, f"{origin}\n\n{text_of(pairs, len(designs))}")
    except InputError as error:
        parser.error(str(error))


def _command(options: argparse.Namespace) -> str:
    words = ["python benchmarks/reduced.py"]
    if options.designs != 200:
        words.append(f"--designs {options.designs}")
    if options.page:
        words.append(f"--page {options.page}")
    return " ".join(words)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--designs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--config")
    parser.add_argument("--study", type=Path, default=Path("results/random_designs"))
    parser.add_argument("--page", type=Path)
    return parser


if __name__ == "__main__":
    main()
