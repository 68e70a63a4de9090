"""The balance of forces along one axis of a moving vehicle, with the hydrodynamic force as sum of candidate terms.

What is known stands on the one side: rigid body, added mass where it is known, weight and buoyancy, thrusters::

    (M nu_dot + C_RB(nu) nu - g - tau)_i = sum_k theta_k phi_k(nu, controls)

with -C_A(nu) nu among the terms, as measured derivatives contain it. Where the added mass is to be found, M is M_RB alone and
the accelerations are terms.

The weak form of an equation of motion: averages over windows in place of derivatives of noisy measurements.

A test function w(x) = (1 - x^2)^4 on -1 <= x <= 1 vanishes at both ends of its window, so that partial integration moves
the derivative from the measurement to the known function::

    <f> = int w f dt / int w dt        <df/dt> = - int w' f dt / int w dt

Measurements are taken as straight between their times, and the integrals of that are exact for any steps: the rate of a
constant is zero to rounding. Rows that are few for that are joined by splines first. Test functions and their use with
sparse regression: Gurevich, Reinbold & Grigoriev (2019),
Messenger & Bortz (2021), and pysindy's ``WeakPDELibrary``, which wants even steps and draws its windows at random.

Which terms an identification may choose from, by their SNAME symbols.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.identify import identification
from coeflab.identify.series import MotionSeries
from coeflab.law.rigid_body import rigid_body_force, rigid_body_inertia
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.law.terms import Term, parse_suffix
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_file import ParameterFile

POWER = 4
FEWEST = 8
FINE = 300.0
ROUNDING = 1e-9
_TEST = Polynomial([1.0, 0.0, -1.0]) ** POWER
_ONCE = _TEST.integ(lbnd=-1.0)
_TWICE = _ONCE.integ(lbnd=-1.0)
_WHOLE = float(_ONCE(1.0))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Windows:
    """Windows over one time series.

    Attributes
    ----------
    time : (n,) array
        s, rising, any steps.
    centres : (m,) array
    half : float
        Half of a window, s.
    """

    time: Array
    centres: Array
    half: float

    def averages(self, values: Array, rates: Array) -> tuple[Array, Array]:
        """Averages of values and of the rates of others.

        Parameters
        ----------
        values : (n, k) array
        rates : (n, r) array
            Whose derivatives are averaged.

        Returns
        -------
        (m, k) array, (m, r) array
        """
        selected, moved = np.empty((len(self.centres), values.shape[1])), np.empty((len(self.centres), rates.shape[1]))
        for row, centre in enumerate(self.centres):
            rows, of_values, of_rates = self._weights(centre)
            selected[row], moved[row] = of_values @ values[rows], of_rates @ rates[rows]
        return selected, moved

    def _weights(self, centre: float) -> tuple[slice, Array, Array]:
        """Rows of a window, and what each counts for in the average of a value and of a rate."""
        first = max(int(np.searchsorted(self.time, centre - self.half, side="right")) - 1, 0)
        last = min(int(np.searchsorted(self.time, centre + self.half, side="left")) + 1, len(self.time))
        x = (self.time[first:last] - centre) / self.half
        step, inside = np.diff(x), np.clip(x, -1.0, 1.0)
        once = _ONCE(inside)
        area = np.diff(once)
        # Beyond the window the first integral stays, and the second one rises straight.
        lean = once[1:] * step - np.diff(_TWICE(inside) + _WHOLE * np.maximum(x - 1.0, 0.0))
        of_values, of_rates = np.zeros(len(x)), np.zeros(len(x))
        of_values[:-1] += area - lean / step
        of_values[1:] += lean / step
        of_rates[:-1] -= area / step
        of_rates[1:] += area / step
        return slice(first, last), of_values / _WHOLE, of_rates / (_WHOLE * self.half)


def refined(time: Array, columns: Array, half: float) -> tuple[Array, Array]:
    """The rows with others between them, on cubic splines, so that a window has `FINE` rows: straight pieces cut corners.

    Parameters
    ----------
    time : (n,) array
    columns : (n, k) array
    half : float
        Half of a window, s.
    """
    from scipy.interpolate import CubicSpline

    parts = int(np.ceil(FINE * float(np.median(np.diff(time))) / (2.0 * half)))
    if parts < 2:
        return time, columns
    between = np.concatenate([(time[:-1, None] + np.diff(time)[:, None] * np.arange(parts) / parts).ravel(), time[-1:]])
    return between, np.asarray(CubicSpline(time, columns, axis=0)(between))


def windows(time: Array, half: float, apart: float) -> Windows:
    """Windows at even distances over a series; those with too few rows or over a gap are left out.

    Parameters
    ----------
    time : (n,) array
    half : float
        Half of a window, s.
    apart : float
        Distance of the centres, s.
    """
    count = int(np.floor((time[-1] - time[0] - 2.0 * half) / apart * (1.0 + 1e-12))) + 1
    centres = time[0] + half + apart * np.arange(max(count, 0))
    return Windows(time, centres[filled(time, centres, half)], half)


def filled(time: Array, centres: Array, half: float) -> NDArray[np.bool_]:
    """(m,) whether a window has `FEWEST` rows at least, reaches over no end, and no step longer than a quarter of it."""
    low = np.searchsorted(time, centres - half, side="left")
    high = np.searchsorted(time, centres + half, side="right")
    inside = (centres - half >= time[0] - ROUNDING * half) & (centres + half <= time[-1] + ROUNDING * half)
    good: NDArray[np.bool_] = (high - low >= FEWEST) & inside
    for gap in np.flatnonzero(np.diff(time) > 0.5 * half):
        good &= (time[gap] >= centres + half) | (time[gap + 1] <= centres - half)
    return good


# Half-widths of a window: neighbours overlap in three quarters, for their weights fade to both ends; what lies within two
# windows is taken as one stretch.
APART, STRETCH = 0.5, 4.0
SHARES, MORE, TELLING = 8.0, 1.25, 3e-3
NOISE = 0.5  # share of a motion's power: with less of it told twice alike, noise is most of what is seen


@brief
@dataclass(frozen=True, slots=True)
class Candidate:
    """A term of the hydrodynamic force.

    Attributes
    ----------
    symbol : str
        SNAME, without prime.
    component : str
    term : Term
        Empty for an acceleration.
    per_prime : float
        SI coefficient of one primed unit.
    rest : bool
        Damping about a state of rest.
    rate : str
        Motion whose acceleration it is, or empty.
    """

    symbol: str
    component: str
    term: Term
    per_prime: float
    rest: bool = False
    rate: str = ""

    @property
    def needs(self) -> frozenset[str]:
        """Motions and controls in it, but for the speed."""
        return frozenset({v for v, _, _ in self.term.factors} | ({self.rate} if self.rate else set()))


def known(s: MotionSeries, vehicle: Vehicle) -> Array:
    """(n, 6) force and moment of weight, buoyancy and thrusters."""
    return np.asarray(vehicle.restoring(s.attitude) + s.wrench)


def _sides(s: MotionSeries, vehicle: Vehicle, component: str, terms: Sequence[Candidate]) -> tuple[Array, Array, Array]:
    """Values of terms and load (n, p + 1), momentum (n, 1) and velocities, whose rates belong to the balance.

    The vehicle's law is what is known of the hydrodynamic force: fitted tables that no term speaks of.
    """
    i, nu = COMPONENTS.index(component), np.asarray(s.velocity)
    columns = dict(zip((*MOTIONS, *CONTROLS), np.hstack([nu, s.controls]).T, strict=True))
    values = [np.zeros(len(nu)) if t.rate else identification.column(component, t.term, columns, t.rest) for t in terms]
    load = (
        rigid_body_force(vehicle.mass, vehicle.centre, vehicle.inertia, nu) - vehicle.restoring(s.attitude) - s.wrench
    )
    if vehicle.law.terms:
        load = load - vehicle.force(nu, s.controls)
    added = vehicle.added * (0.0 if any(t.rate for t in terms) else 1.0)
    mass = rigid_body_inertia(vehicle.mass, vehicle.centre, vehicle.inertia) + added
    return np.column_stack([*values, load[:, i]]), nu @ mass[i], nu


def _joined(values: Array, momentum: Array, rates: Array, terms: Sequence[Candidate]) -> Array:
    """(m, p + 1) columns and response: accelerations in their places, the momentum's rate with the load."""
    out = values.copy()
    for k, t in enumerate(terms):
        if t.rate:
            out[:, k] = rates[:, MOTIONS.index(t.rate)]
    out[:, -1] += momentum
    return out


