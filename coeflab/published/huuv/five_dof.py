"""The HUUV in five degrees of freedom by the paper's equations 1-33, errata corrected.

Axes FRD from the centre of buoyancy; the roll is held. Velocities nu = (u, v, w, q, r)::

    M nu' + C(nu) nu + D(nu, delta) + g(theta) = tau                                          (1)
    F_D = V^2 C_D(alpha, beta),  F_S = V^2 C_S(beta),  F_L = V^2 C_L(alpha)                   (8-10)
    M_q = V^2 C_m(alpha) + M_mq,  M_r = V^2 C_m(beta) + M_mr                                  (11, 12)
    elevators: the same with V_xz^2 = u^2 + w^2, C(delta - alpha) - C(-alpha)                 (13-17)

Coefficients have density, area and length in them. The tables end at 25 deg of incidence, where their last value stays.

Two things the errata do not name, and what is done here. Equation 23 leaves the elevators out of F_x although equation 15
computes their drag: it is in. Equations 15-17 give a force at delta = 0 too, which the hull's tables with neutral elevators
hold already: of the elevators only what the deflection adds counts, C(delta - alpha) - C(-alpha).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np

from coeflab.bodies.added_mass.primitives import added_mass
from coeflab.bodies.body import Body
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Cylinder, Parts, Plate
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array, brief, locking
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.rigid_body import rigid_body_inertia
from coeflab.law.transforms import incidence
from coeflab.published.huuv.model import Huuv, thrust

Masses = Literal["stated", "geometry"]
AT = (0, 1, 2, 4, 5)  # u v w q r among u v w p q r
KINDS: Mapping[str, Any] = {
    "weight.centre_below": takes.Length, "weight.displaced": takes.Volume, "weight.pitch_inertia": takes.Inertia,
    "vertical.tuned_by": takes.Pure, "elevator.area": takes.Area, "elevator.length": takes.Length,
    "elevator.lever": takes.Length, "elevator.largest_angle": takes.Angle,
}  # fmt: skip
ELEVATOR = ("C_D0", "C_D2", "C_L1", "C_L3", "C_m1", "C_m3")
BODY = "huuv_assumed"


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("geometry")
class FiveDof:
    """The vehicle, SI and rad, FRD about the centre of buoyancy.

    Attributes
    ----------
    level : Huuv
        What the horizontal plane has: constants, thrusters, errata.
    constants : mapping
        Those of five_dof.toml, by their keys without the table.
    masses : {"stated", "geometry"}
        Whether m_x, m_y, m_yr and J_z are those of the steady turns, or of the assumed geometry as all others are.
    geometry : (6, 6) array
        Added mass of the assumed geometry by equations 28-32 as corrected.
    """

    level: Huuv
    constants: Mapping[str, float]
    masses: Masses
    geometry: Array

    @property
    def density(self) -> float:
        """kg/m^3."""
        return self.level.chosen["density"]

    @property
    def weight(self) -> float:
        """F_w, N."""
        return self.level.constants["m"] * STANDARD_GRAVITY

    @property
    def buoyancy(self) -> float:
        """F_B, N."""
        return self.density * self.constants["displaced"] * STANDARD_GRAVITY

    @property
    def added(self) -> Array:
        """(6, 6) M_A."""
        out = np.array(self.geometry)
        if self.masses == "stated":
            c = self.level.constants
            out[0, 0], out[1, 1] = c["mx"], c["my"]
            out[1, 5] = out[5, 1] = c["myr"]
            out[5, 5] = c["inertia"] - self.level.chosen["rigid_inertia"]
        return out

    @property
    def rigid(self) -> Array:
        """(6, 6) M_RB; the roll's moment of inertia is a place holder."""
        about = np.diag([0.0, self.constants["pitch_inertia"], self.level.chosen["rigid_inertia"]])
        return rigid_body_inertia(
            self.level.constants["m"], np.array([0.0, 0.0, self.constants["centre_below"]]), about
        )


