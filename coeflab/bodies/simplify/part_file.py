"""A body of simple parts as a body.toml that the reader ``primitives`` takes."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.shape import (
    CLASSES,
    Box,
    Cylinder,
    Faceted,
    Finned,
    Form,
    Part,
    Parts,
    Plate,
    StandIn,
    Tube,
    Turned,
)
from coeflab.law.symbols import MOTIONS
from coeflab.law.transforms import angles

COUNTS = {2: "two", 4: "four"}
AGREEMENT = (
    "Added mass of the parts over that of the mesh by the panel method, less one, motion by motion; error: of the mesh's, "
    "an estimate. Delete this table where you correct a part."
)
FIGURES, WIDTH = 12, 118  # digits that outlast rounding, and a line of an editor


def part_file(
    body: Body, shape: Parts, opening: tuple[str, ...], remarks: Mapping[str, tuple[str, ...]], mesh: str = ""
) -> bytes:
    """A body.toml.

    Parameters
    ----------
    body : Body
        Names, datum, reference point, source and scaling.
    shape : Parts
    opening : tuple of str
        Comment lines at the top.
    remarks : mapping of str to tuple of str
        Comment lines over each part, by its name.
    mesh : str
        Name of the file beside it, m, FRD, from the datum, for which the parts stand; none where empty.
    """
    lines = [*_comments(opening), "[body]"]
    lines += [f"name = {_text(body.name)}", f"title = {_text(body.title)}", 'reader = "primitives"']
    lines.append(f"datum = {_text(body.datum.id)}")
    if body.datum.note:
        lines.append(f"datum_note = {_text(body.datum.note)}")
    lines += [f"reference_point = {_numbers(body.reference_point)}", "", "[source]"]
    for key in ("citation", "place", "kind", "how_obtained", "stated_uncertainty"):
        value = getattr(body.source, key)
        if value:
            lines.append(f"{key} = {_text(value)}")
    if body.scaling is not None:
        lines += ["", "[prime]", f"length = {_number(body.scaling.length)}"]
        lines.append(f"length_name = {_text(body.scaling.length_name)}")
    if mesh:
        spelled = body.axes is not None and body.axes.spelled  # what was stated one by one stays so
        frame = '["forward", "starboard", "down"]' if spelled else '"FRD"'
        lines += ["", "[mesh]", f"path = {_text(mesh)}", 'unit = "m"', f"axes = {frame}"]
    if shape.agreement is not None:
        lines += ["", *_comments((AGREEMENT,)), "[against_mesh]"]
        found = zip(MOTIONS, shape.agreement.entries, strict=True)
        lines += [f"{motion} = {_number(value)}" for motion, value in found if value is not None]
        if shape.agreement.error is not None:
            lines.append(f"error = {_number(shape.agreement.error)}")
    for part in shape.parts:
        lines += ["", *_comments(remarks.get(part.name, ())), *_part(part)]
    return ("\n".join(lines) + "\n").encode()


def _part(part: Part) -> list[str]:
    form = part.form
    kind, sizes = form_keys(form)
    lines = ["[[part]]", f"name = {_text(part.name)}", f"form = {_text(kind)}"]
    lines += [f"{key} = {_number(value)}" for key, value in sizes.items()]
    if isinstance(form, Turned):
        lines += [f"stations = {_numbers(np.array(form.stations))}", f"radii = {_numbers(np.array(form.radii))}"]
    if isinstance(form, Finned):
        lines.append(f'count = "{COUNTS[form.count]}"')
    if isinstance(form, Faceted):
        lines.append(f"path = {_text(mesh_name(part))}")
    lines.append(f"centre = {_numbers(part.centre)}")
    turned = [float(np.round(np.degrees(a), 9)) + 0.0 for a in angles(part.rotation)]
    if any(turned):
        lines.append("rotation = [" + ", ".join(f'"{a:g} deg"' for a in turned) + "]")
    if part.fit is not None:
        lines.append(f"fit = {_fit(part.fit)}")
    return lines


def _fit(fit: StandIn) -> str:
    own = ("misfit", fit.misfit) if fit.misfit is not None else ("thickness", fit.thickness or 0.0)
    numbers = {own[0]: own[1], "shared": fit.shared, "volume": fit.volume, "length": fit.length}
    words = ", ".join(f"{key} = {_number(value)}" for key, value in numbers.items())
    return f'{{class = "{fit.kind}", {words}, areas = {_numbers(np.array(fit.areas))}}}'


def mesh_name(part: Part) -> str:
    """The file that holds the surface of a mesh part."""
    return f"{part.name}.ply"


def form_keys(form: Form) -> tuple[str, dict[str, float]]:
    """The name and the keys under which a body.toml gives a form."""
    if isinstance(form, Cylinder):
        return "cylinder", {"radius": form.radius, "length": form.length}
    if isinstance(form, Plate):
        return "plate", {"chord": form.chord, "span": form.span}
    if isinstance(form, Box):
        return CLASSES[type(form)], {"length": form.length, "width": form.width, "height": form.height}
    if isinstance(form, Tube):
        kind = "tube" if form.length > 2.0 * form.radius else "ring"
        return kind, {"radius": form.radius, "inner_radius": form.inner_radius, "length": form.length}
    if isinstance(form, Finned):
        sizes = {"radius": form.radius, "semi_span": form.semi_span, "chord": form.chord}
        return "finned", sizes | {"thickness": form.thickness}
    if isinstance(form, Turned | Faceted):
        return CLASSES[type(form)], {}
    if form.x == form.y == form.z:
        return "sphere", {"radius": form.x}
    if form.y == form.z:
        return "spheroid", {"length": 2.0 * form.x, "diameter": 2.0 * form.y}
    return "ellipsoid", {"semi_axis_x": form.x, "semi_axis_y": form.y, "semi_axis_z": form.z}


def _comments(texts: tuple[str, ...]) -> list[str]:
    """Comment lines; TOML allows no control characters in them."""
    plain = ("".join(ch if ch.isprintable() else " " for ch in text) for text in texts)
    wrap = textwrap.TextWrapper(WIDTH, initial_indent="# ", subsequent_indent="#   ")
    return [line for text in plain for line in wrap.wrap(text)]


def _text(value: str) -> str:
    """A TOML basic string; JSON's escapes are TOML's but for DEL, which TOML wants escaped."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _number(value: float) -> str:
    text = f"{float(value) + 0.0:.{FIGURES}g}"
    return text if any(ch in text for ch in ".en") else f"{text}.0"


def _numbers(values: np.ndarray) -> str:
    return "[" + ", ".join(_number(float(v)) for v in values) + "]"
