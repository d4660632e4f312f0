# The configuration and the designs, checked once, and what the rules ask of them.

import functools
import gc
import json
import os
import sys
from pathlib import Path
from shlex import quote

from snakemake.exceptions import WorkflowError

from pagd.catalogue import read_designs, read_pneunets
from pagd.config import (
    check_study,
    checked,
    completed,
    known_tables,
    material_as_json,
    material_file,
    part_as_json,
    refusal_of_cells,
    retyped,
)
from pagd.errors import InputError
from pagd.stages import STAGE_VERSIONS

# Snakemake's objects for the jobs stay to the end: Python need not look among them for what has
# become free each time that a few hundred more are there.
gc.set_threshold(100_000, 50, 100)

# Jobs use the Python that runs Snakemake, activated or not.
shell.prefix(f"export PATH={quote(str(Path(sys.executable).parent))}:$PATH; ")


def read_inputs(config, check):
    """The completed configuration; designs and known designs by name; materials by use."""
    config = retyped(config)
    try:
        whole = checked(config, "configuration") if check else completed(config)
        if check:
            check_study(whole, "configuration")
        designs = read_designs(whole["designs"], checked=check)
        known = read_pneunets(known_tables(whole), checked=check)
        materials = {
            role: material_as_json(whole["material_file"], whole[role], role)
            for role in ("material", "paper")
        }
    except InputError as error:
        raise WorkflowError(str(error)) from None
    return whole, designs, [design.as_json() for design in known.values()], materials


# Jobs on a cluster parse this file again; what they read has passed the check already.
CONFIG, TABLES, KNOWN, MATERIALS = read_inputs(config, check=workflow.is_main_process)

# Without a selection the generative half has no part in a run.
GENERATIVE = CONFIG["selection"]["designs"] > 0


# What the page shows beside single designs, by the names that the page has for it.
STUDY = {
    "performance": "results/summary/performance.parquet",
    "simulated": "results/figures/simulated",
}
if GENERATIVE:
    STUDY |= {
        "dataset": "results/dataset",
        "embedding": "results/embedding",
        "generated": "results/generated",
        "selection": "results/selection",
        "diversity": "results/summary/diversity.json",
        "comparison": "results/diversity",
        "pictures": "results/figures/generative",
    }

# Designs that are analysed by a chamber each, by where their table is: with no training designs, or
# where chambers are not alike, none.
TABLE_SIZES = {
    "generated": CONFIG["generator"]["designs"],
    "training": CONFIG["dataset"]["size"],
}
SCREENED = TABLE_SIZES | {"training": CONFIG["screening"]["training_designs"]}
SCREENING = GENERATIVE and SCREENED["training"] > 0 and refusal_of_cells(CONFIG["solve"]) is None
if SCREENING:
    STUDY |= {
        "screened": "results/screening/generated",
        "screened_training": "results/screening/training",
        "fronts": "results/summary/fronts.json",
        "screening_pictures": "results/figures/screening",
    }

SCREENED_PICTURES = ("screened", "screened_novelty", "screened_beside_full")

# A job that has taken more than it was allotted, or was killed from outside, is tried once more,
# with twice as much. What fails by itself leaves a record, and is not tried again. On a cluster it
# is for the process that submits jobs to try again: within a job there is no more than allotted.
TRIES = 2
RETRIES = TRIES - 1 if workflow.is_main_process else 0

# The stages whose meaning is that of a screening too.
SCREENING_STAGES = ("screening", "mesh", "solve", "metrics")


def growing(amount):
    """The amount of a resource at the first try, twice that at the second."""

    def at(wildcards, attempt):
        return amount * attempt

    return at


def tries_left(wildcards, attempt):
    """How many tries may follow: at the last one, a limit exceeded is how the design ends."""
    return max(0, TRIES - attempt)


def files_of_configuration():
    """The files that the configuration names: tables of designs, and materials."""
    files = [*CONFIG["designs"].values(), str(material_file(CONFIG))]
    return files + list(known_tables(CONFIG).values()) if GENERATIVE else files


def of_generative_half(path):
    """The path as an input if the generative half is part of the run; nothing otherwise."""
    return [path] if GENERATIVE else []


def of_screening(path):
    """The path as an input if designs are screened; nothing otherwise."""
    return [path] if SCREENING else []


def designs_to_screen(wildcards):
    """The folder of the stage that has made the table."""
    stages = {"generated": rules.generate.output, "training": rules.dataset.output}
    return stages[wildcards.screened][0]


