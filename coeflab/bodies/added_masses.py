"""Added mass of a body by every method."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.bodies.added_mass import ADDED_MASS
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import computed
from coeflab.bodies.shape import Agreement, Parts
from coeflab.bodies.triangulation import Triangulation
from coeflab.core.errors import InputError
from coeflab.core.machine import one_thread
from coeflab.core.texts import input_error
from coeflab.law.added_mass import AddedMass, NearWall
from coeflab.law.water import ROUND_DENSITY

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.simplify.simplification import Simplification
    from coeflab.core.finding import Finding

DENSEST = 1e5
SHARE = 3  # digits
SILENT = 1e-3  # of the largest of its kind: a motion that moves no water
FILE = "body.toml"


def methods() -> tuple[str, ...]:
    """Every method with its presets: ``strip`` and ``strip:lamb``."""
    out = []
    for name in ADDED_MASS.usable():
        out += [name, *(f"{name}:{preset}" for preset in ADDED_MASS.load(name).presets)]
    return tuple(out)


@one_thread()
def added_masses(
    body: Body,
    density: float,
    method: str = "all",
    given: Mapping[str, Any] | None = None,
    *,
    reproducible: bool = False,
    error: str = "",
) -> Triangulation:
    """Run one method, or all that apply.

    Where parts stand for a mesh that their file names, the methods that take a surface (panel, strip) take that mesh;
    what others compute of the parts is as rough as these are stand-ins for it.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.
    method : str
        ``all``, a plugin's name, or a name with a preset.
    given : mapping, optional
        Options of the one method.
    reproducible : bool
        Take the options of each plugin that give the same numbers with and without optional packages.
    error : str
        Target of the panel method's error, such as ``2%``; empty for its panels as they are.

    Raises
    ------
    InputError
        Density not above zero, no shape, an unknown preset, or no method that applies.
    PluginError
        No plugin has that name.
    """
    if not 0.0 < density <= DENSEST:
        raise input_error("bodies.density_kg", column="density", density=density, densest=DENSEST)
    shape = body.require_shape()
    if given and method == "all":
        raise InputError(f"options {', '.join(given)} for all methods", "one --method that they are for")
    original = _original(body)
    results: list[AddedMass] = []
    refused: dict[str, str] = {}
    cited: dict[str, None] = {}
    on_mesh: list[str] = []
    for name in methods() if method == "all" else (method,):
        plugin_name, _, preset = name.partition(":")
        plugin = ADDED_MASS.load(plugin_name)
        known = plugin.presets
        if preset and preset not in known:
            raise InputError(f'the unknown preset "{preset}" of {plugin_name}', f"one of {', '.join(known) or 'none'}")
        options = dict(plugin.reproducible if reproducible else {})
        options |= {**(known[preset] if preset else {}), **(given or {})}
        options |= {"error": error} if error and hasattr(plugin.Options, "error") else {}
        subjects = [body]
        if original is not None and plugin.takes_surface:
            subjects = [original, body] if method == "all" else [original]
        for subject in subjects:
            try:
                if not plugin.takes_sheets:
                    _require_solid(subject)
                found = plugin.added_mass(subject, density, options)
            except InputError as why:
                if method != "all":
                    raise
                if not preset:
                    refused.setdefault(f"{name} on the mesh" if subject is original else name, why.found)
                continue
            if subject is original:
                on_mesh.append(found.method)
                found = replace(found, statements=(f"on the mesh {_file(body)}", *found.statements))
            elif isinstance(shape, Parts) and shape.stand_ins:
                found = _stood_in(found, shape)
            results.append(found)
            cited |= dict.fromkeys(plugin.citations)
            break
    if not results:
        raise InputError(f"no method that applies to {body.name}", f"a body for one of {', '.join(methods())}")
    if original is not None:
        parts, *printed = body.configurations
        body = replace(body, configurations=(parts, original.configurations[0], *printed))
    return Triangulation(body, density, tuple(results), refused, tuple(cited), original, tuple(on_mesh))


@one_thread()
def against_mesh(found: Simplification, density: float = ROUND_DENSITY, panels: int = 6_000) -> Simplification:
    """The added mass of the parts beside the panel method on the mesh, in six motions.

    Parameters
    ----------
    found : Simplification
    density : float
        kg/m^3.
    panels : int
        On the mesh; none: they are not compared.

    Returns
    -------
    Simplification
        With both and their agreement; as it is, with the reason, where the panel method refuses the mesh.
    """
    if found.left_as_mesh:
        return found
    if not panels:
        return replace(found, uncompared="that was not asked for")
    try:
        mesh = ADDED_MASS.load("panel").added_mass(replace(found.body, shape=found.mesh), density, {"panels": panels})
        parts = ADDED_MASS.load("primitives").added_mass(found.body, density, None)
    except InputError as why:
        return replace(found, uncompared=f"found {why.found}; expected {why.expected}")
    own, error = np.diag(mesh.matrix), np.diag(mesh.error) if mesh.error is not None else np.zeros(6)
    largest = np.repeat(own.reshape(2, 3).max(axis=1), 3)
    heard = own > np.maximum(error, SILENT * largest)
    ratios = np.round(np.diag(parts.matrix) / np.where(heard, own, 1.0) - 1.0, SHARE)
    entries = tuple(float(r) + 0.0 if h else None for r, h in zip(ratios, heard, strict=True))
    worst = None if mesh.error is None else round(float(np.max(error[heard] / own[heard], initial=0.0)), SHARE)
    shape = replace(found.shape, agreement=Agreement(entries, worst))
    return replace(found, shape=shape, body=replace(found.body, shape=shape), compared=(parts, mesh))


@one_thread()
def near_walls(
    body: Body, density: float, wall: str, distances: Sequence[float], given: Mapping[str, Any] | None = None
) -> tuple[AddedMass, ...]:
    """Added mass by the panel method far from walls and at distances from one.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.
    wall : str
        ``bottom``, ``surface_zero`` or ``surface_infinite``.
    distances : sequence of float
        From the reference point to the wall, m.
    given : mapping, optional
        Further options of the panel method.

    Returns
    -------
    tuple of AddedMass
        Far from walls, with all others as its ``walls``; then one for each distance, rising.

    Raises
    ------
    InputError
        A density not above zero, no distance or one within the body, and what the method refuses.
    """
    if not 0.0 < density <= DENSEST:
        raise input_error("bodies.density_kg_2", column="density", density=density, densest=DENSEST)
    near = wall_sweep(body, density, wall, distances, given)
    far = ADDED_MASS.load("panel").added_mass(_original(body) or body, density, dict(given or {}))
    walls = tuple(NearWall(wall, d, n.matrix) for d, n in zip(sorted(set(distances)), near, strict=True))
    return replace(far, walls=walls), *near


@one_thread()
def wall_sweep(
    body: Body, density: float, wall: str, distances: Sequence[float], given: Mapping[str, Any] | None = None
) -> tuple[AddedMass, ...]:
    """Added mass by the panel method at distances from a wall, rising; as `near_walls`.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.
    wall : str
        One of those that the panel method knows, such as ``bottom``.
    distances : sequence of float
        From the reference point to the wall, m.
    given : mapping, optional
        Further options of the panel method.

    Raises
    ------
    InputError
        No distance, or what the panel method refuses.
    """
    if not distances:
        raise InputError("no distance", "distances from the reference point to the wall, m", column="--distance")
    method, subject = ADDED_MASS.load("panel"), _original(body) or body
    options = {**(given or {}), "wall": wall}
    return tuple(method.added_mass(subject, density, {**options, "distance": d}) for d in sorted(set(distances)))


def finer(found: AddedMass, given: Mapping[str, Any]) -> Finding | None:
    """What a smaller error of a result would cost; None of a method that has no mesh to refine, or where nobody needs less.

    Parameters
    ----------
    found : AddedMass
    given : mapping
        Options of the method as they were typed.
    """
    name = found.method.partition(":")[0]
    cost = ADDED_MASS.load(name).finer if name in ADDED_MASS.names() else None
    return None if cost is None else cost(found, given)


def _require_solid(body: Body) -> None:
    """Refuse sheets of a mesh for methods that would leave them out."""
    shape = body.require_shape()
    if isinstance(shape, TriangleMesh) and len(shape.sheets):
        raise input_error("bodies.mesh_sheets_thickness")


def _original(body: Body) -> Body | None:
    """The mesh for which the parts of a body stand, as a body with the same names, datum and reference point."""
    if body.mesh is None:
        return None
    surface, words = body.mesh.read()
    return replace(body, shape=surface, mesh=None, configurations=(computed(surface, words), *body.configurations[1:]))


def _file(body: Body) -> str:
    return body.mesh.file.name if body.mesh is not None else ""


def _stood_in(found: AddedMass, shape: Parts) -> AddedMass:
    """What was computed of parts that stand for a mesh: as rough as they are."""
    words = "parts stand for a mesh" + (f", a rough guide to it: {'; '.join(shape.rough)}" if shape.rough else "")
    return replace(found, statements=(*found.statements, words), rough=found.rough or bool(shape.rough))
