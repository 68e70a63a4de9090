"""What several tables of one campaign settle, ask and show together: one question where they agree, one a table where not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.errors import InputError
from coeflab.tables.column_map import ColumnMap
from coeflab.tables.evidence import Evidence
from coeflab.tables.form import Line, argument, column_lines, is_shown, question_line, setting_line, with_reynolds
from coeflab.tables.interpretation import Interpretation, interpreted
from coeflab.tables.mapping import known_as
from coeflab.tables.parts import ALONE, SPLIT, Part, own
from coeflab.tables.questions import Basis, Question
from coeflab.tables.raw_table import HALF_MODEL, RawColumn, RawTable, Stated
from coeflab.tables.settings import Setting, Settings, read_in
from coeflab.tables.settings_in_files import against_words
from coeflab.tables.words.points import POINT_FROM, POINT_OF


def interpreted_together(
    parts: Sequence[Part], columns: Mapping[str, ColumnMap], settings: Settings, accept: bool = False
) -> tuple[Interpretation, ...]:
    """`interpreted` of every part, by what is said of all and of it; a part with half the drag of another asks for its half."""
    out = [_interpreted(part, parts, columns, settings, accept) for part in parts]
    for k, why in _half_by_drag(parts, out, settings).items():
        if HALF_MODEL not in parts[k].raw.stated:
            half = Stated("symmetry plane", why, offered=True, contradicted=why)
            part = replace(parts[k], raw=replace(parts[k].raw, stated={**parts[k].raw.stated, HALF_MODEL: half}))
            out[k] = _interpreted(part, parts, columns, settings, accept)
    return tuple(out)


def _interpreted(
    part: Part, parts: Sequence[Part], columns: Mapping[str, ColumnMap], settings: Settings, accept: bool
) -> Interpretation:
    named = own(columns, part, parts)
    if part.name:
        known = {n for c in part.raw.columns for n in (c.name, *known_as(c))}
        named = {name: one for name, one in named.items() if name in known}
    found = interpreted(part.raw, named, own(settings, part, parts), accept)
    return replace(found, shows=tuple(_placed(part.name, e) for e in found.shows)) if part.name else found


HALF = 0.02  # of a ratio of drags straight ahead: a grid or a wall moves a drag by more than that, and not to a half


def _half_by_drag(parts: Sequence[Part], founds: Sequence[Interpretation], settings: Settings) -> dict[int, str]:
    """Parts whose X straight ahead is half of that of another part at the same speed, by their places, with both forces."""
    drags = [_straight_ahead(found) for found in founds]
    speeds = [own(settings, p, parts).get("conditions.speed") for p in parts]
    out = {}
    for k, (x, u) in enumerate(drags):
        for j, (whole, v) in enumerate(drags):
            alike = bool(np.isfinite(u) and np.isfinite(v)) or (np.isnan(u) and np.isnan(v) and speeds[k] == speeds[j])
            ratio = x / whole * (1.0 if np.isnan(u) else (v / u) ** 2) if alike and whole else np.nan
            if abs(ratio - 0.5) <= HALF * 0.5:
                out[k] = f"X straight ahead is {x:.4g} N, {ratio:.3f} of the {whole:.4g} N of {parts[j].name}"
    return out


def _straight_ahead(found: Interpretation) -> tuple[float, float]:
    """X in N where nothing else moves, and U there or NaN without such a column; NaN where no row is so."""
    data = {c.meaning.plain: c for c in found.columns}
    if "X" not in data or data["X"].meaning.pure or "R" in data:
        return np.nan, np.nan
    moves = [
        c.values for c in found.columns if c.meaning.role in ("angle", "velocity", "control") and c.meaning.name != "u"
    ]
    still = np.all([np.abs(np.nan_to_num(m)) <= 1e-9 for m in moves], axis=0) if moves else np.zeros(0, dtype=bool)
    if not np.any(still):
        return np.nan, np.nan
    speed = next((data[n] for n in ("U", "u") if n in data and not data[n].meaning.primed), None)
    return float(np.median(data["X"].values[still])), np.nan if speed is None else float(np.median(speed.values[still]))


def _placed(name: str, shows: Evidence) -> Evidence:
    return replace(shows, statement=f"{name}: {shows.statement}")


def questions_together(
    parts: Sequence[Part], founds: Sequence[Interpretation], whole: str = ""
) -> list[tuple[str, Question]]:
    """What is not said yet: one question a key where the parts agree, else one a part, or one that names what differs.

    Parameters
    ----------
    parts, founds : sequences
    whole : str
        Name of what was imported, for the citation.
    """
    out: list[tuple[str, Question]] = []
    for key in dict.fromkeys(q.key for found in founds for q in found.questions):
        have = [(p, q) for p, f in zip(parts, founds, strict=True) for q in f.questions if q.key == key]
        strong = [(p, q) for p, q in have if q.basis not in (Basis.COLUMN, Basis.CANCELS, Basis.ZEROS)] or have
        if len({q.basis is Basis.CANCELS for _, q in have}) > 1 and not key.startswith(ALONE):
            have = strong
        values = {q.default for _, q in strong if q.default}
        named = [q for _, q in strong if q.default and q.basis is not Basis.UNSTATED]
        if key == "source.citation" and whole:
            out.append((key, replace(strong[0][1], default=whole)))
        elif len(values) > 1 and strong[0][1].harmless and len({q.default for q in named}) == 1:
            out.append((key, named[0]))
        elif (
            (len(values) > 1 and key.startswith(SPLIT))
            or (key == POINT_OF and not values and _points_differ(parts))
            or (key == HALF_MODEL and len(parts) > 1)
        ):
            out += [(f"{p.name}/{key}", q) for p, q in have]
        elif len(values) > 1:
            each = "; ".join(f"{p.name}: {q.default} ({q.short or q.why})" for p, q in strong if q.default)
            one = strong[0][1]
            out.append(
                (key, replace(one, default="", shown="", harmless=False, choices=f"{each}; {one.choices}".rstrip("; ")))
            )
        elif key.startswith(ALONE) and len({(q.default, q.shown) for _, q in have}) > 1:
            out += [(f"{p.name}/{key}", q) for p, q in have]
        else:
            out.append(
                (key, next((q for _, q in strong if q.default), next((q for _, q in strong if q.shown), strong[0][1])))
            )
    return out


def _points_differ(parts: Sequence[Part]) -> bool:
    """Whether words of several tables name several points, so that each has to be said from one of them."""
    return len(parts) > 1 and any(
        p.raw.stated[k].contradicted for p in parts for k in ("axes.datum", POINT_FROM) if k in p.raw.stated
    )


def settled_together(
    parts: Sequence[Part], columns: Mapping[str, ColumnMap], settings: Settings, accept: bool, whole: str = ""
) -> tuple[tuple[Interpretation, ...], dict[str, Setting]]:
    """What follows when proposals are accepted, one from the other until nothing more does; else of harmless ones alone.

    Parameters
    ----------
    parts : sequence of Part
    columns : mapping of str to ColumnMap
    settings : mapping of str to Setting
    accept : bool
    whole : str
        See `questions_together`.
    """
    out = dict(settings)
    while True:
        founds = interpreted_together(parts, columns, out, accept)
        fresh: dict[str, Setting] = {}
        for key, q in questions_together(parts, founds, whole):
            if q.default and (accept or q.harmless):
                flag = q.assumed and not q.harmless
                fresh |= {k: Setting(v, q.why, flag) for k, v in read_in(key, q.default).items() if k not in out}
        if not fresh:
            return founds, out
        out |= fresh


def complaints_of(founds: Sequence[Interpretation]) -> list[InputError]:
    """Those of all parts."""
    return [one for found in founds for one in found.complaints]


def is_pending(parts: Sequence[Part], founds: Sequence[Interpretation]) -> bool:
    """Whether something is open or waits to be accepted."""
    waits = any(found.doubts or found.open for found in founds)
    return waits or any(not q.harmless for _, q in questions_together(parts, founds))


def form_together(
    parts: Sequence[Part], founds: Sequence[Interpretation], settings: Settings, read_by: Sequence[Line] = (),
    numbers: dict[str, int] | None = None, whole: str = "",
) -> tuple[Line, ...]:  # fmt: skip
    """All lines of the form, open ones first: one for what the parts share.

    Parameters
    ----------
    parts, founds : sequences
    settings : mapping of str to Setting
        What is known, with names of parts where it is said of one.
    read_by : sequence of Line
    numbers : dict of str to int, optional
        Those of the keys that were shown before; new ones are added.
    whole : str
        See `questions_together`.
    """
    out = [*read_by, *_columns(parts, founds)]
    out += [replace(question_line(q), key=key, argument=argument("--set", key, q.default or "?")) for key, q in
            questions_together(parts, founds, whole)]  # fmt: skip
    words: dict[str, str] = {}
    for part in parts:
        words |= {
            key: f"{part.name}, {place}".removeprefix(", ")
            for key, _, place in against_words(part.raw, own(settings, part, parts))
        }
    about = {key: text for found in founds for key, text in found.about.items()}
    for key, one in settings.items():
        plain = key.rpartition("/")[2]
        if is_shown(plain):
            line = setting_line(plain, one, about.get(plain, plain), words.get(plain, ""))
            out.append(with_reynolds(replace(line, key=key), settings))
    taken: dict[str, int] = {} if numbers is None else numbers
    ordered = sorted(out, key=lambda line: line.group)
    return tuple(replace(line, number=taken.setdefault(line.key, len(taken) + 1)) for line in ordered)


def _columns(parts: Sequence[Part], founds: Sequence[Interpretation]) -> Iterator[Line]:
    """One line for columns of one name that are the same in all parts, else one a part."""
    have: dict[str, list[tuple[Part, Line]]] = {}
    for part, found in zip(parts, founds, strict=True):
        for line in column_lines(part.raw, found):
            have.setdefault(line.key, []).append((part, line))
    for name, lines in have.items():
        if len({(line.value, line.group) for _, line in lines}) == 1:
            first, where = lines[0][1], ""
            if len(lines) < len(parts):
                where = "; " + ", ".join(p.name for p, _ in lines)
            head, _, span = first.why.partition(";")
            yield replace(first, why=f"{head}{where};{span}".rstrip(";"))
            continue
        for part, line in lines:
            words = line.argument.replace(f"{name}=", f"{part.name}/{name}=", 1)
            yield replace(line, key=f"{part.name}/{name}", argument=words)


def columns_by_name(parts: Sequence[Part]) -> dict[str, tuple[str, tuple[tuple[RawTable, RawColumn], ...]]]:
    """By every name that a person may type for a column, with and without that of a part: its key, and where it stands."""
    out: dict[str, tuple[str, tuple[tuple[RawTable, RawColumn], ...]]] = {}
    for part in parts:
        for column in part.raw.columns:
            for name in (column.name, *known_as(column)):
                key, places = out.get(name, (column.name, ()))
                out[name] = (key, (*places, (part.raw, column)))
                if part.name:
                    out[f"{part.name}/{name}"] = (f"{part.name}/{column.name}", ((part.raw, column),))
    return out
