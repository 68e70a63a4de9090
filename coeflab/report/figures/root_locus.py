"""Eigenvalues of small motions against speed: real parts above, imaginary parts below where there are any."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from coeflab.core.types import Array
from coeflab.motion.root_locus import RootLocus
from coeflab.report.document import Figure, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, GAP, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, tagged
from coeflab.report.figures.svg import settings, svg_text

IN_PLANE = {"G_h": "the horizontal plane", "G_v": "the vertical plane"}
UPPER, LOWER, LEGEND = 150.0, 80.0, 34.0
ACROSS = "speed  [m/s]"


def root_locus_figure(locus: RootLocus, name: str, anchor: str) -> Figure:
    """Roots of one plane over speed.

    Parameters
    ----------
    locus : RootLocus
    name : str
        Of the parameter file.
    anchor : str
    """
    waves = bool(np.any(locus.roots.imag != 0.0))
    bottom = BOTTOM + (LOWER + GAP if waves else 0.0)
    title = f"{name}: roots of straight motion in {IN_PLANE[locus.index]}"
    across = (0.0, float(locus.speed[-1]))
    description = f"{_summary('Real', locus.roots.real)}{_summary('Imaginary', locus.roots.imag) if waves else ''}"
    with settings():
        figure = drawing(bottom + UPPER + 8.0 + LEGEND)
        real = np.append(locus.roots.real, 0.0)
        main = panel(
            figure, bottom, UPPER, across=across, up=limits(real, 0.08) or (-1.0, 1.0), name_up="real part  [1/s]",
            name_across="" if waves else ACROSS,
        )  # fmt: skip
        handles = _lines(main, locus, locus.roots.real)
        panels = [numbers(main, _series(locus, locus.roots.real), ACROSS, "real part  [1/s]")]
        if waves:
            up = limits(locus.roots.imag, 0.1) or (-1.0, 1.0)
            lower = panel(
                figure, BOTTOM, LOWER, across=across, up=up, name_up="imag.  [1/s]", name_across=ACROSS, most_up=3
            )
            _lines(lower, locus, locus.roots.imag)
            panels.append(numbers(lower, _series(locus, locus.roots.imag), ACROSS, "imaginary part  [1/s]"))
        legend(figure, handles, bottom + UPPER)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, "" if locus.index == "G_h" else locus.statement, description, tuple(panels))


def _lines(axes: Axes, locus: RootLocus, values: Array) -> list[Any]:
    axes.axhline(0.0, color=COLOURS["ink"], linewidth=0.8, zorder=1)
    if locus.critical is not None:
        axes.axvline(locus.critical, color=COLOURS["ink"], linewidth=0.9, linestyle=(0, (1.0, 2.0)), zorder=1)
    handles: list[Any] = []
    for i, style in zip(range(values.shape[1]), STYLES, strict=False):
        look: dict[str, Any] = {"color": style.colour, "linestyle": style.line, "linewidth": 1.4}
        handles += tagged(axes.plot(locus.speed, values[:, i], label=f"root {i + 1}", zorder=2.5, **look), f"root{i}")
    return handles


def _series(locus: RootLocus, values: Array) -> list[Series]:
    return [curve(f"root{i}", f"root {i + 1}", locus.speed, values[:, i]) for i in range(values.shape[1])]


def _summary(part: str, values: Array) -> str:
    ends = ", ".join(f"{low:.3g} to {high:.3g}" for low, high in zip(values[0], values[-1], strict=True))
    return f"{part} parts from the slowest to the fastest speed, 1/s: {ends}. "
