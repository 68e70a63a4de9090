"""SDF models for gz-sim: the Hydrodynamics plugin and <fluid_added_mass>."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.axes import FLU
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import XML_BYTES
from coeflab.core.text.toml import read_text
from coeflab.core.text.xml import numbers, once, read_xml
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.core.wording import one_line
from coeflab.formats import NoDensityError
from coeflab.formats.gazebo.actuators import actuators
from coeflab.formats.gazebo.assembly import (
    MOVING,
    Assembly,
    Lumped,
    assembly,
    displaced_by,
    lumped,
)
from coeflab.formats.gazebo.checks import added_mass_of, coriolis_of, examine
from coeflab.formats.gazebo.law import (
    DENSITIES,
    LENGTH,
    GzLink,
    as_sdf,
    hydrodynamics,
    read_gz_link,
    read_tags,
)
from coeflab.formats.gazebo.systems import GZ_SIM
from coeflab.formats.left_out import MOST, left_out, other_plugins, unread_tags
from coeflab.formats.link_file import LinkModel, link_file
from coeflab.vehicle.imported_numbers import BUOYANCY
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics
from coeflab.vehicle.second_order import SecondOrder

__all__ = ["citations", "examine", "read", "reads", "recognises", "signs", "summary"]
summary = "gz-sim SDF or URDF: Hydrodynamics plugin and <fluid_added_mass>, link frame FLU to FRD"
citations = ("fossen2011", "gz_sim")
reads = "SDF with the Hydrodynamics plugin"
signs = "gz-sim takes damping and <xDotU> ... negative, <fluid_added_mass> positive."


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
        added=coriolis_of(link),
        matrix=added_mass_of(link),
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


def _form(link: GzLink) -> SecondOrder:
    once = np.triu(link.signed) + np.triu(np.swapaxes(link.signed, 1, 2), 1)
    return SecondOrder(link.linear, once, link.absolute, link.resistance).turned(FLU)
