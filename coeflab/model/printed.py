"""Coefficients that somebody printed, read from words and held against a fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.model.fit_result import FitResult


def read_printed(items: Sequence[str], place: str) -> dict[str, float]:
    """``K_L=9.5`` as numbers.

    Raises
    ------
    InputError
        No finite number behind an equals sign.
    """
    out = {}
    for item in items:
        symbol, _, text = item.partition("=")
        try:
            out[symbol] = float(text)
        except ValueError:
            raise InputError(shown(item), "SYMBOL=NUMBER such as K_L=9.5281", column=place) from None
        if not np.isfinite(out[symbol]):
            raise InputError(shown(item), "a finite number", column=place)
    return out


def at_no_angle(symbol: str, printed: float, result: FitResult) -> str:
    """A printed coefficient that no unit of the angle touches, against the fitted 95 % interval."""
    model = next((m for m in result.models if symbol in m.symbols), None)
    if model is None:
        return f"{symbol}: not fitted, so the printed {printed:g} is not compared."
    value, half = model.named(symbol)
    if not np.isfinite(half):
        return f"{symbol}: printed {printed:g}, fitted {value:.5g} without an interval."
    place = "inside" if abs(printed - value) <= half else "outside"
    return (
        f"{symbol}: printed {printed:g} is {place} the fitted {value:.5g} +- {half:.2g}; it has no unit of the angle."
    )
