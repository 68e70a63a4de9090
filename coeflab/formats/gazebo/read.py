"""SDF models for gz-sim: the Hydrodynamics plugin and <fluid_added_mass>.

Volume of the plain shapes of a link's collisions, from which gz-sim computes buoyancy.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import XML_BYTES
from coeflab.core.table import Check
from coeflab.core.text.toml import read_text
from coeflab.core.text.xml import numbers, once, read_xml
from coeflab.core.types import Array
from coeflab.core.wording import one_line
from coeflab.formats import NoDensityError
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
from coeflab.formats.left_out import left_out, other_masses, other_plugins, unread_tags
from coeflab.formats.stated_file import LinkModel, link_file
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.second_order import FLU, SecondOrder
from coeflab.vehicle.stated_numbers import Written, displaced, gravity, imperial, munk_twice, no_mass, water


def collision_volume(link: Element | None, file: Path | str | None = None) -> float:
    """Sum over boxes, cylinders, spheres, capsules and ellipsoids, m^3; zero where there are none.

    Raises
    ------
    InputError
        A size that is no number.
    """
    shapes = [] if link is None else [s for g in link.iterfind("collision/geometry") for s in g]
    return sum(_volume(s, file) for s in shapes)


def _volume(shape: Element, file: Path | str | None) -> float:
    def size(tag: str, count: int = 1) -> tuple[float, ...]:
        return numbers(shape.findtext(tag), (count,), f"{shape.tag} {tag}", file)

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
        case _:
            return 0.0


summary = "gz-sim SDF or URDF: Hydrodynamics plugin and <fluid_added_mass>, link frame FLU to FRD"
citations = ("fossen2011", "gz_sim")
reads = "SDF with the Hydrodynamics plugin"
signs = "gz-sim takes damping and <xDotU> ... negative, <fluid_added_mass> positive."

SQUARES = tuple(FORCES[i] + VELOCITIES[i] * 2 for i in range(6))
FRESH = 1000.0


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
    model = LinkModel(
        model=link.model,
        link=link.link,
        density=rho,
        form=_form(link),
        added=_coriolis(link),
        matrix=_added_mass(link),
        mass=link.mass,
        centre=link.centre * FLU[:3] + 0.0,
        inertia=None if link.inertia is None else link.inertia * np.outer(FLU[:3], FLU[:3]) + 0.0,
        length=None if of_primes is None else numbers(of_primes.text, (1,), LENGTH, path)[0],
        length_name="" if of_primes is None else one_line(of_primes.get("name") or "length")[:200],
        notes=(
            "axes turned from the link frame (x forward, y port, z up) to FRD; reference point: the link's origin",
            "|u| v is read as U v: both agree on straight courses",
        ),
        findings=_left_out(root, link),
    )
    return link_file(model, path, citations, length, speed)


def _left_out(root: Element, link: GzLink) -> tuple[Finding, ...]:
    """What the file says of the vehicle's motion and a parameter file does not hold, and what its plugin takes by itself."""
    plugin, system = hydrodynamics(root)
    name = link.model or link.link
    hull = link.link.rpartition("::")[2]
    links = tuple(root.iter("link"))
    volume = [f"collisions of {hull}" for e in links if e.get("name") == hull and e.find("collision") is not None]
    currents = ("default_current", "namespace", "lookup_current_x", "lookup_current_y", "lookup_current_z")
    unread = unread_tags(plugin, (*read_tags(system), *currents))
    joints = [j.get("name", "") for j in root.iter("joint") if j.get("type") != "fixed"]
    out = [
        *left_out(name, "terms", unread),
        *left_out(name, "environment", [f"<{t}>" for t in currents if plugin.find(t) is not None]),
        *left_out(name, "hydrostatics", volume),
        *other_plugins(name, root.iter("plugin"), plugin),
        *other_masses(name, links, hull),
        *left_out(name, "joints", joints),
    ]
    if system is not GZ_SIM:
        out.append(Finding.of("model.system", name, Severity.NOTE, name=system.name, source=system.source))
    if link.missing:
        out.append(Finding.of("model.defaults", name, Severity.WARN, names=link.missing))
    if system.faces_aft:
        out.append(Finding.of("model.ahead", name, Severity.WARN))
    return tuple(out)


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    root = as_sdf(read_xml(path))
    link = read_gz_link(root, path)
    own = link.plugin_mass if not link.disable_added_mass else np.zeros((6, 6))
    out = [*_units(root, link, path)]
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
    hull = next((e for e in root.iter("link") if e.get("name") == link.link.rpartition("::")[2]), None)
    volume, density = collision_volume(hull, path), link.density or FRESH
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
