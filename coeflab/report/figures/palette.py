"""Colours of drawings by their names, and how large numbers are written beside an axis; nothing of Matplotlib."""

from __future__ import annotations

from collections.abc import Mapping

# Every colour of a drawing is one of these. The values are what a renderer without style sheets shows: dark on white,
# the series from the palette of Okabe & Ito, darkened so that thin lines keep a contrast of 3 to 1.
COLOURS = {
    "ink": "#1c2126",
    "muted": "#5d666f",
    "rule": "#c9cfd5",
    "band": "#9aa5b1",
    "a": "#0067a8",
    "b": "#c04f00",
    "c": "#007a58",
    "d": "#a3437f",
}
NAMED = {colour: name for name, colour in COLOURS.items()}


def recoloured(colour: str, palette: Mapping[str, str]) -> str:
    """A colour of `COLOURS` as another palette has it; any other as it is."""
    return palette[NAMED[colour]] if colour in NAMED else colour


_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(largest: float) -> tuple[float, str]:
    """Factor that brings numbers of that size to 1 ... 1000, and its text for an axis label (``x 10^3``)."""
    if not 0.0 < largest < float("inf"):
        return 1.0, ""
    exponent = 0
    while largest * 10.0**exponent < 1.0 and exponent < 30:
        exponent += 3
    while largest * 10.0**exponent >= 10_000.0:
        exponent -= 3
    return 10.0**exponent, f" × 10{superscript(exponent)}" if exponent else ""


def superscript(exponent: int) -> str:
    """A whole number as an exponent."""
    return str(exponent).translate(_SUPERSCRIPT)
