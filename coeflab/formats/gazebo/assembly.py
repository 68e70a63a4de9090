"""Links and joints of an SDF or URDF model in the frame of its hull: where each is, what all weigh together, what they displace.

Poses as SDFormat 1.11 has them: of a link in the model, of a joint in its child link, an axis in its joint, unless
``relative_to`` or ``expressed_in`` says otherwise. As URDF has them: the origin of a joint is the child link in the parent's frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.text.xml import numbers
from coeflab.core.types import Array, brief, locking
from coeflab.law.rigid_body import about_another
from coeflab.law.transforms import rotation

MOST_JOINTS = 400
MODEL = "__model__"
LINK = "base_link"  # the hull, in what coeflab writes
STAND_IN = "coeflab_"  # links that coeflab writes for fins and propellers hold no mass of the vehicle's
MOVING = ("revolute", "continuous", "prismatic", "screw", "universal", "ball", "revolute2", "gearbox", "planar", "floating")  # fmt: skip


class Pose(NamedTuple):
    """A frame in another: turn (3, 3) and place (3,)."""

    turn: Array
    place: Array

    def then(self, inner: Pose) -> Pose:
        """A frame given in this one."""
        return Pose(self.turn @ inner.turn, self.place + self.turn @ inner.place)

    @property
    def inverse(self) -> Pose:
        """The outer frame, seen from here."""
        return Pose(self.turn.T, -self.turn.T @ self.place)


HERE = Pose(np.eye(3), np.zeros(3))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("place axis")
class Joint:
    """A joint in the frame of the hull.

    Attributes
    ----------
    name, kind, child : str
    place : (3,) array
        Of the child link's origin, m.
    axis : (3,) array
        Of length one; zero where the joint has none.
    link : Pose
        Of the child link.
    low, high : float
        Limits, rad; infinite where none is stated.
    rate : float or None
        rad/s.
    """

    name: str
    kind: str
    child: str
    place: Array
    axis: Array
    link: Pose
    low: float
    high: float
    rate: float | None


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Assembly:
    """A hull and all that joints hold to it.

    Attributes
    ----------
    hull : str
    links : mapping of name to Pose
        In the hull's frame; those that no joint holds to it are not in it.
    elements : mapping of name to Element
    joints : tuple of Joint
    unplaced : tuple of str
        Links with a mass that are not among `links`, or whose place is not understood.
    """

    hull: str
    links: dict[str, Pose]
    elements: dict[str, Element]
    joints: tuple[Joint, ...]
    unplaced: tuple[str, ...]

    def joint_of(self, child: str) -> Joint | None:
        """The joint that holds a link."""
        return next((j for j in self.joints if j.child == child), None)


def pose_of(element: Element | None, file: Path | str | None = None) -> Pose:
    """A <pose> of an element; URDF states it by <origin xyz rpy>."""
    if element is None:
        return HERE
    origin, pose = element.find("origin"), element.find("pose")
    if pose is not None and (pose.text or "").split():
        values = numbers(pose.text, (6,), "pose", file)
        if (pose.get("degrees") or "").strip().lower() in ("true", "1"):
            values = (*values[:3], *map(math.radians, values[3:]))
    elif origin is not None:
        values = (
            *numbers(origin.get("xyz", "0 0 0"), (3,), "origin xyz", file),
            *numbers(origin.get("rpy", "0 0 0"), (3,), "origin rpy", file),
        )
    else:
        return HERE
    return Pose(rotation(*values[3:]), np.array(values[:3]))


def assembly(root: Element, hull: str, file: Path | str | None = None) -> Assembly:
    """The links that joints hold to a hull, in its frame.

    Parameters
    ----------
    root : Element
        As `coeflab.formats.gazebo.law.as_sdf` leaves it.
    hull : str
        Name of a link.
    file : path, optional
        For messages.
    """
    elements: dict[str, Element] = {}
    for link in root.iter("link"):
        elements.setdefault(link.get("name", ""), link)
    joints = [j for j in root.iter("joint") if j.get("name") is not None and j.find("child") is not None][:MOST_JOINTS]
    ends = {id(j): (joint_end(j, "parent"), joint_end(j, "child")) for j in joints}
    held, waiting = {hull}, [hull]
    while waiting:
        at = waiting.pop()
        for parent, child in ends.values():
            for one, other in ((parent, child), (child, parent)):
                if one == at and other in elements and other not in held:
                    held.add(other)
                    waiting.append(other)
    urdf = root.tag == "robot"
    placed = (
        _by_joints(hull, joints, ends, file)
        if urdf
        else _by_poses(hull, held, elements, joints, ends, _nested(root, file), file)
    )
    links = {n: p for n, p in placed.items() if n in held}
    massive = [n for n, e in elements.items() if n not in links and e.find("inertial/mass") is not None]
    found = tuple(_joint(j, ends[id(j)][1], links, placed, file) for j in joints if ends[id(j)][1] in links)
    return Assembly(hull, links, elements, found, tuple(massive))


def joint_end(joint: Element, tag: str) -> str:
    """Name of the link at an end of a joint, without its model."""
    part = joint.find(tag)
    return "" if part is None else (part.get("link") or (part.text or "")).strip().rpartition("::")[2]


def _by_joints(
    hull: str, joints: list[Element], ends: dict[int, tuple[str, str]], file: Path | str | None
) -> dict[str, Pose]:
    """URDF: from joint to joint, both ways."""
    out, waiting = {hull: HERE}, [hull]
    while waiting:
        at = waiting.pop()
        for j in joints:
            parent, child = ends[id(j)]
            step = pose_of(j, file)
            if parent == at and child not in out:
                out[child] = out[at].then(step)
                waiting.append(child)
            elif child == at and parent not in out:
                out[parent] = out[at].then(step.inverse)
                waiting.append(parent)
    return out


def _by_poses(
    hull: str, held: set[str], elements: dict[str, Element], joints: list[Element], ends: dict[int, tuple[str, str]],
    nested: dict[str, Pose], file: Path | str | None,
) -> dict[str, Pose]:  # fmt: skip
    """SDF: every link in its model; ``relative_to`` another link or joint that is placed is followed, anything else is not.

    The frame of the model stands among them as `MODEL`.
    """
    of_joints = {j.get("name", ""): (ends[id(j)][1], pose_of(j, file)) for j in joints if not pose_base(j.find("pose"))}
    out: dict[str, Pose] = {}

    def resolved(name: str, deep: int) -> Pose | None:
        if name in out:
            return out[name]
        element = elements.get(name)
        if element is None or deep > len(elements):
            return None
        to = pose_base(element.find("pose"))
        own = pose_of(element, file)
        if to in ("", MODEL):
            base: Pose | None = nested.get(name, HERE)
        elif to in of_joints and of_joints[to][0] != name:
            child, at = of_joints[to]
            outer = resolved(child, deep + 1)
            base = None if outer is None else outer.then(at)
        else:
            base = resolved(to, deep + 1)
        if base is None:
            return None
        out[name] = base.then(own)
        return out[name]

    centre = resolved(hull, 0)
    if centre is None:
        return {hull: HERE}
    found = {name: resolved(name, 0) for name in held}
    return {MODEL: centre.inverse} | {name: centre.inverse.then(p) for name, p in found.items() if p is not None}


def pose_base(pose: Element | None) -> str:
    """Name of the frame that a pose is given in; empty of its default."""
    return "" if pose is None else (pose.get("relative_to") or "").strip()


def _nested(root: Element, file: Path | str | None) -> dict[str, Pose]:
    """Where the models stand that links are in, in the outermost one."""
    out: dict[str, Pose] = {}
    waiting: list[tuple[Element, Pose | None]] = [(root, HERE if root.tag == "model" else None)]
    while waiting:
        at, frame = waiting.pop()
        for child in at:
            if child.tag == "model":
                waiting.append((child, HERE if frame is None else frame.then(pose_of(child, file))))
            elif child.tag == "link":
                out.setdefault(child.get("name", ""), frame or HERE)
            elif frame is None:
                waiting.append((child, None))
    return out


def _joint(
    joint: Element, child: str, links: dict[str, Pose], placed: dict[str, Pose], file: Path | str | None
) -> Joint:
    link = links[child]
    axis = joint.find("axis")
    own = np.zeros(3)
    if axis is not None:
        text = (
            axis.get("xyz") or axis.findtext("xyz") or "1 0 0"
            if axis.get("xyz") or axis.find("xyz") is not None
            else "0 0 1"
        )
        own = np.array(numbers(text, (3,), "axis xyz", file))
        xyz = axis.find("xyz")
        frame = "" if xyz is None else (xyz.get("expressed_in") or "").strip()
        pose = joint.find("pose")
        base = (
            link
            if joint.find("origin") is not None or pose is None
            else placed.get(pose_base(pose), link).then(pose_of(joint, file))
        )
        of_model = (axis.findtext("use_parent_model_frame") or "").strip().lower() in ("true", "1")
        base = placed.get(MODEL if of_model else frame, base)
        own = base.turn @ own
        size = float(np.linalg.norm(own))
        own = own / size if size > 0.0 else np.zeros(3)
    limit = joint.find("limit") if joint.find("limit") is not None else joint.find("axis/limit")

    def bound(name: str) -> float | None:
        text = None if limit is None else limit.get(name) or limit.findtext(name)
        if text is None or text.strip().lower().lstrip("+-") in ("inf", "infinity"):
            return None
        return numbers(text, (1,), f"limit {name}", file)[0]

    low, high, rate = bound("lower"), bound("upper"), bound("velocity")
    free = joint.get("type") == "continuous"
    return Joint(
        joint.get("name", ""), joint.get("type", ""), child, link.place, own, link,
        -math.inf if low is None or free else low, math.inf if high is None or free else high,
        rate if rate is not None and rate > 0.0 else None,
    )  # fmt: skip


class Lumped(NamedTuple):
    """Mass, kg, centre (3,) and inertia about it (3, 3) of several links, in the hull's frame; None where a link has no inertia."""

    mass: float
    centre: Array
    inertia: Array | None
    names: tuple[str, ...]


