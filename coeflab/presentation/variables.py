"""How variables of fitted models are shown: angles in degrees, velocities and rates primed or in SI."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, primed
from coeflab.model.fitted_model import FittedModel
from coeflab.model.table import number
from coeflab.presentation.svg import power_of_ten

Array = NDArray[np.float64]
_NAMES = {
    "alpha": "angle of attack",
    "alpha_deg": "angle of attack",
    "beta": "sideslip",
    "dr": "rudder angle",
    "ds": "stern plane angle",
    "db": "bow plane angle",
    "e": "angle of the surface to the flow",
    "u": "surge velocity",
    "v": "sway velocity",
    "w": "heave velocity",
    "p": "roll rate",
    "q": "pitch rate",
    "r": "yaw rate",
}


def in_radians(variable: str) -> bool:
    """Whether the numbers of a variable are an angle in radians."""
    return variable in ("alpha", "beta", "e", *CONTROLS)


def unit_of(variable: str, model: FittedModel) -> str:
    """The unit in which a variable is shown."""
    if in_radians(variable) or variable == "alpha_deg":
        return "deg"
    if model.unit == "1":
        return "-"
    return "m/s" if variable in LINEAR else "rad/s" if variable in ANGULAR else "-"


def symbol_of(variable: str, model: FittedModel) -> str:
    """``v'``, ``r'``, ``u``, ``alpha``."""
    return f"{variable}'" if variable in (*LINEAR, *ANGULAR) and model.unit == "1" else variable


def axis_name(variable: str, model: FittedModel) -> str:
    """Label of an axis, with its unit."""
    name, symbol, unit = _NAMES.get(variable, ""), symbol_of(variable, model), unit_of(variable, model)
    shown = symbol.removesuffix("_deg")
    if symbol.endswith("'"):
        shown = f"{symbol} = {variable}/U" if variable in LINEAR else f"{symbol} = {variable} L/U"
    return f"{name} {shown}  [{unit}]".strip()


def shown_values(variable: str, x: Array) -> Array:
    """Values as an axis shows them."""
    return np.degrees(x) if in_radians(variable) else np.asarray(x)


def response_name(model: FittedModel) -> str:
    """``Y'`` for primes, else the response as it is."""
    return primed(model.response) if model.unit == "1" and model.response in COMPONENTS else model.response


def response_unit(model: FittedModel) -> str:
    """Unit of the response, ``-`` for none."""
    return "-" if model.unit == "1" else model.unit


def scale_of(values: Array) -> tuple[float, str]:
    """Factor that brings values to a readable size, and its text; values of some tenths stay as they are."""
    largest = float(np.max(np.abs(values), initial=0.0))
    return (1.0, "") if 0.1 <= largest < 1.0 else power_of_ten(largest)


def moving(model: FittedModel) -> tuple[str, ...]:
    """Variables of the terms that differ between the rows."""
    terms = dict.fromkeys(v for t in model.terms for v, _, _ in t.factors)
    ordered = [
        *(v for v in model.domain.variables if v in terms),
        *(v for v in terms if v not in model.domain.variables),
    ]
    return tuple(v for v in ordered if np.ptp(model.x[v]) > 0.0)


def domain_in_words(model: FittedModel) -> str:
    """The box of the domain, each variable with its unit: ``alpha -25.0 .. 25.0 deg``."""
    parts = []
    for v, low, high in zip(model.domain.variables, model.domain.low, model.domain.high, strict=True):
        unit = unit_of(v, model)
        ends = " .. ".join(number(float(x) + 0.0, 3) for x in shown_values(v, np.array([low, high])))
        parts.append(f"{symbol_of(v, model)} {ends}" + (f" {unit}" if unit != "-" else ""))
    return "; ".join(parts)