def read_five_dof(level: Huuv, masses: Masses = "stated", folder: Path | None = None) -> FiveDof:
    """The shipped vehicle.

    Parameters
    ----------
    level : Huuv
    masses : {"stated", "geometry"}
    folder : Path, optional
        With five_dof.toml; the shipped one where None.

    Raises
    ------
    InputError
        A file that is missing or does not say what it must.
    """
    if masses not in get_args(Masses):
        raise InputError(f"the masses {masses!r}", " or ".join(get_args(Masses)))
    file = read_toml((shipped("cfd_data") / "huuv" if folder is None else folder) / "five_dof.toml")
    keys = {**{k: Annotated[kind, takes.ABOVE_ZERO] for k, kind in KINDS.items()},
            **{f"elevator.{name}": takes.Pure for name in ELEVATOR}}  # fmt: skip
    constants = {k.partition(".")[2]: takes.declared_key(file, k, kind) for k, kind in keys.items()}
    return FiveDof(level, constants, masses, geometry_matrix(assumed_body(), level.chosen["density"]))


def assumed_body() -> Body:
    """Hull, mast and elevators with assumed radii and spans."""
    return read_body(shipped("geometry") / BODY / "body.toml")


def geometry_matrix(body: Body, density: float) -> Array:
    """(6, 6) added mass of hull, mast and elevators, every part moved to the common origin."""
    return np.array(added_mass(body, density, {"cylinder_ends": "huuv"}).matrix)


def simple_masses(body: Body, density: float) -> dict[str, float]:
    """Equations 28-32 as corrected, in the paper's own symbols: m_x, m_y, m_z, J_y, J_z.

    Parameters
    ----------
    body : Body
        A hull cylinder, a mast cylinder on it, and plates alike.
    density : float

    Notes
    -----
    The paper gives the mast on its end no m_z and no k of its own to the plates' turning; both are left out here too.
    """
    from coeflab.bodies.closed_forms.parts import plate_coefficient

    shape = body.require_shape()
    parts = shape.parts if isinstance(shape, Parts) else ()
    cylinders = [p.form for p in parts if isinstance(p.form, Cylinder)]
    plates = [p for p in parts if isinstance(p.form, Plate)]
    if len(cylinders) != 2 or not plates:
        raise InputError(
            f"{body.name}, {len(cylinders)} cylinders and {len(plates)} plates", "hull, mast and elevators"
        )
    (r, long), (rm, tall) = ((c.radius, c.length) for c in cylinders)
    hull, mast = density * np.pi * r**2 * long, density * np.pi * rm**2 * tall
    plate, ahead, normal = plates[0].form, float(plates[0].centre[0]), 0.0
    if isinstance(plate, Plate):
        short, wide = sorted((plate.chord, plate.span))
        normal = len(plates) * plate_coefficient(wide / short) * np.pi / 4.0 * density * short**2 * wide
    return {
        "m_x": 0.1 * hull + mast,
        "m_y": hull + mast,
        "m_z": hull + normal,
        "J_y": hull * long**2 / 12.0 + density * np.pi * rm**2 * ((r + tall) ** 3 - r**3) / 3.0 + ahead**2 * normal,
        "J_z": hull * long**2 / 12.0,
    }


def inertia(huuv: FiveDof) -> Array:
    """(5, 5) M = M_RB + M_A: row 1, column 4 is m z_CG and the m_x of each part times its height."""
    return np.asarray((huuv.rigid + huuv.added)[np.ix_(AT, AT)])


def coriolis(huuv: FiveDof, nu: Array) -> Array:
    """(n, 5, 5) C(nu) in the pattern that the paper prints.

    Where it prints m_z z_CG, C has the moments of the added masses: -sum(m_x z) beside u, sum(m_y z) beside v.
    """
    m, added = inertia(huuv), huuv.added
    weighed = huuv.level.constants["m"] * huuv.constants["centre_below"]
    surge, sway = added[0, 4], -added[1, 3]
    u, v, w, q, r = nu.T
    along = m[0, 0] * u
    lateral, vertical = m[1, 1] * v + m[1, 4] * r, m[2, 2] * w + m[2, 3] * q
    out = np.zeros((len(nu), 5, 5))
    out[:, 0, 3], out[:, 0, 4] = vertical, -lateral
    out[:, 1, 3], out[:, 1, 4] = weighed * r, along + surge * q
    out[:, 2, 3] = -(weighed + surge) * q - along
    out[:, 3, 4] = -sway * v
    return np.asarray(out - np.swapaxes(out, 1, 2))


