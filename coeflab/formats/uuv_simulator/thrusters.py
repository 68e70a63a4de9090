"""Thrusters of uuv_simulator and DAVE: a command through a rotor's lag, then through a conversion, along the joint.

ThrusterPlugin.cc, Dynamics.cc and ThrusterConversionFcn.cc of uuv_gazebo_plugins, commit bfb40cb1: the command, within <clampMin> and
<clampMax>, times <gain> is what the rotor's speed goes to; the conversion of the speed is the thrust, within <thrustMin> and <thrustMax>, at
the centre of gravity of <linkName> along the axis of <jointName>.
"""

from __future__ import annotations

import copy
import math
import re
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding
from coeflab.core.text.xml import numbers
from coeflab.formats.gazebo.assembly import Assembly, pose_of
from coeflab.formats.left_out import left_out
from coeflab.formats.rotor_curves import (
    FASTEST,
    Pieces,
    held,
    lines,
    not_limited,
    per_command,
    rise,
    rotor,
    squares,
    where,
)
from coeflab.formats.uuv_simulator.law import FRD
from coeflab.formats.uuv_simulator.xacro import Xacro
from coeflab.vehicle.parameter_parts import ParameterThruster

FILE = re.compile(r"lib\w*thruster(_ros)?_plugin(\.so)?", re.IGNORECASE)
EFFICIENCIES = ("thrust_efficiency", "propeller_efficiency")


class Driven(NamedTuple):
    """Thrusters, the plugins that they are all of, and findings."""

    thrusters: tuple[ParameterThruster, ...]
    plugins: tuple[Element, ...]
    findings: tuple[Finding, ...]


class UnknownLawError(ValueError):
    """A law that is not known here, or a place that the file does not state."""


def thrusters_of(root: Element, links: Assembly | None, subject: str, x: Xacro, path: Path) -> Driven:
    """The thrusters that joints hold to a link.

    Parameters
    ----------
    root : Element
    links : Assembly or None
        Of the hull.
    subject : str
        Whom findings are about.
    x : Xacro
    path : path
    """
    plugins = [p for p in root.iter("plugin") if FILE.fullmatch(p.get("filename", "").rpartition("/")[2])]
    out: dict[str, ParameterThruster] = {}
    unread: list[str] = []
    free: list[str] = []
    for plugin in plugins:
        name = plugin.get("name", "") or (plugin.findtext("linkName") or "").strip()
        try:
            name = text_of(name, x)
            found = None if links is None or name in out else _thruster(plugin, name, links, free, x, path)
        except UnknownLawError:
            found = None
        if found is None:
            unread.append(f"Thruster {name}")
        else:
            out[name] = found
    return Driven(
        tuple(out.values()), tuple(plugins), (*left_out(subject, "actuators", unread), *not_limited(subject, free))
    )


def plain(root: Element, x: Xacro) -> Element:
    """Links and joints as URDF has them, every expression of xacro computed; without those that need what another file defines."""
    out = Element("robot")
    for e in (*root.iter("link"), *root.iter("joint")):
        if e.find("hydrodynamic_model") is None and e.get("name") is not None:
            try:
                out.append(_computed(copy.deepcopy(e), x))
            except InputError:
                continue
    return out


def _computed(element: Element, x: Xacro) -> Element:
    for e in element.iter():
        for key, text in e.attrib.items():
            e.set(key, x.text(text))
    return element


def _thruster(
    plugin: Element, name: str, found: Assembly, free: list[str], x: Xacro, path: Path
) -> ParameterThruster | None:  # fmt: skip
    called, link = (text_of(plugin.findtext(tag) or "", x).strip() for tag in ("jointName", "linkName"))
    joint = next((j for j in found.joints if j.name == called), None) or found.joint_of(link)
    if joint is None or link not in found.links or not np.any(joint.axis):
        raise UnknownLawError
    at = found.links[link].then(pose_of(found.elements[link].find("inertial"), path)).place
    efficiency, share = (e if 0.0 <= (e := value_of(plugin, t, 1.0, x, path)) <= 1.0 else 1.0 for t in EFFICIENCIES)
    gain = value_of(plugin, "gain", 1.0, x, path)
    if not gain * share:
        raise UnknownLawError
    pieces = per_command(held(_conversion(plugin, x, path), -FASTEST, FASTEST), 1.0, efficiency)
    least, most = _ends(plugin, "thrustMin", "thrustMax", x, path)
    low, high = (where(pieces, v) for v in ((least, most) if rise(pieces) > 0.0 else (most, least)))
    pieces = held(pieces, -math.inf if low is None else low, math.inf if high is None else high)
    pieces = held(per_command(pieces, gain * share), *_ends(plugin, "clampMin", "clampMax", x, path))
    if pieces and max(-pieces[0].low, pieces[-1].high) * abs(gain * share) >= FASTEST:
        free.append(name)
    return rotor(
        name, at * FRD, joint.axis * FRD, pieces, unit="rad/s" if gain == 1.0 else "1", lag=_lag(plugin, x, path)
    )


def _ends(plugin: Element, low: str, high: str, x: Xacro, path: Path) -> tuple[float, float]:
    """Limits, infinite where the plugin takes none: one is missing, or they are not in order."""
    found = value_of(plugin, low, -math.inf, x, path), value_of(plugin, high, math.inf, x, path)
    return found if found[0] < found[1] else (-math.inf, math.inf)


def _lag(plugin: Element, x: Xacro, path: Path) -> float | None:
    """Time constant, s; None of a rotor that is at its speed at once."""
    kind = (plugin.findtext("dynamics/type") or "").strip()
    if kind not in ("FirstOrder", "ZeroOrder"):
        raise UnknownLawError
    found = value_of(plugin, "dynamics/timeConstant", 0.0, x, path) if kind == "FirstOrder" else 0.0
    return found if found > 0.0 else None


def _conversion(plugin: Element, x: Xacro, path: Path) -> Pieces:
    """Thrust over the rotor's speed."""

    def of(tag: str) -> float:
        return value_of(plugin, f"conversion/{tag}", math.nan, x, path)

    match (plugin.findtext("conversion/type") or "").strip():
        case "Basic":
            out = squares(of("rotorConstant"), of("rotorConstant"))
        case "Bessa":
            dead = of("deltaL"), of("deltaR")
            if not dead[0] <= 0.0 <= dead[1]:
                raise UnknownLawError
            out = squares(of("rotorConstantL"), of("rotorConstantR"), dead)
        case "LinearInterp":
            both = [text_of(plugin.findtext(f"conversion/{tag}") or "", x) for tag in ("inputValues", "outputValues")]
            speeds, values = (numbers(text, (len(text.split()) or 1,), "conversion", path) for text in both)
            points = dict(zip(speeds, values, strict=False))
            if len(speeds) != len(values) or len(points) < 2:
                raise UnknownLawError
            out = lines(sorted(points), [points[s] for s in sorted(points)])
        case _:
            raise UnknownLawError
    if any(math.isnan(c) for p in out for c in p.coefficients):
        raise UnknownLawError
    return out


def text_of(raw: str, x: Xacro) -> str:
    """A text of xacro computed; `UnknownLawError` where it needs what another file defines."""
    try:
        return x.text(raw)
    except InputError:
        raise UnknownLawError from None


def value_of(plugin: Element, tag: str, default: float, x: Xacro, path: Path) -> float:
    """The number in a tag."""
    text = plugin.findtext(tag)
    return default if text is None else numbers(text_of(text, x), (1,), tag, path)[0]
