"""Thrusters of a vehicle with an arm: both models of the URV paper's section 3.6, and the matrix from thrusts to the vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locked

DIRECTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
LETTERS = "XYZKMN"
SINGULAR = 1e-9  # relative: of the largest singular value, and of a pivot of scaled rows
BLADE = 0.7  # of the radius, where the blade is taken
HALVINGS = 200
NO_THRUSTERS_NEEDED = "A free or a held vehicle needs none."


@brief
@dataclass(frozen=True, slots=True)
class TorqueThruster:
    """Thruster of one state (Yoerger, Cooke & Slotine 1990): dOmega/dt = beta tau - alpha Omega |Omega|, T = C Omega |Omega|.

    Attributes
    ----------
    alpha : float
        1/rad: what the water takes.
    beta : float
        1/(kg m^2): what a torque gives.
    thrust : float
        C, N s^2/rad^2.
    strongest : float
        Largest torque, N m.
    """

    alpha: float
    beta: float
    thrust: float
    strongest: float = float("inf")

    @property
    def order(self) -> int:
        """States: Omega."""
        return 1

    def rates(self, state: Array, command: float, density: float) -> Array:
        """(1,) rate of Omega at a torque, N m, which stays within `strongest`."""
        del density
        torque = min(max(command, -self.strongest), self.strongest)
        return np.array([self.beta * torque - self.alpha * state[0] * abs(state[0])])

    def force(self, state: Array, density: float) -> float:
        """Thrust at Omega, N."""
        del density
        return float(self.thrust * state[0] * abs(state[0]))

    def steady(self, thrust: float, density: float) -> tuple[float, Array]:
        """Torque, N m, that holds a thrust, N, and the state that it does so at."""
        del density
        turning = float(np.sign(thrust) * np.sqrt(abs(thrust) / self.thrust))
        return self.alpha / self.beta * turning * abs(turning), np.array([turning])


@brief
@dataclass(frozen=True, slots=True)
class VoltageThruster:
    """Thruster of two states with slip, after Healey, Rock, Cody, Miles & Brown (1994): motor, blade and column of water.

    The URV paper prints the two states and names that work, which was not at hand: the functions of them are not checked against it.

    dOmega/dt = -k1 Omega + k2 V - kh Q; rho A l gamma dv_p/dt = T - rho A delta v_p |v_p|. Blades at 0.7 of the radius see
    U_t = 0.7 R Omega and v_p, at the angle theta = atan2(v_p, U_t) and an incidence pitch - theta; lift is C_L sin(2 incidence),
    drag C_D (1 - cos(2 incidence)), both by 1/2 rho (U_t^2 + v_p^2) A; T = L cos(theta) - D sin(theta) and
    Q = 0.7 R (L sin(theta) + D cos(theta)).

    Attributes
    ----------
    damping, drive, load : float
        k1, 1/s; k2, rad/s^2 per V; kh, 1/(kg m^2).
    radius : float
        m.
    pitch : float
        Of the blade at 0.7 R, rad.
    lift, drag : float
        C_L and C_D, at their largest.
    column : float
        l gamma, length of the water that accelerates with the propeller, m.
    momentum : float
        delta, the share of momentum that leaves.
    strongest : float
        Largest voltage, V.
    """

    damping: float
    drive: float
    load: float
    radius: float
    pitch: float
    lift: float
    drag: float
    column: float
    momentum: float
    strongest: float = float("inf")

    @property
    def order(self) -> int:
        """States: Omega and v_p."""
        return 2

    def _blade(self, state: Array, density: float) -> tuple[float, float]:
        """Thrust, N, and torque, N m, of the blades."""
        across, through = BLADE * self.radius * float(state[0]), float(state[1])
        angle = float(np.arctan2(through, across))
        reverse = across < 0.0
        if reverse:  # the blade runs backwards: the mirror image of what it does ahead
            angle = float(np.arctan2(-through, -across))
        pressure = 0.5 * density * (across**2 + through**2) * np.pi * self.radius**2
        twice = 2.0 * (self.pitch - angle)
        lift, drag = pressure * self.lift * np.sin(twice), pressure * self.drag * (1.0 - np.cos(twice))
        sign = -1.0 if reverse else 1.0
        thrust = sign * (lift * np.cos(angle) - drag * np.sin(angle))
        torque = sign * BLADE * self.radius * (lift * np.sin(angle) + drag * np.cos(angle))
        return float(thrust), float(torque)

    def rates(self, state: Array, command: float, density: float) -> Array:
        """(2,) rates of Omega and v_p at a voltage, V, which stays within `strongest`."""
        thrust, torque = self._blade(state, density)
        volts = min(max(command, -self.strongest), self.strongest)
        area = density * np.pi * self.radius**2
        slowed = self.momentum * area * state[1] * abs(state[1])
        return np.array(
            [
                -self.damping * state[0] + self.drive * volts - self.load * torque,
                (thrust - slowed) / (area * self.column),
            ]
        )

    def force(self, state: Array, density: float) -> float:
        """Thrust at Omega and v_p, N."""
        return self._blade(state, density)[0]

    def steady(self, thrust: float, density: float) -> tuple[float, Array]:
        """Voltage, V, that holds a thrust, N, and the state that it does so at.

        Raises
        ------
        InputError
            No propeller speed gives the thrust.
        """
        wanted = abs(thrust)
        through = float(np.sqrt(wanted / (density * np.pi * self.radius**2 * self.momentum)))
        low, high = 0.0, 1.0
        while self._blade(np.array([high, through]), density)[0] < wanted:
            low, high = high, 2.0 * high
            if high > 1e6:
                raise InputError(f"a thrust of {thrust:g} N", "a thrust that the propeller can hold", column="thrust")
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            short = self._blade(np.array([middle, through]), density)[0] < wanted
            low, high = (middle, high) if short else (low, middle)
        state = np.array([high, through])
        volts = (self.damping * high + self.load * self._blade(state, density)[1]) / self.drive
        sign = float(np.sign(thrust))
        return sign * volts, sign * state


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Thruster:
    """A thruster on the vehicle.

    Attributes
    ----------
    name : str
    place : (3,) array
        From the vehicle's centre of mass, m, FRD.
    axis : (3,) array
        Unit vector of positive thrust, FRD.
    model : TorqueThruster, VoltageThruster or None
        None gives what is ordered at once.
    """

    name: str
    place: Array
    axis: Array
    model: TorqueThruster | VoltageThruster | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "place", locked(self.place))
        axis = np.asarray(self.axis, dtype=float)
        object.__setattr__(self, "axis", locked(axis / np.linalg.norm(axis)))

    @property
    def order(self) -> int:
        """States of its model."""
        return 0 if self.model is None else self.model.order


def thruster_matrix(thrusters: Sequence[Thruster]) -> Array:
    """Theta, (6, k): force and moment on the vehicle about its centre of mass of every thruster's unit thrust (section 3.6)."""
    columns = [np.concatenate([t.axis, np.cross(t.place, t.axis)]) for t in thrusters]
    return np.array(columns).reshape(-1, 6).T


