"""Estimates: forces and derivatives of a body from its outline alone, one file a method, and what a method is.

An estimate is no measurement: each carries its method, its source, the range it was published for and a U95 from the
scatter that its source states and from the spread between methods.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mirror_planes import NAMES, Planes, forbidden, planes_of, planes_through
from coeflab.bodies.orientation import require_orientation
from coeflab.core.errors import InputError
from coeflab.core.registry import Plugin, Registry
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.law.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.law.rigid_body import ideal_force
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, CONTROLS, LINEAR, MOTIONS, derivative
from coeflab.law.transforms import force_transfer, velocity_transfer

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.outline import Outline
    from coeflab.law.added_mass import AddedMass

Forces = Callable[[NDArray[np.float64], dict[str, NDArray[np.float64]]], NDArray[np.float64]]


@brief
@dataclass(frozen=True, slots=True)
class Water:
    """What the body moves through.

    Attributes
    ----------
    density, viscosity, speed : float
        kg/m^3, kinematic m^2/s, m/s of the reference condition.
    roughness : float
        Height on the surface, m; 0 is smooth.
    """

    density: float
    viscosity: float
    speed: float
    roughness: float = 0.0

    def __post_init__(self) -> None:
        for name in ("density", "viscosity", "speed"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise InputError(f"{name} = {value:g}", "a number above zero", column=name)


@brief
@dataclass(frozen=True, slots=True)
class Contribution:
    """What one part gives by one method.

    Attributes
    ----------
    part : str
        Of the outline.
    kind : str
        What the number is of: ``friction``, ``hull lift``, ``fin lift``, ``cross-flow drag`` ... ; contributions of one part
        and one kind by several methods are alternatives, others add up.
    method : str
        Name of the plugin.
    forces : callable
        ``forces(nu, angles)``: (n, 6) X, Y, Z, K, M, N, N and N m, FRD, about the datum, at (n, 6) velocities u, v, w, p, q, r
        of the datum through still water; ``angles`` holds (n,) control angles by name, rad.
    share : float
        95 % half-width over the value, from the scatter that the source states; 0.3 is 30 %. One error for all of a kind.
    citation, place : str
        Key of a work and page or equation.
    outside : str
        Why the part lies outside the range of the source; empty where it is inside.
    each : float
        As ``share``, of what one body's parts scatter apart from others': one error for all of a kind in one group.
    lever : float
        95 % half-width of where the force acts along x, m; one error for all of a kind in one group.
    group : str
        Parts that err together; the part itself where empty.
    scatter : tuple of callable
        95 % half-widths that are no share of the value, each the forces of one independent error; as ``forces``.
    """

    part: str
    kind: str
    method: str
    forces: Forces
    share: float
    citation: str
    place: str
    outside: str = ""
    each: float = 0.0
    lever: float = 0.0
    group: str = ""
    scatter: tuple[Forces, ...] = ()


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Estimates:
    """All estimates of a body.

    Attributes
    ----------
    coefficients : CoefficientSet
        Primed; status ``estimate``, origin ``estimate``, U95 with covariance.
    contributions : tuple of Contribution
    shares : mapping of str to mapping of str to float
        Of each symbol: what each ``part, kind`` gives to its value, primed.
    forces : callable
        As of a contribution: the recommended sum, about the set's reference point.
    notes : tuple of str
        What is assumed or left out, one line each.
    """

    coefficients: CoefficientSet
    contributions: tuple[Contribution, ...]
    shares: dict[str, dict[str, float]]
    forces: Forces
    notes: tuple[str, ...]


@runtime_checkable
class EstimateMethod(Plugin, Protocol):
    """Estimates forces on parts of an outline."""

    def contributions(self, outline: Outline, water: Water) -> tuple[Contribution, ...]:
        """What the method gives for the parts that it is for; empty where there is none.

        Parameters
        ----------
        outline : Outline
        water : Water
        """
        ...


METHODS = Registry("coeflab.estimates", "method of estimates", EstimateMethod, __name__)  # type: ignore[type-abstract]


KINDS_OF_ESTIMATE = "semi-empirical, from the shape"
STEP, GRID = 2e-3, (0.1, 0.2, 0.3)
NOTHING = 1e-9
# Through 1 at no excess, 1.927 / 2 at -0.6 and 1.653 / 2 at -1.2: 95.45 %, as two standard deviations of a normal error.
OF_EXCESS = (-0.0226, -0.1391)
# Of the largest alike: fins of a mesh file in single precision stand 1e-6 rad off their planes.
OF_MESH = 1e-5
LEVERS = {4: (2, -1.0), 5: (1, 1.0)}  # M = -x Z, N = x Y
STEERED = {"dr": ("v", "r"), "ds": ("w", "q"), "db": ("w", "q")}  # motions of the plane that a control steers in
PLANES = (("v", "r", "Y", "N"), ("w", "q", "Z", "M"))
IDEAL = "ideal fluid"
SEPARATED = 0.50  # of a bluff body's ideal fluid, judged: what separated flow takes from it or adds


def estimated(body: Body, water: Water, towed: bool = False, added_mass: AddedMass | None = None) -> Estimates:
    """Estimate all that the methods can of a body.

    Parameters
    ----------
    body : Body
        With an outline.
    water : Water
    towed : bool
        As fits of a campaign on a course ahead state them, bluff bodies too.
    added_mass : AddedMass, optional
        The body's own, at the water's density: it gives the ideal fluid of a body of bluff parts alone.

    Raises
    ------
    InputError
        The body has no outline, nothing in it that a method is for, or axes that its mesh contradicts.
    """
    require_orientation(body)
    outline = body.outline
    if outline is None:
        advice = "Give its body.toml a shape: a mesh, a hull form with fins, or parts."
        raise input_error("bodies.without_outline", name=body.name, advice=advice)
    found: list[Contribution] = []
    for name in METHODS.names():
        with METHODS.guarded(name):
            found += METHODS.load(name).contributions(outline, water)
    if not found:
        raise InputError(f"{body.name}: no hull, fin or bluff part", "an outline with at least one")
    if added_mass is not None and every_way(outline):
        found = [c for c in found if c.kind != IDEAL]
        found.append(_ideal_fluid(outline.bluff[0].name if len(outline.bluff) == 1 else body.name, added_mass))
    contributions = tuple(found)
    return combined(body, outline, contributions, water, towed)


def every_way(outline: Outline) -> bool:
    """Whether a body is of bluff parts alone, which has no course ahead."""
    return bool(outline.bluff) and not (outline.hulls or outline.foils or outline.rings)


def _ideal_fluid(part: str, added_mass: AddedMass) -> Contribution:
    """-C_A(nu) nu of a whole body, about the datum; each entry of the matrix has its own error."""

    def of(matrix: NDArray[np.float64]) -> Forces:
        return shifted(partial(_ideal, matrix), -added_mass.reference_point)

    matrix, half = np.array(added_mass.matrix), added_mass.error
    half, scatter = np.zeros((6, 6)) if half is None else half, []
    for i, j in np.argwhere(np.triu(np.where(half > 0.0, matrix, 0.0))):
        error = np.zeros((6, 6))
        error[i, j] = error[j, i] = half[i, j]
        scatter.append(of(error))
    place = f"-C_A(nu) nu of the added mass by {added_mass.method}"
    return Contribution(part, IDEAL, "added mass", of(matrix), SEPARATED, "lamb1932", place, scatter=tuple(scatter))


def _ideal(
    matrix: NDArray[np.float64], nu: NDArray[np.float64], angles: dict[str, NDArray[np.float64]]
) -> NDArray[np.float64]:
    del angles
    return ideal_force(matrix, nu)


def combined(
    body: Body, outline: Outline, contributions: tuple[Contribution, ...], water: Water, towed: bool = False
) -> Estimates:
    """Coefficients, covariance and shares of contributions.

    Parameters
    ----------
    body : Body
    outline : Outline
    contributions : tuple of Contribution
    water : Water
    towed : bool

    Notes
    -----
    Alternatives of one part and kind: their mean, with the standard deviation of a rectangular distribution between the
    extremes, range / (2 sqrt 3). Half-widths hold 95 % by the fourth cumulant of the sum, `coverage`. Scatter of one kind is common to all of its parts;
    what a source states of single bodies is an error of each group, and so is the place of its force. Kinds are independent.
    What a mirror plane of the solid through the reference point forbids is zero and is left out.
    """
    scaling = body.scaling or _overall(body, outline)
    point = body.reference_point
    functionals = _functionals(
        scaling.length, water.speed, tuple(dict.fromkeys(name for f in outline.foils for name, _ in f.turns))
    )
    symbols = tuple(f.symbol for f in functionals)
    units = np.array([scaling.unit(s[0], water.density, water.speed) for s in symbols])
    free = not towed and every_way(outline)
    rows, levered, errors = _rows(contributions, functionals, units, point, water.speed if free else None)
    symbols = _symbols_of_bluff(symbols) if free else symbols
    kinds: dict[str, dict[str, list[int]]] = {}
    for i, c in enumerate(contributions):
        kinds.setdefault(c.kind, {}).setdefault(c.part, []).append(i)
    value, covariance = np.zeros(len(symbols)), np.zeros((len(symbols), len(symbols)))
    scatter, spread, fourth = (np.zeros(len(symbols)) for _ in range(3))
    shares: dict[str, dict[str, float]] = {s: {} for s in symbols}
    for kind, parts in kinds.items():
        common = np.zeros(len(symbols))
        apart_by: dict[tuple[str, str], NDArray[np.float64]] = {}
        alternatives: dict[str, NDArray[np.float64]] = {}
        for part, members in parts.items():
            mean = np.mean([rows[i] for i in members], axis=0)
            value += mean
            common += mean * float(np.mean([contributions[i].share for i in members]))
            first = contributions[members[0]]
            place = np.mean([levered[i] * contributions[i].lever for i in members], axis=0)
            for what, error in (("size", mean * first.each), ("place", place)):
                at = (what, first.group or part)
                apart_by[at] = apart_by.get(at, np.zeros(len(symbols))) + error
            for s, v in zip(symbols, mean, strict=True):
                if v != 0.0:
                    shares[s][f"{part}, {kind}"] = float(v)
            for i in members if len(members) > 1 else ():
                key = contributions[i].method
                alternatives[key] = alternatives.get(key, np.zeros(len(symbols))) + rows[i] - mean
        for error in (common, *apart_by.values()):
            covariance += np.outer(error, error) / 4.0
            scatter += error**2
        if alternatives:
            apart = np.array(list(alternatives.values()))
            width = (apart.max(axis=0) - apart.min(axis=0)) / np.sqrt(3.0)
            size = np.sqrt(np.sum(apart**2, axis=0))
            along = np.divide(apart, size, out=np.zeros_like(apart), where=size > 0.0)
            covariance += np.outer(width, width) / 4.0 * (along.T @ along)
            spread += width**2
            fourth += width**4
    for error in errors:
        covariance += np.outer(error, error) / 4.0
        scatter += error**2
    narrower = coverage(fourth, scatter + spread)
    covariance *= np.outer(narrower, narrower)
    scatter, spread = scatter * narrower**2, spread * narrower**2
    none = forbidden(symbols, planes := _planes(body, outline))
    value[none], scatter[none], spread[none] = 0.0, 0.0, 0.0
    keep = _counting(symbols, value, scatter + spread)
    works = {s: _works(contributions, rows, i) for i, s in enumerate(symbols)}
    coefficients = tuple(
        Coefficient(
            symbol=symbols[i], value=float(value[i]), u95=float(2.0 * np.sqrt(covariance[i, i])), status=Status.ESTIMATE,
            body=body.name, parts=Parts(model_form=float(np.sqrt(spread[i])), input=float(np.sqrt(scatter[i]))),
            origin="estimate", estimator=KINDS_OF_ESTIMATE, citation=", ".join(works[symbols[i]]),
        )
        for i in keep
    )  # fmt: skip
    found = CoefficientSet(
        coefficients, covariance[np.ix_(keep, keep)], scaling, np.array(point), body.datum, body.name
    )
    return Estimates(
        found, contributions, {symbols[i]: shares[symbols[i]] for i in keep},
        shifted(recommended(contributions), point), _notes(outline, contributions, planes),
    )  # fmt: skip


def coverage(fourth: NDArray[np.float64], square: NDArray[np.float64]) -> NDArray[np.float64]:
    """Half-width that holds 95 % of a sum of rectangular and normal errors, over two standard deviations.

    By the excess of the sum's fourth cumulant, -1.2 of one rectangular error; exact for the normal, for one rectangular error
    and for two alike, whose sum is triangular: 95.45 % lie within 2, 1.653 and 1.927 standard deviations.

    Parameters
    ----------
    fourth, square : (n,) arrays
        Sums of the fourth powers of rectangular half-widths, and of the squares of all, each of two standard deviations.

    Examples
    --------
    >>> coverage(np.array([0.0, 1.0, 2.0]), np.array([1.0, 1.0, 2.0])).round(3)
    array([1.   , 0.827, 0.964])
    """
    squared = square**2  # zero too where a tiny square is below all doubles
    excess = -1.2 * np.divide(fourth, squared, out=np.zeros_like(fourth), where=squared > 0.0)
    return np.asarray(1.0 + OF_EXCESS[0] * excess + OF_EXCESS[1] * excess**2)


def _planes(body: Body, outline: Outline) -> Planes:
    """Mirror planes of the solid through the reference point; of an outline that holds more than the shape, of both."""
    if body.shape is None:
        return False, False, False
    x, y, z = planes_through(body.shape, body.reference_point, [t.place for t in body.thrusters])
    if body.outlined is None:
        return x, y, z
    _, port, top = planes_of(outline, body.reference_point)
    return x, y and port, z and top


def _rows(
    contributions: tuple[Contribution, ...], functionals: tuple[Functional, ...], units: NDArray[np.float64],
    point: NDArray[np.float64], ahead: float | None,
) -> tuple[list[NDArray[np.float64]], list[NDArray[np.float64]], list[NDArray[np.float64]]]:  # fmt: skip
    """Primed coefficients of each contribution, what they gain by a lever of 1 m, and of each error of their scatter.

    ``ahead``: the speed, m/s, of a body of bluff parts, whose symbols are `_symbols_of_bluff`; None of others.
    """
    symbols = tuple(f.symbol for f in functionals)
    full = functionals if ahead is None else _at_full_surge(functionals, ahead)
    rows, levered, errors = [], [], []
    for c in contributions:
        ideal = c.kind == IDEAL
        for k, forces in enumerate((c.forces, *c.scatter)):
            found = _derived(full if ideal else functionals, shifted(forces, point), units)
            value, gained = found if ahead is None else (_of_bluff(symbols, f, ideal) for f in found)
            if k:
                errors.append(value)
            else:
                rows.append(value)
                levered.append(gained)
    return rows, levered, errors


TURNED = ("Yr", "Zq", "Nv", "Mw")  # products of the ideal fluid that a bluff body's law has with u


def _symbols_of_bluff(symbols: tuple[str, ...]) -> tuple[str, ...]:
    """Those of a body that goes every way, with no course ahead: its law must hold in sway and astern.

    Drag along x is u|u|, without what X0 V^2 needs beside it in drift; the products of the ideal fluid are of u, not of V.
    """
    selected = (symbols[i] for i in _bluff_indices(symbols))
    return (*("Xu|u|" if s == "X0" else s for s in selected), *(f"{s[0]}u{s[1:]}" for s in TURNED))


def _bluff_indices(symbols: tuple[str, ...]) -> list[int]:
    gone = {f"X{m}{m}" for m in ("v", "w", "p", "q", "r")}
    return [i for i, s in enumerate(symbols) if s not in gone]


def _of_bluff(symbols: tuple[str, ...], values: NDArray[np.float64], ideal: bool) -> NDArray[np.float64]:
    """The values that belong to `_symbols_of_bluff`."""
    turned = [symbols.index(s) for s in TURNED]
    own = values[turned] * ideal
    rest = np.where(np.isin(np.arange(len(symbols)), turned) & ideal, 0.0, values)
    return np.concatenate([rest[_bluff_indices(symbols)], own])


def _at_full_surge(functionals: tuple[Functional, ...], speed: float) -> tuple[Functional, ...]:
    """The same at u = U in place of u = sqrt(U^2 - v^2 - w^2): for laws in u, which have no tail in |v| of a slope in U."""
    known: dict[int, NDArray[np.float64]] = {}
    for f in functionals:
        if id(f.nu) not in known:
            nu = np.array(f.nu)
            nu[:, 0] = speed
            known[id(f.nu)] = nu
    return tuple(replace(f, nu=known[id(f.nu)]) for f in functionals)


def recommended(contributions: tuple[Contribution, ...]) -> Forces:
    """The sum of contributions about the datum, alternatives by their mean."""
    many: dict[tuple[str, str], int] = {}
    for c in contributions:
        many[c.part, c.kind] = many.get((c.part, c.kind), 0) + 1

    def forces(nu: NDArray[np.float64], angles: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
        out = np.zeros((len(nu), 6))
        for c in contributions:
            out += c.forces(nu, angles) / many[c.part, c.kind]
        return out

    return forces


def shifted(forces: Forces, point: NDArray[np.float64]) -> Forces:
    """Forces about the datum as forces about a point, by velocities of that point."""
    velocity, moment = velocity_transfer(-np.asarray(point)), force_transfer(np.asarray(point))

    def about(nu: NDArray[np.float64], angles: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
        return np.asarray(forces(np.asarray(nu, dtype=float) @ velocity.T, angles) @ moment.T)

    return about


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Functional:
    """One coefficient as weights on forces at motions.

    Attributes
    ----------
    symbol : str
    nu : (n, 6) array
    angles : mapping of str to (n,) array
    component : int
    weights : (n,) array
        Per prime units of the variables.
    """

    symbol: str
    nu: NDArray[np.float64]
    angles: dict[str, NDArray[np.float64]]
    component: int
    weights: NDArray[np.float64]


def _motions(length: float, speed: float, **primed: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 6) velocities at the whole speed U from v' w' and p' q' r'."""
    count = len(next(iter(primed.values())))
    nu = np.zeros((count, 6))
    for name, values in primed.items():
        nu[:, MOTIONS.index(name)] = values * (speed if name in LINEAR else speed / length)
    nu[:, 0] = np.sqrt(speed**2 - nu[:, 1] ** 2 - nu[:, 2] ** 2)
    return nu