def own_inertia(inertial: Element, file: Path | str | None = None) -> Array | None:
    """(3, 3) in the axes of an <inertial>; None without all three moments."""
    entries = {(i, j): inertial.findtext(f"inertia/i{'xyz'[i]}{'xyz'[j]}") for i in range(3) for j in range(i, 3)}
    if any(entries[i, i] is None for i in range(3)):
        return None
    values = {k: numbers(v or "0", (1,), "inertia", file)[0] for k, v in entries.items()}
    return np.array([[values[min(i, j), max(i, j)] for j in range(3)] for i in range(3)])


def lumped(found: Assembly, own: tuple[float, Array, Array | None], file: Path | str | None = None) -> Lumped:
    """All that is held to the hull as one body, moving joints at zero.

    Parameters
    ----------
    found : Assembly
    own : (mass, centre, inertia)
        Of the hull, as its reader has them.
    file : path, optional
    """
    parts = [(own[0], own[1], own[2])]
    names = []
    for name, pose in found.links.items():
        inertial = found.elements[name].find("inertial") if name in found.elements else None
        if name == found.hull or name.startswith(STAND_IN) or inertial is None or inertial.find("mass") is None:
            continue
        mass = numbers(inertial.findtext("mass"), (1,), f"mass of {name}", file)[0]
        if mass <= 0.0:
            continue
        at = pose.then(pose_of(inertial, file))
        plain = own_inertia(inertial, file)
        parts.append((mass, at.place, None if plain is None else at.turn @ plain @ at.turn.T))
        names.append(name)
    total = math.fsum(p[0] for p in parts)
    centre = sum((p[0] * p[1] for p in parts), np.zeros(3)) / total
    inertia = None
    if own[2] is not None:
        inertia = sum(
            (
                about_another(np.zeros((3, 3)) if p[2] is None else p[2], p[0], np.zeros(3), p[1] - centre)
                for p in parts
            ),
            np.zeros((3, 3)),
        )
    return Lumped(total, centre, inertia, tuple(names))


