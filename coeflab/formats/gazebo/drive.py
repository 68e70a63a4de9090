"""What drives and steers a written gz-sim model: fin links with joints and a LiftDrag each, propellers with the Thruster system.

A fin's LiftDrag acts on the hull, with <cla> and <cda> zero and <control_joint_rad_to_cl>, so that its force goes with the angle of its
joint alone: its lift in drift is in the hull's law already. Force c q A delta across the stream at <cp>: c A = |Ydr'| L^2, at
x = L Ndr'/Ydr', z = -L Kdr'/Ydr'; of planes x = -L Mds'/Zds', y = L Kds'/Zds'. Nothing astern, as LiftDrag has it.
A propeller's Thruster takes newtons, between what the file's curve gives at its ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Comment, Element, SubElement

import numpy as np

from coeflab.core.axes import FLU
from coeflab.core.types import Array
from coeflab.core.wording import identifier, one_line
from coeflab.formats.exported_law import number
from coeflab.formats.gazebo.assembly import HERE, LINK, STAND_IN, assembly
from coeflab.formats.gazebo.lift_drag import at_hull, read_lift_drag
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterSurface

SMALL_MASS, SMALL_INERTIA = 1e-3, 1e-6  # kg, kg m^2: SDFormat wants some
LIMIT = 0.6  # rad, of a control whose limit the file does not state
# Control: force and moments by it, which of x y z the levers are, hinge and lift in the link's frame.
FINS = {
    "dr": ("Y", "N", 1.0, "z", -1.0, (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    "ds": ("Z", "M", -1.0, "y", 1.0, (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "db": ("Z", "M", -1.0, "y", 1.0, (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
}
LIFT_DRAG = {"filename": "gz-sim-lift-drag-system", "name": "gz::sim::systems::LiftDrag"}
CONTROLLER = {
    "filename": "gz-sim-joint-position-controller-system",
    "name": "gz::sim::systems::JointPositionController",
}
THRUSTER = {"filename": "gz-sim-thruster-system", "name": "gz::sim::systems::Thruster"}


def _value(parameters: ParameterFile, symbol: str) -> float:
    c = parameters.coefficient(symbol)
    return 0.0 if c is None or c.value is None else c.value


def driven_fins(parameters: ParameterFile) -> dict[str, tuple[float, Array]]:
    """By control: c A with the sign that a positive angle gives the lift, m^2, and where it acts, m, FRD.

    A control without a force across, with a moment alone, has none.
    """
    out, length = {}, parameters.scaling.length
    for control, (force, moment, sense, across, side, _, _) in FINS.items():
        push, turn, roll = (_value(parameters, f"{c}{control}") for c in (force, moment, "K"))
        if not push:
            continue
        place = np.array([sense * turn / push * length, 0.0, 0.0])
        place["xyz".index(across)] = side * roll / push * length
        out[control] = (-push * length**2, place + 0.0)
    return out


def drive(model: Element, parameters: ParameterFile, hull: str, length: float, radius: float) -> None:
    """Add links, joints and systems of fins and thrusters to a model.

    Parameters
    ----------
    model : Element
        Its <model>, with the hull's link.
    parameters : ParameterFile
    hull : str
    length, radius : float
        Of the displaced volume, m, for what is seen.
    """
    limits: dict[str, ParameterSurface] = {s.control: s for s in parameters.surfaces}
    for words in control_signs(parameters):
        model.append(Comment(f" {words} "))
    for control, (area, place) in driven_fins(parameters).items():
        _, _, _, _, _, hinge, upward = FINS[control]
        surface = limits.get(control)
        size = (
            (0.06 * length, 0.01 * length, 2.0 * radius)
            if control == "dr"
            else (0.06 * length, 2.0 * radius, 0.01 * length)
        )
        _part(model, f"{STAND_IN}{control}", place, size)
        joint = _joint(model, control, hull, f"{STAND_IN}{control}", np.array(hinge))
        limit = SubElement(joint, "limit")
        most = LIMIT if surface is None else surface.limit
        _filled(limit, lower=number(-most), upper=number(most), effort="1000")
        if surface is not None and surface.rate is not None:
            SubElement(limit, "velocity").text = number(surface.rate)
        lift = SubElement(model, "plugin", LIFT_DRAG)
        _filled(
            lift, link_name=hull, control_joint_name=control, air_density=number(parameters.conditions.density), area=number(abs(area)),
            control_joint_rad_to_cl=number(np.sign(area)), cla="0", cda="0", cma="0", cla_stall="0", cda_stall="0", cma_stall="0",
            forward="1 0 0", upward=" ".join(map(number, upward)), cp=" ".join(map(number, place * FLU[:3] + 0.0)),
        )  # fmt: skip
        controller = SubElement(model, "plugin", CONTROLLER)
        _filled(controller, joint_name=control, sub_topic=f"joint/{control}", use_velocity_commands="true")
        if surface is not None and surface.rate is not None:
            SubElement(controller, "cmd_max").text = number(surface.rate)
    for name, k in named(parameters).items():
        t = parameters.thrusters[k]
        _part(model, f"{STAND_IN}{name}", np.array(t.position), (0.02 * length, radius, radius))
        joint = _joint(model, name, hull, f"{STAND_IN}{name}", np.array(t.direction) * FLU[:3] + 0.0)
        limit = SubElement(joint, "limit")
        _filled(limit, lower="-1e16", upper="1e16")
        system = SubElement(model, "plugin", THRUSTER)
        _filled(
            system, joint_name=name, topic=name, velocity_control="true", thrust_coefficient="0.1",
            propeller_diameter=number(max(2.0 * radius, 1e-3)), fluid_density=number(parameters.conditions.density),
            max_thrust_cmd=number(t.curve.at(t.curve.high)), min_thrust_cmd=number(t.curve.at(t.curve.low)),
        )  # fmt: skip


def _filled(parent: Element, **texts: str) -> None:
    """Add an element for each text, in their order."""
    for tag, text in texts.items():
        SubElement(parent, tag).text = text


def named(parameters: ParameterFile) -> dict[str, int]:
    """Thrusters by names that are joints and topics: letters, digits and _, none twice, none a control's."""
    out: dict[str, int] = {}
    for k, t in enumerate(parameters.thrusters):
        name = identifier(t.name) or f"thruster_{k + 1}"
        while name in out or name in FINS or name == LINK or name.startswith(STAND_IN):
            name = f"thruster_{name}_{k + 1}"
        out[name] = k
    return out


