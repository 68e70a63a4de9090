"""A MATLAB or Octave function in the manner of the vehicle models of the Marine Systems Simulator (MSS).

Coefficients stand in a struct ``h`` under their SNAME names, primed as in MSS VESSELS/npsauv.m (constants r2 ... r5 and
section "Parameters, hydrodynamic derivatives and main dimensions"); the struct, and ``a`` for absolute values, are those of
VESSELS/navalvessel.m (section "Vessel Data").
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files as resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.arithmetic import evaluate
from coeflab.core.text.bounded import own_text
from coeflab.core.wording import identifier, matlab, one_line
from coeflab.formats.coded_tables import KEYS, coded_tables, law_of_tables
from coeflab.formats.coded_thrusters import coded_thrusters, command_names, held_in_words, limits, read_angle
from coeflab.formats.exported_law import (
    COURSE,
    COURSE_MEANS,
    expression,
    has_course,
    not_written,
    propulsion,
    spelt,
    written_accelerations,
    written_changes,
    written_controls,
    written_terms,
)
from coeflab.formats.lacking_law import in_header, unstated
from coeflab.formats.missing_parts import missing_water
from coeflab.formats.mss.assignments import TABLED, assignments, own_part
from coeflab.law.force_law import ForceLaw, ForceTerm
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.parameter_file import ParameterFile

summary = "MSS: a MATLAB or Octave function of force and added mass, with a struct of SNAME coefficients"
citations = ("sname1950", "fossen2011", "mss")
adds_coriolis = False
holds = frozenset({"hydrostatics", "tables", "thrusters", "surfaces"})
not_held, missing = not_written, missing_water

# Names of the function that no vehicle may have.
OWN = frozenset((
    *["nu", "delta", "command", "tau", "tabled", "held", "tables", "driven", "curve", "thrusters", "h", "MA", "U", "course"], *MOTIONS, *COMPONENTS, *CONTROLS,
))  # fmt: skip
_PLACES = {"prime": "h.", "rest": "h.rest.", "potential": "h.ideal."}
_HEADINGS = {
    "prime": "Primed by rho and L: totals, potential part included",
    "rest": "Damping about a state of rest, SI, not scaled with U",
    "potential": "Primed products of the ideal fluid, -C_A(nu)*nu, that no coefficient above covers",
}


_NAMES = {
    "mass": "h.m",
    "mass.centre": "h.xG h.yG h.zG",
    "mass.inertia_matrix": "h.I11 ... h.I33",
    "hydrostatics": "h.volume h.g h.xB h.yB h.zB",
}


def _quoted(text: str) -> str:
    return "'" + one_line(text).replace("'", "''") + "'"


def _place(group: str, name: str) -> str:
    return _PLACES[group] + name


def _head(function: str, parameters: ParameterFile) -> list[str]:
    commands = command_names(parameters)
    call = f"[tau, MA, h] = {function}(nu, delta{', command' if commands else ''})"
    return [
        f"function {call}",
        f"% {call} returns the force of the water on a body",
        "% in steady motion, and its added mass. Plain MATLAB language; runs in GNU Octave.",
        "%",
        f"%   {one_line(parameters.name)}, body: {one_line(parameters.body)}",
        "%",
        "%   nu    = [ u v w p q r ]'  velocity through the water at the reference point (m/s, rad/s)",
        "%   delta = [ dr ds db ]'     rudder, stern plane, bow plane (rad), zero if not given",
        *(f"%                             {words}" for words in control_signs(parameters)),
        *(f"%   command({k}) = {words}, zero if not given" for k, words in enumerate(commands, 1)),
        "%   tau   = [ X Y Z K M N ]'  force and moment about the reference point (N, N m)",
        "%   MA    = added mass matrix about the reference point, positive (kg, kg m, kg m^2)",
        "%   h     = struct of the coefficients",
        "%",
        "% Axes: x forward, y starboard, z down. Equations of motion with rigid-body MRB and CRB:",
        "%   (MRB + MA)*nu_dot + CRB*nu + g = tau + tau_control",
        "% tau contains -C_A(nu)*nu already (the Munk moment in Nv and Mw): do not add m2c(MA, nu).",
        *([] if commands else [f"% {propulsion(parameters)}."]),
        *(f"% {words}." for words in (*in_header(parameters, tables=True), *unstated(parameters, _NAMES))),
        "%",
        "% Primes: Y = 1/2 rho U^2 L^2 Y', v' = v/U, r' = r L/U, U = |(u, v, w)|; a in a name is an absolute value,",
        "% h.Yvav that of v|v|.",
        "",
        "if nargin < 1, nu = zeros(6,1); end",
        "if nargin < 2, delta = zeros(3,1); end",
        *(["if nargin < 3, command = zeros(0,1); end"] if commands else []),
        "",
    ]


def _facts(parameters: ParameterFile) -> list[str]:
    p, point = parameters, parameters.reference_point
    facts: list[tuple[str, float | str | None, str]] = [
        ("coeflab", 1.0, "layout of this file"),
        ("name", p.name, ""),
        ("body", p.body, ""),
        ("rho", p.conditions.density, "density (kg/m^3)"),
        ("U0", p.conditions.speed, "speed of the tests (m/s)"),
        ("viscosity", p.conditions.viscosity, "kinematic (m^2/s)"),
        ("L", p.scaling.length, "length of the primes (m)"),
        ("L_name", p.scaling.length_name, ""),
        ("datum", point.datum, "where points are measured from"),
        *((f"{axis}_ref", value, "reference point (m)") for axis, value in zip("xyz", point.point, strict=True)),
    ]
    if p.mass is not None:
        facts += [("m", p.mass.mass, "mass (kg)"), ("mxG", p.mass.mass_moment, "x_G*m (kg m)")]
        facts += [("I_transverse", p.mass.inertia, "Iyy = Izz about the reference point (kg m^2)")]
        centre = () if p.mass.centre is None else p.mass.centre.tolist()
        facts += [(f"{axis}G", x, "centre of gravity (m)") for axis, x in zip("xyz", centre, strict=False)]
        rows = enumerate(() if p.mass.inertia_matrix is None else p.mass.inertia_matrix.tolist(), 1)
        facts += [(f"I{i}{j}", x, "of the inertia matrix (kg m^2)") for i, row in rows for j, x in enumerate(row, 1)]
    if p.hydrostatics is not None:
        facts += [
            ("volume", p.hydrostatics.volume, "displaced (m^3)"),
            ("g", p.hydrostatics.gravity, "gravity (m/s^2)"),
        ]
        centre = zip("xyz", p.hydrostatics.centre_of_buoyancy, strict=True)
        facts += [(f"{axis}B", x, "centre of buoyancy (m)") for axis, x in centre]
    for kind, unit, values in zip(
        ("limit", "rate"), ("largest angle (rad)", "rad/s, to be kept by the loop"), limits(p), strict=True
    ):
        facts += [(f"{kind}_{c}", x, unit) for c, x in values.items()]
    facts += [(f"lag_{k}", t.lag, f"of thruster {k} (s), to be kept by the loop") for k, t in enumerate(p.thrusters, 1)]
    if p.added_mass is not None:
        facts += [("MA_body", p.added_mass.body, ""), ("MA_method", p.added_mass.method, "")]
    return [
        f"h.{name} = {_quoted(value) if isinstance(value, str) else repr(value)};" + (f"  % {note}" if note else "")
        for name, value, note in facts
        if value is not None
    ]


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One function file; its name is the parameter file's, as an identifier."""
    function = identifier(parameters.name, matlab() | OWN)
    terms = written_terms(parameters)
    accelerations, source = written_accelerations(parameters)
    lines = [*_head(function, parameters), *_facts(parameters)]
    for group, heading in _HEADINGS.items():
        chosen = [t for t in terms if t.kind == group]
        if chosen:
            lines += ["", f"% {heading}"]
            lines += [
                f"{_place(group, spelt(t.symbol))} = {t.written!r};" + (f"  % {t.note}" if t.note else "")
                for t in chosen
            ]
    lines += ["", f"% Primed acceleration derivatives, the negative of the added mass: {one_line(source)}"]
    lines += [f"h.{name} = {value!r};" for name, value in accelerations.items()]
    tables, wind = coded_tables(parameters)
    lines += ["", *_force(parameters, terms, accelerations, bool(tables)), "", *_added_mass(accelerations), "end"]
    if tables:
        lines += [own_text(resources("coeflab.formats.mss") / "tables.m").rstrip(), "", *_tables(tables, wind)]
    if parameters.thrusters:
        lines += [own_text(resources("coeflab.formats.mss") / "driven.m").rstrip(), "", *_thrusters(parameters)]
    return {f"{function}.m": ("\n".join(lines) + "\n").encode()}