def _functionals(length: float, speed: float, controls: tuple[str, ...]) -> tuple[Functional, ...]:
    """All coefficients that are asked for, each as a linear functional of the forces.

    With D(h) = (f(h) - f(-h)) / 2h = a + b h of a force that goes as a x + b x|x|: a = 2 D(h) - D(2h), b = (D(2h) - D(h)) / h.
    """
    out = []
    steps = STEP * np.array([1.0, -1.0, 2.0, -2.0, 0.0])
    first = np.array([1.0, -1.0, -0.25, 0.25, 0.0]) / STEP
    second = np.array([-0.5, 0.5, 0.25, -0.25, 0.0]) / STEP**2
    even = np.array([0.5, 0.5, 0.0, 0.0, -1.0]) / STEP**2
    rest = np.array([0.0, 0.0, 0.0, 0.0, 1.0])
    ahead = _motions(length, speed, v=np.zeros(5))
    out += [Functional(f"{c}0", ahead, {}, i, rest) for i, c in enumerate(COMPONENTS)]
    for m in ("v", "w", "p", "q", "r"):
        nu = _motions(length, speed, **{m: steps})
        out += [Functional(f"{c}{m}", nu, {}, i, first) for i, c in enumerate(COMPONENTS) if c != "X"]
        out += [Functional(f"{c}{m}|{m}|", nu, {}, i, second) for i, c in enumerate(COMPONENTS) if c != "X"]
        out.append(Functional(f"X{m}{m}", nu, {}, 0, even))
    out += [f for slide, turn, *two in PLANES for f in _coupled(length, speed, slide, turn, two)]
    for control in (c for c in controls if c in CONTROLS):
        angles = {control: steps}
        out += [Functional(f"{c}{control}", ahead, angles, i, first) for i, c in enumerate(COMPONENTS) if c != "X"]
        out.append(Functional(f"X{control}{control}", ahead, angles, 0, even))
        out += [_steered(length, speed, motion, control) for motion in STEERED[control]]
    return tuple(out)


