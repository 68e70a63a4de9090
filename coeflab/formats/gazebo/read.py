"""SDF models for gz-sim: the Hydrodynamics plugin and <fluid_added_mass>.

Volume of the plain shapes of a link's collisions, from which gz-sim computes buoyancy.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.bodies.closed_forms import ellipsoid_added_mass
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import XML_BYTES
from coeflab.core.table import Check, as_check
from coeflab.core.text.toml import read_text
from coeflab.core.text.xml import numbers, once, read_xml
from coeflab.core.types import Array
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.core.wording import one_line
from coeflab.formats import NoDensityError
from coeflab.formats.gazebo.actuator_checks import actuator_checks
from coeflab.formats.gazebo.actuators import actuators
from coeflab.formats.gazebo.assembly import (
    MOVING,
    Assembly,
    Lumped,
    assembly,
    collision_box,
    displaced_by,
    lumped,
    own_inertia,
)
from coeflab.formats.gazebo.law import (
    DENSITIES,
    FORCES,
    LENGTH,
    VELOCITIES,
    GzLink,
    as_sdf,
    hydrodynamics,
    read_gz_link,
    read_tags,
)
from coeflab.formats.gazebo.systems import GZ_SIM
from coeflab.formats.left_out import MOST, left_out, other_plugins, unread_tags
from coeflab.formats.link_file import LinkModel, link_file
from coeflab.law.rigid_body import ideal_quadratics, inertia_doubt
from coeflab.law.water import ROUND_DENSITY
from coeflab.vehicle.imported_numbers import BUOYANCY, Written, displaced, gravity, imperial, munk_twice, no_mass, water
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics
from coeflab.vehicle.second_order import FLU, SecondOrder

summary = "gz-sim SDF or URDF: Hydrodynamics plugin and <fluid_added_mass>, link frame FLU to FRD"
citations = ("fossen2011", "gz_sim")
reads = "SDF with the Hydrodynamics plugin"
signs = "gz-sim takes damping and <xDotU> ... negative, <fluid_added_mass> positive."

SQUARES = tuple(FORCES[i] + VELOCITIES[i] * 2 for i in range(6))
TURN, FREE = 2.0 * math.pi + 1e-3, 1e6  # rad; limits of joints that turn freely are written as huge numbers
FLATTEST = 1e-4  # of its largest side: no hull is so thin
OF_BOX = (0.5, 2.5, 4.5)  # a cylinder has 1.5 times the water of its ellipsoid, a box 2


def recognises(path: Path) -> bool:
    """Whether the file is SDF, or XML with the Hydrodynamics plugin of gz-sim."""
    text = read_text(path, XML_BYTES)
    if not text.lstrip().startswith("<") or "hydrodynamic_model" in text:
        return False
    return "<sdf" in text or re.search(r"<plugin[^<>]*hydrodynamics", text, re.IGNORECASE) is not None


def read(
    path: Path, density: float | None = None, length: float | None = None, speed: float | None = None
) -> ParameterFile:
    """Read an SDF model.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, where the file states none.
    length, speed : float, optional
        Of the primes, m and m/s; else those that coeflab wrote into the file, or 1 m, and 1 m/s, which the result says. Forces
        do not depend on them.

    Raises
    ------
    InputError
        No SDF with one Hydrodynamics plugin.
    NoDensityError
    """
    root = as_sdf(read_xml(path))
    once(hydrodynamics(root, path)[0], path)
    link = read_gz_link(root, path)
    stated = [numbers(e.text, (1,), tag, path)[0] for tag in DENSITIES for e in root.iter(tag)]
    rho = stated[0] if stated else density
    if rho is None:
        raise NoDensityError(
            "no density", "the density of the water", file=path,
            advice="The plugin needs none, primes do: give it (--density 1025), or write <uniform_fluid_density>.",
        )  # fmt: skip
    of_primes = root.find(f".//{LENGTH}")
    name = link.model or link.link
    held = assembly(root, link.link.rpartition("::")[2], path)
    driven = actuators(root, held, name, path)
    weighed, words = _weighed(link, held, name, path)
    afloat, of_volume = _afloat(root, held, weighed, rho, name, path)
    form = _form(link)
    absolute = form.absolute.copy()
    absolute[:, :, 0] += driven.drift
    model = LinkModel(
        model=link.model,
        link=link.link,
        density=rho,
        form=replace(form, absolute=absolute),
        added=_coriolis(link),
        matrix=_added_mass(link),
        mass=None if weighed is None else weighed.mass,
        centre=(link.centre if weighed is None else weighed.centre) * FLU[:3] + 0.0,
        inertia=None
        if weighed is None or weighed.inertia is None
        else weighed.inertia * np.outer(FLU[:3], FLU[:3]) + 0.0,
        hydrostatics=afloat,
        thrusters=driven.thrusters,
        surfaces=driven.surfaces,
        controls=driven.controls,
        length=None if of_primes is None else numbers(of_primes.text, (1,), LENGTH, path)[0],
        length_name="" if of_primes is None else one_line(of_primes.get("name") or "length")[:200],
        notes=(
            "axes turned from the link frame (x forward, y port, z up) to FRD; reference point: the link's origin",
            "|u| v is read as U v: both agree on straight courses",
        ),
        findings=(*_left_out(root, link, held, driven.read), *words, *of_volume, *driven.findings),
    )
    return link_file(model, path, citations, length, speed)


def _weighed(link: GzLink, held: Assembly, name: str, path: Path) -> tuple[Lumped | None, tuple[Finding, ...]]:
    """The hull and what joints hold to it as one body, and which links those are."""
    if link.mass is None or link.mass <= 0.0:
        return None, ()
    found = lumped(held, (link.mass, link.centre, link.inertia), path)
    return found, () if not found.names else (
        Finding.of("model.one_body", name, Severity.NOTE, statistic=found.mass, names=found.names[:MOST]),
    )


def _afloat(
    root: Element, held: Assembly, weighed: Lumped | None, density: float, name: str, path: Path
) -> tuple[ParameterHydrostatics | None, tuple[Finding, ...]]:
    """Volume and its centre as the Buoyancy system counts them; left out where a shape states none, or where no Buoyancy stands in
    the file and the collisions cannot be the displaced volume.
    """
    found = displaced_by(held, path)
    if found.unknown:
        return None, left_out(name, "hydrostatics", found.unknown)
    if found.volume <= 0.0:
        return None, ()
    ratio = None if weighed is None else density * found.volume / weighed.mass
    acts = any(
        "buoyancy" in (p.get("name", "") + p.get("filename", "")).lower() and "engine" not in p.get("name", "").lower()
        for p in root.iter("plugin")
    )
    if ratio is None or (not acts and not BUOYANCY[0] <= ratio <= BUOYANCY[1]):
        out = Finding.of(
            "model.rough_volume",
            name,
            Severity.WARN if ratio else Severity.NOTE,
            statistic=ratio or 0.0,
            threshold=1.0,
            volume=found.volume,
        )
        return None, (out,)
    strengths = [
        float(np.linalg.norm(numbers(e.text, (3,), "gravity", path)))
        for e in root.iter("gravity")
        if len((e.text or "").split()) == 3
    ]
    x, y, z = (found.centre * FLU[:3] + 0.0).tolist()
    g = strengths[0] if strengths and strengths[0] > 0.0 else STANDARD_GRAVITY
    return ParameterHydrostatics(volume=found.volume, centre_of_buoyancy=(x, y, z), gravity=g), ()


def _left_out(root: Element, link: GzLink, held: Assembly, read_too: Sequence[Element]) -> tuple[Finding, ...]:
    """What the file says of the vehicle's motion and a parameter file does not hold, and what its plugin takes by itself."""
    plugin, system = hydrodynamics(root)
    name = link.model or link.link
    currents = ("default_current", "namespace", "lookup_current_x", "lookup_current_y", "lookup_current_z")
    unread = unread_tags(plugin, (*read_tags(system), *currents))
    turned = {p.findtext(tag) for p in read_too for tag in ("joint_name", "control_joint_name")} | {
        j.name for p in read_too for j in held.joints if j.child == (p.findtext("link_name") or "").strip()
    }
    joints = [j.get("name", "") for j in root.iter("joint") if j.get("type") in MOVING and j.get("name") not in turned]
    shown = {id(p) for gui in root.iter("gui") for p in gui.iter("plugin")}
    plugins = [
        p
        for p in root.iter("plugin")
        if id(p) not in shown and not any(p is q for q in read_too) and not _is_buoyancy(p)
    ]
    out = [
        *left_out(name, "terms", unread),
        *left_out(name, "environment", [f"<{t}>" for t in currents if plugin.find(t) is not None]),
        *other_plugins(name, plugins, plugin),
        *left_out(name, "masses", held.unplaced),
        *left_out(name, "joints", joints),
        *left_out(
            name, "includes", [(e.text or "").strip().rpartition("/")[2] for e in root.iterfind(".//include/uri")]
        ),
    ]
    if system is not GZ_SIM:
        out.append(Finding.of("model.system", name, Severity.NOTE, name=system.name, source=system.source))
    if link.missing:
        out.append(Finding.of("model.defaults", name, Severity.WARN, names=link.missing))
    if system.faces_aft:
        out.append(Finding.of("model.ahead", name, Severity.WARN))
    return tuple(out)


