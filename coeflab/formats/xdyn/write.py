"""A simulation file of xdyn (lxdyn), the time-domain simulator of Sirehna and Naval Group.

The body frame is FRD with its origin at the centre of gravity, because xdyn uses the velocities of the origin with matrices
about the centre of gravity (xdyn/core/Body.cpp, calculate_state_derivatives). xdyn adds no C_A(nu) nu, so totals are
written, and the ideal fluid's products beside them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from coeflab.core.text.yaml import parse_yaml
from coeflab.core.texts import input_error
from coeflab.core.types import Array, remembered
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.core.wording import identifier, listed, one_line
from coeflab.formats.coded_thrusters import held_in_words, limits
from coeflab.formats.exported_law import (
    COURSE,
    COURSE_MEANS,
    expression,
    has_course,
    not_written,
    propulsion,
    spelt,
    written_changes,
    written_controls,
    written_terms,
)
from coeflab.formats.lacking_law import in_header
from coeflab.formats.missing_parts import missing_water
from coeflab.formats.xdyn.actuators import command_names, held_lines, limited, thrust_lines
from coeflab.formats.xdyn.expressions import settled
from coeflab.formats.xdyn.law import ADDED, BUOYANCY, DAMPING, FUNCTIONS, HERE, RIGID, THRUST, XdynBody, xdyn_body
from coeflab.law.definiteness import definiteness
from coeflab.law.force_law import ForceTerm
from coeflab.law.rigid_body import MassProperties, about_another, rigid_body_inertia
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.law.transforms import force_transfer, moved, velocity_transfer
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.parameter_file import ParameterFile

summary = "xdyn: a YAML simulation file with inertia, added mass, damping and manoeuvring expressions"
citations = ("sname1950", "fossen2011", "xdyn")
adds_coriolis = False
holds = frozenset({"hydrostatics", "thrusters", "surfaces"})
not_held, missing = not_written, missing_water

FORCES = "hydrodynamic_forces"
VISCOSITY = 1e-6
STATES = ("x", "y", "z", "u", "v", "w", "p", "q", "r", "qr", "qi", "qj", "qk")


def _names(parameters: ParameterFile) -> tuple[str, str]:
    """Body and file, as identifiers."""
    return identifier(parameters.body, {"NED", FORCES, BUOYANCY}), identifier(parameters.name)


def _weighed(parameters: ParameterFile) -> MassProperties:
    mass = parameters.mass
    if mass is None or mass.centre is None or mass.inertia_matrix is None:
        keys = ("mass", "mass.centre", "mass.inertia_matrix")
        lacking = keys if mass is None else [k for k in keys[1:] if getattr(mass, k.removeprefix("mass.")) is None]
        raise input_error("formats.no_rigid_body", column=lacking[0], lacking=listed(lacking))
    return mass


def _centre(parameters: ParameterFile) -> Array:
    """Centre of gravity from the reference point."""
    return np.array(_weighed(parameters).centre)


def _rigid(parameters: ParameterFile) -> Array:
    """Inertia about the centre of gravity, (6, 6)."""
    mass = _weighed(parameters)
    about = about_another(np.array(mass.inertia_matrix), mass.mass, np.array(mass.centre), np.zeros(3))
    return rigid_body_inertia(mass.mass, np.zeros(3), (about + about.T) / 2.0)


def _damped(t: ForceTerm, at_origin: bool) -> int:
    """The power of the damping block that takes a term: 1, 2, or 0 for none."""
    if not at_origin or t.kind != "rest" or t.term.factors[:1] == ():
        return 0
    names = {v for v, _, _ in t.term.factors}
    powers = sorted((n, a) for _, n, a in t.term.factors)
    if len(names) != 1 or not names <= set(MOTIONS):
        return 0
    return {((1, False),): 1, ((1, False), (1, True)): 2}.get(tuple(powers), 0)


def _place(group: str, name: str) -> str:
    return name + {"prime": "", "rest": "_rest", "potential": "_ideal"}[group]


def _axes(values: Sequence[float], unit: str, names: str = "xyz") -> list[str]:
    return [f"{n}: {{value: {float(v)!r}, unit: {unit}}}" for n, v in zip(names, values, strict=True)]


def _angles() -> list[str]:
    return [f"{n}: {{value: 0, unit: rad}}" for n in ("phi", "theta", "psi")]


def _block(indent: int, head: str, lines: Sequence[str]) -> list[str]:
    return [" " * indent + head, *(" " * (indent + 4) + line for line in lines)]


def _rows(matrix: Array) -> list[str]:
    return [f"row {k}: [{', '.join(repr(float(v) + 0.0) for v in row)}]" for k, row in enumerate(matrix, 1)]


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One YAML file that runs alone: straight ahead at the file's speed, without propulsion; with weight and buoyancy where
    the file states hydrostatics.

    Raises
    ------
    InputError
        No rigid-body inertia, or one whose sum with the added mass is not positive definite: xdyn does not run these.
    """
    (body, name), h = _names(parameters), parameters.hydrostatics
    offset, rigid = 0.0 - _centre(parameters), _rigid(parameters)
    water = water_inertia(parameters)
    added = moved(water.matrix, -offset)
    if definiteness(rigid + added).smallest <= 0.0:
        raise input_error("formats.inertia_not_positive")
    terms, speed = written_terms(parameters), parameters.conditions.speed
    place = np.array(parameters.reference_point.point) - offset
    dynamics = [
        *_block(0, f"{HERE}:", _axes((0.0, 0.0, 0.0), "m")),
        *_block(0, "centre of inertia:", [f"frame: {body}", *_axes((0.0, 0.0, 0.0), "m")]),
        *_block(0, f"{RIGID}:", _rows(rigid)),
        *_block(0, f"{ADDED}:", _rows(added)),
    ]
    states = ", ".join(f"'{s}({body})'" for s in STATES)
    position = [*_axes((0.0, 0.0, 0.0), "m"), *_angles()]
    lines = [
        f"# {one_line(parameters.name)}, body: {one_line(parameters.body)}",
        "# Body frame: x forward, y starboard, z down, origin at the centre of gravity;",
        f"# the mesh frame is FRD from: {one_line(parameters.reference_point.datum)}",
        f"# Totals: xdyn adds no C_A(nu) nu.{' Weight and buoyancy are not in here.' if h is None else ''}",
        *([] if parameters.thrusters else [f"# {propulsion(parameters)}"]),
        *(f"# {words}" for words in in_header(parameters)),
        *(f"# {words}; rad" for words in control_signs(parameters)),
        f"# Inertia of the water: {one_line(water.source)}",
        "rotations convention: [psi, theta', phi'']",
        "environmental constants:",
        f"    g: {{value: {STANDARD_GRAVITY if h is None else h.gravity!r}, unit: m/s^2}}",
        f"    rho: {{value: {parameters.conditions.density!r}, unit: kg/m^3}}",
        f"    nu: {{value: {parameters.conditions.viscosity or VISCOSITY!r}, unit: m^2/s}}",
        "environment models: []",
        "bodies:",
        f"  - name: {body}",
        *_block(4, "position of body frame relative to mesh:", ["frame: mesh", *_axes(place.tolist(), "m"), *_angles()]),
        *_block(4, "initial position of body frame relative to NED:", ["frame: NED", *position]),
        *_block(4, "initial velocity of body frame relative to NED:",
                [f"frame: {body}", *_axes((speed, 0.0, 0.0), "m/s", "uvw"), *_axes((0.0, 0.0, 0.0), "rad/s", "pqr")]),
        *_block(4, "dynamics:", dynamics),
        "    external forces:",
        *_restoring(parameters, body, offset),
        *_damping(terms, not offset.any()),
        *_manoeuvring(parameters, body, offset, terms),
        *_thrusters(parameters, body, offset),
        *_commands(parameters, terms),
        "output:",
        "  - format: csv",
        f"    filename: {name}.csv",
        f"    data: [t, {states}]",
    ]  # fmt: skip
    return {f"{name}.yml": ("\n".join(lines) + "\n").encode()}


