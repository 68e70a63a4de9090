"""Models of xdyn and lxdyn: one body's inertia, added mass, damping and manoeuvring expressions, multiplied out."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from coeflab.core.arithmetic import ArithmeticProblem
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding
from coeflab.core.limits import JSON_BYTES, positive_number
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.table import Check
from coeflab.core.text.toml import read_text
from coeflab.core.text.yaml import number, read_yaml
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import one_line
from coeflab.formats.exported_law import sname
from coeflab.formats.left_out import left_out
from coeflab.formats.stated_coefficients import matrix_doubts
from coeflab.formats.stated_file import Law, Stated, stated_file
from coeflab.formats.xdyn.actuators import read_limits
from coeflab.formats.xdyn.law import XdynBody, xdyn_body
from coeflab.formats.xdyn.multiplied_out import MultipliedOut, multiplied_out
from coeflab.formats.xdyn.products import Product
from coeflab.law.definiteness import definiteness
from coeflab.law.rigid_body import MassProperties, about_another, ideal_quadratics, inertia_doubt
from coeflab.law.scaling import Conditions, Scaling, powers_of
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.law.terms import parse_suffix
from coeflab.law.transforms import moved
from coeflab.vehicle.imported_numbers import gravity
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterSurface

summary = "xdyn YAML: one body with added mass, damping matrices and manoeuvring expressions"
citations = ("sname1950", "fossen2011", "xdyn")
reads = "xdyn YAML"
signs = "xdyn takes the added mass and both damping matrices positive."

KEYS = re.compile(r"^[ \t-]*(dynamics|external forces|rotations convention)[ \t]*:", re.MULTILINE)
LENGTHS = ("L", "Lpp", "LBP", "LOA", "Lwl")
SPEED, CLOSE = 1.0, 1e-9


def recognises(path: Path) -> bool:
    """Whether the file is YAML with a key of xdyn's bodies."""
    text = read_text(path, JSON_BYTES)
    return text.lstrip()[:1] not in ("<", "{") and KEYS.search(text) is not None


def read(path: Path, density: float | None = None) -> ParameterFile:  # noqa: ARG001 - the file states it
    """Read a model file, which states its density.

    Moments are about the manoeuvring model's point where its expressions use the velocities there, else about the centre
    of gravity. xdyn adds no C_A(nu) nu: its added mass is taken as such where the file's own expressions hold these
    products, and as acceleration derivatives otherwise.

    Raises
    ------
    InputError
        No YAML, tags, aliases, several bodies, an expression that is no sum of products of velocities.
    """
    body = xdyn_body(read_yaml(path), path)
    if expected := positive_number(body.density):
        raise InputError(f"density rho {body.density:g}", expected, file=path)
    try:
        law = multiplied_out(body)
        stated = _stated(body, law, path)
    except ArithmeticProblem as why:
        raise input_error("formats.no_sums_of_products", path, why=str(why)) from None
    return stated_file(stated, [InputFile(path.name, sha256_of(path))], citations)


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    constants = read_yaml(path).get("environmental constants")
    stated = constants.get("g") if isinstance(constants, dict) else None
    value = number(stated.get("value")) if isinstance(stated, dict) else None
    return () if value is None else gravity("xdyn", value, "environmental constants: g")


