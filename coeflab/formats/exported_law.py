"""What exports to simulators of second order in the velocities share: the law, its form, an added mass that they can carry.

A law near a straight course ahead, whatever its terms are called, and whether a target of another form takes a term.

The force law of a parameter file as named numbers and expressions, for targets that are programs.

Absolute values in a name are written with ``a`` before the factor, ``Yvav`` for Yv|v|, as in MSS navalvessel.m.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.definiteness import definiteness
from coeflab.law.force_law import AHEAD, ForceLaw, ForceTerm
from coeflab.law.named_terms import canonical
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.vehicle.force_law import force_law, ideal_terms, motion_law, sources_of
from coeflab.vehicle.inertia import centre_of_gravity, water_inertia
from coeflab.vehicle.law_at_points import motion_of
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import SecondOrder, resists, second_order, slot


def number(value: float) -> str:
    """All digits, and no minus before a zero."""
    return repr(float(value) + 0.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ExportedLaw:
    """A law as simulators of second order take it, in FRD about the file's reference point.

    Attributes
    ----------
    law : ForceLaw
    form : SecondOrder
        The law's terms that have a place in it.
    matrix : (6, 6) array
        Added mass that the vehicle moves with, see `coeflab.vehicle.inertia`; zeros where nothing is known.
    statements : tuple of str
        Where it comes from, then what was done to it.
    """

    law: ForceLaw
    form: SecondOrder
    matrix: Array
    statements: tuple[str, ...]

    @property
    def inert(self) -> bool:
        """Whether there is no added mass."""
        return not np.any(self.matrix)


def exported_law(parameters: ParameterFile) -> ExportedLaw:
    """The law of a file and the added mass that a physics engine integrates, the same that `coeflab simulate` does.

    A file without mass cannot be simulated, and engines take a default mass: there an added mass that is not positive by itself
    keeps its diagonal alone.
    """
    law, water = force_law(parameters), water_inertia(parameters)
    matrix, statements = water.matrix, water.statements
    if parameters.mass is None and not definiteness(matrix).holds:
        matrix = np.diag(np.maximum(np.diag(matrix), 0.0))
        words = "added mass: only its diagonal, because the whole is not positive and no mass is known: entries are missing or wrong"
        statements = (*statements, words)
    form, taken = _nearest(second_order(law), law, parameters)
    return ExportedLaw(law, form, matrix, (*statements, *taken))


STEPS, ROUNDS = 41, 40  # points over the range; rounds of weights, after which the worst changes by less than 1 %
ACROSS = ("v", "w")
LEAST = 1e-3  # of the largest force of a component, that a change is worth


def _nearest(form: SecondOrder, law: ForceLaw, parameters: ParameterFile) -> tuple[SecondOrder, tuple[str, ...]]:
    """The form whose x|x| and x^2 are nearest, over the range in which the law holds, to what else has no place in it.

    Slopes stay. Taken up are v^3 and its like, and u for U; only in files that say where their law holds.
    """
    if not parameters.law_holds:
        return form, ()
    speed, length = parameters.conditions.speed, parameters.scaling.length
    signed, absolute, phrases = form.signed.copy(), form.absolute.copy(), list[str]()
    for name, reach in _reaches(parameters).items():
        j = MOTIONS.index(name)
        x = np.linspace(-reach, reach, STEPS)
        nu = np.zeros((STEPS, 6))
        nu[:, 0] = speed * (np.sqrt(1.0 - x**2) if name in ACROSS else 1.0)
        nu[:, j] = speed * x / (1.0 if name in ACROSS else length)
        wanted = law.force(nu)
        left = wanted - form.force(nu)
        bent = np.column_stack([nu[:, j] * np.abs(nu[:, j]), nu[:, j] ** 2])
        more = _least_worst(bent, left - left[STEPS // 2])
        for i, c in enumerate(COMPONENTS):
            largest = float(np.abs(wanted[:, i]).max())
            selected = np.abs(more[:, i]) * np.abs(bent).max(axis=0) > LEAST * largest
            absolute[i, j, j] += more[0, i] * selected[0]
            signed[i, j, j] += more[1, i] * selected[1]
            phrases += [f"{c}{name}|{name}|"] if selected[0] else []
            phrases += [f"{c}{name}{name}"] if selected[1] else []
    if not phrases:
        return form, ()
    words = (
        f"{', '.join(phrases)}: fitted to include what this form cannot express (v^3 and its like, U for u), with the least largest difference over "
        "the range in which the law holds"
    )
    return SecondOrder(form.linear, signed, absolute, form.resistance), (words,)


def _least_worst(columns: Array, wanted: Array) -> Array:
    """Coefficients (p, m) of columns (n, p) with the least largest difference from (n, m), by Lawson's weights.

    C. L. Lawson, Contributions to the theory of linear least maximum approximation, UCLA 1961.
    """
    out = np.zeros((columns.shape[1], wanted.shape[1]))
    for k, d in enumerate(wanted.T):
        weights, least = np.ones(len(d)), np.inf
        for _ in range(ROUNDS):
            root = np.sqrt(weights)
            found = np.linalg.lstsq(columns * root[:, None], d * root, rcond=None)[0]
            away = np.abs(d - columns @ found)
            if away.max() < least:
                least, out[:, k] = float(away.max()), found
            if not away.max():
                break
            weights = weights * away / float((weights * away).sum())
    return out


def _reaches(parameters: ParameterFile) -> Mapping[str, float]:
    """The largest prime of every motion that the file offers."""
    out: dict[str, float] = {}
    for c in parameters.offered:
        name, size = motion_of(c.variable), max(abs(c.low), abs(c.high))
        if name in MOTIONS and size > 0.0:
            out[name] = max(out.get(name, 0.0), float(np.sin(size)) if c.variable.startswith("asin(") else size)
    return out


@dataclass(frozen=True, slots=True, eq=False)
class Afloat:
    """Weight and buoyancy as an export writes them, those that `coeflab.motion.vehicle.vehicle` moves the file with.

    Attributes
    ----------
    mass : float
        kg.
    centre, centre_of_buoyancy : (3,) arrays
        From the reference point, m, FRD.
    volume : float
        Displaced, m^3.
    gravity : float
        m/s^2.
    length : float
        m, of a cylinder of that volume, no shorter than thick.
    note : str
        Where volume and centre come from.
    """

    mass: float
    centre: Array
    volume: float
    centre_of_buoyancy: Array
    gravity: float
    length: float
    note: str

    @property
    def radius(self) -> float:
        """Of the cylinder, m."""
        return float(np.sqrt(self.volume / (np.pi * self.length)))


def afloat(parameters: ParameterFile, otherwise: float) -> Afloat:
    """Mass, displaced volume and their centres: what the file has not is neutral, with both centres in one point.

    Parameters
    ----------
    parameters : ParameterFile
    otherwise : float
        kg, the mass that the target takes where the file states neither mass nor buoyancy.
    """
    h, density, length = parameters.hydrostatics, parameters.conditions.density, parameters.scaling.length
    centre = centre_of_gravity(parameters)
    mass = parameters.mass.mass if parameters.mass is not None else otherwise if h is None else density * h.volume
    if h is None:
        volume, at, gravity = mass / density, centre, STANDARD_GRAVITY
        words = "neutrally buoyant, the centre of buoyancy in the centre of gravity: the file states no buoyancy"
        if parameters.mass is None:
            words = f"neutrally buoyant at {mass:g} kg: the file states neither weight nor buoyancy; write mass and volume together"
    else:
        volume, at, gravity = h.volume, np.array(h.centre_of_buoyancy), h.gravity
        x, y, z = (f"{v:g}" for v in at)
        words = f"displaced volume {volume:g} m^3 at ({x}, {y}, {z}) m, FRD from the reference point, of the file"
        if parameters.mass is None:
            centre = at
            words += f"; the file states no mass: {mass:.6g} kg, neutral, with its centre in that of buoyancy"
    return Afloat(mass, centre, volume, at, gravity, max(length, (4.0 * volume / np.pi) ** (1.0 / 3.0)), words)


def states_buoyancy(parameters: ParameterFile, otherwise: str) -> str:
    """Why an export has no weight and buoyancy, or not the file's: the file states none, or the target does not take them."""
    return "the file's hydrostatics are not in it" if parameters.hydrostatics is not None else otherwise