def _halves(s: MotionSeries) -> tuple[MotionSeries, MotionSeries]:
    """Even and odd rows."""
    first, second = (
        replace(
            s, time=s.time[k::2], velocity=s.velocity[k::2], attitude=s.attitude[k::2], controls=s.controls[k::2],
            wrench=s.wrench[k::2],
        )
        for k in (0, 1)
    )  # fmt: skip
    return first, second


def centres(s: MotionSeries, half: float) -> Array:
    """Middles of the windows that both halves of the rows fill, s."""
    first, second = _halves(s)
    start, end = max(first.time[0], second.time[0]), min(first.time[-1], second.time[-1])
    found = windows(s.time[(s.time >= start) & (s.time <= end)], half, APART * half).centres
    return np.asarray(found[filled(first.time, found, half) & filled(second.time, found, half)])


def weak(
    series: Sequence[MotionSeries], vehicle: Vehicle, component: str, terms: Sequence[Candidate], half: float
) -> identification.Products:
    """The balance averaged over windows of ``2 half`` seconds, once over the even and once over the odd rows."""
    sides: tuple[list[Array], list[Array]] = ([], [])
    stretch: list[NDArray[np.int64]] = []
    for s in series:
        middles, noise = centres(s, half), row_noise(s)
        for part, out in zip(_halves(s), sides, strict=True):
            values, momentum, nu = _sides(part, vehicle, component, terms)
            values = _unbiased(part, vehicle, component, terms, values, noise)
            time, fine = refined(part.time, np.column_stack([values, nu, momentum]), half)
            selected, moved = Windows(time, middles, half).averages(*np.split(fine, [values.shape[1]], axis=1))
            out.append(_joined(selected, moved[:, -1], moved[:, :-1], terms))
        stretch.append(stretches(middles, half))
    return identification.products(np.vstack(sides[0]), np.vstack(sides[1]), _numbered(stretch))


