"""Listings of Digital DATCOM and Missile DATCOM (for006.dat): static coefficients over the angle of attack, a page a Mach number.

Both give CL up, CD aft, CN up and CA aft along the body, CM nose up by the longitudinal reference length, alpha nose up and sideslip
with the nose to port of the path; Missile DATCOM also CY to starboard, CLN nose to starboard and CLL starboard side down, by the
lateral length. That is FRD but for the signs of CN and CA, which their names say. Places count aft and up from the origin of the
input, which is the nose where the input says nothing else.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.limits import JSON_BYTES, LARGEST_NUMBER
from coeflab.core.options import parse_options, text
from coeflab.core.text.bounded import whole_bytes
from coeflab.core.texts import input_error
from coeflab.core.wording import listed
from coeflab.tables.monitor_files import decoded, head, kind_of, lines_of
from coeflab.tables.raw_table import RawColumn, RawTable, Stated

summary = "listings of Digital DATCOM and Missile DATCOM: static coefficients over the angle of attack"
reads = "listings of Digital and Missile DATCOM (for006.dat, .out)"
computed = True
citations = (
    "Williams, J. E., Vukelich, S. R. (1979): The USAF Stability and Control Digital DATCOM, AFFDL-TR-79-3032, vol. I.",
    "Blake, W. B. (1998): Missile DATCOM User's Manual, 1997 FORTRAN 90 Revision, AFRL-VA-WP-TR-1998-3009.",
)

_MISSILE, _DIGITAL = "AUTOMATED MISSILE DATCOM", "STABILITY AND CONTROL METHODS PER APRIL 1976 VERSION OF DATCOM"
_KNOWN = (_MISSILE, _DIGITAL, "USAF STABILITY AND CONTROL  DIGITAL DATCOM")
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:E[-+]?\d+)?"
_CELL = re.compile(rf"{_NUMBER}|\*+|NDM|NA\b")
_NAMES = re.compile(r"[01 ]\s*ALPHA\s+(C[DLN]\b.*)")
_STATIC = {_MISSILE: re.compile(r"\s*STATIC AERODYNAMICS FOR (.+)"), _DIGITAL: re.compile(r"\s*(CHARACTERISTICS AT ANGLE OF ATTACK AND IN SIDESLIP)")}  # fmt: skip
_LABELS = {
    "mach": "MACH NO", "beta": "SIDESLIP", "area": "REF AREA", "length": r"\bREF LENGTH", "lateral": "LAT REF LENGTH", "x": "MOMENT CENTER"
}  # fmt: skip
_QUANTITIES = {key: re.compile(rf"{_LABELS[key]}\s*=\s*({_NUMBER})") for key in _LABELS}
_UNITS = {"FT": 0.3048, "M": 1.0, "IN": 0.0254, "CM": 0.01}
_WANTED = ("ALPHA", "CL", "CD", "CN", "CA", "CM", "CY", "CLN", "CLL")


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the reader.

    Attributes
    ----------
    configuration : str
        Title of the pages that are read, as far as it tells them from others; where none is said, of those that begin nearest to rest
        the last of the listing, which is the whole configuration.
    """

    configuration: str = text("")


@dataclass(frozen=True, slots=True)
class _Page:
    """One page: what it is of (title, lengths in m), its first line, its rows."""

    title: str
    line: int
    sizes: Mapping[str, float]
    rows: Sequence[Mapping[str, float]]
    lines: Sequence[int]


def wrote(lines: Sequence[str]) -> bool:
    """Whether the listing names its program."""
    return any(mark in line for line in lines for mark in _KNOWN)


def recognises(path: Path) -> bool:
    """Whether a file is a listing of DATCOM."""
    return path.is_file() and kind_of(head(path)) == "datcom"


