"""What lies below a folder: reports, parameter files and their coefficients; those that cannot be read with the reason.

Files below a folder by the key that stands in an address: nothing outside, nothing hidden, no links that lead out.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import field, replace
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path
from threading import Lock
from urllib.parse import quote, unquote_to_bytes

from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.table import percent, plus_minus
from coeflab.core.text.bounded import stream_of
from coeflab.core.text.json import parse_json
from coeflab.core.types import dataclass
from coeflab.report.printable import shortened
from coeflab.report.reproduction import digest_of
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.stability import INDICES, sense, stability

SERVED = {".html": "text/html; charset=utf-8", ".pdf": "application/pdf", ".json": "application/json"}


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


HEAD, SNIFFED = 1 << 19, 1 << 12
PARAMETERS = ".parameters.json"
OWN_REPORTS = ("report.html", "summary.html")
MOST_FILES, MOST_ENTRIES = 2_000, 200_000
LONGEST, MOST_ROWS = 300, 60
SLOPES = tuple(s for *several, _ in INDICES.values() for s in several)
LOOK, CLASS = re.compile(r"^figure svg \.(s\d+) \{ ([^{}<>\"]*) \}$", re.MULTILINE), re.compile(r' class="(s\d+)"')
DRAWN = re.compile(r'<svg xmlns="http://www.w3.org/2000/svg" viewBox="[\d. ]+" role="img".*?</svg>', re.DOTALL)
ROWS = re.compile(r'<script type="application/json" class="rows">(.*?)</script>', re.DOTALL)


@dataclass(frozen=True, slots=True)
class Valued:
    """A coefficient of a report or of a parameter file.

    Attributes
    ----------
    symbol : str
        With prime.
    value, u95 : float or None
    status : str
        In words; says why there is no value.
    source : str
        Campaign or work.
    """

    symbol: str
    value: float | None
    u95: float | None
    status: str = ""
    source: str = ""

    @property
    def value_text(self) -> str:
        """Value and U95, or why there is none."""
        return self.status if self.value is None else plus_minus(self.value, self.u95)


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
    verdict : str
        Its first sentence.
    written : str
        Day of the file, 2026-11-22 in universal time. Files that come out the same are not written again, so its inputs are
        those of that day.
    picture : str
        Key of the file that holds its first drawing; empty without one.
    coefficients : tuple of Valued
        The rows of its answer.
    """

    path: str
    title: str = ""
    study: str = ""
    digest: str = ""
    keys: tuple[tuple[str, str], ...] = ()
    fault: str = ""
    verdict: str = ""
    written: str = ""
    picture: str = ""
    coefficients: tuple[Valued, ...] = ()

    @property
    def key(self) -> str:
        """Of its first file; empty where it cannot be read."""
        return self.keys[0][1] if self.keys else ""

    @property
    def called(self) -> str:
        """What it is called."""
        return self.title or self.path

    @property
    def words(self) -> str:
        """What a search looks through."""
        symbols = " ".join(c.symbol for c in self.coefficients)
        return f"{self.path} {self.title} {self.study} {self.digest} {self.verdict} {self.written} {symbols}".casefold()


@dataclass(frozen=True, slots=True)
class ParameterEntry:
    """A parameter file; attributes as of `ReportEntry`. The digest is that of the inputs that it names."""

    path: str
    key: str = ""
    name: str = ""
    body: str = ""
    length: str = ""
    coefficients: tuple[Valued, ...] = ()
    models: int = 0
    version: str = ""
    fault: str = ""
    verdict: str = ""
    study: str = ""
    digest: str = ""
    written: str = ""
    picture: str = ""

    @property
    def symbols(self) -> tuple[str, ...]:
        """Symbols in order, without a value too."""
        return tuple(c.symbol for c in self.coefficients)

    @property
    def valued(self) -> int:
        """How many coefficients have a value."""
        return sum(c.value is not None for c in self.coefficients)

    @property
    def called(self) -> str:
        """What it is called."""
        return self.name

    @property
    def words(self) -> str:
        """What a search looks through."""
        about = f"{self.path} {self.name} {self.body} {self.study} {self.digest} {self.verdict} {self.written}"
        return f"{about} {' '.join(self.symbols)}".casefold()


Entry = ReportEntry | ParameterEntry


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

    def coefficients(self, query: str) -> tuple[tuple[Valued, Entry], ...]:
        """Coefficients that a query names, each with the file that holds it; parameter files first.

        A word that begins a symbol is one, in any case and with or without prime: ``yv`` finds Yv', then Yv|v|' and
        Yvdot'. The other words have to stand in the file's entry, or in the campaign.
        """
        entries: list[Entry] = [*self.parameters, *self.reports]
        every = [(c, e) for e in entries for c in e.coefficients]
        known = {_bare(c.symbol) for c, _ in every}
        words = [w for w in query.casefold().split() if w]
        symbols = [_bare(w) for w in words if any(s.startswith(_bare(w)) for s in known if len(_bare(w)) > 1)]
        if not symbols:
            return ()
        others = [w for w in words if _bare(w) not in symbols]
        found = [
            (c, e) for c, e in every
            if any(_bare(c.symbol).startswith(s) for s in symbols) and all(w in f"{e.words} {c.source.casefold()}" for w in others)
        ]  # fmt: skip
        return tuple(sorted(found, key=lambda pair: (_bare(pair[0].symbol) not in symbols, pair[0].symbol)))

    def files_of(self, report: ReportEntry) -> tuple[ParameterEntry, ...]:
        """The parameter files that lie beside a report and come from the same inputs."""
        folder = report.path.rpartition("/")[0]
        return tuple(
            e for e in self.parameters
            if report.digest and e.digest == report.digest and e.path.rpartition("/")[0] == folder and e.key
        )  # fmt: skip


