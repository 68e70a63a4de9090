"""URDF and xacro models for uuv_simulator and DAVE: the hydrodynamic model "fossen"."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import XML_BYTES
from coeflab.core.table import Check
from coeflab.core.text.toml import read_text
from coeflab.core.text.xml import numbers, once, read_xml
from coeflab.core.wording import one_line
from coeflab.formats.gazebo.assembly import assembly
from coeflab.formats.left_out import left_out, other_masses, other_plugins, unread_tags
from coeflab.formats.link_file import LinkModel, link_file
from coeflab.formats.uuv_simulator.fins import fins_of
from coeflab.formats.uuv_simulator.law import FRD, MATRICES, PLUGIN_DENSITY, FossenLink, read_fossen_link
from coeflab.formats.uuv_simulator.thrusters import Driven, plain, thrusters_of
from coeflab.formats.uuv_simulator.xacro import SPACE, Xacro, unfolded
from coeflab.law.rigid_body import ideal_quadratics, momentum_quadratics
from coeflab.vehicle.imported_numbers import Written, displaced, gravity, munk_twice, no_mass, water
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics
from coeflab.vehicle.second_order import SURGE, SecondOrder

summary = "uuv_simulator and DAVE: URDF or xacro with hydrodynamic_model fossen"
citations = ("fossen2011", "uuv_simulator")
reads = "uuv_simulator URDF or xacro"
signs = "uuv_simulator takes <added_mass> positive, every damping matrix negative."

GRAVITIES = ("g", "gravity")


def recognises(path: Path) -> bool:
    """Whether the file is XML with a <hydrodynamic_model>."""
    text = read_text(path, XML_BYTES)
    return text.lstrip().startswith("<") and "hydrodynamic_model" in text


def read(
    path: Path, density: float | None = None, length: float | None = None, speed: float | None = None
) -> ParameterFile:
    """Read a URDF, or a xacro file whose properties it defines itself.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, where the file states none; else the plugin's own 1028 kg/m^3.
    length, speed : float, optional
        Of the primes, m and m/s; else the length of <box>, or 1 m, and 1 m/s, which the file says. Forces do not depend on
        them.

    Raises
    ------
    InputError
        No file with one hydrodynamic model of type fossen.
    """
    root = read_xml(path)
    link = read_fossen_link(root, path)
    for model in root.iter("hydrodynamic_model"):
        once(model, path)
    notes = [
        "the plugin takes these numbers in x forward, y starboard, z down; reference point: the link's origin",
        "u v of linear_damping_forward_speed is read as U v: both agree on straight courses",
    ]
    rho = link.density if link.density is not None else density
    if rho is None:
        rho = PLUGIN_DENSITY
        notes.append(f"density {rho:g} kg/m^3: the file states none, this is the plugin's own (BuoyantObject.cc)")
    if np.any(link.centre):
        notes.append(
            "the plugin's force acts at the centre of gravity: moments, and added mass, are moved to the link's origin"
        )
    name = root.get("name", "") or link.link
    afloat, not_afloat = _afloat(root, link, rho, name, path)
    x = Xacro(root, path)
    links = assembly(plain(root, x), link.link, path) if root.find(".//joint") is not None else None
    driven = thrusters_of(root, links, name, x, path)
    fins, of_fins = fins_of(root, links, name, x, path)
    driven = driven._replace(plugins=(*driven.plugins, *of_fins), findings=(*driven.findings, *fins.findings))
    form = _form(link)
    absolute = form.absolute.copy()
    absolute[:, :, 0] += fins.drift
    stated = LinkModel(
        model=root.get("name", ""),
        link=link.link,
        density=rho,
        form=replace(form, absolute=absolute),
        added=np.einsum("il,ljk->ijk", link.arm, momentum_quadratics(link.added_mass)),
        matrix=link.arm @ link.added_mass,
        mass=link.mass,
        centre=link.centre,
        inertia=link.inertia,
        length=link.length,
        length_name="length of the box",
        notes=tuple(notes),
        findings=(*_left_out(root, link, driven), *not_afloat),
        hydrostatics=afloat,
        thrusters=driven.thrusters,
        surfaces=fins.surfaces,
        controls=fins.controls,
    )
    return link_file(stated, path, citations, length, speed)


def _afloat(
    root: Element, link: FossenLink, density: float, name: str, path: Path
) -> tuple[ParameterHydrostatics | None, tuple[Finding, ...]]:  # fmt: skip
    """Volume, of the mass where the link is neutrally buoyant, and the centre of buoyancy, which the plugin counts from that of gravity
    (BuoyantObject.cc, ApplyBuoyancyForce: AddForceAtRelativePosition), z up.
    """
    element = next(
        e for e in root.iter("link") if e.get("name", "") == link.link and e.find("hydrodynamic_model") is not None
    )
    neutral = (element.findtext("neutrally_buoyant") or "").strip().lower() in ("1", "true")
    volume = link.mass / density if neutral and link.mass else link.volume
    stated = [t for t in ("volume", "center_of_buoyancy", "neutrally_buoyant") if element.find(t) is not None]
    if not volume or volume <= 0.0:
        return None, left_out(name, "hydrostatics", [f"<{t}>" for t in stated])
    text = element.findtext("center_of_buoyancy")
    x = Xacro(root, path)
    own = np.zeros(3) if text is None else np.array(numbers(x.text(text), (3,), "center_of_buoyancy", path)) * FRD
    at = (link.centre + own + 0.0).tolist()
    return ParameterHydrostatics(volume=volume, centre_of_buoyancy=(at[0], at[1], at[2])), ()


PLUGIN = re.compile(r"(lib)?(uuv|dave)\w*underwater_object\w*(\.so)?", re.IGNORECASE)
CURRENT = ("flow_velocity_topic", "use_global_current", "default_current")


def _left_out(root: Element, link: FossenLink, driven: Driven) -> tuple[Finding, ...]:
    """What the file says of the vehicle's motion and a parameter file does not hold."""
    name = root.get("name", "") or link.link
    links = [e for e in root.iter("link") if e.get("name", "") == link.link]
    model = next(m for e in links if (m := e.find("hydrodynamic_model")) is not None)
    plugins = tuple(root.iter("plugin"))
    own = next((p for p in plugins if model in p.iter("hydrodynamic_model")), model)
    others = [p for p in plugins if not any(p is q for q in driven.plugins)]
    turned = {(p.findtext(tag) or "").strip() for p in driven.plugins for tag in ("jointName", "joint_name")}
    joints = [j.get("name", "") for j in root.iter("joint") if j.get("type", "fixed") != "fixed"]
    ignored = link.quadratic - np.diag(np.diag(link.quadratic))
    off = [f"<quadratic_damping> row {i + 1} column {j + 1}" for i, j in np.argwhere(ignored)]
    out = [
        *left_out(name, "terms", unread_tags(model, (*MATRICES, "type"))),
        *left_out(name, "ignored", off),
        *left_out(name, "environment", [f"<{t}>" for t in CURRENT if own.find(t) is not None]),
        *other_plugins(name, others, own),
        *driven.findings,
        *other_masses(name, root.iter("link"), link.link),
        *left_out(name, "macros", unfolded(root)),
        *left_out(name, "includes", [e.get("filename", "").rpartition("/")[2] for e in root.iter(f"{SPACE}include")]),
        *left_out(name, "joints", [j for j in joints if j not in turned]),
    ]
    file = own.get("filename", "")
    if not PLUGIN.fullmatch(file.rpartition("/")[2]):
        out.append(Finding.of("model.by_type", name, Severity.WARN, file=one_line(file)[:80] or "no plugin"))
    return tuple(out)


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    root = read_xml(path)
    link = read_fossen_link(root, path)
    out = [*_units(root, link, path)]
    ignored = link.quadratic - np.diag(np.diag(link.quadratic))
    if np.any(ignored):
        out.append(_found("<quadratic_damping>", f"{np.count_nonzero(ignored)} off-diagonal entries",
                          "a diagonal matrix", "The plugin ignores them (HydrodynamicModel.cc, line 437)."))  # fmt: skip
    if np.any(link.centre):
        out.append(_found("<inertial> <origin>", f"centre of gravity {np.linalg.norm(link.centre):g} m from the link's origin",
                          "the origin in the centre of gravity",
                          "The plugin takes velocities at one and applies forces at the other."))  # fmt: skip
    added = momentum_quadratics(link.added_mass)
    out += munk_twice("uuv_simulator", _turning(link), added, ideal_quadratics(link.added_mass))
    return tuple(out)


