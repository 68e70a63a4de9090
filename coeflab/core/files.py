"""Files: shipped data by name, and writing that leaves either the old file or the new one, and no litter of the killed."""

from __future__ import annotations

import os
import re
import secrets
import stat
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from errno import EISDIR
from importlib.resources import files
from pathlib import Path

from coeflab.core.errors import InputError, OutputError, clipped, shown
from coeflab.core.machine import stage
from coeflab.core.text.bounded import holds, leading_bytes
from coeflab.core.wording import repeated

if sys.platform != "win32":
    import fcntl

SUFFIX = ".coeflab"
LOCKS = Path("/proc/locks")
PATIENCE = 60.0  # s for which a writer waits for another one of the same folder
OTHER_FOLDER = "Name another folder."
_LITTER = re.compile(rf"\..+\.\w{{8}}{re.escape(SUFFIX)}", re.DOTALL)
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
        No file or folder can have that name: 5,000 characters, a NUL, the home of nobody; it is shut, or a link that
        leads to itself.
    """
    if not isinstance(name, str | Path):
        raise InputError(f"a {type(name).__name__}", "the path of a file or folder")
    if "\0" in str(name):
        raise InputError(f"{shown(name)}, which is no usable path (a NUL in it)", "the path of a file or folder")
    try:
        path = Path(name).expanduser()
        with suppress(FileNotFoundError, NotADirectoryError):
            path.stat()
    except (OSError, RuntimeError, ValueError) as why:
        reason = getattr(why, "strerror", None) or why
        raise InputError(f"{shown(name)}, which is no usable path ({reason})", "the path of a file or folder") from None
    return path


def placeable(path: Path) -> None:
    """Refuse a place below something that is no folder, before anything is computed for it.

    Raises
    ------
    InputError
        As `typed`.
    OutputError
        A file is in the way.
    """
    above = next((p for p in typed(path).parents if p.exists()), Path())
    if not above.is_dir():
        raise OutputError(f"cannot write {clipped(path)}: {clipped(above)} is no folder. {OTHER_FOLDER}")


def readable(path: Path) -> Path:
    """The path of a file or folder that can be read to its end: no pipe, no device, no link that leads to itself.

    Raises
    ------
    InputError
        It is not.
    """
    typed(path)
    if not path.exists():
        found = "a link that leads to no file" if path.is_symlink() else "no such file or folder"
        raise InputError(found, "a path that exists", file=path)
    if not path.is_file() and not path.is_dir():
        raise InputError("a device or pipe", "a file or folder", file=path, advice="Save its content to a file.")
    return path


def stem(name: str) -> str:
    """A name that files can bear: letters, digits, - and _, 80 at most.

    Parameters
    ----------
    name : str
    """
    return "".join(ch if ch.isalnum() or ch in "-_" else "_" for ch in name)[:80]


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


def named(name: str | Path, file: str) -> Path:
    """The path that a person typed, or the shipped file of that name.

    Parameters
    ----------
    name : str or Path
    file : str
        What is shipped under a name, as `by_name` has it.

    Raises
    ------
    InputError
        No path of a file, and no shipped name.
    """
    path = typed(name)
    if path.is_file() or len(path.parts) != 1:
        return path
    places = by_name(file)
    if path.name in places:
        return places[path.name]
    if path.suffix or path.exists():
        return path
    raise InputError(f"no file {shown(path, 300)}", f"a file that exists, or a shipped name ({', '.join(places)})")


def by_name(file: str) -> dict[str, Path]:
    """Shipped files by the name of their folder below ``cfd_data``; several of one folder go by their own names.

    Parameters
    ----------
    file : str
        ``plan.toml``, ``*.parameters.json``.
    """
    found = sorted(shipped("cfd_data").glob(f"*/{file}"))
    crowded = repeated(p.parent.name for p in found)
    return {p.name.partition(".")[0] if p.parent.name in crowded else p.parent.name: p for p in found}


def names_in(folder: Path) -> list[str]:
    """What a folder holds, in order; what a killed process left of our temporary files is removed, and counts for nothing."""
    _sweep([folder])
    return sorted(p.name for p in folder.iterdir() if not _LITTER.fullmatch(p.name))


def refuse_others(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Refuse to write where a file of that name differs.

    Raises
    ------
    OutputError
        Names it.
    """
    for name, content in contents.items():
        if (folder / name).exists() and not holds(folder / name, content):
            raise OutputError(f"{folder / name} exists and differs. Name another --out, or replace it with --force.")


