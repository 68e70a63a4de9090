"""Meshes of a towed body by snappyHexMesh: the case and its job. What became of it is judged in `coeflab.tank.openfoam.mesh_report`."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.files import write_all
from coeflab.core.types import Array
from coeflab.tank.jobs import Job, Step
from coeflab.tank.openfoam import rendered, step
from coeflab.tank.openfoam.cell_count import BETWEEN_LEVELS, cell_count
from coeflab.tank.openfoam.features import features, foils
from coeflab.tank.openfoam.layers import GROWTH, LAST_LAYER, LEAST_LAYER
from coeflab.tank.openfoam.mesh_report import GEOMETRY, MESH_FILE, PLANNED
from coeflab.tank.openfoam.mesh_sizes import MOST_CELLS, MeshKeys, MeshSizes, mesh_sizes
from coeflab.tank.openfoam.mirroring import SYMMETRY_AXIS, images, mirrored_axes
from coeflab.tank.tank import Grid, Tank
from coeflab.tank.test_matrix import Half

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

FAR, CUT = "far", "cut"  # patches beside those of the body; the cut is a symmetryPlane
WITHOUT_VALUES = ("controlDict", "fvSchemes", "fvSolution", "meshQualityDict")
SIDES = {
    ("x", 0): "(0 4 7 3)",
    ("x", 1): "(1 2 6 5)",
    ("y", 0): "(0 1 5 4)",
    ("y", 1): "(3 7 6 2)",
    ("z", 0): "(0 3 2 1)",
    ("z", 1): "(4 5 6 7)",
}
CUT_SIDE = {Half.PORT: ("y", 1), Half.UPPER: ("z", 1)}
AFTER_MIRROR = ("mirrorMesh", "topoSet", "createPatch")
DIGITS = 9  # of the points of an edge, a nanometre
THIN = 10  # more layers than that are too thin for the usual limits of quality
# Of OpenFOAM 1912, measured on meshes of 20,000 to 600,000 cells; the last steps have one core only.
SECONDS_AT_LEAST, SECONDS_A_CELL, SECONDS_A_FACE, SPEEDUP, SECONDS_ALONE = 1.0, 1.25e-4, 6.5e-4, 0.6, 1.5e-5
BYTES_AT_LEAST, BYTES_A_CELL = 80e6, 1750.0
HULL_COVERAGE, FOIL_COVERAGE = 0.95, 0.9  # share of a patch that layers have to cover


def mesh_name(grid: Grid, half: Half, controls: Mapping[str, float], domain: float = 1.0) -> str:
    """Name of a mesh's job and, below the folder of the tow, its folder: ``mesh/medium_upper_dr+5``."""
    words = [grid.name, *([half.name.lower()] if half is not Half.WHOLE else [])]
    words += [f"{name}{np.degrees(angle):+.6g}" for name, angle in sorted(controls.items()) if angle]
    words += [f"domain{domain:.6g}"] if domain != 1.0 else []
    return "mesh/" + "_".join(words)


def mesh_job(
    tank: Tank,
    body: TowedBody,
    grid: Grid,
    half: Half,
    controls: Mapping[str, float],
    options: MeshKeys,
    folder: Path,
    version: str,
    domain: float = 1.0,
) -> Job:
    """Write the case of a mesh below the folder of the tow, and give its job; equal files are left alone.

    Parameters
    ----------
    tank : Tank
        Its speed and viscosity set the layers, its cores share the work.
    body : TowedBody
        With its controls at the angles of ``controls``.
    grid : Grid
    half : Half
    controls : mapping of str to float
        rad; they name the mesh.
    options : MeshKeys
    folder : Path
        Of the tow.
    version : str
        Of OpenFOAM; part of the key.
    domain : float
        Factor on the distances to the ends of the domain.

    Returns
    -------
    Job
        Polyhedral mesh in ``constant/polyMesh``, patches of the body, ``far`` and, of a half, ``cut``.

    Raises
    ------
    InputError
        The body reaches through the end of the domain, or the mesh would have too many cells.
    """
    mirrored = mirrored_axes(body, half)
    sizes = mesh_sizes(body, grid.size, half, options, tank.conditions, domain, mirrored)
    count = cell_count(body, sizes)
    if (cells := count.cells * 2.0 ** len(mirrored)) > options.most_cells:
        raise InputError(
            f"a mesh of about {cells:.2g} cells for the grid {grid.name}",
            f"{options.most_cells:.2g} at most",
            key="most_cells",
            advice="Choose fewer cells_per_chord or cells_per_length, a larger grid, or raise most_cells.",
        )
    name, cores = mesh_name(grid, half, controls, domain), tank.cores
    shared = (SECONDS_A_CELL * count.cells + SECONDS_A_FACE * count.faces) / cores**SPEEDUP
    twins = images(body, half, mirrored)
    contents = _files(body, sizes, half, twins, cores)
    planned = {"cells": round(cells), **_geometry(body, half)}
    planned["layers"] = {patch: result.count for patch, result in sizes.layers.items()}
    planned["images"] = {image: patch for pairs in twins.values() for patch, image in pairs}
    planned["coverage"] = {
        patch: options.coverage or (FOIL_COVERAGE if patch in foils(body) else HULL_COVERAGE) for patch in sizes.layers
    }
    place = (folder / name).resolve()
    write_all(place, {**contents, PLANNED: json.dumps(planned, indent=1).encode() + b"\n"})
    return Job(
        name=name,
        folder=place,
        solver="openfoam",
        steps=_steps(twins, cores),
        cores=cores,
        memory=BYTES_AT_LEAST * cores + BYTES_A_CELL * cells,
        seconds=SECONDS_AT_LEAST + shared + SECONDS_ALONE * cells,
        key=_key(contents, version),
        cells=float(cells),
    )


