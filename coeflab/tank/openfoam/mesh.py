"""Meshes of a towed body by snappyHexMesh: the case, its job, and what it became: cells, layers and quality from the logs of its
tools, the body in it from the mesh itself.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.files import write_all
from coeflab.core.types import Array, brief
from coeflab.tank.jobs import Job, Step
from coeflab.tank.openfoam import rendered, step
from coeflab.tank.openfoam.cell_count import BETWEEN_LEVELS, cell_count
from coeflab.tank.openfoam.mesh_sizes import (
    GROWTH,
    LAST_LAYER,
    MOST_CELLS,
    SYMMETRY_AXIS,
    MeshKeys,
    MeshSizes,
    mesh_sizes,
    mirrored_axes,
)
from coeflab.tank.tank import Grid, Tank
from coeflab.tank.test_matrix import Half

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

__all__ = ["CUT", "FAR", "expected_cells", "mesh_ended", "mesh_job", "mesh_name"]

FAR, CUT = "far", "cut"  # patches beside those of the body; the cut is a symmetryPlane
GEOMETRY = "constant/triSurface"
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
SEED_DISTANCE = 4.0  # in cells of the patch
THIN = 10  # more layers than that are too thin for the usual limits of quality
# Of OpenFOAM 1912, measured on meshes of 20,000 to 600,000 cells; the last steps have one core only.
SECONDS_AT_LEAST, SECONDS_A_CELL, SECONDS_A_FACE, SPEEDUP, SECONDS_ALONE = 1.0, 1.25e-4, 6.5e-4, 0.6, 1.5e-5
BYTES_AT_LEAST, BYTES_A_CELL = 80e6, 1750.0
MADE, PLANNED = "mesh.json", "planned.json"
# What checkMesh marks and no solver can use; what else it marks is a remark.
UNUSABLE = ("negative", "open cells", "boundary openness", "face pyramids", "invalid face", "boundary definition")
VOLUME_WITHIN, SURFACE_WITHIN, SURFACE_LEAST = 0.1, 0.1, 0.5
NUMBER = r"[-+\d.eE]+"


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
    contents = _files(body, sizes, half, mirrored, cores)
    planned = {"cells": round(cells), "coverage": options.coverage, **_geometry(body, half)}
    planned["layers"] = {patch: made.count for patch, made in sizes.layers.items()}
    place = (folder / name).resolve()
    write_all(place, {**contents, PLANNED: json.dumps(planned, indent=1).encode() + b"\n"})
    return Job(
        name=name,
        folder=place,
        solver="openfoam",
        steps=_steps(mirrored, cores),
        cores=cores,
        memory=BYTES_AT_LEAST * cores + BYTES_A_CELL * cells,
        seconds=SECONDS_AT_LEAST + shared + SECONDS_ALONE * cells,
        key=_key(contents, version),
        cells=float(cells),
    )


def _files(body: TowedBody, sizes: MeshSizes, half: Half, mirrored: tuple[int, ...], cores: int) -> dict[str, bytes]:
    from coeflab.tank.towed_body import stl

    whole = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    planes = {CUT_SIDE[half]: CUT} if half is not Half.WHOLE else {}
    planes |= {("xyz"[axis], 1): f"mirror_{'xyz'[axis]}" for axis in mirrored}
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
        "growth": GROWTH,
        "last_layer": LAST_LAYER,
        "inside": sizes.inside,
        "between_levels": BETWEEN_LEVELS,
        "most_cells": round(2.0 * MOST_CELLS),  # a tow is refused before, by the cells expected
        "cores": cores,
        "thin_layers": any(made.count > THIN for made in sizes.layers.values()),
    }
    names = ("blockMeshDict", "snappyHexMeshDict", *WITHOUT_VALUES, *(("decomposeParDict",) if cores > 1 else ()))
    contents = {f"system/{name}": rendered(f"mesh/{name}", **values) for name in names}
    for axis in mirrored:
        name = _mirror_dict(axis)
        contents[name] = rendered("mesh/mirrorMeshDict", name=Path(name).name, normal=np.eye(3)[axis])
    if mirrored:
        contents["system/createPatchDict"] = rendered("mesh/createPatchDict")
    for patch in body.patches:
        name = f"{patch}.eMesh"
        contents[f"{GEOMETRY}/{name}"] = rendered("mesh/seeds.eMesh", name=name, points=_seeds(body, patch, sizes))
    return contents | {f"{GEOMETRY}/body.stl": stl(body)}


def _mirror_dict(axis: int) -> str:
    return f"system/mirrorMeshDict_{'xyz'[axis]}"


def _seeds(body: TowedBody, patch: str, sizes: MeshSizes) -> Array:
    """Ends of an edge of one triangle in every few cells, (2 n, 3): what lies in the domain."""
    ends = body.vertices[body.faces[body.patch == body.patches.index(patch)][:, :2]]
    ends = ends[np.all((ends > sizes.low) & (ends < sizes.high), axis=(1, 2))]
    places = np.floor(ends.mean(1) / (SEED_DISTANCE * sizes.edge(patch))).astype(int)
    _, first = np.unique(places, axis=0, return_index=True)
    seeds: Array = ends[np.sort(first)].reshape(-1, 3)
    return seeds


def _steps(mirrored: tuple[int, ...], cores: int) -> tuple[Step, ...]:
    processors = [f"processor{k}" for k in range(cores)]
    clean = Step("clean", ("rm", "-rf", "constant/polyMesh", MADE, *processors))
    whole = [step(f"mirrorMesh_{'xyz'[a]}", "mirrorMesh", "-dict", _mirror_dict(a), "-overwrite") for a in mirrored]
    whole += [step("createPatch", "createPatch", "-overwrite")] if mirrored else []  # takes out the planes, now empty
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


@brief
@dataclass(frozen=True, slots=True)
class MeshMade:
    """A mesh.

    Attributes
    ----------
    cells : int
    layers : mapping of str to float
        Share of the layers asked for that stand on each patch, on average over its faces.
    surface : mapping of str to float
        Of each patch, over that of the body's surface.
    volume : float
        That the mesh leaves out, over that of the body.
    non_orthogonality, skewness : float
        The largest, deg and 1.
    marked : tuple of str
        What checkMesh marks.
    """

    cells: int
    layers: Mapping[str, float]
    surface: Mapping[str, float]
    volume: float
    non_orthogonality: float
    skewness: float
    marked: tuple[str, ...] = ()


def mesh_ended(job: Job) -> tuple[tuple[str, ...], str]:
    """Judge a mesh whose steps have ended, and keep what it became in ``mesh.json`` beside it.

    Parameters
    ----------
    job : Job
        Of a mesh.

    Returns
    -------
    remarks : tuple of str
        Few layers, a surface that the cells do not follow, cells of poor quality.
    why : str
        Why no run may use it; empty where it is sound.
    """
    planned = json.loads((job.folder / PLANNED).read_text())
    try:
        made = _read(job.folder, planned)
    except FileNotFoundError as why:
        return (), f"no mesh was made: {Path(why.filename).relative_to(job.folder)} is missing"
    except (ValueError, IndexError) as why:
        return (), f"the mesh cannot be read: {why}"
    write_all(job.folder, {MADE: (json.dumps(asdict(made), indent=1) + "\n").encode()})
    return tuple(_remarks(made, planned)), next(_faults(made), "")


def mesh_made(folder: Path) -> MeshMade | None:
    """The mesh in a folder as its job left it; None before it is made."""
    if not (folder / MADE).is_file():
        return None
    kept = json.loads((folder / MADE).read_text())
    tables = {name: MappingProxyType(kept[name]) for name in ("layers", "surface")}
    return MeshMade(**(kept | tables | {"marked": tuple(kept["marked"])}))


def expected_cells(folder: Path) -> float:
    """Cells of the mesh in a folder: counted once it is made, expected before."""
    made = mesh_made(folder)
    return float(made.cells if made else json.loads((folder / PLANNED).read_text())["cells"])


def _read(folder: Path, planned: Mapping[str, Any]) -> MeshMade:
    checked = (folder / "log.checkMesh").read_text(errors="replace")
    surface, volume = _body_in_mesh(folder / "constant" / "polyMesh", list(planned["surface"]))
    asked = {patch: count for patch, count in planned["layers"].items() if planned["surface"][patch] > 0.0}
    snapped = (folder / "log.snappyHexMesh").read_text(errors="replace")
    return MeshMade(
        cells=int(_after("cells:", checked)),
        layers=dict.fromkeys(asked, 0.0) | {p: mean / asked[p] for p, mean in _layers(snapped) if p in asked},
        surface={name: surface[name] / area for name, area in planned["surface"].items() if area > 0.0},
        volume=volume / planned["volume"],
        non_orthogonality=_after("Mesh non-orthogonality Max:", checked),
        skewness=_after("Max skewness =", checked),
        marked=tuple(" ".join(line.split()) for line in re.findall(r"^ *\*{3}(.*)$", checked, re.MULTILINE)),
    )


def _after(words: str, log: str) -> float:
    found = re.search(rf"{re.escape(words)}\s*({NUMBER})", log)
    if not found:
        raise ValueError(f'log.checkMesh does not say "{words}"')
    return float(found[1].rstrip(","))


def _layers(log: str) -> Iterator[tuple[str, float]]:
    """Mean number of layers on each patch: the last table of snappyHexMesh."""
    table = log.rpartition("overall thickness")[2].partition("\n\n")[0] if "overall thickness" in log else ""
    for patch, mean in re.findall(rf"^(\S+)\s+\d+\s+({NUMBER})\s+{NUMBER}\s+{NUMBER}\s*$", table, re.MULTILINE):
        yield patch, float(mean)


def _remarks(made: MeshMade, planned: Mapping[str, Any]) -> Iterator[str]:
    few = {patch: share for patch, share in made.layers.items() if share < planned["coverage"]}
    if few:
        words = ", ".join(f"{share:.0%} of {patch}" for patch, share in few.items())
        yield f"layers cover {words}; {planned['coverage']:.0%} is asked for"
    for patch, share in made.surface.items():
        if abs(share - 1.0) > SURFACE_WITHIN:
            yield f"{patch} has {share:.0%} of its surface: its cells are too large for its shape"
    yield from (f"checkMesh: {line}" for line in made.marked if not _unusable(line))


def _faults(made: MeshMade) -> Iterator[str]:
    for patch, share in made.surface.items():
        if share == 0.0:
            yield f"no cell lies on the patch {patch}: its cells are too large for its shape"
        elif not SURFACE_LEAST < share < 1.0 / SURFACE_LEAST:
            yield f"the patch {patch} has {share:.0%} of its surface"
    if abs(made.volume - 1.0) > VOLUME_WITHIN:
        yield f"the mesh leaves out {made.volume:.0%} of the body's volume: water got in, or cells are too large"
    yield from (f"checkMesh: {line}" for line in made.marked if _unusable(line))


def _unusable(line: str) -> bool:
    return any(words in line.lower() for words in UNUSABLE)


def _body_in_mesh(folder: Path, patches: list[str]) -> tuple[dict[str, float], float]:
    """Surface of each patch, m^2, and the volume that all of them enclose with a cut through the origin, m^3."""
    ranges = _ranges((folder / "boundary").read_text())
    points, (starts, corners) = _binary(folder / "points", 3)[0], _binary(folder / "faces", 0)
    surface, volume = {}, 0.0
    for patch in patches:
        count, start = ranges.get(patch, (0, 0))
        bounds = starts[start : start + count + 1]
        area = np.zeros((count, 3))
        for triangles, face in _fans(points, corners, bounds):
            across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2.0
            area[face] += across
            volume -= float((triangles.mean(1) * across).sum() / 3.0)  # faces look into the body
        surface[patch] = float(np.linalg.norm(area, axis=1).sum())
    return surface, volume


def _fans(points: Array, corners: NDArray[Any], bounds: NDArray[Any]) -> Iterator[tuple[Array, NDArray[Any]]]:
    """Triangles of each face from its first corner, by the number of corners; and the faces that they belong to."""
    sizes = np.diff(bounds)
    for size in np.unique(sizes):
        face = np.flatnonzero(sizes == size)
        ring = points[corners[bounds[face][:, None] + np.arange(size)]]
        for k in range(1, size - 1):
            yield ring[:, [0, k, k + 1]], face


def _ranges(boundary: str) -> dict[str, tuple[int, int]]:
    """Number of faces and first face of each patch."""
    found = re.findall(r"(\S+)\s*\{[^{}]*?nFaces\s+(\d+);\s*startFace\s+(\d+);[^{}]*\}", boundary)
    return {name: (int(count), int(start)) for name, count, start in found}


def _binary(path: Path, width: int) -> list[NDArray[Any]]:
    """Lists of a binary file of OpenFOAM: one of (n, width) scalars, or with a width of 0 two of labels.

    Raises
    ------
    ValueError
        The file is not binary, or ends early.
    """
    content = path.read_bytes()
    arch = re.search(rb'arch\s+"LSB;label=(32|64);scalar=(32|64)"', content[:4096])
    if not arch or not re.search(rb"format\s+binary", content[:4096]):
        raise ValueError(f"{path.name} is not binary, least significant byte first")
    kind = np.dtype(f"<f{int(arch[2]) // 8}" if width else f"<i{int(arch[1]) // 8}")
    lists, place = [], content.index(b"}") + 1
    for _ in range(1 if width else 2):
        head = re.compile(rb"(?:\s|//[^\n]*\n)*(\d+)\s*\(").match(content, place)
        if not head:
            raise ValueError(f"{path.name} holds no list")
        size = int(head[1]) * max(width, 1)
        values = np.frombuffer(content, kind, size, head.end())
        lists.append(values.reshape(-1, width) if width else values)
        place = head.end() + values.nbytes + 1
    return lists