def _restoring(parameters: ParameterFile, body: str, offset: Array) -> list[str]:
    """Weight, and buoyancy in the centre of buoyancy, which xdyn's own model "basic buoyancy" puts into that of gravity."""
    h = parameters.hydrostatics
    if h is None:
        return []
    at = (offset + np.array(h.centre_of_buoyancy)).tolist()
    lines = [
        f"name: {BUOYANCY}",
        *_block(0, "reference frame:", [f"frame: {body}", *_axes(at, "m"), *_angles()]),
        "commands: []",
        f"volume: {h.volume!r}",
        "B: rho*g*volume",
        "X: B*sin(theta(t))",
        "Y: 0-B*cos(theta(t))*sin(phi(t))",
        "Z: 0-B*cos(theta(t))*cos(phi(t))",
        *(f"{moment}: 0" for moment in "KMN"),
    ]
    return ["      - model: gravity", "      - model: maneuvering", *("        " + line for line in lines)]


def _damping(terms: Sequence[ForceTerm], at_origin: bool) -> list[str]:
    out = []
    for power, model in ((1, "linear damping"), (2, "quadratic damping")):
        chosen = [t for t in terms if _damped(t, at_origin) == power]
        if chosen:
            matrix = np.zeros((6, 6))
            for t in chosen:
                matrix[COMPONENTS.index(t.component), MOTIONS.index(t.term.factors[0][0])] -= t.written
            out += [f"      - model: {model}", *_block(8, f"{DAMPING}:", _rows(matrix))]
    return out