def _is_buoyancy(plugin: Element) -> bool:
    """gz-sim's Buoyancy, whose volumes are read."""
    return (
        plugin.get("name", "").endswith("systems::Buoyancy") or plugin.get("filename", "") == "gz-sim-buoyancy-system"
    )


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    root = as_sdf(read_xml(path))
    link = read_gz_link(root, path)
    own = link.plugin_mass if not link.disable_added_mass else np.zeros((6, 6))
    out = [*_units(root, link, path), *_angles(root, link, path), *_of_box(root, link, path)]
    out += [*_links(root, link, path), *actuator_checks(root, path)]
    if np.any(link.fluid_mass) and np.any(own):
        out.append(_found(Severity.FAIL, "<fluid_added_mass>", "<fluid_added_mass> and <xDotU> ...", "one of the two",
                          "Added mass counts twice. Remove the plugin's."))  # fmt: skip
    if np.any(own) and not link.disable_coriolis:
        out.append(_found(Severity.WARN, "<disable_coriolis>", "<xDotU> ... without it", "no Coriolis of the plugin",
                          "The plugin adds +C_A(nu) nu, the reverse of the ideal fluid's. Disable it."))  # fmt: skip
    out += munk_twice("gazebo", _turning(link), _coriolis(link), ideal_quadratics(_added_mass(link)))
    squares = [t for i, t in enumerate(SQUARES) if link.signed[i, i, i]]
    if squares:
        bars = ", ".join(f"<{t[:2]}abs{t[2]}>" for t in squares)
        out.append(_found(Severity.WARN, ", ".join(f"<{t}>" for t in squares), "squares", "damping that changes sign with the motion",
                          f"A square pushes in one of the two directions since gz-sim 7; {bars} is meant."))  # fmt: skip
    if link.mass is not None and (heaviest := float(-own.diagonal()[:3].min())) >= link.mass:
        out.append(_found(Severity.WARN, "<mass>", f"added mass {heaviest:g} kg, link {link.mass:g} kg", "added mass below the link's",
                          "The plugin integrates it explicitly, which is unstable. Use <fluid_added_mass>."))  # fmt: skip
    return tuple(out)


