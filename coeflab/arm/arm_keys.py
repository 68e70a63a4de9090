"""The keys of a body.toml of a vehicle with an arm: joints, links, vehicle, mount, thrusters, controller and phases."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np

from coeflab.bodies.body_file import InertiaMatrix
from coeflab.bodies.closed_forms.parts import cylinder_with_ends
from coeflab.bodies.closed_forms.revolution import MeridianIntegrals, strip_added_mass
from coeflab.bodies.pieces import Direction
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import STANDARD_GRAVITY, with_unit
from coeflab.law.definiteness import definiteness
from coeflab.law.rigid_body import inertia_doubt
from coeflab.law.transforms import about_axis, moved, rotation, turned
from coeflab.law.water import ROUND_DENSITY

INERTIA = (
    "[[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz, Izz]] about the centre of mass: the same numbers on both sides of the diagonal, "
    "principal moments above zero, none above the sum of the other two"
)
LAWS = ("computed_torque", "station")
FORMULAS = ("across", "ends", "none")
DIMENSIONS = {"revolute": ("angle", "rate", "moment"), "prismatic": ("length", "speed", "force")}
IN_LINK = "a point [x, y, z] in metres, in the link's own frame"
SIX = takes.numbers(6, "none", "six rows of six numbers, kg, kg m and kg m^2")
Own = Annotated[Array, takes.Takes(IN_LINK, lambda v, f: np.array(_OWN.read(v, f)), takes.POINT.schema)]
_OWN = takes.numbers(3, "length", IN_LINK)
_TURN = takes.numbers(3, "angle", "three angles [roll, pitch, yaw]")
Turn = Annotated[tuple[float, float, float], _TURN]
Sizes = Annotated[tuple[float, float, float], takes.numbers(3, "length", "three semi-axes [x, y, z]")]
Areas = Annotated[tuple[float, float, float], takes.numbers(3, "area", "three areas [x, y, z]")]


def _six(value: Any, file: Path) -> Array:
    if not isinstance(value, list) or len(value) != 6:
        raise InputError(shown(value), SIX.words)
    return np.array([SIX.read(row, file) for row in value])


Six = Annotated[
    Array, takes.Takes(SIX.words, _six, {"type": "array", "items": SIX.schema, "minItems": 6, "maxItems": 6})
]


def _moving(what: str, units: str) -> takes.Takes:
    """A value whose dimension is that of the joint: read in `LinkKeys.of_joint`."""

    def read(value: Any, _file: Path) -> Any:
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise InputError(shown(value), what)
        return value

    return takes.Takes(what, read, {"type": ["number", "string"], "unit": units})


Position = Annotated[Any, _moving("an angle of a revolute, a length of a prismatic joint", "rad or m")]
Pace = Annotated[Any, _moving("a rate of a revolute, a speed of a prismatic joint", "rad/s or m/s")]
Effort = Annotated[Any, _moving("a moment of a revolute, a force of a prismatic joint", "N m or N")]


class JointRange(NamedTuple):
    """What a joint can do, in SI."""

    low: float
    high: float
    home: float
    fastest: float
    strongest: float


_OWN_AXES = "Check units and axes, and that it is not about another point."


def _require_inertia(mass: float, inertia: Array) -> None:
    if doubt := inertia_doubt(mass, np.zeros(3), inertia):
        raise InputError(doubt, INERTIA, column="inertia_matrix", advice=_OWN_AXES)


def _require_added_mass(matrix: Array | None) -> None:
    if matrix is not None and np.any(matrix) and not definiteness(matrix).holds:
        smallest = float(np.linalg.eigvalsh((matrix + matrix.T) / 2.0)[0])
        raise input_error("arm.added_mass_smallest", column="added_mass", smallest=smallest)


def _one_each(what: str, units: str, example: str) -> takes.Takes:
    """Values whose dimensions are those of joints or thrusters: read in SI by the file, which knows these."""
    expected = f"a list of {what}, such as {example}"

    def read(value: Any, _file: Path) -> tuple[Any, ...]:
        if not isinstance(value, list) or any(
            isinstance(v, bool) or not isinstance(v, (int, float, str)) for v in value
        ):
            raise InputError(shown(value), expected)
        return tuple(value)

    items = {"type": ["number", "string"], "unit": units}
    return takes.Takes(f"a list of {what}", read, {"type": "array", "items": items})


def _speeds(value: Any, _file: Path) -> tuple[float, ...]:
    if not isinstance(value, list) or len(value) != 6:
        raise InputError(shown(value), "six speeds, m/s and rad/s")
    return tuple(with_unit(v, "speed" if i < 3 else "rate") for i, v in enumerate(value))


Positions = Annotated[tuple[Any, ...], _one_each("positions", "rad or m", '["20 deg", 0]')]
Paces = Annotated[tuple[Any, ...], _one_each("rates", "rad/s or m/s", '["5 deg/s", 0]')]
Efforts = Annotated[tuple[Any, ...], _one_each("torques or forces", "N m or N", '["2 N*m", 0]')]
Commands = Annotated[tuple[Any, ...], _one_each("commands", "N m, V or N", '["2 N*m", 0]')]
_SIX_SPEEDS = {
    "type": "array",
    "items": {"type": ["number", "string"], "unit": "m/s or rad/s"},
    "minItems": 6,
    "maxItems": 6,
}
_BY_CONTROL = "Its controller gives the torques."
Speeds = Annotated[tuple[float, ...], takes.Takes("six speeds, m/s and rad/s", _speeds, _SIX_SPEEDS)]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CylinderKeys(takes.Declaration):
    """A cylinder of a link: it drags across its axis and moves water with it.

    Attributes
    ----------
    radius, length : float
        Of the cylinder.
    centre : (3,) array
        Middle of its axis, [x, y, z], m, in the link's own frame.
    axis : (3,) tuple
        Direction of its axis, in the link's own frame.
    drag_coefficient : float
        C_D of the flow straight across, by diameter and length.
    added_mass : {"across", "ends", "none"}
        across moves rho pi r^2 L across the axis and nothing along it, as the URV paper has it (erratum 3); ends has flat
        ends, by our panel method.
    """

    radius: Annotated[takes.Length, takes.ABOVE_ZERO]
    length: Annotated[takes.Length, takes.ABOVE_ZERO]
    centre: Own
    axis: Direction
    drag_coefficient: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    added_mass: Annotated[str, takes.one_of(*FORMULAS)] = "across"

    def check(self) -> None:
        """It lies somewhere."""
        if not np.linalg.norm(self.axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="axis")

    @property
    def turn(self) -> Array:
        """(3, 3) rotation from its own axes, x along it, to the link's."""
        return about_axis(np.asarray(self.axis) / np.linalg.norm(self.axis))

    def moved_water(self, density: float, point: Array) -> Array:
        """(6, 6) added mass about a point of the link, along the link's axes.

        The paper's k = rho pi r^2 L / 4 takes a diameter for r, and its k L^2 / 3 is about an end (erratum 3): here it is
        rho pi r^2 L across, and L^2 / 12 of that about the middle.
        """
        section = np.pi * self.radius**2
        whole = MeridianIntegrals(section * self.length, 0.0, 0.0, section * self.length**3 / 12.0)
        if self.added_mass == "none":
            return np.zeros((6, 6))
        ends = self.added_mass == "ends"
        own = cylinder_with_ends(self.radius, self.length, density) if ends else strip_added_mass(whole, density)
        return moved(turned(own, self.turn), point - self.centre)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinkKeys(takes.Declaration):
    """A joint, its Denavit-Hartenberg row, and the link that it moves.

    Attributes
    ----------
    name : str
        Of the link and of its joint.
    joint : {"revolute", "prismatic"}
        What its position is added to: theta, or d.
    a, alpha, d, theta : float
        A_(j-1)^j = Rz(theta) Tz(d) Tx(a) Rx(alpha), all four.
    low, high : float
        Limits of the position, an angle or a length; none unless given.
    home : float
        Position at which the arm is drawn and a motion begins.
    fastest, strongest : float
        Limits of the rate, and of the torque or force of the drive; none unless given.
    mass : float
        Of the link.
    centre_of_mass : (3,) array
        [x, y, z], m, in the link's own frame.
    inertia_matrix : (3, 3) array
        About the centre of mass, along the link's own axes.
    volume : float
        Displaced; neutral, mass over density, unless given.
    centre_of_buoyancy : (3,) array
        [x, y, z], m, in the link's own frame; the centre of mass unless given.
    added_mass : (6, 6) array
        About the centre of mass, in place of the cylinders'.
    cylinder : array of tables
        What drags.
    """

    name: takes.Text
    joint: Annotated[str, takes.one_of("revolute", "prismatic")]
    a: takes.Length
    alpha: takes.Angle
    d: takes.Length
    theta: takes.Angle
    low: Position | None = None
    high: Position | None = None
    home: Position = 0.0
    fastest: Pace | None = None
    strongest: Effort | None = None
    mass: Annotated[takes.Mass, takes.ABOVE_ZERO]
    centre_of_mass: Own
    inertia_matrix: InertiaMatrix
    volume: Annotated[takes.Volume, takes.ZERO_OR_MORE] | None = None
    centre_of_buoyancy: Own | None = None
    added_mass: Six | None = None
    cylinder: tuple[CylinderKeys, ...] = ()

    def check(self) -> None:
        """Limits in order, and an inertia that a body can have."""
        low, high, home, fastest, strongest = self.range
        f, unit = (180.0 / np.pi, "deg") if self.joint == "revolute" else (1.0, "m")
        if not low < high:
            raise input_error("arm.low_high", column="low", f=f * low, f_2=f * high, unit=unit)
        if not low <= home <= high:
            raise input_error("arm.low_high_2", column="home", f=f * home, unit=unit, f_2=f * low, f_3=f * high)
        for key, value in (("fastest", fastest), ("strongest", strongest)):
            if not value > 0.0:
                raise InputError(f"{value:g}", "a value above zero", column=key)
        _require_inertia(self.mass, self.inertia_matrix)
        _require_added_mass(self.added_mass)

    @property
    def range(self) -> JointRange:
        """Limits and home in SI."""
        place, pace, effort = DIMENSIONS[self.joint]

        def read(key: str, dimension: str, absent: float) -> float:
            value = getattr(self, key)
            try:
                return absent if value is None else with_unit(value, dimension)
            except InputError as why:
                raise why.at(column=key) from None

        return JointRange(
            read("low", place, -np.inf), read("high", place, np.inf), read("home", place, 0.0),
            read("fastest", pace, np.inf), read("strongest", effort, np.inf),
        )  # fmt: skip

    def moved_water(self, density: float) -> Array:
        """(6, 6) added mass about the centre of mass, along the link's axes."""
        if self.added_mass is not None:
            return self.added_mass
        out = np.zeros((6, 6))
        for one in self.cylinder:
            out += one.moved_water(density, self.centre_of_mass)
        return out


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VehicleKeys(takes.Declaration):
    """The vehicle without its arm.

    Attributes
    ----------
    semi_axes : (3,) tuple
        Of the ellipsoid that is its hull.
    centre : (3,) array
        Of the ellipsoid, [x, y, z], m, FRD, from the datum.
    mass : float
        Without the arm.
    centre_of_mass : (3,) array
        [x, y, z], m, FRD, from the datum.
    inertia_matrix : (3, 3) array
        About the centre of mass.
    volume : float
        Displaced; neutral, mass over density, unless given.
    centre_of_buoyancy : (3,) array
        [x, y, z], m, FRD, from the datum; the centre of mass unless given.
    added_mass : (6, 6) array
        About the centre of mass, in place of the ellipsoid's by Lamb.
    drag_area : (3,) tuple
        C_D S of the flow along x, y and z.
    """

    semi_axes: Sizes
    centre: takes.Point
    mass: Annotated[takes.Mass, takes.ABOVE_ZERO]
    centre_of_mass: takes.Point
    inertia_matrix: InertiaMatrix
    volume: Annotated[takes.Volume, takes.ZERO_OR_MORE] | None = None
    centre_of_buoyancy: takes.Point | None = None
    added_mass: Six | None = None
    drag_area: Areas = (0.0, 0.0, 0.0)

    def check(self) -> None:
        """Sizes above zero, and an inertia that a body can have."""
        if min(self.semi_axes) <= 0.0:
            raise InputError(shown(list(self.semi_axes)), "three lengths above zero", column="semi_axes")
        if min(self.drag_area) < 0.0:
            raise InputError(shown(list(self.drag_area)), "three areas of zero or more", column="drag_area")
        _require_inertia(self.mass, self.inertia_matrix)
        _require_added_mass(self.added_mass)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArmKeys(takes.Declaration):
    """Where the arm stands on the vehicle, and in which water.

    Attributes
    ----------
    attachment : (3,) array
        Origin of frame 0, [x, y, z], m, FRD, from the datum.
    mount : (3,) tuple
        [roll, pitch, yaw] of frame 0; roll 180 deg is x forward, y left, z up.
    tool : (3,) array
        End effector, [x, y, z], m, in the last link's own frame.
    density : float
        Of the water.
    gravity : float
        The standard one unless given.
    """

    attachment: takes.Point
    mount: Turn = (np.pi, 0.0, 0.0)
    tool: Own = field(default_factory=lambda: np.zeros(3))
    density: Annotated[takes.Density, takes.ABOVE_ZERO] = ROUND_DENSITY
    gravity: Annotated[takes.Acceleration, takes.ZERO_OR_MORE] = STANDARD_GRAVITY

    @property
    def turn(self) -> Array:
        """(3, 3) axes of frame 0 as columns, FRD."""
        result = rotation(*self.mount)
        near = np.round(result)
        return near if np.max(np.abs(result - near)) < 1e-12 else result


