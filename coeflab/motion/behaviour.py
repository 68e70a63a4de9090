"""Two vehicles by what they do at a speed: stability, eigenvalues, turning, zigzag, and the forces of both laws about one point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import listed
from coeflab.law.force_law import ForceLaw
from coeflab.law.symbols import COMPONENTS
from coeflab.law.transforms import force_transfer, velocity_transfer
from coeflab.motion.root_locus import lacking_accelerations
from coeflab.motion.simulation import simulate
from coeflab.motion.small_motions import modes
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.comparison import coefficient_set
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.matching import by_plain_names, on_one_datum
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCovariance
from coeflab.vehicle.stability import stability

CURVES = (("v/U", 1, 0.25), ("w/U", 2, 0.25), ("p L/U", 3, 0.5), ("q L/U", 4, 0.5), ("r L/U", 5, 0.5))
POINTS = 11
MANOEUVRES: tuple[tuple[str, Mapping[str, float], tuple[str, ...]], ...] = (
    (
        "turning_circle",
        {"rudder": float(np.radians(15.0))},
        ("tactical diameter", "turning radius", "steady turning diameter"),
    ),
    ("zigzag", {"rudder": float(np.radians(10.0))}, ("first overshoot", "second overshoot")),
)
PLANES = {
    ("v", "r"): ("YNS", "beta"),
    ("w", "q"): ("ZML", "alpha"),
}  # components, those along the flow too, and incidence
EQUAL = 1e-9


@dataclass(frozen=True, slots=True)
class Behaviour:
    """One figure of two vehicles.

    Attributes
    ----------
    name, unit : str
    a, b : float or None
    difference : float or None
        b - a; of a curve the largest over its grid.
    combined : float or None
        U95 of both, root sum of squares, taken as independent; of a curve where the difference is largest.
    reason : str
        Why there is none, or no U95.
    """

    name: str
    unit: str
    a: float | None
    b: float | None
    difference: float | None
    combined: float | None = None
    reason: str = ""

    @property
    def ratio(self) -> float | None:
        """Difference over combined U95."""
        return abs(self.difference) / self.combined if self.difference is not None and self.combined else None


def under_plain_names(parameters: ParameterFile) -> ParameterFile:
    """The file with every slope under its plain name, for what asks by names: one force on a straight course, no law for a motion."""
    found, _ = by_plain_names(coefficient_set(parameters))
    rows = tuple(replace(c, symbol=f"{c.symbol}'", value_si=None, potential=None) for c in found.coefficients)
    cells = tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in found.covariance)
    return parameters.model_copy(
        update={
            "coefficients": rows,
            "covariance": ParameterCovariance(symbols=tuple(c.symbol for c in rows), matrix=cells),
        }
    )


def behaviour(a: ParameterFile, b: ParameterFile, speed: float) -> tuple[Behaviour, ...]:
    """G_h, G_v, eigenvalues, turning circle at 15 deg, zigzag 10/10, and curves of forces over drift and rates.

    Parameters
    ----------
    a, b : ParameterFile
        Forces are about the point of the first, where both measure it from one datum or state their centre of gravity.
    speed : float
        m/s.
    """
    b, _ = on_one_datum(a, b)
    return (*_indices(a, b), *_eigenvalues(a, b, speed), *_figures(a, b, speed), *_curves(a, b, speed))


def _pair(
    name: str, unit: str, values: tuple[float | None, float | None], reason: str = "", combined: float | None = None
) -> Behaviour:
    one, other = values
    difference = None if one is None or other is None else other - one
    return Behaviour(name, unit, one, other, difference, combined, reason)


def _indices(a: ParameterFile, b: ParameterFile) -> list[Behaviour]:
    both = [{d.name: d for d in stability(f)} for f in (under_plain_names(a), _at_scale_of(under_plain_names(b), a))]
    out = []
    for name in ("G_h", "G_v"):
        one, other = (s.get(name) for s in both)
        if one is None and other is None:
            continue
        halves = [None if d is None or d.result is None else d.result.monte_carlo for d in (one, other)]
        combined = float(np.hypot(*halves)) if all(h is not None for h in halves) else None  # type: ignore[arg-type]
        why = "" if one and other else "mass or a slope is missing in one file"
        found = _pair(
            name, "1", (None if one is None else one.value, None if other is None else other.value), why, combined
        )
        if not why and a.reference_point.origin != b.reference_point.origin:
            why = f"each about its own point, whose datums differ: {a.reference_point.datum}, {b.reference_point.datum}"
            found = replace(found, difference=None, combined=None, reason=why)
        out.append(found)
    return out


def _at_scale_of(b: ParameterFile, a: ParameterFile) -> ParameterFile:
    """A file by the length and about the point of another, coefficients and mass; as it is where their datums differ.

    The index is a ratio whose parts depend on the point: two of other datums are no difference.
    """
    if a.reference_point.origin != b.reference_point.origin:
        return b
    found = coefficient_set(b).to_length(a.scaling).about(np.array(a.reference_point.point))
    rows = tuple(replace(c, symbol=f"{c.symbol}'", value_si=None, potential=None) for c in found.coefficients)
    cells = tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in found.covariance)
    mass = b.mass
    if mass is not None:
        shift = float(a.reference_point.point[0] - b.reference_point.point[0])
        moved = replace(
            mass, mass_moment=mass.mass_moment - mass.mass * shift, inertia=None, inertia_matrix=None, centre=None
        )
        mass = moved.primed(a.scaling, b.conditions.density)
    covariance = ParameterCovariance(symbols=tuple(c.symbol for c in rows), matrix=cells)
    update = {
        "scaling": a.scaling,
        "reference_point": a.reference_point,
        "mass": mass,
        "coefficients": rows,
        "covariance": covariance,
    }
    return b.model_copy(update=update)


def _rates(parameters: ParameterFile, speed: float, free: tuple[str, ...]) -> Array:
    """Largest real part first: eigenvalues of small motions about straight ahead, 1/s."""
    result = vehicle(parameters, free)
    at = result.free_columns
    if lacking := lacking_accelerations(result, at):
        raise InputError("no added mass", ", ".join(lacking))
    nu = np.zeros(6)
    nu[0] = speed

    def acceleration(x: Array) -> Array:
        states = np.tile(nu, (len(x), 1))
        states[:, at] = x
        attitude = np.tile([1.0, 0.0, 0.0, 0.0], (len(x), 1))
        return result.acceleration(states, attitude, np.zeros((len(x), 3)), np.zeros(6))[:, at]

    step = 1e-5 * max(speed, 1e-3)
    base, eye = nu[list(at)], np.eye(len(at))
    jacobian = np.column_stack(
        [
            ((acceleration((base + step * e)[None]) - acceleration((base - step * e)[None])) / (2.0 * step))[0]
            for e in eye
        ]
    )
    return np.asarray(modes(jacobian))


def _known(parameters: ParameterFile, free: tuple[str, str]) -> None:
    """Raise where a file states no force in the plane by one of its motions: a zero would be no slope but one that nobody knows."""
    components, angle = PLANES[free]
    terms = [t for t in motion_law(parameters)[0].terms if t.component in components]
    for motion in free:
        if not any({motion, *((angle,) if motion == free[0] else ())} & set(t.variables) for t in terms):
            names = [f"{c}{motion}'" for c in components[:2]]
            raise InputError(f"no force by {motion}", f"{names[0]} and {names[1]}, or terms or a table in {motion}")


def _eigenvalues(a: ParameterFile, b: ParameterFile, speed: float) -> list[Behaviour]:
    out = []
    for plane, free in (("horizontal", ("v", "r")), ("vertical, no weight", ("w", "q"))):

        def rates(p: ParameterFile, free: tuple[str, str] = free) -> Array:
            _known(p, free)
            return np.asarray(np.sort_complex(_rates(p, speed, free))[::-1])

        found, why = _both(rates, a, b)
        for k in range(2):
            values = tuple(None if f is None else float(np.real(f[k])) for f in found)
            out.append(
                _pair(f"eigenvalue {k + 1}, {plane}", "1/s", (values[0], values[1]), why or "no U95 of eigenvalues")
            )
    return out


def _both(function: Callable[[ParameterFile], object], a: ParameterFile, b: ParameterFile) -> tuple[list, str]:  # type: ignore[type-arg]
    found, why = [], ""
    for p in (a, b):
        try:
            found.append(function(p))
        except CoeflabError as wrong:
            found.append(None)
            why = f"{p.name}: {wrong}"[:160]
    return found, why


def _figures(a: ParameterFile, b: ParameterFile, speed: float) -> list[Behaviour]:
    apart = float(np.linalg.norm(np.subtract(a.reference_point.point, b.reference_point.point)))
    own = f"; paths of two points, {apart:.3g} m apart" if apart > EQUAL * a.scaling.length else ""
    out = []
    for name, options, wanted in MANOEUVRES:

        def run(
            p: ParameterFile, name: str = name, options: Mapping[str, float] = options
        ) -> dict[str, tuple[float | None, str]]:
            return {f.name: (f.value, f.unit) for f in simulate(p, name, {**options, "speed": speed}).figures}

        found, why = _both(run, a, b)
        known = [n for n in dict.fromkeys(k for f in found if f for k in f) if any(w in n for w in wanted)]
        for figure in known or [name.replace("_", " ")]:
            pairs = [None if f is None else f.get(figure) for f in found]
            values = [None if x is None else x[0] for x in pairs]
            unit = next((x[1] for x in pairs if x is not None), "")
            out.append(
                _pair(figure, unit, (values[0], values[1]), (why or "no U95 of motions: coeflab uncertainty") + own)
            )
    return out


def _law_at(
    parameters: ParameterFile, point: Array | None
) -> Callable[[Array], tuple[Array, Array, dict[str, NDArray[np.bool_]]]]:
    """Forces (n, 6), their U95 about a point of the file's datum, and where what has no U95 is part of them: there is none there."""
    law, _ = motion_law(parameters)
    shift = np.zeros(3) if point is None else point - np.array(parameters.reference_point.point)
    back, on = velocity_transfer(-shift), force_transfer(shift)
    symbols = list(parameters.covariance.symbols)
    matrix = np.array([[np.nan if v is None else v for v in row] for row in parameters.covariance.matrix]).reshape(
        len(symbols), len(symbols)
    )

    known = {c.symbol for c in parameters.coefficients if c.u95 is not None and c.symbol in symbols}
    known -= {s for s, half in zip(symbols, np.diag(matrix), strict=True) if np.isnan(half)}
    still = np.zeros((6, 6, 6))
    open_terms = dict.fromkeys(t.in_file for t in law.terms if t.in_file not in known)
    parts = {n: ForceLaw(tuple(t for t in law.terms if t.in_file == n), still) for n in open_terms} | {"products of the ideal fluid": ForceLaw((), law.ideal)}  # fmt: skip

    def force(nu: Array) -> tuple[Array, Array, dict[str, NDArray[np.bool_]]]:
        own = nu @ back.T
        value = law.force(own) @ on.T
        columns = {}
        for c in parameters.coefficients:
            if c.u95 and c.symbol in known and c.value is not None:
                more = parameters.model_copy(update={"coefficients": tuple(
                    replace(x, value=x.value + x.u95, value_si=None, potential=None) if x is c and x.value is not None and x.u95 else x
                    for x in parameters.coefficients)})  # fmt: skip
                columns[c.symbol] = (motion_law(more)[0].force(own) @ on.T - value) / c.u95
        size = EQUAL * float(np.max(np.abs(value)))
        without = {name: np.abs(part.force(own) @ on.T) > size for name, part in parts.items()}
        if not columns:
            return value, np.full(value.shape, np.nan), without
        at = [symbols.index(s) for s in columns]
        gradient = np.stack(list(columns.values()), axis=-1)
        spread = np.einsum("nij,jk,nik->ni", gradient, np.nan_to_num(matrix[np.ix_(at, at)]), gradient)
        half = 2.0 * np.sqrt(np.maximum(spread, 0.0))
        half[np.any(list(without.values()), axis=0)] = np.nan
        return value, half, without

    return force