def _stated(body: XdynBody, law: MultipliedOut, path: Path) -> Stated:
    notes = [*law.notes]
    named = next((n for n in LENGTHS if law.constants.get(n, 0.0) > 0.0), None)
    scaling = Scaling(law.constants[named], named) if named else Scaling(1.0, "1 m")
    notes.append(f"lengths made dimensionless by {scaling.length_name}" + ("" if named else ": the file states none"))
    at = Conditions(body.density, abs(body.speed) or SPEED)
    if not body.speed:
        notes.append(f"the file's initial speed is zero; {SPEED:g} m/s is used instead")
    matrix = moved(body.added, law.point - body.centre)
    ideal = ideal_quadratics(matrix)
    doubts = matrix_doubts(matrix)
    if body.rigid is not None and definiteness(body.rigid + body.added).smallest <= 0.0:
        doubts += ("with its added mass the inertia is not positive definite: no simulation survives it",)
    notes += doubts
    selected = not doubts and bool(np.any(ideal)) and _speaks_of_all(law, ideal)
    if np.any(ideal) and not selected:
        notes.append("no C_A(nu) nu in the file: products of velocities that it does not name are taken as zero")
    coefficients: dict[str, tuple[float, Law]] = {}
    spelling = _spelling(body)
    for i, component in enumerate(COMPONENTS):
        for product, value in law.components[i].terms.items():
            if selected and _is_ideal(law, ideal, i, product):
                continue
            symbol, rest = _symbol(component, product, spelling)
            if symbol in coefficients:
                raise ArithmeticProblem(f"{symbol} both with and without the speed")
            unit = scaling.unit(symbol, at.density, at.speed if rest else 1.0)
            coefficients[symbol] = (value / unit, "rest" if rest else "motion")
    if not selected:
        for i, j in np.argwhere((matrix != 0.0) | (matrix.T != 0.0)):
            symbol = f"{COMPONENTS[i]}{MOTIONS[j]}dot"
            coefficients[symbol] = ((0.0 - float(matrix[i, j])) / scaling.unit(symbol, at.density), "motion")
    x, y, z = map(float, law.point if body.mesh is None else body.mesh + law.point)
    mass, doubt = _mass(body, law.point)
    name = one_line(body.name)[:200] or path.stem[:200]
    return Stated(
        name=path.stem[:200],
        body=name,
        scaling=scaling,
        conditions=at,
        coefficients=coefficients,
        point=(x, y, z),
        datum=Datum("origin of the body frame" if body.mesh is None else "origin of the mesh"),
        matrix=matrix if selected else None,
        mass=mass,
        surfaces=tuple(
            ParameterSurface(control=c, limit=limit)
            for m in body.manoeuvring
            for c, limit in read_limits(m.expressions).items()
        ),
        notes=(*notes, *doubt),
        findings=_left_out(body, name),
    )


# Force models of xdyn that are not of the hull's own hydrodynamics.
STATICS = (
    "gravity",
    "buoyancy",
    "non-linear hydrostatic (exact)",
    "non-linear hydrostatic (fast)",
    "linear hydrostatics",
    "hydrostatic",
)
DRIVES = re.compile(
    r"propeller|rudder|thruster|wageningen|kt\(j\)|controll?er|PID|constant force|sail|aero|linear stiffness",
    re.IGNORECASE,
)


def _left_out(body: XdynBody, name: str) -> tuple[Finding, ...]:
    """Force models that are not read, commands at zero, times, and the state at the start."""
    models = tuple(dict.fromkeys(body.left_out))
    statics = [m for m in models if m in STATICS]
    drives = [m for m in models if m not in STATICS and DRIVES.search(m)]
    commands = [c for m in body.manoeuvring for c in m.commands if c not in CONTROLS]
    timed = [k for m in body.manoeuvring for k, v in m.expressions.items() if _TIME.search(_STATE.sub("", v))]
    return (
        *left_out(name, "hydrostatics", statics),
        *left_out(name, "propulsion", drives),
        *left_out(name, "forces", [m for m in models if m not in (*statics, *drives)]),
        *left_out(name, "commands", commands),
        *left_out(name, "time", timed),
        *left_out(name, "environment", body.unread),
    )


_STATE, _TIME = re.compile(r"\(\s*t\s*\)"), re.compile(r"(?<!\w)t(?!\w)", re.ASCII)


