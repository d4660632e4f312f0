"""An example of every subcommand, for its help."""

from __future__ import annotations

from typing import Final

__all__ = ["EXAMPLES"]

#: Subcommand, with the action of ``design``, to a command as it is typed.
EXAMPLES: Final = {
    "run": "pagd run my_actuator.yaml --out my_actuator --block-mm 4 --threads 2",
    "check": "pagd design check my_actuator.yaml",
    "show": "pagd design show my_actuator.yaml",
    "geometry": "pagd geometry my_actuator.yaml --out geometry",
    "repair": "pagd repair --geometry geometry --out repair",
    "mesh": "pagd mesh --geometry geometry --repair repair --block-mm 4 --out mesh",
    "solve": "pagd solve my_actuator.yaml --material dragon_skin_30 --pressure-kPa 30 --out solved",
    "metrics": "pagd metrics --geometry geometry --repair repair --mesh mesh --solve solve"
    " --out metrics",
    "figures": "pagd figures my_actuator --out pictures",
    "export": "pagd export my_actuator --out exported",
    "deck": "pagd deck --mesh mesh --pressure-kPa 20 --one-step --out actuator.inp",
    "view": "pagd view my_actuator",
    "report": "pagd report results/designs/* --out designs.html",
    "summary": "pagd summary results/designs/* --out tables",
    "dataset": "pagd dataset --size 2000 --sampling sobol --out dataset",
    "embed": "pagd embed --dataset dataset --perplexity 20 --threads 2 --out embedding",
    "generate": "pagd generate -n 100 --mode mixed --out mixed",
    "diversity": "pagd diversity --dataset dataset --embedding embedding --generated generated"
    " --out diversity",
    "select": "pagd select --dataset dataset --generated generated -n 6 --out selection",
    "screen": "pagd screen mixed/designs.parquet --processes 2 --out screened",
    "sample": "pagd sample --family half_bellows -n 100 --out bellows.csv",
    "status": "pagd status --json",
    "audit": "pagd audit --quick",
    "archive": "pagd archive results --out archive --zip archive.zip",
    "check-archive": "pagd check-archive archive.zip",
}