Twins = Mapping[int, tuple[tuple[str, str], ...]]  # see `images`


def _files(body: TowedBody, sizes: MeshSizes, half: Half, twins: Twins, cores: int) -> dict[str, bytes]:
    from coeflab.tank.towed_body import stl

    whole = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    planes = {CUT_SIDE[half]: CUT} if half is not Half.WHOLE else {}
    planes |= {("xyz"[axis], 1): f"mirror_{'xyz'[axis]}" for axis in twins}
    boundary = [{"name": FAR, "type": "patch", "faces": [face for side, face in SIDES.items() if side not in planes]}]
    boundary += [{"name": name, "type": "symmetryPlane", "faces": [SIDES[side]]} for side, name in planes.items()]
    values: dict[str, Any] = {
        "corners": np.where(whole, sizes.high, sizes.low),
        "counts": sizes.counts,
        "boundary": boundary,
        "levels": sizes.levels,
        "surface_level": min(sizes.levels.values()),
        "regions": sizes.regions,
        "layers": sizes.layers,
        "features": features(body, sizes.low, sizes.high),
        "growth": GROWTH,
        "last_layer": LAST_LAYER,
        "least_layer": LEAST_LAYER,
        "inside": sizes.inside,
        "between_levels": BETWEEN_LEVELS,
        "most_cells": round(2.0 * MOST_CELLS),  # a tow is refused before, by the cells expected
        "cores": cores,
        "thin_layers": any(result.count > THIN for result in sizes.layers.values()),
    }
    names = ("blockMeshDict", "snappyHexMeshDict", *WITHOUT_VALUES, *(("decomposeParDict",) if cores > 1 else ()))
    contents = {f"system/{name}": rendered(f"mesh/{name}", **values) for name in names}
    for axis, pairs in twins.items():
        normal = np.eye(3)[axis]
        low = np.where(normal > 0.0, 0.0, -1e9)
        for what in AFTER_MIRROR:
            if what == "topoSet" and not pairs:
                continue
            name = f"{what}Dict_{'xyz'[axis]}"
            contents[f"system/{name}"] = rendered(f"mesh/{what}Dict", name=name, normal=normal, pairs=pairs, low=low)
    for patch, ends in values["features"].items():
        points, pieces = _joined(ends)
        name = f"{patch}.eMesh"
        contents[f"{GEOMETRY}/{name}"] = rendered("mesh/edges.eMesh", name=name, points=points, ends=pieces)
    return contents | {f"{GEOMETRY}/body.stl": stl(body)}


def _joined(ends: Array) -> tuple[Array, NDArray[np.int64]]:
    """Points of edges (n, 2, 3), each once, and the ends of each edge among them; without those of no length."""
    points, index = np.unique(np.round(ends.reshape(-1, 3), DIGITS), axis=0, return_inverse=True)
    pieces = index.reshape(-1, 2).astype(np.int64)
    pieces = pieces[pieces[:, 0] != pieces[:, 1]]
    return points, np.unique(np.sort(pieces, axis=1), axis=0)


def _steps(twins: Twins, cores: int) -> tuple[Step, ...]:
    processors = [f"processor{k}" for k in range(cores)]
    clean = Step("clean", ("rm", "-rf", "constant/polyMesh", MESH_FILE, *processors))
    whole = [
        _with_dict(what, "xyz"[axis]) for axis, pairs in twins.items() for what in AFTER_MIRROR
        if pairs or what != "topoSet"
    ]  # fmt: skip
    last = (*whole, step("renumberMesh", "renumberMesh", "-overwrite"), step("checkMesh", "checkMesh"))
    if cores == 1:
        return (clean, step("blockMesh", "blockMesh"), step("snappyHexMesh", "snappyHexMesh", "-overwrite"), *last)
    return (
        clean,
        step("blockMesh", "blockMesh"),
        step("decomposePar", "decomposePar", "-force"),
        step("snappyHexMesh", "snappyHexMesh", "-overwrite", cores=cores),
        step("reconstructParMesh", "reconstructParMesh", "-constant", "-mergeTol", "1e-6"),
        Step("cleanProcessors", ("rm", "-rf", *processors)),
        *last,
    )


def _with_dict(tool: str, axis: str) -> Step:
    last = () if tool == "topoSet" else ("-overwrite",)
    return step(f"{tool}_{axis}", tool, "-dict", f"system/{tool}Dict_{axis}", *last)


def _key(contents: Mapping[str, bytes], version: str) -> str:
    """Of everything but how the work is shared among cores."""
    digest = hashlib.sha256(f"OpenFOAM {version}\n".encode())
    for name in sorted(contents):
        if not name.endswith("decomposeParDict"):
            digest.update(f"{name} {hashlib.sha256(contents[name]).hexdigest()}\n".encode())
    return digest.hexdigest()


def _geometry(body: TowedBody, half: Half) -> dict[str, Any]:
    """Volume of the body in the domain and wetted surface of each patch."""
    corners = body.vertices[body.faces]
    normals: Array = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2.0
    here = corners.mean(1)[:, SYMMETRY_AXIS[half]] < 0.0 if half is not Half.WHOLE else np.ones(len(corners), bool)
    areas = np.bincount(body.patch[here], np.linalg.norm(normals[here], axis=1), len(body.patches))
    volume = float((corners.mean(1) * normals).sum() / 3.0)
    return {
        "volume": volume / (1.0 if half is Half.WHOLE else 2.0),
        "surface": dict(zip(body.patches, areas.tolist(), strict=True)),
    }
