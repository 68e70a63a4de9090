"""Thrusters of a Stonefish scenario, as their rotor comes to its speed and as thrust follows from that.

Thruster.cpp, ActuatorDynamics.h and ScenarioParser.cpp, commit b21eb8e: a setpoint of at most <max_setpoint>, rad/s, goes through
<rotor_dynamics>, then through <thrust_model>. Before 2024: <specs thrust_coeff torque_coeff max_rpm>, at rest K_T rho D^4 n|n| along +x and
K_Q rho D^5 n|n| against it, n in 1/s, under a speed controller.
"""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.xml import numbers
from coeflab.core.wording import one_line
from coeflab.formats.left_out import left_out
from coeflab.formats.rotor_curves import Pieces, held, lines, per_command, rotor, squares
from coeflab.law.transforms import rotation
from coeflab.vehicle.parameter_parts import ParameterThruster

ROTORS = ("zero_order", "first_order", "mechanical_pi")  # whose setpoint is a speed
TURN = 2.0 * math.pi
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")


class Driven(NamedTuple):
    """Thrusters, and findings about what is left out."""

    thrusters: tuple[ParameterThruster, ...]
    findings: tuple[Finding, ...]


class _Unknown(ValueError):  # noqa: N818 - never leaves this file
    """An actuator whose law is not known here, or whose numbers the file does not state."""


def thrusters_of(robot: Element, density: float, subject: str, path: Path) -> Driven:
    """The thrusters of a robot.

    Parameters
    ----------
    robot : Element
    density : float
        kg/m^3.
    subject : str
        Whom the findings are about.
    path : path

    Raises
    ------
    InputError
        A number that is none.
    """
    out: dict[str, ParameterThruster] = {}
    rotors: list[str] = []
    watered: dict[float, list[str]] = {}
    unread: list[str] = []
    base = robot.find("base_link")
    hull = "" if base is None else base.get("name", "")
    for actuator in robot.iter("actuator"):
        name = one_line(actuator.get("name", "actuator"))[:100]
        try:
            found = None if name in out else _thruster(actuator, hull, name, density, rotors, watered, path)
        except _Unknown:
            found = None
        if found is None:
            unread.append(f"{actuator.get('type', 'actuator')} {name}")
        else:
            out[name] = found
    findings = [
        *left_out(subject, "actuators", unread),
        *left_out(subject, "rotors", rotors),
        *(
            Finding.of("model.open_water", subject, Severity.WARN, names=tuple(names), value=value)
            for value, names in watered.items()
        ),
    ]
    return Driven(tuple(out.values()), tuple(findings))


def _thruster(
    actuator: Element, hull: str, name: str, density: float, rotors: list[str], watered: dict[float, list[str]], path: Path
) -> ParameterThruster | None:  # fmt: skip
    specs, propeller, link = (actuator.find(tag) for tag in ("specs", "propeller", "link"))
    elsewhere = link is not None and link.get("name") != hull
    if actuator.get("type") != "thruster" or specs is None or propeller is None or elsewhere:
        raise _Unknown
    origin = actuator.find("origin")
    texts = ("0 0 0", "0 0 0") if origin is None else (origin.get("xyz", "0 0 0"), origin.get("rpy", "0 0 0"))
    at, angles = (np.array(numbers(_arithmetic(t), (3,), "origin", path)) for t in texts)
    along = rotation(*angles)[:, 0]
    right = propeller.get("right", "true").strip().lower() in ("true", "1")
    diameter = _number(propeller, "diameter", path)
    if actuator.find("thrust_model") is None:
        if not right or specs.get("inverted", "false").strip().lower() == "true" or specs.get("thrust_coeff_backward"):
            raise _Unknown
        value, most = _number(specs, "thrust_coeff", path), abs(_number(specs, "max_rpm", path))
        per = density * diameter**4 / 3600.0
        turning = -per * diameter * (_number(specs, "torque_coeff", path) if specs.get("torque_coeff") else 0.0)
        rotors.append(f"speed controller of {name}")
        watered.setdefault(value, []).append(name)
        thrust, torque = (held(squares(k, k), -most, most) for k in (value * per, turning))
        return rotor(name, at, along, thrust, torque if turning else (), unit="rpm")
    lag = _lag(actuator, name, rotors, path)
    thrust, torque = _model(actuator, density, diameter, right, path)
    if torque:
        watered.setdefault(_number(actuator.find("thrust_model/thrust_coeff"), "forward", path), []).append(name)
    most = abs(_number(specs, "max_setpoint", path))
    way = -1.0 if specs.get("inverted_setpoint", "false").strip().lower() in ("true", "1") else 1.0
    thrust, torque = (per_command(held(p, -most, most), way) for p in (thrust, torque))
    return rotor(name, at, along, thrust, torque, lag=lag)