def _steered(length: float, speed: float, motion: str, control: str) -> Functional:
    """Xvdr, Xrdr and the like: the lift of a turned foil in drift or a turn has a part along x, which slows a turn."""
    wide = 1.0 if motion in LINEAR else 2.0
    a, b = (
        g.ravel()
        for g in np.meshgrid(
            [s * wide * x for s in (-1.0, 1.0) for x in GRID], [s * x for s in (-1.0, 1.0) for x in GRID]
        )
    )
    none = np.zeros_like(a)
    nu = _motions(length, speed, **{motion: np.concatenate([a, a, none, none])})
    signs = np.repeat([1.0, -1.0, -1.0, 1.0], len(a))
    product = np.linalg.pinv((a * b)[:, None])[0]
    return Functional(
        f"X{motion}{control}", nu, {control: np.concatenate([b, none, b, none])}, 0, np.tile(product, 4) * signs
    )


def _coupled(length: float, speed: float, slide: str, turn: str, components: list[str]) -> list[Functional]:
    """v|r| and |v|r of the side, vr of X, by least squares over drift and rate together; of the other plane alike."""
    a, b = (
        g.ravel()
        for g in np.meshgrid([*(-x for x in GRID), *GRID], [*(-2.0 * x for x in GRID), *(2.0 * x for x in GRID)])
    )
    none = np.zeros_like(a)
    nu = np.vstack([
        _motions(length, speed, **{slide: x, turn: y}) for x, y in ((a, b), (a, none), (none, b), (none, none))
    ])  # fmt: skip
    signs = np.repeat([1.0, -1.0, -1.0, 1.0], len(a))
    out = []
    both = np.linalg.pinv(np.column_stack([a * np.abs(b), np.abs(a) * b]))
    for c in components:
        for name, row in ((f"{slide}|{turn}|", both[0]), (f"|{slide}|{turn}", both[1])):
            out.append(Functional(f"{c}{name}", nu, {}, COMPONENTS.index(c), np.tile(row, 4) * signs))
    product = np.linalg.pinv((a * b)[:, None])[0]
    out.append(Functional(f"X{slide}{turn}", nu, {}, 0, np.tile(product, 4) * signs))
    return out


