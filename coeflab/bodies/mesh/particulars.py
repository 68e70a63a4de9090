"""What a shape says of its body: particulars computed from a mesh, a size that a vehicle may have, whether it is a vehicle's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from coeflab.bodies.body import Body, Configuration
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mirror_planes import silhouettes
from coeflab.core.errors import InputError
from coeflab.core.units import factor

BY_MESH = "by_mesh"
SHORTEST, LONGEST = 0.05, 500.0  # m: from the smallest towed model to the largest ship; beyond, the unit is wrong
UNITS = ("mm", "m", "cm", "ft", "in")
NEAR = 0.05  # of a stated length: the unit is right
SAME_VOLUME, SAME_SURFACE = 0.01, 0.03  # printed particulars of one model; sail and planes of a submarine are more


def computed(shape: TriangleMesh, statements: tuple[str, ...]) -> Configuration:
    """Volume, centre, areas and second moments of the facets, with what was done to the mesh in words."""
    return Configuration(
        name=BY_MESH,
        title="; ".join((f"integrals over {len(shape.faces)} faces", *statements)),
        volume=shape.volume,
        wetted_surface=shape.integrals.area,
        centre_of_buoyancy=shape.centre_of_volume,
        mass=None,
        projected_areas=silhouettes(shape),
        second_moments=shape.integrals.second_moments,
    )


def mesh_statements(body: Body) -> tuple[str, ...]:
    """What was done to the mesh of a body as it was read, such as ``repaired: 5 shells united``; empty of other bodies."""
    own = body.configuration(BY_MESH)
    return () if own is None else tuple(own.title.split("; ")[1:])


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


@dataclass(frozen=True, slots=True)
class Likeness:
    """Whether a shape is that of a vehicle.

    Attributes
    ----------
    same : bool or None
        None where nothing but their names can be compared, and these differ.
    words : str
        What was compared.
    """

    same: bool | None
    words: str


def likeness(hull: Body, vehicle: str, stated: Configuration | None, own_file: bool = False) -> Likeness:
    """Compare a shape with the vehicle that it is to stand for.

    A body that bears the vehicle's name, or whose file has a configuration of that name, is the vehicle unless both its
    volume and its wetted surface say otherwise. A body of another name is the vehicle where both are known and agree.

    Parameters
    ----------
    hull : Body
        With a shape; its first configuration is computed from it.
    vehicle : str
    stated : Configuration or None
        Of the vehicle, from its particulars.
    own_file : bool
        The particulars stand in the hull's own file, which then describes one vehicle.
    """
    named = hull.name == vehicle or hull.configuration(vehicle) is not None
    if (named and own_file) or stated is None:
        return Likeness(
            True if named else None, f"the body of {vehicle}" if named else "no particulars to compare with"
        )
    own = next(iter(hull.configurations), None)
    apart, words = [], []
    for what, unit, limit in (("volume", "m^3", SAME_VOLUME), ("wetted_surface", "m^2", SAME_SURFACE)):
        ours, theirs = getattr(own, what, None), getattr(stated, what)
        if ours and theirs:
            share = ours / theirs - 1.0
            apart.append(abs(share) > limit)
            words.append(
                f"{what.replace('_', ' ')} {ours:.4g} against {theirs:.4g} {unit} ({share:+.1%}, limit {limit:.0%})"
            )
    phrases = ", ".join(words) or "neither volume nor wetted surface to compare"
    if len(apart) == 2:
        return Likeness(not (all(apart) if named else any(apart)), phrases)
    return Likeness(True if named else False if any(apart) else None, phrases)
