"""The balance of forces along one axis of a moving vehicle, with the hydrodynamic force as sum of candidate terms.

What is known stands on the one side: rigid body, added mass where it is known, weight and buoyancy, thrusters::

    (M nu_dot + C_RB(nu) nu - g - tau)_i = sum_k theta_k phi_k(nu, controls)

with -C_A(nu) nu among the terms, as measured derivatives contain it. Where the added mass is to be found, M is M_RB alone and
the accelerations are terms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief
from coeflab.identify import candidates, identification
from coeflab.identify.series import MotionSeries
from coeflab.identify.windows import Windows, filled, refined, windows
from coeflab.law.rigid_body import rigid_body_force, rigid_body_inertia
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.law.terms import Term
from coeflab.motion.vehicle import Vehicle

# Half-widths of a window: neighbours overlap in three quarters, for their weights fade to both ends; what lies within two
# windows is taken as one stretch.
APART, STRETCH = 0.5, 4.0
SHARES, MORE, TELLING = 8.0, 1.25, 3e-3
WHOLE = 1.5  # times the usual time between the rows of a difference; beyond it a gap
BIASING = 0.05  # of a motion
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
    values = [np.zeros(len(nu)) if t.rate else candidates.column(component, t.term, columns, t.rest) for t in terms]
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
        Rows between those of a difference: noise that neighbours share shows where this is more than its memory. A difference
        across a gap of the record would be motion.
    """
    rows, wide = len(s.time) - 4 * apart, s.time[4 * apart :] - s.time[: -4 * apart]
    parts = [c * s.velocity[k * apart : k * apart + rows] for k, c in enumerate((1.0, -4.0, 6.0, -4.0, 1.0))]
    whole = wide <= WHOLE * np.median(wide)
    return np.asarray(np.sqrt(np.mean(np.square(np.sum(parts, axis=0)[whole]), axis=0) / 70.0))


def correlated(s: MotionSeries, half: float, least: float = TELLING) -> tuple[str, ...]:
    """Motions whose noise neighbouring rows share, so that even and odd rows are no instruments for each other.

    An eighth of half a window apart it is clearly more than between neighbours, and more than a share of the motion: at `BIASING` the
    square of it, which the values are off by, is 0.25 %.
    """
    apart = round(half / SHARES / float(np.median(np.diff(s.time))))
    if apart < 2 or len(s.time) < 8 * apart:
        return ()
    far, size = row_noise(s, apart), np.sqrt(np.mean(np.square(s.velocity), axis=0))
    found = (far > MORE * row_noise(s)) & (far > least * size)
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