def _tables(tables: Sequence[Mapping[str, Any]], wind: Sequence[Sequence[int]]) -> list[str]:
    """A function that gives the rows of every table."""
    out = [
        "function [T, speaks] = tables()",
        "% Fitted tables. variables: of u v w p q r dr ds db U alpha beta; a variable is times prime/U where that is not zero; rule",
        "% outside: 0 nearest point, 1 fading into it, 2 none; terms: X Y Z K M N, then D S L of each row of speaks, value (SI), power",
        "% of U, then of each variable its power and that of its absolute value.",
        f"speaks = [{'; '.join(' '.join(map(str, into)) for into in wind)}];",
    ]
    for k, t in enumerate(tables, 1):
        out.append(f"% {one_line(t['name'])}")
        for key in KEYS:
            rows = t[key] if isinstance(t[key], list) else [t[key]]
            nested = rows if rows and isinstance(rows[0], list) else [rows]
            body = "; ".join(
                " ".join(repr(float(x)) if key not in ("variables",) else str(x) for x in row) for row in nested
            )
            out.append(f"T({k}).{key} = [{body}];")
    return [*out, "end"]


_ROW = re.compile(r"^T\((\d+)\)\.(\w+) = \[([^\]]*)\];$", re.MULTILINE)


def _read_tables(text: str) -> ForceLaw:
    """The law of the tables in a function file."""
    out: dict[int, dict[str, Any]] = {}
    for k, key, body in _ROW.findall(text):
        rows = [[float(x) for x in row.split()] for row in body.split(";")]
        nested = key in ("spaces", "faces", "maps", "terms")
        out.setdefault(int(k), {})[key] = (
            rows if nested else rows[0][0] if key in ("rule", "boxed", "rests") else rows[0]
        )
    wind = [[int(x) for x in row.split()] for row in text.rpartition("speaks = [")[2].partition("]")[0].split(";")]
    return law_of_tables([out[k] for k in sorted(out)], wind)


