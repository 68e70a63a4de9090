"""Drawings of the TJ-FlyingFish: operating points, rotors and bench, tilt, damping in both media, tracks, the change of medium."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.core.files import shipped
from coeflab.core.types import Array
from coeflab.identify.identified_figures import bench_figure
from coeflab.identify.thruster import BenchTest
from coeflab.motion.trajectory import Trajectory
from coeflab.published.flyingfish.model import ROTORS, FlyingFish, Medium
from coeflab.published.flyingfish.motions import Craft, benches, hop, steady
from coeflab.published.publication import publication
from coeflab.report.acceptance import ComparedTable
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, Trace
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables

PAPER = publication("flyingfish")

ALONG = "motion of Table 1  [-]"
FINE = 57
DRAWN = 6  # decimals of a metre: a level track is level


def figures(craft: Craft, nearest: ComparedTable) -> tuple[tuple[str, Figure], ...]:
    """All drawings by their file names.

    Parameters
    ----------
    craft : Craft
    nearest : ComparedTable
        The trims nearest to Table 1, eight rows a motion: four tilts in deg, four rotor speeds in rpm.
    """
    fish = craft.fish
    found = {row + 1: steady(craft, row) for row in range(len(fish.motion))}
    return (
        ("flyingfish_operating_points", _operating_points(nearest)),
        ("flyingfish_thrust_over_tilt", _thrust_over_tilt(fish)),
        ("flyingfish_tilt", _tilt()),
        ("flyingfish_rotors", _rotors(fish)),
        *((f"flyingfish_bench_{medium}", _bench(medium, test)) for medium, test in benches(fish).items()),
        ("flyingfish_damping", _damping(fish, "water")),
        ("flyingfish_damping_air", _damping(fish, "air")),
        ("flyingfish_level", _level(craft, found)),
        ("flyingfish_oblique", _oblique(found)),
        ("flyingfish_curves", _curves(found)),
        ("flyingfish_surface", _surface(hop(craft))),
    )


def _operating_points(nearest: ComparedTable) -> Figure:
    rows = nearest.rows
    shape = (len(rows) // 8, 8)
    printed = np.array([r.against for r in rows]).reshape(shape)
    found = np.array([np.nan if r.found is None else r.found for r in rows]).reshape(shape)
    motion = np.arange(1.0, shape[0] + 1.0)
    plots: list[Plot] = []
    for first, name, unit in ((0, "tilt", "deg"), (4, "speed", "rpm")):
        both: list[Trace] = []
        apart: list[Trace] = []
        for i, rotor in enumerate(ROTORS):
            stated, ours = printed[:, first + i], found[:, first + i]
            both.append(Trace(f"rotor {rotor}, printed", motion, stated, i, "hollow"))
            both.append(Trace(f"rotor {rotor}, recomputed", motion, ours, i, "filled"))
            apart.append(Trace(f"rotor {rotor}, recomputed", motion, ours - stated, i, "filled"))
        plots.append(Plot(f"{name}  [{unit}]", ALONG, tuple(both), 108.0, is_scaled=False))
        plots.append(Plot(f"apart  [{unit}]", ALONG, tuple(apart), 66.0, rows[first].tolerance, is_scaled=first == 4))
    worst = np.nanmax(np.abs(found - printed), axis=0)
    return PAPER.figure("flyingfish-operating-points", plots, tilt=worst[:4].max(), speed=worst[4:].max())


def _law(factors: Array, n: Array) -> Array:
    return np.asarray(factors[0] * n + factors[1] * n**2)


def _noted(fish: FlyingFish) -> tuple[str, ...]:
    return tuple(f"motion {i + 1}" for i in range(len(fish.motion)))


def _rotors(fish: FlyingFish) -> Figure:
    n = np.linspace(0.0, fish.largest_speed, FINE)
    plots = []
    for factors, name, unit, last in (
        (fish.rotors.thrust, "thrust T", "N", False),
        (fish.rotors.torque, "torque Q", "N m", True),
    ):
        traces = [Trace("curve of the paper", n, _law(factors, n), -1)]
        for i, rotor in enumerate(ROTORS):
            at = fish.speeds[:, i]
            traces.append(Trace(f"rotor {rotor}, Table 1", at, _law(factors, at), i, "hollow", _noted(fish)))
        plots.append(Plot(f"{name}  [{unit}]", "rotor speed  [rpm]", tuple(traces), 130.0, is_scaled=last))
    return PAPER.figure("flyingfish-rotors", plots)


def _thrust_over_tilt(fish: FlyingFish) -> Figure:
    traces = tuple(
        Trace(
            f"rotor {rotor}", np.degrees(fish.angles[:, i]), _law(fish.rotors.thrust, fish.speeds[:, i]), i, "filled",
            _noted(fish),
        )
        for i, rotor in enumerate(ROTORS)
    )  # fmt: skip
    return PAPER.figure("flyingfish-thrust-over-tilt", (Plot("thrust T  [N]", "tilt beta  [deg]", traces, 190.0),))


def _damping(fish: FlyingFish, medium: Medium) -> Figure:
    """Fig. 8: the printed laws, and the synthetic points made of them."""
    wet = medium == "water"
    table = read_tables(PlannedTable(Path(str(shipped("cfd_data") / f"flyingfish_{medium}_synthetic")), ()))[0]
    linear, quadratic = (fish.rotors.linear, fish.rotors.quadratic) if wet else fish.air
    plots = []
    for part, names, across, unit in (
        (range(3), ("surge: X over u", "sway: Y over v", "heave: Z over w"), "speed along the axis  [m/s]", "N"),
        (range(3, 6), ("roll: K over p", "pitch: M over q", "yaw: N over r"), "rate about the axis  [deg/s]", "N m"),
    ):
        traces: list[Trace] = []
        for i, (name, k) in enumerate(zip(names, part, strict=True)):
            x = np.asarray(table.motion["uvwpqr"[k]])
            alone = x != 0.0
            si = np.linspace(float(x.min()), float(x.max()), 2 * FINE - 1)
            factor = 1.0 if unit == "N" else np.degrees(1.0)
            traces.append(Trace(name, factor * si, -(linear[k] + quadratic[k] * np.abs(si)) * si, i))
            points = np.asarray(table.forces["XYZKMN"[k]])[alone]
            traces.append(Trace(f"{name.split(':')[0]}, synthetic", factor * x[alone], points, i, "hollow"))
        plots.append(Plot(f"{'force' if unit == 'N' else 'moment'}  [{unit}]", across, tuple(traces), 120.0))
    return PAPER.figure(f"flyingfish-damping{'' if wet else '-air'}", plots)


def _tilt() -> Figure:
    """Fig. 3: what the tilt of an arm does to the thrust on it."""
    beta = np.linspace(-180.0, 180.0, 121)
    sin, cos = np.sin(np.radians(beta)), np.cos(np.radians(beta))
    shares = (
        ("force along x  [T]", (("rotor 1", sin, 0), ("rotor 2", -sin, 1))),
        ("force along y  [T]", (("rotor 3", -sin, 2), ("rotor 4", sin, 3))),
        ("force along z  [T]", (("every rotor", cos, -1),)),
    )
    plots = [
        Plot(
            name,
            "tilt beta  [deg]",
            tuple(Trace(rotor, beta, y, style) for rotor, y, style in curves),
            70.0,
            is_scaled=k == 2,
        )
        for k, (name, curves) in enumerate(shares)
    ]
    return PAPER.figure("flyingfish-tilt", plots)


def _bench(medium: Medium, test: BenchTest) -> Figure:
    """Fig. 5."""
    which = "47 and 48" if medium == "water" else "45 and 46"
    result = bench_figure(test, PAPER.text("bench", medium=medium, which=which))
    return replace(
        result,
        anchor=f"flyingfish-bench-{medium}",
        svg=result.svg.replace("bench-rotor1", f"flyingfish-bench-{medium}"),
    )


def _tracks(found: Mapping[int, Trajectory], shown: Sequence[tuple[int, int]]) -> tuple[Plot, Plot]:
    """Depth and distance east over distance north; motions and their styles."""
    paths = {k: np.round(found[k].position, DRAWN) for k, _ in shown}
    depth, east = (
        tuple(Trace(f"motion {k}", paths[k][:, 0], paths[k][:, axis], style) for k, style in shown) for axis in (2, 1)
    )
    return Plot("depth  [m]", "north  [m]", depth, 100.0, is_scaled=False), Plot("east  [m]", "north  [m]", east, 70.0)


def _level(craft: Craft, found: Mapping[int, Trajectory]) -> Figure:
    """Fig. 9 (a) and (b)."""
    rotor = np.arange(1.0, 5.0)
    tilts: list[Trace] = []
    for k, style in ((1, 0), (3, 1)):
        tilts.append(Trace(f"motion {k}, printed tilts", rotor, np.degrees(craft.fish.angles[k - 1]), style, "hollow"))
        trimmed = np.degrees(craft.trims[k - 1, :4])
        tilts.append(Trace(f"motion {k}, corrected tilts", rotor, trimmed, style, "filled"))
    return PAPER.figure(
        "flyingfish-level", (*_tracks(found, ((1, 0), (3, 1))), Plot("tilt  [deg]", "rotor  [-]", tuple(tilts), 80.0))
    )


def _oblique(found: Mapping[int, Trajectory]) -> Figure:
    """Fig. 9 (c)."""
    return PAPER.figure("flyingfish-oblique", _tracks(found, ((4, 0), (5, 1), (6, -1), (7, 2), (8, 3))))


def _curves(found: Mapping[int, Trajectory]) -> Figure:
    """Fig. 10: the circle and the helix."""
    circle, spiral = found[9], found[10]
    both = tuple(
        Trace(name, t.position[:, 1], t.position[:, 0], i) for i, (name, t) in enumerate((("motion 9", circle), ("motion 10", spiral)))
    )  # fmt: skip
    depth = tuple(
        Trace(name, t.time, t.position[:, 2], i)
        for i, (name, t) in enumerate((("motion 9", circle), ("motion 10", spiral)))
    )
    return PAPER.figure(
        "flyingfish-curves",
        (Plot("north  [m]", "east  [m]", both, 190.0, is_equal=True), Plot("depth  [m]", "time  [s]", depth, 80.0)),
    )


def _surface(found: Trajectory) -> Figure:
    """The hop out of the water."""
    time, above = np.asarray(found.time), -np.asarray(found.position)[:, 2]
    depth = float(found.position[int(np.argmin(np.abs(time - (found.reached[0] or 0.0)))), 2])
    up = -np.asarray(found.velocity)[:, 2]
    media = (("under water", found.phase == 0, 0), ("in air", found.phase == 1, 1))
    plots: list[Plot] = []
    for name, values in (("height  [m]", above + depth), ("speed up  [m/s]", up)):
        traces = tuple(Trace(medium, time[at], values[at], style) for medium, at, style in media)
        plots.append(Plot(name, "time  [s]", traces, 100.0, is_scaled=len(plots) == 1))
    return PAPER.figure("flyingfish-surface", plots)
