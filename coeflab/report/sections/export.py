"""Exports in a report: what every target makes of a parameter file, and what it loses."""

from __future__ import annotations

from coeflab.core.table import ABSENT, Table
from coeflab.formats.export import Export, Refused
from coeflab.formats.loss import ASSUMED, LOSSLESS, Loss
from coeflab.report.document import Section
from coeflab.report.tables import formats as loss_tables
from coeflab.study.study import Study

TEXT = (
    "The files were read again and evaluated by the target's own force law, written from its source, beside the force law of the "
    "parameter file; so are the accelerations that this force and the added mass in those files give. A difference is what a "
    "simulation with that target has wrong, if the parameter file is right.",
    "Where a target adds -C_A(nu) nu itself, first-order derivatives are given to it less their potential part, so that nothing "
    "counts twice.",
)


def export_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no export."""
    if not study.exports and not study.refused:
        return ()
    each = tuple(
        Section(f"export-{i}", f"{made.parameters} for {made.target}", tables=_tables(made.target, made.loss))
        for i, made in enumerate(study.exports)
        if made.loss is not None
    )
    refused = tuple(f"Refused, and not written: {_sentence(r)}" for r in study.refused)
    return (Section("exports", "Exports", (*TEXT, *refused), (summary(study),), subsections=each),)


def _tables(target: str, loss: Loss) -> tuple[Table, ...]:
    points = loss_tables.at_points(loss.at_points, f"Force law of {target}", controls=False)
    return (loss_tables.forces(loss), *((points,) if points.rows else ()))


def _sentence(refused: Refused) -> str:
    why = refused.why
    return f"{refused.parameters} for {refused.target}. Found {why.found}; expected {why.expected}."


def summary(study: Study) -> Table:
    """One row an export, those that were refused last."""
    rows = tuple(
        (made.parameters, made.target, _verdict(made), _worst(made), _accelerations(made), _place(made))
        for made in study.exports
    )
    rows += tuple((r.parameters, r.target, "refused", ABSENT, ABSENT, "none") for r in study.refused)
    headers = ("parameter file", "target", "loss", "worst of largest", "accelerations", "files")
    notes = (
        "worst of largest: largest difference of a force component or an acceleration over its largest value, both over the states that the loss of "
        f"each export names: what campaigns cover, and primes to {ASSUMED:g} either way of a motion that none covers",
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
    return f"{loss_tables.percent(worst)} ({name})" if worst > LOSSLESS else loss_tables.percent(worst)


def _place(made: Export) -> str:
    names = ", ".join(sorted(made.files))
    return f"{made.folder}/: {names}" if made.folder else names
