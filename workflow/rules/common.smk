# The configuration and the designs, checked once, and what the rules ask of them.

import json
import sys
from pathlib import Path
from shlex import quote

from snakemake.exceptions import WorkflowError

from pagd.catalogue import read_designs
from pagd.config import checked, completed, material_as_json, part_as_json
from pagd.errors import InputError
from pagd.stages import STAGE_VERSIONS

# Jobs use the Python that runs Snakemake, activated or not.
shell.prefix(f"export PATH={quote(str(Path(sys.executable).parent))}:$PATH; ")


def read_inputs(config, check):
    """The completed configuration, the designs by name and the materials by use."""
    try:
        whole = checked(config, "configuration") if check else completed(config)
        designs = read_designs(whole["designs"], checked=check)
        materials = {
            role: material_as_json(whole["material_file"], whole[role], role)
            for role in ("material", "paper")
        }
    except InputError as error:
        raise WorkflowError(str(error)) from None
    return whole, designs, materials


# Jobs on a cluster parse this file again; what they read has passed the check already.
CONFIG, DESIGNS, MATERIALS = read_inputs(config, check=workflow.is_main_process)


def design_row(wildcards):
    """The design's own row: a change of it, and of no other row, runs the design again."""
    if wildcards.design not in DESIGNS:
        raise WorkflowError(f"No table of designs has a design named '{wildcards.design}'.")
    return DESIGNS[wildcards.design].as_json()


def config_of(stage):
    """The part of the configuration that a stage depends on, as one line of JSON."""
    return part_as_json(CONFIG, stage)


def config_of_pictures():
    """The same for the pictures of one design: how many designs are drawn changes none of them."""
    resolution = {"resolution_dpi": CONFIG["figures"]["resolution_dpi"]}
    return json.dumps({"figures": resolution})


def of_all_designs(pattern):
    """The paths of a per-design output, for all designs, in the order of the tables."""
    return expand(pattern, design=DESIGNS)


def of_drawn_designs(pattern):
    """The same for the designs that pictures are drawn of."""
    return of_all_designs(pattern)[: CONFIG["figures"]["drawn_designs"]]


def design_folder(wildcards):
    """The folder that holds the folders of a design's stages."""
    return f"results/designs/{wildcards.design}"
