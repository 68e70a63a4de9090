"""What captions of fitted models say."""

from __future__ import annotations

import numpy as np

from coeflab.model.fitted_model import Extrapolation, FittedModel
from coeflab.model.misfit import chance
from coeflab.model.table import number
from coeflab.presentation.svg import superscript
from coeflab.presentation.variables import response_name

BEYOND = {
    Extrapolation.REFUSE: "a reader is to refuse",
    Extrapolation.CLAMP: "a reader is to take the value at the nearest point of the data",
    Extrapolation.TAPER: "a reader is to blend into the value at the nearest point of the data",
}


def band_in_words(model: FittedModel) -> str:
    """What the band holds and what not."""
    if not np.any(np.isfinite(model.half_width)):
        return "No band, as there is no covariance."
    held = ", ".join(("the scatter of the points", *model.shared))
    text = f"Shaded: 95 % band of the mean from {held}; the error of the form is not in it."
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
