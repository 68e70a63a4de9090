"""HUUV: coefficients tuned to the printed turns, and which held constants the turns could not tell apart from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from coeflab.core.texts import remark
from coeflab.core.types import Array
from coeflab.identify.output_error import Estimate, estimate, examine
from coeflab.identify.output_problem import Problem, problem
from coeflab.identify.tuning import (
    TunedQuantity,
    Tuning,
    driving,
    moved_in_words,
    statements,
    together_in_words,
    tuned_parameters,
)
from coeflab.motion.steady_turns import COEFFICIENTS, sensitivities, steady_turns, turn_figures
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, Turns, thrust, thrust_rates
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Basis, ComparedTable

PAPER = publication("huuv")

NAMES = (*COEFFICIENTS, "slope", "intercept", "arm")
AT_SLOPE = len(COEFFICIENTS)
BASE = ("intercept", "d0", "d2", "s1", "s3", "n1", "n3")
FREE = (*BASE, "nr", "nrr")
UNITS = {
    **dict.fromkeys(("m", "mx", "my"), "kg"), "myr": "kg m", "nr": "N m s", "nrr": "N m s^2", "intercept": "N", "arm": "m",
    **dict.fromkeys(("d0", "d2", "s1", "s3"), "kg/m"), **dict.fromkeys(("n1", "n3"), "kg"),
}  # fmt: skip
IN_WORDS = {
    "m": "mass m", "my": "added mass m_y", "arm": "thruster arm y_ct", "intercept": "thrust intercept",
    "d0": "drag C_D (constant)", "d2": "drag C_D (beta^2)", "s1": "side force C_S (beta)", "s3": "side force C_S (beta^3)",
    "n1": "yaw moment C_m (beta)", "n3": "yaw moment C_m (beta^3)", "nr": "yaw rate term M_mr (r)",
    "nrr": "yaw rate term M_mr (r|r|)",
}  # fmt: skip
DAMPING = ("nr", "nrr")  # the equations take them off: a negative one drives
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
    parameters = tuned_parameters(free, [UNITS[n] for n in free], p, found)
    drives = [
        driving(replace(one, after=-one.after, name=IN_WORDS[one.name]), source)
        for one in parameters
        if one.name in DAMPING
    ]
    words = (*statements(p, found), *(remark(f) for f in drives if f is not None))
    return Tuning(
        f"huuv_{source}", parameters, found.correlation, found.covariance,
        _quantities(p, found), tuple(together_in_words([IN_WORDS[n] for n in free], c, found.parameters) for c in found.undetermined),
        found.singular, found.birge, found.freedom, found.converged, words,
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
    names = [IN_WORDS[n] for n in free]
    return tuple(together_in_words(names, c, p.start) for c in found.undetermined if c[-1] != 0.0)


LIMITS = {"u": ("m/s", 0.007), "beta": ("deg", 0.40), "radius": ("m", 0.027)}
ABOUT = {"u": ("m/s", 0.063), "beta": ("deg", 1.1), "radius": ("m", 0.14)}
INTERCEPT = 2.30


def origin_rows(huuv: Huuv) -> ComparedTable:
    """The constants of the steady turns, fitted again."""
    fit = tuned(huuv, MATLAB, BASE)
    rows = tuple(
        Row("fit of seven", IN_WORDS[n], p.unit, huuv.constants[n], p.after) for n in BASE if (p := fit.parameter(n))
    )
    return PAPER.table("origin", rows, **_facts(fit))


def _facts(fit: Tuning) -> dict[str, object]:
    """What texts on a fit name: how far it leaves the turns, what moved, what goes together, what else it states."""
    rms = ", ".join(f"{q.name} {q.rms():.4f} {q.unit}" for q in fit.quantities)
    moved = [moved_in_words(p) for p in fit.parameters]
    return {"words": rms, "moved": moved, "together": fit.together, "statements": fit.statements}


def tuned_rows(fit: Tuning) -> ComparedTable:
    """What the fit to the paper's simulation leaves, and its thrust intercept."""
    rows = [Row("MATLAB", "thrust intercept", "N", INTERCEPT, -fit.parameter("intercept").after)]
    rows += [
        Row("MATLAB", f"rms of {n}", unit, most, fit.quantity(n).rms(), 0.0, basis=Basis.CALIBRATION, at_most=True)
        for n, (unit, most) in LIMITS.items()
    ]
    return PAPER.table("tuned_matlab", rows, **_facts(fit))


def pool_rows(fit: Tuning) -> ComparedTable:
    """What the fit to the pool leaves."""
    rows = tuple(
        Row("TRACKER", f"rms of {n}", unit, about, fit.quantity(n).rms()) for n, (unit, about) in ABOUT.items()
    )
    return PAPER.table("tuned_tracker", rows, **_facts(fit))


NEAR = 70.0  # per cent: turns with no more on the right are fitted, the others predicted
# What an independent fit of seven leaves of the paper's simulation, as rms.
AHEAD = {"u": 0.011, "beta": 0.79, "radius": 0.049}


def predicted(huuv: Huuv, source: str, start: Array | None = None) -> Array:
    """(12, 3) errors of u in m/s, drift in deg and radius in m: seven numbers fitted to the turns with the right thruster at `NEAR` or less, held to the others.

    Parameters
    ----------
    huuv : Huuv
    source : str
        Which half of Fig. 17.
    start : (16,) array, optional
        Of the fit; the shipped constants, which saw all turns of the simulation, unless given.
    """
    turns, whole = huuv.turns[source], (start_of(huuv) if start is None else start).copy()
    near, far = (
        Turns(turns.left[rows], turns.right[rows], turns.figures[rows])
        for rows in (turns.right <= NEAR, turns.right > NEAR)
    )
    whole[[NAMES.index(n) for n in BASE]] = estimate(
        turning_problem(huuv, near, ERRORS[source], BASE, whole)
    ).parameters
    ahead = turning_problem(huuv, far, ERRORS[source], BASE, whole)
    errors = (ahead.outputs(ahead.start) - ahead.measured).reshape(-1, len(QUANTITIES))
    return np.asarray(errors * [factor for _, _, factor in QUANTITIES])


def predicted_rows(huuv: Huuv) -> ComparedTable:
    """Twelve turns that the fit has not seen, by their root mean square."""
    rms = {source: np.sqrt(np.mean(predicted(huuv, source) ** 2, axis=0)) for source in (MATLAB, TRACKER)}
    rows = tuple(
        Row("MATLAB", f"rms of {name}", unit, AHEAD[name], float(x))
        for (name, unit, _), x in zip(QUANTITIES, rms[MATLAB], strict=True)
    )
    pool = ", ".join(f"{name} {x:.2g} {unit}" for (name, unit, _), x in zip(QUANTITIES, rms[TRACKER], strict=True))
    return PAPER.table("out_of_sample", rows, near=NEAR, pool=pool)


def hidden_rows(huuv: Huuv, fit: Tuning) -> ComparedTable:
    """Held constants that the turns would not tell apart from what is free."""
    rows, words = [], []
    for name in ("m", "my", "arm"):
        found = hidden(huuv, fit, MATLAB, name)
        rows.append(Row("MATLAB", f"sets that {IN_WORDS[name]} hides in", "1", 1.0, float(len(found))))
        words += list(found)
    both = sum("beta^3" in text and "r|r|" in text for text in fit.together)
    rows.append(Row("MATLAB", "sets of M_mr (r|r|) and C_m (beta^3)", "1", 1.0, float(both)))
    return PAPER.table("hidden", rows, words=words)
