"""gz-sim's LiftDrag: what an SDF file holds of a fin, and the force that gz-sim makes of it.

The law is that of src/systems/lift_drag/LiftDrag.cc, commit 93bbf3e, Load and Update, in still water: nothing where the link
moves at 0.01 m/s or less, or backwards unless <reversible>; lift, drag and moment by the angle in the plane of forward and upward.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.text.xml import numbers
from coeflab.core.types import Array, brief, locked
from coeflab.formats.gazebo.assembly import Pose
from coeflab.law.transforms import turned_about

SLOWEST = 0.01  # m/s
DEFAULTS = {
    "cla": 1.0, "cda": 0.01, "cma": 0.0, "alpha_stall": math.pi / 2.0, "cla_stall": 0.0, "cda_stall": 1.0, "cma_stall": 0.0,
    "cm_delta": 0.0, "air_density": 1.2041, "area": 1.0, "a0": 0.0, "control_joint_rad_to_cl": 4.0,
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
class LiftDrag:
    """One foil, in the frame of its link.

    Attributes
    ----------
    link, joint : str
        Names; ``joint`` is <control_joint_name>, empty where there is none.
    numbers : mapping of tag to float
    cp, forward, upward : (3,) arrays
    reversible, radial : bool
    """

    link: str
    joint: str
    numbers: dict[str, float]
    cp: Array
    forward: Array
    upward: Array
    reversible: bool
    radial: bool

    def __post_init__(self) -> None:
        for name in ("cp", "forward", "upward"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def wrench(self, velocity: Array, rates: Array, angle: float = 0.0) -> Array:
        """Force and moment (6,) about the link's origin in the link's frame, for its velocity (3,) and rates (3,) there.

        ``angle`` is that of the control joint, which adds to the lift.
        """
        n = self.numbers
        v = velocity + np.cross(rates, self.cp)
        if np.linalg.norm(v) <= SLOWEST or (not self.reversible and self.forward @ v <= 0.0):
            return np.zeros(6)
        upward = self.upward
        if self.radial:
            upward = _unit(np.cross(self.forward, np.cross(self.forward, _unit(v))))
        span = _unit(np.cross(self.forward, upward))
        cos2 = 1.0 - float(np.clip(span @ _unit(v), -1.0, 1.0)) ** 2
        plane = v - (v @ span) * span
        lift = _unit(np.cross(span, plane))
        alpha = (
            math.acos(float(np.clip(lift @ upward, -1.0, 1.0))) * (1.0 if lift @ self.forward >= 0.0 else -1.0)
            + n["a0"]
        )
        while abs(alpha) > 0.5 * math.pi:
            alpha -= math.copysign(math.pi, alpha)
        pressure = 0.5 * n["air_density"] * float(plane @ plane) * n["area"]
        cl = self._coefficient("cla", alpha) * cos2 + (n["control_joint_rad_to_cl"] * angle if self.joint else 0.0)
        cd = abs(self._coefficient("cda", alpha, floor=False) * cos2)
        cm = self._coefficient("cma", alpha) * cos2 + (n["cm_delta"] * angle if self.joint else 0.0)
        force = pressure * (cl * lift - cd * _unit(plane))
        return np.concatenate([force, pressure * cm * span + np.cross(self.cp, force)])

    def _coefficient(self, name: str, alpha: float, *, floor: bool = True) -> float:
        """Straight to the stall, then by the other slope; lift and moment do not change sign there."""
        n = self.numbers
        slope, stall, beyond = n[name], n["alpha_stall"], n[f"{name}_stall"]
        if abs(alpha) <= stall:
            return slope * alpha
        value = slope * stall + beyond * (abs(alpha) - stall)
        return math.copysign(max(0.0, value), alpha) if floor else value


def _unit(a: Array) -> Array:
    size = float(np.linalg.norm(a))
    return a / size if size > 0.0 else a


def read_lift_drag(plugin: Element, file: Path | str | None = None) -> LiftDrag:
    """The foil of a plugin; tags that are missing have gz-sim's own values.

    Raises
    ------
    InputError
        A tag that is no number.
    """

    def vector(tag: str, default: tuple[float, ...]) -> Array:
        text = plugin.findtext(tag)
        return np.array(default if text is None else numbers(text, (3,), tag, file))

    def flag(tag: str) -> bool:
        return (plugin.findtext(tag) or "").strip().lower() in ("true", "1")

    values = {
        tag: default if plugin.find(tag) is None else numbers(plugin.findtext(tag), (1,), tag, file)[0]
        for tag, default in DEFAULTS.items()
    }
    return LiftDrag(
        link=(plugin.findtext("link_name") or "").strip().rpartition("::")[2],
        joint=(plugin.findtext("control_joint_name") or "").strip().rpartition("::")[2],
        numbers=values,
        cp=vector("cp", (0.0, 0.0, 0.0)),
        forward=_unit(vector("forward", (1.0, 0.0, 0.0))),
        upward=_unit(vector("upward", (0.0, 0.0, 1.0))),
        reversible=flag("reversible"),
        radial=flag("radial_symmetry"),
    )


def at_hull(foil: LiftDrag, link: Pose, axis: Array | None, nu: Array, angle: float = 0.0) -> Array:
    """Force and moment (6,) of a foil about the hull's origin in the hull's frame.

    Parameters
    ----------
    foil : LiftDrag
    link : Pose
        Of its link in the hull's frame at a joint angle of zero.
    axis : (3,) array or None
        Of the joint that turns the link about its origin, in the hull's frame; None: fixed.
    nu : (6,) array
        Velocity of the hull's origin, in the hull's frame.
    angle : float
        Of that joint, rad; of the control joint where the foil names one.
    """
    turn = link.turn if axis is None else turned_about(axis, angle) @ link.turn
    velocity = nu[:3] + np.cross(nu[3:], link.place)
    own = foil.wrench(turn.T @ velocity, turn.T @ nu[3:], angle)
    force, moment = turn @ own[:3], turn @ own[3:]
    return np.concatenate([force, moment + np.cross(link.place, force)])
