"""What a mesh says of its body: the particulars computed from it, and a size that a vehicle may have."""

from __future__ import annotations

from collections.abc import Callable

from coeflab.bodies.body import Configuration
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.errors import InputError
from coeflab.core.units import factor

SHORTEST, LONGEST = 0.05, 500.0  # m: from the smallest towed model to the largest ship; beyond, the unit is wrong
UNITS = ("mm", "m", "cm", "ft", "in")
NEAR = 0.05  # of a stated length: the unit is right


def computed(shape: TriangleMesh, statements: tuple[str, ...]) -> Configuration:
    """Volume, centre, areas and second moments of the facets, with what was done to the mesh in words."""
    return Configuration(
        name="by_mesh",
        title="; ".join((f"integrals over {len(shape.faces)} faces", *statements)),
        volume=shape.volume,
        wetted_surface=shape.integrals.area,
        centre_of_buoyancy=shape.centre_of_volume,
        mass=None,
        projected_areas=shape.integrals.projected,
        second_moments=shape.integrals.second_moments,
    )


def likely_unit(numbers: float, length: float | None) -> str:
    """The unit in which the file's numbers give the stated length, or a plausible one."""
    for name in UNITS:
        found = numbers * factor(name, "length")
        if abs(found / length - 1.0) <= NEAR if length else 2.0 * SHORTEST <= found <= 0.4 * LONGEST:
            return f'Is the unit "{name}"? The body would be {found:.4g} m long.'
    return "Is the unit right?"


def require_plausible(mesh: TriangleMesh, unit: float, fail: Callable[[str, str, str], InputError]) -> None:
    """Hold the largest size of a body of no stated length against what vehicles have.

    Parameters
    ----------
    mesh : TriangleMesh
    unit : float
        Of its file, m.
    fail : callable
        The error of what was found, what was expected and the advice.

    Raises
    ------
    InputError
        Shorter than 0.05 m or longer than 500 m.
    """
    largest = float(mesh.extents.max())
    if not SHORTEST <= largest <= LONGEST:
        expected = f"{SHORTEST:g} to {LONGEST:g} m, or another length stated under [particulars] in a body.toml"
        raise fail(f"a body {largest:.6g} m in size", expected, likely_unit(largest / unit, None))