def _manoeuvring(parameters: ParameterFile, body: str, offset: Array, terms: Sequence[ForceTerm]) -> list[str]:
    """The model with every other term; its frame has its origin at the reference point."""
    selected = [t for t in terms if not _damped(t, not offset.any())]
    velocities = {m: f"{m}(t)" for m in MOTIONS}
    if offset.any():
        velocities |= {"u": "u(t) + q(t)*z_P - r(t)*y_P", "v": "v(t) + r(t)*x_P - p(t)*z_P",
                       "w": "w(t) + p(t)*y_P - q(t)*x_P"}  # fmt: skip
    scales = sorted({t.length_power for t in selected} - {0})
    lines = [
        f"name: {FORCES}",
        *_block(0, "reference frame:", [f"frame: {body}", *_axes(offset.tolist(), "m"), *_angles()]),
        f"commands: [{', '.join(written_controls(tuple(selected)))}]",
        *(f"{n}_P: {float(v)!r}" for n, v in zip("xyz", offset, strict=True) if offset.any()),
        *(f"{m}: {text}" for m, text in velocities.items()),
        "U: sqrt(u^2 + v^2 + w^2 + 1e-18)",
        *[f"course: {COURSE}  # {COURSE_MEANS}"] * has_course(selected),
        f"L: {parameters.scaling.length!r}  # {one_line(parameters.scaling.length_name)}",
        *(f"r{k}: 0.5*rho*L^{k}" for k in scales),
        *(f"{_place(t.kind, spelt(t.symbol))}: {t.written!r}" for t in selected),
        *held_lines(parameters, written_controls(tuple(selected))),
    ]
    for component in COMPONENTS:
        parts = [expression(t, _place, "^") for t in selected if t.component == component]
        text = " + ".join(parts) or "0"
        for c in limits(parameters)[0]:
            text = re.sub(rf"\b{c}\b", limited(c), text)
        lines.append(f"{component}: {text}")
    return ["      - model: maneuvering", *("        " + line for line in lines)]


def _thrusters(parameters: ParameterFile, body: str, offset: Array) -> list[str]:
    """A model with every thruster, which acts at the reference point."""
    if not parameters.thrusters:
        return []
    commands, expressions = thrust_lines(parameters)
    lines = [
        f"name: {THRUST}",
        *_block(0, "reference frame:", [f"frame: {body}", *_axes(offset.tolist(), "m"), *_angles()]),
        f"commands: [{', '.join(commands)}]",
        *expressions,
    ]
    return ["      - model: maneuvering", *("        " + line for line in lines)]


