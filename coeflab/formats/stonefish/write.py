"""Stonefish: a scenario with one robot, its mesh, and the drags along its axes; nothing else of a force law.

The mesh is an ellipsoid, for Stonefish computes drag, buoyancy and added mass from a mesh and the file states none. Its form
drag grows with the cube of the speed and its friction in proportion to it. How they are chosen is said in
`coeflab.formats.stonefish.write` and, with figures, in the loss report.

Stonefish's fluid forces on a submerged mesh, steady part, and a mesh of an ellipsoid.

Source of the law: patrykcieslak/stonefish, Library/src/entities/SolidEntity.cpp at commit 3857913, functions
ComputeHydrodynamicForcesSubmerged, CorrectHydrodynamicForces, ComputeEllipsoidalApprox, LambKFactor and getAugmentedMass;
FeatherstoneEntity.cpp gives mass and inertia with the added ones to the engine, gyroscopic terms on.

What the source calls quadratic drag is v |v| (-v.n) a face, hence a force with the cube of the speed, and its coefficient is in
s/m; what it calls viscous is linear, its coefficient in m/s. The coefficients of the three axes are weighed by the direction
of the force. Added mass is one number for all directions, the mean of three: there is no Munk moment.

A robot's one link in Stonefish, and the drags along its axes that stand for a force law.

Stonefish's form drag grows with the cube of the speed, its friction in proportion to it, and both are weighed by the direction of
the force on the whole mesh. Drags that meet a resistance straight ahead can be several times too large in drift.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.text.xml import numbers, parse_xml, serialised
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.core.wording import identifier, one_line
from coeflab.formats.exported_law import held_when_straight, number
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import covered_grid, unheld
from coeflab.formats.missing_parts import missing_mass
from coeflab.formats.mujoco.law import ellipsoid_of_masses
from coeflab.law.transforms import force_transfer, moved, velocity_transfer
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.inertia import central_inertia, centre_of_gravity, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import second_order

AT_ONCE = 128
RINGS, SEGMENTS = 12, 16
FLUID_ROUNDING = 1e-10


def ellipsoid_mesh(axes: Array, centre: Array) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (n, 3) and faces (m, 3), seen from outside counter-clockwise, of semi-axes (3,) along x, y, z.

    No face is three times larger than their mean, which Stonefish would divide.
    """
    theta, phi = np.pi * np.arange(1, RINGS) / RINGS, 2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    rings = np.stack(
        np.broadcast_arrays(
            np.cos(theta)[:, None], np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi))
        ),
        axis=-1,
    ).reshape(-1, 3)
    unit = np.vstack([rings, [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]])
    front, back = len(unit) - 2, len(unit) - 1
    faces = []
    for k in range(SEGMENTS):
        n = (k + 1) % SEGMENTS
        faces += [(front, k, n), (back, (RINGS - 2) * SEGMENTS + n, (RINGS - 2) * SEGMENTS + k)]
        for i in range(RINGS - 2):
            a, b = i * SEGMENTS, (i + 1) * SEGMENTS
            faces += [(a + k, b + k, b + n), (a + k, b + n, a + n)]
    return centre + unit * axes, np.array(faces, dtype=np.int64)


def raw_drag(corners: Array, v: Array, w: Array) -> tuple[Array, Array, Array, Array]:
    """Sums over faces before coefficients: force and torque of the form drag, force and torque of friction, each (n, 3).

    Parameters
    ----------
    corners : (m, 3, 3) array
        From the centre of gravity, m.
    v, w : (n, 3) arrays
        Velocity of the centre of gravity and rate of turn, body axes.
    """
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    normal, area, middle = normal / size, size / 2.0, corners.mean(axis=1)
    out: list[list[Array]] = [[], [], [], []]
    for at in range(0, len(v), AT_ONCE):
        water = -(v[at : at + AT_ONCE, None] + np.cross(w[at : at + AT_ONCE, None], middle))
        through = np.sum(water * normal, axis=2, keepdims=True)
        form = water * np.linalg.norm(water, axis=2, keepdims=True) * np.maximum(-through, 0.0) * area
        skin = (water - through * normal) * area
        for k, face in enumerate((form, skin)):
            out[2 * k].append(_summed(face))
            out[2 * k + 1].append(_summed(np.cross(middle, face)))
    form_force, form_torque, skin_force, skin_torque = (np.concatenate(parts) for parts in out)
    return form_force, form_torque, skin_force, skin_torque


