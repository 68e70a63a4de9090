"""Runs of a solver or a carriage in a folder: found, read in as many processes as there are cores, and remembered.

What a run gave is kept in a state file, one line a run, and read again only when one of its files changed: long work goes on
where it was interrupted.
"""

from __future__ import annotations

import hashlib
import json
import os
import stat
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import IO, Any

from coeflab.core.errors import CoeflabError, InputError, OutputError, clipped
from coeflab.core.machine import cores, end_with_parent
from coeflab.core.text.bounded import stream_of
from coeflab.core.text.json import parse_json
from coeflab.core.texts import input_error
from coeflab.core.version import VERSION
from coeflab.core.wording import listed, natural
from coeflab.tables.histories import Convergence
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.raw_table import NO_FORCES, Stated
from coeflab.tables.run_summary import RunSummary, summarised

Progress = Callable[[str], None]
STATE = "collected_runs.jsonl"
STATE_KIND = "coeflab collected runs 4"
DEEPEST, MOST_ENTRIES = 12, 500_000
SHALLOW, MOST_SHALLOW = 2, 2_000  # levels of a run's folder, and their entries, that tell whether it changed
STILL_WRITTEN = 2_000_000_000  # ns; what changed so shortly before it was read may change again unseen
CHUNK, AHEAD = 8, 4  # runs that go to a process at once, and chunks that wait for each process
PATIENCE = 2.0  # s of work that are left before processes are started for it


class NoRunsError(InputError):
    """A folder or file in which no run of a known format is."""


def find_runs(path: Path, importer: str = "") -> tuple[str, dict[str, Path]]:
    """The runs at or below a path: what exactly one importer recognises, and nothing inside of it.

    Parameters
    ----------
    path : Path
    importer : str
        The only one to be asked.

    Returns
    -------
    importer : str
    runs : dict of str to Path
        By name, the path from the folder of runs; in natural order.

    Raises
    ------
    InputError
        None is there, two importers claim one, two formats are there, or the folder is too large.
    """
    if importer and IMPORTERS.load(importer).run is None:
        able = [n for n in IMPORTERS.usable() if IMPORTERS.load(n).run is not None]
        raise input_error(
            "tables.importer_without_runs", column="importer", importer=importer, able=", ".join(able) or "none"
        )
    loaded = {name: IMPORTERS.load(name) for name in ([importer] if importer else IMPORTERS.usable())}
    plugins = {name: plugin for name, plugin in loaded.items() if plugin.run is not None}
    runs: dict[str, Path] = {}
    formats: dict[str, str] = {}

    def claimed(candidate: Path) -> bool:
        owners = []
        for name, plugin in plugins.items():
            with IMPORTERS.guarded(name):
                owners += [name] if plugin.recognises(candidate) else []
        if not owners:
            return False
        if len(owners) > 1:
            raise input_error("tables.recognised_twice", candidate, owners=listed(owners), first=owners[0])
        name = candidate.relative_to(path).as_posix() if candidate != path else path.resolve().name
        runs[name] = candidate
        formats.setdefault(owners[0], name)
        return True

    if not claimed(path):
        _walk(path, claimed)
    if not runs:
        kinds = ", ".join(f"{n} ({p.reads or p.summary})" for n, p in plugins.items())
        raise NoRunsError("no run of a known format", f"folders or files of one of: {kinds or 'none'}", file=path)
    if len(formats) > 1:
        some = " and ".join(f"{name} ({kind})" for kind, name in formats.items())
        raise input_error("tables.runs_of_several_formats", path, count=len(formats), some=some)
    return next(iter(formats)), {n: runs[n] for n in sorted(runs, key=natural)}


def _walk(root: Path, claimed: Callable[[Path], bool]) -> None:
    """Ask about everything below a folder, level by level; a folder that links lead to twice is entered once."""
    seen: set[tuple[int, int]] = set()
    waiting = deque([(root, 0)])
    entries = 0
    while waiting:
        folder, depth = waiting.popleft()
        try:
            about = folder.stat()
            if (about.st_dev, about.st_ino) in seen or not stat.S_ISDIR(about.st_mode):
                continue
            seen.add((about.st_dev, about.st_ino))
            with os.scandir(folder) as listing:
                inside = sorted((e.name for e in listing if not e.name.startswith(".")), key=natural)
        except OSError:
            continue
        entries += len(inside)
        if entries > MOST_ENTRIES:
            raise input_error("tables.too_many_files", root, most_entries=MOST_ENTRIES)
        for name in inside:
            candidate = folder / name
            with suppress(OSError):
                about = candidate.stat()
                is_folder = stat.S_ISDIR(about.st_mode)
                if is_folder and (about.st_dev, about.st_ino) in seen:
                    continue
                if claimed(candidate):
                    seen.add((about.st_dev, about.st_ino))
                elif is_folder and depth < DEEPEST:
                    waiting.append((candidate, depth + 1))