@dataclass(frozen=True, slots=True, kw_only=True)
class TorqueKeys(takes.Declaration):
    """One state, by torque (Yoerger, Cooke and Slotine 1990): dOmega/dt = beta tau - alpha Omega |Omega|, T = C Omega |Omega|.

    Attributes
    ----------
    alpha : float
        1/rad.
    beta : float
        1/(kg m^2).
    thrust : float
        C, N s^2/rad^2.
    strongest : float
        Largest torque, N m; no limit unless given.
    """

    alpha: Annotated[takes.Pure, takes.ABOVE_ZERO]
    beta: Annotated[takes.Pure, takes.ABOVE_ZERO]
    thrust: Annotated[takes.Pure, takes.ABOVE_ZERO]
    strongest: Annotated[takes.Moment, takes.ABOVE_ZERO] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class VoltageKeys(takes.Declaration):
    """Two states with slip, by voltage, after Healey, Rock, Cody, Miles and Brown (1994), from memory of their work.

    Attributes
    ----------
    damping, drive, load : float
        Of the motor: k1, 1/s; k2, rad/s^2 per V; kh, 1/(kg m^2).
    radius : float
        Of the propeller.
    pitch : float
        Of the blade at 0.7 of the radius.
    lift, drag : float
        Largest C_L and C_D of the blade.
    column : float
        Length of the water that accelerates with the propeller.
    momentum : float
        Share of momentum that leaves with the jet.
    strongest : float
        Largest voltage, V; no limit unless given.
    """

    damping: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    drive: Annotated[takes.Pure, takes.ABOVE_ZERO]
    load: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    radius: Annotated[takes.Length, takes.ABOVE_ZERO]
    pitch: takes.Angle
    lift: Annotated[takes.Pure, takes.ABOVE_ZERO]
    drag: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    column: Annotated[takes.Length, takes.ABOVE_ZERO]
    momentum: Annotated[takes.Pure, takes.ABOVE_ZERO]
    strongest: Annotated[takes.Pure, takes.ABOVE_ZERO] | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PropulsorKeys(takes.Declaration):
    """A thruster; without a model it gives what is ordered at once.

    Attributes
    ----------
    name : str
        Of the thruster.
    place : (3,) array
        [x, y, z], m, FRD, from the datum.
    axis : (3,) tuple
        Of positive thrust, FRD.
    torque : table
        The model of one state.
    voltage : table
        The model of two states.
    """

    name: takes.Text
    place: takes.Point
    axis: Direction
    torque: TorqueKeys | None = None
    voltage: VoltageKeys | None = None

    def check(self) -> None:
        """One model, and it pushes somewhere."""
        if not np.linalg.norm(self.axis) > 0.0:
            raise InputError("an axis without a direction", "[x, y, z], one of them not zero", column="axis")
        if self.torque is not None and self.voltage is not None:
            raise InputError("both torque and voltage", "one model of the thruster", column="voltage")


