"""Stonefish scenarios (.scn): a robot's rigid body, what it displaces, and its thrusters, as far as the text states them.

Stonefish makes drag, added mass and the volume of meshes from their surfaces (SolidEntity.cpp), so that a scenario holds no force law. Body
axes are x forward, y starboard, z down.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import XML_BYTES
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.toml import read_text
from coeflab.core.text.xml import numbers, read_xml
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import one_line
from coeflab.formats import NoDensityError
from coeflab.formats.left_out import left_out
from coeflab.formats.stated_file import Stated, stated_file
from coeflab.formats.stonefish.thrusters import thrusters_of
from coeflab.law.rigid_body import MassProperties, about_another, inertia_doubt
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.transforms import rotation
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics

summary = (
    "Stonefish .scn: mass, inertia, volume of plain shapes and thrusters of one robot; its forces come from meshes"
)
citations = ("stonefish",)
reads = "Stonefish .scn"
signs = "Stonefish takes z down."
PARTS = ("external_part", "internal_part")


def recognises(path: Path) -> bool:
    """Whether the file is XML with a <scenario>."""
    text = read_text(path, XML_BYTES)
    return text.lstrip().startswith("<") and re.search(r"<scenario\b", text) is not None


def read(path: Path, density: float | None = None) -> ParameterFile:
    """Read the one robot of a scenario.

    Parameters
    ----------
    path : path
    density : float, optional
        kg/m^3, where no <water> states one.

    Raises
    ------
    InputError
        None or several robots.
    NoDensityError
    """
    root = read_xml(path)
    robots = list(root.iter("robot"))
    if len(robots) != 1:
        raise input_error(
            "formats.several_robots", path, count=len(robots), advice="Keep one vehicle in the file." if robots else ""
        )
    robot = robots[0]
    stated = [_one(e, "density", path) for e in root.iter("water") if e.get("density") is not None]
    rho = stated[0] if stated else density
    if rho is None:
        raise NoDensityError("no density", "the density of the water", file=path, advice="Give it: --density 1025.")
    named = one_line(robot.get("name") or "")[:200]
    name = named if named and "$" not in named else path.stem[:200]  # $(arg ...) is of another file
    base = robot.find("base_link")
    parts = [] if base is None else [p for p in base.iter() if p.tag in PARTS] or [base]
    findings: list[Finding] = []
    mass = _mass(parts, name, findings, path)
    driven = thrusters_of(robot, rho, name, path)
    links = [
        e.get("name", "") for e in robot.iter("link") if e.find("physical") is not None or e.find("mass") is not None
    ]
    findings += [
        *left_out(name, "surfaces", [f"{p.get('type', '')} {p.get('name', '')}".strip() for p in parts if p.get("physics") in ("submerged", "floating")]),
        *driven.findings,
        *left_out(name, "masses", links),
    ]  # fmt: skip
    result = Stated(
        name=name, body=name, scaling=Scaling(1.0, "1 m"), conditions=Conditions(rho, 1.0), coefficients={},
        datum=Datum("origin of the robot"), mass=mass, hydrostatics=_afloat(parts, name, findings, path), thrusters=driven.thrusters,
        notes=("lengths made dimensionless by 1 m: the file states none", "axes x forward, y starboard, z down, as in the file"),
        findings=tuple(findings),
    )  # fmt: skip
    return stated_file(result, [InputFile(path.name, sha256_of(path))], citations)


def _one(element: Element, name: str, path: Path) -> float:
    return numbers(element.get(name), (1,), name, path)[0]


def _frame(element: Element | None, path: Path) -> tuple[Array, Array]:
    if element is None:
        return np.eye(3), np.zeros(3)
    return (
        rotation(*numbers(element.get("rpy", "0 0 0"), (3,), "rpy", path)),
        np.array(numbers(element.get("xyz", "0 0 0"), (3,), "xyz", path)),
    )


def _placed(part: Element, path: Path) -> tuple[Array, Array]:
    """Frame of a part's shape in the robot."""
    return _composed(part, "origin", path)


