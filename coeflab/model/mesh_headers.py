"""What a mesh file says of itself, held against its size before anything is loaded: STL, OBJ and PLY."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from coeflab.core.errors import InputError, shown
from coeflab.model.glb_header import glb_faces
from coeflab.model.obj_corners import require_corners

LARGEST_TEXT = 320 << 20
PLY_HEADER = 1 << 16
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
        raise InputError(
            f"{size / 1e6:.0f} MB of text",
            f"at most {LARGEST_TEXT >> 20} MiB of a text format",
            file=path,
            advice="Save the mesh as binary STL or PLY.",
        )
    return path.read_bytes()


def _is_text(head: bytes) -> bool:
    return bool(head) and head.isascii() and all(c >= 32 or c in b"\t\r\n\f" for c in head)


def stl_faces(path: Path) -> int:
    """Triangles of an STL, binary or text."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(1024)
    claimed = int.from_bytes(head[80:84], "little") if len(head) >= 84 else 0
    if len(head) >= 84 and size == 84 + 50 * claimed:
        return claimed
    if not (head.lstrip()[:5].lower() == b"solid" and b"facet" in head.lower()):
        if _is_text(head):
            raise InputError(
                f"a text file that begins {shown(head.decode('ascii')[:40].strip())}",
                "an STL: binary, or text that begins with solid and holds facets",
                file=path,
                advice="It is no STL: export the body again, or give the file its own suffix.",
            )
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
        raise InputError(
            f"{corners} vertices in {facets} finished facets",
            "three for each facet, and endsolid on the last line",
            file=path,
            advice=EXPORT,
        )
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
    with path.open("rb") as stream:
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
            counts[words[1]] = current = int(words[2])
        elif words[:1] == ["property"]:
            least += current * _ply_least(words, binary)
    if not counts.get("vertex") or not counts.get("face"):
        raise InputError(
            "no vertices or no faces", "a PLY of vertices and faces", file=path, advice="Is it a point cloud?"
        )
    if size < least:
        claimed = f"{counts['vertex']} vertices and {counts['face']} faces"
        raise InputError(
            f"{size} bytes behind a header that counts {claimed}", f"{least} bytes or more", file=path, advice=EXPORT
        )
    if not binary:
        _text(path)
    return counts["face"]


def text_of(path: Path, faces: int) -> int:
    """Bytes of a mesh file that is text, whose faces have been counted; 0 of a binary one."""
    size, kind = path.stat().st_size, path.suffix.lower()
    if kind == ".ply":
        with path.open("rb") as stream:
            head = stream.read(PLY_HEADER).partition(b"end_header")[0]
        return size if b"format ascii" in head else 0
    text = kind == ".obj" or (kind == ".stl" and size != 84 + 50 * faces)
    return size if text else 0


def _ply_least(words: list[str], binary: bool) -> int:
    """Bytes that one property takes at least; a list is taken to hold a triangle's corners."""
    sizes = [PLY_BYTES.get(w, 1) if binary else 2 for w in words[1:-1] if w != "list"]
    return sizes[0] + 3 * sizes[-1] if "list" in words and sizes else sum(sizes)


FORMATS: dict[str, Callable[[Path], int]] = {"stl": stl_faces, "obj": obj_faces, "ply": ply_faces, "glb": glb_faces}
