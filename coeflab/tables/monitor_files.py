"""Which solver wrote a file: by its content, each file by one only; and which files of a folder are one run."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

from coeflab.core.limits import MONITOR_FILES
from coeflab.core.text.bounded import stream_of

HEAD = 1 << 16
SUFFIXES = (".csv", ".dat", ".out", ".txt", ".frp", ".trn")
# Folders and files that say that a folder is no run of a monitor alone: a case of OpenFOAM, a campaign.
OTHERS = ("system", "constant", "postProcessing", "campaign.toml")
FORCE_TABLE = re.compile(
    r"^(?P<title>(?:Forces|Moments)\b.*)\n.*\n[ \t]*Zone[ \t]+Pressure[ \t]+Viscous[ \t]+Total\b", re.M
)
_QUOTED = re.compile(r'"([^"]*)"')
_TITLE, _NAMES = re.compile(r'"[^"]*"'), re.compile(r'\(?\s*"[^"]+"(?:\s+"[^"]*")+\s*\)?')
_FLUENT_INDEX = re.compile(r"iterations?|time[ -]step|flow[ -]time", re.I)
_SU2_NAME = re.compile(r"(?:Time|Outer|Inner)_Iter|rms\[.*|bgs\[.*")
_SU2_OLD = {"CL", "CD", "CLift", "CDrag"}
CFX_INDEX = b'"ACCUMULATED TIMESTEP"'
FIRST_LINES = 64  # in which the names of a captive test are looked for
SIMMAN = frozenset(("X", "Y", "N", "u", "v", "r", "udot", "vdot", "rdot"))
_CAPTIVE = re.compile(r"(?P<name>[A-Za-z]+(?:_?dot)?)\s*(?P<unit>\[[^\[\]]*\]|\([^()]*\))?")
# A row a condition, of reports in the place of a history.
_CONDITION = re.compile(
    r"(?i)\b(?:run|case|design\s*#?|drift|beta|alpha|angle|yaw angle|incidence|speed)(?!.* Monitor\b)"
)
_STAR_MONITOR = re.compile(r".+ Monitor(?: \d+)?: .+|(Iteration|Time Step): \1|Physical Time: Physical Time \(.*\)")


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
    """Which solver or tank wrote the file that begins so: ``starccm``, ``fluent``, ``su2``, ``cfx``, ``simman``, or empty.

    Parameters
    ----------
    raw : bytes
        Its first 64 KiB.

    Notes
    -----
    Layouts: STAR-CCM+ names a column ``NAME Monitor: WHAT (UNIT)`` or begins with ``Iteration: Iteration`` or ``Physical
    Time: Physical Time (s)``. Fluent's report files have a quoted title, quoted names, names in parentheses; its force
    reports a table with Zone, Pressure, Viscous, Total below a line that begins with Forces or Moments. SU2 quotes its
    names and has Time_Iter, Outer_Iter, Inner_Iter or residuals ``rms[...]`` (7, 8), or Iteration and CL (6 and before). CFX's cfx5mondata begins
    with ACCUMULATED TIMESTEP. A captive test as SIMMAN 2014 asks for it has forces X Y N, velocities u v r and accelerations
    udot vdot rdot.
    """
    if not raw or b"\0" in raw:
        return ""
    if raw.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(CFX_INDEX + b","):
        return "cfx"
    text = decoded(raw)[0]
    lines = [line.strip() for line in lines_of(text[:HEAD]) if line.strip()][:4]
    if len(lines) > 1 and _TITLE.fullmatch(lines[0]):
        named = next((line for line in reversed(lines[1:3]) if _NAMES.fullmatch(line)), "")
        if named and _FLUENT_INDEX.fullmatch(_QUOTED.findall(named)[0]):
            return "fluent"
    if FORCE_TABLE.search("\n".join(lines_of(text))):
        return "fluent"
    names = su2_names(lines)
    if any(_SU2_NAME.fullmatch(n) for n in names) or (names[:1] == ("Iteration",) and not _SU2_OLD.isdisjoint(names)):
        return "su2"
    for delimiter in (d for d in ",;\t" if lines and d in lines[0]):
        cells = header_cells(lines[0], delimiter)
        if any(map(_STAR_MONITOR.fullmatch, cells)) and not _CONDITION.search(cells[0]):
            return "starccm"
    if any(captive_names(line)[0] for line in lines_of(text)[:FIRST_LINES]):
        return "simman"
    return ""


def captive_names(line: str) -> tuple[tuple[str, ...], tuple[str, ...], str]:
    """Names, units and delimiter of a line that names the columns of a SIMMAN captive test; empty where it does not.

    Parameters
    ----------
    line : str
        A comment mark before the names is no part of them.
    """
    bare = line.strip().lstrip("#%!").strip()
    delimiter = next((d for d in "\t;," if d in bare), " ")
    # A blank separates columns only where none stands before a unit.
    cells = re.sub(r"\s+([\[(])", r"\1", bare).split() if delimiter == " " else header_cells(bare, delimiter)
    parts = [_CAPTIVE.fullmatch(cell) for cell in cells]
    names = tuple(m["name"].replace("_", "") if m else cell for m, cell in zip(parts, cells, strict=True))
    if not set(names) >= SIMMAN or len(set(names)) < len(names):
        return (), (), ""
    return names, tuple((m["unit"] or "").strip("[]()") if m else "" for m in parts), delimiter


def su2_names(lines: Sequence[str]) -> tuple[str, ...]:
    """Names of the columns of a history of SU2, CSV or Tecplot, from its first lines; empty where it is none."""
    selected = [line for line in lines if not line.startswith("TITLE")]
    if selected and selected[0].startswith("VARIABLES"):
        own = selected[0].partition("=")[2].strip()
        selected = selected[1:] if own in ("", "\\") else [own, *selected[1:]]
    if not selected or not selected[0].startswith('"'):
        return ()
    cells = selected[0].split(",")
    names = [cell.strip() for cell in cells if cell.strip()]
    quoted = all(len(n) > 2 and n[0] == n[-1] == '"' and '"' not in n[1:-1] for n in names)
    return tuple(n[1:-1].strip() for n in names) if quoted and len(names) > 1 else ()


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
