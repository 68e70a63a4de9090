"""A body.toml of a bare mesh, for a person to complete: what was read and found stands in it, what a mesh cannot say is a comment.

No rudder and no thruster is invented: their lines are comments with the fins that were found, and words in the place of numbers that
only their owner knows.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from hashlib import sha256
from importlib.resources import files
from pathlib import Path

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.outline import Foil
from coeflab.core.axes import Axes, parse_axes
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import quoted
from coeflab.core.types import Array

UPRIGHT = 2.0  # rise over reach, or reach over rise, from which a fin is upright, or level
SEAL = "# Replaced by `coeflab vehicle` as long as nobody edits it: "
NOTHING = 1e-4  # of the length: a place nearer to an axis is on it
CONTROLS = {  # of a tail: the angle, what turns by it, the axis and its sense
    "dr": ("upright", "[0.0, 0.0, 1.0]", "dr positive with the trailing edge to port"),
    "ds": ("level", "[0.0, 1.0, 0.0]", "ds positive with the trailing edge down"),
}


def drafted(
    body: Body,
    shape: TriangleMesh,
    mesh: Path,
    folder: Path,
    unit: str,
    axes: str,
    *,
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
) -> str:
    """The text of a body.toml.

    Parameters
    ----------
    body : Body
        As the mesh was read; its datum is the origin of the mesh's axes.
    shape : TriangleMesh
        Its shape.
    mesh, folder : Path
        The mesh file, and the folder of the body.toml, from which the mesh is named.
    unit, axes : str
        As they were stated.
    repair, fill, sheets : bool
        What the mesh needed to be read.
    """
    path = Path(os.path.relpath(mesh.absolute(), folder.absolute())).as_posix()
    mended = "".join(f"{key} = true\n" for key, on in (("repair", repair), ("fill", fill), ("sheets", sheets)) if on)
    outline = body.outline
    foils = outline.foils if outline is not None else ()
    nothing = NOTHING * shape.length
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    text = own_text(files("coeflab.bodies") / "drafted.toml.txt").format(
        name=quoted(body.name), origin=quoted(f"of {mesh.name}"), point=_point(body.reference_point, nothing), path=quoted(path),
        unit=quoted(unit), axes=_stated(parse_axes(axes)), mended=mended, length=high[0] - low[0], source=quoted(f"{mesh.name}, a mesh"),
        controls=_controls(foils, (low[0] + high[0]) / 2.0, nothing), stern=_point(np.array([low[0], *_axis(foils, low, high)]), nothing),
    )  # fmt: skip
    return f"{SEAL}{_digest(text)}\n{text}"


def is_untouched(text: str) -> bool:
    """Whether a body.toml is as `drafted` made it, of whatever unit and axes."""
    first, _, rest = text.partition("\n")
    return first == f"{SEAL}{_digest(rest)}"


def _stated(axes: Axes) -> str:
    """As TOML has them."""
    words = axes.declared
    return quoted(words) if isinstance(words, str) else f"[{', '.join(map(quoted, words))}]"


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:16]


def _controls(foils: Sequence[Foil], middle: float, nothing: float) -> str:
    """The fins that were found, and comments of a control for each way that those of the tail stand."""
    if not foils:
        return "# No fin was found, so nothing can turn.\n"
    lines = [
        "# Fins that were found, as parts of a [[control]]: x of the quarter chord of the root, its chord, exposed span, m."
    ]
    lines += [
        f"#   {f.name}: x = {f.root[0]:.4g}, chord {f.root_chord:.3g}, span {f.span:.3g}, {_where_on_hull(f)}"
        for f in foils
    ]
    for name, (way, axis, sense) in CONTROLS.items():
        tail = [f for f in foils if f.root[0] < middle]
        mine, oblique = ([f for f in tail if _where_on_hull(f) == w] for w in (way, "oblique"))
        groups = ([(mine, axis)] if mine else []) + [([f], _along_span(f, name)) for f in oblique]
        for k, (fins, hinge) in enumerate(groups):
            lines += _control(name, fins, hinge, sense, nothing, first=k == 0)
    return "\n".join(lines) + "\n"


def _control(name: str, fins: Sequence[Foil], axis: str, sense: str, nothing: float, *, first: bool) -> list[str]:
    """Comments of one ``[[control]]``."""
    at = np.mean([(f.root[0] - 0.25 * f.root_chord, *f.stand) for f in fins], axis=0)
    what = "A rudder" if name == "dr" else "Stern planes"
    return [
        "#",
        *([f"# {what}: take the # away and state hinge and limit; rate may stay a comment."] if first else []),
        "# [[control]]",
        f'# name = "{name}"',
        f"# parts = [{', '.join(quoted(f.name) for f in fins)}]",
        f"# hinge = {_point(at, nothing)}  # m, a point on the hinge; here half of the root chord",
        f"# axis = {axis}  # {sense}",
        '# limit = "LIMIT deg"',
        '# rate = "RATE deg/s"  # without one the angle is there at once',
    ]


def _along_span(foil: Foil, control: str) -> str:
    """The hinge of an oblique fin: its span, in the sense in which dr turns about z and ds about y."""
    way = (foil.tip - foil.root)[1:] / foil.span
    y, z = way * np.sign(way[1 if control == "dr" else 0])
    return f"[0.0, {y:.5g}, {z:.5g}]"


def _where_on_hull(foil: Foil) -> str:
    across, rise = np.abs((foil.tip - foil.root)[1:])
    return "upright" if rise > UPRIGHT * across else "level" if across > UPRIGHT * rise else "oblique"


def _axis(foils: Sequence[Foil], low: Array, high: Array) -> Array:
    """Y and z of what the fins stand on, else of the middle."""
    middle = (low + high)[1:] / 2.0
    return np.mean([f.stand for f in foils], axis=0) if foils else middle


def _point(at: Array, nothing: float) -> str:
    return f"[{', '.join(f'{x:.5g}' if abs(x) > nothing else '0' for x in map(float, at))}]"