def _composed(part: Element, tag: str, path: Path) -> tuple[Array, Array]:
    """Frame of a part's ``origin``, its shape, or ``cg``, its principal axes of inertia: both stand in the part's own frame."""
    (outer, at), (inner, own) = _frame(part.find("compound_transform"), path), _frame(part.find(tag), path)
    return outer @ inner, at + outer @ own


def _mass(parts: list[Element], name: str, findings: list[Finding], path: Path) -> MassProperties | None:
    """Sum of the parts; None, with a finding, where one states no mass: it follows from a material and a mesh."""
    if silent := [one_line(p.get("name", ""))[:80] for p in parts if p.find("mass") is None]:
        stated = [
            f"{_one(p.find('mass'), 'value', path):g} kg of {one_line(p.get('name', ''))[:80]}"  # type: ignore[arg-type]
            for p in parts
            if p.find("mass") is not None
        ]
        findings.extend(left_out(name, "inertia", [*(f"mass of {s}" for s in silent), *stated]))
        return None
    bodies = []
    for part in parts:
        turn, at = _placed(part, path) if part.find("cg") is None else _composed(part, "cg", path)
        mass = _one(part.find("mass"), "value", path)  # type: ignore[arg-type]
        own = part.find("inertia")
        moments = None if own is None else turn @ np.diag(numbers(own.get("xyz"), (3,), "inertia xyz", path)) @ turn.T
        bodies.append((mass, at, moments))
    total = math.fsum(b[0] for b in bodies)
    if not total > 0.0:
        findings.append(Finding.of("model.no_inertia", name, Severity.FAIL, why=f"a mass of {total:g} kg"))
        return None
    centre = sum((m * c for m, c, _ in bodies), np.zeros(3)) / total
    matrix = None
    if all(moments is not None for _, _, moments in bodies):
        matrix = sum((about_another(j, m, np.zeros(3), c) for m, c, j in bodies if j is not None), np.zeros((3, 3)))
        if doubt := inertia_doubt(total, centre, matrix):
            findings.append(Finding.of("model.no_inertia", name, Severity.FAIL, why=doubt))
            matrix = None
    return MassProperties(total, total * float(centre[0]), None, centre, matrix)


def _volume(part: Element, path: Path) -> float | None:
    """Of a box, cylinder or sphere, m^3; None of meshes."""
    size = part.find("dimensions")
    if size is None:
        return None
    match part.get("type"):
        case "box":
            return math.prod(numbers(size.get("xyz"), (3,), "dimensions xyz", path))
        case "cylinder":
            return math.pi * _one(size, "radius", path) ** 2 * _one(size, "height", path)
        case "sphere":
            return 4.0 / 3.0 * math.pi * _one(size, "radius", path) ** 3
        case _:
            return None


def _afloat(parts: list[Element], name: str, findings: list[Finding], path: Path) -> ParameterHydrostatics | None:
    """Volume of the buoyant parts and its centre; None, with a finding, where one is a mesh."""
    buoyant = [
        p for p in parts if p.get("buoyant", "true").lower() == "true" and p.get("physics") in ("submerged", "floating")
    ]
    sizes = [_volume(p, path) for p in buoyant]
    if unknown := [one_line(p.get("name", ""))[:80] for p, s in zip(buoyant, sizes, strict=True) if s is None]:
        known = [f"{s:.4g} m^3 of {one_line(p.get('name', ''))[:80]}" for p, s in zip(buoyant, sizes, strict=True) if s]
        findings.extend(left_out(name, "hydrostatics", [*(f"volume of {u}" for u in unknown), *known]))
        return None
    whole = math.fsum(s for s in sizes if s)
    if not whole > 0.0:
        return None
    x, y, z = (
        sum((s * _placed(p, path)[1] for p, s in zip(buoyant, sizes, strict=True) if s), np.zeros(3)) / whole
    ).tolist()
    return ParameterHydrostatics(volume=whole, centre_of_buoyancy=(x, y, z))
