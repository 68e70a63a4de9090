"""What an export loses, as tables and as the text beside the files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from coeflab.core.symbols import COMPONENTS, MOTIONS
from coeflab.model.inertia import WaterInertia
from coeflab.model.loss import LOSSLESS, Apart, Loss
from coeflab.model.lost import Kind
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.potential import potential_part
from coeflab.model.scaling import Scaling
from coeflab.model.table import ABSENT, Table, coefficient, number

NAMED = 3


def forces(loss: Loss) -> Table:
    """Difference of the target's force, and of the acceleration it gives the vehicle, from the file's."""
    rows = [_row(c, "N*m" if c in "KMN" else "N", loss.forces, i) for i, c in enumerate(COMPONENTS)]
    if loss.accelerations is not None:
        rows += [
            _row(f"d{m}/dt", "rad/s^2" if m in "pqr" else "m/s^2", loss.accelerations, i) for i, m in enumerate(MOTIONS)
        ]
    notes = [
        f"over {loss.grid}; steady motion, FRD, about the file's reference point; 0 is less than {LOSSLESS:g} of the largest; worst of "
        "largest: both over these states"
    ]
    if loss.accelerations is not None:
        notes.append(
            "du/dt to dr/dt: accelerations of the file's rigid body in these states, and from rest under a push along each axis as "
            "large as the file's largest force or moment; the target's with the added mass in its own files"
        )
    if loss.not_compared:
        notes.append(loss.not_compared)
    notes.append(loss.water.source)
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
        f"Force law of {loss.target} against the parameter file", headers, tuple(rows), tuple(notes), frozenset({0, 1})
    )


def _row(name: str, unit: str, found: Apart, i: int) -> tuple[str, ...]:
    """One component; no number where it is not compared."""
    share = found.relative[i]
    if not share <= LOSSLESS and not share > LOSSLESS:
        return name, unit, *[ABSENT] * 4
    seen = float(share > LOSSLESS)
    worst, rms = (number(x[i] * seen, 3) for x in (found.worst, found.rms))
    return name, unit, number(found.largest[i], 4), worst, rms, percent(share)


def percent(share: float) -> str:
    """A relative difference in per cent, 0 where it is rounding."""
    return f"{100.0 * share if share > LOSSLESS else 0.0:.2g} %"


def in_short(loss: Loss) -> str:
    """The loss on one line: what is not held, what else is lost, and the largest difference of a force and of an acceleration."""
    said = [f"it has no {_some(loss.not_held, NAMED)}"] if loss.not_held else []
    said += [_some([str(x) for x in loss.lost], 1)] if loss.lost else []
    found: list[tuple[int, float, Sequence[str]]] = [(*loss.forces.furthest, COMPONENTS)]
    if loss.accelerations is not None:
        found.append((*loss.accelerations.furthest, tuple(f"d{m}/dt" for m in MOTIONS)))
    for i, share, names in found:
        if share > LOSSLESS or not said:
            said.append(f"{names[i]} differs by up to {percent(share)} of its largest")
    return ", and ".join(said)


def counted(loss: Loss) -> str:
    """How much is lost, by kind."""
    kinds = Counter(x.kind for x in loss.lost)
    kinds[Kind.NOT_HELD] += len(loss.not_held)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in Kind if kinds[kind])


def _some(words: Sequence[str], most: int) -> str:
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")


def parts(parameters: ParameterFile, water: WaterInertia | None = None) -> Table:
    """Total, potential and viscous part of every coefficient; no rows without added mass.

    Parameters
    ----------
    parameters : ParameterFile
    water : WaterInertia, optional
        The added mass that gives the potential parts; without it that of the file, as booked there.
    """
    hull = parameters.added_mass
    booked = [(c, c.value, c.potential) for c in parameters.coefficients]
    if water is not None and hull is not None:
        scaling = Scaling(parameters.scaling.length, parameters.scaling.length_name)
        noun = water.as_noun(parameters)
        booked = [
            (c, v, None if p is None else potential_part(c.symbol, noun, scaling, parameters.conditions.density))
            for c, v, p in booked
        ]
    rows = tuple(
        (c.symbol, coefficient(v), coefficient(p), coefficient(v - p), c.origin)
        for c, v, p in booked
        if v is not None and p is not None
    )
    notes = []
    if hull is not None:
        by = f"the added mass of {hull.body}, method {hull.method}"
        notes.append(f"potential part by {by if water is None else f'the added mass in use; {water.source}'}")
        if hull.body != parameters.body:
            notes.append(f"not of one body: the coefficients are those of {parameters.body}")
    headers = ("", "total", "potential", "viscous", "origin")
    return Table("Parts of the coefficients", headers, rows, tuple(notes), frozenset({0, 4}))


def as_text(loss: Loss, parameters: ParameterFile) -> str:
    """The loss report: plain text, the same bytes for the same file."""
    lines = [f"Loss report: {parameters.name} ({parameters.body}) for {loss.target}", ""]
    lines.append(
        "Lossless."
        if loss.lossless
        else f"This export is not lossless: {counted(loss) or 'force or acceleration differs'}."
    )
    for table in (forces(loss), parts(parameters, loss.water)):
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
