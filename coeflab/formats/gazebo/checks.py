"""What models for gz-sim let go wrong and a parameter file cannot show."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.axes import FLU
from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.text.xml import numbers, read_xml
from coeflab.core.types import Array
from coeflab.core.wording import one_line
from coeflab.formats.gazebo.actuator_checks import actuator_checks
from coeflab.formats.gazebo.assembly import Assembly, assembly, collision_box, displaced_by, own_inertia
from coeflab.formats.gazebo.joined import structure_checks
from coeflab.formats.gazebo.law import DENSITIES, FORCES, VELOCITIES, GzLink, as_sdf, hydrodynamics, read_gz_link
from coeflab.formats.left_out import MOST
from coeflab.law.rigid_body import ideal_quadratics, inertia_doubt
from coeflab.law.water import ROUND_DENSITY
from coeflab.vehicle.imported_numbers import Written, displaced, gravity, imperial, munk_twice, no_mass, water

SQUARES = tuple(FORCES[i] + VELOCITIES[i] * 2 for i in range(6))
TURN, FREE = 2.0 * math.pi + 1e-3, 1e6  # rad; limits of joints that turn freely are written as huge numbers
FLATTEST = 1e-4  # of its largest side: no hull is so thin
OF_BOX = (0.5, 2.5, 4.5)  # a cylinder has 1.5 times the water of its ellipsoid, a box 2


def examine(path: Path) -> tuple[Check, ...]:
    """What this format lets go wrong and a parameter file cannot show.

    Raises
    ------
    InputError
    """
    root = as_sdf(read_xml(path))
    link = read_gz_link(root, path)
    own = link.plugin_mass if not link.disable_added_mass else np.zeros((6, 6))
    held = assembly(root, link.link.rpartition("::")[2], path)
    out = [*_units(root, link, held, path), *_angles(root, link, held, path), *_of_box(link, held, path)]
    out += [*_links(root, held, path), *actuator_checks(root, path)]
    out += structure_checks(root, hydrodynamics(root)[0], path)
    if np.any(link.fluid_mass) and np.any(own):
        out.append(_found(Severity.FAIL, "<fluid_added_mass>", "<fluid_added_mass> and <xDotU> ...", "one of the two",
                          "Added mass counts twice. Remove the plugin's."))  # fmt: skip
    if np.any(own) and not link.disable_coriolis:
        out.append(_found(Severity.WARN, "<disable_coriolis>", "<xDotU> ... without it", "no Coriolis of the plugin",
                          "The plugin adds +C_A(nu) nu, the reverse of the ideal fluid's. Disable it."))  # fmt: skip
    out += munk_twice("gazebo", _turning(link), coriolis_of(link), ideal_quadratics(added_mass_of(link)))
    squares = [t for i, t in enumerate(SQUARES) if link.signed[i, i, i]]
    if squares:
        bars = ", ".join(f"<{t[:2]}abs{t[2]}>" for t in squares)
        out.append(_found(Severity.WARN, ", ".join(f"<{t}>" for t in squares), "squares", "damping that changes sign with the motion",
                          f"A square pushes in one of the two directions since gz-sim 7; {bars} is meant."))  # fmt: skip
    if link.mass is not None and (heaviest := float(-own.diagonal()[:3].min())) >= link.mass:
        out.append(_found(Severity.WARN, "<mass>", f"added mass {heaviest:g} kg, link {link.mass:g} kg", "added mass below the link's",
                          "The plugin integrates it explicitly, which is unstable. Use <fluid_added_mass>."))  # fmt: skip
    return tuple(out)


def _links(root: Element, held: Assembly, path: Path) -> list[Check]:
    """The link that the plugin acts on, and moments of inertia of each that no body has; the whole may still have some."""
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


def _angles(root: Element, link: GzLink, held: Assembly, path: Path) -> list[Check]:
    """Poses and limits of hinges in degrees."""
    found = []
    for e in root.iter("pose"):
        if (e.get("degrees") or "").strip().lower() not in ("true", "1") and len((e.text or "").split()) == 6:
            found.append(("<pose>", max(map(abs, numbers(e.text, (6,), "pose", path)[3:]))))
    for e in root.iter("origin"):
        found.append(("<origin rpy>", max(map(abs, numbers(e.get("rpy", "0 0 0"), (3,), "origin rpy", path)))))
    for j in held.joints:
        ends = [abs(x) for x in (j.low, j.high) if x not in (0.0,) and abs(x) < FREE]
        found += [(f"<limit> of {j.name}", max(ends))] if j.kind == "revolute" and ends else []
    wrong = [(k, x) for k, x in found if x > TURN]
    if not wrong:
        return []
    words = Finding.of("model.turned", link.model or link.link, Severity.WARN, statistic=max(x for _, x in wrong), threshold=TURN,
                      names=tuple(dict.fromkeys(k for k, _ in wrong)))  # fmt: skip
    return [as_check("gazebo", words)]


def _of_box(link: GzLink, held: Assembly, path: Path) -> list[Check]:
    """Added mass across against that of the ellipsoid in the box of the hull's collisions."""
    box = collision_box(held, path)
    if box is None or not np.all(box > FLATTEST * np.max(box)) or not np.max(box) < FREE:
        return []
    own = np.diag(added_mass_of(link))
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


def _units(root: Element, link: GzLink, held: Assembly, path: Path) -> list[Check]:
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
    density = link.density or ROUND_DENSITY
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


def added_mass_of(link: GzLink) -> Array:
    """(6, 6) FRD: of <fluid_added_mass>, and the plugin's own unless it is disabled."""
    own = np.zeros((6, 6)) if link.disable_added_mass else -link.plugin_mass
    return np.asarray((link.fluid_mass + own) * np.outer(FLU, FLU))


def coriolis_of(link: GzLink) -> Array:
    """What the system adds of its own, FRD: the ideal fluid's of <fluid_added_mass>, about the reverse of it for <xDotU>."""
    turned = link.coriolis * FLU[:, None, None] * FLU[None, :, None] * FLU[None, None, :]
    return np.asarray(ideal_quadratics(link.fluid_mass * np.outer(FLU, FLU)) + turned)
