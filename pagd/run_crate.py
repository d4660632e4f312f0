"""What a whole run says of itself to machines: a Workflow Run RO-Crate of its results.

Profile Workflow Run Crate 0.5, https://w3id.org/ro/wfrun/workflow/0.5, on RO-Crate 1.1. The crate
is the folder of the results: workflow, configuration and environment are copied into it.
"""

from __future__ import annotations

import json
import shutil
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

import snakemake
from rocrate.rocrate import ROCrate

from pagd import __version__
from pagd.audit import OF_DESIGN, OF_STUDY
from pagd.files import must_exist, replaced_folder, write_text
from pagd.record import RECORD_NAME, Record, configuration_hash, read_record
from pagd.tables import read_rows

__all__ = ["METADATA", "PROVENANCE", "write_run_crate"]

#: File of the metadata, and folder of what made the run, in the folder of the results.
METADATA: Final = "ro-crate-metadata.json"
PROVENANCE: Final = "provenance"

_CONFIGURATION: Final = "configuration.json"
_README: Final = "README.md"
_PERFORMANCE: Final = "summary/performance.parquet"
_PROFILES: Final = {
    "https://w3id.org/ro/wfrun/process/0.5": ("Process Run Crate", "0.5"),
    "https://w3id.org/ro/wfrun/workflow/0.5": ("Workflow Run Crate", "0.5"),
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": ("Workflow RO-Crate", "1.0"),
}
_BIOSCHEMAS: Final = "https://bioschemas.org/profiles/ComputationalWorkflow/1.0-RELEASE"
# Of the project's own folder, what a run is made by.
_WORKFLOW: Final = ("Snakefile", "workflow", "requirements.lock", "LICENSE")
_LICENCE: Final = "https://spdx.org/licenses/MIT"
_ENCODINGS: Final = {
    ".csv": "text/csv",
    ".html": "text/html",
    ".json": "application/json",
    ".md": "text/markdown",
    ".parquet": "application/x-parquet",
    ".yaml": "application/yaml",
}
#: What a run leaves, by what it is; what is not there is left out.
_RESULTS: Final = {
    "designs": "a folder a design: geometry, mesh, analysis and metrics, each with its record",
    _PERFORMANCE: "performance of the simulated designs, whatever became of them",
    "summary/summary.csv": "the same for people",
    "summary/by_pressure.parquet": "performance at every recorded pressure",
    "summary/trajectories.parquet": "trajectories of the simulated designs",
    "summary/chambers.parquet": "what every chamber does",
    "dataset": "training designs",
    "embedding": "their reduced space",
    "generated": "generated designs",
    "selection": "those of them that are simulated",
    "diversity": "novelty and diversity, and the comparison of generators",
    "screening": "what a chamber tells of generated and training designs",
    "figures": "pictures of all designs together",
    "report/index.html": "the page",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class _MadeBy:
    """When the oldest of the results was begun and all were there, by what, and what they are."""

    begun: datetime
    ended: datetime
    machines: Sequence[str]
    statuses: Mapping[str, int]
    versions: Mapping[str, str]


def write_run_crate(
    results: Path, project: Path, configuration: Mapping[str, Any], tables: Sequence[Path]
) -> None:
    """Describe a run in the folder of its results.

    Parameters
    ----------
    results
        Folder of the results, with their records.
    project
        Folder of the workflow that has made them.
    configuration
        The whole configuration it ran by, completed, with what the command line changed.
    tables
        Files that the configuration names: tables of designs, and materials.

    Raises
    ------
    InputError
        If the folder is not that of the workflow, or a record cannot be read.
    """
    named = _named(tables)
    with replaced_folder(results / PROVENANCE, _CONFIGURATION) as folder:
        _copy(project, named, configuration, folder)
    crate = ROCrate(version="1.1")
    _describe_root(crate, configuration)
    if (results / _README).is_file():
        _file(crate, _README, "what is in the folder")["about"] = crate.root_dataset
    made_by = _made_by(results)
    workflow = _add_workflow(crate, results, made_by)
    inputs = [_file(crate, f"{PROVENANCE}/{_CONFIGURATION}", "the whole configuration")]
    for name in named:
        inputs.append(_file(crate, f"{PROVENANCE}/inputs/{name}", "designs or materials"))
    outputs = [
        _file(crate, path, what) if (results / path).is_file() else _folder(crate, path, what)
        for path, what in _RESULTS.items()
        if (results / path).exists()
    ]
    _add_action(crate, workflow, made_by, inputs, outputs)
    text = json.dumps(crate.metadata.generate(), indent=2, ensure_ascii=False)
    write_text(results / METADATA, f"{text}\n")


def _named(tables: Sequence[Path]) -> dict[str, Path]:
    """Names of the files in one folder: their own, with a number before it where two have one."""
    found: dict[str, Path] = {}
    for table in dict.fromkeys(table.resolve() for table in tables):
        numbered = (f"{number}-{table.name}" for number in range(1, len(tables) + 1))
        found[next(one for one in (table.name, *numbered) if one not in found)] = table
    return found


def _copy(
    project: Path, tables: Mapping[str, Path], configuration: Mapping[str, Any], folder: Path
) -> None:
    """Copy what made the run."""
    unwanted = shutil.ignore_patterns("__pycache__", ".snakemake")
    for name in _WORKFLOW:
        source = project / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=unwanted)
        else:
            must_exist(source)
            shutil.copyfile(source, folder / name)
    (folder / "inputs").mkdir()
    for name, table in tables.items():
        shutil.copyfile(table, folder / "inputs" / name)
    text = json.dumps(configuration, indent=2, ensure_ascii=False)
    (folder / _CONFIGURATION).write_text(f"{text}\n", encoding="utf-8")


