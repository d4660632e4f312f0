"""Designs and results in the formats of other programs: STEP, ParaView's VTU, CSV."""

from pagd.export.rows import write_csv
from pagd.export.step import write_step

__all__ = ["write_csv", "write_step"]
