"""The page of results: one HTML file that needs neither a network nor any other file."""

from pagd.figures.page.study import Study
from pagd.figures.page.write import write_page

__all__ = ["Study", "write_page"]
