"""Figures of glides: speed, distance, depth and angle of attack in time, and the speed polar."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from coeflab.core.types import Array
from coeflab.glider.glide import GlideRun, SteadyGlide
from coeflab.glider.glider import Glider
from coeflab.glider.steady_glide import glide
from coeflab.report.document import Figure
from coeflab.report.figures import series as plotted
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, LEGEND_ROW, Range, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, Style, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote

FIELD, TALL, ROOM = 104.0, 164.0, 13.0
STEEPEST = np.radians(70.0)
FINE = 241
BALANCED = "in balance of pitch"
SOLID = Style(COLOURS["a"], "-", "o")


@as_users_wrote
def motion_figure(runs: Sequence[GlideRun], anchor: str) -> Figure:
    """V, x, depth and alpha of up to four gliders over time, one panel each, with the steady glides of the first phases.

    The panel of alpha shows the range that 96 % of the time keeps to: at starts and turns, when a glider hardly moves,
    the angle is large and says little.
    """
    shown = list(zip(runs, STYLES if len(runs) > 1 else (SOLID,), strict=False))
    columns: list[tuple[str, list[Array]]] = [
        ("V  [m/s]", [r.speed for r, _ in shown]),
        ("x  [m]", [r.x for r, _ in shown]),
        ("depth  [m]", [r.depth for r, _ in shown]),
        ("alpha  [deg]", [np.degrees(r.alpha) for r, _ in shown]),
    ]
    times = np.concatenate([r.time for r, _ in shown])
    above = BOTTOM + len(columns) * (FIELD + ROOM) - ROOM
    title = f"{_names(runs)}: speed, distance, depth and angle of attack in time"
    description = "Four panels over time: " + ", ".join(name.replace("  ", " ") for name, _ in columns) + "."
    panels = []
    with settings():
        figure = drawing(above + 10.0 + LEGEND_ROW * ((len(shown) + 1) // 2))
        for i, (name, values) in enumerate(columns):
            bottom = BOTTOM + (len(columns) - 1 - i) * (FIELD + ROOM)
            axes = panel(
                figure, bottom, FIELD, across=limits(times, 0.02) or (0.0, 1.0), up=_up(name, values), name_up=name,
                name_across="time  [s]" if i == len(columns) - 1 else "", most_up=4,
            )  # fmt: skip
            words = []
            for k, ((run, style), y) in enumerate(zip(shown, values, strict=True)):
                look: dict[str, Any] = {"color": style.colour, "linestyle": style.line, "linewidth": 1.3, "zorder": 2.5}
                tagged(axes.plot(run.time, y, **look), f"glider{k}")
                words.append(plotted.curve(f"glider{k}", run.glider.name, run.time, y))
            panels.append(numbers(axes, words, "time  [s]", name))
        handles = [tagged(_line(s, r.glider.name), f"glider{k}") for k, (r, s) in enumerate(shown)]
        legend(figure, handles, above)
        svg = svg_text(figure, anchor, title, description)
    caption = "Depth grows downward. Angles of attack at starts and turns, at next to no speed, leave the frame."
    return Figure(anchor, svg, title, caption, description, tuple(panels))


@as_users_wrote
def polar_figure(glider: Glider, steady: Sequence[SteadyGlide], anchor: str) -> Figure:
    """Speed over the glide angle for the net masses of the phases, the angle of attack, and the steady glides on them."""
    masses = list(dict.fromkeys(p.net_mass for p in glider.phases if p.net_mass))[: len(STYLES)]
    curves = {mass: curve(glider, mass) for mass in masses}
    dots = [s for s in steady if s.net_mass in masses]
    across = limits(np.degrees(np.concatenate([zeta for _, zeta, _ in curves.values()])), 0.04) or (-90.0, 90.0)
    above = BOTTOM + 2 * TALL + ROOM
    title = f"{glider.title}: speed and angle of attack over the glide angle"
    description = (
        f"Two panels over the glide angle for {len(masses)} net masses, with {len(dots)} steady glides marked."
    )
    with settings():
        figure = drawing(above + 10.0 + LEGEND_ROW * ((len(masses) + 2) // 2))
        speeds = limits(np.concatenate([v for _, _, v in curves.values()]), 0.06) or (0.0, 1.0)
        upper = panel(figure, BOTTOM + TALL + ROOM, TALL, across=across, up=speeds, name_up="V  [m/s]")
        words = []
        for k, ((_, zeta, speed), style) in enumerate(zip(curves.values(), STYLES, strict=False)):
            look: dict[str, Any] = {"color": style.colour, "linestyle": style.line, "linewidth": 1.3, "zorder": 2.5}
            tagged(upper.plot(np.degrees(zeta), speed, **look), f"mass{k}")
            words.append(plotted.curve(f"mass{k}", f"net mass {masses[k]:.4g} kg", np.degrees(zeta), speed))
        at, notes = np.degrees([s.zeta for s in dots]), [f"net mass {s.net_mass:.4g} kg" for s in dots]
        fast, steep = np.array([s.speed for s in dots]), np.degrees([s.alpha for s in dots])
        tagged(upper.plot(at, fast, **_DOT), "dots")
        words.append(points("dots", BALANCED, at, fast, notes))
        angles = limits(np.degrees(np.concatenate([a for a, _, _ in curves.values()])), 0.06) or (-30.0, 30.0)
        lower = panel(
            figure, BOTTOM, TALL, across=across, up=angles, name_up="alpha  [deg]",
            name_across="glide angle zeta  [deg]",
        )  # fmt: skip
        angled = []
        for mass in {m > 0.0: m for m in masses}.values():
            alpha, zeta, _ = curves[mass]
            lower.plot(np.degrees(zeta), np.degrees(alpha), color=COLOURS["ink"], linewidth=1.1, zorder=2.5)
            angled.append(plotted.curve("angle", "every net mass", np.degrees(zeta), np.degrees(alpha)))
        tagged(lower.plot(at, steep, **_DOT), "dots")
        angled.append(points("dots", BALANCED, at, steep, notes))
        handles = [_line(s, f"net mass {m:.4g} kg") for m, s in zip(masses, STYLES, strict=False)]
        handles = [tagged(h, f"mass{k}") for k, h in enumerate(handles)]
        legend(figure, [*handles, tagged(Line2D([], [], label=BALANCED, **_DOT), "dots")], above)
        panels = (
            numbers(upper, words, "glide angle zeta  [deg]", "V  [m/s]"),
            numbers(lower, angled, "glide angle zeta  [deg]", "alpha  [deg]"),
        )
        svg = svg_text(figure, anchor, title, description)
    caption = (
        "Every point of a curve balances the forces; at the dots the pitch moment balances too. Dives are below zero. The "
        "angle of attack belongs to the glide angle, whatever the net mass."
    )
    return Figure(anchor, svg, title, caption, description, panels)


_DOT: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 4.4,
    "markerfacecolor": "none",
    "markeredgecolor": COLOURS["ink"],
    "zorder": 4,
}


def curve(glider: Glider, net_mass: float) -> tuple[Array, Array, Array]:
    """Angle of attack, glide angle, rad, and speed, m/s, of the glides ahead that are no steeper than 70 degrees."""
    alpha = np.linspace(*glider.polar.searched, FINE)
    speed, zeta = glide(glider.body.polar, net_mass * glider.gravity, alpha)
    selected = np.abs(zeta) <= STEEPEST
    return alpha[selected], zeta[selected], speed[selected]


def _up(name: str, values: Sequence[Array]) -> Range:
    every = np.concatenate(values)
    finite = every[np.isfinite(every)]
    if name.startswith("alpha") and len(finite):
        low, high = np.percentile(finite, [2.0, 98.0])
        finite = finite[(finite >= low) & (finite <= high)]
    low_high = limits(finite, 0.08) or (0.0, 1.0)
    return (low_high[1], low_high[0]) if name.startswith("depth") else low_high


def _line(style: Any, text: str) -> Line2D:
    return Line2D([], [], color=style.colour, linestyle=style.line, linewidth=1.3, label=text)


def _names(runs: Sequence[GlideRun]) -> str:
    return ", ".join(r.glider.name for r in runs)