def _mass(body: XdynBody, point: Array) -> tuple[MassProperties | None, tuple[str, ...]]:
    """Mass properties about a point, where the matrix is that of a body."""
    if body.rigid is None:
        return None, ("the file states no rigid-body inertia",)
    mass, centre = float(body.rigid[0, 0]), body.centre - point
    own = body.rigid[3:, 3:]
    expected = mass * np.eye(6)
    expected[3:, 3:] = own
    if mass <= 0.0 or not np.allclose(body.rigid, expected, rtol=1e-9, atol=1e-9 * abs(mass)):
        return None, (
            "rigid-body inertia left out: about its centre of gravity a body has one mass and no mass moments",
        )
    doubt = inertia_doubt(mass, np.zeros(3), own)
    moment = mass * float(centre[0])
    if doubt:
        return MassProperties(mass, moment, None, centre), (f"inertia left out: {doubt}",)
    about = about_another(own, mass, np.zeros(3), centre)
    transverse = float(about[1, 1]) if abs(about[1, 1] - about[2, 2]) <= 1e-9 * about[1, 1] else None
    return MassProperties(mass, moment, transverse, centre, about), ()


def _pair(product: Product) -> tuple[int, int] | None:
    """The two velocities whose product it is near straight motion, U counted as u; None for others."""
    at: list[int] = []
    for name, power in product:
        if power < 0 or name not in (*MOTIONS, "U"):
            return None
        at += [0 if name == "U" else MOTIONS.index(name)] * power
    if len(at) != 2:
        return None
    first, second = sorted(at)
    return first, second


def _is_ideal(law: MultipliedOut, ideal: Array, i: int, product: Product) -> bool:
    """Whether a product is that of -C_A(nu) nu, and the only one of its pair."""
    pair = _pair(product)
    terms = law.components[i].terms
    if pair is None or any(n == "U" for n, _ in product) or sum(_pair(p) == pair for p in terms) > 1:
        return False
    wanted = ideal[i, pair[0], pair[1]] * (1.0 if pair[0] == pair[1] else 2.0)
    return bool(wanted != 0.0 and abs(terms[product] - wanted) <= CLOSE * np.max(np.abs(ideal[i])))


def _speaks_of_all(law: MultipliedOut, ideal: Array) -> bool:
    """Whether the file has a term for every product of the ideal fluid."""
    for i in range(6):
        pairs = {_pair(p) for p in law.components[i].terms}
        largest = float(np.max(np.abs(ideal[i])))
        for j, k in np.argwhere(np.abs(ideal[i]) > 1e-12 * largest):
            if j <= k and (int(j), int(k)) not in pairs:
                return False
    return True


def _factors(suffix: str) -> Product:
    return tuple(sorted((f"|{v}|" if a else v, n) for v, n, a in parse_suffix(suffix).factors))


def _spelling(body: XdynBody) -> dict[tuple[str, Product], str]:
    """How the file's own keys spell a product: ``Yrvv`` rather than ``Yvvr``."""
    out: dict[tuple[str, Product], str] = {}
    for key in (k for model in body.manoeuvring for k in model.expressions):
        symbol = sname(key.removesuffix("_rest").removesuffix("_ideal"))
        try:
            d = derivative(symbol)
        except InputError:
            continue
        if not any(f.endswith("dot") for f in d.factors):
            out.setdefault((d.component, _factors(d.text[1:])), d.text)
    return out


def _symbol(component: str, product: Product, spelling: dict[tuple[str, Product], str]) -> tuple[str, bool]:
    """The derivative that a product is, and whether it is one about a state of rest.

    Raises
    ------
    ArithmeticProblem
        No derivative has that power of the speed.
    """
    powers = dict(product)
    speed = powers.pop("U", 0)
    rest = tuple(sorted(powers.items()))
    order = (*MOTIONS, *CONTROLS, *(f"|{n}|" for n in (*MOTIONS, *CONTROLS)))
    if any(n not in order or k < 0 for n, k in rest):
        raise ArithmeticProblem(f"{component} with {_words(product)}")
    written = "".join(n * powers[n] for n in order if n in powers) or "0"
    symbol = spelling.get((component, rest), component + written)
    try:
        wanted = powers_of(symbol)[0]
    except InputError:
        raise ArithmeticProblem(f"{component} with {_words(product)}") from None
    if speed not in (wanted, 0):
        raise ArithmeticProblem(f"{component} with {_words(product)}, where {symbol} goes with U^{wanted}")
    return symbol, speed != wanted


def _words(product: Iterable[tuple[str, int]]) -> str:
    return " ".join(n if k == 1 else f"{n}^{k}" for n, k in product) or "a constant"