def _derived(
    functionals: tuple[Functional, ...], forces: Forces, units: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(k,) primed coefficients of one law of forces, and what they gain if the force acts 1 m further forward.

    Each set of motions is computed once.
    """
    known: dict[tuple[int, tuple[str, ...]], NDArray[np.float64]] = {}
    out, gained = np.empty(len(functionals)), np.zeros(len(functionals))
    for i, f in enumerate(functionals):
        key = (id(f.nu), tuple(f.angles))
        if key not in known:
            known[key] = forces(f.nu, f.angles)
        out[i] = known[key][:, f.component] @ f.weights
        if f.component in LEVERS:
            row, sign = LEVERS[f.component]
            gained[i] = sign * known[key][:, row] @ f.weights
    return out / units, gained / units


def _counting(symbols: tuple[str, ...], values: NDArray[np.float64], scatter: NDArray[np.float64]) -> list[int]:
    """Which coefficients are more than rounding beside the others of their component, and beside those alike in all planes.

    Alike are forces, or moments, in as many velocities, rates and angles: Mv' is nothing beside Nv', Mw' and their scatter.
    """
    size = np.maximum(np.abs(values), np.sqrt(scatter))
    components, kinds = [s[0] for s in symbols], [_kind(s) for s in symbols]
    out = []
    for i in range(len(symbols)):
        own = max(abs(v) for v, c in zip(values, components, strict=True) if c == components[i])
        alike = max(s for s, k in zip(size, kinds, strict=True) if k == kinds[i])
        if size[i] > max(1e-6 * own, OF_MESH * alike, NOTHING):
            out.append(i)
    return out


def _kind(symbol: str) -> tuple[str, ...]:
    group = "X" if symbol[0] == "X" else "YZ" if symbol[0] in "YZ" else "KMN"
    factors = derivative(symbol).factors
    return (group, *sorted("slide" if f in LINEAR else "turn" if f in MOTIONS else f[:1] for f in factors))


def _works(contributions: tuple[Contribution, ...], rows: list[NDArray[np.float64]], i: int) -> tuple[str, ...]:
    named = [key for c, row in zip(contributions, rows, strict=True) if row[i] != 0.0 for key in c.citation.split(", ")]
    return tuple(dict.fromkeys(named))


def _overall(body: Body, outline: Outline) -> Scaling:
    """The length over all of what the outline holds.

    Raises
    ------
    InputError
        Nothing of any length.
    """
    ends = [x for h in outline.hulls for x in (h.x[0], h.x[-1])]
    ends += [
        p.centre[0] + s * float((np.abs(p.rotation) @ p.half_extents)[0]) for p in outline.bluff for s in (1.0, -1.0)
    ]
    ends += [x for f in outline.foils for x in (f.root[0] + 0.25 * f.root_chord, f.root[0] - 0.75 * f.root_chord)]
    if not ends or max(ends) <= min(ends):
        raise InputError(f"{body.name} without a length", "a [prime] length in body.toml", column="prime.length")
    return Scaling(float(max(ends) - min(ends)), "length over all")


def _notes(outline: Outline, contributions: tuple[Contribution, ...], planes: Planes) -> tuple[str, ...]:
    """What is assumed and left out."""
    outside = [f"{c.part}, {c.kind}: {c.outside}" for c in contributions if c.outside]
    words = ["Ahead only: no hull lift and no sidewash astern; foils do not stall."]
    mirrored = [name for name, found in zip(NAMES[1:], planes[1:], strict=True) if found]
    words += [f"Mirror planes of the solid: {', '.join(mirrored)}; what they forbid is zero."] if mirrored else []
    words += ["Bluff parts: mean of shielded and not, across each axis and along the motion."] if outline.bluff else []
    return tuple(dict.fromkeys([*words, *outside, *(f"left out: {x}" for x in outline.left_out)]))
