"""HUUV: steady turns of a vehicle steered by two thrusters, and coefficients tuned to its printed turns.

HUUV: coefficients tuned to the printed turns, and which held constants the turns could not tell apart from them.

HUUV: drag, side force and yaw moment over sideslip, as worked out and as tuned to both halves of Fig. 17.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

import numpy as np

from coeflab.bodies.closed_forms import plate_coefficient
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.motion.marching import idle, integrated_forces
from coeflab.motion.steady_state import (
    COEFFICIENTS,
    INERTIAL,
    SteadyTurns,
    features,
    kirchhoff,
    run,
    sensitivities,
    steady_motions,
    steady_turns,
    turn_figures,
    wrenches,
)
from coeflab.motion.tune.output_error import Estimate, Problem, estimate, examine, problem
from coeflab.motion.tune.tuning import (
    TunedQuantity,
    Tuning,
    largest_correlations,
    moved_in_words,
    statements,
    together_in_words,
    tuned_parameters,
)
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, Turns, parameter_file, read_huuv, thrust, thrust_rates
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, Trace, laws_figure
from coeflab.report.figures.tuning import Groups, agreement_figure, curves_figure
from coeflab.vehicle.parameter_file import ParameterFile

NAMES = (*COEFFICIENTS, "slope", "intercept", "arm")
AT_SLOPE = len(COEFFICIENTS)
BASE = ("intercept", "d0", "d2", "s1", "s3", "n1", "n3")
FREE = (*BASE, "nr", "nrr")
UNITS = {
    **dict.fromkeys(("m", "mx", "my"), "kg"), "myr": "kg m", "nr": "N m s", "nrr": "N m s^2", "intercept": "N", "arm": "m",
    **dict.fromkeys(("d0", "d2", "s1", "s3"), "kg/m"), **dict.fromkeys(("n1", "n3"), "kg"),
}  # fmt: skip
TOLD = {
    "m": "mass m", "my": "added mass m_y", "arm": "thruster arm y_ct", "intercept": "thrust intercept",
    "d0": "drag C_D (constant)", "d2": "drag C_D (beta^2)", "s1": "side force C_S (beta)", "s3": "side force C_S (beta^3)",
    "n1": "yaw moment C_m (beta)", "n3": "yaw moment C_m (beta^3)", "nr": "yaw damping M_mr (r)",
    "nrr": "yaw damping M_mr (r|r|)",
}  # fmt: skip
LEAST = {"d2": 20.0, "s3": 100.0, "n3": 30.0, "nr": 0.1, "nrr": 1.0}
QUANTITIES = (("u", "m/s", 1.0), ("beta", "deg", 180.0 / np.pi), ("radius", "m", 1.0))
ERRORS = {"matlab": (0.01, np.radians(0.3), 0.02), "tracker": (0.06, np.radians(1.1), 0.14)}


def turning_problem(huuv: Huuv, turns: Turns, errors: Sequence[float], free: Sequence[str], start: Array) -> Problem:
    """Turns as outputs of the free parameters, with exact derivatives.

    Parameters
    ----------
    huuv : Huuv
    turns : Turns
    errors : sequence of float
        Standard errors of u, beta in rad and radius.
    free : sequence of str
        Some of `NAMES`.
    start : (16,) array
        Values of all `NAMES`.
    """
    at = [NAMES.index(name) for name in free]

    @lru_cache(maxsize=4)  # the derivatives are wanted where the outputs were just computed
    def settled_at(parameters: tuple[float, ...]) -> tuple[Array, tuple[float, float, float], Array]:
        whole = start.copy()
        whole[at] = parameters
        propulsion = (float(whole[AT_SLOPE]), float(whole[AT_SLOPE + 1]), float(whole[AT_SLOPE + 2]))
        wrench = thrust(turns.left, turns.right, *propulsion, huuv.dead_zone)
        return whole[:AT_SLOPE], propulsion, steady_turns(whole[:AT_SLOPE], wrench).velocity

    def operating(parameters: Array) -> tuple[Array, tuple[float, float, float], Array]:
        return settled_at(tuple(parameters.tolist()))

    def model(sets: Array) -> Array:
        return np.array([turn_figures(operating(one)[2])[0].ravel() for one in sets])

    def jacobian(parameters: Array) -> Array:
        theta, propulsion, velocity = operating(parameters)
        by_theta, by_thrust = sensitivities(theta, velocity)
        by_propulsion = by_thrust @ thrust_rates(turns.left, turns.right, *propulsion, huuv.dead_zone)
        moves = turn_figures(velocity)[1] @ np.concatenate([by_theta, by_propulsion], axis=-1)
        return np.asarray(moves.reshape(-1, len(NAMES))[:, at])

    sizes = np.array([max(abs(start[i]), LEAST.get(name, 1e-9)) for i, name in zip(at, free, strict=True)])
    weights = np.tile(errors, len(turns.left))
    return problem(model, turns.figures.ravel(), weights, start[at], sizes=sizes, jacobian=jacobian)


def start_of(huuv: Huuv) -> Array:
    """(16,) the shipped constants in the order of `NAMES`."""
    return np.array([huuv.constants[name] for name in NAMES])


def tuned(huuv: Huuv, source: str, free: Sequence[str] = FREE, errors: Sequence[float] | None = None) -> Tuning:
    """The fit to one half of Fig. 17, from the shipped constants."""
    turns = huuv.turns[source]
    p = turning_problem(huuv, turns, errors or ERRORS[source], free, start_of(huuv))
    found = estimate(p)
    return Tuning(
        f"huuv_{source}", tuned_parameters(free, [UNITS[n] for n in free], p, found), found.correlation, found.covariance,
        _quantities(p, found), tuple(together_in_words([TOLD[n] for n in free], c, found.parameters) for c in found.undetermined),
        found.singular, found.birge, found.freedom, found.converged, statements(p, found),
    )  # fmt: skip


def _quantities(p: Problem, found: Estimate) -> tuple[TunedQuantity, ...]:
    before, after = (p.outputs(x).reshape(-1, 3) for x in (p.start, found.parameters))
    measured, errors = p.measured.reshape(-1, 3), p.errors.reshape(-1, 3)
    return tuple(
        TunedQuantity(name, unit, *(factor * a[:, k] for a in (measured, before, after, errors)))
        for k, (name, unit, factor) in enumerate(QUANTITIES)
    )


def hidden(huuv: Huuv, tuning: Tuning, source: str, constant: str) -> tuple[str, ...]:
    """What the turns would leave open if one held constant were free too, in words; only what names that constant."""
    whole = start_of(huuv)
    for one in tuning.parameters:
        whole[NAMES.index(one.name)] = one.after
    # M_mr (r|r|) and C_m (beta^3) hide each other in any case, so that one of them is enough here.
    free = [p.name for p in tuning.parameters if p.name != "nrr"] + [constant]
    p = turning_problem(huuv, huuv.turns[source], ERRORS[source], free, whole)
    found = examine(p, p.start)
    names = [TOLD[n] for n in free]
    return tuple(together_in_words(names, c, p.start) for c in found.undetermined if c[-1] != 0.0)


FINE = 57
LAWS = (
    ("drag / V^2  [N/(m/s)^2]", ("d0", "d2"), (0, 2)),
    ("side force / V^2  [N/(m/s)^2]", ("s1", "s3"), (1, 3)),
    ("yaw moment / V^2  [N m/(m/s)^2]", ("n1", "n3"), (1, 3)),
)
CAPTION = (
    "Constants of the steady turns, and the two fits to Fig. 17, each as far as its turns reach: {reach}. All turns are to port; the "
    "other side is their mirror image. Where turns do not determine a coefficient the curve is one of many that fit them: {open}. "
    "C_S is known only up to the mass, C_m only up to the arm and m_y - m_x. The paper draws C_D over "
    "alpha and beta in Fig. 12 without printing numbers, and all turns lie at alpha = 0: the data allow these curves and no drag "
    "surface."
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
    reach = f"{ends[MATLAB]:.3g} deg in the simulation, {ends[TRACKER]:.3g} deg in the pool"
    return laws_figure(
        "huuv-forces", "Drag, side force and yaw moment over sideslip", CAPTION.format(reach=reach, open=_open(halves)),
        "Three panels over sideslip: even curves of drag, odd curves of side force and yaw moment, for three sets of constants.",
        plots,
    )  # fmt: skip


def _open(halves: Mapping[str, Tuning]) -> str:
    """What has no interval, of both fits."""
    told = {MATLAB: "simulation", TRACKER: "pool"}
    drawn = {key for _, keys, _ in LAWS for key in keys}
    return "; ".join(
        f"{told[source]}: {listed([TOLD[p.name] for p in fit.parameters if p.name in drawn and p.u95 is None])}"
        for source, fit in halves.items()
        if any(p.name in drawn and p.u95 is None for p in fit.parameters)
    )


def _values(huuv: Huuv, fit: Tuning) -> dict[str, float]:
    return dict(huuv.constants) | {p.name: p.after for p in fit.parameters}


def _law(constants: Mapping[str, float], keys: tuple[str, str], powers: tuple[int, int], beta: Array) -> Array:
    x = np.radians(beta)
    return np.asarray(sum(constants[k] * x**n for k, n in zip(keys, powers, strict=True)))


ACCEPTED, LASTS, SEED = 1e-3, 120.0, 20251105
LIMITS = {"u": ("m/s", 0.007), "beta": ("deg", 0.40), "radius": ("m", 0.027)}
ABOUT = {"u": ("m/s", 0.063), "beta": ("deg", 1.1), "radius": ("m", 0.14)}
ROUGHLY = 0.1
MOTIONS, EXACT, FINEST = 1000, 1e-9, 1e-10  # no finer than that, so that every machine says the same
EQUATION_34, AHEAD, ASTERN, LENGTH = (1.9096, 0.1389), 0.1654, (-20.0, -100.0), 0.75
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
    file = parameter_file(huuv)
    halves = {source: tuned(huuv, source) for source in (MATLAB, TRACKER)}
    return Acceptance(
        "huuv",
        "HUUV: steady turns under two thrusters, and coefficients tuned to the printed turns",
        (
            *turned(huuv, file),
            _simulated(huuv),
            _origin(huuv),
            _tuned(halves[MATLAB]),
            _told(halves[TRACKER]),
            _hidden(huuv, halves[MATLAB]),
        ),
        huuv.errata,
        _statements(huuv, halves),
        ("huuv2025",),
        tuple(_figures(huuv, halves)),
        CONVENTIONS,
        (file,),
    )


def turned(huuv: Huuv, file: ParameterFile) -> tuple[ComparedTable, ...]:
    """What needs neither a motion in time nor a fit to Fig. 17."""
    return (
        _solved(huuv),
        _through_file(huuv, file),
        _sides(huuv, file),
        _coriolis(huuv, file),
        _equations(huuv),
        _thrusters(file),
        _bounds(huuv),
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


def _by_file(huuv: Huuv, file: ParameterFile) -> Array:
    """(n, 6) velocities that the vehicle of the parameter file settles at."""
    made, turns = vehicle(file, free=("u", "v", "r")), huuv.accepted
    commands = [{"left": float(a), "right": float(b)} for a, b in zip(turns.left, turns.right, strict=True)]
    return steady_motions(made, wrenches(made, commands))[0]


def _through_file(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    return ComparedTable(
        "through_file", "The same from the parameter file huuv.parameters.json", _rows(huuv, _by_file(huuv, file)[:, [0, 1, 5]]),
        "equations 1, 5-7, 34-38", ("Tables C_D, C_S and C_n over beta, yaw damping over r, thrusters with a dead zone.",), "steady_turns",
    )  # fmt: skip


def _sides(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """Sizes alone would not notice a turn to the other side."""
    turning = huuv.accepted.right > huuv.accepted.left
    solved = steady_turns(huuv.theta, _wrench(huuv, huuv.accepted)).velocity
    rows = tuple(
        Compared(where, "turns to port, v to starboard", "1", float(np.sum(turning)),
                 float(np.sum(turning & (v > 0.0) & (r < 0.0))), 0.0, Basis.CONSISTENCY)
        for where, (v, r) in (("equations", solved[:, 1:].T), ("parameter file", _by_file(huuv, file)[:, [1, 5]].T))
    )  # fmt: skip
    return ComparedTable("sides", "Which side a larger right thruster turns to", rows, "equation 38, FLU", (SIGNS,))


def _coriolis(huuv: Huuv, file: ParameterFile) -> ComparedTable:
    """The products of velocities in the forces that are integrated, of the equations and of the parameter file."""
    velocity = np.random.default_rng(SEED).normal(size=(MOTIONS, 3))
    inertial = features(velocity)[0][:, :, INERTIAL] @ huuv.theta[INERTIAL]
    moved = idle(vehicle(file, free=("u", "v", "r")))
    nu, level = np.zeros((MOTIONS, 6)), np.tile((1.0, 0.0, 0.0, 0.0), (MOTIONS, 1))
    nu[:, [0, 1, 5]] = velocity
    integrated = integrated_forces(moved, nu, level, np.zeros((MOTIONS, 6)))[..., [0, 1, 5]]
    theory = kirchhoff(huuv.theta, velocity)
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


def _thrusters(file: ParameterFile) -> ComparedTable:
    """Both branches of equation 34 through the file, and the arms with equation 38's sign in FRD."""
    rows = []
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
