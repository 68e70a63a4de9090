"""Thrusters and fins of a gz-sim model: what its Thruster and LiftDrag plugins are as thrusters, limits and derivatives.

Thruster: src/systems/thruster/Thruster.cc, commit 93bbf3e: thrust along the joint's axis at the child link's origin, commanded in N, or in
rad/s by <use_angvel_cmd>, whose thrust is thrust_coefficient rho D^4 n|n|; nothing below <deadband>. LiftDrag: lift_drag.py.

A fin's force is linear in its angle and in drift up to the stall, so that its slopes at a straight course are its derivatives: those by
the angle are Ydr, Ndr, Zds, Mds ..., those by v w p q r add to the hull's. A positive angle turns right-handed about z (dr) or y (ds), FRD.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.axes import FLU
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.xml import numbers
from coeflab.core.types import Array, brief, locking
from coeflab.core.wording import one_line
from coeflab.formats.gazebo.assembly import Assembly, Joint, Pose
from coeflab.formats.gazebo.lift_drag import LiftDrag, at_hull, read_lift_drag
from coeflab.formats.left_out import left_out
from coeflab.law.symbols import COMPONENTS
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterCurve, ParameterSurface, ParameterThruster

ALONG = 0.95  # cosine between a hinge and an axis of the body: 18 deg
STEP = 1e-4  # rad, and of the speed
LARGEST = 1000.0  # of commands, Thruster.cc
WAYS: tuple[tuple[Literal["dr", "ds"], int], ...] = (("dr", 2), ("ds", 1))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("drift")
class Actuators:
    """Thrusters and fins about the hull's origin, FRD.

    Attributes
    ----------
    thrusters : tuple of ParameterThruster
    surfaces : tuple of ParameterSurface
    controls : mapping of symbol to float
        Such as Ydr, SI, of U^2: N s^2/m^2 or N s^2/m.
    drift : (6, 6) array
        What fins add by U and v w p q r, and X by U^2.
    read : tuple of Element
        The plugins that this is all of.
    findings : tuple of Finding
    """

    thrusters: tuple[ParameterThruster, ...]
    surfaces: tuple[ParameterSurface, ...]
    controls: dict[str, float]
    drift: Array
    read: tuple[Element, ...]
    findings: tuple[Finding, ...]


def actuators(root: Element, found: Assembly, subject: str, file: Path | str | None = None) -> Actuators:
    """Thrusters and fins that act on a hull or on links held to it.

    Parameters
    ----------
    root : Element
    found : Assembly
    subject : str
        Whom the findings are about.
    file : path, optional
    """
    thrusters: list[ParameterThruster] = []
    read: list[Element] = []
    findings: list[Finding] = []
    fins: list[tuple[LiftDrag, Joint | None]] = []
    unread: list[str] = []
    for plugin in root.iter("plugin"):
        if is_system(plugin, "thruster"):
            result = _thruster(plugin, found, {t.name for t in thrusters}, findings, subject, file)
            if result is None:
                unread.append(f"Thruster of {one_line(plugin.findtext('joint_name') or 'no joint')}")
            else:
                thrusters.append(result)
            read.append(plugin)
        elif is_system(plugin, "lift-drag") and not is_system(plugin, "advanced"):
            foil = read_lift_drag(plugin, file)
            if foil.link not in found.links:
                unread.append(f"LiftDrag of {foil.link or 'no link'}")
            else:
                named = next((j for j in found.joints if j.name == foil.joint), None) if foil.joint else None
                fins.append((foil, named or found.joint_of(foil.link)))
            read.append(plugin)
    findings += left_out(subject, "actuators", unread)
    of_fins = fins_by_slopes(fins, found, subject)
    return Actuators(
        tuple(thrusters), of_fins.surfaces, of_fins.controls, of_fins.drift, tuple(read), (*findings, *of_fins.findings)
    )


def is_system(plugin: Element, what: str) -> bool:
    """Whether a plugin is gz-sim's system of that name, such as ``lift-drag``."""
    name, file = plugin.get("name", "").lower(), plugin.get("filename", "").lower().rpartition("/")[2]
    own = file.removeprefix("lib").startswith(("gz-sim", "ignition-gazebo")) or name.startswith(
        ("gz::sim::systems::", "ignition::gazebo::systems::")
    )
    return (
        own and (what in file or what.replace("-", "") in name.rpartition("::")[2]) and "spacecraft" not in file + name
    )


