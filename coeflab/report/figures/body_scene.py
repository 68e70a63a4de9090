"""A body of parts, with the mesh around it, as a binary glTF file: equal input gives equal bytes.

Format: Khronos, glTF 2.0 specification, sections 4 (binary layout in 4.4) and 3.9 (materials).
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Parts
from coeflab.core.types import Array
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.part_pictures import COLOUR_OF, POOR, form_name, is_poor, part_facets, picture_surface

Indices = NDArray[np.int64]
FLOAT, UNSIGNED, VERTICES, ELEMENTS = 5126, 5125, 34962, 34963
FILM = 0.3
# glTF has y up and looks along z: forward becomes z, up y, port x. The quaternion (x, y, z, w) of that rotation.
FROM_FRD = [0.5, -0.5, 0.5, 0.5]
AXES = "vertices FRD: x forward, y starboard, z down, from the datum; this node turns them to y up, z forward"


def body_scene(name: str, shape: Parts, mesh: TriangleMesh | None = None) -> bytes:
    """A GLB file: one named node for each part, coloured by form, and a translucent one for the mesh.

    Parameters
    ----------
    name : str
        Of the body.
    shape : Parts
    mesh : TriangleMesh, optional
        With more than 20,000 faces it is simplified for the picture.

    Notes
    -----
    Vertices are in FRD, m, from the datum; the root node turns them to glTF's axes. Nodes carry form, volume and, of poor
    stand-ins, which are dark, what is off in ``extras``, the root unit and axes. Faces have no normals, so viewers shade them flat, as glTF asks.
    """
    out = _Scene()
    kinds = dict.fromkeys((form_name(p.form), is_poor(p)) for p in shape.parts)
    material = {
        (form, poor): out.material(f"{form}{POOR if poor else ''}", COLOURS["ink" if poor else COLOUR_OF[form]], 1.0)
        for form, poor in kinds
    }
    for part in shape.parts:
        form, poor = form_name(part.form), is_poor(part)
        words: dict[str, Any] = {"form": form, "volume_m3": part.form.volume}
        if part.fit is not None:
            words |= {"class": part.fit.kind, "poor": list(part.fit.poor)}
        out.node(part.name, *_triangles(part_facets(part)), material[form, poor], words)
    if mesh is not None:
        vertices, faces = picture_surface(mesh)
        taken = {p.name for p in shape.parts}
        label = next(n for n in ("mesh", "the mesh", f"mesh of {name}") if n not in taken)
        out.node(label, vertices, faces, out.material("mesh", COLOURS["band"], FILM), {"volume_m3": mesh.volume})
    return out.file(name)


def _triangles(facets: Array) -> tuple[Array, Indices]:
    corners = facets[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, 3)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    selected = corners[area > 1e-12 * float(area.max())].reshape(-1, 3)
    vertices, index = np.unique(np.round(selected, 9), axis=0, return_inverse=True)
    return vertices, index.reshape(-1, 3)


class _Scene:
    """glTF's lists while they grow."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.lists: dict[str, list[dict[str, Any]]] = {
            k: [] for k in ("nodes", "meshes", "materials", "accessors", "bufferViews")
        }

    def _add(self, kind: str, entry: dict[str, Any]) -> int:
        self.lists[kind].append(entry)
        return len(self.lists[kind]) - 1

    def material(self, name: str, colour: str, alpha: float) -> int:
        """A matt material of a #RRGGBB colour (sRGB, which glTF wants linear)."""
        srgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
        linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
        base = [round(float(c), 6) for c in linear] + [alpha]
        entry: dict[str, Any] = {"name": name, "doubleSided": True}
        entry["pbrMetallicRoughness"] = {"baseColorFactor": base, "metallicFactor": 0.0, "roughnessFactor": 0.8}
        if alpha < 1.0:
            entry["alphaMode"] = "BLEND"
        return self._add("materials", entry)

    def _accessor(self, values: NDArray[Any], target: int, component: int, kind: str, bounds: bool) -> int:
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes, "target": target}
        self.data += values.tobytes()
        entry = {
            "bufferView": self._add("bufferViews", view),
            "componentType": component,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            entry |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        return self._add("accessors", entry)

    def node(self, name: str, vertices: Array, faces: Indices, material: int, extras: dict[str, Any]) -> None:
        """A named mesh of triangles."""
        places = self._accessor(vertices.astype("<f4"), VERTICES, FLOAT, "VEC3", True)
        index = self._accessor(faces.reshape(-1).astype("<u4"), ELEMENTS, UNSIGNED, "SCALAR", False)
        primitive = {"attributes": {"POSITION": places}, "indices": index, "material": material}
        self._add(
            "nodes",
            {"name": name, "mesh": self._add("meshes", {"name": name, "primitives": [primitive]}), "extras": extras},
        )

    def file(self, name: str) -> bytes:
        """Header, JSON chunk and binary chunk."""
        children = list(range(len(self.lists["nodes"])))
        words = {"units": "m", "axes": AXES}
        root = self._add("nodes", {"name": name, "rotation": FROM_FRD, "children": children, "extras": words})
        content = {
            "asset": {"version": "2.0", "generator": "coeflab"},
            "scene": 0,
            "scenes": [{"name": name, "nodes": [root]}],
            **self.lists,
            "buffers": [{"byteLength": len(self.data)}],
        }
        text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.data) + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
