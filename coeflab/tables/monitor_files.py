"""Which solver wrote a file: by its content, each file by one only; and which files of a folder are one run."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from coeflab.core.errors import InputError
from coeflab.core.limits import MONITOR_FILES
from coeflab.core.text.bounded import stream_of
from coeflab.tables.importers import IMPORTERS

HEAD = 1 << 16
SUFFIXES = (".csv", ".dat", ".out", ".txt", ".frp", ".trn")
# Folders and files that say that a folder is no run of a monitor alone: a case of OpenFOAM, a campaign.
OTHERS = ("system", "constant", "postProcessing", "campaign.toml")


def head(path: Path) -> bytes:
    """The first 64 KiB of a file; empty where it cannot be read."""
    try:
        if not path.is_file():
            return b""
        with stream_of(path) as stream:
            return stream.read(HEAD)
    except OSError:
        return b""


def decoded(raw: bytes) -> tuple[str, str]:
    """Text of the head of a file and its encoding; a character cut at the end is left out."""
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "", "UTF-16"
    try:
        return raw.decode("utf-8-sig"), "UTF-8"
    except UnicodeDecodeError as why:
        if why.start >= len(raw) - 3:
            return raw[: why.start].decode("utf-8-sig"), "UTF-8"
        return raw.decode("latin-1"), "not UTF-8"


def lines_of(text: str) -> list[str]:
    """The lines of a text whatever their ends, and only those three ends."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def header_cells(line: str, delimiter: str) -> list[str]:
    """Names in a line of a delimited header, without quotation marks and blanks around."""
    try:
        row = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:
        return []
    return [" ".join(cell.replace('"', " ").split()) for cell in row]


def kind_of(raw: bytes) -> str:
    """Name of the importer whose solver or tank wrote the file that begins so; empty where none did.

    Parameters
    ----------
    raw : bytes
        Its first 64 KiB.
    """
    lines = [] if b"\0" in raw else lines_of(decoded(raw)[0])
    writers = ((name, IMPORTERS.load(name).wrote) for name in IMPORTERS.usable() if any(lines))
    return next((name for name, wrote in writers if wrote and wrote(lines)), "")


def first_filled(lines: Sequence[str], most: int) -> list[tuple[int, str]]:
    """The first lines that are not blank, stripped, with their numbers from 1."""
    return list(islice(((n, line.strip()) for n, line in enumerate(lines, start=1) if line.strip()), most))


def require(raw: bytes, path: Path, kind: str, expected: str) -> None:
    """Refuse a file that the solver of another importer wrote, or none.

    Raises
    ------
    InputError
    """
    if kind_of(raw) != kind:
        raise InputError("another content" if path.is_file() else "no such file", expected, file=path, line=1)


def files_of(folder: Path, kind: str) -> tuple[Path, ...]:
    """Monitors of one run in a folder; empty unless all monitors in it are of this kind.

    A folder of a case of OpenFOAM or with a campaign.toml is none.
    """
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return ()
    if any(e.name in OTHERS for e in entries):
        return ()
    texts = [e for e in entries if e.suffix.lower() in SUFFIXES]
    if len(texts) > MONITOR_FILES:
        return ()
    found = {e: kind_of(head(e)) for e in texts if e.is_file()}
    kinds = {k for k in found.values() if k}
    return tuple(e for e, k in found.items() if k) if kinds == {kind} else ()


def one_run(files: Sequence[Path], part: re.Pattern[str]) -> tuple[Path, ...]:
    """Files that are parts of one run by their names, in order; empty where they are several runs.

    Parameters
    ----------
    files : sequence of Path
    part : pattern
        Of the stem of a continuation, its first group the stem of the file that it continues.
    """
    bases = {m[1] if (m := part.fullmatch(f.stem)) else f.stem for f in files}
    return tuple(sorted(files, key=lambda f: (len(f.stem), f.stem))) if len(bases) == 1 else ()
