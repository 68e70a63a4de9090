"""Symmetry planes that a case of OpenFOAM names: in its fields, its mesh, and the dictionaries that make the mesh.

A mesh is seldom shipped with a case, so every place counts: fields of ``0*`` and of the start time, ``polyMesh/boundary`` of the case, of its
regions and of its processors, and every dictionary of ``system`` (blockMeshDict, snappyHexMeshDict, createPatchDict, meshDict ...).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from coeflab.core.errors import InputError
from coeflab.core.limits import FOAM_FIELD_BYTES
from coeflab.core.text.foam import FoamCase
from coeflab.core.text.series import opened
from coeflab.tables.openfoam_forces import listed

# Types of patches on whose other side the image of the flow lies.
MIRRORS = ("symmetryPlane", "symmetry", "basicSymmetry")
MOST = 60  # files of one folder
PROCESSORS = 4  # of them as many are looked at: each names every patch
_COMMENTS = re.compile(rb"//[^\n]*|/\*.*?\*/", re.DOTALL)
_TYPED = re.compile(rb'\btype\s+"?(' + "|".join(MIRRORS).encode() + rb')"?\s*;')
# foam-extend and versions before 2.0 list patches as: symmetryPlane name ( faces )
_LISTED = re.compile(rb"\b(symmetryPlane|symmetry)\s+([A-Za-z_][\w.\-]*)\s*\(\s*\(")
_HEAD = re.compile(rb'("[^"]*"|[^\s{}();"]+)?\s*\Z')
_NAME = re.compile(rb"\bname\s+([^\s;{}]+)\s*;")
_TIME = re.compile(r"\d+(?:\.\d+)?")  # a steady run often keeps its last time alone
# A copy of caseDicts/setConstraintTypes: no patch of the case.
_ALL_KINDS = re.compile(rb"\bprocessor\s*\{\s*type\s+processor")
_INCLUDED = re.compile(rb'#include(?:IfPresent)?\s+"([^"$<]+)"')


def mirror_patches(case: FoamCase) -> str:
    """The patches that mirror the flow, with their types and places, of the first file that names any; or empty.

    Parameters
    ----------
    case : FoamCase
    """
    for name in ("0/U", "0.orig/U", "0/Urel", "0.orig/Urel", "constant/polyMesh/boundary"):
        try:
            file = case.read(name)
        except InputError as why:
            if name != "constant/polyMesh/boundary":
                raise
            case.note(f"{name} is looked through for symmetry planes only: {why.found}")
            continue
        holder = file.part("boundaryField") or file if file is not None else None
        found = [
            (patch, *kind) for patch, part in (holder.parts() if holder is not None else ())
            if (kind := case.value(part, "type")) is not None and str(kind[0]).strip('"') in MIRRORS
        ]  # fmt: skip
        if found:
            return "; ".join(f"{place}: patch {patch} is of type {kind}" for patch, kind, place in found)
    for path in dict.fromkeys(_places(case)):
        if planes := "; ".join(_named_in(case, path)):
            if path not in case.files:
                case.files.append(path)
            return planes
    return ""


def _places(case: FoamCase) -> Iterator[Path]:
    """Every file of a case that may name the type of a patch, fields first, what makes a mesh last."""
    start = case.value(case.read("system/controlDict"), "startTime")
    first = str(start[0]) if start is not None else ""
    folders = _folders(case.root)
    processors = [f for f in folders if re.fullmatch(r"processors?\d+(?:_\d+-\d+)?", f.name)][:PROCESSORS]
    for root in (case.root, *processors):
        times = [f for f in _folders(root) if f.name.startswith("0") or f.name == first or _TIME.fullmatch(f.name)]
        meshes = [f for f in (root / "constant", *times) if f.is_dir()]
        for folder in meshes:
            for within in (folder, *_folders(folder)):
                yield from (f for f in (within / "polyMesh/boundary", within / "polyMesh/boundary.gz") if f.is_file())
        for folder in times:
            for within in (folder, *(f for f in _folders(folder) if f.name != "polyMesh")):
                yield from _files(within)
    yield from (f for f in (case.root / "constant/polyMesh/blockMeshDict",) if f.is_file())
    for folder in (case.root / "system", *_folders(case.root / "system")):
        yield from _files(folder)


def _folders(root: Path) -> list[Path]:
    return [f for f in islice(listed(root), 10 * MOST) if f.is_dir()]


def _files(folder: Path) -> list[Path]:
    return [f for f in islice(listed(folder), MOST) if f.is_file()]


def _named_in(case: FoamCase, path: Path, depth: int = 0) -> Iterator[str]:
    """Places, patches and types that one file names, and the files that it includes from its own case."""
    try:
        with opened(path) as stream:
            raw = stream.read(FOAM_FIELD_BYTES)
    except (InputError, OSError):
        return
    if b"symmetry" in raw.lower():
        text = _COMMENTS.sub(lambda m: b"\n" * m[0].count(b"\n"), raw)
        if not _ALL_KINDS.search(text):
            for m in _TYPED.finditer(text):
                yield _symmetry_place(case, path, text, m.start(), _patch_at(text, m.start()), m[1])
            for m in _LISTED.finditer(text):
                yield _symmetry_place(case, path, text, m.start(), m[2].decode("utf-8", "replace"), m[1])
    for m in _INCLUDED.finditer(raw[: 1 << 20]) if depth < 2 else ():
        inner = path.parent / m[1].decode("utf-8", "replace")
        if inner.is_file() and inner.resolve().is_relative_to(case.root.resolve()):
            yield from _named_in(case, inner, depth + 1)


def _symmetry_place(case: FoamCase, path: Path, text: bytes, at: int, patch: str, kind: bytes) -> str:
    line = text.count(b"\n", 0, at) + 1
    return f"{case.relative(path)}:{line}: patch {patch} is of type {kind.decode()}"


def _patch_at(text: bytes, at: int) -> str:
    """The keyword of the dictionary around a place; of a patchInfo that of the dictionary around it, or its name."""
    for _ in range(3):
        depth, open_ = 0, -1
        for i in range(at - 1, max(at - 20_000, -1), -1):
            c = text[i : i + 1]
            depth += (c == b"}") - (c == b"{")
            if depth < 0:
                open_ = i
                break
        if open_ < 0:
            return "unnamed"
        head = _HEAD.search(text, max(open_ - 200, 0), open_)
        word = head[1].decode("utf-8", "replace") if head and head[1] else ""
        if word and word not in ("patchInfo", "patchInfos"):
            return word
        if not word and (named := _NAME.search(text, open_, open_ + 2000)):
            return named[1].decode("utf-8", "replace")
        at = open_
    return "unnamed"
