"""Writing a body of simple parts as a body.toml that the reader ``primitives`` takes."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping

import numpy as np

from coeflab.kernels.attitude import angles
from coeflab.model.body import Body
from coeflab.model.shape import Box, Cylinder, Form, Part, Parts, Plate, StandIn

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
        lines += ["", "[mesh]", f"path = {_text(mesh)}", 'unit = "m"', 'axes = "FRD"']
    for part in shape.parts:
        lines += ["", *_comments(remarks.get(part.name, ())), *_part(part)]
    return ("\n".join(lines) + "\n").encode()


def _part(part: Part) -> list[str]:
    kind, sizes = written(part.form)
    lines = ["[[part]]", f"name = {_text(part.name)}", f"form = {_text(kind)}"]
    lines += [f"{key} = {_number(value)}" for key, value in sizes.items()]
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
    said = ", ".join(f"{key} = {_number(value)}" for key, value in numbers.items())
    return f'{{class = "{fit.kind}", {said}, areas = {_numbers(np.array(fit.areas))}}}'


def written(form: Form) -> tuple[str, dict[str, float]]:
    """The name and the keys under which a body.toml gives a form."""
    if isinstance(form, Cylinder):
        return "cylinder", {"radius": form.radius, "length": form.length}
    if isinstance(form, Plate):
        return "plate", {"chord": form.chord, "span": form.span}
    if isinstance(form, Box):
        return "box", {"length": form.length, "width": form.width, "height": form.height}
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
