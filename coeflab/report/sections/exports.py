"""Exports in a report: what every target makes of a parameter file, and what it loses."""

from __future__ import annotations

import numpy as np

from coeflab.core.table import ABSENT, Table
from coeflab.formats import loss_tables
from coeflab.formats.export import ASSUMED, LOSSLESS, Export, Kind, Loss, Refused
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.report.document import Section
from coeflab.study.study import Study
from coeflab.vehicle.inertia import against_computed

EXPORTED = (
    "Largest difference: forces and accelerations of the written file by the simulator's own equations against those of the parameter file.",
)


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
    text = (*EXPORTED, *refused, *added_masses(study))
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


KINDS = {
    Kind.NOT_HELD: "a term that the target's force law does not have",
    Kind.MISSING: "a number that the target needs and the parameter file does not state",
    Kind.REPLACED: "a number of the parameter file in whose place the target gets another",
    Kind.MISMATCH: "a number that the target understands in another way",
    Kind.LEFT_OUT: "a term with which the target would drive what the file damps, or damp what it drives",
}


ACCELERATIONS = {
    "measured": "the file's acceleration derivatives; gaps are filled with computed added mass",
    "computed": "computed added mass only",
}


def summary(study: Study) -> Table:
    """One row an export, those that were refused last."""
    rows = tuple(
        (result.parameters, result.target, _verdict(result), _worst(result), _accelerations(result), _place(result))
        for result in study.exports
    )
    rows += tuple((r.parameters, r.target, "refused", ABSENT, ABSENT, "none") for r in study.refused)
    headers = ("parameter file", "target", "loss", "largest difference in %", "added mass", "files")
    lossy = [result.loss for result in study.exports if result.loss is not None]
    kinds = {x.kind for loss in lossy for x in loss.lost} | {Kind.NOT_HELD for loss in lossy if loss.not_held}
    notes = (
        *(
            ("accepted: the study's plan allows this loss, so the file is written.",)
            if any("accepted" in row[2] for row in rows)
            else ()
        ),
        *(f"{kind}: {KINDS[kind]}." for kind in Kind if kind in kinds),
        *(
            f"added mass {used}: {ACCELERATIONS[used]}."
            for used in ACCELERATIONS
            if any(row[4] == used for row in rows)
        ),
        *(["files: each row also has one loss report, .loss.txt."] if lossy else []),
        "Largest difference in %: export minus parameter file, of any force or acceleration, divided by its largest value. A "
        "component below 1 % of the largest force or moment is too small to judge. "
        f"States tried: the ranges of the campaigns; from -{ASSUMED:g} to {ASSUMED:g} (primed) for a motion that no campaign varies.",
    )
    return Table("Exports of this study", headers, rows, notes, frozenset({0, 1, 2, 4, 5}))


def _accelerations(made: Export) -> str:
    return ABSENT if made.loss is None else made.loss.water.used


def _verdict(made: Export) -> str:
    if made.loss is None:
        return "none: tables of the file's own values"
    if made.lossless:
        return "none"
    return f"accepted: {loss_tables.counted(made.loss) or 'force or acceleration differs'}"


def _worst(made: Export) -> str:
    if made.loss is None:
        return ABSENT
    name, worst = made.loss.furthest
    small = made.loss.too_small
    if name not in small:
        return f"{loss_tables.percent(worst)} ({name})" if worst > LOSSLESS else loss_tables.percent(worst)
    shares = {c: float(x) for c, x in zip(COMPONENTS, np.nan_to_num(made.loss.relative), strict=True) if c not in small}
    if made.loss.accelerations is not None:
        i, share = made.loss.accelerations.furthest
        shares[f"d{MOTIONS[i]}/dt"] = share
    name = max(shares, key=lambda c: shares[c])
    rest = (
        f"{loss_tables.percent(shares[name])} ({name})"
        if shares[name] > LOSSLESS
        else loss_tables.percent(shares[name])
    )
    return f"{rest}; {', '.join(small)} too small to judge"


def _place(made: Export) -> str:
    names = ", ".join(n for n in sorted(made.files) if made.loss is None or not n.endswith(".loss.txt"))
    return f"{made.folder}/: {names}" if made.folder else names
