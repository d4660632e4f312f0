"""Materials: hyperelastic elastomers and the paper, read from a YAML file.

Units: MPa, kg/m³ and mm. Every result names its material, because published
constants of one product differ by up to a factor of two.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import yaml
from numpy.typing import NDArray

from pagd.documents import parse_yaml
from pagd.errors import InputError

POLYNOMIAL = 0
GENT = 1
OGDEN = 2

Coefficients = Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Elastomer:
    """A nearly incompressible isotropic hyperelastic material.

    Attributes
    ----------
    name
        The name it has in results.
    law
        ``neo_hookean``, ``mooney_rivlin``, ``yeoh``, ``gent`` or ``ogden``.
    coefficients
        The law's coefficients under their usual names; see :data:`LAWS`.
    poisson_ratio
        ν of the small-strain limit; sets the bulk modulus K = 2µ(1+ν)/(3(1−2ν)).
    density_kg_m3
        Mass density, which gravity alone makes use of.
    largest_stretch
        Principal stretch beyond which the material is taken to be overstretched.
    source
        Where the coefficients come from.
    """

    name: str
    law: str
    coefficients: Coefficients
    poisson_ratio: float = 0.499
    density_kg_m3: float = 1100.0
    largest_stretch: float = 4.0
    source: str = ""

    @property
    def kind(self) -> int:
        """The family of kernels that evaluates the law: POLYNOMIAL, GENT or OGDEN."""
        return LAWS[self.law].kind

    @property
    def parameters(self) -> NDArray[np.float64]:
        """The numbers the kernels take, in MPa where they are moduli."""
        return np.array(LAWS[self.law].parameters(self.coefficients), dtype=np.float64)

    @property
    def shear_modulus(self) -> float:
        """µ of the small-strain limit, in MPa."""
        numbers = self.parameters
        if self.kind == POLYNOMIAL:
            return float(2 * (numbers[0] + numbers[3]))
        return float(numbers[0]) if self.kind == GENT else float(numbers[0::2].sum())

    @property
    def bulk_modulus(self) -> float:
        """K = 2µ(1+ν)/(3(1−2ν)), in MPa."""
        nu = self.poisson_ratio
        return 2 * self.shear_modulus * (1 + nu) / (3 * (1 - 2 * nu))


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """A thin linear elastic sheet, such as the paper in the base.

    Attributes: ``youngs_modulus`` in MPa, ``poisson_ratio``, ``thickness`` in mm.
    """

    name: str
    youngs_modulus: float
    poisson_ratio: float
    thickness: float
    density_kg_m3: float = 750.0
    source: str = ""

    @property
    def membrane_stiffness(self) -> float:
        """E h / (1 − ν²), in N/mm."""
        return self.youngs_modulus * self.thickness / (1 - self.poisson_ratio**2)

    @property
    def bending_stiffness(self) -> float:
        """E h³ / (12 (1 − ν²)), in N·mm."""
        return self.membrane_stiffness * self.thickness**2 / 12


@dataclass(frozen=True, slots=True)
class _Law:
    """Kernel family, the names of the coefficients (required, optional), their translation."""

    kind: int
    required: tuple[str, ...]
    optional: tuple[str, ...]
    parameters: Callable[[Coefficients], list[float]]


def _polynomial(coefficients: Coefficients) -> list[float]:
    return [float(coefficients.get(key, 0.0)) for key in ("C10", "C20", "C30", "C01")]


def _gent(coefficients: Coefficients) -> list[float]:
    return [float(coefficients["mu"]), float(coefficients["Jm"])]


def _ogden(coefficients: Coefficients) -> list[float]:
    moduli, exponents = coefficients["mu"], coefficients["alpha"]
    return [float(x) for pair in zip(moduli, exponents, strict=True) for x in pair]


#: The laws. With Ī₁, Ī₂ the isochoric invariants and λ̄ the isochoric stretches:
#: neo-Hookean C10 (Ī₁−3); Mooney–Rivlin adds C01 (Ī₂−3) and, if given, C20 (Ī₁−3)²;
#: Yeoh Σ Ci0 (Ī₁−3)^i, i ≤ 3; Gent −½ µ Jm ln(1 − (Ī₁−3)/Jm);
#: Ogden Σ 2µ_i/α_i² (λ̄₁^α_i + λ̄₂^α_i + λ̄₃^α_i − 3), the form Abaqus uses.
LAWS: Mapping[str, _Law] = {
    "neo_hookean": _Law(POLYNOMIAL, ("C10",), (), _polynomial),
    "mooney_rivlin": _Law(POLYNOMIAL, ("C10", "C01"), ("C20",), _polynomial),
    "yeoh": _Law(POLYNOMIAL, ("C10",), ("C20", "C30"), _polynomial),
    "gent": _Law(GENT, ("mu", "Jm"), (), _gent),
    "ogden": _Law(OGDEN, ("mu", "alpha"), (), _ogden),
}

_ELASTOMER_KEYS = {
    "law",
    "coefficients",
    "poisson_ratio",
    "density_kg_m3",
    "largest_stretch",
    "source",
}
_SHEET_KEYS = {"law", "youngs_modulus", "poisson_ratio", "thickness", "density_kg_m3", "source"}


def _number(owner: str, key: str, value: Any, low: float, high: float) -> float:
    """``value`` as a float in (low, high), or an error that names owner, key, value and rule."""
    good = isinstance(value, int | float) and not isinstance(value, bool)
    if not (good and math.isfinite(value) and low < value < high):
        rule = f"a number greater than {low:g}" + (f" and less than {high:g}" if high < 1e9 else "")
        raise InputError(f"material '{owner}': {key} is {value!r}, but must be {rule}")
    return float(value)


def _check_keys(owner: str, given: Mapping[str, Any], required: set[str], known: set[str]) -> None:
    unknown, missing = sorted(set(given) - known), sorted(required - set(given))
    if unknown:
        raise InputError(
            f"material '{owner}': unknown key {', '.join(unknown)}; known are "
            f"{', '.join(sorted(known))}"
        )
    if missing:
        raise InputError(f"material '{owner}': {', '.join(missing)} is missing")


def _check_ogden(owner: str, coefficients: Coefficients) -> None:
    moduli, exponents = coefficients["mu"], coefficients["alpha"]
    lists = isinstance(moduli, list) and isinstance(exponents, list)
    if not lists or len(moduli) != len(exponents) or not 1 <= len(moduli) <= 3:
        raise InputError(
            f"material '{owner}': mu is {moduli!r} and alpha is {exponents!r}, but both must be "
            "lists of the same length, 1 to 3"
        )
    for modulus, exponent in zip(moduli, exponents, strict=True):
        _number(owner, "mu", modulus, -math.inf, math.inf)
        _number(owner, "alpha", exponent, -math.inf, math.inf)
        if exponent == 0:
            raise InputError(f"material '{owner}': alpha is 0, but must not be zero")


def _check_coefficients(owner: str, law: str, coefficients: Any) -> None:
    if law not in LAWS:
        raise InputError(
            f"material '{owner}': law is {law!r}, but must be one of {', '.join(sorted(LAWS))}"
        )
    if not isinstance(coefficients, Mapping):
        raise InputError(f"material '{owner}': coefficients must be a table of names and numbers")
    required, optional = set(LAWS[law].required), set(LAWS[law].optional)
    _check_keys(owner, coefficients, required, required | optional)
    if law == "ogden":
        _check_ogden(owner, coefficients)
        return
    for key, value in coefficients.items():
        _number(owner, key, value, 0.0 if key in ("mu", "Jm") else -math.inf, math.inf)


def elastomer(name: str, entry: Mapping[str, Any]) -> Elastomer:
    """Make an elastomer of one entry of the material file; ``InputError`` where it is unusable."""
    _check_keys(name, entry, {"law", "coefficients"}, _ELASTOMER_KEYS)
    _check_coefficients(name, entry["law"], entry["coefficients"])
    result = Elastomer(
        name=name,
        law=entry["law"],
        coefficients=dict(entry["coefficients"]),
        poisson_ratio=_number(name, "poisson_ratio", entry.get("poisson_ratio", 0.499), 0.0, 0.5),
        density_kg_m3=_number(
            name, "density_kg_m3", entry.get("density_kg_m3", 1100.0), 0.0, math.inf
        ),
        largest_stretch=_number(
            name, "largest_stretch", entry.get("largest_stretch", 4.0), 1.0, math.inf
        ),
        source=str(entry.get("source", "")),
    )
    _number(name, "the initial shear modulus", result.shear_modulus, 0.0, math.inf)
    return result


def sheet(name: str, entry: Mapping[str, Any]) -> Sheet:
    """Make a sheet of one entry of the material file; ``InputError`` where it is unusable."""
    required = {"youngs_modulus", "poisson_ratio", "thickness"}
    _check_keys(name, entry, required, _SHEET_KEYS)
    return Sheet(
        name=name,
        youngs_modulus=_number(name, "youngs_modulus", entry["youngs_modulus"], 0.0, math.inf),
        poisson_ratio=_number(name, "poisson_ratio", entry["poisson_ratio"], -1.0, 0.5),
        thickness=_number(name, "thickness", entry["thickness"], 0.0, math.inf),
        density_kg_m3=_number(
            name, "density_kg_m3", entry.get("density_kg_m3", 750.0), 0.0, math.inf
        ),
        source=str(entry.get("source", "")),
    )


def read_materials(path: Path) -> dict[str, dict[str, Any]]:
    """Read the material file: name → entry. ``InputError`` where it is not such a table."""
    try:
        entries = parse_yaml(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"material file {path}: cannot be read ({reason})") from None
    if not isinstance(entries, dict) or not all(isinstance(e, dict) for e in entries.values()):
        raise InputError(f"material file {path}: must be a table of materials by name")
    return entries


#: What an entry is used for: ``material`` is an elastomer, ``paper`` a sheet.
Use: TypeAlias = Literal["material", "paper"]


def find_material(path: Path, name: str, use: Use = "material") -> dict[str, Any]:
    """The entry ``name`` of the material file; ``InputError`` names those there are for ``use``."""
    entries = read_materials(path)
    fitting = {n: e for n, e in entries.items() if ("youngs_modulus" in e) == (use == "paper")}
    if name not in fitting:
        raise InputError(
            f"{use} is {name!r}, but must be one of {', '.join(sorted(fitting))} (in {path})"
        )
    return fitting[name]
