"""What a mesh file says of itself, compared with its size before anything is loaded: STL, OBJ, PLY, COLLADA and GLB."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import GLB_DEEPEST, GLB_NODES, JSON_BYTES
from coeflab.core.text.bounded import stream_of, whole_bytes
from coeflab.core.text.json import parse_json
from coeflab.core.texts import input_error

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
    with stream_of(path) as stream:
        head = stream.read(20)
        words = [int.from_bytes(head[k : k + 4], "little") for k in range(0, 20, 4)]
        if len(head) < 20 or head[:4] != b"glTF":
            raise InputError(shown(head[:4].decode("latin-1")), 'a GLB, which begins with "glTF"', file=path)
        if words[1] != 2 or head[16:20] != b"JSON":
            found = f"version {words[1]}" if words[1] != 2 else "no description behind the header"
            raise InputError(found, "a GLB of version 2 that begins with its description", file=path)
        if words[2] != size or words[3] > min(size - 20, JSON_BYTES):
            raise input_error("mesh.bytes_behind_header_2", path, size=size, words=words[2], words_2=words[3])
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
        raise input_error("mesh.plain_glb_holds", path, found=what)
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
                raise input_error("mesh.nodes_more_than", path, glb_deepest=GLB_DEEPEST)
            reached += len(level)
            level = [c for n in level for c in nodes[n].get("children", [])]
    if reached != len(nodes):
        raise InputError("nodes that are no tree", "a GLB whose nodes have one parent each", file=path)


WHOLE = re.compile(rb"-?\d+")


def require_corners(path: Path) -> None:
    """Hold every corner of every face of an OBJ against its vertices; for a file that could not be read.

    Corners count from 1, or back from the vertex above them with a minus; ``7/1/3`` names texture and normal too, which
    do not matter here.

    Raises
    ------
    InputError
        By file and line: a corner that is no whole number, that is zero, or whose vertex does not exist.
    """
    lines = whole_bytes(path, LARGEST_TEXT).splitlines()
    total = sum(line.split(maxsplit=1)[:1] == [b"v"] for line in lines)
    above = 0
    for number, line in enumerate(lines, 1):
        key, *corners = line.split() or [b""]
        above += key == b"v"
        for corner in corners if key == b"f" else ():
            index = corner.partition(b"/")[0]
            at = int(index) if WHOLE.fullmatch(index) and len(index) < 20 else 0
            if not (1 <= at <= total or -above <= at <= -1):
                raise input_error("mesh.face_corner", path, number, decode=shown(corner.decode("latin-1")), total=total)


LARGEST_TEXT = 320 << 20
PLY_HEADER = 1 << 16
LONGEST_COUNT = 15  # digits of a number of faces or vertices
PLY_BYTES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "int32", "uint32", "float", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
CORNER_ZERO = re.compile(rb"^[ \t]*f[^\n]*[ \t]0+(?=[ \t/\r\n])", re.MULTILINE)
EXPORT = "Export it again, or copy it again: it may have been cut short."


def _text(path: Path) -> bytes:
    size = path.stat().st_size
    if size > LARGEST_TEXT:
        raise input_error("mesh.mb_text", path, size=size / 1000000.0, largest_text=LARGEST_TEXT >> 20)
    return whole_bytes(path, LARGEST_TEXT)


def stl_faces(path: Path) -> int:
    """Triangles of an STL, binary or text."""
    size = path.stat().st_size
    with stream_of(path) as stream:
        head = stream.read(1024)
    claimed = int.from_bytes(head[80:84], "little") if len(head) >= 84 else 0
    if len(head) >= 84 and size == 84 + 50 * claimed:
        return claimed
    if not (head.lstrip()[:5].lower() == b"solid" and b"facet" in head.lower()):
        if bool(head) and head.isascii() and all(c >= 32 or c in b"\t\r\n\f" for c in head):
            raise input_error("mesh.text_file_begins", path, strip=shown(head.decode("ascii")[:40].strip()))
        raise InputError(
            f"{size} bytes" + (f" behind a header that counts {claimed} triangles" if len(head) >= 84 else ""),
            f"an STL: text, or binary of {84 + 50 * claimed} bytes" if len(head) >= 84 else "an STL, text or binary",
            file=path,
            advice=EXPORT,
        )
    text = _text(path).lower()
    facets = text.count(b"endfacet")
    corners = sum(1 for _ in re.finditer(rb"^[ \t]*vertex\s", text, re.MULTILINE))
    if corners != 3 * facets or not text.rstrip().rpartition(b"\n")[2].strip().startswith(b"endsolid"):
        raise input_error("mesh.vertices_finished_facets", path, corners=corners, facets=facets, advice=EXPORT)
    return facets


def obj_faces(path: Path) -> int:
    """Faces of an OBJ; a face of n corners counts n - 2."""
    text = _text(path)
    faces = sum(max(len(f[1].split()) - 2, 0) for f in re.finditer(rb"^[ \t]*f[ \t]+(.*)$", text, re.MULTILINE))
    if not faces or not re.search(rb"^[ \t]*v\s", text, re.MULTILINE):
        raise InputError("no vertices and faces", "an OBJ with lines v and f", file=path)
    if CORNER_ZERO.search(text):
        require_corners(path)
    return faces


def ply_faces(path: Path) -> int:
    """Faces of a PLY, by its header; the elements that it promises must fit into the file."""
    size = path.stat().st_size
    with stream_of(path) as stream:
        head = stream.read(PLY_HEADER)
    begin, _, _ = head.partition(b"end_header")
    if not head.startswith(b"ply") or len(begin) == len(head):
        raise InputError(shown(head[:20].decode("latin-1")), "a PLY: ply, format, elements, end_header", file=path)
    counts, least, binary, current = {}, len(begin), False, 0
    for line in begin.decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            binary = words[1:2] != ["ascii"]
        elif words[:1] == ["element"] and len(words) == 3 and words[2].isdigit():
            if len(words[2]) > LONGEST_COUNT:
                raise InputError(
                    shown(words[2]), f"a count of {LONGEST_COUNT} digits at most", file=path, advice=EXPORT
                )
            counts[words[1]] = current = int(words[2])
        elif words[:1] == ["property"]:
            least += current * _ply_least(words, binary)
    if not counts.get("vertex") or not counts.get("face"):
        raise input_error("mesh.vertices_faces", path)
    if size < least:
        claimed = f"{counts['vertex']} vertices and {counts['face']} faces"
        raise input_error("mesh.bytes_behind_header", path, size=size, claimed=claimed, least=least, advice=EXPORT)
    if not binary:
        _text(path)
    return counts["face"]


def text_of(path: Path, faces: int) -> int:
    """Bytes of a mesh file that is text, whose faces have been counted; 0 of a binary one."""
    size, kind = path.stat().st_size, path.suffix.lower()
    if kind == ".ply":
        with stream_of(path) as stream:
            head = stream.read(PLY_HEADER).partition(b"end_header")[0]
        return size if b"format ascii" in head else 0
    text = kind == ".obj" or (kind == ".stl" and size != 84 + 50 * faces)
    return size if text else 0


def _ply_least(words: list[str], binary: bool) -> int:
    """Bytes that one property takes at least; a list is taken to hold a triangle's corners."""
    sizes = [PLY_BYTES.get(w, 1) if binary else 2 for w in words[1:-1] if w != "list"]
    return sizes[0] + 3 * sizes[-1] if "list" in words and sizes else sum(sizes)