def _links(root: Element, link: GzLink, path: Path) -> list[Check]:
    """The link that the plugin acts on, and moments of inertia of each that no body has; the whole may still have some."""
    held = assembly(root, link.link.rpartition("::")[2], path)
    out = []
    if held.hull not in held.elements and held.elements and root.find(".//include") is None:
        out.append(
            Finding.of(
                "model.no_link",
                one_line(held.hull)[:100],
                Severity.FAIL,
                names=tuple(map(one_line, held.elements))[:MOST],
            )
        )
    for j in held.joints:
        if j.low > j.high:
            out.append(
                Finding.of("model.limits", f"joint {one_line(j.name)}"[:100], Severity.WARN, low=j.low, high=j.high)
            )
    for name in held.links:
        inertial = held.elements[name].find("inertial") if name in held.elements else None
        matrix = None if inertial is None else own_inertia(inertial, path)
        if inertial is not None and matrix is not None:
            mass = numbers(inertial.findtext("mass") or "0", (1,), f"mass of {name}", path)[0]
            if doubt := inertia_doubt(mass, np.zeros(3), matrix):
                out.append(Finding.of("model.no_body", one_line(name)[:100], Severity.WARN, why=doubt))
    return [as_check("gazebo", f) for f in out]


def _angles(root: Element, link: GzLink, path: Path) -> list[Check]:
    """Poses and limits of hinges in degrees."""
    found = []
    for e in root.iter("pose"):
        if (e.get("degrees") or "").strip().lower() not in ("true", "1") and len((e.text or "").split()) == 6:
            found.append(("<pose>", max(map(abs, numbers(e.text, (6,), "pose", path)[3:]))))
    for e in root.iter("origin"):
        found.append(("<origin rpy>", max(map(abs, numbers(e.get("rpy", "0 0 0"), (3,), "origin rpy", path)))))
    held = assembly(root, link.link.rpartition("::")[2], path)
    for j in held.joints:
        ends = [abs(x) for x in (j.low, j.high) if x not in (0.0,) and abs(x) < FREE]
        found += [(f"<limit> of {j.name}", max(ends))] if j.kind == "revolute" and ends else []
    wrong = [(k, x) for k, x in found if x > TURN]
    if not wrong:
        return []
    words = Finding.of("model.turned", link.model or link.link, Severity.WARN, statistic=max(x for _, x in wrong), threshold=TURN,
                      names=tuple(dict.fromkeys(k for k, _ in wrong)))  # fmt: skip
    return [as_check("gazebo", words)]