class Displaced(NamedTuple):
    """Volume of all collisions, m^3, its centre (3,) in the hull's frame, and collisions whose shape states no volume."""

    volume: float
    centre: Array
    unknown: tuple[str, ...]


def displaced_by(found: Assembly, file: Path | str | None = None) -> Displaced:
    """What the collisions of a hull and of all that joints hold to it displace, as gz-sim's Buoyancy counts it."""
    volume, moment, unknown = 0.0, np.zeros(3), []
    for name, pose in found.links.items():
        for collision in found.elements[name].iterfind("collision") if name in found.elements else ():
            at = pose.then(pose_of(collision, file))
            for shape in collision.iterfind("geometry/*"):
                size = shape_volume(shape, file)
                if size is None:
                    unknown.append(f"{shape.tag} of {name}")
                else:
                    volume += size
                    moment = moment + size * at.place
    return Displaced(volume, moment / volume if volume > 0.0 else moment, tuple(unknown))


def collision_box(found: Assembly, file: Path | str | None = None) -> Array | None:
    """Sizes (3,) of the box around the plain collisions of the hull itself, m; None where a shape is a mesh or there is none."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for collision in found.elements[found.hull].iterfind("collision") if found.hull in found.elements else ():
        at = pose_of(collision, file)
        for shape in collision.iterfind("geometry/*"):
            half = _half(shape, file)
            if half is None:
                return None
            reach = np.abs(at.turn) @ half
            low, high = np.minimum(low, at.place - reach), np.maximum(high, at.place + reach)
    return high - low if np.all(np.isfinite(low)) else None


def _size(shape: Element, file: Path | str | None, tag: str, count: int = 1) -> tuple[float, ...]:
    return numbers(shape.findtext(tag), (count,), f"{shape.tag} {tag}", file)


def _half(shape: Element, file: Path | str | None) -> Array | None:
    size = partial(_size, shape, file)
    match shape.tag:
        case "box":
            return np.array(size("size", 3)) / 2.0
        case "cylinder" | "capsule":
            radius, half = size("radius")[0], size("length")[0] / 2.0
            return np.array([radius, radius, half + (radius if shape.tag == "capsule" else 0.0)])
        case "sphere":
            return np.full(3, size("radius")[0])
        case "ellipsoid":
            return np.array(size("radii", 3))
        case _:
            return None


def shape_volume(shape: Element, file: Path | str | None = None) -> float | None:
    """Of a box, cylinder, sphere, capsule or ellipsoid, m^3; zero of a plane, None of anything else.

    Raises
    ------
    InputError
        A size that is no number.
    """
    size = partial(_size, shape, file)
    match shape.tag:
        case "box":
            return math.prod(size("size", 3))
        case "cylinder":
            return math.pi * size("radius")[0] ** 2 * size("length")[0]
        case "capsule":
            radius = size("radius")[0]
            return math.pi * radius**2 * (size("length")[0] + 4.0 / 3.0 * radius)
        case "sphere":
            return 4.0 / 3.0 * math.pi * size("radius")[0] ** 3
        case "ellipsoid":
            return 4.0 / 3.0 * math.pi * math.prod(size("radii", 3))
        case "plane" | "empty":
            return 0.0
        case _:
            return None
