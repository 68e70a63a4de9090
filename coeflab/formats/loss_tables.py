"""What an export loses, as tables and as the text beside the files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from coeflab.core.table import ABSENT, Table, coefficient, number
from coeflab.core.texts import remark
from coeflab.formats.loss import LOSSLESS, Apart, Loss
from coeflab.formats.missing_parts import Kind
from coeflab.law.added_mass import potential_part
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.inertia import MEASURED, WaterInertia, stated_accelerations
from coeflab.vehicle.law_at_points import LawAtPoints
from coeflab.vehicle.parameter_file import ParameterFile

RARE = "astern, broadside and at rest"

NAMED = 3
MOST_APART = 1000.0  # per cent of a force; a larger difference is not told from this one
IN_PERCENT = (
    "Largest and rms: difference of law and points, in % of the largest force of the component in that table; where: the point with the largest difference. Two errors of the set-up are subtracted from the points first: a force "
    "at zero angle and rate that the law does not contain, and the part of X that is odd in the drift."
)


def forces(loss: Loss) -> Table:
    """Difference of the target's force, and of the acceleration it gives the vehicle, from the file's."""
    rows = [_row(c, "N*m" if c in "KMN" else "N", loss.forces, i) for i, c in enumerate(COMPONENTS)]
    if loss.accelerations is not None:
        rows += [
            _row(f"d{m}/dt", "rad/s^2" if m in "pqr" else "m/s^2", loss.accelerations, i) for i, m in enumerate(MOTIONS)
        ]
    notes = [
        f"At {loss.grid}; in steady motion, FRD, about the file's reference point.",
        f"0: below {LOSSLESS:g} of the largest value.",
        *loss.controls,
    ]
    if (rare := in_rare_states(loss)) and loss.rare is not None:
        notes.append(rare)
    if loss.accelerations is not None:
        notes.append(
            "du/dt to dr/dt: accelerations of the file's rigid body in these states, and from rest under a force along each axis as "
            "large as the file's largest; those of the target use the added mass in its own files."
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
    headers = ("", "unit", "largest value", "max. difference", "rms difference", "max. in %")
    return Table(
        f"Force law of {loss.target} against the parameter file", headers, tuple(rows), tuple(notes), frozenset({0, 1})
    )


def in_rare_states(loss: Loss) -> str:
    """The differences astern, broadside and at rest, in words; empty where there is none."""
    if loss.rare is None or not loss.rare.furthest[1] > LOSSLESS:
        return ""
    each = zip(COMPONENTS, loss.rare.worst, loss.rare.relative, strict=True)
    words = [f"{c} {number(w, 3)} {'N*m' if c in 'KMN' else 'N'} ({percent(s)})" for c, w, s in each if s > LOSSLESS]
    return f"{RARE}, which the rows above do not hold, the largest differences are {', '.join(words)}"


def at_points(found: Sequence[LawAtPoints], whose: str, *, controls: bool = True) -> Table:
    """A law against the measured points, by component and table; no rows where the file has no points.

    Parameters
    ----------
    found : sequence of LawAtPoints
    whose : str
        Whose law it is, in words.
    controls : bool
        Whether rows with a control off zero are among the points.
    """
    rows = tuple(
        (f.component, f.table, str(f.n_points - len(f.beyond)),
         *(ABSENT if f.small or len(f.beyond) == f.n_points else percent(x) for x in (f.share, f.rms_share)), f.worst_at,
         ABSENT if f.small else percent(f.allowed / f.largest if f.largest else 0.0), at_points_verdict(f))
        for f in found
    )  # fmt: skip
    notes = [IN_PERCENT]
    if not controls:
        notes.append("Points with a deflected control are left out: no force of controls is compared.")
    notes += [
        f"{f.component}, {f.table}: points {', '.join(f.beyond)} lie outside the range of the law; the largest difference there is "
        f"{percent(f.worst_beyond / f.largest if f.largest else 0.0)}."
        for f in found
        if f.beyond
    ]
    headers = ("force", "table", "points", "largest", "rms", "where", "allowed", "verdict")
    return Table(f"{whose} against its points", headers, rows, tuple(notes), frozenset({0, 1, 5, 7}), ("where", "rms"))


def at_points_verdict(f: LawAtPoints) -> str:
    """One word or two on a component."""
    if f.small:
        return "too small to judge"
    if f.missed:
        return f"misses {len(f.missed)}"
    n = len(f.beyond)
    if n == f.n_points:
        return "not compared: no point in its range"
    return f"holds; {n} point{'s' * (n > 1)} outside its range" if n else "holds"


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
    value = 100.0 * share if share > LOSSLESS else 0.0
    return f"> {MOST_APART:.0f} %" if value > MOST_APART else f"{value:.0f} %" if value >= 99.5 else f"{value:.2g} %"


def in_short(loss: Loss) -> str:
    """The loss on one line: what is not held, what else is lost, and the largest difference of a force and of an acceleration."""
    terms = [what.partition(" (")[0].partition(": ")[0] for what in loss.not_held]
    words = [f"no {_some(terms, NAMED)}"] if terms else []
    others: dict[str, list[str]] = {}
    for x in loss.lost:
        others.setdefault(x.kind, []).append(x.what.partition("; ")[0].partition(": ")[0])
    words += [f"{kind}: {_some(whats, 1)}" for kind, whats in others.items()]
    found: list[tuple[int, float, Sequence[str], str]] = [(*loss.forces.furthest, COMPONENTS, "")]
    if loss.accelerations is not None:
        found.append((*loss.accelerations.furthest, tuple(f"d{m}/dt" for m in MOTIONS), ""))
    if loss.rare is not None:
        found.insert(loss.furthest[1] > LOSSLESS and len(found), (*loss.rare.furthest, COMPONENTS, f" {RARE}"))
    for i, share, names, where in found:
        if share > LOSSLESS or not words:
            by = percent(share).replace(">", "more than") if 100.0 * share > MOST_APART else f"up to {percent(share)}"
            words.append(f"{names[i]} {by}{where}" if where else f"{names[i]} differs by {by} of its largest")
    return ", and ".join(words)


def counted(loss: Loss) -> str:
    """How much is lost, by kind."""
    kinds = Counter(x.kind for x in loss.lost)
    kinds[Kind.NOT_HELD] += len(loss.not_held)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in Kind if kinds[kind])


def _some(words: Sequence[str], most: int) -> str:
    return ", ".join(words) if len(words) <= most + 1 else f"{', '.join(words[:most])} and {len(words) - most} more"


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
        noun, primes, density = water.as_noun(parameters), parameters.scaling, parameters.conditions.density
        booked = [(c, v, None if p is None else potential_part(c.symbol, noun, primes, density)) for c, v, p in booked]
    rows = tuple(
        (c.symbol, coefficient(v), coefficient(p), coefficient(v - p), c.origin)
        for c, v, p in booked
        if v is not None and p is not None
    )
    notes = []
    if hull is not None:
        by = f"the added mass of {hull.body}, method {hull.method}"
        notes.append(f"potential part by {by if water is None else f'the added mass in use; {water.source}'}")
        if water is not None and water.used == MEASURED:
            notes.append(f"the parameter file books other potential parts, by {by} alone; the totals are the same")
        elif water is None and stated_accelerations(parameters):
            notes.append(
                "motions and exports take the acceleration derivatives of the file first, and subtract what these give"
            )
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
    lines += [f"Of the parameter file, {f.severity}: {remark(f)}" for f in parameters.findings]
    measured = at_points(loss.at_points, f"Force law of {loss.target}", controls=False)
    own = at_points(points_of(parameters), "Force law of the parameter file")
    if not own.rows:
        lines.append("The parameter file has no measured points to compare the two laws with.")
    for table in (forces(loss), measured, own, parts(parameters, loss.water)):
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
