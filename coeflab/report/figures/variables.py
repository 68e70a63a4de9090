"""How variables of fitted models are shown: angles in degrees, velocities and rates primed or in SI.

Points of a fitted model in a panel: used ones filled, rejected or doubtful ones hollow.

What captions of fitted models say.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.table import number
from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.lack_of_fit import chance
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, primed
from coeflab.report.figures.palette import COLOURS, power_of_ten, superscript
from coeflab.report.texts import text_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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


MANY = 60


def used(axes: Axes, x: Array, y: Array) -> list[Any]:
    """Points that the fit uses; smaller where they are many."""
    size = 3.2 if len(x) <= MANY else 2.0
    drawn: list[Any] = axes.plot(
        x, y, linestyle="none", marker="o", markersize=size, markerfacecolor=COLOURS["ink"], markeredgewidth=0.0,
        zorder=4, label="points",
    )  # fmt: skip
    return drawn


def hollow(axes: Axes, x: Array, y: Array) -> list[Any]:
    """Points that the fit does not use."""
    drawn: list[Any] = axes.plot(
        x, y, linestyle="none", marker="o", markersize=4.6, markerfacecolor="none", markeredgecolor=COLOURS["ink"],
        markeredgewidth=0.8, zorder=3.5, label=f"rejected or doubtful ({len(x)})",
    )  # fmt: skip
    return drawn


def draw_set_aside(axes: Axes, model: FittedModel, variable: str, factor: float) -> list[Any]:
    """The rejected and doubtful points over a variable, within its range; none where they are not known."""
    aside = model.set_aside
    if aside is None or variable not in aside.x:
        return []
    x = shown_values(variable, aside.x[variable])
    low, high = axes.get_xlim()
    seen = (x >= low) & (x <= high)
    return hollow(axes, x[seen], aside.y[seen] * factor) if np.any(seen) else []


def beyond(model: FittedModel) -> str:
    """What a reader outside the domain is to do."""
    return text_of(f"variables_figure.{model.domain.rule.name.lower()}")


def band_in_words(model: FittedModel) -> str:
    """What the band holds and what not."""
    if not np.any(np.isfinite(model.half_width)):
        return "No band, as there is no covariance."
    form = ("what they show that the form leaves out",) if model.remainder is not None else ()
    held = ", ".join(("the scatter of the points", *form, *model.shared))
    text = f"Shaded: 95 % band of the mean from {held}."
    return f"{text} It is too narrow, as the terms were chosen on the same points." if model.post_selection else text


def law_in_words(model: FittedModel, longest: int = 8) -> str:
    """The sum of terms with the names of its coefficients, where it is short; else the form."""
    if len(model.terms) > longest:
        return model.form
    parts = [s if not t.factors else f"{s} {t}" for s, t in zip(model.symbols, model.terms, strict=True)]
    return f"{response_name(model)} = {' + '.join(parts)}"


def scatter_in_words(model: FittedModel) -> str:
    """Residuals and left-out points as numbers, and whether the signs are random."""
    fit = model.fit
    unit = "" if model.unit == "1" else f" {model.unit}"
    text = f"Residuals: {_plain(fit.rms)}{unit} rms; left-out points: {_plain(fit.press_rms)}{unit} rms"
    if np.isnan(fit.runs_probability):
        return f"{text}."
    return f"{text}; runs test {chance(fit.runs_probability)}."


def _plain(value: float) -> str:
    """Three digits, tiny numbers with a power of ten: ``5.37 × 10⁻⁵``, unbroken at the end of a line."""
    text = number(value, 3)
    mantissa, e, exponent = text.partition("e")
    return f"{mantissa}\u00a0×\u00a010{superscript(int(exponent))}" if e else text