def propulsion(parameters: ParameterFile) -> str:
    """That an export has no propulsion, and which thrust keeps the file's speed on a straight course, in words."""
    speed, nu = parameters.conditions.speed, np.zeros((1, 6))
    nu[0, 0] = speed
    thrust = -float(motion_law(parameters)[0].force(nu)[0, 0])
    needed = f": {thrust:.4g} N along x keep {speed:g} m/s straight ahead" if thrust > 0.0 else ""
    if parameters.thrusters:
        return f"propulsion is not in the export{needed}"
    return f"the file has no thruster, so the export has no propulsion{needed}"


def common_changes(parameters: ParameterFile, law: ExportedLaw, *, whole: bool) -> tuple[str, ...]:
    """What any such export changes, in words; `whole` says whether the target takes v^2 and w^2 of the resistance."""
    out = [f"numbers are SI: primes times 1/2 rho L^k at {parameters.conditions.density:g} kg/m^3", *law.statements[1:]]
    terms = [t for t in law.law.terms if t.coefficient]
    if whole and any(resists(t) for t in terms):
        out.append(
            "X0 U^2 is written as u|u| + v^2 + w^2, alike on every course ahead; <coeflab_x0> repeats it for our reader, the target passes it over"
        )
    speed = [t.symbol for t in terms if t.speed_power and slot(t) is not None and not (whole and resists(t))]
    if speed:
        out.append(
            f"u stands for U in {', '.join(speed)} (u v for U v, u|u| or u^2 for U^2): alike on a straight course ahead, in drift "
            "less by 1 - cos(beta) of a term in U, 1 - cos^2(beta) of one in U^2"
        )
    return (*out, propulsion(parameters))


