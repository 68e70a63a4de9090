"""Pictures in the user's own style: each draws into an Axes, sets nothing beyond it, and shares its drawing with the report's figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes

from coeflab.bodies.body import Body
from coeflab.core.errors import InputError, shown
from coeflab.core.wording import listed
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.straight_runs import StraightRuns
from coeflab.law.added_mass import AddedMass
from coeflab.law.named_terms import read_term
from coeflab.law.symbols import ANGULAR, CONTROLS, MOTIONS, primed
from coeflab.motion.trajectory import Trajectory
from coeflab.report.figures.estimator import draw_forms, frame_of
from coeflab.report.figures.first_page import draw_intervals
from coeflab.report.figures.law_along import along, draw_along
from coeflab.report.figures.laws import draw_trace
from coeflab.report.figures.motion import draw_history, draw_track
from coeflab.report.figures.nouns import MOVED_BY, traces
from coeflab.report.figures.series import axis_name, is_in_degrees, on_axis, tagged
from coeflab.report.figures.slices import draw_slices, slices_of
from coeflab.report.figures.sweep import draw_curves, draw_points
from coeflab.report.figures.variables import axis_name as name_of_axis
from coeflab.report.figures.variables import moving, response_name, response_unit
from coeflab.tables.force_table import ForceTable

Interval = tuple[float | None, float | None]
FINE, STEP = 121, 0.16
OUTLINE_DIGITS = 9  # of a metre
DIRECTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
ALSO = {"rudder": "dr", "stern planes": "ds", "bow planes": "db", "yaw": "heading", "yaw rate": "r"}


def axes_of(ax: Axes | None) -> Axes:
    """The axes that were given, or those of a new figure.

    Parameters
    ----------
    ax : Axes or None
    """
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    result: Axes = plt.subplots()[1]
    return result


def palette() -> Mapping[str, str]:
    """Colours of the style that is set, by the names of the report's."""
    look = mpl.rcParams
    cycle: list[Any] = [one.get("color", "C0") for one in look["axes.prop_cycle"]] or ["C0"]
    own = {name: cycle[i % len(cycle)] for i, name in enumerate("abcd")}
    return {
        "ink": look["text.color"],
        "muted": look["axes.labelcolor"],
        "rule": look["grid.color"],
        "band": "0.6",
        **own,
    }


def plot_body(body: Body, view: str = "side", ax: Axes | None = None) -> Axes:
    """Its silhouette with the reference point, m, FRD, from the datum; z points down.

    Parameters
    ----------
    body : Body
    view : {"side", "top", "front"}
    ax : Axes, optional

    Raises
    ------
    InputError
        Another view, or a body without a shape.
    """
    from coeflab.report.figures.body import FRONT, SIDE, TOP
    from coeflab.report.figures.body_view import draw_outline
    from coeflab.report.figures.three_views import surfaces_of

    views = {"side": (SIDE, "x [m]", "z [m]"), "top": (TOP, "x [m]", "y [m]"), "front": (FRONT, "y [m]", "z [m]")}
    if view not in views:
        raise InputError(shown(view), f"one of {', '.join(views)}", column="view")
    seen, across, up = views[view]
    frame = seen.axes[:2]
    signs = frame.sum(axis=1)  # of what the axis is called
    axes, colours = axes_of(ax), palette()
    for _, surface in surfaces_of(body):
        draw_outline(axes, surface, frame, palette=colours, digits=OUTLINE_DIGITS, sense=signs)
    point = frame @ np.asarray(body.reference_point) * signs
    axes.plot(*([v] for v in point), "+", color=colours["a"], label="reference point")
    axes.set(xlabel=across, ylabel=up)
    axes.autoscale_view()
    axes.set_aspect("equal")
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
    if signs[0] < 0.0 and not axes.xaxis_inverted():
        axes.invert_xaxis()
    return axes


