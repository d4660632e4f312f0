"""What became of one design: a folder of its stages, with figures, tables and a picture."""

from __future__ import annotations

import base64
import html
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pagd.errors import InputError, Status
from pagd.notebook import is_notebook
from pagd.record import RECORD_NAME, Record, read_record

if TYPE_CHECKING:
    import pandas as pd

    from pagd.design import Design
    from pagd.families import Actuator
    from pagd.tables import Column

__all__ = ["Result", "read_result"]


def read_result(folder: Path | str) -> Result:
    """Open the folder of a design: one of ``results/designs/``, or what ``pagd run`` has left.

    Raises
    ------
    InputError
        If it holds no record of the metrics, the last stage of an analysis.
    """
    path = Path(folder)
    if not (path / "metrics" / RECORD_NAME).is_file():
        raise InputError(
            f"folder = {path} must be that of a design, with metrics/{RECORD_NAME} in it."
        )
    return Result(path, read_record(path / "metrics"))


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """How one design ended, and what was measured on the way.

    A design that failed is a result like others: ``status`` and ``reason`` tell how, and figures
    and tables go as far as it came. In a notebook it shows itself as its deformed shapes and a
    short table.

    folder: the folders of the stages are in it.
    record: that of the last one, the metrics.
    """

    folder: Path
    record: Record

    @property
    def name(self) -> str:
        """Name of the design."""
        return self.record.design_id

    @property
    def status(self) -> Status:
        """How it ended; everything but ``ok`` comes with a reason."""
        return self.record.status

    @property
    def reason(self) -> str | None:
        """Why it is not ok, in one sentence."""
        return self.record.reason

    @cached_property
    def design(self) -> Design | Actuator | None:
        """The design, or None where a mesh of one's own was solved."""
        from pagd.figures.load import load_design

        return load_design(self.folder)

    @property
    def figures(self) -> Mapping[str, Any]:
        """The design's row in the table of all designs, at its last pressure; units in the keys."""
        return self.record.figures

    @property
    def bending_deg(self) -> float:
        """Bending of the tip at the last pressure; not a number where it was not measured."""
        return self._figure("bending_deg")

    @property
    def twist_deg(self) -> float:
        """Twist of the tip at the last pressure; not a number where it was not measured."""
        return self._figure("twist_deg")

    @property
    def blocked_force_N(self) -> float:
        """Force of the held tip at its own last pressure; not a number where none was measured."""
        return self._figure("blocked_force_N")

    @property
    def performance(self) -> pd.DataFrame:
        """Bending, twist, tip, work, strain, force and so on: a row a recorded pressure."""
        from pagd.tables import MEASURES

        return self._table("metrics/performance.parquet", MEASURES)

    @property
    def trajectory(self) -> pd.DataFrame:
        """Where every section is and how it is turned: a row a station and recorded pressure."""
        from pagd.tables import TRAJECTORY

        return self._table("metrics/trajectory.parquet", TRAJECTORY)

    @property
    def history(self) -> pd.DataFrame:
        """Pressure, volume, work and gaps in free actuation: a row a converged step."""
        from pagd.tables import HISTORY

        return self._table("solve/history.parquet", HISTORY)

    def picture(self) -> bytes | None:
        """Return a picture as PNG: deformed shapes, else the geometry; None if neither is there."""
        return self._picture

    def show(self) -> None:
        """Show the result in a notebook; elsewhere print its figures and where it is."""
        if is_notebook():
            from IPython.display import display

            display(self)  # type: ignore[no-untyped-call]
            return
        width = max(len(label) for label in self._short())
        for label, value in self._short().items():
            print(f"{label:<{width}}  {value}")
        print(f"{'folder':<{width}}  {self.folder}")

    def __repr__(self) -> str:
        if math.isnan(self.bending_deg):
            told = f"{self.status}: {self.reason}"
        else:
            told = (
                f"{self.status}, bends by {self.bending_deg:z.1f}° and twists by "
                f"{self.twist_deg:z.1f}° at {self.figures['pressure_kPa']:g} kPa"
            )
        return f"<Result of {self.name}: {told.rstrip('.')}; {self.folder}>"

    def _repr_mimebundle_(
        self, include: object = None, exclude: object = None
    ) -> dict[str, str | bytes]:
        """What notebooks ask for; they choose by what they can show."""
        bundle: dict[str, str | bytes] = {"text/plain": repr(self), "text/html": self._as_html()}
        return bundle | ({"image/png": self._picture} if self._picture else {})

    def _figure(self, key: str) -> float:
        value = self.figures.get(key)
        return math.nan if value is None else float(value)

    def _table(self, name: str, columns: tuple[Column, ...]) -> pd.DataFrame:
        import pandas as pd

        from pagd.tables import read_table

        path = self.folder / name
        if path.is_file():
            return pd.DataFrame(read_table(path))
        return pd.DataFrame(columns=[column.name for column in columns])

    @cached_property
    def _picture(self) -> bytes | None:
        from pagd.figures.result import picture_of

        return picture_of(self.folder)

    def _short(self) -> dict[str, str]:
        """Return the figures that people ask for first, as text by name."""
        from pagd.figures.result import short_table

        return short_table(self.record)

    def _as_html(self) -> str:
        rows = "".join(
            f'<tr><th style="text-align: left">{html.escape(label)}</th>'
            f'<td style="text-align: left">{html.escape(value)}</td></tr>'
            for label, value in self._short().items()
        )
        table = f"<table>{rows}</table>"
        if self._picture is None:
            return table
        data = base64.b64encode(self._picture).decode("ascii")
        shapes = html.escape(f"{self.name}: shapes under pressure")
        image = f'<img style="max-width: 100%" alt="{shapes}" src="data:image/png;base64,{data}">'
        return f"<div>{image}{table}</div>"