def _part(model: Element, name: str, place: Array, size: tuple[float, float, float]) -> None:
    link = SubElement(model, "link", name=name)
    SubElement(link, "pose").text = " ".join(map(number, place * FLU[:3] + 0.0)) + " 0 0 0"
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "mass").text = number(SMALL_MASS)
    inertia = SubElement(inertial, "inertia")
    for axis in ("ixx", "iyy", "izz"):
        SubElement(inertia, axis).text = number(SMALL_INERTIA)
    geometry = SubElement(SubElement(link, "visual", name="seen"), "geometry")
    SubElement(SubElement(geometry, "box"), "size").text = " ".join(map(number, size))


def _joint(model: Element, name: str, parent: str, child: str, axis: Array) -> Element:
    joint = SubElement(model, "joint", name=name, type="revolute")
    SubElement(joint, "parent").text = parent
    SubElement(joint, "child").text = child
    found = SubElement(joint, "axis")
    SubElement(found, "xyz").text = " ".join(map(number, axis))
    return found


def driven_force(
    root: Element, hull: str, nu: Array, angles: Mapping[str, float | Array], thrusts: Mapping[str, float]
) -> Array:
    """Force and moment (n, 6) of the written fins and propellers about the hull's origin, FRD, by the sources of gz-sim.

    Parameters
    ----------
    root : Element
        Of the file.
    hull : str
    nu : (n, 6) array
        FRD.
    angles : mapping of joint to float or (n,) array
        rad.
    thrusts : mapping of joint to N
        As commanded: limited as Thruster.cc limits it.
    """
    found = assembly(root, hull)
    out = np.zeros(nu.shape)
    for plugin in root.iter("plugin"):
        if plugin.get("name") == LIFT_DRAG["name"]:
            foil = read_lift_drag(plugin)
            out += at_hull(foil, HERE, None, nu * FLU, angles.get(foil.joint, 0.0)) * FLU
        elif plugin.get("name") == THRUSTER["name"]:
            joint = next(j for j in found.joints if j.name == plugin.findtext("joint_name"))
            low, high = (float(plugin.findtext(t) or "nan") for t in ("min_thrust_cmd", "max_thrust_cmd"))
            force = min(max(thrusts.get(joint.name, 0.0), low), high) * joint.axis
            out += np.concatenate([force, np.cross(joint.place, force)]) * FLU
    return out


