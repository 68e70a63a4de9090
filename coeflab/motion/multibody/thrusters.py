"""Thrusters of a vehicle with an arm: both models of the URV paper's section 3.6, and the matrix from thrusts to the vehicle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief, locked


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


@brief
@dataclass(frozen=True, slots=True)
class VoltageThruster:
    """Thruster of two states with slip (Healey, Rock, Cody, Miles & Brown 1994): motor, blade and column of water.

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
