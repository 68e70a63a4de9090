"""Stonefish: a scenario with one robot, its mesh, and the drags along its axes; nothing else of a force law.

The mesh is an ellipsoid, for Stonefish computes drag, buoyancy and added mass from a mesh and the file states none. Its form
drag grows with the cube of the speed and its friction in proportion to it: together they meet the file's resistance, in value
and slope, at the file's speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.identifiers import identifier, one_line
from coeflab.core.xml import numbers, parse_xml, serialised
from coeflab.kernels.mujoco_fluid import ellipsoid_of_masses
from coeflab.kernels.stonefish_fluid import added, ellipsoid_mesh, raw_drag, weighed
from coeflab.kernels.transforms import force_transfer, velocity_transfer
from coeflab.model.exported_law import central_inertia, centre_of_gravity, number
from coeflab.model.force_law import force_law
from coeflab.model.inertia import added_mass_of
from coeflab.model.loss import unheld
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.second_order import second_order
from coeflab.model.straight_motion import held_when_straight

summary = "Stonefish: a scenario with drags along the axes of an ellipsoid mesh; no derivatives, no Munk moment"
citations = ("stonefish", "lamb1932")
adds_coriolis = True

Array = NDArray[np.float64]
HELD = 1e-6
_LEFT_OUT = (
    "resistance with the square of the speed: Stonefish has the cube and the first power, which meet it at the file's speed",
    "the added mass of the file: Stonefish takes one number from the mesh for all directions, and no Munk moment",
)


@dataclass(frozen=True, slots=True, eq=False)
class _Link:
    """Vertices and faces, m, FRD from the reference point; centre of gravity; coefficients; density."""

    vertices: Array
    faces: NDArray[np.int64]
    centre: Array
    form: Array
    skin: Array
    density: float

    @property
    def corners(self) -> Array:
        return np.asarray(self.vertices[self.faces] - self.centre)

    def force(self, nu: Array) -> Array:
        """(n, 6), FRD, about the reference point: drags, and what the added mass takes up in turning."""
        own = nu @ velocity_transfer(self.centre).T
        v, w = own[:, :3], own[:, 3:]
        form_force, form_torque, skin_force, skin_torque = raw_drag(self.corners, v, w)
        half, whole = 0.5 * self.density * self.form, self.density * self.skin
        mass, moments = added(self.corners, self.density)
        force = weighed(form_force, half) + weighed(skin_force, whole) - np.cross(w, mass * v)
        torque = weighed(form_torque, half) + weighed(skin_torque, whole) - np.cross(w, moments * w)
        return np.asarray(np.hstack([force, torque]) @ force_transfer(-self.centre).T)


def _axes(parameters: ParameterFile) -> Array:
    """Semi-axes of the file's added masses, or of its length; of its mass in water, where there is one.

    Raises
    ------
    InputError
        Neither mass nor added masses along x, y and z of some ellipsoid.
    """
    masses, rho = np.diag(added_mass_of(parameters)[0])[:3], parameters.conditions.density
    axes = None
    if np.all(masses > 0.0):
        found, miss = ellipsoid_of_masses(masses, rho)
        axes = found if miss <= HELD else None
    if parameters.mass is None:
        if axes is None:
            raise InputError(
                "neither mass nor the added masses of an ellipsoid", "one of them, for the size of the mesh"
            )
        return axes
    volume = parameters.mass.mass / rho
    if axes is not None:
        return np.asarray(axes * (volume / (4.0 / 3.0 * np.pi * np.prod(axes))) ** (1.0 / 3.0))
    long = parameters.scaling.length / 2.0
    thick = float(np.sqrt(3.0 * volume / (4.0 * np.pi * long)))
    return np.array([long, thick, thick])


def _fitted(parameters: ParameterFile) -> _Link:
    """The link; where the file has no drag along an axis, or one that drives, that coefficient is zero."""
    rho, speed, centre = parameters.conditions.density, parameters.conditions.speed, centre_of_gravity(parameters)
    vertices, faces = ellipsoid_mesh(_axes(parameters), centre)
    vertices = np.array([[float(f"{x:.12g}") for x in vertex] for vertex in vertices])
    law, axis = second_order(force_law(parameters)), np.arange(3)
    square, linear = -law.absolute[axis, axis, axis], -law.linear[axis, axis]
    square, linear = np.maximum(square, 0.0), np.maximum(linear, 0.0)
    form_force, _, skin_force, _ = raw_drag(vertices[faces] - centre, np.eye(3), np.zeros((3, 3)))
    fronts, sides = -np.diag(form_force), -np.diag(skin_force)
    form = 2.0 * square / (2.0 * speed) / (rho * fronts)
    skin = (linear + square * speed / 2.0) / (rho * sides)
    return _Link(vertices, faces, centre, form, skin, rho)


def _row(values: Array) -> str:
    return " ".join(number(v) for v in values)


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """A scenario and its mesh; the robot's frame is x forward, y starboard, z down, its origin the reference point.

    Raises
    ------
    InputError
        As `_axes` says, or an inertia that is not positive.
    """
    link, name = _fitted(parameters), identifier(parameters.name)
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
        "Frame of base_link: x forward, y starboard, z down, origin at the reference point. The drags belong to this mesh: another",
        "has other areas, and theirs are to be multiplied by the ratio.",
    )
    mesh = [f"v {_row(v)}" for v in link.vertices] + [f"f {a} {b} {c}" for a, b, c in (link.faces + 1).tolist()]
    return {f"{name}.obj": ("\n".join(mesh) + "\n").encode(), f"{name}.scn": serialised(root, comment)}


def force(files: Mapping[str, bytes], nu: Array) -> Array:
    """Stonefish's own law (`coeflab.kernels.stonefish_fluid`, with its source) of the robot and its mesh; FRD as they are."""
    root = parse_xml(next(c for n, c in files.items() if n.endswith(".scn")).decode())
    water, body = root.find("environment/ocean/water"), root.find("robot/base_link")
    drags = None if body is None else body.find("hydrodynamics")
    if water is None or body is None or drags is None:
        raise InputError("no robot", "a robot with <hydrodynamics> in an ocean")
    rows = [r.split() for r in next(c for n, c in files.items() if n.endswith(".obj")).decode().splitlines()]
    vertices = np.array([r[1:] for r in rows if r[0] == "v"], dtype=np.float64)
    faces = np.array([r[1:] for r in rows if r[0] == "f"], dtype=np.int64) - 1
    centre, cg = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0, body.find("cg")
    if cg is not None:
        centre = np.array(numbers(cg.get("xyz"), (3,), "cg"))
    form, skin = (np.array(numbers(drags.get(n), (3,), n)) for n in ("quadratic_drag", "viscous_drag"))
    return _Link(vertices, faces, centre, form, skin, float(water.get("density", "1000"))).force(nu)


