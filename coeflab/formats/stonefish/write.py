"""Stonefish: a scenario with one robot, its mesh, and the drags along its axes; nothing else of a force law.

The mesh is an ellipsoid, for Stonefish computes drag, buoyancy and added mass from a mesh and the file states none. Its form
drag grows with the cube of the speed and its friction in proportion to it. How they are chosen is said in
`coeflab.formats.stonefish.write` and, with figures, in the loss report.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from coeflab.core.text.xml import numbers, parse_xml, serialised
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import identifier, one_line
from coeflab.formats.exported_law import held_when_straight, number
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import unheld
from coeflab.formats.missing_parts import missing_mass
from coeflab.formats.mujoco.law import ellipsoid_of_masses
from coeflab.formats.stonefish.drags import ChosenDrags, StonefishLink, chosen_drags
from coeflab.formats.stonefish.law import added, ellipsoid_mesh
from coeflab.law.transforms import moved
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.inertia import central_inertia, centre_of_gravity, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile

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
