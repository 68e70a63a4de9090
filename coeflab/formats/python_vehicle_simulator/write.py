"""A vehicle class in the manner of Fossen's Python Vehicle Simulator, which needs numpy alone.

The simulator's loop (src/python_vehicle_simulator/lib/mainLoop.py, simulate()) calls ``stepInput(t)`` and
``dynamics(eta, nu, u_actual, u_control, sampleTime)`` and reads ``name L controlDescription controlMode nu u_actual
controls dimU``; currents and the Euler step are those of vehicles/remus100.py, dynamics().
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from importlib.resources import files as resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.text.bounded import own_text
from coeflab.core.wording import identifier, one_line, python
from coeflab.formats.coded_tables import coded_tables, law_of_tables
from coeflab.formats.coded_thrusters import coded_thrusters, command_names, held_in_words, limits, read_angle
from coeflab.formats.exported_law import (
    COURSE,
    COURSE_MEANS,
    expression,
    has_course,
    not_written,
    spelt,
    written_accelerations,
    written_changes,
    written_controls,
    written_terms,
)
from coeflab.formats.lacking_law import in_header
from coeflab.formats.missing_parts import missing_mass, missing_water
from coeflab.law.force_law import ForceLaw, ForceTerm
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.inertia import centre_of_gravity
from coeflab.vehicle.parameter_file import ParameterFile

summary = "Python Vehicle Simulator: a vehicle class with dynamics(), its law in SNAME coefficients"
citations = ("sname1950", "fossen2011", "python_vehicle_simulator")
adds_coriolis = False
holds = frozenset({"hydrostatics", "tables", "thrusters", "surfaces", "rates", "lags"})

not_held = not_written

UNLIMITED = 1e300
GRAVITY = 9.81  # m/s^2, as in the simulator's own vehicles (vehicles/otter.py)
_PLACES = {"prime": "self.", "rest": "self.rest_", "potential": "self.ideal_"}
_HEADINGS = {
    "prime": "Primed by rho and L: totals, potential part included",
    "rest": "Damping about a state of rest, SI, not scaled with U",
    "potential": "Primed products of the ideal fluid, -C_A(nu) nu, that no coefficient above covers",
}
_VECTOR = ("rudder (rad)", "stern plane (rad)", "bow plane (rad)", "thrust (N)")


def _own(name: str) -> str:
    """A part of the class file."""
    return own_text(resources("coeflab.formats.python_vehicle_simulator") / f"{name}.py.txt")


def _place(group: str, name: str) -> str:
    return _PLACES[group] + name


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One class file; class and file bear the parameter file's name as an identifier."""
    name = identifier(parameters.name, python())
    terms, h = written_terms(parameters), parameters.hydrostatics
    accelerations, source = written_accelerations(parameters)
    p, mass = parameters, parameters.mass
    commands, (largest, turning) = command_names(parameters), limits(parameters)
    lags = {4 + k: t.lag for k, t in enumerate(p.thrusters) if t.lag is not None}
    exceptions = ["limits and rates of angles"] * bool(largest) + ["lags of thrusters"] * bool(lags)
    point = ", ".join(f"{x:g}" for x in p.reference_point.point)
    lines = [
        "#!/usr/bin/env python3",
        f"# {name}.py: {one_line(p.name)}, body: {one_line(p.body)}",
        f"# Primes by {one_line(p.scaling.length_name)}; reference point ({point}) m, x forward, y starboard, z down, "
        f"from: {one_line(p.reference_point.datum)}",
        *(f"# {words}" for words in in_header(p, tables=True)),
        _own("head").format(
            name=name,
            m=None if mass is None else mass.mass,
            moments=_moments(parameters),
            products=_products(parameters),
            centre=tuple(float(x) for x in centre_of_gravity(parameters)),
            gravity=GRAVITY if h is None else h.gravity,
            buoyancy=None if h is None else tuple(map(float, h.centre_of_buoyancy)),
            volume=None if h is None else h.volume,
            controls="".join(f"\n    {words}" for words in control_signs(p)),
            vector=", ".join((*_VECTOR, *commands)).replace("\\", "/").replace('"', "'"),
            labels="".join(f", {c!r}" for c in commands),
            kept=f" but for {' and '.join(exceptions)}" if exceptions else "",
        ),
        f"        self.name = {one_line(p.name)!r}",
        f"        self.rho = {p.conditions.density!r}  # kg/m^3",
        f"        self.L = {p.scaling.length!r}  # length of the primes (m)",
        f"        self.U0 = {p.conditions.speed!r}  # speed of the tests (m/s)",
        "        self.nu_0 = np.array([self.U0, 0, 0, 0, 0, 0], float)",
        "        self.nu = self.nu_0.copy()",
    ]
    for group, heading in _HEADINGS.items():
        chosen = [t for t in terms if t.kind == group]
        if chosen:
            lines += ["", f"        # {heading}"]
            lines += [
                f"        {_place(group, spelt(t.symbol))} = {t.written!r}" + (f"  # {t.note}" if t.note else "")
                for t in chosen
            ]
    lines += ["", f"        # Acceleration derivatives, primed: {one_line(source)}"]
    lines += [f"        self.{name} = {value!r}" for name, value in accelerations.items()]
    lines += [f"        self.limit_{c} = {x!r}  # rad" for c, x in largest.items()]
    if commands:
        for member, rows in zip(("thrusters", "segments"), coded_thrusters(parameters), strict=True):
            lines += [f"        self.{member} = ["] + [f"            {r!r}," for r in rows] + ["        ]"]
    tables, wind = coded_tables(parameters)
    if tables:
        lines += [
            "",
            "        # Fitted tables, as tabled() reads them",
            f"        self.speaks = {wind!r}",
            "        self.tables = [",
        ]
        lines += [f"            {t!r}," for t in tables] + ["        ]"]
    angles = [(largest.get(c, UNLIMITED), turning.get(c, UNLIMITED)) for c in CONTROLS]
    tail = (
        _own("tail")
        .replace("@DRIVEN@", "\n        tau += driven(self.thrusters, self.segments, u_actual[4:])" if commands else "")
        .replace(
            "@ACTUAL@", "self.turned(u_actual, u_control, sampleTime)" if exceptions else "np.array(u_control, float)"
        )
        .replace("@ZEROS@", ", 0.0" * len(commands))
    )
    lines += [*_added_mass(accelerations), *_force(terms, bool(tables), largest), tail.rstrip()]
    if exceptions:
        lines.append(_own("turned").format(angles=angles, lags=lags).rstrip())
    if commands:
        lines.append(_own("driven").rstrip())
    if tables:
        lines.append(_own("tables").rstrip())
    return {f"{name}.py": ("\n".join(lines) + "\n").encode()}


