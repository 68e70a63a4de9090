"""An SDF model of one link under gz-sim's Hydrodynamics system, and a world with Buoyancy, written from a parameter file.

Weight and buoyancy are those of gz-sim: Buoyancy.cc (commit 93bbf3e) pushes with density times volume of the collisions times
gravity in the mean of their places; gz-physics (commit a43f638, dartsim SimulationFeatures.cc, lines 98-112) applies mass times gravity
to a link with <fluid_added_mass> whatever <gravity> of the link says.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from coeflab.core.axes import FLU
from coeflab.core.text.xml import parse_xml, sayable, serialised
from coeflab.core.types import Array
from coeflab.core.wording import identifier, one_line
from coeflab.formats.exported_law import Afloat, afloat, exported_law, number
from coeflab.formats.gazebo.assembly import LINK
from coeflab.formats.gazebo.drive import drive, driven_force, fin_symbols, in_words, not_driven
from coeflab.formats.gazebo.law import DENSITY, FLUID_TAGS, FORCES, LENGTH, RESISTANCE, SYSTEM, VELOCITIES, read_gz_link
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import unheld
from coeflab.formats.missing_parts import missing_mass, missing_water
from coeflab.law.symbols import CONTROLS
from coeflab.vehicle.inertia import central_inertia, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import SecondOrder, slot

INERTIA = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
AXES = "axes: FRD to the link frame x forward, y port, z up; Y Z M N v w q r change sign, factors between bars do not"
DEFAULT_MASS = 1.0  # kg, of SDFormat
ELLIPSOID = "The visual is an ellipsoid of that volume, no mesh of the body."
SYSTEMS = {
    "Physics": "physics",
    "UserCommands": "user-commands",
    "SceneBroadcaster": "scene-broadcaster",
    "Buoyancy": "buoyancy",
}


def sdf(
    parameters: ParameterFile, version: str, plugin: list[tuple[str, str]], fluid: Array | None
) -> Mapping[str, bytes]:
    """A model whose link has its origin at the reference point, and a world of water that it floats in.

    Gravity acts on the link: gz-physics takes <gravity> false for links without <fluid_added_mass> alone. The collision displaces
    the file's volume in the centre of buoyancy, from which the world's Buoyancy system computes its force.

    Parameters
    ----------
    parameters : ParameterFile
    version : str
        Of SDFormat.
    plugin : list of (tag, text)
        Of the Hydrodynamics system.
    fluid : (6, 6) array or None
        FLU, positive.
    """
    p, name, at = parameters, identifier(parameters.name), afloat(parameters, DEFAULT_MASS)
    alone, watered = Element("sdf", version=version), Element("sdf", version=version)
    world = SubElement(watered, "world", name="water")
    SubElement(world, "gravity").text = f"0 0 {number(-at.gravity)}"
    physics = SubElement(world, "physics", name="steps", type="dart", default="true")
    SubElement(physics, "max_step_size").text = "0.001"
    SubElement(physics, "real_time_factor").text = "1"
    systems = {s: SubElement(world, "plugin", _system(s)) for s in SYSTEMS}
    SubElement(systems["Buoyancy"], "uniform_fluid_density").text = number(p.conditions.density)
    light = SubElement(world, "light", name="sun", type="directional")
    SubElement(light, "pose").text = "0 0 10 0 0 0"
    SubElement(light, "direction").text = "-0.5 0.1 -0.9"
    for parent in (alone, world):
        model = SubElement(parent, "model", name=name)
        link = SubElement(model, "link", name=LINK)
        _inertial(link, p, at, fluid)
        _displacing(link, at)
        _seen(link, at)
        system = SubElement(model, "plugin", SYSTEM)
        SubElement(system, "link_name").text = LINK
        for tag, text in plugin:
            SubElement(system, tag).text = text
        SubElement(system, DENSITY).text = number(p.conditions.density)
        length = SubElement(system, LENGTH, name=sayable(one_line(p.scaling.length_name)))
        length.text = number(p.scaling.length)
        drive(model, p, LINK, at.length, at.radius)
    frame = f"Link frame: x forward, y port, z up, origin at the reference point; density {number(p.conditions.density)} kg/m^3"
    shape = (
        "The collision is a cylinder of the displaced volume in the centre of buoyancy: Buoyancy takes these two of it. "
        + ELLIPSOID
    )
    inertia = f"Inertia of the water: {one_line(water_inertia(p).source)}"
    titled = f"{one_line(p.name)}, body: {one_line(p.body)}"
    water = "world" if name != "world" else "world_of_water"
    return {
        f"{name}.sdf": serialised(
            alone,
            (
                titled,
                frame,
                inertia,
                f"It needs a world with the system Buoyancy, as {water}.sdf is, and sinks without.",
                shape,
                *in_header(p),
            ),
        ),
        f"{water}.sdf": serialised(
            watered,
            (
                titled,
                f"A world of water without surface or bottom: gz sim -r {water}.sdf. Not run in Gazebo by coeflab. The model is that of {name}.sdf.",
                frame,
                inertia,
                *in_header(p),
            ),
        ),
    }


def _system(name: str) -> dict[str, str]:
    return {"filename": f"gz-sim-{SYSTEMS[name]}-system", "name": f"gz::sim::systems::{name}"}


def _inertial(link: Element, parameters: ParameterFile, at: Afloat, fluid: Array | None) -> None:
    massive = parameters.mass is not None or parameters.hydrostatics is not None
    if not massive and fluid is None:
        return
    inertial = SubElement(link, "inertial")
    if massive:
        SubElement(inertial, "pose").text = f"{_turned(at.centre)} 0 0 0"
        SubElement(inertial, "mass").text = number(at.mass)
        central = central_inertia(parameters)
        if central is not None:
            inertia = SubElement(inertial, "inertia")
            turned = central * np.outer(FLU[:3], FLU[:3])
            for i, j in INERTIA:
                SubElement(inertia, f"i{'xyz'[i]}{'xyz'[j]}").text = number(turned[i, j])
    if fluid is not None:
        element = SubElement(inertial, "fluid_added_mass")
        for (i, j), tag in FLUID_TAGS.items():
            SubElement(element, tag).text = number(fluid[i, j])


def _displacing(link: Element, at: Afloat) -> None:
    collision = SubElement(link, "collision", name="displaced_volume")
    SubElement(collision, "pose").text = f"{_turned(at.centre_of_buoyancy)} 0 {number(np.pi / 2.0)} 0"
    cylinder = SubElement(SubElement(collision, "geometry"), "cylinder")
    SubElement(cylinder, "radius").text = number(at.radius)
    SubElement(cylinder, "length").text = number(at.length)


def _seen(link: Element, at: Afloat) -> None:
    """An ellipsoid of the displaced volume and length in its centre."""
    visual = SubElement(link, "visual", name="hull")
    SubElement(visual, "pose").text = f"{_turned(at.centre_of_buoyancy)} 0 0 0"
    half = at.length / 2.0
    across = float(np.sqrt(3.0 * at.volume / (4.0 * np.pi * half)))
    SubElement(SubElement(SubElement(visual, "geometry"), "ellipsoid"), "radii").text = " ".join(
        map(number, (half, across, across))
    )


def _turned(vector: Array) -> str:
    return " ".join(map(number, FLU[:3] * vector))


def tags(form: SecondOrder) -> list[tuple[str, str]]:
    """Tags of the plugin for a form in FRD, without zeros; the last says what its reader is to take for X0."""
    turned = form.turned(FLU)
    out = []
    for i, j in np.argwhere(turned.linear):
        out.append((FORCES[i] + VELOCITIES[j], number(turned.linear[i, j])))
    for i, j, k in np.argwhere(turned.absolute):
        out.append((f"{FORCES[i]}{VELOCITIES[j]}abs{VELOCITIES[k]}", number(turned.absolute[i, j, k])))
    for i, j, k in np.argwhere(turned.signed):
        out.append((FORCES[i] + VELOCITIES[j] + VELOCITIES[k], number(turned.signed[i, j, k])))
    if form.resistance:
        out.append((RESISTANCE, number(form.resistance)))
    return out


def placed(parameters: ParameterFile) -> tuple[str, ...]:
    """Where the link's origin, its centre of gravity and its displaced volume are, in words."""
    at = afloat(parameters, DEFAULT_MASS)
    moved = (f"centre of gravity at {_spaced(at.centre)} m, in <inertial><pose>",) if np.any(at.centre) else ()
    return (
        AXES,
        "the link's origin is the reference point",
        *moved,
        f"weight and buoyancy at {at.gravity:g} m/s^2: {at.note}",
        f"the collision, a cylinder {at.length:.4g} m long of radius {at.radius:.4g} m, is that volume in its centre, at {_spaced(at.centre_of_buoyancy)} m; the system Buoyancy of the world gives its force, and in a world without that system the model sinks",
    )


