"""HUUV: coefficients tuned to the printed turns, and which held constants the turns could not tell apart from them.

HUUV: drag, side force and yaw moment over sideslip, as worked out and as tuned to both halves of Fig. 17.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np

from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.motion.steady_state import COEFFICIENTS, sensitivities, steady_turns, turn_figures
from coeflab.motion.tune.output_error import Estimate, Problem, estimate, examine, problem
from coeflab.motion.tune.tuning import TunedQuantity, Tuning, statements, together_in_words, tuned_parameters
from coeflab.published.huuv.model import MATLAB, TRACKER, Huuv, Turns, thrust, thrust_rates
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, Trace, laws_figure

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