def plot_forest(
    rows: Sequence[tuple[str, Sequence[Interval]]], names: Sequence[str] = (), ax: Axes | None = None
) -> Axes:
    """Values with U95, each over the size of the first value of its row; a bar that reaches zero leaves the sign open.

    Parameters
    ----------
    rows : sequence of (symbol, intervals)
        Value and U95 of every series; None where there is none.
    names : sequence of str
        Of the series, for the legend.
    ax : Axes, optional
    """
    axes, colours = axes_of(ax), palette()
    y = np.arange(len(rows))[::-1].astype(float)
    count = max((len(found) for _, found in rows), default=0)
    sizes = [abs(found[0][0] or 0.0) or max((abs(v or 0.0) for v, _ in found), default=0.0) or 1.0 for _, found in rows]
    handles = []
    for k in range(count):
        at = [i for i, (_, found) in enumerate(rows) if k < len(found) and found[k][0] is not None]
        value, half = (np.array([(rows[i][1][k][part] or 0.0) / sizes[i] for i in at]) for part in (0, 1))
        offset = (0.5 * (count - 1) - k) * STEP
        handles.append(draw_intervals(axes, value, half, y[at] + offset, f"s{k}", colours["abcd"[k % 4]]))
    axes.axvline(0.0, color=colours["muted"], linewidth=0.8)
    axes.set_yticks(y, [symbol for symbol, _ in rows])
    axes.set_xlabel("value over its size, with U95")
    if names and rows:
        axes.legend(handles=handles, labels=list(names))
    return axes


def plot_added_mass(found: AddedMass, ax: Axes | None = None) -> Axes:
    """Entries beside the root of the product of their diagonal ones, so that 1 is the most; their numbers in kg, kg m, kg m^2.

    Parameters
    ----------
    found : AddedMass
    ax : Axes, optional
    """
    axes = axes_of(ax)
    size = np.sqrt(np.abs(np.diag(found.matrix)))
    scale = np.outer(size, size)
    share = np.divide(np.abs(found.matrix), scale, out=np.zeros((6, 6)), where=scale > 0.0)
    axes.imshow(share, vmin=0.0, vmax=1.0, cmap="Greys")
    for (i, j), value in np.ndenumerate(found.matrix):
        if share[i, j] > 1e-3:
            axes.text(j, i, f"{value:.3g}", ha="center", va="center", color="w" if share[i, j] > 0.5 else "k")
    axes.set_xticks(range(6), DIRECTIONS)
    axes.set_yticks(range(6), DIRECTIONS)
    axes.set_title(f"{found.body} by {found.method}")
    return axes


def plot_model(models: Sequence[FittedModel], symbol: str, ax: Axes | None = None) -> Axes:
    """The law that a coefficient belongs to, along the variable that it goes with and the others at rest; of a cross term slices.

    Parameters
    ----------
    models : sequence of FittedModel
    symbol : str
    ax : Axes, optional

    Raises
    ------
    InputError
        No law has it, no three rows have all other variables at rest, or a cross term is of no grid of rows.
    """
    name = symbol.removesuffix("'")
    model = next((m for m in models if name in [s.removesuffix("'") for s in m.symbols]), None)
    if model is None:
        known = ", ".join(primed(s) for m in models for s in m.symbols)
        raise InputError(f"no law with {shown(symbol)}", f"one of {known}", column="symbol")
    term = next(t for t, s in zip(model.terms, model.symbols, strict=True) if s.removesuffix("'") == name)
    variables = [v for v in moving(model) if v in {f for f, _, _ in term.factors}]
    if len(variables) < 2:
        return plot_along(model, next(iter(variables), ""), ax)
    if len(variables) > 2 or not slices_of(model, variables):
        raise InputError(
            f"{shown(symbol)}, a term of {listed(variables)} together, of rows that are no grid of two",
            "a term of one motion, such as a slope",
            column="symbol",
            advice=f'Without a symbol, plot() draws its interval; laws["{model.response}"].evaluate({", ".join(f"{v}=..." for v in variables)}) has the law.',
        )
    axes = axes_of(ax)
    handles, _ = draw_slices(axes, model, variables, palette=palette())
    axes.legend(handles=handles)
    return _named(axes, model, variables[0])


