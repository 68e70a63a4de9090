"""Files: shipped data by name, and writing that leaves either the old file or the new one."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from errno import EISDIR
from importlib.resources import files
from pathlib import Path

from coeflab.core.errors import InputError, OutputError, clipped, shown

_CHECKOUT = Path(__file__).resolve().parents[2]


def shipped(kind: str) -> Path:
    """Folder of shipped data, ``cfd_data`` or ``geometry``: inside the wheel, else in the checkout."""
    inside = Path(str(files("coeflab"))) / "_data" / kind
    return inside if inside.is_dir() else _CHECKOUT / kind


def typed(name: str | Path) -> Path:
    """The path that a person typed, its ``~`` written out.

    Raises
    ------
    InputError
        No file or folder can have that name: 5,000 characters, the home of nobody; or it is shut.
    """
    try:
        path = Path(name).expanduser()
        path.exists()
    except (OSError, RuntimeError) as why:
        reason = getattr(why, "strerror", None) or why
        raise InputError(f"{shown(name)}, which is no usable path ({reason})", "the path of a file or folder") from None
    return path


def located(name: str | Path, kind: str, base: Path | None = None) -> Path:
    """The path that a plan or a person means: relative to ``base``, to the current folder, or a shipped name.

    Parameters
    ----------
    name : str or Path
    kind : {"cfd_data", "geometry"}
        Which shipped names are meant.
    base : Path, optional
        Folder of the plan that names it.

    Raises
    ------
    InputError
        Nothing is there.
    """
    path = typed(name)
    candidate = path if path.is_absolute() or base is None else typed(base / path)
    if candidate.exists():
        return candidate
    if len(path.parts) == 1 and (shipped(kind) / path).is_dir():
        return shipped(kind) / path
    known = ", ".join(sorted(p.name for p in shipped(kind).iterdir() if p.is_dir())) if shipped(kind).is_dir() else ""
    raise InputError(
        f"no file or folder {shown(candidate, 300)}",
        "a path that exists" + (f", or a shipped name ({known})" if known else ""),
    )


def write_all(folder: Path, contents: Mapping[str, bytes]) -> dict[str, bool]:
    """Write files so that all of them change or none: every content first goes to a temporary neighbour, then into place.

    A fault while a content is written, such as a full disk, leaves all files as they were. Only a stop between the
    replacements at the end, which need no space, leaves old and new files side by side, each of them whole.

    Parameters
    ----------
    folder : Path
    contents : mapping of str to bytes
        By name, or path below the folder.

    Returns
    -------
    dict of str to bool
        Whether a file changed; an equal file is left untouched.

    Raises
    ------
    OutputError
        A folder cannot be made or written.
    """
    staged: dict[Path, Path] = {}
    changed = {}
    path = folder
    try:
        try:
            for name, content in contents.items():
                path = folder / name
                changed[name] = not (path.is_file() and path.read_bytes() == content)
                if changed[name]:
                    staged[path] = _staged(path, content)
            for path, temporary in staged.items():
                temporary.replace(path)
        finally:
            for temporary in staged.values():
                temporary.unlink(missing_ok=True)
    except OSError as why:
        raise OutputError(f"cannot write {clipped(path)}: {why.strerror or why}. Choose another folder.") from None
    return changed


def _staged(path: Path, content: bytes) -> Path:
    """A temporary neighbour of the path with the content."""
    if path.is_dir():
        raise IsADirectoryError(EISDIR, "a folder of that name is in the way")
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:40]}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        temporary.chmod(0o644)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return temporary


def write_atomically(path: Path, content: bytes) -> bool:
    """Write one file through a temporary neighbour; an equal file is left untouched.

    Parameters
    ----------
    path : Path
    content : bytes

    Returns
    -------
    bool
        True when the file changed.

    Raises
    ------
    OutputError
        The folder cannot be made or written.
    """
    return write_all(path.parent, {path.name: content})[path.name]
