"""uuv_simulator and DAVE (classic Gazebo): a URDF whose link has a hydrodynamic model of type fossen.

The plugin adds C_A(nu) of <added_mass> itself. It has one full matrix of products with u, <linear_damping_forward_speed>, which
takes what is left of every first-order derivative; quadratic damping is used on its diagonal only. Its force acts at the centre
of gravity, so the link's origin is put there, and the reference point is a second link fixed to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from coeflab.core.axes import FLU
from coeflab.core.text.xml import parse_xml, serialised
from coeflab.core.types import Array
from coeflab.core.wording import identifier, one_line
from coeflab.formats.exported_law import ExportedLaw, common_changes, exported_law, number
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import unheld
from coeflab.formats.missing_parts import missing_mass, missing_water
from coeflab.formats.uuv_simulator.law import MATRICES, read_fossen_link
from coeflab.law.force_law import ForceTerm
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import COMPONENTS
from coeflab.law.transforms import derivative_transfer, force_transfer, moved, velocity_transfer
from coeflab.vehicle.inertia import central_inertia, centre_of_gravity, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import ROUNDING, SURGE, products_once, slot

summary = "uuv_simulator and DAVE: URDF with hydrodynamic_model fossen, viscous parts beside its added mass"
citations = ("fossen2011", "uuv_simulator")
adds_coriolis = True
holds = frozenset({"hydrostatics"})
LINK = "base_link"
PLUGIN = {"name": "uuv_plugin", "filename": "libuuv_underwater_object_ros_plugin.so"}


def _matrices(law: ExportedLaw, shift: Array) -> dict[str, Array]:
    """The model's matrices about a point ``shift`` (3,) away from the reference point.

    There the old u is the new one plus rates: of products with it those with the new u are kept.
    """
    left, right = derivative_transfer(shift)
    form = law.form
    products = form.signed[:, SURGE, :].copy()
    products[:, 1:] += form.absolute[:, 1:, SURGE]
    total = left @ products @ right
    total[:, 1:] += np.outer(left @ products[:, SURGE], right[SURGE, 1:])
    mass = moved(law.matrix, shift)
    own = products_once(ideal_quadratics(mass))[:, SURGE, :]
    viscous = total - own
    viscous[np.abs(viscous) <= ROUNDING * np.maximum(np.abs(total), np.abs(own))] = 0.0
    quadratic = np.diag([form.absolute[i, i, i] for i in range(6)])
    return dict(zip(MATRICES, (mass, left @ form.linear @ right, viscous, quadratic), strict=True))


def _held(term: ForceTerm) -> bool:
    match slot(term):
        case "linear", _, _:
            return True
        case "signed", j, _:
            return j == SURGE
        case "absolute", j, k:
            return (k == SURGE and j != SURGE) or j == k == COMPONENTS.index(term.component)
    return False


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One URDF, its link's origin at the centre of gravity."""
    p, at = parameters, centre_of_gravity(parameters)
    robot = Element("robot", name=identifier(p.name))
    link = SubElement(robot, "link", name=LINK)
    central = central_inertia(p)
    if p.mass is not None:
        inertial = SubElement(link, "inertial")
        SubElement(inertial, "origin", xyz="0 0 0")
        SubElement(inertial, "mass", value=number(p.mass.mass))
        if central is not None:
            turned = central * np.outer(FLU[:3], FLU[:3])
            axes = {f"i{'xyz'[i]}{'xyz'[j]}": number(turned[i, j]) for i in range(3) for j in range(i, 3)}
            SubElement(inertial, "inertia", axes)
    SubElement(robot, "link", name="reference_point")
    joint = SubElement(robot, "joint", name="reference_point_joint", type="fixed")
    SubElement(joint, "parent", link=LINK)
    SubElement(joint, "child", link="reference_point")
    SubElement(joint, "origin", xyz=" ".join(map(number, -FLU[:3] * at)))
    plugin = SubElement(SubElement(robot, "gazebo"), "plugin", PLUGIN)
    SubElement(plugin, "fluid_density").text = number(p.conditions.density)
    SubElement(plugin, "flow_velocity_topic").text = "hydrodynamics/current_velocity"
    under = SubElement(plugin, "link", name=LINK)
    h = p.hydrostatics
    SubElement(under, "neutrally_buoyant").text = "1" if h is None else "0"
    if h is not None:
        SubElement(under, "volume").text = number(h.volume)
    above = np.zeros(3) if h is None else FLU[:3] * (np.array(h.centre_of_buoyancy) - at)
    SubElement(under, "center_of_buoyancy").text = "0 0 0" if h is None else " ".join(map(number, above))
    model = SubElement(under, "hydrodynamic_model")
    SubElement(model, "type").text = "fossen"
    for tag, matrix in _matrices(exported_law(p), at).items():
        SubElement(model, tag).text = "\n" + "\n".join(" ".join(map(number, row)) for row in matrix) + "\n"
    comment = (
        f"{one_line(p.name)}, body: {one_line(p.body)}",
        "The plugin turns Gazebo's x forward, y port, z up to x forward, y starboard, z down itself: the matrices are in the latter,",
        "about the centre of gravity, which is the origin of base_link. Damping is negative, added mass positive.",
        f"Inertia of the water: {one_line(water_inertia(p).source)}",
        *in_header(p),
        "Neutrally buoyant with both centres in one point: the parameter file states neither weight nor buoyancy."
        if h is None
        else "Volume and centre of buoyancy, the latter x forward, y port, z up from the centre of gravity, are the file's.",
    )
    return {f"{identifier(p.name)}.urdf": serialised(robot, comment)}