def raw(path: Path, options: Mapping[str, Any]) -> RawTable:
    """The static coefficients of one configuration at all its Mach numbers.

    Parameters
    ----------
    path : Path
    options : mapping
        See `Options`.

    Raises
    ------
    InputError
        No page of static coefficients, or none of the configuration wanted.
    """
    wanted = parse_options(Options, options, "importers.datcom").configuration.casefold()
    pages = [p for p in _pages(lines_of(decoded(whole_bytes(path, JSON_BYTES))[0])) if p.rows]
    of = [p for p in pages if wanted in p.title.casefold()]
    titles = list(dict.fromkeys(p.title for p in pages))
    if not of:
        raise input_error("tables.no_page_of_datcom", path, titles=", ".join(titles) or "none")
    rest = {t: min(abs(row["ALPHA"]) for p in of if p.title == t for row in p.rows) for t in {p.title for p in of}}
    last = [p for p in of if rest[p.title] == min(rest.values())][-1]
    same = [p for p in of if p.title == last.title and {**p.sizes, "mach": 0} == {**last.sizes, "mach": 0}]
    rows = [{**row, "MACH": p.sizes["mach"], "BETA": p.sizes.get("beta", 0.0)} for p in same for row in p.rows]
    lateral = last.sizes["lateral"] / last.sizes["length"]
    names = [n for n in (*_WANTED, "BETA", "MACH") if any(n in row for row in rows)]
    columns = [
        np.array([row.get(n, np.nan) * (lateral if n in ("CLN", "CLL") else 1.0) for row in rows]) for n in names
    ]
    place = f"{path.name}:{last.line}"
    stated = {
        "axes.frame": Stated("FRD", place, convention=True),
        "axes.alpha": Stated("w = +U sin(alpha)", place, convention=True),
        "axes.beta": Stated("v = +U sin(beta)", place, convention=True),
        "axes.datum": Stated("nose", place, convention=True),
        "axes.reference_point": Stated((-last.sizes["x"], 0.0, -last.sizes.get("z", 0.0)), place),
        "coefficients.area": Stated(last.sizes["area"], place),
        "coefficients.length": Stated(last.sizes["length"], place),
    }
    remarks = [f"configuration {last.title}, of {listed(titles)}"] if len(titles) > 1 else []
    return RawTable(
        path, tuple(RawColumn(n, "deg" if n in ("ALPHA", "BETA") else "", v) for n, v in zip(names, columns, strict=True)),
        lines=np.array([line for p in same for line in p.lines]), files=(path,), stated=stated, remarks=tuple(remarks),
        dialect={"format": "DATCOM", "configuration": last.title, "pages": f"{len(same)} of {len(pages)}"},
    )  # fmt: skip


def _pages(lines: Sequence[str]) -> Iterator[_Page]:
    """The pages of static coefficients of a listing, in order."""
    starts = [n for n, line in enumerate(lines) if _MISSILE in line or _DIGITAL in line]
    for begin, end in zip(starts, [*starts[1:], len(lines)]):
        kind = _MISSILE if _MISSILE in lines[begin] else _DIGITAL
        top = [*(line.strip() for line in lines[begin + 1 : begin + 6]), "", ""]
        found = next((m for line in lines[begin + 1 : begin + 6] if (m := _STATIC[kind].match(line))), None)
        sizes = _sizes(kind, lines[begin:end]) if found else {}
        if not found or not {"mach", "area", "length", "lateral", "x"} <= sizes.keys():
            continue
        parts = (top[1], found[1]) if kind == _MISSILE else takewhile(lambda t: t and "---" not in t, top[1:4])
        rows, numbers = _rows(lines, begin, end)
        yield _Page(" / ".join(" ".join(p.split()) for p in parts if p), begin + 1, sizes, rows, numbers)


def _sizes(kind: str, lines: Sequence[str]) -> dict[str, float]:
    """Mach number, sideslip, and the reference quantities in m."""
    if kind == _MISSILE:
        top = "\n".join(lines[:16])
        out = {name: _number(m[1]) for name, pattern in _QUANTITIES.items() if (m := pattern.search(top))}
        unit = re.search(r"REF AREA\s*=\s*\S+\s+([A-Z]+)\*\*2", top)
    else:
        unit = next((m for line in lines[:14] if (m := re.search(r"([A-Z]+)\*\*2(?:\s+\1){4}\s*$", line))), None)
        values = next((c for line in lines[:16] if line[:1] == "0" and len(c := _CELL.findall(line[1:])) > 5), [])
        names = ("mach", "area", "length", "lateral", "x", "z")
        out = {k: _number(v) for k, v in zip(names, [*values[:1], *values[-5:]])}
    size = _UNITS.get(unit[1] if unit else "", 0.0)
    powers = {"area": 2, "mach": 0, "beta": 0}
    out = {k: v * size ** powers.get(k, 1) for k, v in out.items()}
    return out if np.isfinite([*out.values()]).all() and all(out.get(k, 0.0) > 0.0 for k in ("area", "length")) else {}


def _number(cell: str) -> float:
    """The number of a cell; NaN of stars, NDM, NA and what no coefficient is."""
    number = float(cell) if re.fullmatch(_NUMBER, cell) else np.nan
    return number if abs(number) <= LARGEST_NUMBER else np.nan


def _rows(lines: Sequence[str], begin: int, end: int) -> tuple[list[dict[str, float]], list[int]]:
    """Rows under every ALPHA of a page, those of one angle together, and their lines."""
    found: dict[float, dict[str, float]] = {}
    numbers: dict[float, int] = {}
    names: list[str] = []
    for n in range(begin, end):
        cells = _CELL.findall(lines[n][1:])
        if head_line := _NAMES.match(lines[n]):
            names = ["ALPHA", *head_line[1].split()]
        elif _CELL.sub("", lines[n][1:]).strip():
            names = []
        elif names and cells and lines[n][0] == " " and np.isfinite(alpha := _number(cells[0])):
            row = {k: number for k, c in zip(names, cells) if k in _WANTED and np.isfinite(number := _number(c))}
            found.setdefault(alpha, {}).update(row)
            numbers.setdefault(alpha, n + 1)
    return list(found.values()), list(numbers.values())
