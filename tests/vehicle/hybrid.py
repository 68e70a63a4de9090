"""A hybrid vehicle whose force is stated by three kinds of sources, and its turns by equations of their own.

C_D, C_S, C_L, C_m and C_n over incidence, by an area; terms over rates of turn; two thrusters. The truth uses no part of coeflab.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import fsolve

from coeflab.core.axes import Datum
from coeflab.law.added_mass import AddedMass
from coeflab.law.rigid_body import MassProperties
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from coeflab.vehicle.parameter_parts import ParameterThruster
from tests.vehicle.test_force_law import parameters

RHO, LENGTH, AREA, MASS, SPEED, ARM = 1000.0, 2.0, 0.045, 36.0, 1.5, 0.15
REACH = np.radians(25.0)
ADDED = np.diag([2.0, 31.0, 28.0, 0.02, 3.1, 2.9])
DRAG = {(): 0.35, (("alpha", 2),): 1.0, (("beta", 2),): 1.1}
SIDE = {(("beta", 1),): -2.2, (("beta", 3),): -4.0}
LIFT = {(("alpha", 1),): 1.4, (("alpha", 3),): 2.0}
PITCH = {(("alpha", 1),): 0.35, (("alpha", 3),): -0.2}
YAW = {(("beta", 1),): 0.06, (("beta", 3),): 0.3}
Y_R, N_R, N_RR = 2.0 / 0.8, -0.6 / 0.8, -3.0  # by V r, V r and r|r|
Z_Q, M_Q, M_QQ = -2.0 / 0.8, -0.7 / 0.8, -3.5
RATES = {"Yr": Y_R, "Nr": N_R, "Nr|r|": N_RR, "Zq": Z_Q, "Mq": M_Q, "Mq|q|": M_QQ}


def surface(response: str, terms: dict[Any, float], rule: str = "refuse", **more: Any) -> ParameterModel:
    """A table over alpha and beta on the box within 25 deg, or within other half spaces."""
    spaces = [[1.0, 0.0, -REACH], [-1.0, 0.0, -REACH], [0.0, 1.0, -REACH], [0.0, -1.0, -REACH]]
    return ParameterModel.model_validate({
        "response": response, "unit": "1", "form": "surface", "n_points": 66, "rms": 0.0, "press_rms": None, "table": "static.csv",
        "campaign": "static", "area": {"value": AREA, "name": "frontal"},
        "variables": [{"name": v, "unit": "rad"} for v in ("alpha", "beta")],
        "terms": [
            {"symbol": f"{response}_{i}", "value": value, "half_width_95": None,
             "factors": [{"variable": v, "power": n} for v, n in factors]}
            for i, (factors, value) in enumerate(terms.items())
        ],
        "covariance": [[None] * len(terms)] * len(terms),
        "domain": {"low": [-REACH] * 2, "high": [REACH] * 2, "half_spaces": more.pop("spaces", spaces), "extrapolation": rule},
        **more,
    })  # fmt: skip


def tables(rule: str = "refuse", **more: Any) -> tuple[ParameterModel, ...]:
    """All five."""
    named = {"C_D": DRAG, "C_S": SIDE, "C_L": LIFT, "C_m": PITCH, "C_n": YAW}
    return tuple(surface(name, terms, rule, **more) for name, terms in named.items())


def thruster(name: str, y: float) -> ParameterThruster:
    """None below 10 %, then a third of a newton a per cent."""
    curve = {
        "command": "share",
        "unit": "%",
        "segments": [
            {"low": 0.0, "high": 10.0, "coefficients": [0.0]},
            {"low": 10.0, "high": 100.0, "coefficients": [-10.0 / 3.0, 1.0 / 3.0]},
        ],
    }
    return ParameterThruster.model_validate(
        {"name": name, "position": (-0.5, y, 0.0), "direction": (1.0, 0.0, 0.0), "curve": curve}
    )


def hybrid(rates: dict[str, float] | None = None, models: tuple[ParameterModel, ...] | None = None) -> ParameterFile:
    """The vehicle; ``rates`` in SI at 1 m/s."""
    unit = {
        "Y": 0.5 * RHO * LENGTH**3,
        "Z": 0.5 * RHO * LENGTH**3,
        "N": 0.5 * RHO * LENGTH**4,
        "M": 0.5 * RHO * LENGTH**4,
    }
    given = RATES if rates is None else rates
    primes = {s: value / (0.5 * RHO * LENGTH**5 if "|" in s else unit[s[0]]) for s, value in given.items()}
    bare = parameters(primes)
    hull = AddedMass(ADDED, np.zeros(3), Datum("nose"), bare.body, "ellipsoid", density=RHO)
    mass = MassProperties(MASS, 0.0, 3.6, np.zeros(3), np.diag([0.25, 3.6, 3.6])).primed(bare.scaling, RHO)
    both = (thruster("left", -ARM), thruster("right", ARM))
    return bare.model_copy(
        update={"models": tables() if models is None else models, "added_mass": hull, "mass": mass, "thrusters": both}
    )


def thrust(share: float) -> float:
    """N of one thruster."""
    return 0.0 if share < 10.0 else (share - 10.0) / 3.0


def turn(left: float, right: float) -> np.ndarray:
    """u, v, r of the steady turn, the cross term X_vr of the added mass accounted for."""

    def balance(x: np.ndarray) -> list[float]:
        u, v, r = x
        speed, b = np.hypot(u, v), np.arctan2(v, u)
        q = 0.5 * RHO * speed**2 * AREA
        drag, side = q * (0.35 + 1.1 * b * b), -q * (2.2 * b + 4.0 * b**3)
        ahead, aside = thrust(left), thrust(right)
        x_force = ahead + aside - np.cos(b) * drag - np.sin(b) * side + (MASS + ADDED[1, 1]) * v * r
        y_force = -np.sin(b) * drag + np.cos(b) * side + Y_R * r * speed - MASS * u * r
        moment = q * LENGTH * (0.06 * b + 0.3 * b**3) + N_R * r * speed + N_RR * r * abs(r) + ARM * (ahead - aside)
        return [x_force, y_force, moment]

    away = 1.0 if left > right else -1.0
    found, _, ok, why = fsolve(balance, (1.4, -0.1 * away, 0.3 * away), full_output=True, xtol=1e-12)
    assert ok == 1, why
    return np.asarray(found)
