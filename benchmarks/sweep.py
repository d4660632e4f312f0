"""The sweep over generated designs: cost by stage, overhead of the workflow, hours for all.

    python benchmarks/sweep.py [--designs 60] [--seed 1] [--cores 2] [--config FILE or JSON]
        [--dry-run-designs 100 1000 11000] [--page docs/performance.md]
        [--out results/benchmarks/sweep]

Makes the generated designs first (some minutes, once), then simulates a random sample of them by
`snakemake --profile profiles/sweep` in a folder of its own, and times dry runs of tables of
random designs. Repeating the command goes on where it was. Give nothing else to do to the machine
meanwhile.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from performance.options import command_of, must_be_positive, must_not_be_negative
from performance.origin import origin_lines
from performance.page import must_have_section, publish
from robustness.drawing import drawn_designs
from sweep.costs import inside_s, overhead_of
from sweep.page import as_markdown
from sweep.project import ROOT, DryRun, Project
from sweep.sample import Sample

from pagd import config as configuration
from pagd.errors import InputError

_SECTION = "sweep"


def main() -> None:
    """Simulate what is not done, time the dry run, print the section or write it to the page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        must_be_positive({"designs": options.designs, "cores": options.cores})
        least = min(options.dry_run_designs)
        must_not_be_negative({"seed": options.seed, "dry-run-designs": least})
        config = configuration.load(options.config or str(ROOT / "config" / "config.yaml"))
        text, commits = _measured(options, config)
        usual = vars(_parser().parse_args([]))
        command = command_of("benchmarks/sweep.py", vars(options), usual)
        publish(options.page, _SECTION, f"{origin_lines(command, commits=commits)}\n\n{text}")
    except InputError as error:
        parser.error(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted; the same command goes on from here")


def _measured(
    options: argparse.Namespace, config: configuration.Config
) -> tuple[str, list[str | None]]:
    out = options.out.resolve()
    sample = Sample(Project(out / "sample"), config, options.designs, options.seed)
    print("generated designs …", flush=True)
    names = sample.prepare(options.cores)
    if not sample.simulate(names, options.cores):
        print(f"Some designs have crashed; {sample.project.folder}/snakemake.log tells of them.")
    costs = sample.costs(names)
    if not costs:
        raise InputError(f"{sample.project.folder}: none of the {len(names)} designs is done.")
    runs = [run for run in sample.runs() if inside_s(run, costs) > 0]
    overhead = overhead_of(runs, costs)
    counts = sorted(count for count in options.dry_run_designs if count > 0)
    dry_runs = [_dry_run(options, config, count) for count in counts]
    text = as_markdown(costs, len(names), overhead, options.cores, dry_runs)
    return text, [run.commit for run in runs]


def _dry_run(options: argparse.Namespace, config: configuration.Config, count: int) -> DryRun:
    print(f"dry run of {count} designs …", flush=True)
    project = Project(options.out.resolve() / "dry_run")
    project.write_table_alone(drawn_designs(count, options.seed, config), config)
    return project.dry_run(count)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    add = parser.add_argument
    add("--designs", type=int, default=60, help="size of the sample (default: %(default)s)")
    add("--seed", type=int, default=1, help="of the drawing (default: %(default)s)")
    add("--cores", type=int, default=2, help="cores of the sweep (default: %(default)s)")
    add(
        "--dry-run-designs",
        type=int,
        nargs="+",
        default=[100, 1000, 11000],
        metavar="N",
        help="designs of the dry runs; 0 leaves them out (default: 100 1000 11000)",
    )
    add("--config", help="file or JSON text, in place of config/config.yaml")
    add("--page", type=Path, help="page whose section is replaced; printed unless given")
    add(
        "--out",
        type=Path,
        default=Path("results/benchmarks/sweep"),
        help="folder to work in (default: %(default)s)",
    )
    return parser


if __name__ == "__main__":
    main()