def _commands(parameters: ParameterFile, terms: tuple[ForceTerm, ...]) -> list[str]:
    """All commands at zero; those of thrusters by their own unit, which stands beside them."""
    controls = written_controls(terms)
    lines = []
    if controls:
        lines += [f"  - name: {FORCES}", "    t: [0.0]"]
        lines += [f"    {c}: {{unit: rad, values: [0.0]}}" for c in controls]
    if parameters.thrusters:
        lines += [f"  - name: {THRUST}", "    t: [0.0]"]
        for t, name in zip(parameters.thrusters, command_names(parameters), strict=True):
            lines.append(
                f"    {name}: {{unit: 1, values: [0.0]}}  # {one_line(f'{t.name}: {t.curve.command}, {t.curve.unit}')}"
            )
            if t.tilt_axis is not None:
                lines.append(f"    {name}_tilt: {{unit: rad, values: [0.0]}}")
    return ["commands:", *lines] if lines else []


def wrench(files: Mapping[str, bytes], commands: Mapping[str, Array]) -> Array:
    """(n, 6) of the thrusters about the reference point, by the file's own expressions."""
    body = _read(*next((n, c) for n, c in files.items() if n.endswith(".yml")))
    model = body.thrusters
    found = settled(model.expressions, {**body.given(model), **commands}, FUNCTIONS) if model is not None else {}
    size = len(next(iter(commands.values())))
    return np.column_stack([np.broadcast_to(found.get(c, 0.0), size) for c in COMPONENTS])


def force(files: Mapping[str, bytes], nu: Array) -> Array:
    """What xdyn's models give, by the sources named in `coeflab.formats.xdyn.law`, about the reference point.

    The reference point is the origin of the manoeuvring model's frame.
    """
    return steered_force(files, nu, np.zeros((len(nu), 3)))


def steered_force(files: Mapping[str, bytes], nu: Array, controls: Array) -> Array:
    """The same under the commands dr ds db."""
    body = _read(*next((n, c) for n, c in files.items() if n.endswith(".yml")))
    shift = body.manoeuvring[0].point - body.centre
    commands = dict(zip(CONTROLS, controls.T, strict=True))
    return np.asarray(body.force(nu @ velocity_transfer(-shift).T, commands) @ force_transfer(shift).T)


@remembered(2)  # a loss report evaluates one file at many motions
def _read(name: str, content: bytes) -> XdynBody:
    return xdyn_body(parse_yaml(content.decode(), name), name)


def added_mass(files: Mapping[str, bytes]) -> Array:
    """The added mass matrix about the centre of gravity, moved to the reference point."""
    body = _read(*next((n, c) for n, c in files.items() if n.endswith(".yml")))
    return moved(body.added, body.manoeuvring[0].point - body.centre)


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the law is written, in words."""
    centre, terms = _centre(parameters), written_terms(parameters)
    words = [
        *written_changes(
            parameters, "xdyn", "expressions ending in _ideal", "added mass about the body frame's origin"
        ),
        "velocities over the ground are used as those through the water; currents are for linear and quadratic damping only",
        *held_in_words(parameters, f"the commands of {THRUST}", rates="are not kept: an expression has no time"),
        *(() if parameters.thrusters else (propulsion(parameters),)),
    ]
    if parameters.hydrostatics is not None:
        words.append(
            f"weight as xdyn's model gravity, buoyancy as a second manoeuvring model, {BUOYANCY}, in the centre of buoyancy: both are "
            "no part of the differences in this report"
        )
    if centre.any():
        x, y, z = (f"{v:g}" for v in centre)
        words.append(
            f"the body frame has its origin at the centre of gravity, ({x}, {y}, {z}) m from the reference point; the "
            "expressions use the velocities at the reference point, and forces act there"
        )
    if any(_damped(t, not centre.any()) for t in terms):
        words.append("damping about a state of rest is written as damping matrices, with the opposite sign")
    if any(m.area is not None for m in parameters.models):
        words.append(
            "no hydrodynamic polar is written for C_D and the like: xdyn's takes C_L, C_D and C_m as functions of one angle in one "
            "plane, and would add to the expressions of the coefficients, which have no arc tangent for alpha and beta"
        )
    if parameters.conditions.viscosity is None:
        words.append(f"viscosity {VISCOSITY:g} m^2/s, which no expression uses: the file has none")
    return tuple(words)
