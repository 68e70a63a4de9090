"""Fins of uuv_simulator and DAVE: lift by the angle of the flow in the plane of the fin, at the centre of gravity of its link.

FinPlugin.cc and LiftDragModel.cc of uuv_gazebo_plugins, commit bfb40cb1: the fin turns to its command, within the limits of its joint, by
<dynamics>; in the axes of its link, the force is against y with the angle of the velocity from x, by <lift_constant> U^2, or by half of
density, area and <cla> up to the stall.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.formats.gazebo.actuators import Fins, fins_by_slopes
from coeflab.formats.gazebo.assembly import Assembly, Joint, pose_of
from coeflab.formats.gazebo.lift_drag import DEFAULTS, LiftDrag
from coeflab.formats.left_out import left_out
from coeflab.formats.uuv_simulator.thrusters import UnknownLawError, text_of, value_of
from coeflab.formats.uuv_simulator.xacro import Xacro

FILE = re.compile(r"lib\w*fin(_ros)?_plugin(\.so)?", re.IGNORECASE)


def fins_of(
    root: Element, found: Assembly | None, subject: str, x: Xacro, path: Path
) -> tuple[Fins, tuple[Element, ...]]:
    """The fins that joints hold to the hull, and their plugins.

    Parameters
    ----------
    root : Element
    found : Assembly or None
    subject : str
        Whom findings are about.
    x : Xacro
    path : path
    """
    plugins = tuple(p for p in root.iter("plugin") if FILE.fullmatch(p.get("filename", "").rpartition("/")[2]))
    read: list[tuple[LiftDrag, Joint | None]] = []
    unread, late = [], []
    for plugin in plugins:
        name = plugin.get("name", "") or (plugin.findtext("link_name") or "").strip()
        try:
            name = text_of(name, x)
            foil, joint = _fin(plugin, found, x, path)
            lag = value_of(plugin, "dynamics/timeConstant", 0.0, x, path)
        except UnknownLawError:
            unread.append(f"Fin {name}")
            continue
        read.append((foil, joint))
        late += [f"{lag:g} s of {name}"] if lag > 0.0 else []
    out = Fins({}, (), np.zeros((6, 6)), []) if found is None else fins_by_slopes(read, found, subject)
    words = [*left_out(subject, "actuators", unread), *out.findings, *left_out(subject, "late_fins", late)]
    return out._replace(findings=words), plugins


def _fin(plugin: Element, found: Assembly | None, x: Xacro, path: Path) -> tuple[LiftDrag, Joint]:
    link, called = (text_of(plugin.findtext(tag) or "", x).strip() for tag in ("link_name", "joint_name"))
    joint = None if found is None else next((j for j in found.joints if j.name == called and j.child == link), None)
    if found is None or joint is None:
        raise UnknownLawError

    def of(tag: str) -> float:
        return value_of(plugin, f"liftdrag/{tag}", math.nan, x, path)

    kind = (plugin.findtext("liftdrag/type") or "").strip()
    if kind == "TwoLines":
        own = {t: of(t) for t in ("cla", "area", "alpha_stall")} | {"air_density": of("fluid_density"), "a0": -of("a0")}
    elif kind == "Quadratic":
        own = {"cla": of("lift_constant"), "area": 1.0, "air_density": 2.0}
    else:
        raise UnknownLawError
    if any(map(math.isnan, own.values())):
        raise UnknownLawError
    numbers = DEFAULTS | {"cda": 0.0} | own
    at = pose_of(found.elements[link].find("inertial"), path).place
    return LiftDrag(link, "", numbers, at, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), True, False), joint
