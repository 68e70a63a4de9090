"""Axes with ticks in metres under and left of a view along a body axis."""

from __future__ import annotations

from typing import Any

import numpy as np

from coeflab.core.types import Array
from coeflab.report.figures.body_view import Sheet
from coeflab.report.figures.palette import COLOURS

LEFT, BELOW = 34.0, 24.0
ACROSS, UP = 44.0, 20.0
TICK, SMALL = 3.0, 7.0
STEPS = (1.0, 2.0, 5.0, 10.0)


def ticks(low: float, high: float, least: float) -> list[float]:
    """Round values from low to high that are at least ``least`` apart: steps of 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(least))
    step = float(next(k * power for k in STEPS if k * power >= least * (1.0 - 1e-9)))
    first, last = int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9))
    return [float(f"{k * step:.12g}") for k in range(first, last + 1)]


def rulers(sheet: Sheet, points: Array) -> None:
    """Draw both axes of a view whose right and up lie along body axes.

    Parameters
    ----------
    sheet : Sheet
    points : (n, 3) array
        What the view shows, m, FRD.
    """
    flat = sheet.on_paper(points)
    (left, bottom), (right, top) = flat.min(axis=0), flat.max(axis=0)
    for k, least in ((0, ACROSS), (1, UP)):
        axis = int(np.argmax(np.abs(sheet.view.axes[k])))
        sign = float(np.sign(sheet.view.axes[k, axis]))
        values = points[:, axis]
        at = [
            (v, sheet.scale * sign * v + float(sheet.move[k]))
            for v in ticks(float(values.min()), float(values.max()), least / sheet.scale)
        ]
        _rule(sheet, k, (left, right) if k == 0 else (bottom, top), bottom if k == 0 else left, at)
        name = f"{'xyz'[axis]} [m]"
        if k == 0:
            _text(sheet, right, bottom - 22.0, name, "right")
        else:
            _text(sheet, left - LEFT, top + 7.0, name, "left")


def _rule(sheet: Sheet, k: int, ends: tuple[float, float], edge: float, at: list[tuple[float, float]]) -> None:
    """One axis: 0 under the view, 1 left of it."""
    line = edge - 4.0
    style: dict[str, Any] = {"color": COLOURS["muted"], "linewidth": 0.6, "zorder": 1}
    sheet.axes.plot(*((ends, [line, line]) if k == 0 else ([line, line], ends)), **style)
    for value, place in at:
        ends_of_tick = [line, line - TICK]
        sheet.axes.plot(*(([place, place], ends_of_tick) if k == 0 else (ends_of_tick, [place, place])), **style)
        if k == 0:
            _text(sheet, place, line - TICK - 7.0, f"{value:g}", "center")
        else:
            _text(sheet, line - TICK - 2.0, place - 2.5, f"{value:g}", "right")


def _text(sheet: Sheet, x: float, y: float, text: str, place: str) -> None:
    sheet.axes.text(x, y, text, ha=place, fontsize=SMALL, color=COLOURS["muted"])