def fin_symbols(parameters: ParameterFile) -> frozenset[str]:
    """Derivatives by controls that the fins stand for, without prime."""
    return frozenset(f"{c}{k}" for k in driven_fins(parameters) for c in (FINS[k][0], FINS[k][1], "K"))


def not_driven(parameters: ParameterFile) -> tuple[str, ...]:
    """What of thrusters the Thruster system has no place for."""
    out = []
    for t in parameters.thrusters:
        dropped = [] if t.curve.unit == "N" and len(t.curve.segments) == 1 else ["its curve over the command"]
        dropped += ["its reaction torque"] if t.torque_curve is not None else []
        dropped += ["its tilt"] if t.tilt_axis is not None else []
        out += [f"thruster {one_line(t.name)}: {', '.join(dropped)}; it takes newtons"] if dropped else []
    return tuple(out)


def in_words(parameters: ParameterFile) -> tuple[str, ...]:
    """What drives the model, what of it is not the file's, and how to command it."""
    fins, thrusters = driven_fins(parameters), named(parameters)
    out = []
    if fins:
        places = "; ".join(f"{c} c A {abs(a):.4g} m^2 at x {x[0]:+.4g} m" for c, (a, x) in fins.items())
        out.append(
            f"fins: {places}. Joint, LiftDrag and JointPositionController each; forces by the angle alone, across the stream, none astern; "
            f"command: gz topic -t /model/NAME/joint/CONTROL -m gz.msgs.Double -p 'data: 0.1', CONTROL: {', '.join(fins)}"
        )
        other = [
            c.symbol for c in parameters.coefficients
            if c.value and any(k in c.symbol for k in FINS) and c.symbol.removesuffix("'") not in fin_symbols(parameters)
        ]  # fmt: skip
        out += [f"not in the fins: {', '.join(other)}"] if other else []
        free = [c for c in fins if c not in {s.control for s in parameters.surfaces}]
        out += [f"limit of {', '.join(free)}: the file states none; {LIMIT:g} rad is written"] if free else []
    if thrusters:
        names = ", ".join(f"{n} ({one_line(parameters.thrusters[k].name)})" for n, k in thrusters.items())
        out.append(
            f"thrusters: {names}; Thruster takes newtons, from {', '.join(f'{parameters.thrusters[k].curve.at(parameters.thrusters[k].curve.low):.4g} to {parameters.thrusters[k].curve.at(parameters.thrusters[k].curve.high):.4g} N' for k in thrusters.values())}: "
            "the curve over the command, its dead zone and the reaction torque are not in it"
        )
        tilting = [n for n, k in thrusters.items() if parameters.thrusters[k].tilt_axis is not None]
        out += [f"fixed at no tilt: {', '.join(tilting)}"] if tilting else []
    if fins or thrusters:
        out.append(
            f"links {STAND_IN}... weigh {SMALL_MASS:g} kg each, which is none of the vehicle's, and are seen as boxes"
        )
    return tuple(out)
