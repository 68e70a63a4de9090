"""One body of an xdyn YAML file, and the hydrodynamic force that xdyn computes from it.

Sources of the law, github.com/naval-group/lxdyn (xdyn 26.8): xdyn/core/Sim.cpp, sum_of_forces (the rigid body's Coriolis
terms and the force models, nothing from the added mass); xdyn/core/Body.cpp, calculate_state_derivatives (the states u v w
are used with matrices about the centre of gravity); xdyn/core/ForceModel.cpp, operator() (every force moves to the centre
of gravity); xdyn/force_models/ManeuveringForceModel.cpp, get_force (ground velocities; the force acts at the origin of the
model's own frame); DampingForceModel.cpp, get_force and LinearDampingForceModel.cpp, QuadraticDampingForceModel.cpp
(-D nu and -D |nu| nu at the hydrodynamic forces calculation point).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import bounded_number
from coeflab.core.text.yaml import number
from coeflab.core.types import Array, brief, locked
from coeflab.formats.xdyn.expressions import settled
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.law.transforms import force_transfer

RIGID = "rigid body inertia matrix at the center of gravity and projected in the body frame"
ADDED = "added mass matrix at the center of gravity and projected in the body frame"
DAMPING = "damping matrix at the center of gravity projected in the body frame"
HERE = "hydrodynamic forces calculation point in body frame"
BUOYANCY, THRUST = "buoyancy", "thrusters"  # models of our own beside the one of the hull
FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "abs": np.abs, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "cos": np.cos, "sin": np.sin,
}  # fmt: skip
POWERS = {"linear damping": 1, "quadratic damping": 2}
UNITS = {"m": 1.0, "m/s": 1.0, "rad/s": 1.0, "rad": 1.0, "kg/m^3": 1.0, "m/s^2": 1.0, "ft": 0.3048, "knot": 1852.0 / 3600.0,
         "km/h": 1.0 / 3.6, "deg": np.pi / 180.0, "deg/s": np.pi / 180.0}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Manoeuvring:
    """A ``maneuvering`` model: expressions by name, the point (3,) where its force acts, and its commands."""

    point: Array
    expressions: Mapping[str, str]
    commands: tuple[str, ...]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class XdynBody:
    """A body with its hydrodynamic models; points are from the origin of the body frame, m, FRD.

    Attributes
    ----------
    name : str
    density : float
        kg/m^3.
    speed : float
        Initial u, m/s.
    centre, damping_point : (3,) array
        Centre of gravity; where damping forces act.
    mesh : (3,) array or None
        Origin of the body frame in the mesh's frame; None where that is turned.
    rigid : (6, 6) array or None
        About the centre of gravity; None where the file has none, which xdyn itself refuses.
    added : (6, 6) array
        About the centre of gravity.
    manoeuvring : tuple of Manoeuvring
    damping : tuple of (power, (6, 6) array)
        Power 1 or 2, matrices positive.
    left_out : tuple of str
        Names of the other force models, the manoeuvring model ``buoyancy`` among them.
    unread : tuple of str
        Keys of the state at the start, of waves and the like that are not zero.
    thrusters : Manoeuvring or None
        The manoeuvring model of that name, which no force is read of.
    """

    name: str
    density: float
    speed: float
    centre: Array
    damping_point: Array
    mesh: Array | None
    rigid: Array | None
    added: Array
    manoeuvring: tuple[Manoeuvring, ...]
    damping: tuple[tuple[int, Array], ...]
    left_out: tuple[str, ...]
    unread: tuple[str, ...] = ()
    thrusters: Manoeuvring | None = None

    def __post_init__(self) -> None:
        for name in ("centre", "damping_point", "mesh", "rigid", "added"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    def given(self, model: Manoeuvring) -> dict[str, Any]:
        """What expressions may use beside their own keys: constants, with every command at zero."""
        return {"rho": self.density, "t": 0.0, **dict.fromkeys(model.commands, 0.0)}

    def force(self, nu: Array, commands: Mapping[str, Array] | None = None) -> Array:
        """Hydrodynamic force and moment about the centre of gravity, (n, 6), for velocities (n, 6) there.

        Parameters
        ----------
        nu : (n, 6) array
        commands : mapping of name to (n,) array, optional
            Of those that a model has; zero unless given.
        """
        out = np.zeros_like(nu)
        states: dict[str, Callable[..., Any]] = {m: partial(_state, nu[:, j]) for j, m in enumerate(MOTIONS)}
        functions: dict[str, Callable[..., Any]] = {**states, **FUNCTIONS}
        for model in self.manoeuvring:
            moved = {name: x for name, x in (commands or {}).items() if name in model.commands}
            found = settled(model.expressions, {**self.given(model), **moved}, functions)
            at_point = np.column_stack([np.broadcast_to(found[c], len(nu)) for c in COMPONENTS])
            out += at_point @ force_transfer(self.centre - model.point).T
        for power, matrix in self.damping:
            motion = nu if power == 1 else np.abs(nu) * nu
            out -= motion @ matrix.T @ force_transfer(self.centre - self.damping_point).T
        return out


def _state(column: Array, _time: Any) -> Array:
    return column


class Reading:
    """The content of an xdyn file, read by keys; every complaint names file and key."""

    def __init__(self, content: Mapping[str, Any], file: Path | str) -> None:
        self.content, self.file = content, file

    def fail(self, found: str, expected: str, key: str, advice: str = "") -> InputError:
        """An error about one key, to be raised by the caller."""
        return InputError(found, expected, file=self.file, column=key, advice=advice)

    def mapping(self, parent: Mapping[str, Any], key: str) -> Mapping[str, Any]:
        """A sub-mapping."""
        found = parent.get(key)
        if not isinstance(found, dict):
            raise self.fail("nothing" if found is None else shown(found), "keys and values", key)
        return found

    def measured(self, parent: Mapping[str, Any], key: str) -> float:
        """``{value: 1, unit: m}`` in SI."""
        found = self.mapping(parent, key)
        value, unit = number(found.get("value")), str(found.get("unit"))
        if value is None or bounded_number(value) or unit not in UNITS:
            raise self.fail(shown(found), f"{{value: number, unit: one of {', '.join(UNITS)}}}", key)
        return value * UNITS[unit]

    def point(self, parent: Mapping[str, Any], key: str) -> Array:
        """The point x y z of a sub-mapping."""
        found = self.mapping(parent, key)
        return np.array([self.measured(found, axis) for axis in "xyz"])

    def matrix(self, parent: Mapping[str, Any], key: str) -> Array:
        """``row 1`` to ``row 6`` of a sub-mapping."""
        found = self.mapping(parent, key)
        rows = []
        for k in range(1, 7):
            row = found.get(f"row {k}")
            values = [number(v) for v in row] if isinstance(row, list) else []
            if len(values) != 6 or any(v is None or bounded_number(v) for v in values):
                raise self.fail(shown(row), "six numbers", f"row {k} of the {key}")
            rows.append(values)
        return np.array(rows, dtype=np.float64)


def xdyn_body(content: Mapping[str, Any], file: Path | str) -> XdynBody:
    """The one body of a file.

    Raises
    ------
    InputError
        Anything missing or of the wrong kind; several bodies; a manoeuvring frame that is turned or not the body's.
    """
    reading = Reading(content, file)
    bodies = content.get("bodies")
    if not isinstance(bodies, list) or len(bodies) != 1 or not isinstance(bodies[0], dict):
        count = len(bodies) if isinstance(bodies, list) else "no"
        raise reading.fail(f"{count} bodies", "one body", "bodies")
    body = bodies[0]
    dynamics = reading.mapping(body, "dynamics")
    models = body.get("external forces") or []
    models = [*models, *(body.get("controlled forces") or [])] if isinstance(models, list) else []
    if not all(isinstance(m, dict) and isinstance(m.get("model"), str) for m in models):
        raise reading.fail("a force without a model", "model: name", "external forces")
    shaped = [m for m in models if m["model"] == "maneuvering" and m.get("name") not in (BUOYANCY, THRUST)]
    named = str(body.get("name"))
    place = body.get("position of body frame relative to mesh")
    return XdynBody(
        name=named,
        density=reading.measured(reading.mapping(content, "environmental constants"), "rho"),
        speed=reading.measured(reading.mapping(body, "initial velocity of body frame relative to NED"), "u"),
        centre=reading.point(dynamics, "centre of inertia"),
        damping_point=reading.point(dynamics, HERE),
        mesh=None if not isinstance(place, dict) or _turned(reading, place) else
        reading.point(body, "position of body frame relative to mesh"),
        rigid=reading.matrix(dynamics, RIGID) if RIGID in dynamics else None,
        added=reading.matrix(dynamics, ADDED),
        manoeuvring=tuple(_manoeuvring(reading, m, named) for m in shaped),
        damping=tuple((POWERS[m["model"]], reading.matrix(m, DAMPING)) for m in models if m["model"] in POWERS),
        left_out=tuple(
            str(m["name"]) if m["model"] == "maneuvering" else m["model"] for m in models
            if m not in shaped and m["model"] not in POWERS
        ),
        unread=_unread(content, body),
        thrusters=next((_manoeuvring(reading, m, named) for m in models if m["model"] == "maneuvering" and m.get("name") == THRUST), None),
    )  # fmt: skip


def _unread(content: Mapping[str, Any], body: Mapping[str, Any]) -> tuple[str, ...]:
    """What else moves the body: waves and wind, the state at the start beside u, blocked motions."""
    environment = content.get("environment models") or []
    named = [m for m in environment if isinstance(m, dict)] if isinstance(environment, list) else []
    out = [str(m.get("model")) for m in named if m.get("model") != "no waves"]
    velocity = body.get("initial velocity of body frame relative to NED")
    for key in "vwpqr" if isinstance(velocity, dict) else "":
        value = velocity.get(key) if isinstance(velocity, dict) else None
        if isinstance(value, dict) and number(value.get("value")) not in (None, 0.0):
            out.append(f"{key} at the start")
    return (*out, *(k for k in ("blocked dof", "filtered states") if body.get(k)))


def _turned(reading: Reading, frame: Mapping[str, Any]) -> bool:
    return any(reading.measured(frame, angle) != 0.0 for angle in ("phi", "theta", "psi"))


def _manoeuvring(reading: Reading, model: Mapping[str, Any], body: str) -> Manoeuvring:
    frame = reading.mapping(model, "reference frame")
    if str(frame.get("frame")) != body or _turned(reading, frame):
        raise reading.fail(shown(frame), f"the frame of {body}, not turned", "reference frame")
    skipped = ("model", "name", "commands", "reference frame")
    expressions = {str(k): v for k, v in model.items() if k not in skipped}
    wrong = next((k for k, v in expressions.items() if isinstance(v, (dict, list, bool)) or v is None), None)
    missing = [c for c in COMPONENTS if c not in expressions]
    if wrong is not None or missing:
        raise reading.fail(f"no expression for {wrong or missing[0]}", "X Y Z K M N as expressions", "maneuvering")
    commands = model.get("commands") or []
    if not isinstance(commands, list):
        raise reading.fail(shown(commands), "a list of names", "commands")
    written = {k: repr(v) if isinstance(v, float) else str(v) for k, v in expressions.items()}
    return Manoeuvring(reading.point(model, "reference frame"), written, tuple(map(str, commands)))
