"""The paper beside this run: what it says or draws, what was measured here, and where to look.

The paper is Ghosh and Roy, "Generative design of multimodal Soft Pneumatic Actuators"; numbers of
figures and tables are its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from pagd.diversity.comparison import TRAINING
from pagd.figures.page.markup import escaped
from pagd.figures.page.rows import Row
from pagd.figures.page.study import Study, comparison_of, record_in
from pagd.figures.style import number
from pagd.tables import read_table

__all__ = ["Claim", "claims", "claims_of"]

_KNOWN = "table2"
_METHODS = {"tsne": "t-SNE"}
# What the paper describes: Gaussians where the data are, and none that is put between them.
_PLAIN = "gmm_plain"
# Angles below this are none: a straight row is symmetric, and twists by round-off alone.
_ANGLE_DEG = 1.0


class Claim(NamedTuple):
    """What the paper says, where it does, what was measured here, and the section that shows it."""

    said: str
    where: str
    measured: str
    section: str


def claims(study: Study, rows: Sequence[Row]) -> str:
    """Return a table of what the paper says beside what this run has measured, as markup."""
    found = list(claims_of(study, rows))
    if not found:
        return ""
    body = "".join(
        f"<tr><td>{escaped(one.said)} <small>{escaped(one.where)}</small></td>"
        f"<td>{escaped(one.measured)}</td>"
        f'<td><a href="#{one.section}">see</a></td></tr>'
        for one in found
    )
    head = "<tr><th>in the paper</th><th>in this run</th><th></th></tr>"
    return f'<table class="claims"><thead>{head}</thead><tbody>{body}</tbody></table>'


def claims_of(study: Study, rows: Sequence[Row]) -> Iterator[Claim]:
    """Return the claims that this run can say something about.

    Parameters
    ----------
    study
        Where the results of the generative half lie.
    rows
        Simulated designs, of :func:`pagd.figures.page.rows.rows_of`.
    """
    method = [*_of_data(study), *_of_generator(study), *_of_diversity(study)]
    paper = list(_of_table_2(rows))
    yield from method
    # Designs of one's own alone are beside nothing in the paper.
    if method or paper:
        yield from _of_analysis(rows)
    yield from paper


def _of_data(study: Study) -> Iterator[Claim]:
    dataset, embedding = record_in(study.dataset), record_in(study.embedding)
    if dataset is not None:
        found = dataset.figures
        kinds = {kind: sum(parts.values()) for kind, parts in found.get("counts", {}).items()}
        told = ", ".join(f"{count:,} {kind}" for kind, count in kinds.items())
        yield Claim(
            "11,000 designs of 16 parameters in two categories, random and around published ones",
            "",
            f"{found['size']:,} designs: {told}",
            "dataset",
        )
    if dataset is not None and embedding is not None:
        setting = embedding.configuration.get("embedding", {})
        yield Claim(
            "t-SNE with perplexity 30 shows the two categories as separate clusters",
            "Fig. 4a",
            f"{_METHODS.get(setting.get('method'), setting.get('method'))} with perplexity "
            f"{setting.get('perplexity', 0):g}: of {_percent(_alike(study))} of the designs the "
            "nearest one in the plane is of their own category",
            "dataset",
        )


def _alike(study: Study) -> float:
    """Share of the training designs whose nearest one in the plane is of the same category."""
    assert study.dataset is not None
    assert study.embedding is not None
    modes = read_table(study.dataset / "designs.parquet")["mode"]
    points = read_table(study.embedding / "points.parquet")
    places = np.column_stack([points[name] for name in sorted(points) if name != "design_id"])
    nearest = cKDTree(places).query(places, k=2)[1][:, 1]
    return float(np.mean(modes == modes[nearest]))


def _percent(share: float) -> str:
    return f"{number(100.0 * share, 1 if 0.99 < share < 1.0 else 0)} %"


def _of_generator(study: Study) -> Iterator[Claim]:
    compared, generated = record_in(study.comparison), record_in(study.generated)
    if generated is None:
        return
    found, setting = generated.figures, generated.configuration.get("generator", {})
    told = f"{setting.get('method')}: {_mixed(found.get('mode_share', {}))} of the designs"
    if setting.get("method") == "gmm":
        told += ", by a component between the two whose weight is a setting"
    plain = compared.figures.get("mode_share", {}).get(_PLAIN) if compared else None
    if plain:
        told = f"not by the data alone ({_PLAIN}: {_mixed(plain)} of the designs); {told}"
    yield Claim(
        "a mixture of Gaussians finds three where the data has two categories: the third is mixed",
        "Fig. 4b",
        told,
        "generator",
    )


def _mixed(shares: Mapping[str, float]) -> str:
    return f"mixed {_percent(shares.get('mixed', 0.0))}"


def _of_diversity(study: Study) -> Iterator[Claim]:
    content = comparison_of(study)
    own = str(content.get("generator"))
    names = {own: own, _PLAIN: _PLAIN, TRAINING: "training designs among themselves"}
    novelty = {name: _value_of(content, name, "novelty", "plane_sample") for name in names}
    if novelty[own] is not None:
        told = ", ".join(
            f"{names[name]} {number(value['value'], 3)}" for name, value in novelty.items() if value
        )
        yield Claim(
            "1,000 generated designs have a novelty of 0.014, in a space that is not told",
            "",
            f"in a plane of a few training designs, scaled to the unit square: {told}",
            "diversity",
        )
    row = _value_of(content, own, "hull_ratio", "plane")
    if row is not None and row.get("low") is not None:
        low, high = (number(row[key], 2) for key in ("low", "high"))
        sure = "" if row["low"] > 1.0 else "; no larger hull is certain"
        yield Claim(
            "50 generated designs span a larger convex hull than 50 training designs",
            "Fig. 5",
            f"{number(row['value'], 2)} times the area ({low} to {high} for other fifties){sure}",
            "diversity",
        )


def _value_of(
    content: Mapping[str, Any], generator: str, metric: str, space: str
) -> Mapping[str, Any] | None:
    wanted = (generator, metric, space, "all")
    keys = ("generator", "metric", "space", "mode")
    rows = (row for row in content.get("rows", ()) if tuple(map(row.get, keys)) == wanted)
    return next((row for row in rows if row.get("value") is not None), None)


def _of_analysis(rows: Sequence[Row]) -> Iterator[Claim]:
    if not rows:
        return
    counts = Counter(str(row["status"]).replace("_", " ") for row in rows)
    yield Claim(
        "finite elements without a hand for every design; some do not move, some do not converge",
        "",
        f"{len(rows)} designs: " + ", ".join(f"{n} {status}" for status, n in counts.most_common()),
        "explorer",
    )


def _of_table_2(rows: Sequence[Row]) -> Iterator[Claim]:
    found = [row for row in rows if row.get("origin") == _KNOWN and _angles(row)]
    if not found:
        return
    told = "; ".join(
        f"{row['design_id']} at {number(row['pressure_kPa'], 0)} kPa: {_angles(row)}"
        for row in found
    )
    yield Claim(
        "straight chambers bend, slanted ones bend and twist, a mixed row does both",
        "Table 2, Fig. 6 and 7",
        told,
        "paths",
    )


def _angles(row: Row) -> str:
    angles = {"bends": row.get("bending_deg"), "twists": row.get("twist_deg")}
    known = {word: value for word, value in angles.items() if value is not None}
    return ", ".join(
        f"{word} by {number(value, 0)}°" if abs(value) >= _ANGLE_DEG else f"{word} not"
        for word, value in known.items()
    )
