"""Volume of the plain shapes of a link's collisions, from which gz-sim computes buoyancy."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element

from coeflab.core.xml import numbers


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
