"""Exports in a report: what every target makes of a parameter file, and what it loses."""

from __future__ import annotations

from coeflab.model.export import Export, Refused
from coeflab.model.loss import ASSUMED, LOSSLESS
from coeflab.model.study import Study
from coeflab.model.table import ABSENT, Table
from coeflab.presentation import loss_tables
from coeflab.presentation.document import Section

TEXT = (
    "The files were read again and evaluated by the target's own force law, written from its source, beside the force law of the "
    "parameter file. A difference is what a simulation with that target has wrong in steady motion, if the parameter file is "
    "right.",
    "Where a target adds -C_A(nu) nu itself, first-order derivatives are given to it less their potential part, so that nothing "
    "counts twice.",
)


def export_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no export."""
    if not study.exports and not study.refused:
        return ()
    each = tuple(
        Section(f"export-{i}", f"{made.parameters} for {made.target}", tables=(loss_tables.forces(made.loss),))
        for i, made in enumerate(study.exports)
        if made.loss is not None
    )
    refused = tuple(f"Refused, and not written: {_sentence(r)}" for r in study.refused)
    return (Section("exports", "Exports", (*TEXT, *refused), (summary(study),), subsections=each),)


def _sentence(refused: Refused) -> str:
    why = refused.why
    return f"{refused.parameters} for {refused.target}. Found {why.found}; expected {why.expected}."


def summary(study: Study) -> Table:
    """One row an export, those that were refused last."""
    rows = tuple((made.parameters, made.target, _verdict(made), _worst(made), _place(made)) for made in study.exports)
    rows += tuple((r.parameters, r.target, "refused", ABSENT, "none") for r in study.refused)
    headers = ("parameter file", "target", "loss", "worst of largest", "files")
    notes = (
        "worst of largest: largest difference of a force component over its largest value, both over the states that the loss of "
        f"each export names: what campaigns cover, and primes to {ASSUMED:g} either way of a motion that none covers",
    )
    return Table("Exports of this study", headers, rows, notes, frozenset({0, 1, 2, 4}))


def _verdict(made: Export) -> str:
    if made.loss is None:
        return "none: tables of the file's own values"
    if made.lossless:
        return "none"
    return f"accepted: {loss_tables.counted(made.loss) or 'the force differs'}"


def _worst(made: Export) -> str:
    if made.loss is None:
        return ABSENT
    worst = float(made.loss.relative.max())
    return f"{100.0 * worst if worst > LOSSLESS else 0.0:.2g} %"


def _place(made: Export) -> str:
    names = ", ".join(sorted(made.files))
    return f"{made.folder}/: {names}" if made.folder else names
