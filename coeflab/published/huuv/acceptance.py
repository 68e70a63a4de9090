"""HUUV: everything that the paper's equations and its Fig. 17 let us judge, in the horizontal plane and in five degrees of freedom."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.closed_forms.parts import plate_coefficient
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.core.wording import THREE_LINES, grouped
from coeflab.identify.tuning import Tuning, largest_correlations
from coeflab.motion import steady_state
from coeflab.motion import steady_turns as planar_turns
from coeflab.motion.ensemble import idle, integrated_forces
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv import tuning
from coeflab.published.huuv.figures import paper_figures, tuning_figures
from coeflab.published.huuv.five_dof import read_five_dof
from coeflab.published.huuv.five_dof_file import five_dof_file
from coeflab.published.huuv.five_dof_rows import dived, moving_rows, stated_rows
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, Turns, parameter_file, read_huuv, thrust
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Acceptance, ComparedTable
from coeflab.vehicle.parameter_file import ParameterFile

PAPER = publication("huuv")

LASTS, MOTIONS, SEED = 120.0, 1000, 20251105
EQUATION_34, AHEAD, ASTERN, LENGTH = (1.9096, 0.1389), 0.1654, (-20.0, -100.0), 0.75
WITHIN = 13.9  # per cent: the printed dead zone ends at 14
PLATES = ((1.0, 0.579), (2.0, 0.756), (3.0, 0.831), (5.0, 0.896))


@one_thread()
def acceptance() -> Acceptance:
    """Both models, their parameter files, tables and figures."""
    huuv = read_huuv()
    file, five = parameter_file(huuv), read_five_dof(huuv)
    whole = five_dof_file(five)
    dives = dived(whole)
    halves = {source: tuning.tuned(huuv, source) for source in (MATLAB, TRACKER)}
    return PAPER.acceptance(
        (
            *turned(huuv, file),
            simulated_rows(huuv),
            tuning.origin_rows(huuv),
            tuning.tuned_rows(halves[MATLAB]),
            tuning.pool_rows(halves[TRACKER]),
            tuning.predicted_rows(huuv),
            tuning.hidden_rows(huuv, halves[MATLAB]),
            *stated_rows(five, whole),
            *moving_rows(five, dives),
        ),
        _statements(huuv, halves),
        errata=huuv.errata,
        figures=(*tuning_figures(huuv, halves), *paper_figures(five, dives)),
        parameter_files=(file, whole),
    )


def _statements(huuv: Huuv, halves: dict[str, Tuning]) -> tuple[str, ...]:
    pairs = [
        f"{tuning.IN_WORDS[a]} with {tuning.IN_WORDS[b]} {r:+.2f}" for a, b, r in largest_correlations(halves[MATLAB])
    ]
    start = "Correlations on the MATLAB half: "
    several = grouped(pairs, THREE_LINES - len(start) - 1, ", ".join)
    reach = max(float(np.degrees(np.nanmax(t.figures[:, 1]))) for t in huuv.turns.values())
    weights = (
        f"{source} {u:g} m/s, {np.degrees(beta):.2g} deg, {radius:g} m"
        for source, (u, beta, radius) in tuning.ERRORS.items()
    )
    correlations = [f"{start}{', '.join(group)}." for group in several]
    cannot = [f"Cannot be made. {text}" for text in PAPER.content["cannot"]]
    return PAPER.texts("statements", reach=reach, weights="; ".join(weights), correlations=correlations, cannot=cannot)


# ---- steady turns by root finding, in time and through the parameter file ----------------------------------------


def turned(huuv: Huuv, file: ParameterFile) -> tuple[ComparedTable, ...]:
    """What needs neither a motion in time nor a fit to Fig. 17."""
    return (
        _solved(huuv),
        PAPER.table("through_file", _rows(huuv, _by_file(huuv, file)[:, [0, 1, 5]])),
        _sides(huuv, file),
        _coriolis(huuv, file),
        _equations(huuv),
        _thrusters(huuv, file),
        _bounds(huuv),
    )


def _wrench(huuv: Huuv, turns: Turns) -> Array:
    c = huuv.constants
    return thrust(turns.left, turns.right, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)


def _rows(huuv: Huuv, found: Array) -> list[Row]:
    """Operating points beside velocities u v r."""
    turns, ours = (
        huuv.accepted,
        planar_turns.SteadyTurns(found, np.ones(len(found), bool), np.ones(len(found), bool)),
    )
    printed = np.column_stack([turns.figures * (1.0, np.degrees(1.0), 1.0), huuv.accepted_rate])
    computed = np.column_stack([found[:, 0], np.degrees(np.abs(ours.drift)), ours.radius, np.abs(found[:, 2])])
    names = (("u", "m/s"), ("|beta|", "deg"), ("R", "m"), ("|r|", "rad/s"))
    return [
        Row(f"{turns.left[i]:g}, {turns.right[i]:g} %", name, unit, float(against), float(value))
        for i, (held, here) in enumerate(zip(printed, computed, strict=True))
        for (name, unit), against, value in zip(names, held, here, strict=True)
        if np.isfinite(against)
    ]


def _solved(huuv: Huuv) -> ComparedTable:
    found = planar_turns.steady_turns(huuv.theta, _wrench(huuv, huuv.accepted))
    stable = "all are stable" if np.all(found.stable) else "some are not stable"
    return PAPER.table("steady_turns", _rows(huuv, found.velocity), stable=stable)


def simulated_rows(huuv: Huuv) -> ComparedTable:
    """The steady turns after two minutes from rest."""
    times = np.array([0.0, LASTS])
    ends = np.array([planar_turns.run(huuv.theta, one, times)[-1] for one in _wrench(huuv, huuv.accepted)])
    return PAPER.table("simulated", _rows(huuv, ends), lasts=LASTS)


def _by_file(huuv: Huuv, file: ParameterFile) -> Array:
    """(n, 6) velocities that the vehicle of the parameter file settles at."""
    result, turns = vehicle(file, free=("u", "v", "r")), huuv.accepted
    commands = [{"left": float(a), "right": float(b)} for a, b in zip(turns.left, turns.right, strict=True)]
    return steady_state.steady_motions(result, steady_state.wrenches(result, commands))[0]


def _sides(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """Sizes alone would not notice a turn to the other side."""
    turning = huuv.accepted.right > huuv.accepted.left
    solved = planar_turns.steady_turns(huuv.theta, _wrench(huuv, huuv.accepted)).velocity
    rows = tuple(
        Row(where, "turns to port, v to starboard", "1", float(np.sum(turning)), float(np.sum(turning & (v > 0.0) & (r < 0.0))))
        for where, (v, r) in (("equations", solved[:, 1:].T), ("parameter file", _by_file(huuv, file)[:, [1, 5]].T))
    )  # fmt: skip
    return PAPER.table("sides", rows)


def _coriolis(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """The products of velocities in the forces that are integrated, of the equations and of the parameter file."""
    velocity = np.random.default_rng(SEED).normal(size=(MOTIONS, 3))
    inertial = planar_turns.features(velocity)[0][:, :, planar_turns.INERTIAL] @ huuv.theta[planar_turns.INERTIAL]
    moved = idle(vehicle(file, free=("u", "v", "r")))
    nu, level = np.zeros((MOTIONS, 6)), np.tile((1.0, 0.0, 0.0, 0.0), (MOTIONS, 1))
    nu[:, [0, 1, 5]] = velocity
    integrated = integrated_forces(moved, nu, level, np.zeros((MOTIONS, 6)))[..., [0, 1, 5]]
    theory = planar_turns.kirchhoff(huuv.theta, velocity)
    found = (
        ("equations", "force apart from Kirchhoff's", "N, N m", inertial - theory),
        ("equations", "power", "W", np.sum(inertial * velocity, axis=-1)),
        ("parameter file", "force apart from Kirchhoff's", "N, N m", integrated - theory),
        ("parameter file", "power", "W", np.sum(integrated * velocity, axis=-1)),
    )
    rows = tuple(Row.none(f"{where}, {MOTIONS} random motions", what, unit, left) for where, what, unit, left in found)
    return PAPER.table("coriolis", rows)


def _equations(huuv: Huuv) -> ComparedTable:
    c = huuv.constants
    rows = [Row("equation 34", "intercept without a step", "N", 2.3156, c["slope"] * huuv.dead_zone)]
    rows += [
        Row(f"equation 30, aspect {a:g}", "k", "1", k, plate_coefficient(a), 0.01, relative=True) for a, k in PLATES
    ]
    return PAPER.table("equations", rows, seen=c["n1"] - (c["my"] - c["mx"]))


def _thrusters(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """Both branches of equation 34 through the file, the arms with equation 38's sign in FRD, and the dead zone."""
    c, still = huuv.constants, np.array([WITHIN])
    push = thrust(still, still, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)
    rows = [Row(f"equations, {WITHIN:g} %", "thrust", "N", 0.0, float(np.max(np.abs(push))))]
    for t in file.thrusters:
        rows += [
            Row(f"{t.name}, {c:g} %", "thrust", "N", EQUATION_34[1] * c + EQUATION_34[0], float(t.curve.at(c)))
            for c in ASTERN
        ]
        rows += [Row(f"{t.name}, {c:g} %", "thrust", "N", 0.0, float(t.curve.at(c))) for c in (-WITHIN, WITHIN)]
        gain = float(t.curve.at(100.0) - t.curve.at(50.0))
        rows.append(Row(f"{t.name}, 100 % over 50 %", "gain of thrust", "N", 50.0 * AHEAD, gain))
    return PAPER.table("thrusters", rows)


def _bounds(huuv: Huuv) -> ComparedTable:
    """What the printed length allows a moment of inertia to be: all of the mass at both ends."""
    c = huuv.constants
    most = (c["m"] + c["my"]) * (LENGTH / 2.0) ** 2
    row = Row("mass and added mass at the ends", "sum of moments of inertia", "kg m^2", most, c["inertia"])
    return PAPER.table("bounds", (row,))
