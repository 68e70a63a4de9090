"""Bodies as named cylinders, plates, spheroids, ellipsoids, spheres and boxes, each with its pose."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.toml import Section
from coeflab.kernels.attitude import rotation
from coeflab.model.body import Body, Configuration
from coeflab.model.body_file import open_body_file
from coeflab.model.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts, Plate

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
    section.finish()
    return Part(name, form, centre, rotation(*turn))


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
    return opened.body(shape, computed)
