"""What an export loses, as tables and as the text beside the files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from coeflab.core.symbols import COMPONENTS
from coeflab.model.loss import LOSSLESS, Loss
from coeflab.model.lost import Kind
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.table import Table, coefficient, number

NAMED = 3


def forces(loss: Loss) -> Table:
    """Difference of the target's force from the file's."""
    shares = np.where(loss.relative > LOSSLESS, loss.relative, 0.0)
    rows = tuple(
        (
            c,
            "N*m" if c in "KMN" else "N",
            number(a, 4),
            number(b * (x > 0.0), 3),
            number(r * (x > 0.0), 3),
            f"{100.0 * x:.2g} %",
        )
        for c, a, b, r, x in zip(COMPONENTS, loss.largest, loss.worst, loss.rms, shares, strict=True)
    )
    notes = [
        f"over {loss.grid}; steady motion, FRD, about the file's reference point; 0 is less than {LOSSLESS:g} of the largest; worst of "
        "largest: both over these states"
    ]
    notes += [
        f"worse than no force at all: {c}, whose rms difference is {number(loss.rms[i], 3)} where the file's own rms is {number(loss.size[i], 3)}"
        for i, c in enumerate(COMPONENTS)
        if c in loss.worse_than_nothing
    ]
    notes += [f"not held: {what}" for what in loss.not_held]
    notes += [str(each) for each in loss.lost]
    notes += [f"changed: {what}" for what in loss.changes]
    headers = ("", "unit", "largest", "worst difference", "rms difference", "worst of largest")
    return Table(
        f"Force law of {loss.target} against the parameter file", headers, rows, tuple(notes), frozenset({0, 1})
    )


def in_short(loss: Loss) -> str:
    """The loss on one line: what is not held, what else is lost, and the largest difference of a component."""
    said = [f"it has no {_some(loss.not_held, NAMED)}"] if loss.not_held else []
    said += [_some([str(x) for x in loss.lost], 1)] if loss.lost else []
    worst = int(loss.relative.argmax())
    if loss.relative[worst] > LOSSLESS or not said:
        said.append(f"{COMPONENTS[worst]} differs by up to {100.0 * loss.relative[worst]:.2g} % of its largest")
    return ", and ".join(said)


def counted(loss: Loss) -> str:
    """How much is lost, by kind."""
    kinds = Counter(x.kind for x in loss.lost)
    kinds[Kind.NOT_HELD] += len(loss.not_held)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in Kind if kinds[kind])


def _some(words: Sequence[str], most: int) -> str:
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")


def parts(parameters: ParameterFile) -> Table:
    """Total, potential and viscous part of every coefficient; no rows without added mass."""
    rows = tuple(
        (c.symbol, coefficient(c.value), coefficient(c.potential), coefficient(c.value - c.potential), c.origin)
        for c in parameters.coefficients
        if c.value is not None and c.potential is not None
    )
    hull = parameters.added_mass
    notes = [] if hull is None else [f"potential part by the added mass of {hull.body}, method {hull.method}"]
    if hull is not None and hull.body != parameters.body:
        notes.append(f"not of one body: the coefficients are those of {parameters.body}")
    headers = ("", "total", "potential", "viscous", "origin")
    return Table("Parts of the coefficients", headers, rows, tuple(notes), frozenset({0, 4}))


def as_text(loss: Loss, parameters: ParameterFile) -> str:
    """The loss report: plain text, the same bytes for the same file."""
    lines = [f"Loss report: {parameters.name} ({parameters.body}) for {loss.target}", ""]
    lines.append(
        "Lossless." if loss.lossless else f"This export is not lossless: {counted(loss) or 'the force differs'}."
    )
    for table in (forces(loss), parts(parameters)):
        if table.rows:
            lines += ["", table.title, *_aligned(table), *(f"  {n}" for n in table.notes)]
    return "\n".join(lines) + "\n"


def _aligned(table: Table) -> list[str]:
    rows = [table.headers, *table.rows]
    widths = [max(len(r[i]) for r in rows) for i in range(len(table.headers))]
    return [
        "  "
        + "  ".join(
            cell.ljust(w) if i in table.left else cell.rjust(w)
            for i, (cell, w) in enumerate(zip(r, widths, strict=True))
        ).rstrip()
        for r in rows
    ]
