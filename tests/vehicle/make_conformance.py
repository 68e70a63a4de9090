"""Write the conformance vectors: ``python -m tests.vehicle.make_conformance``. Values are those of the library's own law.

Each file holds a parameter file, without what no force depends on, and states with their forces and accelerations.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import coeflab as cf
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.added_mass import AddedMass
from coeflab.law.coefficient import Status
from coeflab.law.rigid_body import MassProperties
from coeflab.law.symbols import CONTROLS, MOTIONS
from coeflab.motion.orders import lagged
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.conform import FOLDER
from coeflab.vehicle.force_law import full_force
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface, ParameterThruster
from tests.formats.massed import ADDED, torpedo, with_mass
from tests.vehicle.hybrid import hybrid, thruster
from tests.vehicle.test_force_law import HULL, parameters

UNUSED = ("measured", "law_at_points", "law_holds", "findings", "covered")
ABSENT = {"afloat": ("hydrostatics", "gravity")}
LEVEL = [1.0, 0.0, 0.0, 0.0]
HEELED = (np.array([0.96, 0.1, -0.2, 0.12]) / np.linalg.norm([0.96, 0.1, -0.2, 0.12])).tolist()
TRIANGLE = [[-1.0, 0.0, -0.4], [0.0, -1.0, -0.4], [1.0, 1.0, -0.1]]


def states(speed: float, spread: float = 1.0) -> list[dict[str, Any]]:
    """Ahead, astern, broadside, upright, at rest, turning, drifting each way; alike for every file."""
    rows = [
        [1, 0, 0, 0, 0, 0], [-1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, -1, 0, 0, 0], [0] * 6, [0, 0, 0, 0.2, -0.3, 0.4],
        [1, 0.1, -0.05, 0.1, 0.2, -0.3], [1.3, -0.35, 0.2, -0.1, 0.15, 0.25], [-0.6, 0.3, 0.25, 0.05, -0.1, 0.2],
        [0.05, 1, 0.4, 0, 0.1, -0.1], [0.7, 0.5, 0.65, 0.1, -0.2, 0.1], [-0.03, 0.5, -0.2, 0.02, 0.03, 0.04],
        [0.9, -0.02, 0.015, 0, 0.01, 0.02], [1.1, 0.42, -0.3, 0, 0, 0],
    ]  # fmt: skip
    out = [{"nu": [speed * x if i < 3 else spread * x for i, x in enumerate(row)]} for row in rows]
    return [{**s, "attitude": HEELED if k % 3 == 1 else LEVEL} for k, s in enumerate(out)]


def steered(given: list[dict[str, Any]], angles: Sequence[Sequence[float]]) -> list[dict[str, Any]]:
    """Each angle in turn, and every state without one."""
    return [{**s, "delta": list(angles[k % len(angles)])} for k, s in enumerate(given)]


def commanded(given: list[dict[str, Any]], each: Sequence[Mapping[str, float]]) -> list[dict[str, Any]]:
    """Commands of thrusters by turns."""
    return [{**s, "commands": dict(each[k % len(each)])} for k, s in enumerate(given)]


def actual_commands(file: ParameterFile, state: Mapping[str, Any]) -> dict[str, float]:
    """What thrusters do: their commands, or on the way there by their lag."""
    out = dict(state.get("commands", {}))
    for t in file.thrusters:
        if t.lag is not None and "since" in state:
            before, order = (np.array(x.get(t.name, 0.0)) for x in (state.get("before", {}), out))
            out[t.name] = float(lagged(before, order, np.array(t.lag), np.array(state["since"])))
    return out


def evaluated(file: ParameterFile, state: Mapping[str, Any]) -> dict[str, Any]:
    """What the library gives: commands beyond the limits of an actuator are held at them."""
    limits = {s.control: s.limit for s in file.surfaces}
    delta = np.array([np.clip(x, -limits.get(c, np.inf), limits.get(c, np.inf))
                      for c, x in zip(CONTROLS, state.get("delta", [0.0] * 3), strict=True)])[None]  # fmt: skip
    nu = np.array([state["nu"]], dtype=float)
    force = full_force(file)(nu, delta)[0]
    if np.any(np.isnan(force)):
        return {"force": None, "acceleration": None}
    try:
        made = vehicle(file, free=tuple(state.get("free", MOTIONS)))
    except InputError:
        return {"force": force.tolist(), "acceleration": None}
    wrench = made.wrench(actual_commands(file, state))
    rates = made.acceleration(nu, np.array([state.get("attitude", LEVEL)]), delta, wrench)[0]
    return {"force": force.tolist(), "acceleration": rates.tolist()}


def written(name: str, file: ParameterFile, rule: str, given: Sequence[Mapping[str, Any]]) -> str:
    content = json.loads(file.to_json())
    for key in UNUSED:
        content.pop(key, None)
    content |= {"law_holds": [], "covered": []}
    if name in ABSENT:
        where, key = ABSENT[name]
        del content[where][key]
    vectors = [{**s, **evaluated(file, s)} for s in given]
    parts = [f' "rules": {json.dumps(rule)}', f' "parameters": {json.dumps(content)}']
    rows = ",\n  ".join(json.dumps(v) for v in vectors)
    return "{\n" + ",\n".join(parts) + f',\n "vectors": [\n  {rows}\n ]\n}}\n'


def denser(file: ParameterFile) -> ParameterFile:
    """The file with its added mass stated for another density."""
    assert file.added_mass is not None
    kept = tuple(replace(c, potential=None) for c in file.coefficients)
    return file.model_copy(update={"added_mass": replace(file.added_mass, density=800.0), "coefficients": kept})


def model(response: str, variables: Sequence[tuple[str, str]], terms: Mapping[tuple[tuple[str, int], ...], float | None],
          low: Sequence[float], high: Sequence[float], rule: str = "clamp", **more: Any) -> ParameterModel:  # fmt: skip
    """A table on a box, or on half-spaces."""
    d = len(variables)
    box = [
        [*(float(i == k) * way for i in range(d)), -way * edge]
        for k in range(d)
        for way, edge in ((1.0, high[k]), (-1.0, low[k]))
    ]
    return ParameterModel.model_validate({
        "response": response, "unit": "1", "form": "surface", "n_points": 9, "rms": 0.0, "press_rms": None, "table": "t.csv",
        "campaign": "c", "variables": [{"name": v, "unit": u} for v, u in variables],
        "terms": [{"symbol": f"{response}_{i}", "value": x, "half_width_95": None,
                   "factors": [{"variable": v.strip("|"), "power": n, "absolute": v.startswith("|")} for v, n in factors]}
                  for i, (factors, x) in enumerate(terms.items())],
        "covariance": [[None] * len(terms)] * len(terms),
        "domain": {"low": list(low), "high": list(high), "half_spaces": more.pop("spaces", box), "extrapolation": rule}, **more,
    })  # fmt: skip


FIN = {(("alpha", 1),): 1.4, (("alpha", 3),): 2.0, (("alpha", 1), ("beta", 2)): -1.0, (("beta", 2),): 0.2, (): 0.05}
ANGLES = [[0.1, 0, 0], [0, -0.15, 0], [0, 0, 0.2], [0.6, -0.7, 0.9], [0, 0, 0]]


def cases() -> dict[str, tuple[ParameterFile, str, list[dict[str, Any]]]]:
    """Parameter file, what it is for, and its states, by name."""
    out: dict[str, tuple[ParameterFile, str, list[dict[str, Any]]]] = {}
    h = ParameterHydrostatics(volume=0.055, centre_of_buoyancy=(0.09, 0.02, -0.05), gravity=9.7)
    fins = tuple(ParameterSurface(control=c, limit=limit) for c, limit in (("dr", 0.4), ("ds", 0.35)))
    pod = ParameterThruster.model_validate({
        "name": "pod", "position": (-0.6, 0.1, 0.05), "direction": (0.8, 0.0, 0.6), "tilt_axis": (0.0, 1.0, 0.0), "tilt_low": -0.5, "tilt_high": 0.8,
        "handedness": -1,
        "curve": {"command": "speed", "unit": "rpm", "segments": [
            {"low": -900.0, "high": -80.0, "coefficients": [0.5, 0.003, -1e-5]}, {"low": 100.0, "high": 1000.0, "coefficients": [-1.0, 0.01, 2e-5]}]},
        "torque_curve": {"command": "speed", "unit": "rpm", "segments": [{"low": 0.0, "high": 1000.0, "coefficients": [0.0, 1e-4, 1e-6]}]},
    })  # fmt: skip
    whole = torpedo().model_copy(
        update={"hydrostatics": h, "surfaces": fins, "thrusters": (pod, thruster("side", 0.2))}
    )
    orders = [{"pod": 500.0, "pod.tilt": 0.3}, {"pod": -400.0}, {"pod": 5000.0, "pod.tilt": 2.0, "side": 40.0}, {"pod": 50.0, "side": 5.0},
              {"thrust": 7.0, "pod": -2000.0, "pod.tilt": -3.0}]  # fmt: skip
    out["torpedo"] = (whole, "(1) (6) (28) (29) (30) primes, ideal fluid, buoyancy, thrusters, limits",
                      [*commanded(steered(states(1.5), ANGLES), orders), {"nu": [1.5, 0.2, 0, 0, 0, 0.1], "free": "uvr"}])  # fmt: skip
    late = whole.model_copy(update={"thrusters": (pod.model_copy(update={"lag": 0.4}), thruster("side", 0.2))})
    changing = [({"pod": 600.0, "side": 20.0}, {"pod": -300.0, "side": -50.0}, 0.0), ({"pod": 600.0, "pod.tilt": 0.4}, {"pod": 150.0}, 0.2),
                ({"pod": 5000.0}, {"pod": 5000.0, "side": 9.0}, 1.0), ({"pod": -500.0}, {"pod": 5000.0}, 0.3), ({"pod": 500.0}, {}, 0.7)]  # fmt: skip
    out["lags"] = (late, "(31) a thruster on its way to a command",
                   [*({**s, "commands": c, "before": b, "since": t} for s, (c, b, t) in zip(states(1.5), changing * 3, strict=False)),
                    {**states(1.5)[0], "commands": {"pod": 500.0}}])  # fmt: skip
    remus = cf.read_vehicle("remus100").file
    out["remus100"] = remus, "(1) a published AUV", steered(states(1.5), ANGLES)
    huuv = cf.read_vehicle("huuv_5dof").file
    both = [{t.name: 40.0 + 30.0 * k for k, t in enumerate(huuv.thrusters)}, {huuv.thrusters[0].name: 75.0}]
    out["huuv_5dof"] = (huuv, "(13) (16) tables over incidence and rates, increments over a control, thrusters",
                        [{**s, "free": "uvwqr"} for s in commanded(steered(states(1.0), ANGLES), both)])  # fmt: skip
    values = {"X0": 0.0, "Yv": -0.03, "Yv|v|": -0.1, "Yvvv": -0.2, "Nur": -0.004, "Nr|r|": -0.003, "Y|v|r": 0.01, "Zww": 0.002, "Zdsds": 0.01, "K|p|p": -1e-3,
              "Xvr": 0.0, "Ydr": 0.01, "Nvdr": 0.02, "Ydr|dr|": 0.004, "Mw": 0.004, "Y0": 1e-4, "Kpdot": -3e-4, "Yrdot": 1e-3}  # fmt: skip
    light = parameters(values, HULL)
    light = light.model_copy(update={"mass": MassProperties(600.0, 30.0, 150.0).primed(light.scaling, 1000.0)})
    out["sources_of_zero"] = (light, "(2) (14) (26) a coefficient of zero is a source; mass without centre; cubes and bars",
                              [{**s, "free": "uvwqr"} for s in steered(states(1.5), ANGLES)] + states(1.5)[:2])  # fmt: skip
    still = parameters({"Xu": -0.02, "Yv": -0.03, "Yv|v|": -0.1, "Xvv": 0.01, "Nr": -0.01, "Kp": -0.001, "Zw": -0.02, "Mq": -0.01, "Z0": -1e-3},
                       HULL, law="rest")  # fmt: skip
    out["at_rest"] = with_mass(still), "(3) damping about a state of rest, SI at every speed", states(0.8)
    dense = AddedMass(ADDED, np.zeros(3), Datum("nose"), "body of tow", "panel")
    stated = {"X0": -3e-4, "Yv": -0.03, "Yvdot": -0.016, "Nvdot": 4e-4, "Yrdot": 6e-4, "Zqdot": -2e-4, "Mqdot": -7e-4}
    out["accelerations"] = (
        denser(with_mass(parameters(stated, dense))),
        "(23) (24) (25) stated accelerations in a matrix of another density",
        states(1.2),
    )
    wrong = denser(with_mass(parameters({**stated, "Nvdot": 0.03, "Yrdot": 0.03}, dense)))
    out["no_inertia"] = wrong, "(27) accelerations that leave no inertia: the computed ones", states(1.2)
    alone = with_mass(parameters({**stated, "Nvdot": 0.03, "Yrdot": 0.03, "Xudot": -1e-3, "Nrdot": -9e-4}))
    out["no_inertia_alone"] = (
        alone,
        "(27) the same without computed ones: the diagonal; no added mass, no ideal fluid",
        states(1.2),
    )
    box = ([-0.3, -0.35], [0.3, 0.35])
    angled = [("alpha", "rad"), ("beta", "rad")]
    curved = (
        model("C_D", angled, {(): 0.35, (("alpha", 2),): 1.0, (("beta", 2),): 1.1}, [-0.4, -0.4], [0.5, 0.5], spaces=TRIANGLE),
        model("C_L", angled, FIN, *box, "taper"),
        model("C_m", angled, FIN, [-0.4, -0.4], [0.5, 0.5], "taper", spaces=TRIANGLE, area={"value": 0.05, "name": "plan"}),
        model("N'", [("v", "1"), ("r", "1")], {(("v", 1),): -0.01, (("r", 1),): -0.004, (("v", 1), ("|r|", 1)): 0.01, (("r", 3),): None},
              [-0.3, -0.4], [0.3, 0.4], "taper"),
        model("K'", [("p", "1"), ("v", "1")], {(("p", 1),): -0.002, (("v", 1),): 0.001}, [-0.2, 0.1], [0.2, 0.1]),
    )  # fmt: skip
    fluid = hybrid(models=curved)
    out["domains"] = (
        fluid,
        "(17) (18) (19) (20) (22) hulls that are no boxes, clamp and taper",
        steered(states(1.5, 0.4), ANGLES),
    )
    refusing = hybrid(
        models=(
            model("C_D", angled, {(): 0.3, (("beta", 2),): 1.0}, *box, "refuse", area={"value": 0.05, "name": "plan"}),
        )
    )
    damped = model("M", [("q", "rad/s")], {(("q", 1),): -3.0}, [-0.5], [0.5], "refuse", unit="N*m")
    out["refusals"] = (refusing.model_copy(update={"models": (*refusing.models, damped)}), "(21) tables without a value outside",
                       [*states(1.5), {"nu": [0, 0, 0, 0, 0.6, 0]}, {"nu": [1, 0.1, 0, 0, 0.2, 0]}])  # fmt: skip
    aside = hybrid(
        models=(
            model(
                "C_S",
                [("beta", "rad")],
                {(("beta", 1),): -2.0, (): -0.1},
                [0.05],
                [0.4],
                "refuse",
                area={"value": 0.05, "name": "plan"},
            ),
        )
    )
    out["refusal_at_rest"] = (
        aside,
        "(21) a table by V^2 is not read without a speed",
        [*states(1.5), {"nu": [1.5, 0.3, 0, 0, 0, 0.1]}],
    )
    mixed = {"X0": -3e-4, "Xvv": 0.01, "Yv": -0.04, "Yr": 0.01, "Nv": -0.01, "Nr": -0.006, "Nvr": 0.002, "Zw": -0.03, "M0": 1e-4, "Mdb": 0.01, "Mw": 0.003,
             "Ydr": 0.01, "Kv": 0.002}  # fmt: skip
    several = (
        model("C_D", angled, {(): 0.3, (("beta", 2),): 1.0, (("alpha", 2),): 0.8}, *box, area={"value": 0.05, "name": "plan"}),
        model("C_D", [("beta", "rad")], {(): 0.4, (("beta", 2),): 1.2}, [-0.3], [0.3]),
        model("C_L", angled, {(("alpha", 1),): 1.0, (("alpha", 1), ("beta", 2)): 0.5}, *box),
        model("C_n", [("beta", "rad")], {(("beta", 1),): 0.1}, [-0.3], [0.3]),
        model("M'", [("w", "1"), ("q", "1")], {(): 1e-4, (("w", 1),): 0.004, (("q", 1),): -0.01, (("w", 1), ("q", 1)): 0.003}, [-0.3, -0.3], [0.3, 0.3]),
        model("C_m", [("alpha", "rad"), ("db", "rad")], {(("db", 1),): -0.2, (("alpha", 1), ("db", 1)): 0.3}, [-0.3, -0.3], [0.3, 0.3]),
        model("K'", [("v", "1"), ("p", "1")], {(("v", 1), ("p", 1)): 0.01}, [-0.3, -0.3], [0.3, 0.3], contains_potential=False),
        model("C_l", [("r", "1")], {(("r", 1),): 0.002}, [-0.3], [0.3], contains_potential=False),
    )  # fmt: skip
    out["overlaps"] = (hybrid(rates={}, models=several).model_copy(update={"coefficients": parameters(mixed).coefficients,
                       "covariance": parameters(mixed).covariance}), "(7) (8) (9) (10) of the same products one source speaks", steered(states(1.5, 0.5), ANGLES))  # fmt: skip
    out |= few_rules(whole)
    silent = replace(
        whole.coefficients[0], value=None, value_si=None, u95=None, potential=None, status=Status.NOT_DETERMINED
    )
    bare = whole.model_copy(
        update={"mass": None, "coefficients": (silent, *whole.coefficients[1:]), "thrusters": (), "hydrostatics": None}
    )
    out["no_mass"] = bare, "(2) no mass: forces alone; a coefficient without a value", steered(states(1.5), ANGLES)
    return out


def with_coefficients(values: Mapping[str, float], models: Sequence[ParameterModel], **more: Any) -> ParameterFile:
    """The hybrid vehicle with other coefficients and tables."""
    of = parameters(dict(values), **more)
    file = hybrid(rates={}, models=tuple(models))
    return file.model_copy(update={"coefficients": of.coefficients, "covariance": of.covariance})


def some(speed: float, spread: float = 0.5) -> list[dict[str, Any]]:
    """Half of the states."""
    return [s for k, s in enumerate(states(speed, spread)) if k in (0, 1, 2, 4, 6, 8, 11, 13)]


def few_rules(whole: ParameterFile) -> dict[str, tuple[ParameterFile, str, list[dict[str, Any]]]]:
    """Files of a rule or two each."""
    out: dict[str, tuple[ParameterFile, str, list[dict[str, Any]]]] = {}
    angled, box = [("alpha", "rad"), ("beta", "rad")], ([-0.3, -0.35], [0.3, 0.35])
    drag = model("C_D", angled, {(): 0.3, (("beta", 2),): 1.0}, *box, area={"value": 0.05, "name": "plan"})
    side = model("C_S", [("beta", "rad")], {(("beta", 1),): -1.2}, [-0.4], [0.4])
    lift = model("C_L", [("alpha", "rad")], {(("alpha", 1),): 1.2}, [-0.4], [0.4])
    planes = model(
        "C_L",
        [("alpha", "rad"), ("db", "rad")],
        {(("db", 1),): 0.8, (("alpha", 2), ("db", 1)): -0.3},
        [-0.4, -0.3],
        [0.4, 0.3],
    )
    turning = model("Y'", [("r", "1")], {(("r", 1),): 0.02}, [-0.9], [0.9])
    upwards = model("Z'", [("w", "1"), ("q", "1")], {(("w", 1),): -0.02, (("q", 1),): -0.01}, [-0.4, -0.4], [0.4, 0.4])
    steady = {"Nr": -0.01, "Mq": -0.01}
    out["turned"] = (with_coefficients({"Zw": -0.03, "Yr": 0.01, **steady}, (drag, side, lift, planes, turning)), "(8) (12): tables left out",
                     steered(some(1.5), ANGLES))  # fmt: skip
    out["along_the_body"] = (with_coefficients({"X0": -1e-3, "Xu|u|": -1e-3, "Xvv": 0.01, "Y0": 1e-4, "Zvw": 0.02, **steady}, (side, lift, planes)),
                             "(12): products that body axes speak of", steered(some(1.5), ANGLES))  # fmt: skip
    out["along_a_table"] = (
        with_coefficients(steady, (drag, upwards, planes)),
        "(12) (15): tables along the body",
        steered(some(1.5), ANGLES),
    )
    dense = AddedMass(ADDED, np.zeros(3), Datum("nose"), "body of tow", "panel", density=1000.0)
    coupled = model(
        "N'", [("v", "1"), ("r", "1")], {(("v", 1),): -0.01, (("v", 1), ("r", 1)): 0.01}, [-0.9, -0.9], [0.9, 0.9]
    )
    planes = model(
        "M'", [("w", "1"), ("db", "rad")], {(("db", 1),): -0.01, (("w", 1), ("db", 1)): 0.01}, [-0.9, -0.4], [0.9, 0.4]
    )
    closing = with_coefficients({"Yv": -0.03, "X0": -1e-3}, (coupled, planes)).model_copy(update={"added_mass": dense})
    out["closed_products"] = (
        closing,
        "(15) products without what a table needs, (16) increments",
        steered(some(1.5), ANGLES),
    )
    flow = (
        model("C_S", [("beta", "rad"), ("r", "1")], {(("beta", 1),): -1.2, (("r", 1),): 0.3, (("beta", 1), ("|r|", 1)): -0.4}, [-0.4, -0.9], [0.4, 0.9]),
        model("C_L", [("alpha", "rad"), ("q", "1")], {(("alpha", 1),): 1.1, (("q", 1),): 0.4}, [-0.4, -0.9], [0.4, 0.9]),
    )  # fmt: skip
    out["flow_axes"] = (
        with_coefficients({**steady, "Xvv": -0.01}, flow).model_copy(update={"added_mass": dense}),
        "(12) (15) tables along the flow over rates: closed in the components that they act in",
        steered(some(1.5), ANGLES),
    )
    rest = {
        "Mw": 0.004,
        "Yv": -0.03,
        "Nvr": 0.002,
        "Xvr": 0.0,
        "Zwdb": -0.02,
        "Yvdr": 0.01,
        "Xdrdr": -0.002,
        "Yrdot": 0.0,
        "Zqdot": 0.0,
    }
    out["products_at_rest"] = (
        with_coefficients(rest, (), law="rest").model_copy(update={"added_mass": dense}),
        "(14) of damping at rest, accelerations of zero", steered(some(1.5), ANGLES),
    )  # fmt: skip
    plain = {(("dr", 1),): 0.02}
    edges = (
        model("N'", [("beta", "rad"), ("dr", "rad")], plain, [-0.4, -0.4], [0.5, 0.5], spaces=TRIANGLE),
        model("K'", [("p", "1"), ("v", "1")], {(("p", 1),): -0.002, (("v", 1), ("p", 1)): 0.01}, [-0.2, 0.1], [0.2, 0.1], "taper"),
        model("M", [("u", "m/s"), ("w", "m/s")], {(): 0.5, (("w", 1),): 1.0}, [-3.0, -1.0], [3.0, 1.0], "refuse", unit="N*m"),
        model("X", [("u", "m/s")], {(("u", 1), ("|u|", 1)): -2.0}, [-4.0], [4.0], unit="N"),
        model("Y'", [("v", "1"), ("p", "1")], {(("p", 1),): None}, [-0.9, -0.35], [0.9, 0.35], "refuse"),
    )  # fmt: skip
    beyond = [{"nu": [3.0 + x, 0.1, 0, 0, 0, 0]} for x in (2e-9, 4e-9)] + [
        {"nu": [1.5, 0.1, 0, x, 0, 0]} for x in (0.2, 0.4)
    ]
    out["edges"] = (with_coefficients({"Xdr": -0.002, "Xdrdr": -0.01}, edges), "domains: unused and undetermined variables, none of a width, their edges",
                    [*steered(some(1.0, 0.1), ANGLES), *beyond])  # fmt: skip
    wide = (model("Z", [("alpha", "rad")], {(("alpha", 1),): 3.0}, [-4.0], [4.0], unit="N"),
            model("K", [("beta", "rad")], {(("beta", 1),): 2.0}, [-4.0], [4.0], unit="N*m"))  # fmt: skip
    slow = [
        {"nu": [-0.0, 0, 0, 0, 0, 0]},
        {"nu": [-1e-10, 3e-10, -0.0, 0, 0, 1e-4]},
        {"nu": [0, 5e-10, 0, 0, 0, 1e-4]},
        {"nu": [-1, 0, -0.0, 0, 0, 0]},
    ]
    out["slow"] = (
        with_coefficients({"Nr": -0.01, "Nrrr": -0.01}, wide),
        "(5) (11): next to rest, zeros below zero",
        [*some(1.0, 1e-4), *slow],
    )
    light = MassProperties(600.0, 30.0, 150.0)
    free = [{**s, "free": "uvwqr"} for s in some(1.2)]
    for name, values, rule in (
        ("no_diagonal", {"X0": -3e-4, "Yv": -0.03, "Yvdot": 0.01, "Nrdot": -9e-4}, "(27) a diagonal below zero and no matrix: no accelerations"),
        ("unknown_roll", {"X0": -3e-4, "Yv": -0.03, "Yvdot": -0.016, "Nrdot": -9e-4, "Yrdot": 6e-4, "Kvdot": 5e-4}, "(27) without the inertia of roll"),
    ):  # fmt: skip
        file = parameters(values)
        out[name] = file.model_copy(update={"mass": light.primed(file.scaling, 1000.0)}), rule, free
    bow = thruster("bow", 0.1).model_dump()
    bow["curve"]["segments"] = [
        {"low": 0.0, "high": 10.0, "coefficients": [0.0, 1.0]},
        {"low": 10.0, "high": 90.0, "coefficients": [20.0, 1.0]},
    ]
    afloat = {"hydrostatics": whole.hydrostatics.model_copy(update={"gravity": STANDARD_GRAVITY}),
              "thrusters": (ParameterThruster.model_validate(bow),)}  # fmt: skip
    out["afloat"] = (
        whole.model_copy(update=afloat),
        "standard gravity, (29) a command on two segments",
        commanded(some(1.5), [{"bow": 10.0}, {"bow": 95.0}]),
    )
    return out


def main() -> None:
    """Write them all."""
    for name, (file, rule, given) in cases().items():
        (Path(FOLDER) / f"{name}.json").write_text(written(name, file, rule, given), encoding="utf-8")


if __name__ == "__main__":
    main()