def _curves(a: ParameterFile, b: ParameterFile, speed: float) -> list[Behaviour]:
    same = a.reference_point.origin == b.reference_point.origin
    point = np.array(a.reference_point.point)
    laws = (_law_at(a, None), _law_at(b, point if same else None))
    out = []
    for name, column, reach in CURVES:
        nu = np.zeros((POINTS, 6))
        nu[:, 0] = speed
        nu[:, column] = np.linspace(-reach, reach, POINTS) * (speed if column < 3 else speed / a.scaling.length)
        (one, half, lacks), (other, other_half, other_lacks) = (law(nu) for law in laws)
        largest = float(np.max(np.abs(one)))
        for i, component in enumerate(COMPONENTS):
            difference = other[:, i] - one[:, i]
            if max(float(np.max(np.abs(one[:, i]))), float(np.max(np.abs(other[:, i])))) <= EQUAL * max(largest, 1e-30):
                continue
            at = int(np.argmax(np.abs(difference)))
            size = float(difference[at]) if abs(difference[at]) > EQUAL * max(np.max(np.abs(one[:, i])), 1e-30) else 0.0
            combined = float(np.hypot(half[at, i], other_half[at, i]))
            where = f"largest at {name} = {np.linspace(-reach, reach, POINTS)[at]:.3g}" + (
                "" if same else "; points of other datums"
            )
            if unknown := list(
                dict.fromkeys(n for d in (lacks, other_lacks) for n, moved in d.items() if moved[at, i])
            ):
                where += f"; no U95 of {listed(unknown)}"
            out.append(Behaviour(f"{component} over {name}", "N m" if component in "KMN" else "N", float(one[at, i]), float(other[at, i]),
                                 size, None if np.isnan(combined) or combined == 0.0 else combined, where))  # fmt: skip
    return out