def _summed(faces: Array) -> Array:
    """Over the faces, (n, 3); what cancels to rounding is zero."""
    total = faces.sum(axis=1)
    return np.where(np.abs(total) <= FLUID_ROUNDING * np.abs(faces).sum(axis=1), 0.0, total)


def weighed(raw: Array, coefficients: Array) -> Array:
    """Raw forces or torques (n, 3) times the coefficients (3,) weighed by their direction."""
    size = np.linalg.norm(raw, axis=1, keepdims=True)
    direction = np.divide(np.abs(raw), size, out=np.zeros_like(raw), where=size > 0.0)
    return np.asarray(raw * (direction @ coefficients)[:, None])


def added(corners: Array, density: float) -> tuple[float, Array]:
    """Added mass, kg, and added moments of inertia (3,), kg m^2, that Stonefish takes from the extent of a mesh.

    The factor for motion ahead is Stonefish's, whose 1 - r^2 / a is not Lamb's 1 - r^2 / a^2.
    """
    a, b, c = (np.max(corners, axis=(0, 1)) - np.min(corners, axis=(0, 1))) / 2.0
    r = (b + c) / 2.0
    e = 1.0 - r * r / a
    log = (1.0 + e) / (1.0 - e)
    alpha = 2.0 * (1.0 - e * e) / (e * e) * (0.5 * np.log(log) - e) if log > 0.0 else 1.0
    volume = 4.0 / 3.0 * np.pi * density
    masses = np.array([alpha / (2.0 - alpha) * volume * a * r * r, volume * a * c * c, volume * a * b * b])
    moments = np.pi * density / 12.0 * a**3 * np.array([0.0, b * b, c * c])
    return float(masses.mean()), moments


DIGITS, ROUNDING = 6, 1e-9
FORCES = "XYZ"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class StonefishLink:
    """A mesh in water and its drags.

    Attributes
    ----------
    vertices, faces : (n, 3) and (m, 3) arrays
        m, FRD, from the reference point.
    centre : (3,) array
        Centre of gravity.
    form, skin : (3,) arrays
        ``quadratic_drag`` in s/m and ``viscous_drag`` in m/s, along the axes.
    density : float
        kg/m^3.
    """

    vertices: Array
    faces: NDArray[np.int64]
    centre: Array
    form: Array
    skin: Array
    density: float

    @property
    def corners(self) -> Array:
        """Of the faces, (m, 3, 3), from the centre of gravity."""
        return np.asarray(self.vertices[self.faces] - self.centre)

    def force(self, nu: Array) -> Array:
        """(n, 6), FRD, about the reference point: drags, and what the added mass takes up in turning."""
        return np.asarray(self._inertial(nu) + self.per_coefficient(nu) @ np.concatenate([self.form, self.skin]))

    def per_coefficient(self, nu: Array) -> Array:
        """(n, 6, 6): the force, about the reference point, of each of the three form and three skin coefficients."""
        v, w = self._own(nu)
        form_force, form_torque, skin_force, skin_torque = raw_drag(self.corners, v, w)
        out = []
        for force, torque, scale in (
            (form_force, form_torque, 0.5 * self.density),
            (skin_force, skin_torque, self.density),
        ):
            for axis in scale * np.eye(3):
                out.append(self._moved(weighed(force, axis), weighed(torque, axis)))
        return np.stack(out, axis=-1)

    def _inertial(self, nu: Array) -> Array:
        v, w = self._own(nu)
        mass, moments = added(self.corners, self.density)
        return self._moved(-np.cross(w, mass * v), -np.cross(w, moments * w))

    def _own(self, nu: Array) -> tuple[Array, Array]:
        own = nu @ velocity_transfer(self.centre).T
        return own[:, :3], own[:, 3:]

    def _moved(self, force: Array, torque: Array) -> Array:
        return np.asarray(np.hstack([force, torque]) @ force_transfer(-self.centre).T)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ChosenDrags:
    """A link with drags, and what they are worth.

    Attributes
    ----------
    link : StonefishLink
    met : bool
        Whether the drags meet the file at its speed, straight along each axis; else they are those of least squares.
    none, at_speed, least : (3,) arrays
        Root mean square error of X, Y, Z over the covered range, N, without drag and with either kind of drags.
    ahead : float or None
        Drag straight ahead at the file's speed over the file's; None where the file has none.
    """

    link: StonefishLink
    met: bool
    none: Array
    at_speed: Array
    least: Array
    ahead: float | None

    def in_words(self) -> str:
        """The rule, the choice and its figures."""
        kinds = (
            ("no drag", self.none),
            ("drags met at the file's speed", self.at_speed),
            ("least squares", self.least),
        )
        figures = "; ".join(
            f"{kind} {' '.join(f'{c} {e:.3g}' for c, e in zip(FORCES, errors, strict=True))}" for kind, errors in kinds
        )
        chosen = (
            "drags that meet the file in value and slope at its speed are written, for over the covered range they make neither X "
            "nor Y nor Z worse than no drag"
            if self.met
            else "the drags are those of least squares over the covered range (X, Y and Z each over its error without drag, none below "
            "zero), for drags that meet the file at its speed make a force worse than no drag in drift and turning"
        )
        ahead = (
            "" if self.ahead is None else f"; straight ahead at that speed the drag is {self.ahead:.3g} of the file's"
        )
        return f"{chosen}; rms error in N: {figures}{ahead}"


