"""A vehicle and the arm that it carries: joints by Denavit and Hartenberg, links, the chain of them, and what flows past.

One convention throughout the house. Vectors of the vehicle are in FRD (x forward, y starboard, z down), earth axes are NED, SI
units, radians. The URV paper's frame 0 (x forward, y left, z up) is the frame that the first row of Denavit-Hartenberg
parameters counts from: `Chain.mount` turns it into FRD, diag(1, -1, -1) unless the file says otherwise, and `in_frame_0` gives
vectors, speeds and matrices of the chain as the paper prints them (its equation 28 leaves that turn out: erratum 7).

Generalised speeds, (6 + n,): u v w p q r of the vehicle's centre of mass, FRD, and the rates of the n joints, base first.
Vectors of link j are in its own frame j, fixed in the link, whose z axis is the one of joint j + 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.arm.thrusters import Thruster
from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locked, locking
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.definiteness import definiteness
from coeflab.law.rigid_body import inertia_doubt, rigid_body_inertia
from coeflab.law.water import ROUND_DENSITY

JointKind = Literal["revolute", "prismatic"]
FLU = np.diag([1.0, -1.0, -1.0])
NODES = 12  # of a strip; Gauss's rule is exact for |v| v where v does not turn round within it
Ints = NDArray[np.int64]


@brief
@dataclass(frozen=True, slots=True)
class Joint:
    """A joint, and the row of Denavit-Hartenberg parameters from its frame to the link's (distal, as in the URV paper).

    A_(j-1)^j = Rz(theta) Tz(d) Tx(a) Rx(alpha); a revolute joint adds its angle q to theta, a prismatic one its travel q to d.

    Attributes
    ----------
    name : str
    kind : {"revolute", "prismatic"}
    a, d : float
        m.
    alpha, theta : float
        rad.
    low, high : float
        Limits of q, rad or m.
    fastest : float
        Limit of the rate, rad/s or m/s.
    strongest : float
        Limit of the drive's torque or force, N m or N.
    home : float
        q at which the arm is drawn and a motion begins, rad or m.
    """

    name: str
    kind: JointKind
    a: float
    alpha: float
    d: float
    theta: float
    low: float = -math.inf
    high: float = math.inf
    fastest: float = math.inf
    strongest: float = math.inf
    home: float = 0.0

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise InputError(f"{self.low:g} to {self.high:g}", "low below high", column="low")
        for name in ("fastest", "strongest"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{getattr(self, name):g}", "a value above zero", column=name)

    @property
    def turns(self) -> bool:
        """Whether q is an angle."""
        return self.kind == "revolute"


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("start end")
class Strip:
    """A straight piece of a link that drags across its own axis, by strip theory (equation 21 of the URV paper).

    Attributes
    ----------
    start, end : (3,) array
        Ends of its axis, m, in the link's frame.
    diameter : float
        Width across the flow, m.
    coefficient : float
        C_D of the flow straight across. The sin^2 of the paper's C_D counts the angle twice beside the velocity across
        (erratum 5): it is left out.
    """

    start: Array
    end: Array
    diameter: float
    coefficient: float

    @property
    def length(self) -> float:
        """From start to end, m."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def axis(self) -> Array:
        """(3,) unit vector from start to end."""
        return np.asarray((self.end - self.start) / self.length)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """A rigid link, described in its own frame j.

    Attributes
    ----------
    name : str
    joint : Joint
        That moves it.
    mass : float
        kg, above zero.
    centre_of_mass : (3,) array
        m.
    inertia : (3, 3) array
        About the centre of mass, kg m^2.
    added_mass : (6, 6) array
        About the centre of mass, kg, kg m and kg m^2; zero in air.
    volume : float
        Displaced, m^3.
    centre_of_buoyancy : (3,) array
        m.
    strips : tuple of Strip
        What drags; none in air.
    """

    name: str
    joint: Joint
    mass: float
    centre_of_mass: Array
    inertia: Array
    added_mass: Array = field(default_factory=lambda: np.zeros((6, 6)))
    volume: float = 0.0
    centre_of_buoyancy: Array = field(default_factory=lambda: np.zeros(3))
    strips: tuple[Strip, ...] = ()

    def __post_init__(self) -> None:
        _lock(self)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Base:
    """The vehicle without its arm: link 0. FRD, every point from its centre of mass.

    Attributes
    ----------
    name : str
    mass : float
        kg, above zero.
    inertia : (3, 3) array
        About the centre of mass, kg m^2.
    added_mass : (6, 6) array
        About the centre of mass.
    volume : float
        Displaced, m^3.
    centre_of_buoyancy : (3,) array
        m, from the centre of mass.
    drag_area : (3,) array
        C_D S of the flow along x, y and z, m^2: the force along each is -1/2 rho C_D S |v| v, v the whole speed through the
        water (the paper's printed v^2 has no sign: erratum 7); no moment.
    """

    name: str
    mass: float
    inertia: Array
    added_mass: Array = field(default_factory=lambda: np.zeros((6, 6)))
    volume: float = 0.0
    centre_of_buoyancy: Array = field(default_factory=lambda: np.zeros(3))
    drag_area: Array = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        _lock(self)


