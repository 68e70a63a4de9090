"""Files: shipped data by name, and writing that leaves either the old file or the new one."""

from __future__ import annotations

import os
import tempfile
from importlib.resources import files
from pathlib import Path

from coeflab.core.errors import InputError, OutputError, shown

_CHECKOUT = Path(__file__).resolve().parents[2]


def shipped(kind: str) -> Path:
    """Folder of shipped data, ``cfd_data`` or ``geometry``: inside the wheel, else in the checkout."""
    inside = Path(str(files("coeflab"))) / "_data" / kind
    return inside if inside.is_dir() else _CHECKOUT / kind


def located(name: str | Path, kind: str, base: Path | None = None) -> Path:
    """The path that a plan or a person means: relative to ``base``, to the current folder, or a shipped name.

    Raises
    ------
    InputError
        Nothing is there.
    """
    path = Path(name).expanduser()
    candidates = [path] if path.is_absolute() or base is None else [base / path]
    try:
        for candidate in candidates:
            if candidate.exists():
                return candidate
        if len(path.parts) == 1 and (shipped(kind) / path).is_dir():
            return shipped(kind) / path
    except (OSError, ValueError):
        raise InputError(f"{shown(name)}, which is no usable path", "the path of a file or folder") from None
    known = ", ".join(sorted(p.name for p in shipped(kind).iterdir() if p.is_dir())) if shipped(kind).is_dir() else ""
    raise InputError(
        f"no file or folder {shown(candidates[0], 300)}",
        "a path that exists" + (f", or a shipped name ({known})" if known else ""),
    )


def write_atomically(path: Path, content: bytes) -> bool:
    """Write a file through a temporary neighbour; an equal file is left untouched.

    Returns
    -------
    bool
        True when the file changed.

    Raises
    ------
    OutputError
        The folder cannot be made or written.
    """
    try:
        if path.is_file() and path.read_bytes() == content:
            return False
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:40]}.")
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
            Path(temporary).chmod(0o644)
            Path(temporary).replace(path)
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as why:
        raise OutputError(f"cannot write {path}: {why.strerror or why}. Choose another folder.") from None
    return True
