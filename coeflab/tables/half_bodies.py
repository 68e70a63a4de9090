"""Half of a body: files of a solver that name a symmetry plane, and forces across the plane that a whole body would not have.

A domain that is cut at a symmetry plane gives the forces of one half. Each importer says where its solver's files name such a plane;
whatever the format, a force across it that is far from zero in every row along the plane asks the same question.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import JSON_BYTES, MONITOR_FILES
from coeflab.core.text.bounded import leading_bytes
from coeflab.core.types import Array
from coeflab.law.symbols import FORCES
from coeflab.tables.campaign import HALVES, PORT_STARBOARD, Cut
from coeflab.tables.raw_table import HALF_MODEL, Stated

# A forbidden component, of the largest force or moment of the table. To half of a body the pressure on the other side of the
# cut is missing, a force of the order of the others; meshes and balances of whole bodies stay well below a twentieth.
FORCE, MOMENT = 0.05, 0.2
LEVER = 0.02  # of the length: the largest moment is taken for the largest force at this lever at least
NOISE = 4.0  # standard errors
FEWEST = 3  # rows along the plane, where no symmetry is declared


class Along(NamedTuple):
    """Forces of rows whose motion lies in a plane, FRD.

    Attributes
    ----------
    forces, errors : mapping of str to (n,) array
        Those of X Y Z K M N that there are, all rows of the table, and their standard errors.
    rows : mapping of str to (n,) boolean array
        By component, the rows along the plane that count.
    length : float
        m; zero where it is not known.
    """

    forces: Mapping[str, Array]
    errors: Mapping[str, Array]
    rows: Mapping[str, NDArray[np.bool_]]
    length: float


def forces_across(
    subject: str, cut: Cut, along: Along, *, declared: bool, in_plane: bool = True, severity: Severity = Severity.WARN
) -> Finding | None:
    """Forces and moments that a body alike on both sides of a plane has not, in motions along that plane.

    Where the symmetry is declared the median over the rows counts; where it is not, the smallest, and only with one sign throughout: a
    body may be a little unlike, but half of a body carries the pressure on its cut at every angle.

    Parameters
    ----------
    subject : str
        Table.
    cut : Cut
    along : Along
    declared : bool
        Whether the body is declared to be its own image in the plane.
    in_plane : bool
        Whether the reference point lies in the plane: moments are judged only then.
    severity : Severity
    """
    force = _largest(along, [c for c in along.forces if c in FORCES])
    moment = max(_largest(along, [c for c in along.forces if c not in FORCES]), LEVER * along.length * force)
    found: dict[str, float] = {}
    for c in (c for c in cut.cancelled if c in along.forces and (c in FORCES or in_plane)):
        share = _size(along, c, declared) / max(force if c in FORCES else moment, 1e-300)
        if share > (FORCE if c in FORCES else MOMENT):
            found[c] = share
    if not found:
        return None
    kind = "force" if set(found) <= set(FORCES) else "moment" if not set(found) & set(FORCES) else "force or moment"
    return Finding.of(
        "half_body.across", subject, severity, statistic=max(found.values()), threshold=FORCE if found.keys() & set(FORCES) else MOMENT,
        advice="half_model = " + " or ".join(f'"{half}"' for half, symmetry in HALVES.items() if symmetry == cut.symmetry),
        components=tuple(found), shares=tuple(f"{c} is {share:.0%}" for c, share in found.items()), kind=kind, plane=cut.plane,
        rows=int(max(np.count_nonzero(along.rows[c]) for c in found)), symmetry=cut.symmetry, declared="yes" if declared else "no",
        doubled=cut.doubled, lost=cut.cancelled,
    )  # fmt: skip


def judged(symmetry: Sequence[str]) -> tuple[str, ...]:
    """Symmetries by which a table is judged: most bodies are alike to port and starboard, few are above and below."""
    return tuple(dict.fromkeys((PORT_STARBOARD, *(s for s in symmetry))))


def _largest(along: Along, components: Sequence[str]) -> float:
    return max((float(np.nanmax(np.abs(along.forces[c]), initial=0.0)) for c in components), default=0.0)


def _size(along: Along, component: str, declared: bool) -> float:
    """Size of a component over the rows along the plane; zero without any, or where its standard errors explain it."""
    rows = along.rows[component]
    values = along.forces[component][rows]
    values = values[np.isfinite(values)]
    if not values.size or (not declared and (values.size < FEWEST or np.ptp(np.sign(values)) > 0.0)):
        return 0.0
    size = float(np.median(np.abs(values)) if declared else np.min(np.abs(values)))
    errors = along.errors.get(component)
    known = np.empty(0) if errors is None else errors[rows][np.isfinite(errors[rows])]
    noise = float(np.median(known)) if known.size else 0.0
    return size if size > NOISE * noise else 0.0


# ------------------------------------------------------------------------------------------------------- files of a solver


def stated_plane(places: Sequence[str]) -> dict[str, Stated]:
    """What an importer states of the half model, from the places of symmetry planes in its files; nothing without any.

    Parameters
    ----------
    places : sequence of str
        Each with file and line: ``run.cfg:9: marker midplane is a symmetry plane``.
    """
    if not places:
        return {}
    where = places[0].partition(": ")[0]
    return {HALF_MODEL: Stated("symmetry plane", where, offered=True, contradicted="; ".join(places))}


def planes_in_files(
    path: Path, suffixes: Sequence[str], kind: re.Pattern[str], name: re.Pattern[str] | None = None
) -> tuple[dict[str, Stated], list[Path]]:
    """What texts beside a monitor state of the half model by a symmetry plane that they name; and the files that name one.

    One setup often serves a whole folder of runs: where a run has a folder of its own without such a text, the folder of runs counts.

    Parameters
    ----------
    path : Path
        A file of the run, or its folder.
    suffixes : sequence of str
        Of the texts that the solver writes or reads.
    kind : pattern
        Of a line that says that a boundary is a symmetry plane; a group is its name.
    name : pattern, optional
        Of an earlier line that names the boundary, its first group.
    """
    folders = (path, path.parent) if path.is_dir() else (path.parent,)
    found = (_planes_of(folder, suffixes, kind, name) for folder in folders)
    places, files = next((planes for planes in found if planes[0]), ([], []))
    return stated_plane(places), files


def _planes_of(
    folder: Path, suffixes: Sequence[str], kind: re.Pattern[str], name: re.Pattern[str] | None
) -> tuple[list[str], list[Path]]:
    try:
        files = sorted(f for f in folder.iterdir() if f.suffix.lower() in suffixes and f.is_file())[:MONITOR_FILES]
    except OSError:
        return [], []
    places, named = list[str](), list[Path]()
    for file in files:
        try:
            about = file.stat()
            found = _planes_in(file, about.st_mtime_ns, about.st_size, kind, name)
        except OSError:
            continue
        places += found
        named += [file] * bool(found)
    return places, named


@lru_cache(maxsize=256)
def _planes_in(
    file: Path, _time: int, _size: int, kind: re.Pattern[str], name: re.Pattern[str] | None
) -> tuple[str, ...]:
    """Symmetry planes that one text names; remembered, as many runs of one folder have the same beside them."""
    raw = leading_bytes(file, JSON_BYTES)
    if b"\0" in raw or b"sym" not in raw.lower():
        return ()
    out: dict[str, str] = {}
    last = before = ""
    for number, here in enumerate(raw.decode("utf-8", "replace").splitlines(), start=1):
        line = before + here
        before = line.rstrip()[:-1] if line.rstrip().endswith("\\") and len(line) <= LONGEST else ""
        if before or len(line) > LONGEST:
            continue
        if name is not None and (m := name.search(line)):
            last = m[1].strip()
        if m := kind.search(line):
            plane = (next((g for g in m.groups() if g), "") or last).strip()
            out.setdefault(plane, f"{file.name}:{number}: boundary {plane}".rstrip() + " is a symmetry plane")
    return tuple(out.values())


LONGEST = 2000  # letters of a line that is looked at


_BODIES = (
    r"(?:model|bod(?:y|ies)|hull|ship|vehicle|submarine|boat|rov|[au]uv|glider|domain|geometry|mesh|grid|configuration)s?"
    r"|(?:modell|k(?:ö|oe)rper|rumpf|schiff|boot|fahrzeug|geometrie|netz|gitter|rechengebiet)\w{0,2}"
    r"|mod[èe]le|corps|coque|domaine|car[èe]ne|maquette|navire|maillage|modelo|cuerpo|casco|modello|corpo|carena|scafo"
)
_SIDES = r"starboard|port|upper|lower|left|right|steuerbord|backbord|tribord|b[âa]bord"
# Half of a body, one of its sides, or the plane that cuts it; "the second half of the run" and "1/2 rho" are none of these.
_HALF = re.compile(
    rf"(?i)(?<![^\W_])(?:(?:half|semi|halb(?:e[snrm]?)?|h(?:ä|ae)lfte|demi\w?|moiti[ée]|mitad|met(?:à|a)|medio|mezz[oa]|½|1/2)"
    rf"[\s_-]{{0,3}}(?:(?:an?|of|the|de[rslnm]?|de|du|del|la|le|l'|el|dello|della)[\s]{{0,3}}){{0,3}}(?:{_BODIES})"
    rf"|(?:{_SIDES}|modell|rumpf|k(?:ö|oe)rper|schiffs?)[\s-]{{0,3}}(?:half|h(?:ä|ae)lfte|moiti[ée])|symmetric\s+half|(?:semi|half)[\s-]?span\s+model"
    rf"|(?:one|{_SIDES})\s+side\s+only|(?:one|either)\s+side\s+of\s+the\s+(?:{_BODIES})|only\s+(?:the\s+)?(?:one|{_SIDES})\s+side|nur\s+(?:eine|die)\s+\w{{0,12}}\s?(?:seite|h(?:ä|ae)lfte)"
    rf"|symmetr(?:y|ic)[\s-]{{1,3}}(?:plane|boundary|condition|bc)s?|symmetrie(?:ebene|rand\w*)|plan\s+de\s+sym[ée]trie|reflection\s+(?:plate|plane)"
    rf"|not\s+(?:yet\s+)?(?:doubled|multiplied\s+by\s+(?:2|two))|to\s+be\s+doubled|nicht\s+verdoppelt|non\s+doubl[ée]e?s?)(?![^\W_])"
)
# What these words are not about: "origin in the symmetry plane", "1/2 hull length", "drift on one side only", "upper half of the table".
_NONE = re.compile(
    r"(?i)(?<![^\W_])(?:no|not|without|full|ohne|kein\w*|sans|scale|double[\s-]body\s+with)\s+(?:an?\s+|the\s+|une?\s+)?$"
)
_PLACE = re.compile(
    r"(?i)(?:(?<![^\W_])(?:in|about|of|to|on|um|dans|à)\s+(?:the\s+|der\s+|die\s+|le\s+)?|walls?\s*:?\s*|top\s*:?\s*)$"
)
_OF_RUNS = re.compile(
    r"(?i)(?:angles?|tests?|runs?|points?|sweeps?|drift|yaw|turn\w*|measured|towed)\s+(?:on|to|at|of)\s+(?:the\s+)?$"
)
_SIZE = re.compile(
    r"(?i)\s+(?:length|breadth|beam|width|height|depth|diameter|radius|speed|scale|spacing|size|mass|were)s?(?![^\W_])"
)
_OF_ANOTHER = re.compile(rf"(?i)\s+of\s+(?!(?:an?\s+|the\s+)?(?:{_BODIES})(?![^\W_]))[^\W_]")


def _is_of_a_body(text: str, m: re.Match[str]) -> bool:
    before, words, after = text[: m.start()], m[0].lower(), text[m.end() :]
    is_plane, is_side = words.startswith(("symm", "plan")), "side" in words
    return not (
        _NONE.search(before[-40:])
        or (is_plane and _PLACE.search(before[-40:]))
        or (is_side and _OF_RUNS.search(before[-40:]))
        or (not is_plane and _SIZE.match(after))
        or (words.endswith("half") and _OF_ANOTHER.match(after))
    )


def half_in_words(texts: Iterable[tuple[str, str]]) -> Stated | None:
    """What words over a table say of half of a body: ``half model``, ``Halbmodell``, ``demi-modele``; None where they do not."""
    for place, text in texts:
        if m := next((m for m in _HALF.finditer(text) if _is_of_a_body(text, m)), None):
            where = f'{place}: "{" ".join(m[0].split())}"'
            return Stated("half of the body", where, offered=True, contradicted=where)
    return None
