"""The one place where files are opened to be read: regular files only, each with the most that is taken of it.

Files of other people go on from here to the readers beside this file, files of the package itself and of this process to whoever asks.
"""

from __future__ import annotations

import errno
import io
import os
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import IO, TYPE_CHECKING, BinaryIO, TextIO

from coeflab.core.errors import InputError
from coeflab.core.limits import LOG_BYTES

if TYPE_CHECKING:
    import zipfile

PIECE = 1 << 20


def stream_of(path: Path) -> BinaryIO:
    """The bytes of a regular file, to be read piece by piece or with a limit.

    Raises
    ------
    OSError
        It cannot be opened; a pipe or device, which may have no end.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise OSError(errno.EINVAL, "a device or pipe", str(path))
    return path.open("rb")


def text_stream_of(path: Path, encoding: str) -> TextIO:
    """The letters of a regular file, line ends as newlines."""
    return io.TextIOWrapper(stream_of(path), encoding=encoding, newline=None)


def part_of(packed: zipfile.ZipFile, name: str | zipfile.ZipInfo) -> IO[bytes]:
    """A part of a packed file, to be read piece by piece."""
    return packed.open(name)


def leading_bytes(file: Path, most: int) -> bytes:
    """The first bytes of a file, to see what it is or names; never more than ``most``.

    Raises
    ------
    OSError
        It cannot be read.
    """
    with stream_of(file) as stream:
        size = os.fstat(stream.fileno()).st_size  # a read of n bytes takes memory for n, however short the file is
        return stream.read(min(most, size + 1 if size else PIECE))  # files of /proc state no size


def whole_bytes(file: Path, most: int) -> bytes:
    """All bytes of a file.

    Raises
    ------
    InputError
        Not to be read, or more than ``most``.
    """
    try:
        content = leading_bytes(file, most + 1)
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=file) from None
    if len(content) > most:
        raise InputError(f"more than {most:,} bytes", f"at most {most:,}", file=file)
    return content


def log_text(file: Path) -> str:
    """The end of what a process of ours, such as a solver, printed into a file; letters that are none replaced.

    Raises
    ------
    OSError
        It cannot be read.
    """
    with stream_of(file) as stream:
        size = stream.seek(0, io.SEEK_END)
        stream.seek(max(size - LOG_BYTES, 0))
        return stream.read(LOG_BYTES).decode("utf-8", "replace").replace("\r\n", "\n")


def own_bytes(place: Traversable) -> bytes:
    """A file of the package itself."""
    return place.read_bytes()


def own_text(place: Traversable) -> str:
    """The same as text."""
    return place.read_text(encoding="utf-8")


def holds(path: Path, content: bytes) -> bool:
    """Whether a file holds these very bytes."""
    return path.is_file() and path.stat().st_size == len(content) and leading_bytes(path, len(content) + 1) == content
