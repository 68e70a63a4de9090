"""Drawings of the TJ-FlyingFish: operating points, rotor curves, thrust against tilt, damping."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array
from coeflab.published.flyingfish.model import ROTORS, FlyingFish
from coeflab.report.acceptance import ComparedTable
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, Trace, laws_figure

ALONG = "motion of Table 1  [-]"
FINE = 57


def figures(fish: FlyingFish, nearest: ComparedTable) -> tuple[tuple[str, Figure], ...]:
    """All drawings by their file names.

    Parameters
    ----------
    fish : FlyingFish
    nearest : ComparedTable
        The trims nearest to Table 1, eight rows a motion: four tilts in deg, four rotor speeds in rpm.
    """
    return (
        ("flyingfish_operating_points", _operating_points(nearest)),
        ("flyingfish_thrust_over_tilt", _thrust_over_tilt(fish)),
        ("flyingfish_rotors", _rotors(fish)),
        ("flyingfish_damping", _damping(fish)),
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
            told, ours = printed[:, first + i], found[:, first + i]
            both.append(Trace(f"rotor {rotor}, printed", motion, told, i, "hollow"))
            both.append(Trace(f"rotor {rotor}, recomputed", motion, ours, i, "filled"))
            apart.append(Trace(f"rotor {rotor}, recomputed", motion, ours - told, i, "filled"))
        plots.append(Plot(f"{name}  [{unit}]", ALONG, tuple(both), 108.0, is_scaled=False))
        plots.append(Plot(f"apart  [{unit}]", ALONG, tuple(apart), 66.0, rows[first].tolerance, is_scaled=first == 4))
    worst = np.nanmax(np.abs(found - printed), axis=0)
    return laws_figure(
        "flyingfish-operating-points", "Operating points: tilts and rotor speeds, printed and recomputed",
        f"The trim nearest to each row of Table 1. Below each panel, recomputed less printed; grey: allowed. The largest is "
        f"{worst[:4].max():.4f} deg and {worst[4:].max():.3f} rpm. In-sample: the constants come from these rows.",
        "Four panels over the ten motions: tilt of four rotors, printed and recomputed, and their difference; rotor speed "
        "likewise.",
        plots,
    )  # fmt: skip


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
    return laws_figure(
        "flyingfish-rotors", "Rotors: thrust and torque over speed, with the operating points",
        "Equations 47 and 48, with 6.0355e-4 for the printed 0.0006. Marks: where the ten motions of Table 1 lie on the curves; "
        "they are no measurements. The paper prints none.",
        "Two panels over the rotor speed: thrust and torque as rising curves, with the speeds of Table 1 marked for four rotors.",
        plots,
    )  # fmt: skip


def _thrust_over_tilt(fish: FlyingFish) -> Figure:
    traces = tuple(
        Trace(
            f"rotor {rotor}", np.degrees(fish.angles[:, i]), _law(fish.rotors.thrust, fish.speeds[:, i]), i, "filled",
            _noted(fish),
        )
        for i, rotor in enumerate(ROTORS)
    )  # fmt: skip
    return laws_figure(
        "flyingfish-thrust-over-tilt", "Thrust against tilt at the operating points",
        "One mark a rotor and motion, thrust by equation 47 at the speeds of Table 1. At no tilt the thrust points down, at 90 deg "
        "across the arm: rotors 1 and 2, with tilts of opposite sign, drive the vehicle ahead; rotors 3 and 4 trim pitch, roll and sway.",
        "Thrust of four rotors over their tilt: rotors 1 and 2 lie at 45 to 86 and at -47 to -82 degrees, rotors 3 and 4 between -44 and 39 degrees.",
        (Plot("thrust T  [N]", "tilt beta  [deg]", traces, 190.0),),
    )  # fmt: skip


def _damping(fish: FlyingFish) -> Figure:
    plots = []
    for part, names, across, unit, reach in (
        (
            slice(0, 3),
            ("surge: X over u", "sway: Y over v", "heave: Z over w"),
            "speed along the axis  [m/s]",
            "N",
            0.6,
        ),
        (
            slice(3, 6),
            ("roll: K over p", "pitch: M over q", "yaw: N over r"),
            "rate about the axis  [deg/s]",
            "N m",
            25.0,
        ),
    ):
        x = np.linspace(-reach, reach, FINE)
        si = x if unit == "N" else np.radians(x)
        laws = zip(names, fish.rotors.linear[part], fish.rotors.quadratic[part], strict=True)
        traces = tuple(Trace(name, x, -(a + b * np.abs(si)) * si, i) for i, (name, a, b) in enumerate(laws))
        plots.append(Plot(f"{'force' if unit == 'N' else 'moment'}  [{unit}]", across, traces, 120.0))
    return laws_figure(
        "flyingfish-damping", "Damping in water, as the paper prints it",
        "Equation 50, over the speeds and rates that Table 1 reaches and a little more. The paper gives drag along each axis alone "
        "and no values over alpha and beta, so there is no drag surface to show.",
        "Two panels of odd, nearly quadratic curves: forces over speed along x, y, z, and moments over rates about them.",
        plots,
    )  # fmt: skip