def _of_box(root: Element, link: GzLink, path: Path) -> list[Check]:
    """Added mass across against that of the ellipsoid in the box of the hull's collisions."""
    held = assembly(root, link.link.rpartition("::")[2], path)
    box = collision_box(held, path)
    if box is None or not np.all(box > FLATTEST * np.max(box)) or not np.max(box) < FREE:
        return []
    own = np.diag(_added_mass(link))
    due = np.diag(ellipsoid_added_mass(box / 2.0, link.density or ROUND_DENSITY))
    hull = held.elements.get(held.hull)
    boxed = hull is not None and hull.find("collision/geometry/box") is not None
    low, high = OF_BOX[0], OF_BOX[2 if boxed else 1]
    ratios = {f"{f}{v}": float(own[i] / due[i]) for i, f, v in ((1, "Y", "v"), (2, "Z", "w")) if own[i] > 0.0}
    wrong = {k: r for k, r in ratios.items() if not low <= r <= high}
    if not wrong:
        return []
    words = Finding.of(
        "model.added_of_box",
        link.model or link.link,
        Severity.WARN,
        statistic=next(iter(wrong.values())),
        names=tuple(wrong),
    )
    return [as_check("gazebo", words)]


def _found(severity: Severity, key: str, statistic: str, rule: str, comment: str) -> Check:
    return Check("gazebo", key, severity, statistic, rule, comment)


def _units(root: Element, link: GzLink, path: Path) -> list[Check]:
    out = [*no_mass("gazebo", link.mass, "<mass>")]
    if link.density is not None:
        tag = next(t for t in DENSITIES if root.find(f".//{t}") is not None)
        out.append(water("gazebo", link.density, f"density <{tag}>"))
    for element in root.iter("gravity"):
        if len((element.text or "").split()) == 3:
            value = float(np.linalg.norm(numbers(element.text, (3,), "gravity", path)))
            out += gravity("gazebo", value, "<gravity>")
            if (upward := numbers(element.text, (3,), "gravity", path)[2]) > 0.0:
                out.append(
                    as_check("gazebo", Finding.of("model.gravity_up", "<gravity>", Severity.FAIL, statistic=upward))
                )
    held, density = assembly(root, link.link.rpartition("::")[2], path), link.density or ROUND_DENSITY
    volume = displaced_by(held, path).volume
    # A collision is often a rough box: only the ratios of units are told by it.
    if link.mass and link.mass > 0.0 and imperial(density * volume / link.mass):
        out += displaced("gazebo", link.mass, volume, density, "<mass> and <collision>")
    return out


def _turning(link: GzLink) -> list[Written]:
    """What the plugin is given of N over v and of M over w; both keep their sign from FLU to FRD."""
    out = []
    for component, i, j in (("N", 5, 1), ("M", 4, 2)):
        f, v = FORCES[i], VELOCITIES[j]
        out += [
            Written(component, f"<{f}{v}absU>", float(link.absolute[i, j, 0]), True),
            Written(component, f"<{f}U{v}>", float(link.signed[i, 0, j]), True),
            Written(component, f"<{f}{v}U>", float(link.signed[i, j, 0]), True),
            Written(component, f"<{f}{v}>", float(link.linear[i, j]), False),
        ]
    return out


def _added_mass(link: GzLink) -> Array:
    own = np.zeros((6, 6)) if link.disable_added_mass else -link.plugin_mass
    return np.asarray((link.fluid_mass + own) * np.outer(FLU, FLU))


def _form(link: GzLink) -> SecondOrder:
    once = np.triu(link.signed) + np.triu(np.swapaxes(link.signed, 1, 2), 1)
    return SecondOrder(link.linear, once, link.absolute, link.resistance).turned(FLU)


def _coriolis(link: GzLink) -> Array:
    """What the system adds of its own, FRD: the ideal fluid's of <fluid_added_mass>, about the reverse of it for <xDotU>."""
    turned = link.coriolis * FLU[:, None, None] * FLU[None, :, None] * FLU[None, None, :]
    return np.asarray(ideal_quadratics(link.fluid_mass * np.outer(FLU, FLU)) + turned)