def row_noise(s: MotionSeries, apart: int = 1) -> Array:
    """(6,) standard deviation of the noise on every velocity, from fourth differences, which motions hardly have.

    Parameters
    ----------
    s : MotionSeries
    apart : int
        Rows between those of a difference: noise that neighbours share shows where this is more than its memory.
    """
    rows = len(s.time) - 4 * apart
    parts = [c * s.velocity[k * apart : k * apart + rows] for k, c in enumerate((1.0, -4.0, 6.0, -4.0, 1.0))]
    return np.asarray(np.sqrt(np.mean(np.square(sum(parts)), axis=0) / 70.0))


def correlated(s: MotionSeries, half: float) -> tuple[str, ...]:
    """Motions whose noise neighbouring rows share, so that even and odd rows are no instruments for each other.

    An eighth of half a window apart it is clearly more than between neighbours, and more than 0.3 % of the motion.
    """
    apart = round(half / SHARES / float(np.median(np.diff(s.time))))
    if apart < 2 or len(s.time) < 8 * apart:
        return ()
    far, size = row_noise(s, apart), np.sqrt(np.mean(np.square(s.velocity), axis=0))
    found = (far > MORE * row_noise(s)) & (far > TELLING * size)
    return tuple(m for m, shared in zip(MOTIONS, found, strict=True) if shared)


def _unbiased(
    s: MotionSeries, vehicle: Vehicle, component: str, terms: Sequence[Candidate], values: Array, noise: Array
) -> Array:
    """Values without what noise adds to squares on average: half its variance times the second derivative."""
    out = values.copy()
    for k in np.flatnonzero(noise > 0.0):
        step = np.where(np.arange(len(noise)) == k, noise[k], 0.0)
        up, down = (_sides(replace(s, velocity=s.velocity + e), vehicle, component, terms)[0] for e in (step, -step))
        out -= 0.5 * (up + down - 2.0 * values)
    return out


def differenced(
    series: Sequence[MotionSeries], vehicle: Vehicle, component: str, terms: Sequence[Candidate], half: float
) -> identification.Products:
    """The balance at every row, accelerations by central differences: ordinary least squares, for clean series."""
    rows, stretch = [], []
    for s in series:
        values, momentum, nu = _sides(s, vehicle, component, terms)
        rates = np.gradient(np.column_stack([nu, momentum]), s.time, axis=0)
        rows.append(_joined(values, rates[:, -1], rates[:, :-1], terms))
        stretch.append(stretches(s.time, half))
    return identification.products(np.vstack(rows), np.vstack(rows), _numbered(stretch))


def stretches(time: Array, half: float) -> NDArray[np.int64]:
    """(n,) number of the stretch of time that a row belongs to."""
    return np.floor((time - time[0]) / (STRETCH * half)).astype(np.int64) if len(time) else np.zeros(0, dtype=np.int64)


def _numbered(parts: Sequence[NDArray[np.int64]]) -> NDArray[np.int64]:
    """Stretches of all series, numbered on."""
    out, so_far = [], 0
    for one in parts:
        _, place = np.unique(one, return_inverse=True)
        out.append(place.astype(np.int64) + so_far)
        so_far += int(place.max(initial=-1)) + 1
    return np.concatenate(out)


