"""Bodies as closed surfaces of triangles: STL, OBJ, PLY or GLB with their unit and axes declared."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import ClassVar

import numpy as np

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.body_file import ShapedBodyFile
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import UNITS, computed, likely_unit, require_plausible
from coeflab.bodies.mesh.source import MeshKeys
from coeflab.bodies.pieces import mesh_piece
from coeflab.core.declarations import declared
from coeflab.core.errors import InputError
from coeflab.core.text.toml import read_toml
from coeflab.core.units import factor

summary = "a closed mesh (STL, OBJ, PLY, GLB) with declared unit and axes, refused unless sound"
citations = ("eberly2002",)

Refusal = Callable[..., InputError]
NEAR, FAR = 0.005, 0.05
STATED = (
    ("length", 0, ("length", "length_overall", "loa")),
    ("breadth", 1, ("breadth", "beam", "width")),
    ("depth", 2, ("depth", "height")),
)


def _require_size(mesh: TriangleMesh, unit: float, lengths: dict[str, float], fail: Refusal) -> tuple[str, ...]:
    """Hold the mesh against the stated sizes; what lies 0.5 to 5 % off is returned in words.

    Raises
    ------
    InputError
        More than 5 % off, or without stated sizes shorter than 0.05 m or longer than 500 m.
    """
    words = []
    stated = {name: (axis, lengths[key]) for name, axis, keys in STATED for key in keys if key in lengths}
    if not stated:
        require_plausible(mesh, unit, partial(fail, "mesh.unit"))
    for name, (axis, value) in stated.items():
        found = float(mesh.extents[axis])
        if not _near(found, value):
            axes = "Are the axes right?" if np.any(np.abs(mesh.extents / value - 1.0) <= FAR) else ""
            advice = axes or likely_unit(found / unit, value)
            raise fail(
                "mesh.path", f"a {name} of {found:.6g} m", f"{value:.6g} m as in [particulars], within 5 %", advice
            )
        if abs(found / value - 1.0) > NEAR:
            words.append(f"{name} {100.0 * (found / value - 1.0):+.1f} % from the stated")
    return tuple(words)


def _require_volume(
    mesh: TriangleMesh, unit: float, printed: tuple[Configuration, ...], fail: Refusal
) -> tuple[str, ...]:
    """Hold the volume against the nearest of the stated ones, in the same way."""
    stated = [(abs(mesh.volume / c.volume - 1.0), c) for c in printed if c.volume]
    if not stated:
        return ()
    off, nearest = min(stated, key=lambda pair: pair[0])
    volume = nearest.volume or 1.0
    if off > FAR:
        likely = (
            f'Is the unit "{u}"?' for u in UNITS if _near(mesh.volume * (factor(u, "length") / unit) ** 3, volume)
        )
        raise fail(
            "mesh.path",
            f"a volume of {mesh.volume:.6g} m^3",
            f"{volume:.6g} m^3 as in [[configuration]] {nearest.name}, within 5 %",
            next(likely, "Does the mesh show the same body, all of it and once?"),
        )
    return (f"volume {100.0 * (mesh.volume / volume - 1.0):+.1f} % from {nearest.name}",) if off > NEAR else ()


def _near(found: float, stated: float) -> bool:
    return abs(found / stated - 1.0) <= FAR


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class File(ShapedBodyFile):
    """A body.toml whose shape is a mesh.

    Attributes
    ----------
    mesh : table
        A file of triangles.
    """

    reader: ClassVar[str] = "mesh"
    mesh: MeshKeys


def read(path: Path) -> Body:
    """Read a body.toml whose shape is a mesh file.

    ``[mesh]`` holds ``path`` (from the folder of the body.toml), ``unit``, ``axes`` (``"FRD"``, ``"FLU"``, ``"CFD"`` or
    three directions), ``origin`` (where the file's origin lies, m, FRD, from the datum; the datum itself unless given)
    and ``repair`` (false). ``length``, ``breadth`` and ``depth`` under ``[particulars]``, and the volume of a
    ``[[configuration]]``, are what the mesh is compared with.

    A text STL of several named solids that close one surface keeps these names as the patches of a towed body.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key; a file that is no sound mesh; a body far from
        its stated size.
    """
    toml = read_toml(path)
    file = declared(File, toml)
    source = file.mesh.source(path.parent)
    shape, statements = source.read()
    body = file.shaped(path, shape, computed(shape, statements), (mesh_piece(shape, source),))
    words = _require_size(shape, source.unit, dict(body.lengths), toml.fail)
    words += _require_volume(shape, source.unit, body.configurations[1:], toml.fail)
    return dataclasses.replace(
        body,
        configurations=(
            dataclasses.replace(body.configurations[0], title=computed(shape, statements + words).title),
            *body.configurations[1:],
        ),
        files=(*body.files, source.input_file(body.name)),
        axes=file.mesh.axes,
    )
