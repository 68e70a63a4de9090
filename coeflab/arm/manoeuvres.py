"""What a vehicle with an arm is to do: the phases of its body.toml, or a manoeuvre by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from coeflab.arm.arm_keys import DIMENSIONS, ArmPhaseKeys
from coeflab.arm.chain import Chain
from coeflab.arm.readers.arm import File
from coeflab.core.errors import InputError, shown
from coeflab.core.options import RAD_AT_MOST, TURNING, NoOptions, measured, parse_options, text
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import with_unit
from coeflab.motion.manoeuvre import Manoeuvre, Phase

PHASES = "phases"
FREE = 10.0  # s of free motion where no phase is given
HELD, STATION = "vehicle.held", "vehicle.kept"


@dataclass(frozen=True, slots=True)
class FreeMotion:
    """Options of free motion.

    Attributes
    ----------
    lasts : float
        How long.
    velocity : str
        u v w p q r of the vehicle over ground at the start, bare in m/s and deg/s, apart at commas; [start] unless given.
    rates : str
        Of the joints at the start, bare in deg/s or m/s, apart at commas; [start] unless given.
    """

    lasts: float = measured(FREE, 1e-3, 1e6, "time")
    velocity: str = text("")
    rates: str = text("")


@dataclass(frozen=True, slots=True)
class StationKeeping:
    """Options of station keeping.

    Attributes
    ----------
    joints : str
        Positions that the joints go to, apart at commas, bare in deg or m; those of the phases that have joints unless given.
    lasts : float
        Time of each way.
    stays : float
        Time that follows.
    velocity, rates : str
        As free motion has them.
    """

    joints: str = text("")
    lasts: float = measured(4.0, 1e-3, 1e6, "time")
    stays: float = measured(4.0, 0.0, 1e6, "time")
    velocity: str = text("")
    rates: str = text("")


@dataclass(frozen=True, slots=True)
class EndEffectorTrack:
    """Options of a track of the end effector.

    Attributes
    ----------
    end : str
        Place that it goes to on a straight line, x,y,z, m, FRD, from the datum; those of the phases that have an end unless given.
    lasts : float
        Time of each way.
    stays : float
        Time that follows.
    velocity : str
        Of the vehicle at the start, as free motion has it.
    """

    end: str = text("")
    lasts: float = measured(4.0, 1e-3, 1e6, "time")
    stays: float = measured(4.0, 0.0, 1e6, "time")
    velocity: str = text("")


class Named(NamedTuple):
    """A manoeuvre by name: what it is, in words, and its options."""

    summary: str
    options: type


MANOEUVRES = {
    PHASES: Named("the [[phase]] tables of the body.toml", NoOptions),
    "free_motion": Named("vehicle and joints without drives; thrusters stand still", FreeMotion),
    "station_keeping": Named("the controller keeps the vehicle where it is while the joints move", StationKeeping),
    "end_effector_track": Named(
        "the same, while the end effector goes along straight lines of the vehicle", EndEffectorTrack
    ),
}


def ordered(name: str, file: File, chain: Chain, options: Mapping[str, Any]) -> tuple[Manoeuvre, tuple[str, ...]]:
    """A manoeuvre, and of each of its phases the table of the file that orders it; nothing where an option does.

    Raises
    ------
    InputError
        An unknown name; options that the manoeuvre does not take, or that cannot be read.
    """
    if name not in MANOEUVRES:
        raise InputError(shown(name), f"one of {', '.join(MANOEUVRES)}", column="--manoeuvre")
    o = _options(name, options)
    if name == PHASES:
        phases = [
            (Phase(one.name, _orders(file, chain, one), one.lasts), f"phase[{i}]") for i, one in enumerate(file.phase)
        ]
        phases = phases or [(Phase("free motion", {HELD: 0.0}, FREE), "")]
    elif name == "free_motion":
        phases = [(Phase("free motion", {HELD: 0.0}, o.lasts), "")]
    else:
        ways = _ways(name, o, file, chain)
        phases = [(Phase(words, {STATION: 1.0, **orders}, o.lasts), place) for words, orders, place in ways]
        if o.stays or not phases:
            phases.append((Phase("stays", {STATION: 1.0}, o.stays or o.lasts), ""))
    rates, velocity = file.rates(), np.array(file.start.velocity)
    if getattr(o, "rates", ""):
        rates = _listed("rates", o.rates, [DIMENSIONS[link.joint][1] for link in file.link])
    if getattr(o, "velocity", ""):
        velocity = np.array(_listed("velocity", o.velocity, ["speed"] * 3 + ["rate"] * 3))
    started = {f"{j.name}.rate": value for j, value in zip(chain.joints, rates, strict=False)}
    written = "arm_motion" if name == PHASES else name
    result = Manoeuvre(written, tuple(phase for phase, _ in phases), velocity, orders=started)
    return result, tuple(place for _, place in phases)


def _options(name: str, given: Mapping[str, Any]) -> Any:
    for option, value in given.items():
        try:
            parse_options(MANOEUVRES[name].options, {option: value}, name)
        except InputError as why:
            raise InputError(why.found, why.expected, column=f"--{option}", advice="See --help-options.") from None
    return parse_options(MANOEUVRES[name].options, given, name)


def _orders(file: File, chain: Chain, one: ArmPhaseKeys) -> dict[str, float]:
    """Orders of a phase, by the names of joints and thrusters."""
    joints = [joint.name for joint in chain.joints]
    orders = {HELD: float(one.vehicle == "held"), STATION: float(one.vehicle == "kept")}
    orders |= dict(zip(joints, file.positions(one), strict=False))
    orders |= {f"{name}.torque": value for name, value in zip(joints, file.torques(one), strict=False)}
    orders |= {t.name: value for t, value in zip(chain.thrusters, file.commands(one), strict=False)}
    return orders | ({} if one.end is None else _to(chain, one.end))


def _to(chain: Chain, place: Array) -> dict[str, float]:
    """Orders of the end effector, to a place from the datum."""
    return {f"end.{axis}": float(value) for axis, value in zip("xyz", place + chain.datum, strict=True)}


def _ways(name: str, o: Any, file: File, chain: Chain) -> list[tuple[str, dict[str, float], str]]:
    """Where the arm goes, one way after the other: name, orders, and the phase of the file that states them."""
    names = [joint.name for joint in chain.joints]
    if name == "station_keeping":
        if o.joints:
            found = _listed("joints", o.joints, [DIMENSIONS[link.joint][0] for link in file.link])
            return [("joints", dict(zip(names, found, strict=True)), "")]
        ways = [
            (one.name, dict(zip(names, file.positions(one), strict=True)), f"phase[{i}]")
            for i, one in enumerate(file.phase)
            if one.joints
        ]
    elif o.end:
        return [("end_effector", _to(chain, np.array(_listed("end", o.end, ["length"] * 3))), "")]
    else:
        ways = [(p.name, _to(chain, p.end), f"phase[{i}]") for i, p in enumerate(file.phase) if p.end is not None]
        if not ways:
            raise input_error("arm.place_go_phase", column="--end")
    return [way for k, way in enumerate(ways) if k == 0 or way[1] != ways[k - 1][1]]


def _listed(option: str, given: str, dimensions: Sequence[str]) -> tuple[float, ...]:
    """Values of an option in SI, one for each dimension; bare angles are in degrees, their rates in deg/s."""
    words = given.split(",")
    if len(words) != len(dimensions):
        raise InputError(
            f"{len(words)} value{'s' * (len(words) > 1)}", f"{len(dimensions)}, apart at commas", column=f"--{option}"
        )
    out = []
    for word, dimension in zip(words, dimensions, strict=True):
        try:
            value: float | str = float(word)
        except ValueError:
            value = word.strip()
        if dimension == "rate" and isinstance(value, float) and 0.0 < abs(value) < RAD_AT_MOST:
            raise input_error("arm.rate_without_unit", column=f"--{option}", value=value, rad_at_most=RAD_AT_MOST)
        if dimension in TURNING and isinstance(value, float):
            value = f"{value!r} {TURNING[dimension]}"
        try:
            out.append(with_unit(value, dimension))
        except InputError as why:
            expected = 'an angle, bare in deg or with its unit: "20 deg"' if dimension == "angle" else why.expected
            raise InputError(why.found, expected, column=f"--{option}", advice=why.advice) from None
    return tuple(out)