def _lock(body: Link | Base) -> None:
    """Arrays read-only, and a body that can be."""
    for name in ("centre_of_mass", "inertia", "added_mass", "centre_of_buoyancy", "drag_area"):
        if hasattr(body, name):
            object.__setattr__(body, name, locked(getattr(body, name)))
    if not body.mass > 0.0:
        raise InputError(f"{body.mass:g} kg", "a mass above zero", column="mass")
    if doubt := inertia_doubt(body.mass, np.zeros(3), body.inertia):
        raise InputError(doubt, "a symmetric inertia about the centre of mass that a body can have", column="inertia")
    if np.any(body.added_mass) and not definiteness(body.added_mass).holds:
        smallest = float(np.linalg.eigvalsh((body.added_mass + body.added_mass.T) / 2.0)[0])
        raise input_error("arm.added_mass_smallest_2", column="added_mass", smallest=smallest)


@dataclass(frozen=True, eq=False)
@locking("attachment mount tool datum")
class Chain:
    """A vehicle and the links that follow each other from it.

    Attributes
    ----------
    name : str
    base : Base
    links : tuple of Link
        From the vehicle outwards; none is a vehicle alone.
    attachment : (3,) array
        c_0: origin of frame 0 from the vehicle's centre of mass, m, FRD.
    mount : (3, 3) array
        Axes of frame 0 as columns, FRD: diag(1, -1, -1) for x forward, y left, z up.
    tool : (3,) array
        End effector in the last link's frame, m.
    thrusters : tuple of Thruster
        Places from the vehicle's centre of mass, FRD.
    density : float
        Of the water, kg/m^3.
    gravity : float
        m/s^2.
    statements : tuple of str
        What was assumed, and which numbers come from where.
    assumed : tuple of str
        Of these, what a motion has to say.
    datum : (3,) array
        What places that people state and read count from, m, FRD, from the vehicle's centre of mass.
    """

    name: str
    base: Base
    links: tuple[Link, ...]
    attachment: Array
    mount: Array = field(default_factory=FLU.copy)
    tool: Array = field(default_factory=lambda: np.zeros(3))
    thrusters: tuple[Thruster, ...] = ()
    density: float = ROUND_DENSITY
    gravity: float = STANDARD_GRAVITY
    statements: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    datum: Array = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        if np.max(np.abs(self.mount.T @ self.mount - np.eye(3))) > 1e-9 or np.linalg.det(self.mount) < 0.0:
            raise InputError("axes that are not right-handed and of length one", "a rotation", column="mount")

    @property
    def home(self) -> Array:
        """(n,) joint positions at which a motion begins."""
        return np.array([joint.home for joint in self.joints])

    @property
    def joints(self) -> tuple[Joint, ...]:
        """From the vehicle outwards."""
        return tuple(link.joint for link in self.links)

    @property
    def count(self) -> int:
        """Links, n."""
        return len(self.links)

    @property
    def size(self) -> int:
        """Generalised speeds, 6 + n."""
        return 6 + len(self.links)

    @cached_property
    def inertias(self) -> tuple[Array, Array]:
        """(n + 1, 6, 6) inertia of the bodies and (n + 1, 6, 6) of the water, each about its centre of mass in its own axes."""
        bodies: tuple[Base | Link, ...] = (self.base, *self.links)
        rigid = np.array([rigid_body_inertia(b.mass, np.zeros(3), b.inertia) for b in bodies])
        return locked(rigid), locked([(b.added_mass + b.added_mass.T) / 2.0 for b in bodies])

    @cached_property
    def displaced(self) -> tuple[Array, Array]:
        """(n + 1,) volumes, m^3, and (n + 1, 3) centres of buoyancy, m, in the bodies' own frames."""
        bodies: tuple[Base | Link, ...] = (self.base, *self.links)
        return locked([b.volume for b in bodies]), locked([b.centre_of_buoyancy for b in bodies])

    @cached_property
    def strip_points(self) -> tuple[Ints, Array, Array, Array]:
        """Nodes of all strips by Gauss's rule: body (k,), place (k, 3) and axis (k, 3) in its frame, 1/2 rho C_D d dl (k,)."""
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        body, place, axis, factor = [], [], [], []
        for number, link in enumerate(self.links, 1):
            for strip in link.strips:
                body += [number] * NODES
                place += [strip.start + (1.0 + t) / 2.0 * (strip.end - strip.start) for t in nodes]
                axis += [strip.axis] * NODES
                factor += list(0.25 * self.density * strip.coefficient * strip.diameter * strip.length * weights)
        return locked(body, int), locked(np.reshape(place, (-1, 3))), locked(np.reshape(axis, (-1, 3))), locked(factor)

    @cached_property
    def signs(self) -> Array:
        """(6 + n, 6 + n) matrix from generalised speeds of the house to those of the paper: the mount's inverse, twice, and 1."""
        out = np.eye(self.size)
        out[:3, :3] = out[3:6, 3:6] = self.mount.T
        return locked(out)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("velocity acceleration")
class Flow:
    """Water that moves as a whole.

    Attributes
    ----------
    velocity : (3,) array
        North, east, down, m/s.
    acceleration : (3,) array
        North, east, down, m/s^2; it stays.
    """

    velocity: Array = field(default_factory=lambda: np.zeros(3))
    acceleration: Array = field(default_factory=lambda: np.zeros(3))

    def at(self, time: float) -> Flow:
        """The water so many seconds later."""
        return replace(self, velocity=self.velocity + time * self.acceleration) if np.any(self.acceleration) else self


STILL = Flow()


def in_frame_0(chain: Chain, quantity: Array) -> Array:
    """A vector (6 + n,) or matrix (6 + n, 6 + n) of the house in the paper's frame 0, and one of the paper in the house's.

    The turn diag(1, -1, -1) is its own inverse; with another mount this goes from the house to frame 0 only.
    """
    turned = chain.signs @ quantity
    return np.asarray(turned @ chain.signs.T if quantity.ndim == 2 else turned)