def not_held(parameters: ParameterFile) -> tuple[str, ...]:
    """The form of the resistance; the added mass; every other term, product and control."""
    link, law = _fitted(parameters), force_law(parameters)
    straight = held_when_straight(link.force, parameters.conditions.speed)
    return (*_LEFT_OUT, *unheld(law, lambda t: t.symbol == "X0" and straight(t), ideal=False))


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How mesh and drags were made, in words."""
    link, speed = _fitted(parameters), parameters.conditions.speed
    a, b, c = _axes(parameters)
    mass, _ = added(link.corners, link.density)
    said = [
        f"the mesh is an ellipsoid of semi-axes {a:.4g} {b:.4g} {c:.4g} m about the centre of gravity: the file states no shape",
        "Stonefish's quadratic_drag grows with the cube of the speed and its viscous_drag with the first power (in its source, "
        f"whatever their names): a drag k v^2 is written as k/(2U) v^3 + k U/2 v, which meets it in value and slope at U = {speed:g} m/s",
        f"Stonefish adds {mass:.4g} kg to the mass, alike in all directions, from the mesh; in a turn that mass has its inertia, -m w x v, which the differences in this report hold",
        "axes and reference point are the file's",
    ]
    if not np.all(link.form > 0.0):
        none = ", ".join(n for n, k in zip("xyz", link.form, strict=True) if k == 0.0)
        said.append(f"no quadratic drag along {none} in the file: zero is written, not Stonefish's default")
    inertia = central_inertia(parameters)
    if parameters.mass is None:
        said.append(
            "no mass in the parameter file: that of the mesh filled with water stands until you write the vehicle's"
        )
    elif inertia is None:
        said.append("no moment of inertia in the parameter file: Stonefish takes that of the mesh, scaled to the mass")
    elif parameters.mass.inertia_matrix is None:
        said.append(
            "roll inertia is not in the parameter file: the transverse one stands in its place; write the vehicle's"
        )
    elif np.any(inertia - np.diag(np.diag(inertia))):
        said.append("products of inertia are left out: Stonefish takes three moments")
    return tuple(said)