def excited(series: Sequence[MotionSeries], half: float) -> dict[str, float]:
    """Share of the power of every motion and control that is no noise, from averages over both halves of the rows."""
    both: tuple[list[Array], list[Array]] = ([], [])
    for s in series:
        middles = centres(s, half)
        for part, out in zip(_halves(s), both, strict=True):
            columns = np.hstack([part.velocity, part.controls])
            out.append(Windows(part.time, middles, half).averages(columns, columns[:, :1])[0])
    share = identification.reliability(np.vstack(both[0]), np.vstack(both[1]))
    return dict(zip((*MOTIONS, *CONTROLS), map(float, share), strict=True))


def candidate_terms(
    parameters: ParameterFile,
    moving: frozenset[str],
    asked: Sequence[str],
    *,
    symmetric: bool,
    accelerations: bool,
    driven: frozenset[str],
) -> list[Candidate]:
    """Candidates of every component whose motion is there.

    Parameters
    ----------
    parameters : ParameterFile
        Its spelling and its scaling are taken.
    moving : frozenset of str
        Motions and controls that the series have.
    asked : sequence of str
        Symbols; ``file`` alone for those of the file; none for terms of the first and second order.
    symmetric : bool
        Leave out what a body symmetric port to starboard cannot have.
    accelerations : bool
        Acceleration derivatives are candidates too, where a force is known that tells them from the rest.
    driven : frozenset of str
        Components along which a force is known: of thrusters, weight or buoyancy.

    Raises
    ------
    InputError
        A symbol that is none, of a component whose motion the series do not have, or an acceleration along which no force
        is known: M nu_dot alone fixes no scale.
    """
    components = [c for c in COMPONENTS if identification.ALONG[c] in moving]
    ordered = [m for m in (*MOTIONS, *CONTROLS) if m in moving]
    if asked and tuple(asked) != ("file",):
        named = [_named(s, parameters) for s in asked]
        strange = [t for t in named if t.component not in components]
        if strange:
            raise input_error(
                "identify.terms_series_have", column="identify.terms", found=strange[0].symbol,
                components=", ".join(components),
            )  # fmt: skip
        loose = [t for t in named if t.rate and t.component not in driven]
        if loose:
            raise input_error(
                "identify.without_known_force", column="identify.terms", symbol=loose[0].symbol, component=loose[0].component,
            )  # fmt: skip
        return named
    if asked:
        symbols = [c.symbol for c in parameters.coefficients if c.value is not None]
        listed = [t for t in (_named(s, parameters) for s in symbols) if t.component in components]
        return [t for t in listed if not t.rate or (accelerations and t.component in driven)]
    out: list[Candidate] = []
    for c in components:
        result = identification.candidates(c, ordered, symmetric)
        out += [_named(_written(c, t, parameters), parameters) for t in result]
        if accelerations and c in driven:
            free = [m for m in MOTIONS if m in moving]
            dots = [m for m in free if not symmetric or identification.allowed(c, Term(((m, 1, False),)))]
            out += [_named(f"{c}{m}dot", parameters) for m in dots]
    return out


def _written(component: str, term: Term, parameters: ParameterFile) -> str:
    """The symbol of a term as the file spells it, where it has it."""
    for c in parameters.coefficients:
        if c.symbol[0] == component and not any(f.endswith("dot") for f in derivative(c.symbol).factors):
            text = derivative(c.symbol).text
            if identification.same(parse_suffix(text[1:]), term):
                return text
    return component + term.suffix


def _named(symbol: str, parameters: ParameterFile) -> Candidate:
    """A candidate by its SNAME symbol."""
    d = derivative(symbol)
    entry = parameters.coefficient(d.text)
    at, primes = parameters.conditions, parameters.scaling
    per_prime = primes.unit(d.text, at.density)
    dots = [f for f in d.factors if f.endswith("dot")]
    if dots:
        if len(d.factors) > 1 or "|" in d.text:
            raise InputError(shown(symbol), "an acceleration by itself, such as Yvdot", column="identify.terms")
        return Candidate(d.text, d.component, Term(), per_prime, rate=dots[0].removesuffix("dot"))
    rest = entry is not None and entry.law == "rest"
    if rest:
        per_prime = primes.unit(d.text, at.density, at.speed)
    return Candidate(d.text, d.component, parse_suffix(d.text[1:]), per_prime, rest)