def plot_along(model: FittedModel, variable: str = "", ax: Axes | None = None) -> Axes:
    """A law along one of its variables, the others at rest.

    Parameters
    ----------
    model : FittedModel
    variable : str
        By default the first along which three rows lie.
    ax : Axes, optional

    Raises
    ------
    InputError
        No three rows have all other variables at rest, or not those of this variable.
    """
    names = along(model)
    if not names or (variable and variable not in names):
        raise InputError(
            f"{shown(variable or model.response)}, whose rows vary several motions at once",
            f"a variable along which three rows or more lie{''.join(f', {n}' for n in names)}",
            column="variable",
        )
    variable = variable or names[0]
    axes = axes_of(ax)
    draw_along(axes, model, variable, palette=palette())
    return _named(axes, model, variable)


def _named(axes: Axes, model: FittedModel, variable: str) -> Axes:
    axes.set_xlabel(name_of_axis(variable, model).replace("  ", " "))
    axes.set_ylabel(f"{response_name(model)} [{response_unit(model)}]")
    return axes


def plot_motion(motion: Trajectory, what: str = "track", ax: Axes | None = None) -> Axes:
    """North over east, or a quantity over time; angles in degrees.

    Parameters
    ----------
    motion : Trajectory
    what : str
    ax : Axes, optional

    Raises
    ------
    InputError
        A quantity that the motion has not.
    """
    known = {
        "depth": (motion.position[:, 2], "m"), "north": (motion.position[:, 0], "m"), "east": (motion.position[:, 1], "m"),
        "heading": (np.degrees(motion.heading), "deg"), "speed": (motion.speed, "m/s"),
        "roll": (np.degrees(motion.angles[:, 0]), "deg"), "pitch": (np.degrees(motion.angles[:, 1]), "deg"),
        **{m: (motion.velocity[:, i], "rad/s" if m in ANGULAR else "m/s") for i, m in enumerate(MOTIONS)},
        **{k: (np.degrees(v), "deg") if k in CONTROLS else (np.asarray(v), "") for k, v in motion.controls.items()},
    }  # fmt: skip
    what = ALSO.get(what, what)
    if what != "track" and what not in known:
        raise InputError(shown(what), f"track, or one of {', '.join(known)}", column="what")
    axes = axes_of(ax)
    if what == "track":
        draw_track(axes, motion, palette=palette())
        axes.set(xlabel="east [m]", ylabel="north [m]")
        axes.set_aspect("equal", adjustable="datalim")
        return axes
    values, unit = known[what]
    draw_history(axes, motion.time, {what: values}, palette())
    axes.set(xlabel="time [s]", ylabel=f"{what} [{unit}]" if unit else what)
    return axes


def plot_straight_runs(runs: StraightRuns, ax: Axes | None = None) -> Axes:
    """X' of every run, X0' and its U95 over the speeds that were run.

    Parameters
    ----------
    runs : StraightRuns
    ax : Axes, optional
    """
    axes = axes_of(ax)
    (points,) = axes.plot(runs.speed, runs.primes, "o", label="runs")
    colour, ends = points.get_color(), np.array([runs.speed.min(), runs.speed.max()])
    axes.plot(ends, [runs.value] * 2, color=colour, label="X0'")
    low, high = runs.value - runs.u95, runs.value + runs.u95
    axes.fill_between(ends, low, high, color=colour, alpha=0.2, linewidth=0.0, label="U95")
    axes.set(xlabel="U [m/s]", ylabel="X'", title=f"X0', {runs.campaign}")
    axes.legend()
    return axes


