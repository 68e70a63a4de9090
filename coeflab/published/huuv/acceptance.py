"""HUUV: steady turns of a vehicle steered by two thrusters, and coefficients tuned to its printed turns."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coeflab.bodies.closed_forms import plate_coefficient
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.motion.steady_state import SteadyTurns, coriolis, run, steady_motions, steady_turns, wrenches
from coeflab.motion.tune.tuning import Tuning, largest_correlations, moved_in_words
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv.fit import BASE, ERRORS, TOLD, forces_figure, hidden, tuned
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, Turns, parameter_file, read_huuv, thrust
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.report.document import Figure
from coeflab.report.figures.tuning import Groups, agreement_figure, curves_figure

ACCEPTED, LASTS, SEED = 1e-3, 120.0, 20251105
LIMITS = {"u": ("m/s", 0.007), "beta": ("deg", 0.40), "radius": ("m", 0.027)}
ABOUT = {"u": ("m/s", 0.063), "beta": ("deg", 1.1), "radius": ("m", 0.14)}
ROUGHLY = 0.1
INTERCEPT, EITHER_WAY = 2.30, 0.15
PLATES = ((1.0, 0.579), (2.0, 0.756), (3.0, 0.831), (5.0, 0.896))
CONVENTIONS = (
    "Reference point: the centre of buoyancy. Only u, v and r move; heave, roll and pitch are zero.",
    "Turns to port have r < 0 and v > 0, so beta > 0; the tables of the paper and of this report give sizes.",
    "The paper's triad, x forward, y port, z down, is left-handed. What it computes fits x forward, y port, z up; port and starboard "
    "mirror each other, so v, r, Y and N change sign together and no coefficient does.",
    "Drag, side force and yaw moment of the hull are coefficients times V^2, with beta in rad and the area and density in them: "
    "N over (m/s)^2, N m over (m/s)^2. C_D points against the velocity, C_S across it.",
    "The Coriolis terms of the added mass stand beside C_m(beta), as in the paper: what the Munk moment counts twice is among the "
    "errata.",
    "Thruster commands are per cent of the largest; a larger right one turns to port.",
)
SIGNS = (
    "Computed in FRD, where these turns to port have r < 0 and v > 0; the table has sizes. Only the sign of the thrusters' "
    "moment changes between the two triads."
)


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper's equations and its Fig. 17 let us judge."""
    huuv = read_huuv()
    halves = {source: tuned(huuv, source) for source in (MATLAB, TRACKER)}
    return Acceptance(
        "huuv",
        "HUUV: steady turns under two thrusters, and coefficients tuned to the printed turns",
        (
            _solved(huuv),
            _simulated(huuv),
            _through_file(huuv),
            _skew(huuv),
            _origin(huuv),
            _tuned(halves[MATLAB]),
            _told(halves[TRACKER]),
            _hidden(huuv, halves[MATLAB]),
            _equations(huuv),
        ),
        huuv.errata,
        _statements(huuv, halves),
        ("huuv2025",),
        tuple(_figures(huuv, halves)),
        CONVENTIONS,
        (parameter_file(huuv),),
    )


def _case(turns: Turns, row: int) -> str:
    return f"{turns.left[row]:g}, {turns.right[row]:g} %"


def _wrench(huuv: Huuv, turns: Turns) -> Array:
    c = huuv.constants
    return thrust(turns.left, turns.right, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)


def _rows(huuv: Huuv, found: Array) -> tuple[Compared, ...]:
    """Operating points beside velocities u v r."""
    turns, ours = huuv.accepted, SteadyTurns(found, np.ones(len(found), bool), np.ones(len(found), bool))
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
    found = steady_turns(huuv.theta, _wrench(huuv, huuv.accepted))
    stable = "all are stable" if np.all(found.stable) else "some are not stable"
    return ComparedTable(
        "steady_turns", "Steady turns by root finding", _rows(huuv, found.velocity), "equations 1, 5-7, 34-38",
        (f"Forces vanish to 1e-8 of the thrust; {stable}.", SIGNS),
    )  # fmt: skip


def _simulated(huuv: Huuv) -> ComparedTable:
    times = np.array([0.0, LASTS])
    ends = np.array([run(huuv.theta, one, times)[-1] for one in _wrench(huuv, huuv.accepted)])
    return ComparedTable(
        "simulated",
        f"The same after {LASTS:g} s from rest",
        _rows(huuv, ends),
        "equations 1, 5-7, 34-38",
        (SIGNS,),
        "steady_turns",
    )


def _through_file(huuv: Huuv) -> ComparedTable:
    made = vehicle(parameter_file(huuv), free=("u", "v", "r"))
    turns = huuv.accepted
    commands = [{"left": float(a), "right": float(b)} for a, b in zip(turns.left, turns.right, strict=True)]
    found, _ = steady_motions(made, wrenches(made, commands))
    return ComparedTable(
        "through_file", "The same from the parameter file huuv.parameters.json", _rows(huuv, found[:, [0, 1, 5]]),
        "equations 1, 5-7, 34-38", ("Tables C_D, C_S and C_n over beta, yaw damping over r, thrusters with a dead zone.",), "steady_turns",
    )  # fmt: skip


def _skew(huuv: Huuv) -> ComparedTable:
    velocity = np.random.default_rng(SEED).normal(size=(1000, 3))
    matrices = coriolis(huuv.theta, velocity)
    rows = (
        Compared("1000 random motions", "largest |C + C^T|", "kg m/s", 0.0,
                 float(np.max(np.abs(matrices + np.swapaxes(matrices, 1, 2)))), 1e-12, Basis.CONSISTENCY),
        Compared("1000 random motions", "largest power of C nu", "W", 0.0,
                 float(np.max(np.abs(np.einsum("ni,nij,nj->n", velocity, matrices, velocity)))), 1e-12, Basis.CONSISTENCY),
    )  # fmt: skip
    return ComparedTable("coriolis", "Coriolis forces do no work", rows, "equation 1, matrix C")