def chosen_drags(parameters: ParameterFile, bare: StonefishLink) -> ChosenDrags:
    """Drags for a link without any.

    Those that meet the file straight along each axis at its speed, in value and slope, unless X, Y or Z then has a larger
    error over the covered range than without drag; else least squares, whose coefficients are not negative.
    """
    law, (nu, _) = force_law(parameters), covered_grid(parameters)
    columns = bare.per_coefficient(nu)[:, :3]
    missing = (law.force(nu) - bare.force(nu))[:, :3]
    met = met_at_speed(parameters, bare)
    none = _rms(missing)
    least = _least_squares(columns, missing, none)
    at_speed = _rms(missing - columns @ met)
    good = bool(np.all(at_speed <= none + ROUNDING * none.max()))
    coefficients = met if good else least
    link = replace(bare, form=coefficients[:3], skin=coefficients[3:])
    straight = parameters.conditions.speed * np.eye(6)[:1]
    resistance = float(law.force(straight)[0, 0])
    ahead = float(link.force(straight)[0, 0]) / resistance if resistance else None
    return ChosenDrags(link, good, none, at_speed, _rms(missing - columns @ least), ahead)


def met_at_speed(parameters: ParameterFile, bare: StonefishLink) -> Array:
    """Form and skin (6,): a drag k v^2 as k/(2U) v^3 + k U/2 v; zero along an axis where the file has none, or one that drives."""
    speed, law, axis = parameters.conditions.speed, second_order(force_law(parameters)), np.arange(3)
    square = np.maximum(-law.absolute[axis, axis, axis], 0.0)
    linear = np.maximum(-law.linear[axis, axis], 0.0)
    form_force, _, skin_force, _ = raw_drag(bare.corners, np.eye(3), np.zeros((3, 3)))
    form = 2.0 * square / (2.0 * speed) / (bare.density * -np.diag(form_force))
    skin = (linear + square * speed / 2.0) / (bare.density * -np.diag(skin_force))
    return np.concatenate([form, skin])


def _least_squares(columns: Array, wanted: Array, scale: Array) -> Array:
    """Coefficients (6,), none negative, to six digits: the seventh differs from one machine to the next."""
    from scipy.optimize import nnls

    used = scale > 0.0
    if not np.any(used):
        return np.zeros(6)
    a, b = columns[:, used] / scale[used, None], wanted[:, used] / scale[used]
    found, _ = nnls(a.reshape(-1, 6), b.ravel())
    return np.array([float(f"{x:.{DIGITS}g}") for x in found])


def _rms(errors: Array) -> Array:
    return np.asarray(np.sqrt(np.mean(errors**2, axis=0)))


