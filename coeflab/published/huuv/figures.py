"""HUUV: our pictures of its figures, as far as caption and text say what they show. No point is drawn that the paper does not print."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from coeflab.bodies.shape import Parts
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.identify.tuning import Tuning
from coeflab.identify.tuning_figures import Groups, agreement_figure, curves_figure
from coeflab.motion.steady_turns import steady_turns, turn_figures
from coeflab.published.huuv.five_dof import FiveDof, assumed_body, elevator_laws, hull_laws, turning_laws
from coeflab.published.huuv.five_dof_rows import SETS, Dive, with_masses
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, commands, thrust
from coeflab.published.huuv.tuning import IN_WORDS
from coeflab.published.publication import publication
from coeflab.report.document import Figure
from coeflab.report.figures.body import body_figure
from coeflab.report.figures.laws import Plot, Trace

PAPER = publication("huuv")


FINE = 57
LAWS = (
    ("drag / V^2  [N/(m/s)^2]", ("d0", "d2"), (0, 2)),
    ("side force / V^2  [N/(m/s)^2]", ("s1", "s3"), (1, 3)),
    ("yaw moment / V^2  [N m/(m/s)^2]", ("n1", "n3"), (1, 3)),
)


def forces_figure(huuv: Huuv, halves: Mapping[str, Tuning]) -> Figure:
    """Three laws over sideslip, three sets of constants.

    Parameters
    ----------
    huuv : Huuv
    halves : mapping of str to Tuning
        The fits to the paper's simulation and to the pool.
    """
    ends = {source: float(np.degrees(np.nanmax(turns.figures[:, 1]))) for source, turns in huuv.turns.items()}
    sets = {
        "steady turns": (dict(huuv.constants), ends[MATLAB]),
        "tuned to the simulation": (_values(huuv, halves[MATLAB]), ends[MATLAB]),
        "tuned to the pool": (_values(huuv, halves[TRACKER]), ends[TRACKER]),
    }
    plots = [
        Plot(
            name, "sideslip beta  [deg]",
            tuple(
                Trace(label, beta, _law(c, keys, powers, beta), i)
                for i, (label, (c, end)) in enumerate(sets.items())
                for beta in [np.linspace(-end, end, FINE)]
            ),
            112.0, is_scaled=k == len(LAWS) - 1,
        )
        for k, (name, keys, powers) in enumerate(LAWS)
    ]  # fmt: skip
    return PAPER.figure("huuv-forces", plots, matlab=ends[MATLAB], tracker=ends[TRACKER], open=_open(halves))


def _open(halves: Mapping[str, Tuning]) -> str:
    """What has no interval, of both fits."""
    of_source = {MATLAB: "simulation", TRACKER: "pool"}
    drawn = {key for _, keys, _ in LAWS for key in keys}
    return "; ".join(
        f"{of_source[source]}: {listed([IN_WORDS[p.name] for p in fit.parameters if p.name in drawn and p.u95 is None])}"
        for source, fit in halves.items()
        if any(p.name in drawn and p.u95 is None for p in fit.parameters)
    )


def _values(huuv: Huuv, fit: Tuning) -> dict[str, float]:
    return dict(huuv.constants) | {p.name: p.after for p in fit.parameters}


def _law(constants: Mapping[str, float], keys: tuple[str, str], powers: tuple[int, int], beta: Array) -> Array:
    x = np.radians(beta)
    return np.asarray(sum(constants[k] * x**n for k, n in zip(keys, powers, strict=True)))


def tuning_figures(huuv: Huuv, halves: dict[str, Tuning]) -> Iterator[tuple[str, Figure]]:
    """Turns and agreement of both fits, and the three laws over sideslip (Figs. 17 and 14)."""
    for source, fit in halves.items():
        turns = huuv.turns[source]
        commands = sorted(set(turns.left.tolist()))
        member = np.searchsorted(commands, turns.left)
        groups = Groups(turns.right, "right thruster  [%]", member, tuple(f"left {c:g} %" for c in commands))
        yield f"huuv_{source}_turns", curves_figure(fit, groups, f"huuv-{source}-turns")
        yield f"huuv_{source}_agreement", agreement_figure(fit, f"huuv-{source}-agreement")
    yield "huuv_forces", forces_figure(huuv, halves)


TALL = 76.0  # points of a panel
SEEN = 60.0  # s of the dives


def paper_figures(five: FiveDof, dives: Mapping[float, Dive]) -> Iterator[tuple[str, Figure]]:
    """Figs. 7, 12, 13, 15, 16, and 18 beside 17; then what the paper has no figure of, turns with other masses."""
    shape = assumed_body().require_shape()
    if isinstance(shape, Parts):
        yield "huuv_fig07", body_figure("HUUV, Fig. 7, radii and fins assumed", shape, None, "huuv-fig07")
    yield "huuv_fig12_13_16", laws_over_attack_and_rates(five)
    yield "huuv_fig15", elevator_figure(five, dives)
    yield "huuv_fig17_18", speeds_figure(five)
    yield "huuv_masses", masses_figure(five)


def laws_over_attack_and_rates(five: FiveDof) -> Figure:
    """Drag over attack at three drifts, lift, pitching moment, and moments against the rates (Figs. 12, 13 and 16)."""
    end, fastest = float(np.degrees(five.level.chosen["largest_drift"])), five.level.chosen["largest_rate"]
    x, rate = np.linspace(-end, end, FINE), np.linspace(-fastest, fastest, FINE)
    attack = np.radians(x)
    drags = [(drift, hull_laws(five, attack, np.full(FINE, np.radians(drift)))["C_D"]) for drift in (0.0, 12.5, 25.0)]
    laws = hull_laws(five, attack, np.zeros(FINE))
    pitching, yawing = turning_laws(five, rate, rate)
    across = "attack alpha  [deg]"
    plots = [
        Plot("drag / V^2  [N/(m/s)^2]", across, tuple(Trace(f"beta {d:g} deg", x, y, i) for i, (d, y) in enumerate(drags)), TALL, is_scaled=False),
        Plot("lift / V^2  [N/(m/s)^2]", across, (Trace("beta 0 deg", x, laws["C_L"], 0),), TALL, is_scaled=False),
        Plot("M / V^2  [N m/(m/s)^2]", across, (Trace("beta 0 deg", x, -laws["C_m alpha"], 0),), TALL),
        Plot("moment  [N m]", "rate of rotation  [rad/s]", (Trace("M_mq, pitch", rate, pitching, 3), Trace("M_mr, yaw", rate, yawing, -1)), TALL),
    ]  # fmt: skip

    return PAPER.figure("huuv-fig12-13-16", plots)


def elevator_figure(five: FiveDof, dives: Mapping[float, Dive]) -> Figure:
    """The elevators' coefficients over their angle (Figs. 6 and 15), and what a deflection does in time."""
    end = float(np.degrees(five.constants["largest_angle"]))
    x = np.linspace(-end, end, FINE)
    laws = zip(("drag C_D", "lift C_L", "moment C_M"), elevator_laws(five, np.radians(x)), strict=True)
    curves = tuple(Trace(n, x, y, i) for i, (n, y) in enumerate(laws))
    plots = [Plot("coefficients  [1]", "elevator delta at alpha = 0  [deg]", curves, TALL)]
    motions = (("depth  [m]", "depth", 1.0), ("pitch  [deg]", "pitch", 180.0 / np.pi))
    for k, (name, key, factor) in enumerate(motions):
        traces = (
            Trace(f"delta {angle:+g} deg", d.time[seen], factor * getattr(d, key)[seen], i)
            for i, (angle, d) in enumerate(dives.items())
            for seen in [d.time <= SEEN]
        )
        plots.append(Plot(name, "time  [s]", tuple(traces), TALL, is_scaled=k == 1))

    c = five.constants
    return PAPER.figure("huuv-fig15", plots, speed=five.level.chosen["speed"], area=c["area"], length=c["length"])