def _thrusters(parameters: ParameterFile) -> list[str]:
    """A function that gives the rows of every thruster."""
    rows = (
        f"[{'; '.join(' '.join(repr(float(x)) for x in r) for r in part)}];" for part in coded_thrusters(parameters)
    )
    return [
        "function [T, S] = thrusters()",
        "% T: position, direction, tilt axis (zeros: fixed), lowest and highest tilt, handedness; S: thruster, 0 thrust or 1 torque,",
        "% lowest and highest command, then coefficients of the command's powers.",
        *(f"{name} = {part}" for name, part in zip("TS", rows, strict=True)),
        "end",
    ]


def _force(
    parameters: ParameterFile, terms: tuple[ForceTerm, ...], accelerations: Mapping[str, float], tabled: bool
) -> list[str]:
    largest = limits(parameters)[0]
    scales = {t.length_power for t in terms} | {powers_of(a)[1] for a in accelerations}
    lines = [f"{name} = nu({k});" for k, name in enumerate(MOTIONS, 1)]
    lines += [
        f"{c} = {read_angle(c, f'delta({k})', 'h.', c in largest)};"
        for k, c in enumerate(CONTROLS, 1)
        if c in written_controls(terms) or tabled
    ]
    lines += ["U = max(sqrt(u^2 + v^2 + w^2), 1e-9);"]
    lines += [f"course = {COURSE};  % {COURSE_MEANS}"] * has_course(terms)
    lines += [f"r{k} = h.rho*h.L^{k}/2;" for k in sorted(scales) if k]
    for component in COMPONENTS:
        parts = [expression(t, _place, "^") for t in terms if t.component == component] or ["0"]
        lines += [f"{component} = " + " ...\n    + ".join(parts) + ";"]
    more = " + tabled([u v w p q r], [dr ds db])" if tabled else ""
    more += " + driven(command)" if parameters.thrusters else ""
    return [*lines, f"tau = [X; Y; Z; K; M; N]{more};"]


