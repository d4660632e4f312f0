"""The elastomer as a ``*HYPERELASTIC`` card."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pagd.errors import InputError
from pagd.materials import Coefficients, Elastomer

__all__ = ["hyperelastic"]

# (J − 1)⁴ and (J − 1)⁶ over D2 and D3 are no part of our laws. CalculiX replaces a D of zero by
# one of its own, (0.1/µ)^i; a large one leaves nothing of the term in either program.
_NO_TERM = 1e9

# Parameters of the card, moduli in MPa, and how many compressibilities D follow.
_Card = tuple[str, list[float], int]


def _neo_hookean(values: Coefficients) -> _Card:
    return "NEO HOOKE", [values["C10"]], 1


def _mooney_rivlin(values: Coefficients) -> _Card:
    if not values.get("C20"):
        return "MOONEY-RIVLIN", [values["C10"], values["C01"]], 1
    return "POLYNOMIAL, N=2", [values["C10"], values["C01"], values["C20"], 0.0, 0.0], 2


def _yeoh(values: Coefficients) -> _Card:
    return "YEOH", [values.get(key, 0.0) for key in ("C10", "C20", "C30")], 3


_CARDS: Mapping[str, Callable[[Coefficients], _Card]] = {
    "neo_hookean": _neo_hookean,
    "mooney_rivlin": _mooney_rivlin,
    "yeoh": _yeoh,
}


def hyperelastic(material: Elastomer, scale: float = 1.0) -> list[str]:
    """Lines of the card; the volumetric energy K/2 (J − 1)² is D1 = 2/K.

    Parameters
    ----------
    material
        The elastomer.
    scale
        How many units of stress in the deck are a MPa.

    Raises
    ------
    InputError
        For a law that the programs do not have (Gent).
    """
    name, constants, terms = _card(material, scale)
    bulk = scale * material.bulk_modulus
    constants += [2 / bulk, *([_NO_TERM] * (terms - 1))]
    rows = [constants[i : i + 8] for i in range(0, len(constants), 8)]
    return [f"*HYPERELASTIC, {name}", *(", ".join(f"{x:.12g}" for x in row) for row in rows)]


def _card(material: Elastomer, scale: float) -> _Card:
    if material.law == "ogden":
        return _ogden(material.coefficients, scale)
    if material.law not in _CARDS:
        raise InputError(
            f"material '{material.name}': law is {material.law!r}, but a deck can only hold "
            f"{', '.join(sorted([*_CARDS, 'ogden']))}"
        )
    name, moduli, terms = _CARDS[material.law](material.coefficients)
    return name, [scale * value for value in moduli], terms


def _ogden(values: Coefficients, scale: float) -> _Card:
    """Both programs write the law with 2µ/α², as we do."""
    pairs = zip(values["mu"], values["alpha"], strict=True)
    terms = len(values["mu"])
    return f"OGDEN, N={terms}", [x for mu, alpha in pairs for x in (scale * mu, alpha)], terms
