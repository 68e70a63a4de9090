"""The chain of a body.toml whose reader is ``arm``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coeflab.arm.arm_keys import LinkKeys, PropulsorKeys, VehicleKeys
from coeflab.arm.chain import Base, Chain, Joint, Link, Strip
from coeflab.arm.control import Controller
from coeflab.arm.manoeuvres import PHASES, ordered
from coeflab.arm.readers.arm import File
from coeflab.arm.thrusters import Thruster, TorqueThruster, VoltageThruster, thruster_matrix, uncontrolled_directions
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core import declarations as takes
from coeflab.core.errors import shown
from coeflab.core.text.toml import read_toml
from coeflab.core.types import Array
from coeflab.law.transforms import moved
from coeflab.motion.manoeuvre import Manoeuvre

BODY = "body.toml"
ALIKE = 0.02  # of the hull's volume: no word about less


class Arm(NamedTuple):
    """What a body.toml states, and what it is to do.

    Attributes
    ----------
    chain : Chain
    manoeuvre : Manoeuvre
    controller : Controller
    places : tuple of str
        Of each phase of the manoeuvre: ``phase[2]`` of the file, or nothing where options of the manoeuvre order it.
    """

    chain: Chain
    manoeuvre: Manoeuvre
    controller: Controller
    places: tuple[str, ...]


def is_arm(path: Path) -> bool:
    """Whether a path is the body.toml of an arm, or the folder of one; nothing is raised for what cannot be read."""
    file = path / BODY if path.is_dir() else path
    if file.suffix != ".toml" or not file.is_file():
        return False
    head = read_toml(file).content.get("body")
    return isinstance(head, dict) and head.get("reader") == File.reader


def read_chain(path: Path) -> Chain:
    """The vehicle and arm of a body.toml, or of the folder that holds one.

    Raises
    ------
    InputError
        No body.toml of an arm; everything that is wrong with it, by line and key.
    """
    return read_arm(path).chain


def read_arm(path: Path, manoeuvre: str = PHASES, options: Mapping[str, Any] | None = None) -> Arm:
    """The same, and a motion: the phases of the file, or a manoeuvre by name; without a phase it moves freely for 10 s.

    Parameters
    ----------
    path : Path
    manoeuvre : str
        Of `coeflab.arm.manoeuvres.MANOEUVRES`.
    options : mapping of str to value, optional
        Of the manoeuvre.

    Raises
    ------
    InputError
        No body.toml of an arm; everything that is wrong with it, by line and key; options of the manoeuvre.
    """
    toml = read_toml(path / BODY if path.is_dir() else path)
    head = toml.content.get("body")
    reader = head.get("reader") if isinstance(head, dict) else None
    if reader != File.reader:
        found = "nothing" if reader is None else shown(reader)
        raise toml.fail("body.reader", found, f'"{File.reader}", a vehicle with an arm', "See geometry/urv_puma.")
    file = takes.declared(File, toml)
    rho, origin = file.arm.density, file.vehicle.centre_of_mass
    neutral = [one.name for one in file.link if one.volume is None]
    if file.vehicle.volume is None:
        neutral.insert(0, "vehicle")
    assumed = [f"Displaced mass equals mass, as no volume is stated: {', '.join(neutral)}."] if neutral else []
    assumed += _hull_against_displaced(file.vehicle, rho)
    thrusters = tuple(_thruster(one, origin) for one in file.thruster)
    if thrusters and (uncontrolled := uncontrolled_directions(thruster_matrix(thrusters))):
        assumed.append(f"The thrusters make no {', no '.join(uncontrolled)}.")
    chain = Chain(
        name=file.body.name,
        base=_base(file.body.name, file.vehicle, rho),
        links=tuple(_link(one, rho) for one in file.link),
        attachment=file.arm.attachment - origin,
        mount=file.arm.turn,
        tool=file.arm.tool,
        thrusters=thrusters,
        density=rho,
        gravity=file.arm.gravity,
        statements=(*assumed, *(f"{key}: {words}" for key, words in file.basis.items())),
        assumed=tuple(assumed),
        datum=-origin,
    )
    motion, places = ordered(manoeuvre, file, chain, {} if options is None else options)
    return Arm(chain, motion, Controller(**asdict(file.controller)), places)


def _base(name: str, keys: VehicleKeys, density: float) -> Base:
    """Link 0, its ellipsoid's added mass by Lamb: e^2 = 1 - (b/a)^2, where the paper prints e (erratum 1)."""
    own = ellipsoid_added_mass(np.array(keys.semi_axes), density)
    moved_water = moved(own, keys.centre_of_mass - keys.centre) if keys.added_mass is None else keys.added_mass
    volume, lifted = _afloat(keys, density)
    return Base(
        name, keys.mass, keys.inertia_matrix, moved_water, volume, lifted - keys.centre_of_mass,
        np.array(keys.drag_area),
    )  # fmt: skip


def _hull_against_displaced(keys: VehicleKeys, density: float) -> list[str]:
    """What is to be said where the vehicle displaces another volume than its ellipsoid has."""
    hull, displaced = 4.0 / 3.0 * np.pi * float(np.prod(keys.semi_axes)), _afloat(keys, density)[0]
    if abs(hull - displaced) <= ALIKE * hull:
        return []
    how = "its mass over the density" if keys.volume is None else "as stated"
    water = "" if keys.added_mass is not None else "; added mass is that of the whole ellipsoid"
    return [
        f"The vehicle displaces {displaced:.4g} m^3, {displaced * density:.4g} kg, {how}; its ellipsoid holds {hull:.4g} m^3, "
        f"{hull * density:.4g} kg of water{water}."
    ]


def _link(keys: LinkKeys, density: float) -> Link:
    low, high, home, fastest, strongest = keys.range
    turns: Any = keys.joint
    strips = []
    for one in keys.cylinder:
        half = np.asarray(one.axis) / np.linalg.norm(one.axis) * one.length / 2.0
        strips.append(Strip(one.centre - half, one.centre + half, 2.0 * one.radius, one.drag_coefficient))
    volume, lifted = _afloat(keys, density)
    joint = Joint(keys.name, turns, keys.a, keys.alpha, keys.d, keys.theta, low, high, fastest, strongest, home)
    water = keys.moved_water(density)
    return Link(
        keys.name, joint, keys.mass, keys.centre_of_mass, keys.inertia_matrix, water, volume, lifted, tuple(strips)
    )


def _afloat(keys: VehicleKeys | LinkKeys, density: float) -> tuple[float, Array]:
    """Volume and centre of buoyancy; neutral, at the centre of mass, as the paper's section 4.5 assumes, unless stated."""
    volume = keys.mass / density if keys.volume is None else keys.volume
    return volume, keys.centre_of_mass if keys.centre_of_buoyancy is None else keys.centre_of_buoyancy


def _thruster(keys: PropulsorKeys, origin: Array) -> Thruster:
    model: TorqueThruster | VoltageThruster | None = None
    if keys.torque is not None:
        t = keys.torque
        model = TorqueThruster(t.alpha, t.beta, t.thrust, np.inf if t.strongest is None else t.strongest)
    if keys.voltage is not None:
        v = keys.voltage
        most = np.inf if v.strongest is None else v.strongest
        model = VoltageThruster(
            v.damping, v.drive, v.load, v.radius, v.pitch, v.lift, v.drag, v.column, v.momentum, most
        )
    return Thruster(keys.name, keys.place - origin, np.array(keys.axis), model)