def force(files: Mapping[str, bytes], nu: Array) -> Array:
    """The plugin's own law (`coeflab.formats.uuv_simulator.law`, with file and lines of its source), moved to the reference point."""
    (content,) = files.values()
    link = read_fossen_link(parse_xml(content.decode()))
    at_link = nu @ velocity_transfer(-link.reference).T
    return np.asarray(link.force(at_link) @ force_transfer(link.reference).T)


def added_mass(files: Mapping[str, bytes]) -> Array:
    """<added_mass>, moved to the reference point."""
    (content,) = files.values()
    link = read_fossen_link(parse_xml(content.decode()))
    return moved(link.added_mass, link.reference)


def not_held(parameters: ParameterFile) -> tuple[str, ...]:
    """Products without u but the own ones of quadratic damping, terms of other orders, and controls."""
    return unheld(exported_law(parameters).law, _held, ideal=True)


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass, moments of inertia and added mass, where the file has none."""
    dropped = "Gazebo leaves out a link without them until you write the vehicle's"
    return (*missing_mass(parameters, dropped), *missing_water(parameters))


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """What was changed, in words."""
    law, at = exported_law(parameters), centre_of_gravity(parameters)
    out = [
        "axes: none, the plugin itself turns Gazebo's x forward, y port, z up to x forward, y starboard, z down",
        "no added mass is known: totals are written and <added_mass> is zero"
        if law.inert
        else f"the plugin adds -C_A(nu) nu of <added_mass> ({law.statements[0]}): <linear_damping_forward_speed> has the viscous "
        "part of every product with u, total less what the plugin adds, so that nothing counts twice",
    ]
    if parameters.added_mass is None and not law.inert:
        out.append(
            "products without u, such as Xvr, that the plugin adds from <added_mass> are none of the parameter file's"
        )
    if np.any(at):
        out.append(
            f"moved to the centre of gravity, ({at[0]:.6g}, {at[1]:.6g}, {at[2]:.6g}) m from the reference point, where the "
            "plugin's force acts; quadratic damping keeps its numbers"
        )
    h = parameters.hydrostatics
    out.append(
        "neutrally buoyant, centre of buoyancy in the centre of gravity: the parameter file states neither"
        if h is None
        else f"buoyancy by <volume> {h.volume:g} m^3 and <center_of_buoyancy>, x forward, y port, z up from the centre of gravity; "
        f"gravity is the world's, the file's is {h.gravity:g} m/s^2"
    )
    return (*out, *common_changes(parameters, law, whole=False))
