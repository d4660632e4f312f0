"""The paper beside this run: what it says or draws, what was measured here, and where to look.

The paper is Ghosh and Roy, "Generative design of multimodal Soft Pneumatic Actuators"; numbers of
figures and tables are its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from pagd.figures.page.markup import escaped
from pagd.figures.page.rows import Row
from pagd.figures.page.study import Study, comparison_of, record_in
from pagd.figures.style import number

__all__ = ["Claim", "claims", "claims_of"]

_KNOWN = "table2"
_METHODS = {"tsne": "t-SNE"}
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
            "data set",
            f"{found['size']:,} designs: {told}",
            "dataset",
        )
    if embedding is not None:
        found, setting = embedding.figures, embedding.configuration.get("embedding", {})
        yield Claim(
            "t-SNE with perplexity 30 shows two separate clusters",
            "Fig. 4a",
            f"{_METHODS.get(setting.get('method'), setting.get('method'))} with perplexity "
            f"{setting.get('perplexity', 0):g}, "
            f"trustworthiness {number(found.get('trustworthiness', 0.0), 3)}",
            "dataset",
        )


def _of_generator(study: Study) -> Iterator[Claim]:
    generated = record_in(study.generated)
    if generated is None:
        return
    found = generated.figures
    shares = found.get("mode_share", {})
    told = ", ".join(f"{mode} {number(100.0 * share, 0)} %" for mode, share in shares.items())
    yield Claim(
        "a mixture of Gaussians finds three where the data has two categories: the third is mixed",
        "Fig. 4b",
        f"of {found['designs']:,} generated designs {told}",
        "generator",
    )
    if found.get("novelty_plane_mean") is not None:
        yield Claim(
            "novelty 0.014, of 1,000 generated designs; the space is not told",
            "d_new",
            f"{number(found['novelty_plane_mean'], 3)} in the plane scaled to the unit square, "
            f"{number(found['novelty_mean'], 2)} in all standardised parameters",
            "diversity",
        )


def _of_diversity(study: Study) -> Iterator[Claim]:
    content = comparison_of(study)
    row = _row_of(content, "hull_ratio", "plane")
    if row is not None:
        low, high = (number(row[key], 2) for key in ("low", "high"))
        sure = "" if row["low"] > 1.0 else "; no larger hull is certain"
        yield Claim(
            "50 generated designs span a larger convex hull than 50 training designs",
            "Fig. 5",
            f"{number(row['value'], 2)} times the area ({low} to {high} for other fifties){sure}",
            "diversity",
        )


def _row_of(content: Mapping[str, Any], metric: str, space: str) -> Mapping[str, Any] | None:
    wanted = (content.get("generator"), metric, space, "all")
    keys = ("generator", "metric", "space", "mode")
    rows = (row for row in content.get("rows", ()) if tuple(map(row.get, keys)) == wanted)
    return next((row for row in rows if None not in map(row.get, ("value", "low", "high"))), None)


def _of_analysis(rows: Sequence[Row]) -> Iterator[Claim]:
    if not rows:
        return
    counts = Counter(str(row["status"]).replace("_", " ") for row in rows)
    yield Claim(
        "finite elements without a hand for every design; some do not move, some do not converge",
        "feasibility",
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