def restoring(huuv: FiveDof, pitch: Array) -> Array:
    """(n, 5) g(eta); the fourth row rights the vehicle."""
    out, light = np.zeros((len(pitch), 5)), huuv.weight - huuv.buoyancy
    out[:, 0], out[:, 2] = light * np.sin(pitch), -light * np.cos(pitch)
    out[:, 3] = huuv.constants["centre_below"] * huuv.weight * np.sin(pitch)
    return out


def hull_laws(huuv: FiveDof, alpha: Array, beta: Array) -> dict[str, Array]:
    """C_D, C_S, C_L, C_m(alpha), C_m(beta) with density, area and length, N/(m/s)^2 and N m/(m/s)^2; C_D(0) once.

    Moments are positive where they turn the bow towards the velocity.
    """
    c, by = huuv.level.constants, huuv.constants["tuned_by"]
    return {
        "C_D": c["d0"] + c["d2"] * alpha**2 + c["d2"] * beta**2,
        "C_S": c["s1"] * beta + c["s3"] * beta**3,
        "C_L": (c["s1"] * alpha + c["s3"] * alpha**3) / by,
        "C_m alpha": pitch_slope(huuv) * alpha + c["n3"] / by * alpha**3,
        "C_m beta": c["n1"] * beta + c["n3"] * beta**3,
    }


def pitch_slope(huuv: FiveDof) -> float:
    """Slope of C_m(alpha): what undoes the Munk moment of C_A, as the yaw slope fitted beside the chosen m_x and m_y does, and half of the rest."""
    c, added = huuv.level.constants, huuv.added
    viscous = c["n1"] - (c["my"] - c["mx"])
    return float(added[2, 2] - added[0, 0] + viscous / huuv.constants["tuned_by"])


def turning_laws(huuv: FiveDof, q: Array, r: Array) -> tuple[Array, Array]:
    """M_mq and M_mr against the rates, N m."""
    c, by = huuv.level.constants, huuv.constants["tuned_by"]
    pitching, yawing = (c["nr"] * x + c["nrr"] * x * np.abs(x) for x in (q, r))
    return pitching / by, yawing


def elevator_laws(huuv: FiveDof, angle: Array) -> tuple[Array, Array, Array]:
    """C_D, C_L and C_m of the elevators over delta - alpha."""
    c = huuv.constants
    return (
        c["C_D0"] + c["C_D2"] * angle**2,
        c["C_L1"] * angle + c["C_L3"] * angle**3,
        c["C_m1"] * angle + c["C_m3"] * angle**3,
    )


def angles(nu: Array) -> tuple[Array, Array, Array]:
    """V, alpha and beta of velocities (n, 5) (equations 2-4; atan2, and zero at rest)."""
    u, v, w = nu[:, :3].T
    return (np.sqrt(u**2 + v**2 + w**2), *incidence(u, v, w))


def hull_damping(huuv: FiveDof, nu: Array) -> Array:
    """(n, 5) of the hull with neutral elevators, against the motion (equations 5-12, corrected)."""
    speed, alpha, beta = angles(nu)
    end = huuv.level.chosen["largest_drift"]
    laws = hull_laws(huuv, np.clip(alpha, -end, end), np.clip(beta, -end, end))
    drag, side, lift, pitching, yawing = (speed**2 * law for law in laws.values())
    mq, mr = turning_laws(huuv, nu[:, 3], nu[:, 4])
    ca, sa, cb, sb = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta)
    return np.column_stack([
        ca * cb * drag - ca * sb * side - sa * lift,
        sb * drag + cb * side,
        sa * cb * drag - sa * sb * side + ca * lift,
        pitching + mq,
        mr - yawing,
    ])  # fmt: skip


