"""Bodies as named cylinders, plates, spheroids, ellipsoids, spheres and boxes, each with its pose."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import open_body_file
from coeflab.bodies.mesh.source import mesh_source
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts, Plate, StandIn
from coeflab.core.errors import InputError, shown
from coeflab.core.text.toml import Section
from coeflab.law.transforms import rotation

summary = "named cylinders, plates, spheroids, ellipsoids, spheres and boxes from a body.toml, each with its pose"
citations = ("fossen2011",)

FORMS = ("cylinder", "plate", "spheroid", "ellipsoid", "sphere", "box")


def _form(section: Section) -> Form:
    kind = section.text("form", choices=FORMS)
    size = {
        "cylinder": ("radius", "length"),
        "plate": ("chord", "span"),
        "spheroid": ("length", "diameter"),
        "ellipsoid": ("semi_axis_x", "semi_axis_y", "semi_axis_z"),
        "sphere": ("radius",),
        "box": ("length", "width", "height"),
    }[kind]
    values = [section.positive(key, "length") for key in size]
    try:
        return _made(kind, values)
    except InputError as why:
        raise section.fail("form", why.found, why.expected, why.advice) from None


def _made(kind: str, values: list[float]) -> Form:
    if kind == "cylinder":
        return Cylinder(*values)
    if kind == "plate":
        return Plate(*values)
    if kind == "box":
        return Box(*values)
    if kind == "sphere":
        return Ellipsoid(values[0], values[0], values[0])
    if kind == "spheroid":
        return Ellipsoid(values[0] / 2.0, values[1] / 2.0, values[1] / 2.0)
    return Ellipsoid(*values)


def _fit(section: Section) -> StandIn:
    def number(key: str) -> float:
        return section.quantity(key, "none")

    raw = section.raw("areas")
    if not isinstance(raw, list) or len(raw) != 3:
        raise section.fail("areas", shown(raw), "three errors [x, y, z] of projected areas")
    areas = section.triple("areas", "none")
    optional = {key: number(key) if section.has(key) else None for key in ("misfit", "thickness")}
    kind, shared = section.text("class"), number("shared")
    volume, length = number("volume"), number("length")
    section.finish()
    try:
        return StandIn(kind, shared, volume, areas, length, **optional)
    except InputError as why:
        raise section.fail(why.column or "class", why.found, why.expected, why.advice) from None


def _part(section: Section) -> Part:
    name, form = section.text("name"), _form(section)
    centre = section.point("centre")
    turn = section.triple("rotation", "angle") if section.has("rotation") else (0.0, 0.0, 0.0)
    if max(abs(a) for a in turn) > 2.0 * np.pi:
        raise section.fail(
            "rotation",
            f"{shown(section.raw('rotation'))}, more than a whole turn",
            "[roll, pitch, yaw] of at most 360 deg each",
            'A bare number is in rad: write degrees as "90 deg".',
        )
    fit = _fit(section.section("fit")) if section.has("fit") else None
    section.finish()
    try:
        return Part(name, form, centre, rotation(*turn), fit)
    except InputError as why:
        raise section.fail("fit", why.found, why.expected, why.advice) from None


def read(path: Path) -> Body:
    """Read a body.toml of parts.

    Lengths are in metres unless a unit is written. ``rotation`` is [roll, pitch, yaw]; a bare number is in rad. Along
    its own axes a cylinder and a spheroid lie along x, a plate has its chord along x, its span along y and its normal
    along z.

    Raises
    ------
    InputError
        Anything missing, unknown, of the wrong unit or not above zero, by file and key.
    """
    opened = open_body_file(path, "primitives")
    sections = opened.root.sections("part")
    if not sections:
        raise InputError("no [[part]]", f"at least one part, with form {', '.join(FORMS)}", file=path, column="part")
    made = tuple(_part(s) for s in sections)
    try:
        shape = Parts(made)
    except InputError as why:
        raise InputError(why.found, why.expected, file=path, column="part") from None
    computed = Configuration(
        name="by_parts",
        title="sum of the parts; overlaps count twice",
        volume=shape.volume or None,
        wetted_surface=None,
        centre_of_buoyancy=shape.centre_of_volume,
        mass=None,
    )
    source = mesh_source(opened.root.section("mesh"), path.parent) if opened.root.has("mesh") else None
    if source is not None and not source.file.is_file():
        raise InputError(
            f"no file {shown(source.file.name)}", "the mesh that the parts stand for", file=path, column="mesh.path",
            advice="Put it back, or delete [mesh]: results are then as rough as the parts.",
        )  # fmt: skip
    body = opened.body(shape, computed)
    if source is None:
        return body
    return replace(body, mesh=source, files=(*body.files, source.input_file(body.name)))
