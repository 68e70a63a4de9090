"""THAUV's figures as our pictures: masses, roller, forces, cruise, speeds and motions in time, and a spiral.

The paper is here as text without pictures. Points are drawn where its text prints the number: none was read off a figure.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from coeflab.core.types import Array
from coeflab.glider.figures import motion_figure, polar_figure
from coeflab.glider.flight import Flown
from coeflab.glider.glide import GlideRun
from coeflab.published.publication import publication
from coeflab.published.thauv.in_space import space_of
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, Trace

PAPER = publication("thauv")

SHOWN = (-15.0, 15.0)
SPEEDS = (0.25, 0.5, 0.75, 1.0)
CRUISES = (0.0, 1.5)
PRINTED = {"01": (0.25, 0.43), "02": (0.32, 0.54), "03": (0.34, 0.57)}
STEADY, SECOND = 170.0, 1430.0  # s, as printed


def figures(flown: Sequence[Flown], spiral: GlideRun) -> Iterator[tuple[str, Figure]]:
    """Every figure with the name of its file, of the three cases and of a spiral."""
    yield "motion", motion_figure([f.run for f in flown], "thauv-motion")
    for f in flown:
        yield f"polar_{f.run.glider.name}", polar_figure(f.run.glider, f.steady, f.run.glider.name)
    yield "forces", _forces(flown)
    yield "forces_case_01", _at_speeds(flown[0])
    yield "cruise", _cruise(flown)
    yield "speeds", _speeds(flown)
    yield "masses", _masses(flown[1])
    yield "spiral", _spiral(spiral)


def _forces(flown: Sequence[Flown]) -> Figure:
    """Lift, drag and pitch moment of the three wings, over V^2."""
    alpha = np.linspace(*SHOWN, 57)
    plots = []
    for name, unit in (("lift", "N"), ("drag", "N"), ("moment", "N m")):
        traces = tuple(
            Trace(f"case {_case(f)}", alpha, _over_speed(f, name)(np.radians(alpha)), i) for i, f in enumerate(flown)
        )
        label = f"{name} / V^2  [{unit}/(m/s)^2]"
        plots.append(Plot(label, "angle of attack alpha  [deg]", traces, 104.0, is_scaled=name == "moment"))
    return PAPER.figure("thauv-forces", plots)


def _at_speeds(flown: Flown) -> Figure:
    """Figures 8 to 10: lift, drag and moment of case 01 over the angle of attack at several speeds."""
    alpha = np.linspace(*SHOWN, 57)
    plots = []
    for name, unit in (("lift", "N"), ("drag", "N"), ("moment", "N m")):
        law = _over_speed(flown, name)(np.radians(alpha))
        traces = tuple(Trace(f"V = {v:g} m/s", alpha, law * v * v, i) for i, v in enumerate(SPEEDS))
        plots.append(
            Plot(f"{name}  [{unit}]", "angle of attack alpha  [deg]", traces, 104.0, is_scaled=name == "moment")
        )
    return PAPER.figure("thauv-forces-case-01", plots)


def _cruise(flown: Sequence[Flown]) -> Figure:
    """Figures 11 and 12: lift and drag of the level cruise over the speed."""
    speed = np.linspace(*CRUISES, 61)
    plots = []
    for name, number in (("lift", 11), ("drag", 12)):
        traces = tuple(
            Trace(f"case {_case(f)}", speed, float(_over_speed(f, name)(np.array(0.0))) * speed**2, i)
            for i, f in enumerate(flown)
        )
        plots.append(Plot(f"{name}, Figure {number}  [N]", "speed V  [m/s]", traces, 110.0, is_scaled=name == "drag"))
    drag = [float(_over_speed(f, "drag")(np.array(0.0))) for f in flown]
    spread = 100.0 * (max(drag) / min(drag) - 1.0)
    return PAPER.figure("thauv-cruise", plots, spread=spread)


def _speeds(flown: Sequence[Flown]) -> Figure:
    """Figure 13 with the printed speeds."""
    traces = []
    for i, f in enumerate(flown):
        traces.append(Trace(f"case {_case(f)}", f.run.time, f.run.speed, i))
        notes = ("section 5: stable dive at around 170 s", "section 5: second stable dive, drawn at 1430 s, its end")
        points = Trace(
            f"case {_case(f)}, printed", np.array([STEADY, SECOND]), np.array(PRINTED[_case(f)]), i, "hollow", notes
        )
        traces.append(points)
    return PAPER.figure("thauv-speeds", (Plot("V  [m/s]", "time  [s]", tuple(traces), 170.0),))


def _masses(flown: Flown) -> Figure:
    """Figures 2 and 3: masses in plan, and the roller's centre over its angle."""
    space, rest = space_of(flown.run.glider)
    masses = space.masses
    right, left = masses.pistons(0.0)
    roller, whole = masses.roller_place(0.0), masses.centre_of_gravity(0.0, 0.0, rest)
    named = (
        ("pistons", (right, left), ("0.511 kg, right", "0.511 kg, left"), "filled"),
        ("roller", (roller,), ("1.04 kg",), "filled"),
        ("the rest", (rest,), ("64.29 kg",), "filled"),
        ("centre of gravity", (whole,), ("66.35 kg",), "hollow"),
    )
    plan = tuple(
        Trace(name, np.array([p[1] for p in at]), np.array([p[0] for p in at]), i, form, notes)
        for i, (name, at, notes, form) in enumerate(named)
    )
    angle = np.linspace(-90.0, 90.0, 61)
    place = np.array([masses.roller_place(a) for a in np.radians(angle)])
    turned = (Trace("roller, y", angle, place[:, 1], 0), Trace("roller, z", angle, place[:, 2], 1))
    return PAPER.figure(
        "thauv-masses",
        (
            Plot("x, forward  [m]", "y, to starboard  [m]", plan, 130.0),
            Plot("place of the roller  [m]", "roller angle gamma  [deg]", turned, 110.0),
        ),
    )


def _spiral(run: GlideRun) -> Figure:
    """A dive with the roller turned: track and roll."""
    t = run.trajectory
    track = (Trace(run.glider.name, t.position[:, 1], t.position[:, 0], -1),)
    roll = (Trace(run.glider.name, t.time, np.degrees(t.angles[:, 0]), -1),)
    height = (Trace(run.glider.name, t.time, -run.depth, -1),)
    return PAPER.figure(
        "thauv-spiral",
        (
            Plot("north  [m]", "east  [m]", track, 150.0),
            Plot("roll  [deg]", "time  [s]", roll, 80.0, is_scaled=False),
            Plot("height  [m]", "time  [s]", height, 80.0),
        ),
    )


def _over_speed(flown: Flown, name: str) -> Callable[[Array], Array]:
    polar = flown.run.glider.body.polar
    return {"lift": polar.lift_at, "drag": polar.drag_at, "moment": polar.moment_at}[name]


def _case(flown: Flown) -> str:
    return flown.run.glider.name.rpartition("_")[2]