def fins(parameters: ParameterFile) -> tuple[str, ...]:
    """Fins and thrusters of the model, in words."""
    return in_words(parameters)


def _spaced(vector: Array) -> str:
    return " ".join(f"{v:.6g}" for v in FLU[:3] * vector + 0.0)


def sdf_force(files: Mapping[str, bytes], nu: Array) -> Array:
    """The system's own law (`coeflab.formats.gazebo.law`, with file and lines of its source) of a rendered model, turned to FRD."""
    return np.asarray(read_gz_link(parse_xml(next(iter(files.values())).decode())).force(nu * FLU) * FLU)


def sdf_steered_force(files: Mapping[str, bytes], nu: Array, controls: Array) -> Array:
    """The same with the fins at angles dr ds db (n, 3)."""
    root = parse_xml(next(iter(files.values())).decode())
    fins_alone = driven_force(root, LINK, nu, dict(zip(CONTROLS, controls.T, strict=True)), {})
    return np.asarray(sdf_force(files, nu) + fins_alone)


def sdf_added_mass(files: Mapping[str, bytes]) -> Array:
    """(6, 6) of <fluid_added_mass>, or of <xDotU> ... where the plugin uses them, turned to FRD."""
    link = read_gz_link(parse_xml(next(iter(files.values())).decode()))
    plugin = 0.0 if link.disable_added_mass else -link.plugin_mass
    return np.asarray((link.fluid_mass + plugin) * np.outer(FLU, FLU))


def not_in_sdf(parameters: ParameterFile) -> tuple[str, ...]:
    """Terms that are no product of one or two velocities, controls that no fin has, and what Thruster has no place for."""
    steered = fin_symbols(parameters)
    terms = unheld(
        exported_law(parameters).law, lambda t: slot(t) is not None or t.symbol in steered, ideal=True, driven=steered
    )
    return (*terms, *not_driven(parameters))


def missing_in_sdf(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass, moments of inertia and added mass, where the file has none."""
    default = "SDFormat's default, 1 kg or 1 kg m^2, stands until you write the vehicle's"
    if parameters.mass is None and parameters.hydrostatics is not None:
        default = (
            "the mass of the displaced water and SDFormat's default, 1 kg m^2, stand until you write the vehicle's"
        )
    return (*missing_mass(parameters, default), *missing_water(parameters))