def _found(key: str, statistic: str, rule: str, comment: str) -> Check:
    return Check("uuv_simulator", key, Severity.WARN, statistic, rule, comment)


def _units(root: Element, link: FossenLink, path: Path) -> list[Check]:
    out = [*no_mass("uuv_simulator", link.mass, "<mass>")]
    if link.density is not None:
        out.append(water("uuv_simulator", link.density, "density <fluid_density>"))
    if link.mass and link.volume and link.mass > 0.0:
        out += displaced("uuv_simulator", link.mass, link.volume, link.density or PLUGIN_DENSITY, "<mass> and <volume>")
    known = Xacro(root, path)
    for e in root.iter(f"{SPACE}property"):
        if (name := e.get("name", "")) in GRAVITIES:
            value = numbers(known.text(e.get("value", "")), (1,), name, path)[0]
            out += gravity("uuv_simulator", value, f'<xacro:property name="{name}">')
    return out


def _turning(link: FossenLink) -> list[Written]:
    """What the plugin is given of N over v and of M over w, in the order of its matrices."""
    out = []
    for component, i, j in (("N", 5, 1), ("M", 4, 2)):
        for tag, matrix, with_speed in (
            ("linear_damping_forward_speed", link.forward, True), ("linear_damping", link.linear, False),
        ):  # fmt: skip
            out.append(Written(component, f"<{tag}> row {i + 1} column {j + 1}", float(matrix[i, j]), with_speed))
    return out


def _form(link: FossenLink) -> SecondOrder:
    """The file's matrices as forces about the link's origin."""
    linear, forward = link.arm @ link.linear, link.arm @ link.forward
    signed, absolute = np.zeros((6, 6, 6)), np.zeros((6, 6, 6))
    signed[:, SURGE, SURGE] = forward[:, SURGE]
    plain = linear[:, 1:] == 0.0
    absolute[:, 1:, SURGE] = np.where(plain, forward[:, 1:], 0.0)
    signed[:, SURGE, 1:] = np.where(plain, 0.0, forward[:, 1:])
    for i in range(6):
        absolute[:, i, i] += link.arm[:, i] * link.quadratic[i, i]
    return SecondOrder(linear, signed, absolute)