def _added_mass(accelerations: Mapping[str, float]) -> list[str]:
    rows = []
    for component in COMPONENTS:
        names = [f"{component}{motion}dot" for motion in MOTIONS]
        rows.append(" ".join(f"r{powers_of(n)[1]}*h.{n}" if n in accelerations else "0" for n in names))
    return ["MA = -[" + ";\n       ".join(rows) + "];"]


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """The function's own assignments, one after the other, with zero control angles."""
    return steered_force(files, nu, np.zeros((len(nu), 3)))


def steered_force(
    files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same under control angles."""
    names, _ = _evaluated(files, nu, controls)
    out = np.column_stack([np.broadcast_to(np.asarray(names[c], dtype=np.float64), len(nu)) for c in COMPONENTS])
    text = _text(files)
    if TABLED not in text:
        return out
    held = np.column_stack([np.broadcast_to(np.asarray(names[c], dtype=np.float64), len(nu)) for c in CONTROLS])
    return out + _read_tables(text).force(nu, held)


def _text(files: Mapping[str, bytes]) -> str:
    return next(content for name, content in files.items() if name.endswith(".m")).decode()


def added_mass(files: Mapping[str, bytes]) -> NDArray[np.float64]:
    """The function's own ``MA``, entry by entry."""
    names, matrix = _evaluated(files, np.zeros((1, 6)), np.zeros((1, 3)))
    rows = matrix.strip().removeprefix("-[").removesuffix("]").split(";")
    return -np.array([[float(evaluate(entry, names, {})) for entry in row.split()] for row in rows])


def _evaluated(
    files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
) -> tuple[dict[str, Any], str]:
    """What the function's assignments give at velocities (n, 6) and controls (n, 3), and the text of that of MA."""
    text = own_part(_text(files))
    functions: dict[str, Callable[..., Any]] = {
        "nu": lambda k: nu[:, int(k) - 1],
        "delta": lambda k: controls[:, int(k) - 1],
        "sqrt": np.sqrt,
        "max": np.maximum,
        "min": np.minimum,
        "abs": np.abs,
    }
    names: dict[str, Any] = {}
    matrix = ""
    for a in assignments(text):
        if a.target == "MA":
            matrix = a.expression
        elif a.quoted is None and a.target not in ("nu", "delta", "command", "tau"):
            names[a.target] = evaluate(a.expression, names, functions)
    return names, matrix


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the law is written, in words."""
    buoyant = "h.volume, h.g and h.xB h.yB h.zB give the restoring forces g in (MRB + MA)*nu_dot + CRB*nu + g = tau, as arguments of MSS gvect"
    return (
        *written_changes(parameters, "the function", "h.ideal", "MA"),
        f"tau contains no weight and no buoyancy{'' if parameters.hydrostatics is None else f': {buoyant}'}",
        *held_in_words(parameters, "command", rates="stand in h and are not kept: the function has no time"),
        *(() if parameters.thrusters else (propulsion(parameters),)),
        *unstated(parameters, _NAMES),
        "r2 in the function is 1/2 rho L^2, r3 is 1/2 rho L^3 and so on; U is never below 1e-9 m/s",
    )