def _origin(huuv: Huuv) -> ComparedTable:
    fit = tuned(huuv, MATLAB, BASE)
    rows = tuple(
        Compared("fit of seven", TOLD[n], p.unit, huuv.constants[n], p.after, 1e-3, Basis.CONSISTENCY, True)
        for n in BASE
        if (p := fit.parameter(n))
    )
    said = ", ".join(f"{q.name} {q.rms():.4f} {q.unit}" for q in fit.quantities)
    return ComparedTable(
        "origin", "Where the constants of the steady turns come from", rows, "Fig. 17 b, d, f",
        (f"Quadratic yaw damping held at 1, none linear. Root mean square: {said}; its radius does not reach 0.027 m.",),
    )  # fmt: skip


def _tuned(fit: Tuning) -> ComparedTable:
    rows = [
        Compared(
            "MATLAB",
            "thrust intercept",
            "N",
            INTERCEPT,
            -fit.parameter("intercept").after,
            EITHER_WAY,
            Basis.CONSISTENCY,
        )
    ]
    rows += [
        Compared("MATLAB", f"rms of {n}", unit, most, fit.quantity(n).rms(), 0.0, Basis.CALIBRATION, at_most=True)
        for n, (unit, most) in LIMITS.items()
    ]
    said = ", ".join(f"{q.name} {q.rms():.4f} {q.unit}" for q in fit.quantities)
    return ComparedTable(
        "tuned_matlab", "Tuned to the paper's simulation, 28 turns", tuple(rows), "Fig. 17 b, d, f",
        (f"Root mean square: {said}.", *(moved_in_words(p) for p in fit.parameters), *fit.together, *fit.statements),
    )  # fmt: skip


def _told(fit: Tuning) -> ComparedTable:
    rows = tuple(
        Compared("TRACKER", f"rms of {n}", unit, about, fit.quantity(n).rms(), ROUGHLY, Basis.CALIBRATION, True)
        for n, (unit, about) in ABOUT.items()
    )
    return ComparedTable(
        "tuned_tracker", "Tuned to the pool, 28 turns", rows, "Fig. 17 a, c, e",
        (*(moved_in_words(p) for p in fit.parameters), *fit.together, *fit.statements),
    )  # fmt: skip


def _hidden(huuv: Huuv, fit: Tuning) -> ComparedTable:
    """Held constants that the turns would not tell apart from what is free."""
    rows, said = [], []
    for name in ("m", "my", "arm"):
        found = hidden(huuv, fit, MATLAB, name)
        rows.append(
            Compared("MATLAB", f"sets that {TOLD[name]} hides in", "1", 1.0, float(len(found)), 0.0, Basis.CONSISTENCY)
        )
        said += list(found)
    both = sum("beta^3" in text and "r|r|" in text for text in fit.together)
    rows.append(
        Compared("MATLAB", "sets of M_mr (r|r|) and C_m (beta^3)", "1", 1.0, float(both), 0.0, Basis.CONSISTENCY)
    )
    return ComparedTable(
        "hidden", "What the turns do not determine", tuple(rows), "Fig. 17 b, d, f",
        (*said, "So C_S is known only up to the mass, and the yaw equation only up to the arm and m_y - m_x."),
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
            f"Equation 12: C_m (beta) of the steady turns is {c['n1'] / (c['my'] - c['mx']):.3f} times m_y - m_x. The one is "
            "fitted, the other chosen here, so that this is no comparison; it shows that C_m(beta) holds the Munk moment, see the errata.",
            "Cylinders and plates of equations 28-32: `coeflab added-mass BODY --method primitives:huuv`.",
        ),
    )  # fmt: skip


def _statements(huuv: Huuv, halves: dict[str, Tuning]) -> tuple[str, ...]:
    pairs = ", ".join(f"{TOLD[a]} with {TOLD[b]} {r:+.2f}" for a, b, r in largest_correlations(halves[MATLAB]))
    reach = max(float(np.degrees(np.nanmax(t.figures[:, 1]))) for t in huuv.turns.values())
    return (
        "m_x, m_y, m_yr, the thruster arm and the moments of inertia are chosen: the paper prints none of them.",
        f"Incidence reaches {reach:.3g} deg; the paper's tables end at 25 deg. Astern the hull is its own mirror image.",
        f"Standard errors of u, beta and radius are chosen, about what the fits leave: {_weights()}. No turn was left out.",
        f"Correlations on the MATLAB half: {pairs}.",
        "The paper scaled C_S, C_m and M_mr by 2 by hand; here they are least squares with intervals where there are any.",
    )


def _weights() -> str:
    return "; ".join(
        f"{source} {u:g} m/s, {np.degrees(beta):.2g} deg, {radius:g} m" for source, (u, beta, radius) in ERRORS.items()
    )


def _figures(huuv: Huuv, halves: dict[str, Tuning]) -> Iterator[tuple[str, Figure]]:
    for source, fit in halves.items():
        turns = huuv.turns[source]
        commands = sorted(set(turns.left.tolist()))
        member = np.searchsorted(commands, turns.left)
        groups = Groups(turns.right, "right thruster  [%]", member, tuple(f"left {c:g} %" for c in commands))
        yield f"huuv_{source}_turns", curves_figure(fit, groups, f"huuv-{source}-turns")
        yield f"huuv_{source}_agreement", agreement_figure(fit, f"huuv-{source}-agreement")
    yield "huuv_forces", forces_figure(huuv, halves)