def _thruster(
    plugin: Element, found: Assembly, taken: Iterable[str], findings: list[Finding], subject: str, file: Path | str | None
) -> ParameterThruster | None:  # fmt: skip
    name = (plugin.findtext("joint_name") or "").strip().rpartition("::")[2]
    joint = next((j for j in found.joints if j.name == name), None)
    if joint is None or not np.any(joint.axis):
        return None

    def value(tag: str, default: float) -> float:
        return default if plugin.find(tag) is None else numbers(plugin.findtext(tag), (1,), tag, file)[0]

    low, high, dead = value("min_thrust_cmd", -LARGEST), value("max_thrust_cmd", LARGEST), abs(value("deadband", 0.0))
    if high < low:
        low, high = -LARGEST, LARGEST
    rates = (plugin.findtext("use_angvel_cmd") or "").strip().lower() in ("true", "1")
    if plugin.find("thrust_coefficient") is None and (rates or plugin.find("alpha_2") is not None):
        findings.append(Finding.of("model.open_water", subject, Severity.WARN, names=name, value=value("alpha_1", 1.0)))
    per = (
        value("thrust_coefficient", value("alpha_1", 1.0))
        * value("fluid_density", 1000.0)
        * value("propeller_diameter", 0.02) ** 4
        if rates
        else 1.0
    )
    forward = joint.axis * FLU[:3] * (1.0 if per >= 0.0 else -1.0)
    stop = math.sqrt(dead / abs(per)) if rates and per else dead
    law = (0.0, 0.0, abs(per)) if rates else (0.0, 1.0)
    segments = []
    if low < -stop:
        segments.append(
            CurveSegment(
                low=low, high=min(-stop, high), coefficients=tuple(-c if k == 2 else c for k, c in enumerate(law))
            )
        )
    if high > stop:
        segments.append(CurveSegment(low=max(stop, low), high=high, coefficients=law))
    if not segments:
        return None
    curve = ParameterCurve(
        command="rate" if rates else "thrust", unit="rad/s" if rates else "N", segments=tuple(segments)
    )
    x, y, z = (joint.link.place * FLU[:3] + 0.0).tolist()
    a, b, c = (forward / np.linalg.norm(forward) + 0.0).tolist()
    called = one_line(name)[:100]
    return ParameterThruster(name=called if called not in taken else f"{called}_{len(tuple(taken))}",
                             position=(x, y, z), direction=(a, b, c), curve=curve)  # fmt: skip


class Fins(NamedTuple):
    """Fins as `Actuators` has them."""

    controls: dict[str, float]
    surfaces: tuple[ParameterSurface, ...]
    drift: Array
    findings: list[Finding]


def fins_by_slopes(fins: list[tuple[LiftDrag, Joint | None]], found: Assembly, subject: str) -> Fins:
    """Foils on joints by their slopes at a straight course.

    Parameters
    ----------
    fins : list of (LiftDrag, Joint or None)
    found : Assembly
    subject : str
        Whom the findings are about.
    """
    controls: dict[str, float] = {}
    limits: dict[Literal["dr", "ds"], tuple[float, float | None]] = {}
    drift, odd, read = np.zeros((6, 6)), [], []
    for foil, joint in fins:
        link = found.links[foil.link]
        hinge = joint.axis * FLU[:3] if joint is not None and joint.kind in ("revolute", "continuous") else None
        turning = (
            joint.axis
            if hinge is not None and joint is not None and joint.child == foil.link and not foil.joint
            else None
        )
        way = None if hinge is None else next(((w, i) for w, i in WAYS if abs(hinge[i]) > ALONG), None)
        drift += _slopes(foil, link)
        read.append(foil.link)
        if joint is None or joint.kind == "fixed":
            continue
        if way is None:
            odd.append(joint.name)
            continue
        control, axis = way
        sign = math.copysign(1.0, float(hinge[axis]))  # type: ignore[index]
        nu = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        per = (at_hull(foil, link, turning, nu, STEP) - at_hull(foil, link, turning, nu, -STEP)) / (2.0 * STEP)
        for component, part in zip(COMPONENTS, sign * per * FLU, strict=True):
            if abs(part) > 1e-6 * float(np.max(np.abs(per))):
                controls[component + control] = controls.get(component + control, 0.0) + float(part)
        largest = min(abs(joint.low), abs(joint.high))
        if math.isfinite(largest) and largest > 0.0:
            before = limits.get(control, (math.inf, None))
            limits[control] = (min(largest, before[0]), joint.rate if before[1] is None else before[1])
    findings = [*left_out(subject, "hinges", odd)]
    if read:
        findings.append(Finding.of("model.fins", subject, Severity.NOTE, names=tuple(dict.fromkeys(read))))
    surfaces = tuple(ParameterSurface(control=c, limit=low, rate=rate) for c, (low, rate) in limits.items())
    return Fins(controls, surfaces, drift, findings)


def _slopes(foil: LiftDrag, link: Pose) -> Array:
    """(6, 6) FRD: force over U by u (the whole of it) and v w p q r about a straight course, by central differences."""
    out = np.zeros((6, 6))
    ahead = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    out[:, 0] = at_hull(foil, link, None, ahead)
    for j in range(1, 6):
        step = STEP * np.eye(6)[j]
        out[:, j] = (at_hull(foil, link, None, ahead + step) - at_hull(foil, link, None, ahead - step)) / (2.0 * STEP)
    out = out * np.outer(FLU, FLU)
    return np.where(np.abs(out) > 1e-9 * max(float(np.max(np.abs(out))), 1e-30), out, 0.0)
