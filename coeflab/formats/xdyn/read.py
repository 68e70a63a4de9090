"""Models of xdyn and lxdyn: one body's inertia, added mass, damping and manoeuvring expressions, multiplied out.

The force law of an xdyn body, multiplied out into products of velocities about one point.

Sums of products of velocities: what an expression says when it is multiplied out.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

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
from coeflab.core.types import Array, brief
from coeflab.core.wording import one_line
from coeflab.formats.exported_law import sname
from coeflab.formats.imported_file import Law, Stated, imported_file, matrix_doubts
from coeflab.formats.left_out import left_out
from coeflab.formats.xdyn.actuators import limited, read_limits
from coeflab.formats.xdyn.law import Manoeuvring, XdynBody, settled, xdyn_body
from coeflab.law.added_mass import definiteness
from coeflab.law.force_law import AHEAD
from coeflab.law.rigid_body import MassProperties, about_another, ideal_quadratics, inertia_doubt
from coeflab.law.scaling import Conditions, Scaling, powers_of
from coeflab.law.symbols import COMPONENTS, CONTROLS, LINEAR, MOTIONS, derivative
from coeflab.law.terms import parse_suffix
from coeflab.law.transforms import force_transfer, moved
from coeflab.vehicle.imported_numbers import gravity
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterSurface

Product = tuple[tuple[str, int], ...]
MOST = 4000
HIGHEST = 12
NOTHING = 1e-15
SIGN, SIDES = "course", ("course + 1", "course - 1")
RESISTANCE: Product = (("U", 2),)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Products:
    """Numbers by product; a product is names with their powers, sorted, ``|v|`` a name of its own.

    Attributes
    ----------
    terms : mapping of product to float
    """

    terms: Mapping[Product, float]

    @classmethod
    def of(cls, name: str) -> Products:
        """One name."""
        return cls({((name, 1),): 1.0})

    @property
    def number(self) -> float | None:
        """The value where no name is left."""
        return self.terms.get((), 0.0) if set(self.terms) <= {()} else None

    def _one(self, doing: str) -> tuple[Product, float]:
        if len(self.terms) != 1:
            raise ArithmeticProblem(f"{doing} a sum")
        return next(iter(self.terms.items()))

    def __add__(self, other: Products | float) -> Products:
        out = dict(self.terms)
        for product, value in as_products(other).terms.items():
            out[product] = out.get(product, 0.0) + value
        return Products({p: v for p, v in out.items() if v != 0.0})

    __radd__ = __add__

    def __neg__(self) -> Products:
        return self * -1.0

    def __sub__(self, other: Products | float) -> Products:
        return self + as_products(other) * -1.0

    def __rsub__(self, other: float) -> Products:
        return as_products(other) + self * -1.0

    def __mul__(self, other: Products | float) -> Products:
        factor = as_products(other).terms
        if len(factor) * len(self.terms) > MOST:
            raise ArithmeticProblem(f"more than {MOST} products")
        out: dict[Product, float] = {}
        for a, x in self.terms.items():
            for b, y in factor.items():
                product = _joined(a, b)
                out[product] = out.get(product, 0.0) + x * y
        return Products({p: v for p, v in out.items() if v != 0.0})

    __rmul__ = __mul__

    def __pow__(self, power: Products | float) -> Products:
        exponent = as_products(power).number
        if exponent is None or exponent != int(exponent) or abs(exponent) > HIGHEST:
            raise ArithmeticProblem(f"a power that is no whole number up to {HIGHEST}")
        if exponent < 0:
            product, value = self._one("dividing by")
            if value == 0.0:
                raise ArithmeticProblem("division by zero")
            return Products({tuple((n, int(k * exponent)) for n, k in product): value**exponent})
        out = as_products(1.0)
        for _ in range(int(exponent)):
            out = out * self
        return out

    def __truediv__(self, other: Products | float) -> Products:
        return self * as_products(other) ** -1.0

    def __rtruediv__(self, other: float) -> Products:
        return as_products(other) * self**-1.0

    def __abs__(self) -> Products:
        if not self.terms:
            return self
        product, value = self._one("the absolute value of")
        named = ((n if n.startswith("|") or n == "U" else f"|{n}|", k) for n, k in product)
        return Products({_joined((), tuple(named)): abs(value)})

    def same(self, other: Products) -> bool:
        """Whether both are equal to rounding, term by term."""
        apart = (self - other).terms
        return all(abs(v) <= 1e-12 * max(abs(self.terms.get(p, 0.0)), NOTHING) for p, v in apart.items())


def as_products(value: Products | float) -> Products:
    """A number as a sum of products."""
    if isinstance(value, Products):
        return value
    return Products({(): float(value)} if value else {})


def _joined(a: Product, b: Product) -> Product:
    powers: dict[str, int] = {}
    for name, k in (*a, *b):
        powers[name] = powers.get(name, 0) + k
    return tuple(sorted((n, k) for n, k in powers.items() if k))


FLOOR = 1e-9
MARK = "@"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class MultipliedOut:
    """The law as sums of products.

    Attributes
    ----------
    point : (3,) array
        That the moments are about and the velocities are of, from the origin of the body frame, m.
    components : tuple of 6 Products
        X Y Z K M N in SI over ``u`` ... ``r``, ``|u|`` ... , ``U`` and control angles.
    constants : dict of name to float
        Keys of the manoeuvring models that are plain numbers.
    notes : tuple of str
    """

    point: Array
    components: tuple[Products, ...]
    constants: dict[str, float]
    notes: tuple[str, ...]


def multiplied_out(body: XdynBody) -> MultipliedOut:
    """Everything in the body's hydrodynamic models, about the manoeuvring model's point where its expressions use the
    velocities there, else about the centre of gravity.

    Raises
    ------
    ArithmeticProblem
        An expression that is no sum of products of velocities, their absolute values, powers of the speed and angles.
    """
    notes: list[str] = []
    constants: dict[str, float] = {}
    if len(body.manoeuvring) == 1 and not body.damping:
        model = body.manoeuvring[0]
        found = _components(body, model, True, notes, constants)
        if found is not None:
            return MultipliedOut(model.point, found, constants, tuple(dict.fromkeys(notes)))
        notes.clear()
    total = [as_products(0.0)] * 6
    for model in body.manoeuvring:
        found = _components(body, model, False, notes, constants) or tuple(total)
        total = [a + b for a, b in zip(total, _moved(found, body.centre - model.point), strict=True)]
    for power, matrix in body.damping:
        at_centre = force_transfer(body.centre - body.damping_point) @ matrix
        for j, name in enumerate(MOTIONS):
            motion = Products.of(name) if power == 1 else Products.of(name) * abs(Products.of(name))
            total = [a + motion * -float(at_centre[i, j]) for i, a in enumerate(total)]
    return MultipliedOut(body.centre, tuple(total), constants, tuple(dict.fromkeys(notes)))


def _moved(components: tuple[Products, ...], shift: Array) -> tuple[Products, ...]:
    transfer = force_transfer(shift)
    rows = []
    for row in transfer:
        out = as_products(0.0)
        for factor, component in zip(row, components, strict=True):
            out = out + component * float(factor)
        rows.append(out)
    return tuple(rows)


def _components(
    body: XdynBody, model: Manoeuvring, at_point: bool, notes: list[str], constants: dict[str, float]
) -> tuple[Products, ...] | None:
    """X Y Z K M N of one model; with ``at_point`` over the velocities at its point, None if others are used too."""
    marked = MARK if at_point else ""
    shift = model.point - body.centre
    expected = dict(zip(LINEAR, _velocities_at(shift), strict=True)) if at_point else {}
    still = not np.any(shift)

    def state(name: str, _time: Any) -> Products:
        return Products.of(name + (marked if still and name in LINEAR else ""))

    def finish(_name: str, value: Any) -> Any:
        if not isinstance(value, Products):
            return value
        number = value.number
        if number is not None:
            return number
        if dict(value.terms) == {((SIDES[0], 1),): 0.5, ((SIDES[1], 1),): -0.5}:
            return Products.of(SIGN)
        at = next((m for m, form in expected.items() if not still and value.same(form)), None)
        return value if at is None else Products.of(at + marked)

    functions: dict[str, Callable[..., Any]] = {m: partial(state, m) for m in MOTIONS}
    functions |= {"abs": partial(_absolute, f"u{marked}"), "sqrt": partial(_root, notes)}
    functions |= {f: partial(_of_number, f) for f in ("exp", "log", "cos", "sin")}
    given = {**body.given(model), **{c: Products.of(c) for c in model.commands if c in CONTROLS}}
    free = {limited(c): c for c in read_limits(model.expressions) if c in model.commands}
    try:
        known = settled({**model.expressions, **free}, given, functions, finish)
    except ArithmeticProblem:
        if at_point:
            return None
        raise
    constants |= {k: v for k, v in known.items() if isinstance(v, float) and k in model.expressions}
    out = tuple(as_products(known[c]) for c in COMPONENTS)
    names = {n.strip("|") for c in out for p in c.terms for n, _ in p}
    if at_point and names & set(LINEAR):
        return None
    plain = [{tuple(sorted((n.replace(MARK, ""), k) for n, k in p)): v for p, v in c.terms.items()} for c in out]
    if RESISTANCE in plain[0]:
        notes.append("X with U^2 alone pushes ahead on a course astern in the file; here it is drag there too")
    signed = tuple(sorted((*RESISTANCE, (SIGN, 1))))
    if signed in plain[0]:
        plain[0][RESISTANCE] = plain[0].get(RESISTANCE, 0.0) + plain[0].pop(signed)
    return tuple(Products(c) for c in plain)


def _absolute(ahead: str, value: Any) -> Any:
    """An absolute value: of one product, or of the two of which the sign of the course is made (`formats.exported_law.COURSE`)."""
    if isinstance(value, Products) and len(value.terms) == 2:
        share = {p: v / AHEAD.prime if p else v for p, v in value.terms.items()}
        for name, side in zip(SIDES, (1.0, -1.0), strict=True):
            if share == {tuple(sorted(((ahead, 1), ("U", -1)))): 1.0, (): side}:
                return Products.of(name)
    return abs(value)


def _velocities_at(shift: Array) -> tuple[Products, ...]:
    """Velocities u v w at a point ``shift`` from the centre of gravity, over the states of xdyn."""
    u, v, w, p, q, r = (Products.of(m) for m in MOTIONS)
    x, y, z = map(float, shift)
    return u + q * z - r * y, v + r * x - p * z, w + p * y - q * x


def _root(notes: list[str], value: Any) -> Any:
    """A square root: of a number, or the speed."""
    products = as_products(value)
    number = products.number
    if number is not None:
        if number < 0.0:
            raise ArithmeticProblem("the root of a negative number")
        return math.sqrt(number)
    squares = {}
    for product, factor in products.terms.items():
        if product == () and abs(factor) <= FLOOR:
            continue
        name, power = product[0] if len(product) == 1 else ("", 0)
        if power != 2 or abs(factor - 1.0) > 1e-12:
            raise ArithmeticProblem("a root that is not that of u^2 + v^2 + w^2")
        squares[name.replace(MARK, "")] = factor
    if not squares or not set(squares) <= set(LINEAR):
        raise ArithmeticProblem("a root that is not that of u^2 + v^2 + w^2")
    if len(squares) < 3:
        notes.append(
            f"U of the file is the root of {' + '.join(f'{n}^2' for n in squares)}; here it is that of all three"
        )
    return Products.of("U")


def _of_number(function: str, value: Any) -> float:
    number = as_products(value).number
    if number is None:
        raise ArithmeticProblem(f"{function} of a velocity")
    return float(getattr(math, function)(number))


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
    return imported_file(stated, [InputFile(path.name, sha256_of(path))], citations)


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
