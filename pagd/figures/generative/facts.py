"""The numbers of a run that its captions carry, from records and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from pagd.figures.captions import SUPPORTS
from pagd.figures.generative.captions import facts_of_settings, written
from pagd.figures.generative.results import (
    GenerativePaths,
    figures_of,
    load_mixture,
    settings_of,
    table_or_none,
)
from pagd.figures.style import number
from pagd.fronts import reached

__all__ = ["facts_of"]


def facts_of(paths: GenerativePaths) -> dict[str, str]:
    """Return all facts that the results of a run know."""
    settings: dict[str, Any] = {}
    for folder in (paths.embedding, paths.generated, paths.diversity):
        settings |= settings_of(folder)
    measured = _counts(paths) | _mixture(paths)
    measured["trustworthiness"] = figures_of(paths.embedding).get("trustworthiness")
    known = {key: written(value) for key, value in measured.items() if value is not None}
    return facts_of_settings(settings) | known


def _counts(paths: GenerativePaths) -> dict[str, Any]:
    training = table_or_none(paths.dataset / "designs.parquet")
    generated = table_or_none(paths.generated / "designs.parquet")
    simulated = table_or_none(paths.performance)
    screened = {
        "screened": table_or_none(paths.screened / "performance.parquet"),
        "screened_training": table_or_none(paths.screened_training / "performance.parquet"),
    }
    return {
        **{name: None if t is None else len(reached(t)) for name, t in screened.items()},
        "trained": _length(training),
        "generated": _length(generated),
        "mixed": None if generated is None else int((generated["mode"] == "mixed").sum()),
        "simulated": _length(simulated),
        "held": None if simulated is None else int(simulated["blocked_force_N"].notna().sum()),
        "support": None if simulated is None else _support(simulated),
        "succeeded": None if simulated is None else int((simulated["status"] == "ok").sum()),
    }


def _mixture(paths: GenerativePaths) -> dict[str, Any]:
    content = load_mixture(paths)
    weights, bridge, bic = (content.get(name) for name in ("weights", "bridge", "bic"))
    bridged = weights[bridge] if weights and bridge is not None else None
    redrawn = figures_of(paths.generated).get("redrawn_by_generator")
    return {
        "gaussians": len(weights) if weights else None,
        "bridge_weight": None if bridged is None else _percent(bridged),
        "redrawn": None if bridged is None else redrawn,
        "least_bic": min(bic, key=bic.get) if bic else None,
    }


def _support(simulated: pd.DataFrame) -> str | None:
    """Return what held the tips, in words; None where nothing was held."""
    variants = simulated.get("blocked_force_variant", pd.Series(dtype=object)).dropna().unique()
    return ", ".join(SUPPORTS.get(v, v) for v in sorted(variants)) or None


def _percent(share: float) -> str:
    return f"{number(100.0 * share, 0)} %"


def _length(frame: pd.DataFrame | None) -> int | None:
    return None if frame is None else len(frame)
