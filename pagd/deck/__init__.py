"""Input decks of the simulated actuators for other finite-element programs."""

from pagd.deck.writing import HELD, SHEET_ELEMENTS, SOLID_ELEMENTS, STRESS_UNITS, write_deck

__all__ = ["HELD", "SHEET_ELEMENTS", "SOLID_ELEMENTS", "STRESS_UNITS", "write_deck"]