# Of the speed; products such as v|v| err by the first power of a step, which two steps take off.
TOLERANCE, STEP = 1e-6, 1e-5


def canonical_name(term: ForceTerm) -> str | None:
    """What a term is on a straight course ahead, where U = u = |u|: ``Yv`` for Yv, Yuv, Yv|u|; ``X0`` for X0, Xu|u|, Xuu, Xu;
    ``Yv|v|``; None for products of other motions and for terms even in one.
    """
    match [f for f in canonical(term.product) if f[0] != "u"]:
        case []:
            return f"{term.component}0"
        case [(x, 1, True)]:
            return term.component + x
        case [(x, 2, True)]:
            return f"{term.component}{x}|{x}|"
        case _:
            return None


def straight_coefficients(law: ForceLaw, speed: float) -> Mapping[str, float]:
    """Sums of terms alike on a straight course, by their canonical names.

    Parameters
    ----------
    law : ForceLaw
    speed : float
        m/s, at which a term in another power of the speed than its name says counts: Xu of a state of rest is X0 = Xu / U.

    Returns
    -------
    mapping of str to float
        SI: ``X0`` by U^2, ``Yv`` by U, ``Yv|v|`` by no power of U.
    """
    out: dict[str, float] = {}
    for t in law.terms:
        name = canonical_name(t)
        if name is not None:
            ahead = sum(n for v, n, _ in t.product.factors if v == "u")
            rest = t.product.degree - ahead
            out[name] = out.get(name, 0.0) + t.coefficient * speed ** (t.speed_power + ahead + rest - 2)
    return out


def held_when_straight(force: Callable[[Array], Array], law: ForceLaw, speed: float) -> Callable[[ForceTerm], bool]:
    """A test of terms: constants and those linear in one velocity are held if the target's force has them to 1e-6.

    Terms that are alike on a straight course, such as Yv and Yuv, are held together or not at all.

    Parameters
    ----------
    force : callable
        Velocities (n, 6) -> forces (n, 6) of the target, FRD about the file's reference point.
    law : ForceLaw
        Of the file.
    speed : float
        m/s, straight ahead; derivatives are taken there, extrapolated to no step, for a term such as r|r| bends the line.
    """
    straight = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
    wanted = straight_coefficients(law, speed)

    def held(t: ForceTerm) -> bool:
        name = canonical_name(t)
        if name is None or "|" in name or t.speed_power + t.product.degree != 2:
            return False
        i = COMPONENTS.index(t.component)
        if name.endswith("0"):
            theirs, ours = float(force(straight[None])[0, i]), wanted[name] * speed**2
        else:
            step = speed * np.eye(6)[MOTIONS.index(name[1:])]
            slopes = []
            for h in (STEP, STEP / 2.0):
                pair = force(np.array([straight + h * step, straight - h * step]))
                slopes.append(float(pair[0, i] - pair[1, i]) / (2.0 * h * speed))
            theirs, ours = 2.0 * slopes[1] - slopes[0], wanted[name] * speed
        return abs(theirs - ours) <= TOLERANCE * abs(ours)

    return held


