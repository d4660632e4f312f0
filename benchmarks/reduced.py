"""The reduced-order analysis against the full one, on random designs that were solved in full.

    python benchmarks/reduced.py [--designs 200] [--seed 1] [--processes 2] [--config JSON]
        [--study results/random_designs] [--page docs/reduced-order.md] [--mixed]

The study is that of benchmarks/random_designs.py with the same designs, seed and configuration, and
--mixed if that is given; designs that it has not solved are left out. --page writes the section of
the accuracy, or that of mixed rows.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from performance.origin import origin_lines
from performance.page import must_have_section, publish
from reduction.page import text_of
from reduction.pairs import compared
from robustness.drawing import drawn_designs, mixed_designs

from pagd import config as configuration
from pagd.errors import InputError
from pagd.stages.solve import materials_of

_SECTION, _SECTION_OF_MIXED = "accuracy", "mixed"


def main() -> None:
    """Compare, and print the tables or write them to a page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        section = _SECTION_OF_MIXED if options.mixed else _SECTION
        must_have_section(options.page, section)
        for name in ("designs", "processes"):
            if getattr(options, name) < 1:
                raise InputError(f"--{name} must be at least 1.")
        config = configuration.load(options.config)
        draw = mixed_designs if options.mixed else drawn_designs
        designs = draw(options.designs, options.seed, config)
        folders = {named.name: options.study / "designs" / named.name for named in designs}
        materials = materials_of(config)
        pairs = compared(designs, folders, config, materials, options.processes)
        if not pairs:
            raise InputError(f"--study = {options.study}: none of the designs is solved there.")
        origin = origin_lines(_command(options))
        text = text_of(pairs, len(designs), brief=options.mixed)
        publish(options.page, section, f"{origin}\n\n{text}")
    except InputError as error:
        parser.error(str(error))


def _command(options: argparse.Namespace) -> str:
    words = ["python benchmarks/reduced.py"]
    if options.designs != 200:
        words.append(f"--designs {options.designs}")
    if options.study != Path("results/random_designs"):
        words.append(f"--study {options.study}")
    if options.mixed:
        words.append("--mixed")
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
    parser.add_argument("--mixed", action="store_true")
    return parser


if __name__ == "__main__":
    main()