def _moments(parameters: ParameterFile) -> tuple[float | None, ...]:
    """Ix, Iy, Iz about the reference point, None where the file states none."""
    mass = parameters.mass
    if mass is None or mass.inertia_matrix is None:
        transverse = None if mass is None else mass.inertia
        return None, transverse, transverse
    return tuple(mass.inertia_matrix.diagonal().tolist())


def _products(parameters: ParameterFile) -> tuple[float, ...]:
    mass = parameters.mass
    matrix = None if mass is None else mass.inertia_matrix
    return (0.0, 0.0, 0.0) if matrix is None else tuple(float(matrix[i][j]) for i, j in ((0, 1), (0, 2), (1, 2)))


def _scales(powers: set[int]) -> list[str]:
    return [f"        r{k} = 0.5 * self.rho * self.L**{k}" for k in sorted(powers) if k]


def _added_mass(accelerations: Mapping[str, float]) -> list[str]:
    lines = _scales({powers_of(a)[1] for a in accelerations})
    lines.append("        self.MA = -np.array([")
    for component in COMPONENTS:
        names = [f"{component}{motion}dot" for motion in MOTIONS]
        cells = (f"r{powers_of(n)[1]} * self.{n}" if n in accelerations else "0.0" for n in names)
        lines.append(f"            [{', '.join(cells)}],")
    return [*lines, "        ])"]


def _force(terms: tuple[ForceTerm, ...], tabled: bool, largest: Mapping[str, float]) -> list[str]:
    lines = [
        "",
        "    def hydrodynamics(self, nu, delta=(0.0, 0.0, 0.0)):",
        '        """X Y Z K M N of the water on the body (N, N m) for u v w p q r and control angles dr ds db (rad).',
        "",
        "        It contains -C_A(nu) nu already, the Munk moment in Nv and Mw: m2c(MA, nu) must not be added.",
        '        """',
        *(f"        {name} = nu[{k}]" for k, name in enumerate(MOTIONS)),
        *(
            f"        {c} = {read_angle(c, f'delta[{k}]', 'self.', c in largest)}"
            for k, c in enumerate(CONTROLS)
            if c in written_controls(terms) or tabled
        ),
        "        U = max((u**2 + v**2 + w**2) ** 0.5, 1e-9)",
        *[f"        course = {COURSE}  # {COURSE_MEANS}"] * has_course(terms),
        *_scales({t.length_power for t in terms}),
    ]
    for component in COMPONENTS:
        parts = [expression(t, _place, "**") for t in terms if t.component == component] or ["0.0"]
        lines += [f"        {component} = (", *(f"            {'+ ' if i else ''}{p}" for i, p in enumerate(parts))]
        lines.append("        )")
    more = " + tabled(self.tables, self.speaks, nu, (dr, ds, db))" if tabled else ""
    return [*lines, f"        return np.array([{', '.join(COMPONENTS)}], float){more}"]


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """What ``hydrodynamics`` returns, read from the class without running it, with zero control angles."""
    return steered_force(files, nu, np.zeros((len(nu), 3)))


