"""Oscillating runs in a report: what amplitude explains, the force over time with its harmonics, coefficients over amplitude."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from coeflab.core.table import plus_minus
from coeflab.core.types import Array
from coeflab.core.wording import finite
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.oscillation import Oscillation, describing
from coeflab.fits.statistics.harmonics import AtZero
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Section, Series
from coeflab.report.figures.palette import COLOURS, power_of_ten
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.tables import oscillations as tables
from coeflab.report.texts import texts_of
from coeflab.study.study import Study

TALL = 252.0
UNDER_LEGEND = TALL - 4.0 - 3 * 12.2 - 8.0


def oscillation_sections(study: Study, fit: FitResult, anchors: Callable[[str], str]) -> tuple[Section, ...]:
    """One section a component and motion of a fit of oscillating runs, after one that says what amplitude explains.

    Parameters
    ----------
    study : Study
        Whose steady fits of the same body are compared.
    fit : FitResult
    anchors : callable
        Gives an anchor for a text.
    """
    if not fit.oscillations:
        return ()
    shown = tuple(t for t in (tables.explained(fit, study.fits), tables.over_frequency(fit)) if t.rows)
    first = Section(
        anchors("amplitude and frequency"), "Amplitude and frequency", texts_of("oscillations.section"), shown
    )
    each = []
    for o, table in zip(fit.oscillations, tables.runs(fit), strict=True):
        place = anchors(o.symbol)
        title = f"{primed(o.symbol)} and {primed(f'{o.symbol}dot')}"
        each.append(Section(place, title, (_in_words(fit, o),), (table,), oscillation_figures(o, place)))
    return (first, *each)


def _in_words(fit: FitResult, o: Oscillation) -> str:
    damping, inertia = fit.coefficients[o.symbol], fit.coefficients[f"{o.symbol}dot"]
    text = f"{primed(damping.symbol)} = {plus_minus(damping.value, damping.u95)}, "
    text += f"{primed(inertia.symbol)} = {plus_minus(inertia.value, inertia.u95)} (U95)."
    forms = [f"{f.name.format(o.variable)} {100.0 * f.weight:.0f} %" for f in o.damping.forms]
    if o.damping.at_zero:
        text += f" Forms over amplitude, by likelihood: {', '.join(forms)}."
    else:
        text += " At one amplitude: what amplitude does is unknown, so there is no U95."
    if o.damping.scatter < tables.SIGNIFICANT:
        text += " The runs scatter about the form by more than their cycles say; U95 is by that scatter."
    if o.interval:
        text += f" Taken to omega' = 0 as a + b omega'^2 over omega' up to {o.interval[1]:.3g}."
    return text


def oscillation_figures(o: Oscillation, anchor: str) -> tuple[Figure, ...]:
    """The force of the largest run over time, then damping and added mass over amplitude.

    Parameters
    ----------
    o : Oscillation
    anchor : str
        Unique in the document.
    """
    damping = _over_amplitude(o, o.damping, [r.damping for r in o.runs], o.symbol, f"{anchor}-damping")
    rate = f"{o.symbol}dot"
    return (
        _over_time(o, f"{anchor}-time"),
        damping,
        _over_amplitude(o, o.inertia, [r.inertia for r in o.runs], rate, f"{anchor}-inertia"),
    )


def _framed(figure: Drawing, y: Array, across: tuple[float, float], names: tuple[str, str]) -> tuple[Axes, float]:
    factor, power = power_of_ten(float(np.nanmax(np.abs(y), initial=0.0)))
    up = limits(y * factor, 0.08) or (-1.0, 1.0)
    axes = panel(
        figure, BOTTOM, UNDER_LEGEND - BOTTOM, across=across, up=up, name_up=f"{names[1]}{power}", name_across=names[0]
    )
    return axes, factor


def _over_time(o: Oscillation, anchor: str) -> Figure:
    run = o.largest
    name = f"{o.component}' of {run.label} over time"
    time = run.theta / (2.0 * np.pi)
    names = ("time  [cycles]", f"{o.component}'  [-]")
    description = f"{o.component}' as recorded over {run.cycles:.3g} cycles, and its mean and harmonics."
    with settings():
        figure = drawing(TALL)
        axes, factor = _framed(figure, run.measured, (float(time[0]), float(time[-1])), names)
        look: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 2.0, "color": COLOURS["muted"]}
        handles = tagged(axes.plot(time, run.measured * factor, zorder=2.4, label="recorded", **look), "recorded")
        line = axes.plot(
            time, run.fitted * factor, color=COLOURS["a"], linewidth=1.3, zorder=2.6, label="mean and harmonics"
        )
        handles += tagged(line, "fitted")
        legend(figure, handles, UNDER_LEGEND)
        found = [
            points("recorded", "recorded", time, run.measured),
            curve("fitted", "mean and harmonics", time, run.fitted),
        ]
        shown = numbers(axes, found, *names, factor)
        svg = svg_text(figure, anchor, name, description)
    caption = "From the largest velocity of the motion on; filter and inertia are still in the record."
    return Figure(anchor, svg, name, caption, description, (shown,))


def _over_amplitude(o: Oscillation, at: AtZero, each: list[tuple[float, float]], symbol: str, anchor: str) -> Figure:
    x, y, half = np.array([r.amplitude for r in o.runs]), *np.array(each).T
    used = np.array([r.used for r in o.runs])
    reach = np.linspace(0.0, 1.05 * float(x.max()), 41)
    shape = {"|{0}|": lambda a: a}
    names = (f"amplitude of {o.variable}'  [-]", f"{primed(symbol)}  [-]")
    title = f"{primed(symbol)} over amplitude"
    description = (
        f"{primed(symbol)} of {len(x)} runs over the amplitude of {o.variable}', and the value at zero amplitude."
    )
    bounded = at.at_zero and np.isfinite(at.half_width)
    with settings():
        figure = drawing(TALL)
        reached = np.concatenate(
            [
                y - np.nan_to_num(half),
                y + np.nan_to_num(half),
                [at.value + s * np.nan_to_num(at.half_width) for s in (-1, 1)],
            ]
        )
        axes, factor = _framed(figure, reached, (-0.04 * float(reach[-1]), float(reach[-1])), names)
        handles: list[Any] = []
        series: list[Series] = []
        for i, f in enumerate(at.forms if at.at_zero and not o.interval else ()):
            style, name = STYLES[i % len(STYLES)], f"{f.name.format(o.variable)}, {100.0 * f.weight:.0f} %"
            slope = 0.0 if np.isnan(f.slope) else f.slope
            law = f.value + slope * np.array(
                [shape.get(f.name, lambda a, n=f.name: describing(n, a))(a) for a in reach]
            )
            line = axes.plot(
                reach, law * factor, color=style.colour, linestyle=style.line, linewidth=1.2, zorder=2.3, label=name
            )
            handles += tagged(line, f"form{i}")
            series.append(curve(f"form{i}", name, reach, law))
        for key, name, selected, colour in (("runs", "runs", used, "ink"), ("aside", "runs not used", ~used, "muted")):
            if not np.any(selected):
                continue
            axes.vlines(
                x[selected],
                (y - half)[selected] * factor,
                (y + half)[selected] * factor,
                color=COLOURS[colour],
                linewidth=0.9,
                zorder=2.5,
            )
            look: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 3.4, "color": COLOURS[colour]}
            handles += tagged(axes.plot(x[selected], y[selected] * factor, zorder=2.6, label=name, **look), key)
            notes = [f"{r.label}, omega' {r.frequency:.3g}" for r, k in zip(o.runs, selected, strict=True) if k]
            series.append(points(key, name, x[selected], y[selected], notes))
        if bounded:
            axes.vlines(
                0.0,
                (at.value - at.half_width) * factor,
                (at.value + at.half_width) * factor,
                color=COLOURS["d"],
                linewidth=2.0,
                zorder=2.8,
            )
            look = {"linestyle": "none", "marker": "D", "markersize": 4.2, "color": COLOURS["d"]}
            handles += tagged(axes.plot([0.0], [at.value * factor], zorder=2.9, label="zero amplitude", **look), "zero")
            words = [plus_minus(at.value, finite(at.half_width))]
            series.append(points("zero", "zero amplitude", np.zeros(1), np.array([at.value]), words))
        legend(figure, handles, UNDER_LEGEND)
        shown = numbers(axes, series, *names, factor)
        svg = svg_text(figure, anchor, title, description)
    return Figure(
        anchor,
        svg,
        title,
        "Strokes are 95 % half-widths: of runs by their cycles, of the value with the forms.",
        description,
        (shown,),
    )
