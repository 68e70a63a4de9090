"""Files below a folder by the key that stands in an address: nothing outside, nothing hidden, no links that lead out."""

from __future__ import annotations

import os
from pathlib import Path
from urllib.parse import quote, unquote_to_bytes

SERVED = {
    ".html": "text/html; charset=utf-8",
    ".pdf": "application/pdf",
    ".json": "application/json",
}


def key_of(relative: str) -> str:
    """The address of a file from its path below the folder, whatever bytes the path has."""
    return quote(os.fsencode(relative.replace(os.sep, "/")), safe="/")


def place_of(folder: Path, key: str) -> Path | None:
    """The file that a key means; None where there is none that may be shown.

    Parameters
    ----------
    folder : Path
        Resolved.
    key : str
        As it came, percent signs and all; decoded once.
    """
    name = os.fsdecode(unquote_to_bytes(key))
    parts = name.split("/")
    if any(_unfit(part) for part in parts) or Path(name).suffix.lower() not in SERVED:
        return None
    try:
        found = folder.joinpath(*parts).resolve(strict=True)
        inside = found.relative_to(folder)
        fit = found.is_file() and found.suffix.lower() in SERVED and not any(_unfit(p) for p in inside.parts)
    except (OSError, ValueError, RuntimeError):
        return None
    return found if fit else None


def _unfit(part: str) -> bool:
    """Empty, hidden, a step up, or a name that some system reads as more than a name."""
    return (
        not part
        or part.startswith(".")
        or "\0" in part
        or any(mark in part for mark in (os.sep, os.altsep) if mark)
        or (os.name == "nt" and ":" in part)
    )