def elevator_damping(huuv: FiveDof, nu: Array, delta: Array) -> Array:
    """(n, 5) that a deflection (n,) of the elevators adds, against the motion (equations 13-17, and their part along x)."""
    u, _, w = nu[:, :3].T
    _, alpha, _ = angles(nu)
    end, most = huuv.level.chosen["largest_drift"], huuv.constants["largest_angle"]
    c = huuv.constants
    pressure = 0.5 * huuv.density * (u**2 + w**2) * c["area"]
    neutral = -np.clip(alpha, -end, end)
    laws = zip(elevator_laws(huuv, np.clip(delta, -most, most) + neutral), elevator_laws(huuv, neutral), strict=True)
    drag, lift, moment = (pressure * (deflected - still) for deflected, still in laws)
    out = np.zeros((len(nu), 5))
    out[:, 0] = np.cos(alpha) * drag - np.sin(alpha) * lift
    out[:, 2] = np.sin(alpha) * drag + np.cos(alpha) * lift
    out[:, 3] = -(c["length"] * moment + c["lever"] * lift)
    return out


def damping(huuv: FiveDof, nu: Array, delta: Array) -> Array:
    """(n, 5) D(nu) nu (equations 23-27)."""
    return hull_damping(huuv, nu) + elevator_damping(huuv, nu, delta)


def thrusts(huuv: FiveDof, left: Array, right: Array) -> Array:
    """(n, 5) tau of two commands in per cent; the thrusters lie on the level of the origin."""
    c = huuv.level.constants
    x, y, n = thrust(left, right, c["slope"], c["intercept"], c["arm"], huuv.level.dead_zone).T
    return np.column_stack([x, y, np.zeros((len(x), 2)), n])


def unbalanced(huuv: FiveDof, nu: Array, pitch: Array, delta: Array, tau: Array) -> Array:
    """(n, 5) force and moment that accelerate the vehicle: tau - C nu - D - g."""
    held = np.einsum("nij,nj->ni", coriolis(huuv, nu), nu)
    return np.asarray(tau - held - damping(huuv, nu, delta) - restoring(huuv, pitch))


def rates(huuv: FiveDof, state: Array, delta: Array, tau: Array) -> Array:
    """(n, 7) rates of u v w q r, of the pitch and of the depth."""
    nu, pitch = state[:, :5], state[:, 5]
    moves = np.linalg.solve(inertia(huuv), unbalanced(huuv, nu, pitch, delta, tau).T).T
    sinking = nu[:, 2] * np.cos(pitch) - nu[:, 0] * np.sin(pitch)
    return np.column_stack([moves, nu[:, 3], sinking])


def steady(huuv: FiveDof, delta: Array, tau: Array, start: Array) -> tuple[Array, Array]:
    """Steady motions without pitch rate: straight, or a turn at constant pitch.

    Parameters
    ----------
    huuv : FiveDof
    delta : (n,) array
    tau : (n, 5) array
    start : (n, 5) array
        u v w, pitch and r.

    Returns
    -------
    found : (n, 5) array
        u v w, pitch and r; NaN where none was found.
    growth : (n,) array
        Largest real part of the eigenvalues of small motions of u v w q r and pitch, 1/s.
    """
    from scipy.optimize import root

    from coeflab.motion.small_motions import linearised

    found, growth = np.full((len(start), 5), np.nan), np.full(len(start), np.nan)
    for i, (angle, push) in enumerate(zip(delta, tau, strict=True)):

        def left(x: Array, angle: float = angle, push: Array = push) -> Array:
            nu = np.array([[x[0], x[1], x[2], 0.0, x[4]]])
            return np.asarray(unbalanced(huuv, nu, x[3:4], np.array([angle]), push[None, :])[0])

        def moving(y: Array, angle: float = angle, push: Array = push) -> Array:
            return np.asarray(rates(huuv, np.array([[*y, 0.0]]), np.array([angle]), push[None, :])[0, :6])

        solved = root(left, start[i], tol=1e-12)
        if np.max(np.abs(left(solved.x))) > 1e-8 * max(float(np.max(np.abs(push))), 1.0):
            continue
        found[i] = u, v, w, pitch, r = solved.x
        slopes = linearised(moving, np.array([u, v, w, 0.0, r, pitch]), np.ones(6))
        growth[i] = np.linalg.eigvals(slopes).real.max()
    return found, growth
