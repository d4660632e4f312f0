"""The page of results: one HTML file, and a folder of cards beside it; it needs no network."""

from pagd.figures.page.study import Study
from pagd.figures.page.write import cards_beside, write_page

__all__ = ["Study", "cards_beside", "write_page"]
