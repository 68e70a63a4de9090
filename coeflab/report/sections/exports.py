"""Exports in a report: what every target makes of a parameter file, and what it loses."""

from __future__ import annotations

import numpy as np

from coeflab.core.table import ABSENT, Table
from coeflab.formats import loss_tables
from coeflab.formats.export import Export, Refused
from coeflab.formats.loss import ASSUMED, LOSSLESS, Loss
from coeflab.formats.missing_parts import Kind
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.report.document import Section
from coeflab.report.texts import table_of, text_of, texts_of
from coeflab.study.study import Study
from coeflab.vehicle.inertia import against_computed


def export_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no export."""
    if not study.exports and not study.refused:
        return ()
    each = tuple(
        Section(
            f"export-{i}",
            f"{result.parameters} for {result.target}",
            tables=_tables(result.target, result.loss),
            appendix=True,
        )
        for i, result in enumerate(study.exports)
        if result.loss is not None
    )
    refused = tuple(f"Refused, and not written: {_sentence(r)}" for r in study.refused)
    text = (*texts_of("exports.section"), *refused, *added_masses(study))
    return (Section("exports", "Exports", text, (summary(study),), subsections=each),)


def added_masses(study: Study) -> tuple[str, ...]:
    """Of every parameter file that is exported, where its added mass rests on a mean or differs from the computed one."""
    waters = {result.parameters: result.loss.water for result in study.exports if result.loss is not None}
    files = {p.name: p for p in study.parameter_files.values()}
    each = {name: [*w.warnings, against_computed(files[name]) if name in files else ""] for name, w in waters.items()}
    named = {name: ". ".join(f"{w[:1].upper()}{w[1:]}" for w in words if w) for name, words in each.items()}
    return tuple(
        f"Added mass of {name} for stability, motions and exports: {words}." for name, words in named.items() if words
    )


def _tables(target: str, loss: Loss) -> tuple[Table, ...]:
    points = loss_tables.at_points(loss.at_points, f"Force law of {target}", controls=False)
    return (loss_tables.forces(loss), *((points,) if points.rows else ()))


def _sentence(refused: Refused) -> str:
    why = refused.why
    return f"{refused.parameters} for {refused.target}. Found {why.found}; expected {why.expected}."


def summary(study: Study) -> Table:
    """One row an export, those that were refused last."""
    rows = tuple(
        (result.parameters, result.target, _verdict(result), _worst(result), _accelerations(result), _place(result))
        for result in study.exports
    )
    rows += tuple((r.parameters, r.target, "refused", ABSENT, ABSENT, "none") for r in study.refused)
    lossy = [result.loss for result in study.exports if result.loss is not None]
    kinds = {x.kind for loss in lossy for x in loss.lost} | {Kind.NOT_HELD for loss in lossy if loss.not_held}
    notes = (
        *(
            ("accepted: the study's plan allows this loss, so the file is written.",)
            if any("accepted" in row[2] for row in rows)
            else ()
        ),
        *(f"{kind}: {text_of(f'exports.kind_{kind.name.lower()}')}." for kind in Kind if kind in kinds),
        *(
            f"added mass {used}: {text_of(f'exports.added_mass_{used}')}."
            for used in ("measured", "computed")
            if any(row[4] == used for row in rows)
        ),
        *(["files: each row also has one loss report, .loss.txt."] if lossy else []),
        text_of("exports.largest", assumed=ASSUMED),
    )
    return table_of("exports.summary", rows, notes)


def _accelerations(result: Export) -> str:
    return ABSENT if result.loss is None else result.loss.water.used


def _verdict(result: Export) -> str:
    if result.loss is None:
        return "none: tables of the file's own values"
    if result.lossless:
        return "none"
    return f"accepted: {loss_tables.counted(result.loss) or 'force or acceleration differs'}"


def _worst(result: Export) -> str:
    if result.loss is None:
        return ABSENT
    name, worst = result.loss.furthest
    small = result.loss.too_small
    if name not in small:
        return f"{loss_tables.percent(worst)} ({name})" if worst > LOSSLESS else loss_tables.percent(worst)
    shares = {
        c: float(x) for c, x in zip(COMPONENTS, np.nan_to_num(result.loss.relative), strict=True) if c not in small
    }
    if result.loss.accelerations is not None:
        i, share = result.loss.accelerations.furthest
        shares[f"d{MOTIONS[i]}/dt"] = share
    name = max(shares, key=lambda c: shares[c])
    rest = (
        f"{loss_tables.percent(shares[name])} ({name})"
        if shares[name] > LOSSLESS
        else loss_tables.percent(shares[name])
    )
    return f"{rest}; {', '.join(small)} too small to judge"


def _place(result: Export) -> str:
    names = ", ".join(n for n in sorted(result.files) if result.loss is None or not n.endswith(".loss.txt"))
    return f"{result.folder}/: {names}" if result.folder else names
