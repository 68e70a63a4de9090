"""A vehicle with an arm: its hull, the mount, Denavit-Hartenberg rows, links and thrusters.

As a body it stands still, with its joints at home. `coeflab.arm.arm_file` makes the chain that moves.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from coeflab.arm import arm_keys
from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import BodyFile
from coeflab.bodies.shape import Cylinder, Ellipsoid, Part, Parts
from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array
from coeflab.core.units import with_unit
from coeflab.law.rigid_body import MassProperties, parallel_axis
from coeflab.law.transforms import denavit_hartenberg

summary = "a vehicle with an arm of any number of links by Denavit-Hartenberg, from a body.toml"
citations = ("urv_kane",)

BASES = ("printed", "derived", "assumed", "chosen")


@dataclass(frozen=True, slots=True, kw_only=True)
class File(BodyFile):
    """A body.toml of a vehicle with an arm.

    Attributes
    ----------
    vehicle : table
        The vehicle without its arm.
    arm : table
        Where the arm stands.
    link : array of tables
        Joints and links, from the vehicle outwards.
    thruster : array of tables
        Thrusters of the vehicle.
    controller : table
        Of phases whose vehicle is kept.
    start : table
        How a motion begins.
    phase : array of tables
        The motion that `coeflab simulate` makes, one phase after the other.
    basis : mapping of str to str
        Where numbers come from, in words that begin with printed, derived, assumed or chosen.
    """

    reader: ClassVar[str] = "arm"
    vehicle: arm_keys.VehicleKeys
    arm: arm_keys.ArmKeys
    link: tuple[arm_keys.LinkKeys, ...] = ()
    thruster: tuple[arm_keys.PropulsorKeys, ...] = ()
    controller: arm_keys.ControllerKeys = field(default_factory=arm_keys.ControllerKeys)
    start: arm_keys.StartKeys = field(default_factory=arm_keys.StartKeys)
    phase: tuple[arm_keys.ArmPhaseKeys, ...] = ()
    basis: dict[str, takes.Text] = field(default_factory=dict)

    def check(self) -> None:
        """Links, by names of their own, and what the basis says."""
        BodyFile.check(self)
        if not self.link:
            raise InputError("no [[link]]", "at least one link with its joint", column="link")
        for key, parts in (("link", self.link), ("thruster", self.thruster)):
            names = [part.name for part in parts]
            if twice := sorted({n for n in names if names.count(n) > 1}):
                raise InputError(f"two called {shown(twice[0])}", "one name for each", column=key, advice="Rename one.")
        self._check_motion()
        for key, words in self.basis.items():
            if words.split()[0].rstrip(":,") not in BASES:
                raise InputError(shown(words), "a text that begins with " + ", ".join(BASES), column=f"basis.{key}")

    def _check_motion(self) -> None:
        """As many values as there are joints and thrusters, each of its joint's kind."""
        many = [("start.rates", self.start.rates, len(self.link), "joints")]
        for i, phase in enumerate(self.phase):
            at = f"phase[{i}]"
            many += [(f"{at}.{key}", getattr(phase, key), len(self.link), "joints") for key in ("joints", "torque")]
            many.append((f"{at}.commands", phase.commands, len(self.thruster), "thrusters"))
        for key, values, count, what in many:
            if values and len(values) != count:
                raise InputError(f"{len(values)} values", f"{count}, one for each of the {what}", column=key)
        read = [("start.rates", self.rates)]
        for i, phase in enumerate(self.phase):
            read += [
                (f"phase[{i}].joints", partial(self.positions, phase)),
                (f"phase[{i}].torque", partial(self.torques, phase)),
            ]
            read.append((f"phase[{i}].commands", partial(self.commands, phase)))
        for key, values_of in read:
            try:
                values_of()
            except InputError as why:
                raise why.at(column=key) from None

    def positions(self, phase: arm_keys.ArmPhaseKeys) -> tuple[float, ...]:
        """Joint positions that a phase goes to, rad and m, within the joints' limits."""
        found = self._of_joints(phase.joints, 0)
        for link, value in zip(self.link, found, strict=False):
            low, high = link.range[:2]
            if not low <= value <= high:
                factor, unit = (180.0 / np.pi, "deg") if link.joint == "revolute" else (1.0, "m")
                raise InputError(
                    f"{factor * value:.6g} {unit}",
                    f"{factor * low:.6g} to {factor * high:.6g} {unit}, the limits of joint {link.name}",
                )
        return found

    def torques(self, phase: arm_keys.ArmPhaseKeys) -> tuple[float, ...]:
        """Torques and forces of the joints in a phase, N m and N."""
        return self._of_joints(phase.torque, 2)

    def rates(self) -> tuple[float, ...]:
        """Rates of the joints at the start, rad/s and m/s."""
        return self._of_joints(self.start.rates, 1)

    def commands(self, phase: arm_keys.ArmPhaseKeys) -> tuple[float, ...]:
        """Commands of the thrusters in a phase: N m by torque, V by voltage, N without a model."""
        return tuple(
            _volts(value) if one.voltage is not None else with_unit(value, "force" if one.torque is None else "moment")
            for one, value in zip(self.thruster, phase.commands, strict=False)
        )

    def _of_joints(self, values: tuple[Any, ...], which: int) -> tuple[float, ...]:
        return tuple(
            with_unit(value, arm_keys.DIMENSIONS[link.joint][which])
            for link, value in zip(self.link, values, strict=False)
        )

    @property
    def at_home(self) -> tuple[tuple[Array, Array], ...]:
        """Rotation to FRD and origin from the datum of every link's frame, with the joints at home."""
        turn, place, out = self.arm.turn, np.array(self.arm.attachment), []
        for link in self.link:
            home = link.range.home
            angle, travel = (home, 0.0) if link.joint == "revolute" else (0.0, home)
            inner, shift = denavit_hartenberg(link.theta + angle, link.d + travel, link.a, link.alpha)
            place, turn = place + turn @ shift, turn @ inner
            out.append((turn, place))
        return tuple(out)

    @property
    def shape(self) -> Parts:
        """Hull and cylinders, with the joints at home."""
        parts = [Part("hull", Ellipsoid(*self.vehicle.semi_axes), self.vehicle.centre, np.eye(3))]
        for link, (turn, origin) in zip(self.link, self.at_home, strict=True):
            for k, one in enumerate(link.cylinder, 1):
                name = link.name if len(link.cylinder) == 1 else f"{link.name}_{k}"
                centre = origin + turn @ one.centre
                parts.append(Part(name, Cylinder(one.radius, one.length), centre, turn @ one.turn))
        return Parts(tuple(parts))

    @property
    def mass(self) -> MassProperties:
        """Of vehicle and arm together, about the reference point, with the joints at home."""
        point, vehicle = self.body.reference_point, self.vehicle
        bodies = [(vehicle.mass, vehicle.centre_of_mass - point, vehicle.inertia_matrix)]
        for link, (turn, origin) in zip(self.link, self.at_home, strict=True):
            centre = origin + turn @ link.centre_of_mass - point
            bodies.append((link.mass, centre, turn @ link.inertia_matrix @ turn.T))
        whole = sum(m for m, _, _ in bodies)
        centre = np.sum([m * c for m, c, _ in bodies], axis=0) / whole
        inertia = np.sum([own + parallel_axis(m, c) for m, c, own in bodies], axis=0)
        return MassProperties(whole, whole * float(centre[0]), None, centre, inertia)


def _volts(value: Any) -> float:
    return with_unit(value.strip().removesuffix("V") if isinstance(value, str) else value, "none")


def read(path: Path) -> Body:
    """Read a body.toml of a vehicle with an arm: the shape and mass that it has with its joints at home.

    Raises
    ------
    InputError
        Everything that is wrong with the file, by line and key: a Denavit-Hartenberg row without one of its four values,
        limits the wrong way round, a link without mass, an inertia that no body has.
    """
    file = takes.declared(File, read_toml(path))
    shape = file.shape
    title = "hull and links with the joints at home; overlaps count twice"
    home = Configuration("home", title, shape.volume, None, shape.centre_of_volume, file.mass)
    return file.build(path, shape, (home,))