def plot_slope(sweep: Sweep, ax: Axes | None = None) -> Axes:
    """Points, the recommended curve and the slope at rest with U95.

    Parameters
    ----------
    sweep : Sweep
    ax : Axes, optional
    """
    axes, colours = axes_of(ax), palette()
    handles = draw_points(axes, sweep, palette=colours) + draw_curves(axes, sweep, palette=colours)
    return _swept(axes, sweep, sweep.symbol, handles)


def _swept(axes: Axes, sweep: Sweep, symbol: str, handles: list[Any]) -> Axes:
    """With the names of a sweep."""
    axes.set(xlabel=axis_name(sweep).replace("  ", " "), ylabel=f"{sweep.component}'")
    axes.set_title(f"{primed(symbol)}, {sweep.campaign}")
    axes.legend(handles=handles)
    return axes


def plot_tied(
    sweep: Sweep, symbol: str, law: Mapping[str, float], window: tuple[float, float], at_rest: float,
    ax: Axes | None = None,
) -> Axes:  # fmt: skip
    """The points of a sweep and the force law over the range that it was fitted to.

    Parameters
    ----------
    sweep : Sweep
    symbol : str
        Of the term, for the title.
    law : mapping of str to float
        Primed coefficients of one variable by symbol, the slope among them.
    window : (float, float)
        Of the variable, primed.
    at_rest : float
        Primed force of the set-up, which no coefficient holds.
    ax : Axes, optional
    """
    axes, colours = axes_of(ax), palette()
    x = np.linspace(*window, FINE)
    y = at_rest + sum(value * read_term(s, symbol).term.evaluate({sweep.variable: x}) for s, value in law.items())
    handles = draw_points(axes, sweep, palette=colours)
    look: dict[str, Any] = {"color": colours["b"], "linewidth": 1.4, "label": " + ".join(map(primed, law))}
    drawn = axes.plot(on_axis(sweep, x), y, zorder=2.5, **look)
    return _swept(axes, sweep, symbol, [*handles, *tagged(drawn, "law")])


def plot_forms(sweep: Sweep, ax: Axes | None = None) -> Axes:
    """Every family over growing ranges about the recommended value.

    Parameters
    ----------
    sweep : Sweep
    ax : Axes, optional
    """
    axes = axes_of(ax)
    axes.set_ylim(*frame_of(sweep))
    draw_forms(axes, sweep, palette=palette())
    axes.set_xlabel("largest angle used [deg]" if is_in_degrees(sweep) else f"largest |{sweep.variable}'| used")
    axes.set_ylabel(primed(sweep.symbol))
    return axes


def plot_table(table: ForceTable, component: str = "", over: str = "", ax: Axes | None = None) -> Axes:
    """A component over a motion, SI; controls in degrees; what no fit uses is hollow.

    Parameters
    ----------
    table : ForceTable
    component, over : str
        Empty: what is measured and varies first.
    ax : Axes, optional

    Raises
    ------
    InputError
        What the table has not.
    """
    known = {**table.motion, **table.controls}
    over = over or next(iter(table.varies), "u")
    if over not in known:
        raise InputError(shown(over), f"one of {', '.join(known)}", column="over")
    component = component or next((c for c in MOVED_BY.get(over, "") if c in table.forces), next(iter(table.forces)))
    if component not in table.forces:
        raise InputError(shown(component), f"one of {', '.join(table.forces)}", column="component")
    axes = axes_of(ax)
    x = np.degrees(known[over]) if over in CONTROLS else np.asarray(known[over])
    y, used = np.asarray(table.forces[component]), np.asarray(table.usable[component])
    for trace in traces(x, y, used):
        drawn = draw_trace(axes, trace, trace.form, palette())
        drawn[0].set_label(f"{table.name}, {component}" if trace.form == "filled" else trace.name)
    axes.set_xlabel(f"{over} [{'deg' if over in CONTROLS else 'rad/s' if over in ANGULAR else 'm/s'}]")
    axes.set_ylabel(f"{component} [{'N' if component in 'XYZ' else 'N m'}]")
    axes.legend()
    return axes