def parts_of_table(wildcards):
    """How many parts of a job each a whole table of designs has."""
    return -(-TABLE_SIZES[wildcards.screened] // CONFIG["screening"]["designs_per_job"])


def part_of_table(wildcards):
    """Which part of how many a job analyses."""
    return f"{wildcards.part}/{parts_of_table(wildcards)}"


def parts_to_screen(wildcards):
    """So many parts that they have the wanted number of designs, each a sample of all."""
    parts, size = parts_of_table(wildcards), TABLE_SIZES[wildcards.screened]
    wanted = -(-min(SCREENED[wildcards.screened], size) * parts // size)
    numbers = range(1, wanted + 1)
    return expand(
        "results/screening/parts/{screened}_{part}", screened=wildcards.screened, part=numbers
    )


def selected_designs():
    """The generated designs that the checkpoint has selected, by name; none before that."""
    table = Path(rules.select.output.selection) / "designs.csv"
    return designs_in(table, table.stat().st_mtime_ns) if table.is_file() else {}


@functools.lru_cache(maxsize=1)
def designs_in(table, changed):
    """The designs of a table that pagd has written, read once each time that it has changed."""
    return read_designs({"generated": str(table)}, checked=False)


def all_designs():
    """All designs to simulate, by name: those of the tables, then the selected ones.

    Snakemake asks again when the checkpoint is done.
    """
    if not GENERATIVE:
        return TABLES
    checkpoints.select.get()
    return TABLES | selected_designs()


def selection_of_design(wildcards):
    """What must be there before a generated design can start; a newer one is no reason to."""
    return [] if wildcards.design in TABLES else ancient(rules.select.output.selection)


def design_named(name):
    """The design of the tables, or among those selected, of that name."""
    designs = TABLES if name in TABLES else selected_designs()
    if name not in designs:
        # Until the checkpoint is done, Snakemake takes this for "not known yet".
        checkpoints.select.get()
        raise WorkflowError(f"No design is named '{name}': neither in the tables nor selected.")
    return designs[name]


def design_row(wildcards):
    """The design's own row: a change of it, and of no other row, runs the design again."""
    return design_named(wildcards.design).as_json()


def and_family(versions):
    """Versions of stages, and that of the design's family if it has files of its own."""

    def both(wildcards):
        digest = design_named(wildcards.design).actuator.digest()
        return versions if digest is None else [*versions, digest]

    return both


def config_of(stage):
    """The part of the configuration that a stage depends on, as one line of JSON."""
    return part_as_json(CONFIG, stage)


def config_of_pictures():
    """The same for the pictures of one design: how many designs are drawn changes none of them."""
    resolution = {"resolution_dpi": CONFIG["figures"]["resolution_dpi"]}
    return json.dumps({"figures": resolution})


def of_all_designs(pattern):
    """The paths of a per-design output, for all designs, in the order of the tables."""

    def paths(wildcards):
        return expand(pattern, design=all_designs())

    return paths


def of_drawn_designs(pattern):
    """The same for the designs that pictures are drawn of."""
    return of_first_designs(pattern, "drawn_designs")


def of_exported_designs(pattern):
    """The same for the designs that have a card on the page."""
    return of_first_designs(pattern, "exported_designs")


def of_first_designs(pattern, key):
    """The same for so many designs as a key of the section ``figures`` says."""

    def paths(wildcards):
        return expand(pattern, design=list(all_designs())[: CONFIG["figures"][key]])

    return paths


def pictures_of_design(wildcards):
    """The pictures of a design, if any are drawn of it."""
    drawn = list(all_designs())[: CONFIG["figures"]["drawn_designs"]]
    return rules.figures.output.figures if wildcards.design in drawn else []


def sum_up_what_is_there():
    """The tables of the designs that are done, where a run ends before all are."""
    from pagd.stages.novelty import novelty_of
    from pagd.summary import write_gathered, write_summary

    names = TABLES | selected_designs() if GENERATIVE else TABLES
    folders = [Path("results/designs", name) for name in names]
    there = [folder for folder in folders if (folder / "metrics" / "record.json").is_file()]
    if not there:
        return
    dataset = Path(rules.dataset.output.dataset)
    known = GENERATIVE and dataset.is_dir()
    novelty = novelty_of([folder / "geometry" for folder in there], dataset) if known else {}
    summary, metrics = Path("results/summary"), [folder / "metrics" for folder in there]
    write_summary(metrics, summary / "performance.parquet", summary / "summary.csv", novelty)
    write_gathered(metrics, summary)
    # Older than all they are made of: the next run makes them again, of whatever there is then.
    for table in summary.iterdir():
        os.utime(table, (0, 0))
    print(f"{len(there)} of {len(names)} designs are done: results/summary has those.", flush=True)


def folders_of(wildcards, input):
    """The folders of the designs whose metrics are an input."""
    return [str(Path(folder).parent) for folder in input.metrics]


def design_folder(wildcards):
    """The folder that holds the folders of a design's stages."""
    return f"results/designs/{wildcards.design}"
