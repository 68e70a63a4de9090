"""What a mesh became: cells, layers and quality from the logs of its tools, the body in it from the mesh itself."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.files import write_all
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import FOAM_BYTES, MESH_BYTES
from coeflab.core.text.bounded import leading_bytes, log_text
from coeflab.core.text.records import read_record
from coeflab.core.texts import remark
from coeflab.core.types import Array, brief
from coeflab.tank.jobs import ANEW, Job

GEOMETRY = "constant/triSurface"
MESH_FILE, PLANNED = "mesh.json", "planned.json"
# What checkMesh marks and no solver can use; what else it marks is a remark.
UNUSABLE = ("negative", "open cells", "boundary openness", "face pyramids", "invalid face", "boundary definition")
SKEW = re.compile(r"Max skewness = (\S+?),? (\d+) highly skew faces")
VOLUME_WITHIN, SURFACE_WITHIN, SURFACE_LEAST = 0.1, 0.02, 0.5
FEW_LAYERS = 2
NUMBER = r"[-+\d.eE]+"


@brief
@dataclass(frozen=True, slots=True)
class MeshReport:
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


_BY_PATCH = {str: float}
_PLANNED = {
    "cells": float,
    "volume": float,
    "surface": _BY_PATCH,
    "layers": _BY_PATCH,
    "coverage?": _BY_PATCH,
    "images?": {str: str},
}
_MESH_KEYS = {
    "cells": int, "layers": _BY_PATCH, "surface": _BY_PATCH, "volume": float, "non_orthogonality": float, "skewness": float,
    "marked": [str],
}  # fmt: skip


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
    planned = read_record(job.folder / PLANNED, _PLANNED, "what was planned of a mesh", advice=ANEW)
    try:
        result = _read(job.folder, planned)
    except FileNotFoundError as why:
        return (), f"no mesh was made: {Path(why.filename).relative_to(job.folder)} is missing"
    except (ValueError, IndexError) as why:
        return (), f"the mesh cannot be read: {why}"
    write_all(job.folder, {MESH_FILE: (json.dumps(asdict(result), indent=1) + "\n").encode()})
    return tuple(map(remark, findings(result, planned))), next(_faults(result), "")


def mesh_report(folder: Path) -> MeshReport | None:
    """The mesh in a folder as its job left it; None before it is made."""
    if not (folder / MESH_FILE).is_file():
        return None
    selected = read_record(folder / MESH_FILE, _MESH_KEYS, "what a mesh became", advice=ANEW)
    selected = {f.name: selected[f.name] for f in fields(MeshReport)}
    tables = {name: MappingProxyType(selected[name]) for name in ("layers", "surface")}
    return MeshReport(**(selected | tables | {"marked": tuple(selected["marked"])}))


def expected_cells(folder: Path) -> float:
    """Cells of the mesh in a folder: counted once it is made, expected before."""
    result = mesh_report(folder)
    if result:
        return float(result.cells)
    return float(read_record(folder / PLANNED, _PLANNED, "what was planned of a mesh", advice=ANEW)["cells"])


def _read(folder: Path, planned: Mapping[str, Any]) -> MeshReport:
    checked = log_text(folder / "log.checkMesh")
    surface, volume = _body_in_mesh(folder / "constant" / "polyMesh", list(planned["surface"]))
    asked = {patch: count for patch, count in planned["layers"].items() if planned["surface"][patch] > 0.0}
    snapped = log_text(folder / "log.snappyHexMesh")
    layers = dict.fromkeys(asked, 0.0) | {p: mean / asked[p] for p, mean in _layers(snapped) if p in asked}
    for image, patch in planned.get("images", {}).items():  # made by mirroring, of which snappyHexMesh knows nothing
        layers |= {image: layers[patch]} if image in layers and patch in layers else {}
    return MeshReport(
        cells=int(_after("cells:", checked)),
        layers=layers,
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


def findings(mesh: MeshReport, planned: Mapping[str, Any]) -> tuple[Finding, ...]:
    """What is to be known of a mesh that is used.

    Parameters
    ----------
    mesh : MeshMade
    planned : mapping
        What ``planned.json`` holds.
    """
    return tuple(_findings(mesh, planned))


def _findings(mesh: MeshReport, planned: Mapping[str, Any]) -> Iterator[Finding]:
    for patch, share in mesh.layers.items():
        if share < (wanted := planned["coverage"][patch]):
            yield Finding.of("tow.layers", patch, Severity.WARN, statistic=share, threshold=wanted)
        if (count := planned["layers"][patch]) <= FEW_LAYERS:
            yield Finding.of("tow.few_layers", patch, Severity.NOTE, statistic=float(count), threshold=FEW_LAYERS + 1.0)
    for patch, share in mesh.surface.items():
        if abs(share - 1.0) > SURFACE_WITHIN:
            yield Finding.of(
                "tow.surface", patch, Severity.WARN, statistic=share, threshold=SURFACE_WITHIN,
                advice=f"cells.{patch}",
            )  # fmt: skip
    for line in mesh.marked:
        skew = SKEW.search(line)
        if skew:
            yield Finding.of(
                "tow.skew", "mesh", Severity.WARN, statistic=float(skew[1]), threshold=4.0, faces=int(skew[2])
            )
        elif not _unusable(line):
            yield Finding.of("tow.check_mesh", "mesh", Severity.NOTE, line=line)


def _faults(mesh: MeshReport) -> Iterator[str]:
    for patch, share in mesh.surface.items():
        if share == 0.0:
            yield f"no cell lies on the patch {patch}: its cells are too large for its shape"
        elif not SURFACE_LEAST < share < 1.0 / SURFACE_LEAST:
            yield f"the patch {patch} has {share:.0%} of its surface"
    if abs(mesh.volume - 1.0) > VOLUME_WITHIN:
        yield f"the mesh leaves out {mesh.volume:.0%} of the body's volume: water got in, or cells are too large"
    yield from (f"checkMesh: {line}" for line in mesh.marked if _unusable(line))


def _unusable(line: str) -> bool:
    return any(words in line.lower() for words in UNUSABLE)


def _body_in_mesh(folder: Path, patches: list[str]) -> tuple[dict[str, float], float]:
    """Surface of each patch, m^2, and the volume that all of them enclose with a cut through the origin, m^3."""
    ranges = _ranges(leading_bytes(folder / "boundary", FOAM_BYTES).decode())
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
    content = leading_bytes(path, MESH_BYTES)
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