UNIT_OF_DAE = re.compile(rb"<unit\b[^>]*?\bmeter\s*=\s*[\"']([^\"']*)[\"']")


def dae_faces(path: Path) -> int:
    """1: a COLLADA does not say how many triangles it comes to; its size is bounded, and it declares no entities."""
    text = _text(path)
    if b"<COLLADA" not in text[:65_536]:
        raise InputError("no <COLLADA>", "a COLLADA document", file=path, advice=EXPORT)
    if b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise InputError("a document that declares entities", "a plain COLLADA", file=path, advice=EXPORT)
    return 1


def metres_of_dae(path: Path) -> float:
    """Metres of one unit of a COLLADA: ``<unit meter="0.001">``; 1 where it states none (COLLADA 1.4.1, asset)."""
    found = UNIT_OF_DAE.search(whole_bytes(path, LARGEST_TEXT))
    try:
        unit = float(found[1]) if found else 1.0
    except ValueError:
        unit = 0.0
    if not 0.0 < unit < float("inf"):
        raise InputError("a <unit> of no length", 'meter="1" or another above zero', file=path)
    return unit


def composed_faces(path: Path) -> int:
    """A model of links, or a STEP, does not say how many triangles it comes to; its size is bounded as that of a text."""
    _text(path)
    return 1