def read_run(path: Path, name: str, importer: str, options: Mapping[str, Any]) -> tuple[RunSummary, list[list[Any]]]:
    """Read one run, in whatever process, and what tells later whether its files changed.

    A run that cannot be read becomes one of status ``unreadable``, with the complaint.
    """
    began = time.time_ns()
    plugin = IMPORTERS.load(importer)
    if plugin.run is None:
        raise InputError(f"the importer {importer}", "one that reads runs", file=path)
    try:
        with IMPORTERS.guarded(importer):
            summary = summarised(plugin.run(path, options), name)
    except (InputError, OSError) as why:
        text = (why.lines[0] if isinstance(why, InputError) else str(why)).replace(f"{path}{os.sep}", "")
        if isinstance(why, InputError) and why.found == NO_FORCES:
            return RunSummary(name, Convergence.EMPTY, text), []
        return RunSummary(name, Convergence.UNREADABLE, text, files=(str(path.absolute()),) * path.is_file()), []
    mark = fingerprint(path, summary.files)
    fresh = not mark or max(m[2] for m in mark) > began - STILL_WRITTEN
    return summary, [] if fresh else mark


def fingerprint(path: Path, files: Sequence[str]) -> list[list[Any]]:
    """Path, size and time of change of a run's files, of the folders above them, and of the first two levels of its folder.

    Empty where one of them is gone.
    """
    looked: dict[str, None] = {str(path.absolute()): None}
    inside = [path] if path.is_dir() else []
    for _ in range(SHALLOW):
        deeper: list[Path] = []
        for folder in inside:
            with suppress(OSError), os.scandir(folder) as listing:
                for entry in sorted(listing, key=lambda e: e.name)[: MOST_SHALLOW - len(looked)]:
                    looked[str(folder.absolute() / entry.name)] = None
                    deeper += [folder / entry.name] if entry.is_dir() else []
        inside = deeper
    root = str(path.absolute())
    for name in files:
        looked[name] = None
        above = Path(name).parent
        while str(above).startswith(root) and str(above) != root:
            looked[str(above)] = None
            above = above.parent
    out = []
    for name in looked:
        try:
            about = os.stat(name)  # noqa: PTH116 - a hundred thousand of them
        except OSError:
            if name in files or name == root:
                return []
            continue  # a link that leads nowhere
        out.append([name, 0 if stat.S_ISDIR(about.st_mode) else about.st_size, about.st_mtime_ns])
    return out


class State:
    """Summaries of finished runs, one line of JSON each: what was written before a kill is there after it.

    Parameters
    ----------
    path : Path
        A file, or a folder in which it gets its usual name.
    key : str
        Of everything but the files that a summary hangs on; lines of another key do not count.
    """

    def __init__(self, path: Path, key: str) -> None:
        self.path = path / STATE if path.is_dir() or not path.suffix else path
        self.key = key
        self._known: dict[str, tuple[list[list[Any]], dict[str, Any]]] = {}
        self._stream: IO[bytes] | None = None
        self._load()

    def _load(self) -> None:
        with suppress(OSError), stream_of(self.path) as stream:
            for line in stream:
                with suppress(InputError, ValueError, KeyError, TypeError):  # a line that a kill cut short
                    digest, text = line.decode().rstrip("\n").split(" ", 1)
                    content = parse_json(text) if digest == _digest(text) else {}
                    if content["kind"] == STATE_KIND and content["key"] == self.key:
                        self._known[content["path"]] = content["mark"], content["run"]

    def known(self, path: Path, name: str) -> RunSummary | None:
        """The summary of a run whose files are what they were."""
        mark, content = self._known.get(str(path.absolute()), ([], {}))
        with suppress(ValueError, KeyError, TypeError):
            if mark and fingerprint(path, content["files"]) == mark:
                return replace(_summary(content), name=name)
        return None

    def keep(self, path: Path, mark: list[list[Any]], summary: RunSummary) -> None:
        """Append a summary.

        Raises
        ------
        OutputError
            The file cannot be written.
        """
        if not mark:
            return
        content = {
            "kind": STATE_KIND,
            "key": self.key,
            "path": str(path.absolute()),
            "mark": mark,
            "run": _plain(summary),
        }
        try:
            if self._stream is None:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                self._stream = self.path.open("ab")
                self._stream.write(b"\n" * (self._stream.tell() > 0))  # behind a line that a kill cut short
            text = json.dumps(content)
            self._stream.write(f"{_digest(text)} {text}\n".encode())
            self._stream.flush()
        except OSError as why:
            raise OutputError(
                f"cannot write {clipped(self.path)}: {why.strerror or why}. Choose another folder."
            ) from None

    def close(self) -> None:
        """Let the file go."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None


_STATED = ("stated_conditions", "stated")


def _plain(summary: RunSummary) -> dict[str, Any]:
    """A summary as JSON holds it; Python's JSON has NaN."""
    names = [n for n in RunSummary.__dataclass_fields__ if n not in ("conditions", "name")]
    out = {n: getattr(summary, n) for n in names}
    for name in _STATED:
        out[name] = {k: [s.value, s.place, s.offered, s.contradicted, s.convention] for k, s in out[name].items()}
    return out


