"""What a GLB says of itself, held against its size before anything is loaded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.json import parse_json
from coeflab.core.limits import GLB_DEEPEST, GLB_NODES, JSON_BYTES

COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
PACKED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization")
TRIANGLES = 4


def glb_faces(path: Path) -> int:
    """Triangles of a GLB, over all of its placed meshes.

    Raises
    ------
    InputError
        Not a GLB of version 2, cut short, compressed, with its data in other files, with more data promised than the
        file holds, or with nodes that are no tree.
    """
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(20)
        words = [int.from_bytes(head[k : k + 4], "little") for k in range(0, 20, 4)]
        if len(head) < 20 or head[:4] != b"glTF":
            raise InputError(shown(head[:4].decode("latin-1")), 'a GLB, which begins with "glTF"', file=path)
        if words[1] != 2 or head[16:20] != b"JSON":
            found = f"version {words[1]}" if words[1] != 2 else "no description behind the header"
            raise InputError(found, "a GLB of version 2 that begins with its description", file=path)
        if words[2] != size or words[3] > min(size - 20, JSON_BYTES):
            raise InputError(
                f"{size} bytes behind a header that counts {words[2]}, {words[3]} of them description",
                "a whole GLB",
                file=path,
                advice="Export it again, or copy it again: it may have been cut short.",
            )
        described = stream.read(words[3])
        stored = int.from_bytes(stream.read(8)[:4], "little")
    try:
        return _faces(parse_json(described.decode("utf-8"), path, "a whole GLB"), stored, path)
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError) as why:
        raise InputError(f"a broken description ({type(why).__name__})", "a whole GLB", file=path) from None


def _faces(scene: dict[str, Any], stored: int, path: Path) -> int:
    packed = [e for e in scene.get("extensionsRequired", []) if e in PACKED]
    if packed or any("uri" in b for b in scene.get("buffers", [])):
        what = f"the extension {packed[0]}" if packed else "data in another file"
        raise InputError(
            what, "a plain GLB that holds all of its data", file=path, advice="Export it without compression."
        )
    views, accessors = scene.get("bufferViews", []), scene.get("accessors", [])
    for a in accessors:
        view = views[a["bufferView"]]
        need = int(a["count"]) * COMPONENT_BYTES[a["componentType"]] * COMPONENTS[a["type"]]
        end = int(view.get("byteOffset", 0)) + int(view["byteLength"])
        if need + int(a.get("byteOffset", 0)) > int(view["byteLength"]) or end > stored:
            raise InputError(f"{a['count']} values that the file does not hold", "a whole GLB", file=path)
    nodes = scene.get("nodes", [])
    _require_tree(nodes, path)
    per_mesh = []
    for mesh in scene.get("meshes", []):
        solid = [p for p in mesh["primitives"] if p.get("mode", TRIANGLES) == TRIANGLES]
        per_mesh.append(sum(accessors[p.get("indices", p["attributes"]["POSITION"])]["count"] // 3 for p in solid))
    return sum(per_mesh[n["mesh"]] for n in nodes if "mesh" in n)


def _require_tree(nodes: list[Any], path: Path) -> None:
    """No node has two parents or is its own ancestor."""
    if len(nodes) > GLB_NODES:
        raise InputError(f"{len(nodes)} nodes", f"at most {GLB_NODES}", file=path, advice="Join the parts.")
    children = [c for n in nodes for c in n.get("children", [])]
    roots = set(range(len(nodes))) - set(children)
    reached, depth, level = 0, 0, list(roots)
    if len(children) == len(set(children)):
        while level:
            depth += 1
            if depth > GLB_DEEPEST:
                raise InputError(
                    f"nodes more than {GLB_DEEPEST} deep", "a flatter GLB", file=path, advice="Join the parts."
                )
            reached += len(level)
            level = [c for n in level for c in nodes[n].get("children", [])]
    if reached != len(nodes):
        raise InputError("nodes that are no tree", "a GLB whose nodes have one parent each", file=path)