def _bare(symbol: str) -> str:
    return symbol.casefold().removesuffix("'")


Stamp = tuple[int, int]


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

    def drawing(self, key: str) -> str:
        """The first drawing of a report's page, one ``<svg>`` element with its own styles; empty where the key means no report with one."""
        path = place_of(self.folder, key)
        if path is None or path.suffix.lower() != ".html":
            return ""
        with stream_of(path) as stream:
            text = stream.read(HEAD).decode("utf-8", "replace")
        found = DRAWN.search(text)
        if found is None:
            return ""
        looks = dict(LOOK.findall(text, 0, found.start()))
        return CLASS.sub(lambda c: f' style="{looks[c[1]]}"' if c[1] in looks else c[0], found[0])

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
            if entry is not None:
                entry = replace(entry, written=f"{datetime.fromtimestamp(about.st_mtime, UTC):%Y-%m-%d}")
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
        out[stem] = replace(main, keys=tuple(sorted(keys.items())))
    return tuple(out.values())


def _report(path: Path, name: str) -> ReportEntry | None:
    """A report of coeflab; None for a page that is something else."""
    with stream_of(path) as stream:
        head = stream.read(HEAD)
    if path.suffix.lower() == ".pdf":
        if not head.startswith(b"%PDF-"):
            return ReportEntry(name, fault="found no PDF; expected one by its name.")
        return ReportEntry(name, keys=(("PDF", key_of(name)),))
    given, text = _ReportHead(), head.decode("utf-8", "replace")
    given.feed(text)
    if given.generator != "coeflab":
        own = path.name in OWN_REPORTS
        return ReportEntry(name, fault="found another page; expected a report of coeflab.") if own else None
    study, _, digest = given.subject.removeprefix("Study ").rpartition(", inputs ")
    return ReportEntry(
        name, shortened(given.title, LONGEST), shortened(study, LONGEST), digest[:64], (("HTML", key_of(name)),),
        verdict=shortened(" ".join(given.verdict.split()), LONGEST), picture=key_of(name) if DRAWN.search(text) else "",
        coefficients=_rows(text),
    )  # fmt: skip


def _rows(page: str) -> tuple[Valued, ...]:
    """The rows of the answer that a page carries for its own download; none where they are not what a report writes."""
    found = ROWS.search(page)
    try:
        rows = parse_json(found[1])["rows"] if found else []
        return tuple(
            Valued(_word(r["symbol"]), _size(r["value"]), _size(r["U95"]), _word(r["status"]), _word(r["from"]))
            for r in rows[:MOST_ROWS]
        )
    except (InputError, ValueError, TypeError, KeyError):
        return ()


def _word(text: object) -> str:
    return shortened(text, LONGEST) if isinstance(text, str) else ""


def _size(value: object) -> float | None:
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else None


def _parameters(path: Path, name: str) -> ParameterEntry | None:
    """A parameter file; None for JSON that does not claim to be one."""
    if not path.name.endswith(PARAMETERS):
        with stream_of(path) as stream:
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
        tuple(
            Valued(c.symbol, c.value, c.u95, c.status.replace("_", " "), c.campaign or c.citation)
            for c in found.coefficients
        ),
        len(found.models),
        found.schema_version,
        verdict=_verdict(found),
        study=shortened(found.provenance.study, LONGEST),
        digest=digest_of(found.provenance.inputs),
        picture=key_of(name) if found.covered else "",
    )


def _verdict(found: ParameterFile) -> str:
    """Whether straight motion is stable, and the widest interval of the derivatives that say so; empty without either."""
    words = [f"{sense(d)}, {d.name} = {d.value:.2f}" for d in stability(found)]
    wide = [(abs(c.u95 / c.value), c) for c in found.coefficients if c.value and c.u95 and c.symbol in SLOPES]
    if wide:
        share, c = max(wide, key=lambda pair: pair[0])
        words.append(f"largest U95 {percent(share, 1.0)}, of {c.symbol}")
    return "; ".join(words)


def fault(why: CoeflabError, path: Path) -> str:
    """An error on one line, without the place of the folder on this machine."""
    text = str(why)
    for head in (f"{path}: ", f"{path}, "):
        text = text.removeprefix(head)
    return shortened(text.replace(str(path), path.name), LONGEST)


class _ReportHead(HTMLParser):
    """What the head of a report says of itself."""

    def __init__(self) -> None:
        super().__init__()
        self.generator = self.title = self.subject = self.verdict = ""
        self._inside = self._until = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if not self.verdict and (given.get("id") == "answer-heading" or "lead" in (given.get("class") or "").split()):
            self._until = tag
        if tag == "bdi":
            return
        if tag == "meta" and given.get("name") == "generator":
            self.generator = given.get("content") or ""
        digest = tag == "p" and "digest" in (given.get("class") or "").split() and not self.subject
        self._inside = "title" if tag == "title" and not self.title else "subject" if digest else ""

    def handle_endtag(self, tag: str) -> None:
        if tag == self._until:
            self._until = ""
        if tag != "bdi":
            self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._until:
            self.verdict += data
        if self._inside == "title":
            self.title += data
        elif self._inside == "subject":
            self.subject += data
