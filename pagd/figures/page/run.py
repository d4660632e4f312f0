"""What was run: how many designs of which kind, how they ended, and with which settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pagd.figures.groups import Entry
from pagd.figures.load import load_records
from pagd.figures.page.markup import badge, data_table, escaped, facts, folded
from pagd.figures.page.rows import Row
from pagd.figures.style import MODE_LOOKS
from pagd.record import Record

__all__ = ["what_was_run"]

_ORIGINS = {
    "table2": "Table 2 of the paper",
    "published": "published actuators",
    "generated": "generated designs",
}


def what_was_run(
    entries: Iterable[Entry], rows: Sequence[Row], others: Iterable[Record | None]
) -> str:
    """Return counts by status, origin and mode, the settings, and all versions, as markup."""
    records = [record for entry in entries for record in load_records(entry.folder).values()]
    settings = [record.configuration for record in records]
    return "".join(
        [
            facts(
                [
                    ("simulated designs", str(len(rows))),
                    ("how they ended", _statuses(rows)),
                    ("material", _values(settings, "material", "name")),
                    ("pressure up to", _values(settings, "solve", "maximum_pressure_kPa", "kPa")),
                    ("mesh size", _told((row.get("size_mm") for row in rows), "mm")),
                    ("element", _told(record.figures.get("element") for record in records)),
                    ("contact between chambers", _values(settings, "solve", "contact")),
                    ("pagd", _versions(records, "pagd")),
                ]
            ),
            _counts(rows) if len(rows) > 1 else "",
            folded("Versions", _all_versions([*records, *filter(None, others)])),
        ]
    )


def _told(values: Iterable[Any], unit: str = "") -> str:
    """The values that are known, once each."""
    found = {f"{_word(value)} {unit}".strip(): True for value in values if value is not None}
    return escaped(", ".join(found))


def _statuses(rows: Sequence[Row]) -> str:
    counts = Counter(str(row["status"]) for row in rows)
    return " ".join(
        badge(f"{count} {status.replace('_', ' ')}", ok=status == "ok")
        for status, count in counts.most_common()
    )


def _counts(rows: Sequence[Row]) -> str:
    """Return a table of origins by modes: how many ended well, of how many."""
    modes = [*MODE_LOOKS, *sorted({str(row["mode"]) for row in rows} - set(MODE_LOOKS))]
    origins = list(dict.fromkeys(str(row["origin"]) for row in rows))
    body = [
        [
            _ORIGINS.get(origin, origin),
            *(_share(rows, {"origin": origin, "mode": mode}) for mode in modes),
            _share(rows, {"origin": origin}),
        ]
        for origin in origins
    ]
    body.append(["all", *(_share(rows, {"mode": mode}) for mode in modes), _share(rows, {})])
    note = '<p class="note">Designs that ended well, of those simulated, by the mode drawn for.</p>'
    return data_table(["", *modes, "all"], body) + note


def _share(rows: Iterable[Row], kind: Mapping[str, str]) -> str:
    chosen = [row for row in rows if all(row[key] == value for key, value in kind.items())]
    good = sum(row["status"] == "ok" for row in chosen)
    return f"{good} of {len(chosen)}" if chosen else "–"


def _values(settings: Iterable[Mapping[str, Any]], part: str, key: str, unit: str = "") -> str:
    """Return the values of a setting in all records, once each."""
    found = {}
    for setting in settings:
        if isinstance(setting.get(part), Mapping) and key in setting[part]:
            value = setting[part][key]
            found[f"{_word(value)} {unit}".strip()] = True
    return escaped(", ".join(found))


def _word(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, float) else str(value).replace("_", " ")


def _versions(records: Iterable[Record], library: str) -> str:
    found = (record.versions.get(library) for record in records)
    return escaped(", ".join(dict.fromkeys(str(version) for version in found if version)))


def _all_versions(records: Sequence[Record]) -> str:
    names = sorted({name for r in records for name in r.versions if name != "stage"})
    return facts([(name, _versions(records, name)) for name in names])