def _describe_root(crate: Any, configuration: Mapping[str, Any]) -> None:
    crate.name = "A run of pagd"
    crate.description = (
        "Soft pneumatic actuators, designed and simulated by pagd. SHA-256 of the configuration: "
        f"{configuration_hash(configuration)}."
    )
    crate.license = _entity(crate, _LICENCE, "CreativeWork", name="MIT License")
    crate.root_dataset["conformsTo"] = [
        _entity(crate, uri, "CreativeWork", name=name, version=version)
        for uri, (name, version) in _PROFILES.items()
    ]


def _add_workflow(crate: Any, results: Path, made_by: _MadeBy) -> Any:
    workflow = crate.add_workflow(
        results / PROVENANCE / "Snakefile",
        f"{PROVENANCE}/Snakefile",
        main=True,
        lang="snakemake",
        lang_version=snakemake.__version__,
        properties={
            "name": "pagd",
            "version": __version__,
            "license": {"@id": _LICENCE},
            "encodingFormat": "text/plain",
        },
    )
    workflow["conformsTo"] = _entity(
        crate, _BIOSCHEMAS, "CreativeWork", name="ComputationalWorkflow", version="1.0"
    )
    _folder(crate, f"{PROVENANCE}/workflow", "rules and scripts of the workflow")
    lock = _file(crate, f"{PROVENANCE}/requirements.lock", "every Python package, by its version")
    workflow["softwareRequirements"] = [
        lock,
        *(
            _entity(crate, f"#{name}", "SoftwareApplication", name=name, softwareVersion=version)
            for name, version in made_by.versions.items()
        ),
    ]
    return workflow


def _add_action(
    crate: Any, workflow: Any, made_by: _MadeBy, inputs: Sequence[Any], outputs: Sequence[Any]
) -> None:
    """The run: when it was, on what kind of machines, and how its designs ended."""
    ended = ", ".join(f"{name} {count:,}" for name, count in made_by.statuses.items())
    action = crate.add_action(
        workflow,
        "#run",
        object=list(inputs),
        result=list(outputs),
        properties={
            "name": "Run of the workflow",
            "description": f"Simulated designs by how they ended: {ended or 'none'}. "
            f"Machines: {'; '.join(made_by.machines)}.",
            "startTime": made_by.begun.isoformat(),
            "endTime": made_by.ended.isoformat(),
            "actionStatus": "http://schema.org/CompletedActionStatus",
        },
    )
    crate.root_dataset["mentions"] = action


def _made_by(results: Path) -> _MadeBy:
    """What the table of the designs and the records of the stages tell of the run."""
    table = results / _PERFORMANCE
    rows = read_rows(table) if table.is_file() else []
    found = list(_records(results, [str(row["design_id"]) for row in rows]))
    begun = [path.stat().st_mtime - record.timings_s["wall"] for path, record in found]
    machines = {configuration_hash(r.machine): r.machine for _, r in found if r.machine}
    return _MadeBy(
        begun=_moment(min(begun, default=time.time())),
        ended=_moment(time.time()),
        machines=[_told(one) for one in machines.values()] or ["not known"],
        statuses=Counter(str(row["status"]) for row in rows),
        versions=_versions(record for _, record in found),
    )


def _records(results: Path, designs: Sequence[str]) -> Iterator[tuple[Path, Record]]:
    """Records of the stages that the results of a run are made of, with their files."""
    folders = [results / name for name in OF_STUDY]
    folders += [results / "screening" / name for name in ("training", "generated")]
    folders += [results / "designs" / name / stage for name in designs for stage in OF_DESIGN]
    for folder in folders:
        path = folder / RECORD_NAME
        if path.is_file():
            yield path, read_record(folder)


def _versions(records: Iterable[Record]) -> dict[str, str]:
    """Versions of what the records name, joined where there are several of one."""
    found: dict[str, dict[str, None]] = {"snakemake": {snakemake.__version__: None}}
    for record in records:
        for name, version in record.versions.items():
            if name != "stage" and version is not None:
                found.setdefault(name, {})[str(version)] = None
    return {name: " and ".join(found[name]) for name in sorted(found)}


def _told(machine: Mapping[str, Any]) -> str:
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['memory_GB']} GB, "
        f"{machine['system']}"
    )


def _moment(seconds: float) -> datetime:
    return datetime.fromtimestamp(round(seconds), tz=UTC)


def _file(crate: Any, path: str, what: str) -> Any:
    encoding = _ENCODINGS.get(Path(path).suffix, "text/plain")
    properties = _described(path, what) | {"encodingFormat": encoding}
    return crate.add_file(dest_path=path, properties=properties)


def _folder(crate: Any, path: str, what: str) -> Any:
    return crate.add_dataset(dest_path=path, properties=_described(path, what))


def _described(path: str, what: str) -> dict[str, str]:
    return {"name": Path(path).name, "description": what}


def _entity(crate: Any, identifier: str, kind: str, **properties: Any) -> Any:
    return crate.add_jsonld({"@id": identifier, "@type": kind, **properties})
