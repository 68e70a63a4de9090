"""HUUV: everything that the paper's equations and its Fig. 17 let us judge, in the horizontal plane and in five degrees of freedom."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.closed_forms import plate_coefficient
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.core.wording import THREE_LINES, grouped
from coeflab.identify.tuning import Tuning, largest_correlations
from coeflab.motion import steady_state
from coeflab.motion.marching import idle, integrated_forces
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv.figures import CANNOT, paper_figures, tuning_figures
from coeflab.published.huuv.five_dof import five_dof_file, read_five_dof
from coeflab.published.huuv.five_dof_rows import dived, moving_rows, stated_rows
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, Turns, parameter_file, read_huuv, thrust
from coeflab.published.huuv.tuning import (
    ERRORS,
    IN_WORDS,
    hidden_rows,
    origin_rows,
    pool_rows,
    predicted_rows,
    tuned,
    tuned_rows,
)
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.vehicle.parameter_file import ParameterFile

CONVENTIONS = (
    "Reference point: the centre of buoyancy. Steady turns are of u, v and r alone; the tables in five degrees of freedom free heave and "
    "pitch too, and hold the roll.",
    "Turns to port have r < 0 and v > 0, so beta > 0; the tables of the paper and of this report give sizes.",
    "The paper's triad, x forward, y port, z down, is left-handed. What it computes fits x forward, y port, z up; port and starboard "
    "mirror each other, so v, r, Y and N change sign together and no coefficient does.",
    "Drag, side force and yaw moment of the hull are coefficients times V^2, with beta in rad and the area and density in them: "
    "N over (m/s)^2, N m over (m/s)^2. C_D points against the velocity, C_S across it.",
    "The Coriolis terms of the added mass stand beside C_m(beta), as in the paper: what the Munk moment counts twice is among the "
    "errata.",
    "Thruster commands are per cent of the largest; a larger right one turns to port.",
)
ACCEPTED, LASTS, SEED = 1e-3, 120.0, 20251105
MOTIONS, EXACT, FINEST = 1000, 1e-9, 1e-10  # no finer than that, so that every machine says the same
EQUATION_34, AHEAD, ASTERN, LENGTH = (1.9096, 0.1389), 0.1654, (-20.0, -100.0), 0.75
WITHIN = 13.9  # per cent: the printed dead zone ends at 14
PLATES = ((1.0, 0.579), (2.0, 0.756), (3.0, 0.831), (5.0, 0.896))
SIGNS = (
    "Computed in FRD, where these turns to port have r < 0 and v > 0; the table has sizes. Only the sign of the thrusters' "
    "moment changes between the two triads."
)


@one_thread()
def acceptance() -> Acceptance:
    """Both models, their parameter files, tables and figures."""
    huuv = read_huuv()
    file, five = parameter_file(huuv), read_five_dof(huuv)
    whole = five_dof_file(five)
    dives = dived(whole)
    halves = {source: tuned(huuv, source) for source in (MATLAB, TRACKER)}
    return Acceptance(
        "huuv",
        "HUUV: five degrees of freedom, turns under two thrusters, and coefficients tuned to them",
        (
            *turned(huuv, file),
            simulated_rows(huuv),
            origin_rows(huuv),
            tuned_rows(halves[MATLAB]),
            pool_rows(halves[TRACKER]),
            predicted_rows(huuv),
            hidden_rows(huuv, halves[MATLAB]),
            *stated_rows(five, whole),
            *moving_rows(five, dives),
        ),
        huuv.errata,
        _statements(huuv, halves),
        ("huuv2025",),
        (*tuning_figures(huuv, halves), *paper_figures(five, dives)),
        CONVENTIONS,
        (file, whole),
    )


def _statements(huuv: Huuv, halves: dict[str, Tuning]) -> tuple[str, ...]:
    pairs = [f"{IN_WORDS[a]} with {IN_WORDS[b]} {r:+.2f}" for a, b, r in largest_correlations(halves[MATLAB])]
    start = "Correlations on the MATLAB half: "
    several = grouped(pairs, THREE_LINES - len(start) - 1, ", ".join)
    reach = max(float(np.degrees(np.nanmax(t.figures[:, 1]))) for t in huuv.turns.values())
    return (
        "m_x, m_y, m_yr, the thruster arm and the moments of inertia are chosen: the paper prints none of them.",
        f"Incidence reaches {reach:.3g} deg; the paper's tables end at 25 deg. Astern the hull is its own mirror image.",
        f"Standard errors of u, beta and radius are chosen, about what the fits leave: {_weights()}. No turn was left out.",
        *(f"{start}{', '.join(group)}." for group in several),
        "The paper scaled C_S, C_m and M_mr by 2 by hand; here they are least squares with intervals where there are any.",
        "Five degrees of freedom: C_L, C_m(alpha), M_mq, elevators, z_CG, buoyancy and geometry are assumed, see five_dof.toml.",
        *(f"Cannot be made. {text}" for text in CANNOT),
    )


def _weights() -> str:
    return "; ".join(
        f"{source} {u:g} m/s, {np.degrees(beta):.2g} deg, {radius:g} m" for source, (u, beta, radius) in ERRORS.items()
    )


# ---- steady turns by root finding, in time and through the parameter file ----------------------------------------


def turned(huuv: Huuv, file: ParameterFile) -> tuple[ComparedTable, ...]:
    """What needs neither a motion in time nor a fit to Fig. 17."""
    return (
        _solved(huuv),
        _through_file(huuv, file),
        _sides(huuv, file),
        _coriolis(huuv, file),
        _equations(huuv),
        _thrusters(huuv, file),
        _bounds(huuv),
    )


def _case(turns: Turns, row: int) -> str:
    return f"{turns.left[row]:g}, {turns.right[row]:g} %"


def _wrench(huuv: Huuv, turns: Turns) -> Array:
    c = huuv.constants
    return thrust(turns.left, turns.right, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)


def _rows(huuv: Huuv, found: Array) -> tuple[Compared, ...]:
    """Operating points beside velocities u v r."""
    turns, ours = huuv.accepted, steady_state.SteadyTurns(found, np.ones(len(found), bool), np.ones(len(found), bool))
    rows: list[Compared] = []
    for i, (u, beta, radius) in enumerate(turns.figures):
        case = _case(turns, i)
        rows.append(Compared(case, "u", "m/s", float(u), float(found[i, 0]), ACCEPTED, Basis.CONSISTENCY, True))
        drift = float(np.degrees(abs(ours.drift[i])))
        rows.append(Compared(case, "|beta|", "deg", float(np.degrees(beta)), drift, ACCEPTED, Basis.CONSISTENCY, True))
        if np.isfinite(radius):
            rows.append(
                Compared(case, "R", "m", float(radius), float(ours.radius[i]), ACCEPTED, Basis.CONSISTENCY, True)
            )
        if np.isfinite(huuv.accepted_rate[i]):
            rate = float(abs(found[i, 2]))
            rows.append(
                Compared(case, "|r|", "rad/s", float(huuv.accepted_rate[i]), rate, ACCEPTED, Basis.CONSISTENCY, True)
            )
    return tuple(rows)


def _solved(huuv: Huuv) -> ComparedTable:
    found = steady_state.steady_turns(huuv.theta, _wrench(huuv, huuv.accepted))
    stable = "all are stable" if np.all(found.stable) else "some are not stable"
    return ComparedTable(
        "steady_turns", "Steady turns by root finding", _rows(huuv, found.velocity), "equations 1, 5-7, 34-38",
        (f"Forces vanish to 1e-8 of the thrust; {stable}.", SIGNS),
    )  # fmt: skip


def simulated_rows(huuv: Huuv) -> ComparedTable:
    """The steady turns after two minutes from rest."""
    times = np.array([0.0, LASTS])
    ends = np.array([steady_state.run(huuv.theta, one, times)[-1] for one in _wrench(huuv, huuv.accepted)])
    return ComparedTable(
        "simulated",
        f"The same after {LASTS:g} s from rest",
        _rows(huuv, ends),
        "equations 1, 5-7, 34-38",
        (SIGNS,),
        "steady_turns",
    )


def _by_file(huuv: Huuv, file: ParameterFile) -> Array:
    """(n, 6) velocities that the vehicle of the parameter file settles at."""
    result, turns = vehicle(file, free=("u", "v", "r")), huuv.accepted
    commands = [{"left": float(a), "right": float(b)} for a, b in zip(turns.left, turns.right, strict=True)]
    return steady_state.steady_motions(result, steady_state.wrenches(result, commands))[0]


def _through_file(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    return ComparedTable(
        "through_file", "The same from the parameter file huuv.parameters.json", _rows(huuv, _by_file(huuv, file)[:, [0, 1, 5]]),
        "equations 1, 5-7, 34-38", ("Tables C_D, C_S and C_n over beta, yaw damping over r, thrusters with a dead zone.",), "steady_turns",
    )  # fmt: skip


def _sides(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """Sizes alone would not notice a turn to the other side."""
    turning = huuv.accepted.right > huuv.accepted.left
    solved = steady_state.steady_turns(huuv.theta, _wrench(huuv, huuv.accepted)).velocity
    rows = tuple(
        Compared(where, "turns to port, v to starboard", "1", float(np.sum(turning)),
                 float(np.sum(turning & (v > 0.0) & (r < 0.0))), 0.0, Basis.CONSISTENCY)
        for where, (v, r) in (("equations", solved[:, 1:].T), ("parameter file", _by_file(huuv, file)[:, [1, 5]].T))
    )  # fmt: skip
    return ComparedTable("sides", "Which side a larger right thruster turns to", rows, "equation 38, FLU", (SIGNS,))


def _coriolis(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """The products of velocities in the forces that are integrated, of the equations and of the parameter file."""
    velocity = np.random.default_rng(SEED).normal(size=(MOTIONS, 3))
    inertial = steady_state.features(velocity)[0][:, :, steady_state.INERTIAL] @ huuv.theta[steady_state.INERTIAL]
    moved = idle(vehicle(file, free=("u", "v", "r")))
    nu, level = np.zeros((MOTIONS, 6)), np.tile((1.0, 0.0, 0.0, 0.0), (MOTIONS, 1))
    nu[:, [0, 1, 5]] = velocity
    integrated = integrated_forces(moved, nu, level, np.zeros((MOTIONS, 6)))[..., [0, 1, 5]]
    theory = steady_state.kirchhoff(huuv.theta, velocity)
    found = (
        ("equations", "force apart from Kirchhoff's", "N, N m", inertial - theory),
        ("equations", "power", "W", np.sum(inertial * velocity, axis=-1)),
        ("parameter file", "force apart from Kirchhoff's", "N, N m", integrated - theory),
        ("parameter file", "power", "W", np.sum(integrated * velocity, axis=-1)),
    )
    rows = tuple(
        Compared(
            f"{where}, {MOTIONS} random motions",
            what,
            unit,
            0.0,
            max(float(np.max(np.abs(left))), FINEST),
            EXACT,
            Basis.CONSISTENCY,
        )
        for where, what, unit, left in found
    )
    return ComparedTable(
        "coriolis", "Coriolis forces follow from the kinetic energy and do no work", rows, "equation 1, matrix C",
        ("Of the forces that steady turns and motions in time are computed with; the sum of the moments of inertia, which no "
         "steady turn asks for, is in the kinetic energy alone.",),
    )  # fmt: skip


def _equations(huuv: Huuv) -> ComparedTable:
    c = huuv.constants
    rows = [
        Compared(
            "equation 34", "intercept without a step", "N", 2.3156, c["slope"] * huuv.dead_zone, 1e-4, Basis.CONSISTENCY
        ),
    ]
    rows += [
        Compared(f"equation 30, aspect {a:g}", "k", "1", k, plate_coefficient(a), 0.01, Basis.CONSISTENCY, True)
        for a, k in PLATES
    ]
    return ComparedTable(
        "equations", "Equations 30 and 34 as corrected", tuple(rows), "equations 12, 28-34",
        (
            f"Equation 12: of C_m (beta) and the Munk moment that C_A adds the turns show the sum alone, n1 - (m_y - m_x) = "
            f"{c['n1'] - (c['my'] - c['mx']):.3g} kg. m_x and m_y are chosen here: n1 moves as they do, and shows nothing of the Munk moment.",
            "Cylinders and plates of equations 28-32: coeflab added-mass BODY --method primitives:huuv.",
        ),
    )  # fmt: skip


def _thrusters(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """Both branches of equation 34 through the file, the arms with equation 38's sign in FRD, and the dead zone."""
    c, still = huuv.constants, np.array([WITHIN])
    push = thrust(still, still, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)
    rows = [
        Compared(f"equations, {WITHIN:g} %", "thrust", "N", 0.0, float(np.max(np.abs(push))), 1e-9, Basis.CONSISTENCY)
    ]
    for t in file.thrusters:
        rows += [
            Compared(
                f"{t.name}, {c:g} %",
                "thrust",
                "N",
                EQUATION_34[1] * c + EQUATION_34[0],
                float(t.curve.at(c)),
                1e-9,
                Basis.CONSISTENCY,
            )
            for c in ASTERN
        ]
        rows += [
            Compared(f"{t.name}, {c:g} %", "thrust", "N", 0.0, float(t.curve.at(c)), 1e-9, Basis.CONSISTENCY)
            for c in (-WITHIN, WITHIN)
        ]
        rows.append(
            Compared(
                f"{t.name}, 100 % over 50 %",
                "gain of thrust",
                "N",
                50.0 * AHEAD,
                float(t.curve.at(100.0) - t.curve.at(50.0)),
                1e-9,
                Basis.CONSISTENCY,
            )
        )
    return ComparedTable(
        "thrusters", "Thrust of the parameter file", tuple(rows), "equation 34",
        ("The printed numbers typed a second time: they prove the way into the file, not the model. Of the branch ahead its slope; "
         "its intercept is fitted, see the errata.",),
    )  # fmt: skip


def _bounds(huuv: Huuv) -> ComparedTable:
    """What the printed length allows a moment of inertia to be: all of the mass at both ends."""
    c = huuv.constants
    most = (c["m"] + c["my"]) * (LENGTH / 2.0) ** 2
    row = Compared(
        "mass and added mass at the ends",
        "sum of moments of inertia",
        "kg m^2",
        most,
        c["inertia"],
        0.0,
        Basis.CONSISTENCY,
        at_most=True,
    )
    return ComparedTable(
        "bounds", "What a body of the printed length can have", (row,), "Table 1, L = 0.75 m",
        ("By strips: no mass lies farther from the middle than half the length. Steady turns do not depend on it.",),
    )  # fmt: skip