summary = "Stonefish: a scenario with drags along the axes of an ellipsoid mesh; no derivatives, no Munk moment"
citations = ("stonefish", "lamb1932")
adds_coriolis = True
holds: frozenset[str] = frozenset()
HELD = 1e-6
_LEFT_OUT = (
    "resistance with the square of the speed: Stonefish has the cube and the first power",
    "the added mass of the file: Stonefish takes one number from the mesh for all directions, and no Munk moment",
)


def _axes(parameters: ParameterFile) -> Array:
    """Semi-axes of the file's added masses, or of its length; of its mass in water, where there is one.

    Raises
    ------
    InputError
        Neither mass nor added masses along x, y and z of some ellipsoid.
    """
    masses, rho = np.diag(water_inertia(parameters).matrix)[:3], parameters.conditions.density
    axes = None
    if np.all(masses > 0.0):
        found, miss = ellipsoid_of_masses(masses, rho)
        axes = found if miss <= HELD else None
    if parameters.mass is None:
        if axes is None:
            raise input_error("formats.no_size_of_mesh")
        return axes
    volume = parameters.mass.mass / rho
    if axes is not None:
        return np.asarray(axes * (volume / (4.0 / 3.0 * np.pi * np.prod(axes))) ** (1.0 / 3.0))
    long = parameters.scaling.length / 2.0
    thick = float(np.sqrt(3.0 * volume / (4.0 * np.pi * long)))
    return np.array([long, thick, thick])


def _fitted(parameters: ParameterFile) -> ChosenDrags:
    """The link with its drags."""
    centre, none = centre_of_gravity(parameters), np.zeros(3)
    vertices, faces = ellipsoid_mesh(_axes(parameters), centre)
    vertices = np.array([[float(f"{x:.12g}") for x in vertex] for vertex in vertices])
    return chosen_drags(parameters, StonefishLink(vertices, faces, centre, none, none, parameters.conditions.density))


def _row(values: Array) -> str:
    return " ".join(number(v) for v in values)


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """A scenario and its mesh; the robot's frame is x forward, y starboard, z down, its origin the reference point.

    Raises
    ------
    InputError
        As `_axes` says, or an inertia that is not positive.
    """
    link, name = _fitted(parameters).link, identifier(parameters.name)
    root = Element("scenario")
    environment = SubElement(root, "environment")
    SubElement(environment, "ned", latitude="0.0", longitude="0.0")
    ocean = SubElement(environment, "ocean")
    SubElement(ocean, "water", density=number(link.density), jerlov="0.2")
    SubElement(ocean, "waves", height="0.0")
    SubElement(SubElement(environment, "atmosphere"), "sun", azimuth="0.0", elevation="45.0")
    SubElement(SubElement(root, "materials"), "material", name="hull", density=number(link.density), restitution="0.5")
    SubElement(SubElement(root, "looks"), "look", name="hull", gray="0.5", roughness="0.5")
    robot = SubElement(root, "robot", name=name, fixed="false", self_collisions="false")
    body = SubElement(robot, "base_link", name="base_link", type="model", physics="submerged", buoyant="true")
    physical = SubElement(body, "physical")
    SubElement(physical, "mesh", filename=f"{name}.obj", scale="1.0")
    SubElement(physical, "origin", xyz="0.0 0.0 0.0", rpy="0.0 0.0 0.0")
    SubElement(body, "material", name="hull")
    SubElement(body, "look", name="hull")
    inertia = central_inertia(parameters)
    if parameters.mass is not None:
        SubElement(body, "mass", value=number(parameters.mass.mass))
    if inertia is not None:
        SubElement(body, "inertia", xyz=_row(np.diag(inertia)))
        SubElement(body, "cg", xyz=_row(link.centre), rpy="0.0 0.0 0.0")
    SubElement(body, "hydrodynamics", viscous_drag=_row(link.skin), quadratic_drag=_row(link.form))
    SubElement(robot, "world_transform", xyz="0.0 0.0 10.0", rpy="0.0 0.0 0.0")
    comment = (
        f"{one_line(parameters.name)}, body: {one_line(parameters.body)}",
        f"Shape by the inertia of the water: {one_line(water_inertia(parameters).source)}",
        *in_header(parameters),
        "Frame of base_link: x forward, y starboard, z down, origin at the reference point. The drags belong to this mesh: another",
        "has other areas, and theirs are to be multiplied by the ratio.",
    )
    mesh = [f"v {_row(v)}" for v in link.vertices] + [f"f {a} {b} {c}" for a, b, c in (link.faces + 1).tolist()]
    return {f"{name}.obj": ("\n".join(mesh) + "\n").encode(), f"{name}.scn": serialised(root, comment)}


