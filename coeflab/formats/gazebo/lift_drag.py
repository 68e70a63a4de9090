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
from coeflab.core.types import Array, brief, locking
from coeflab.formats.gazebo.assembly import Pose
from coeflab.law.transforms import turned_about

SLOWEST = 0.01  # m/s
DEFAULTS = {
    "cla": 1.0, "cda": 0.01, "cma": 0.0, "alpha_stall": math.pi / 2.0, "cla_stall": 0.0, "cda_stall": 1.0, "cma_stall": 0.0,
    "cm_delta": 0.0, "air_density": 1.2041, "area": 1.0, "a0": 0.0, "control_joint_rad_to_cl": 4.0,
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("cp forward upward")
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

    def wrench(self, velocity: Array, rates: Array, angle: Array | float = 0.0) -> Array:
        """Force and moment (..., 6) about the link's origin in the link's frame, for its velocity and rates (..., 3) there.

        ``angle`` (...) is that of the control joint, which adds to the lift.
        """
        n = self.numbers
        v = velocity + np.cross(rates, self.cp)
        along = _unit(v)
        at_rest = (np.linalg.norm(v, axis=-1) <= SLOWEST) | (not self.reversible and v @ self.forward <= 0.0)
        upward = _unit(np.cross(self.forward, np.cross(self.forward, along))) if self.radial else self.upward
        span = _unit(np.cross(self.forward, upward))
        cos2 = 1.0 - np.clip(np.sum(span * along, axis=-1), -1.0, 1.0) ** 2
        plane = v - np.sum(v * span, axis=-1, keepdims=True) * span
        lift = _unit(np.cross(span, plane))
        side = np.where(lift @ self.forward >= 0.0, 1.0, -1.0)
        alpha = np.arccos(np.clip(np.sum(lift * upward, axis=-1), -1.0, 1.0)) * side + n["a0"]
        while np.any(far := np.abs(alpha) > 0.5 * math.pi):
            alpha = np.where(far, alpha - np.copysign(math.pi, alpha), alpha)
        pressure = 0.5 * n["air_density"] * np.sum(plane * plane, axis=-1) * n["area"]
        turned = angle if self.joint else 0.0
        cl = self._coefficient("cla", alpha) * cos2 + n["control_joint_rad_to_cl"] * turned
        cd = np.abs(self._coefficient("cda", alpha, floor=False) * cos2)
        cm = self._coefficient("cma", alpha) * cos2 + n["cm_delta"] * turned
        force = pressure[..., None] * (cl[..., None] * lift - cd[..., None] * _unit(plane))
        moment = (pressure * cm)[..., None] * span + np.cross(self.cp, force)
        return np.where(at_rest[..., None], 0.0, np.concatenate([force, moment], axis=-1))

    def _coefficient(self, name: str, alpha: Array, *, floor: bool = True) -> Array:
        """Straight to the stall, then by the other slope; lift and moment do not change sign there."""
        n = self.numbers
        slope, stall, beyond = n[name], n["alpha_stall"], n[f"{name}_stall"]
        value = slope * stall + beyond * (np.abs(alpha) - stall)
        stalled = np.copysign(np.maximum(0.0, value), alpha) if floor else value
        return np.asarray(np.where(np.abs(alpha) <= stall, slope * alpha, stalled))


def _unit(a: Array) -> Array:
    size = np.linalg.norm(a, axis=-1, keepdims=True)
    return np.asarray(np.divide(a, size, out=np.array(a), where=size > 0.0))


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


def at_hull(foil: LiftDrag, link: Pose, axis: Array | None, nu: Array, angle: Array | float = 0.0) -> Array:
    """Force and moment (..., 6) of a foil about the hull's origin in the hull's frame.

    Parameters
    ----------
    foil : LiftDrag
    link : Pose
        Of its link in the hull's frame at a joint angle of zero.
    axis : (3,) array or None
        Of the joint that turns the link about its origin, in the hull's frame; None: fixed.
    nu : (..., 6) array
        Velocity of the hull's origin, in the hull's frame.
    angle : float, or (...) array where there is no axis
        Of that joint, rad; of the control joint where the foil names one.
    """
    turn = link.turn if axis is None else turned_about(axis, float(angle)) @ link.turn
    velocity = nu[..., :3] + np.cross(nu[..., 3:], link.place)
    own = foil.wrench(velocity @ turn, nu[..., 3:] @ turn, angle)
    force, moment = own[..., :3] @ turn.T, own[..., 3:] @ turn.T
    return np.concatenate([force, moment + np.cross(link.place, force)], axis=-1)