def straight_speeds(huuv: Huuv, total: Array, drag_left_out: float = 0.0) -> Array:
    """(n,) m/s of the straight runs of Fig. 18, ``total`` per cent for both thrusters; ``drag_left_out`` N/(m/s)^2."""
    c = huuv.constants
    left, right = commands(total, np.zeros(len(total)))
    push = thrust(left, right, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)[:, 0]
    return np.asarray(np.sqrt(push / (c["d0"] - drag_left_out)))


def mast_drag(density: float) -> float:
    """Drag over V^2 of the assumed mast as a round cylinder with a drag coefficient of one, N/(m/s)^2."""
    shape = assumed_body().require_shape()
    mast = next(p.form for p in shape.parts if p.name == "mast") if isinstance(shape, Parts) else None
    return density * getattr(mast, "radius", 0.0) * getattr(mast, "length", 0.0)


def speeds_figure(five: FiveDof) -> Figure:
    """Forward speed in turns, with both printed halves, and on a straight course (Figs. 17 a, b and 18)."""
    huuv, c = five.level, five.level.constants
    fine = np.linspace(20.0, 100.0, FINE)
    traces = []
    for i, left in enumerate(sorted(set(huuv.turns[MATLAB].left.tolist()))):
        right = fine[fine > left]
        push = thrust(np.full(len(right), left), right, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)
        ours = turn_figures(steady_turns(huuv.theta, push).velocity)[0]
        traces.append(Trace(f"left {left:g} %, ours", right, ours[:, 0], i))
        for source, form in ((MATLAB, "filled"), (TRACKER, "hollow")):
            turns = huuv.turns[source]
            at = turns.left == left
            name = "printed, simulation" if source == MATLAB else "printed, pool"
            traces.append(Trace(name, turns.right[at], turns.figures[at, 0], i, form))
    mast = mast_drag(five.density)
    straight = (
        Trace("straight, submerged, our model", fine, straight_speeds(huuv, fine), -1),
        Trace("straight, without the mast's drag", fine, straight_speeds(huuv, fine, mast), 1),
    )

    across = "right thruster, in the lower panel both  [%]"
    plots = (
        Plot("u in turns  [m/s]", across, tuple(traces), 170.0, is_scaled=False),
        Plot("u straight  [m/s]", across, straight),
    )
    return PAPER.figure("huuv-fig17-18", plots, share=mast / c["d0"])


def masses_figure(five: FiveDof) -> Figure:
    """The printed turns of the simulation with the stated masses, and with those of the assumed geometry."""
    turns, names = five.level.turns[MATLAB], ("u  [m/s]", "|beta|  [deg]", "R  [m]")
    sets = [(label, with_masses(five, how, turns)) for label, how in SETS]
    at = np.arange(1.0, len(turns.left) + 1.0)
    scale = np.array([1.0, 180.0 / np.pi, 1.0])
    plots = [
        Plot(
            name, "turn of Fig. 17, by left then right thruster",
            (Trace("printed, simulation", at, turns.figures[:, k] * scale[k], -1, "filled"),
             *(Trace(label, at[seen], y[seen], i, "hollow") for i, (label, found) in enumerate(sets)
               for y in [found[:, k] * scale[k]] for seen in [np.isfinite(y)])), TALL,
            is_scaled=k == 2,
        )
        for k, name in enumerate(names)
    ]  # fmt: skip

    return PAPER.figure("huuv-masses", plots)