def write_all(
    folder: Path, contents: Mapping[str, bytes], *, new: bool = False, otherwise: str = OTHER_FOLDER
) -> dict[str, bool]:
    """Write files so that all of them change or none: every content first goes to a temporary neighbour, then into place.

    A fault while a content is written, such as a full disk, leaves all files as they were. Only a stop between the
    replacements at the end, which need no space, leaves old and new files side by side, each of them whole. What killed
    processes left of theirs in the same folders is removed first. Contents are on the disk before they are in place. Of two
    processes that write into one folder one waits.

    Parameters
    ----------
    folder : Path
    contents : mapping of str to bytes
        By name, or path below the folder.
    new : bool
        Whether a folder that holds anything else than these very contents is refused.
    otherwise : str
        What to do then.

    Returns
    -------
    dict of str to bool
        Whether a file changed; an equal file is left untouched.

    Raises
    ------
    OutputError
        A folder cannot be made or written, holds something else, or another process writes into it for a minute.
    """
    staged: dict[Path, Path] = {}
    changed = {}
    path = folder
    try:
        with ExitStack() as locks:
            try:
                if not folder.is_dir():
                    folder.mkdir(parents=True, exist_ok=True)
                locks.enter_context(_alone(folder))
                _sweep({(folder / name).parent for name in contents})
                if new:
                    _require_new(folder, contents, otherwise)
                for name, content in contents.items():
                    path = folder / name
                    changed[name] = not holds(path, content)
                    if changed[name]:
                        staged[path] = _staged(path, content, locks)
                for path, temporary in staged.items():
                    temporary.replace(path)
                for place in sorted({path.parent for path in staged}):
                    _on_disk(place)
            finally:
                for temporary in staged.values():
                    temporary.unlink(missing_ok=True)
    except OSError as why:
        raise OutputError(f"cannot write {clipped(path)}: {why.strerror or why}. Choose another folder.") from None
    return changed


def _require_new(folder: Path, contents: Mapping[str, bytes], otherwise: str) -> None:
    """Refuse a folder with other files than these, which a stopped process may have left of the same contents."""
    tops = {Path(name).parts[0] for name in contents}
    others = [name for name in names_in(folder) if name not in tops]
    others += [n for n, c in contents.items() if (folder / n).exists() and not holds(folder / n, c)]
    if others:
        raise OutputError(f"{clipped(folder)} exists and is not empty. {otherwise}")


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold a folder against other writers; without a lock where the system has none."""
    if sys.platform == "win32":
        yield
        return
    handle = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    try:
        begun = time.monotonic()
        words = False
        while True:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                waited = time.monotonic() - begun
                if waited > PATIENCE:
                    raise OutputError(f"{_holder(handle)} writes into {clipped(folder)}. Wait for it.") from None
                if waited > PATIENCE / 60.0 and not words:
                    stage(f"waiting for {_holder(handle)}, which writes into {clipped(folder)}")
                    words = True
                time.sleep(0.01)
            except OSError:  # a file system without locks
                break
        yield
    finally:
        os.close(handle)


def _holder(handle: int) -> str:
    """Who has the lock of an open folder, by its number where the system says it."""
    with suppress(OSError, ValueError):  # not on Linux, or not to be read
        for line in leading_bytes(LOCKS, 1 << 20).decode("ascii", "replace").splitlines():
            words = line.split()
            if "FLOCK" in words and "->" not in words and words[5].endswith(f":{os.fstat(handle).st_ino}"):
                return f"process {int(words[4])}"
    return "another process"


def _on_disk(folder: Path) -> None:
    """Have the names of a folder written, so that they outlast a loss of power."""
    if sys.platform == "win32":
        return
    with suppress(OSError):  # a file system that cannot
        handle = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _staged(path: Path, content: bytes, locks: ExitStack) -> Path:
    """A temporary neighbour of the path with the content; a lock, kept until the stack ends, says that its writer lives."""
    if path.is_dir():
        raise IsADirectoryError(EISDIR, "a folder of that name is in the way")
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = _locked_file(path)
    try:
        stream = os.fdopen(handle, "wb")
    except BaseException:
        os.close(handle)
        temporary.unlink(missing_ok=True)
        raise
    locks.callback(stream.close)
    try:
        stream.write(content)
        stream.flush()
        os.fsync(stream.fileno())
        if sys.platform == "win32":  # where an open file cannot be moved, and none is swept
            stream.close()
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return temporary


def _locked_file(path: Path) -> tuple[int, Path]:
    """A new file beside the path, and its lock."""
    while True:
        name = path.parent / f".{path.name[:40]}.{secrets.token_hex(4)}{SUFFIX}"
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
        try:
            handle = os.open(name, flags, 0o666)  # less what the umask takes away
        except FileExistsError:
            continue
        if sys.platform == "win32":
            return handle, name
        with suppress(OSError):  # a file system without locks: there nobody sweeps either
            fcntl.flock(handle, fcntl.LOCK_EX)
        if os.fstat(handle).st_nlink:
            return handle, name
        os.close(handle)  # swept between its making and its locking


def _sweep(folders: Iterable[Path]) -> None:
    """Remove temporary files whose writers are dead: the system took back their locks."""
    if sys.platform == "win32":
        return
    for folder in sorted(folders):
        names: list[str] = []
        with suppress(OSError):  # not there yet, or not to be read
            names = os.listdir(folder)  # noqa: PTH208
        for name in filter(_LITTER.fullmatch, names):
            with suppress(OSError):  # gone, another user's, or its writer lives
                handle = os.open(folder / name, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
                try:
                    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    if stat.S_ISREG(os.fstat(handle).st_mode):
                        (folder / name).unlink()
                finally:
                    os.close(handle)


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