@dataclass(frozen=True, slots=True, kw_only=True)
class ControllerKeys(takes.Declaration):
    """The controller of a vehicle that is kept on its station: e'' + 2 damping w e' + w^2 e = 0 of every error e.

    Attributes
    ----------
    law : {"computed_torque", "station"}
        Computed torque knows the whole model; station the inertia at the start of the phase, and weight and buoyancy.
    vehicle_frequency, joint_frequency : float
        Natural frequency w of errors of the vehicle, and of the joints.
    damping : float
        Over the critical one.
    propeller_rate : float
        How fast a propeller is brought to its speed, 1/s.
    knows_current : bool
        Whether the model of computed torque has the current.
    """

    law: Annotated[str, takes.one_of(*LAWS)] = "computed_torque"
    vehicle_frequency: Annotated[takes.Rate, takes.ABOVE_ZERO] = 1.0
    joint_frequency: Annotated[takes.Rate, takes.ABOVE_ZERO] = 4.0
    damping: Annotated[takes.Pure, takes.ABOVE_ZERO] = 1.0
    propeller_rate: Annotated[takes.Pure, takes.ABOVE_ZERO] = 10.0
    knows_current: takes.Flag = True


@dataclass(frozen=True, slots=True, kw_only=True)
class StartKeys(takes.Declaration):
    """How a motion begins: at the origin, level, heading north, with the joints at home.

    Attributes
    ----------
    velocity : (6,) tuple
        u v w p q r of the vehicle over ground, m/s and rad/s.
    rates : list
        Of the joints, rad/s or m/s where bare; at rest unless given.
    """

    velocity: Speeds = (0.0,) * 6
    rates: Paces = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmPhaseKeys(takes.Declaration):
    """A phase of the motion that `coeflab simulate` makes.

    Attributes
    ----------
    name : str
        Of the phase.
    lasts : float
        How long.
    vehicle : {"free", "held", "kept"}
        held: it keeps its velocity, by whatever force that takes; kept: thrusters and drives keep it where the motion began, by [controller].
    joints : list
        Positions that the joints reach at its end, from rest to rest, each with its unit.
    end : (3,) array
        Place that the end effector reaches at its end, on a straight line of the vehicle, [x, y, z], m, FRD, from the datum.
    torque : list
        Of the joints, N m or N where bare, constant. Without joints, end and torque they turn freely; of a vehicle that is kept they stay.
    commands : list
        Of the thrusters, constant: N m by torque, V by voltage, N without a model; without it they stand still.
    """

    name: takes.Text
    lasts: Annotated[takes.Time, takes.ABOVE_ZERO]
    vehicle: Annotated[str, takes.one_of("free", "held", "kept")] = "free"
    joints: Positions = ()
    end: takes.Point | None = None
    torque: Efforts = ()
    commands: Commands = ()

    def check(self) -> None:
        """One way to move the joints."""
        ways = {"joints": bool(self.joints), "end": self.end is not None, "torque": bool(self.torque)}
        given = [key for key, there in ways.items() if there]
        if len(given) > 1:
            raise InputError(f"{' and '.join(given)}", "one of joints, end and torque", column=given[1])
        if self.commands and self.vehicle != "free":
            raise InputError(f"commands of a vehicle that is {self.vehicle}", "a free vehicle", column="commands")
        if self.torque and self.vehicle == "kept":
            raise InputError("torque of a vehicle that is kept", "joints or end", column="torque", advice=_BY_CONTROL)