def steered_force(
    files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same under control angles."""
    methods, numbers = _read(files)
    names = {**numbers, "nu": list(nu.T), "delta": list(controls.T)}
    for node in methods["hydrodynamics"].body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            names[node.targets[0].id] = _value(node.value, names)
    out = np.column_stack([np.broadcast_to(np.asarray(names[c], dtype=np.float64), len(nu)) for c in COMPONENTS])
    tables = _read_tables(methods["__init__"])
    if tables is None:
        return out
    return out + tables.force(nu, np.column_stack([np.broadcast_to(names[c], len(nu)) for c in CONTROLS]))


def _read_tables(constructor: ast.FunctionDef) -> ForceLaw | None:
    """The law of the tables that a constructor sets; None without."""
    found = {
        node.targets[0].attr: node.value
        for node in constructor.body
        if isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Attribute)
        and node.targets[0].attr in ("tables", "speaks")
    }
    if not found:
        return None
    return law_of_tables(ast.literal_eval(found["tables"]), ast.literal_eval(found["speaks"]))


def added_mass(files: Mapping[str, bytes]) -> NDArray[np.float64]:
    """``MA`` of the class, read without running it."""
    methods, names = _read(files)
    for node in methods["__init__"].body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                names[name] = _value(value, names)
            case ast.Assign(
                targets=[ast.Attribute(attr="MA")],
                value=ast.UnaryOp(op=ast.USub(), operand=ast.Call(args=[ast.List(elts=rows)])),
            ):
                return -np.array([[_value(e, names) for e in row.elts] for row in rows if isinstance(row, ast.List)])
    raise ValueError("no self.MA in the class")


def _read(files: Mapping[str, bytes]) -> tuple[dict[str, ast.FunctionDef], dict[str, Any]]:
    """Methods of the class by name, and the numbers that its constructor sets."""
    tree = ast.parse(next(content for name, content in files.items() if name.endswith(".py")))
    vehicle = next(n for n in tree.body if isinstance(n, ast.ClassDef))
    methods = {n.name: n for n in vehicle.body if isinstance(n, ast.FunctionDef)}
    names: dict[str, Any] = {}
    for node in methods["__init__"].body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute) and _is_number(node.value):
            names[f"self.{node.targets[0].attr}"] = ast.literal_eval(node.value)
    return methods, names


def _is_number(node: ast.expr) -> bool:
    inner = node.operand if isinstance(node, ast.UnaryOp) else node
    return isinstance(inner, ast.Constant) and isinstance(inner.value, float)


def _value(node: ast.expr, names: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name):
            return names[name]
        case ast.Attribute(value=ast.Name(id=owner), attr=attribute):
            return names[f"{owner}.{attribute}"]
        case ast.Subscript(value=ast.Name(id=name), slice=ast.Constant(value=int(k))):
            return names[name][k]
        case ast.Call(func=ast.Name(id="max"), args=[first, second]):
            return np.maximum(_value(first, names), _value(second, names))
        case ast.Call(func=ast.Name(id="min"), args=[first, second]):
            return np.minimum(_value(first, names), _value(second, names))
        case ast.UnaryOp(op=ast.USub(), operand=first):
            return -_value(first, names)
        case ast.Call(func=ast.Name(id="abs"), args=[first]):
            return np.abs(_value(first, names))
        case ast.BinOp(left=left, op=sign, right=right):
            a, b = _value(left, names), _value(right, names)
            if isinstance(sign, ast.Sub):
                return a - b
            return a + b if isinstance(sign, ast.Add) else a * b if isinstance(sign, ast.Mult) else (
                a / b if isinstance(sign, ast.Div) else a**b
            )  # fmt: skip
    raise ValueError(ast.dump(node))


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass, moments of inertia and added mass, where the file has none."""
    asks = "dynamics() asks for m, and holds rotations without a moment of inertia"
    return (*missing_mass(parameters, asks, "roll is held"), *missing_water(parameters))


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the law is written, in words."""
    return (
        *written_changes(parameters, "the class (as remus100.py, which zeroes its Munk terms)", "ideal_*", "MA"),
        *held_in_words(parameters, "u_control[4:]", rates="are kept in dynamics()"),
        "weight and buoyancy are equal and act at one point until r_bb is given: the file states no buoyancy"
        if parameters.hydrostatics is None
        else "weight and buoyancy, r_bb and volume, act in dynamics(), not in hydrodynamics(); GRAVITY is the file's",
    )