def force(files: Mapping[str, bytes], nu: Array) -> Array:
    """Stonefish's own law (`coeflab.formats.stonefish.write`, with its source) of the robot and its mesh; FRD as they are."""
    return _read(files).force(nu)


def added_mass(files: Mapping[str, bytes]) -> Array:
    """What Stonefish computes from the mesh about its centre of gravity, moved to the reference point."""
    link = _read(files)
    mass, moments = added(link.corners, link.density)
    return moved(np.diag([mass, mass, mass, *moments]), -link.centre)


def _read(files: Mapping[str, bytes]) -> StonefishLink:
    root = parse_xml(next(c for n, c in files.items() if n.endswith(".scn")).decode())
    water, body = root.find("environment/ocean/water"), root.find("robot/base_link")
    drags = None if body is None else body.find("hydrodynamics")
    if water is None or body is None or drags is None:
        raise input_error("formats.no_robot")
    rows = [r.split() for r in next(c for n, c in files.items() if n.endswith(".obj")).decode().splitlines()]
    vertices = np.array([r[1:] for r in rows if r[0] == "v"], dtype=np.float64)
    faces = np.array([r[1:] for r in rows if r[0] == "f"], dtype=np.int64) - 1
    centre, cg = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0, body.find("cg")
    if cg is not None:
        centre = np.array(numbers(cg.get("xyz"), (3,), "cg"))
    form, skin = (np.array(numbers(drags.get(n), (3,), n)) for n in ("quadratic_drag", "viscous_drag"))
    return StonefishLink(vertices, faces, centre, form, skin, float(water.get("density", "1000")))


def not_held(parameters: ParameterFile) -> tuple[str, ...]:
    """The form of the resistance; the added mass; every other term, product and control."""
    link, law = _fitted(parameters).link, force_law(parameters)
    straight = held_when_straight(link.force, law, parameters.conditions.speed)
    return (*_LEFT_OUT, *unheld(law, lambda t: t.symbol == "X0" and straight(t), ideal=False))


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass and moments of inertia, where the file has none."""
    return missing_mass(
        parameters, "Stonefish takes those of the mesh, as heavy as the file says or water, until you write yours"
    )


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How mesh and drags were made, in words."""
    drags, speed = _fitted(parameters), parameters.conditions.speed
    link = drags.link
    a, b, c = _axes(parameters)
    mass, _ = added(link.corners, link.density)
    words = [
        f"the mesh is an ellipsoid of semi-axes {a:.4g} {b:.4g} {c:.4g} m about the centre of gravity: the file states no shape",
        "Stonefish's quadratic_drag grows with the cube of the speed and its viscous_drag with the first power (in its source, "
        f"whatever their names): a drag k v^2 as k/(2U) v^3 + k U/2 v meets it in value and slope at U = {speed:g} m/s, and is 25 % above "
        "it at half that speed and 8 % at one and a half times it",
        drags.in_words(),
        f"Stonefish adds {mass:.4g} kg to the mass, alike in all directions, from the mesh; in a turn that mass has its inertia, -m w x v, which the differences in this report include",
        "axes and reference point are the file's",
    ]
    if not np.all(link.form > 0.0):
        none = ", ".join(n for n, k in zip("xyz", link.form, strict=True) if k == 0.0)
        words.append(f"no quadratic drag along {none}: zero is written, not Stonefish's default")
    inertia = central_inertia(parameters)
    if inertia is not None and np.any(inertia - np.diag(np.diag(inertia))):
        words.append("products of inertia are left out: Stonefish takes three moments")
    return tuple(words)
