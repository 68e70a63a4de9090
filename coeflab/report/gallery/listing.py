"""What lies below a folder: reports and parameter files, those that cannot be read with the reason.

Files below a folder by the key that stands in an address: nothing outside, nothing hidden, no links that lead out.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from threading import Lock
from urllib.parse import quote, unquote_to_bytes

from coeflab.core.errors import CoeflabError
from coeflab.core.types import brief
from coeflab.report.printable import shortened
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

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


HEAD, SNIFFED = 1 << 17, 1 << 12
PARAMETERS = ".parameters.json"
OWN_REPORTS = ("report.html", "summary.html")
MOST_FILES, MOST_ENTRIES = 2_000, 200_000
LONGEST = 300


@brief
@dataclass(frozen=True, slots=True)
class ReportEntry:
    """A report.

    Attributes
    ----------
    path : str
        Below the folder.
    title, study, digest : str
        Empty where it does not say.
    keys : tuple of (str, str)
        Format and key of each of its files.
    fault : str
        Why it cannot be read; else empty.
    """

    path: str
    title: str = ""
    study: str = ""
    digest: str = ""
    keys: tuple[tuple[str, str], ...] = ()
    fault: str = ""

    @property
    def words(self) -> str:
        """What a search looks through."""
        return f"{self.path} {self.title} {self.study} {self.digest}".casefold()


@brief
@dataclass(frozen=True, slots=True)
class ParameterEntry:
    """A parameter file; attributes as of `ReportEntry`."""

    path: str
    key: str = ""
    name: str = ""
    body: str = ""
    length: str = ""
    symbols: tuple[str, ...] = ()
    valued: int = 0
    models: int = 0
    version: str = ""
    fault: str = ""

    @property
    def words(self) -> str:
        """What a search looks through."""
        return f"{self.path} {self.name} {self.body} {' '.join(self.symbols)}".casefold()


@brief
@dataclass(frozen=True, slots=True)
class Listing:
    """Everything that was found; ``more`` when the folder holds more than is read."""

    reports: tuple[ReportEntry, ...]
    parameters: tuple[ParameterEntry, ...]
    more: bool = False

    def having(self, query: str) -> Listing:
        """The entries that hold every word of a query, in any case."""
        wanted = query.casefold().split()
        return Listing(
            tuple(e for e in self.reports if all(w in e.words for w in wanted)),
            tuple(e for e in self.parameters if all(w in e.words for w in wanted)),
            self.more,
        )


Stamp = tuple[int, int]


@brief
@dataclass(slots=True)
class Shelf:
    """A folder and what was read of it; a file is read again when it changes.

    Parameters
    ----------
    folder : Path
        Resolved.
    """

    folder: Path
    _read: dict[str, tuple[Stamp, ReportEntry | ParameterEntry | None]] = field(default_factory=dict)
    _lock: Lock = field(default_factory=Lock)

    def listing(self) -> Listing:
        """Look again; links and hidden files are passed over unless they lead to what may be shown."""
        names, more = _names(self.folder)
        with self._lock:
            self._read = {n: self._read[n] for n in names if n in self._read}
            found = [entry for name in names if (entry := self._entry(name)) is not None]
        reports = [e for e in found if isinstance(e, ReportEntry)]
        return Listing(_joined(reports), tuple(e for e in found if isinstance(e, ParameterEntry)), more)

    def parameters(self, key: str) -> ParameterFile | None:
        """The parameter file of a key; None where the key means none that may be shown.

        Raises
        ------
        InputError
            It cannot be read.
        """
        path = place_of(self.folder, key)
        return None if path is None or path.suffix.lower() != ".json" else read_parameter_file(path)

    def _entry(self, name: str) -> ReportEntry | ParameterEntry | None:
        path = place_of(self.folder, key_of(name))
        if path is None:
            return None
        try:
            about = path.stat()
            stamp = (about.st_mtime_ns, about.st_size)
            known = self._read.get(name)
            if known is not None and known[0] == stamp:
                return known[1]
            entry = _parameters(path, name) if path.suffix.lower() == ".json" else _report(path, name)
        except OSError as why:
            fault = f"cannot be read: {why.strerror or why}"
            return ParameterEntry(name, fault=fault) if name.endswith(".json") else ReportEntry(name, fault=fault)
        self._read[name] = (stamp, entry)
        return entry


def _names(folder: Path) -> tuple[list[str], bool]:
    """Paths below the folder that may be reports or parameter files, sorted, and whether some were left out."""
    names: list[str] = []
    seen = 0
    for here, folders, files in os.walk(folder):
        folders[:] = sorted(f for f in folders if not f.startswith("."))
        seen += len(folders) + len(files)
        inside = Path(here).relative_to(folder)
        for file in sorted(files):
            if not file.startswith(".") and file.lower().endswith((".html", ".pdf", ".json")):
                if len(names) == MOST_FILES:
                    return names, True
                names.append((inside / file).as_posix())
        if seen > MOST_ENTRIES:
            return names, True
    return names, False


def _joined(entries: list[ReportEntry]) -> tuple[ReportEntry, ...]:
    """A PDF stands with the HTML of its name."""
    stems = {e.path.rpartition(".")[0]: e for e in entries if e.path.lower().endswith(".html")}
    out: dict[str, ReportEntry] = {}
    for e in entries:
        stem = e.path.rpartition(".")[0]
        main = out.get(stem) or stems.get(stem) or e
        keys = dict(main.keys) | dict(e.keys)
        out[stem] = ReportEntry(main.path, main.title, main.study, main.digest, tuple(sorted(keys.items())), main.fault)
    return tuple(out.values())


def _report(path: Path, name: str) -> ReportEntry | None:
    """A report of coeflab; None for a page that is something else."""
    with path.open("rb") as stream:
        head = stream.read(HEAD)
    if path.suffix.lower() == ".pdf":
        if not head.startswith(b"%PDF-"):
            return ReportEntry(name, fault="found no PDF; expected one by its name.")
        return ReportEntry(name, keys=(("PDF", key_of(name)),))
    said = _Said()
    said.feed(head.decode("utf-8", "replace"))
    if said.generator != "coeflab":
        own = path.name in OWN_REPORTS
        return ReportEntry(name, fault="found another page; expected a report of coeflab.") if own else None
    study, _, digest = said.subject.removeprefix("Study ").rpartition(", inputs ")
    return ReportEntry(name, shortened(said.title, LONGEST), shortened(study, LONGEST), digest[:64],
                       (("HTML", key_of(name)),))  # fmt: skip


def _parameters(path: Path, name: str) -> ParameterEntry | None:
    """A parameter file; None for JSON that does not claim to be one."""
    if not path.name.endswith(PARAMETERS):
        with path.open("rb") as stream:
            if b'"schema_version"' not in stream.read(SNIFFED):
                return None
    try:
        found = read_parameter_file(path)
    except CoeflabError as why:
        return ParameterEntry(name, fault=fault(why, path))
    return ParameterEntry(
        name,
        key_of(name),
        shortened(found.name, LONGEST),
        shortened(found.body, LONGEST),
        f"{shortened(found.scaling.length_name, 40)} {found.scaling.length:g} m",
        tuple(c.symbol for c in found.coefficients),
        sum(c.value is not None for c in found.coefficients),
        len(found.models),
        found.schema_version,
    )


def fault(why: CoeflabError, path: Path) -> str:
    """An error on one line, without the place of the folder on this machine."""
    text = str(why)
    for head in (f"{path}: ", f"{path}, "):
        text = text.removeprefix(head)
    return shortened(text.replace(str(path), path.name), LONGEST)


class _Said(HTMLParser):
    """What the head of a report says of itself."""

    def __init__(self) -> None:
        super().__init__()
        self.generator = self.title = self.subject = ""
        self._inside = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "bdi":
            return
        given = dict(attrs)
        if tag == "meta" and given.get("name") == "generator":
            self.generator = given.get("content") or ""
        digest = tag == "p" and "digest" in (given.get("class") or "").split() and not self.subject
        self._inside = "title" if tag == "title" and not self.title else "subject" if digest else ""

    def handle_endtag(self, tag: str) -> None:
        if tag != "bdi":
            self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside == "title":
            self.title += data
        elif self._inside == "subject":
            self.subject += data