COURSE = f"0.5*(abs({AHEAD.prime:g}*u/U + 1) - abs({AHEAD.prime:g}*u/U - 1))"
COURSE_MEANS = "1 ahead, -1 astern: drag astern too"


def has_course(terms: Iterable[ForceTerm]) -> bool:
    """Whether a program needs ``course``, of `COURSE`: for X0' alone, which turns with the direction of motion."""
    return any(t.ahead for t in terms)


_SPELT = re.compile(r"a(dr|ds|db|[uvwpqr](?!dot))")


def expression(term: ForceTerm, place: Callable[[str, str], str], power: str) -> str:
    """A term as an expression.

    Parameters
    ----------
    term : ForceTerm
    place : callable
        Kind and name, as `spelt` has it -> what the program calls the number.
    power : str
        ``^`` or ``**``.
    """
    parts = [f"r{term.length_power}"] if term.length_power else []
    parts.append(place(term.kind, spelt(term.symbol)))
    if term.speed_power > 0:
        parts.append("U" + (f"{power}{term.speed_power}" if term.speed_power > 1 else ""))
    if term.ahead:
        parts.append("course")
    for variable, n, absolute in term.product.factors:
        parts.append((f"abs({variable})" if absolute else variable) + (f"{power}{n}" if n > 1 else ""))
    text, below = "*".join(parts), -term.speed_power
    return text if below <= 0 else f"{text}/U" + (f"{power}{below}" if below > 1 else "")


def spelt(symbol: str) -> str:
    """``Yv|v|'`` as a program can name it: ``Yvav``."""
    return re.sub(r"\|(\w+)\|", r"a\1", symbol.removesuffix("'"))


def sname(name: str) -> str:
    """The SNAME symbol, without prime, of a name that `spelt` made."""
    return name[:1] + _SPELT.sub(r"|\1|", name[1:])


def written_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """Every coefficient of the law, then the ideal fluid's products that no coefficient and no fitted table speaks of."""
    return (*sources_of(parameters).terms, *ideal_terms(parameters))


def written_accelerations(parameters: ParameterFile) -> tuple[dict[str, float], str]:
    """Primed acceleration derivatives that are not zero, and where they come from."""
    water = water_inertia(parameters)
    matrix, source = water.matrix, water.source
    density, primes = parameters.conditions.density, parameters.scaling
    out = {}
    for i, component in enumerate(COMPONENTS):
        for j, motion in enumerate(MOTIONS):
            if matrix[i, j]:
                name = f"{component}{motion}dot"
                out[name] = float(-matrix[i, j] / primes.unit(name, density))
    return out, source


def written_controls(terms: tuple[ForceTerm, ...]) -> tuple[str, ...]:
    """The controls that terms use."""
    used = {v for t in terms for v in t.variables}
    return tuple(c for c in CONTROLS if c in used)


def not_written(parameters: ParameterFile) -> tuple[str, ...]:
    """What no expression of velocities and controls holds: products with an acceleration."""
    dots = [s for s in force_law(parameters).left_out if "dot" in s]
    return tuple(f"{s} (product with an acceleration)" for s in dots if len(derivative(s).factors) > 1)


def written_changes(parameters: ParameterFile, target: str, ideal: str, matrix: str) -> tuple[str, ...]:
    """How any program has the law, in words.

    Parameters
    ----------
    parameters : ParameterFile
    target : str
        Who adds no C_A(nu) nu.
    ideal : str
        As what the ideal fluid's products stand.
    matrix : str
        What the added mass is called.
    """
    water = water_inertia(parameters)
    products = any(t.kind == "potential" for t in written_terms(parameters))
    words = f"; products of the ideal fluid without a measured coefficient are written as {ideal}" if products else ""
    return (
        "axes, signs, primes and reference point are the file's; primes are multiplied by 1/2 rho L^k U^n in the program",
        f"totals are written, for {target} adds no C_A(nu) nu{words}",
        f"{matrix}: {water.source}",
        *water.warnings,
    )