def _lag(actuator: Element, name: str, rotors: list[str], path: Path) -> float | None:
    """Time constant, s; None of a rotor that is at its speed at once, or, which is named, comes there otherwise."""
    dynamics = actuator.find("rotor_dynamics")
    kind = "" if dynamics is None else dynamics.get("type", "")
    if kind not in ROTORS:
        raise _Unknown
    if kind == "first_order":
        found = _number(actuator.find("rotor_dynamics/time_constant"), "value", path)
        return found if found > 0.0 else None
    if kind != "zero_order":
        rotors.append(f"{kind} of {name}")
    return None


def _model(actuator: Element, density: float, diameter: float, right: bool, path: Path) -> tuple[Pieces, Pieces]:
    """Thrust along +x and torque on the vehicle about it, over the rotor's speed in rad/s."""
    model = actuator.find("thrust_model")
    kind = "" if model is None else model.get("type", "")
    way = 1.0 if right else -1.0

    def of(tag: str, attribute: str = "value") -> float:
        return _number(None if model is None else model.find(tag), attribute, path)

    match kind:
        case "quadratic":
            plain = squares(*(of("thrust_coeff"),) * 2)
        case "deadband":
            dead = of("deadband", "lower"), of("deadband", "upper")
            if not dead[0] <= 0.0 <= dead[1]:
                raise _Unknown
            plain = squares(of("thrust_coeff", "reverse"), of("thrust_coeff", "forward"), dead)
        case "linear_interpolation":
            speeds, values = (_texts(model, tag, path) for tag in ("input", "output"))
            if len(speeds) != len(values) or len(speeds) < 2 or any(a >= b for a, b in pairwise(speeds)):
                raise _Unknown
            plain = lines(speeds, values)
        case "fluid_dynamics":
            per = density * diameter**4 / TURN**2
            sides = of("thrust_coeff", "reverse"), of("thrust_coeff", "forward")
            below, above = sides if right else sides[::-1]
            ahead = squares(way * per * below, way * per * above)
            about = -per * diameter * of("torque_coeff")
            return ahead, squares(about, about)
        case _:
            raise _Unknown
    return per_command(plain, 1.0, way), ()


def _texts(model: Element | None, tag: str, path: Path) -> tuple[float, ...]:
    element = None if model is None else model.find(tag)
    words = "" if element is None else element.get("value", "")
    return numbers(words, (len(words.split()) or 1,), tag, path)


def _arithmetic(text: str) -> str:
    """With every ${...} computed.

    Raises
    ------
    _Unknown
        A name that only another file states.
    """
    try:
        plain = _EXPRESSION.sub(lambda m: repr(float(evaluate(m[1].replace("**", "^"), {"pi": math.pi}))), text)
    except ArithmeticProblem:
        raise _Unknown from None
    if "$" in plain:
        raise _Unknown
    return plain


def _number(element: Element | None, name: str, path: Path) -> float:
    text = None if element is None else element.get(name)
    if text is None:
        raise _Unknown
    return numbers(_arithmetic(text), (1,), name, path)[0]
