"""Parquet tables as CSV, for spreadsheets."""

from __future__ import annotations

from pathlib import Path

from pagd.files import replaced_file

__all__ = ["write_csv"]


def write_csv(table: Path, out: Path) -> None:
    """Write all rows and columns of a Parquet table as CSV, with a row of headings.

    Raises
    ------
    InputError
        If the table cannot be read.
    """
    import pandas as pd

    from pagd.tables import read_table

    with replaced_file(out) as temporary:
        pd.DataFrame(read_table(table)).to_csv(temporary, index=False, float_format="%.9g")