def uncontrolled_directions(matrix: Array) -> tuple[str, ...]:
    """Forces and moments that no thrusts make, in words; none of a matrix of rank six.

    Each row of Theta is scaled by its largest entry, so that units do not matter; what is lost is the space that its columns do not span.
    """
    size = np.max(np.abs(matrix), axis=1, initial=0.0)
    scale = np.where(size > 0.0, size, 1.0)
    left, strength, _ = np.linalg.svd(matrix / scale[:, None])
    rank = int(np.sum(strength > SINGULAR * max(float(np.max(strength, initial=0.0)), SINGULAR)))
    uncontrolled = left[:, rank:] / scale[:, None]
    out = []
    # Reduced to echelon form, so that a direction that is lost by itself stands by itself.
    rows = _echelon(uncontrolled.T)
    for row in rows:
        selected = [k for k in range(6) if abs(row[k]) > 1e-6]
        out.append(DIRECTIONS[selected[0]] if len(selected) == 1 else _together(row, selected))
    return tuple(out)


def _together(row: Array, selected: Sequence[int]) -> str:
    """Directions that come together alone, row times (X, Y, Z, K, M, N) being zero: "sway apart from yaw (N = 0.5 m Y)"."""
    *others, last = selected
    terms = []
    for k in others:
        unit = " m" if k < 3 <= last else ""  # no moment stands before a force
        terms.append(f"{-row[k] / row[last]:+.3g}{unit} {LETTERS[k]}")
    words = " ".join(terms).removeprefix("+")
    first, *rest = (DIRECTIONS[k] for k in selected)
    return f"{first} apart from {' and '.join(rest)} ({LETTERS[last]} = {words})"


def _echelon(rows: Array) -> Array:
    """Reduced row echelon form of independent rows, pivots by size."""
    out, at = np.array(rows), 0
    for column in range(out.shape[1]):
        if at == len(out):
            break
        best = at + int(np.argmax(np.abs(out[at:, column])))
        if abs(out[best, column]) < SINGULAR:
            continue
        out[[at, best]] = out[[best, at]]
        out[at] /= out[at, column]
        for other in range(len(out)):
            if other != at:
                out[other] -= out[other, column] * out[at]
        at += 1
    return out


def thrust_allocation(thrusters: Sequence[Thruster]) -> Array:
    """Theta's pseudo-inverse, (k, 6): thrusts of least squares for a force and moment.

    Raises
    ------
    InputError
        Thrusters that cannot make every force and moment, with those that are lost.
    """
    if not thrusters:
        raise input_error("arm.thrusters_make_every", column="thruster", advice=NO_THRUSTERS_NEEDED)
    matrix = thruster_matrix(thrusters)
    if uncontrolled := uncontrolled_directions(matrix):
        raise input_error(
            "arm.thrusters_make", column="thruster", uncontrolled=", no ".join(uncontrolled), without=NO_THRUSTERS_NEEDED,
        )  # fmt: skip
    return np.asarray(np.linalg.pinv(matrix))


def thruster_forces(thrusters: Sequence[Thruster], states: Array, commands: Array, density: float) -> Array:
    """(k,) thrusts, N; a thruster without a model gives its command."""
    out, at = np.empty(len(thrusters)), 0
    for i, one in enumerate(thrusters):
        out[i] = commands[i] if one.model is None else one.model.force(states[at : at + one.order], density)
        at += one.order
    return out


def thruster_rates(thrusters: Sequence[Thruster], states: Array, commands: Array, density: float) -> Array:
    """Rates of all thrusters' states, one after the other."""
    out, at = np.empty(len(states)), 0
    for one, command in zip(thrusters, commands, strict=True):
        if one.model is not None:
            here = slice(at, at + one.order)
            out[here] = one.model.rates(states[here], float(command), density)
        at += one.order
    return out