def _summary(content: Mapping[str, Any]) -> RunSummary:
    read = dict(content)
    for name in _STATED:
        read[name] = {k: Stated(tuple(v) if isinstance(v, list) else v, *how) for k, (v, *how) in read[name].items()}
    for name in ("patches", "other_columns"):
        read[name] = {k: (float(v), unit) for k, (v, unit) in read[name].items()}
    for name in ("files", "remarks"):
        read[name] = tuple(read[name])
    return RunSummary(name="", **{**read, "status": Convergence(read["status"])})


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _key(importer: str, options: Mapping[str, Any]) -> str:
    return _digest(json.dumps([VERSION, importer, sorted(options.items())], default=str))


def read_all(
    root: Path,
    importer: str,
    found: Mapping[str, Path],
    options: Mapping[str, Any],
    progress: Progress | None = None,
    workers: int | None = None,
    state: Path | None = None,
) -> tuple[list[RunSummary], int]:
    """Summaries of runs in their order, and how many of them were read now.

    Parameters
    ----------
    root : Path
    importer : str
    found : mapping of str to Path
        As `find_runs` gives them.
    options : mapping
        Of the importer.
    progress, workers, state
        See `coeflab.tables.collect.collect_groups`.
    """
    say: Progress = progress or (lambda _: None)
    options = dict(options)
    selected = State(state, _key(importer, options)) if state is not None else None
    out: dict[str, RunSummary] = {}
    if selected is not None:
        out = {name: known for name, path in found.items() if (known := selected.known(path, name)) is not None}
    todo = [(path, name) for name, path in found.items() if name not in out]
    count, unfinished, before = len(found), 0, f", {len(out):,} known from before" if out else ""
    every = max(len(todo) // 100, 1)
    say(f"{count:,} runs of {importer} in {root.name or root}{before}")
    try:
        for i, ((path, name), (summary, mark)) in enumerate(
            zip(todo, _read(todo, importer, options, workers), strict=True), 1
        ):
            out[name] = summary
            if selected is not None:
                selected.keep(path, mark, summary)
            unfinished += summary.status is not Convergence.CONVERGED
            if i % every == 0 or i == len(todo):
                say(f"read {i:,} of {len(todo):,} runs, {unfinished:,} not converged{before}")
    finally:
        if selected is not None:
            selected.close()
    return [out[name] for name in found], len(todo)


Read = tuple[RunSummary, list[list[Any]]]


def _read_chunk(chunk: Sequence[tuple[Path, str]], importer: str, options: Mapping[str, Any]) -> list[Read]:
    return [read_run(path, name, importer, options) for path, name in chunk]


def _read(
    todo: Sequence[tuple[Path, str]], importer: str, options: Mapping[str, Any], workers: int | None
) -> Iterator[Read]:
    """Runs in their order; in processes once there is work enough for them."""
    done, began = 0, time.monotonic()
    many = min(workers or cores(), -(-len(todo) // CHUNK))
    for path, name in todo:
        if many > 1 and workers is not None:
            break
        spent = time.monotonic() - began
        if many > 1 and done and spent > 0.5 and spent / done * (len(todo) - done) > PATIENCE:
            break
        yield read_run(path, name, importer, options)
        done += 1
    if done < len(todo):
        yield from _in_processes(todo[done:], importer, options, many)


def _in_processes(
    todo: Sequence[tuple[Path, str]], importer: str, options: Mapping[str, Any], workers: int
) -> Iterator[Read]:
    chunks = iter([todo[i : i + CHUNK] for i in range(0, len(todo), CHUNK)])
    waiting: deque[Future[list[Read]]] = deque()
    with ProcessPoolExecutor(workers, get_context("spawn"), initializer=end_with_parent) as pool:
        try:
            while True:
                while len(waiting) < AHEAD * workers and (chunk := next(chunks, None)) is not None:
                    waiting.append(pool.submit(_read_chunk, chunk, importer, options))
                if not waiting:
                    return
                yield from waiting.popleft().result()
        except BrokenProcessPool:
            raise CoeflabError(
                "A process that read runs was killed, perhaps out of memory. What was read is kept where there is a state "
                "file: start again, with fewer workers."
            ) from None
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
