"""Whether densities are those of water, and the Reynolds number is that of speed, length and viscosity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.core.units import GRAMS
from coeflab.law.scaling import FASTEST, LENGTHS, beyond_ends, doubtful_size, speaks_of_air

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable

summary = "density, Reynolds number of speed, length and viscosity, reference point"
citations = ("ittc_water",)

WATER = (985.0, 1040.0)  # kg/m^3: fresh at 55 deg C to the Red Sea
AIR = (0.5, 1.6)  # kg/m^3: hot and high, cold and dense
ANOTHER = 2e-3  # more than 10 K make in fresh water
REYNOLDS = 0.05  # what LOA in the place of LBP makes


def check(study: Study) -> Sequence[Check]:
    """Findings on every campaign that was run in water or states viscosity and Reynolds number."""
    found = [c for t in {t.campaign: t for t in study.tables}.values() for c in _found(t)]
    rows = [(t.name, t.density) for t in study.tables if t.density is not None]
    found += [c for name, by_row in rows for c in _water(name, float(by_row.min()), float(by_row.max()))]
    return found + [c for name in study.parameter_files if study.plan.conditions is None for c in _waters(study, name)]


def _waters(study: Study, name: str) -> Iterator[Check]:
    """Campaigns of another water than the one of the file's SI values, which is that of the first."""
    file = study.parameter_files[name]
    of, density = {c.campaign for c in file.coefficients}, file.conditions.density
    others = {t.campaign: t.conditions.density for t in study.tables if t.campaign in of}
    if apart := [f"{c} {x:g}" for c, x in others.items() if abs(x / density - 1.0) > ANOTHER]:
        yield Check.of("conditions.waters", f"{name} density", Severity.NOTE, density=density, others=", ".join(apart))


def _water(name: str, low: float, high: float) -> Iterator[Check]:
    if not (AIR[0] <= low and high <= AIR[1]):
        good = WATER[0] <= low and high <= WATER[1]
        found = f"{low:.5g} kg/m^3" if low == high else f"{low:.5g} to {high:.5g} kg/m^3"
        match = "good" if good else "slugs" if low < WATER[0] / 10.0 else "bad"
        severity = Severity.PASS if good else Severity.WARN
        yield Check.of(
            "conditions.density", f"{name} density", severity, found=found, least=WATER[0], most=WATER[1], match=match
        )


def _sizes(t: ForceTable) -> Iterator[Check]:
    """Numbers that are probably in another unit."""
    in_air = (
        speaks_of_air((t.title, t.body, t.source.citation, t.source.how_obtained))
        or AIR[1] >= t.conditions.density > GRAMS[1]
    )
    at = {
        "conditions.density": t.conditions.density,
        "conditions.speed": t.conditions.speed,
        "scaling.length": t.scaling.length,
    }
    for key, number in at.items():
        if why := doubtful_size(key, number, in_air):
            found, _, advice = why.partition(": ")
            what = key.partition(".")[2]
            yield Check.of(
                "conditions.unit", f"{t.campaign} unit of {what}", Severity.WARN, found=found, what=what, fastest=FASTEST,
                advice=f"{advice[:1].upper()}{advice[1:]} in campaign.toml.", least=WATER[0], most=WATER[1],
                shortest=LENGTHS[0], longest=LENGTHS[1],
            )  # fmt: skip


def _found(t: ForceTable) -> Iterator[Check]:
    at = t.conditions
    yield from _water(t.campaign, at.density, at.density)
    yield from _sizes(t)
    point = t.reference_point if t.measured_about is None else t.measured_about
    if why := beyond_ends(t.datum.id, float(point[0]), t.scaling.length):
        yield Check.of(
            "conditions.point", f"{t.campaign} reference point", Severity.WARN, datum=t.datum.id, x=float(point[0]),
            advice=f"{why[:1].upper()}{why[1:]}.",
        )  # fmt: skip
    if at.viscosity is not None and at.reynolds is not None:
        own = at.speed * t.scaling.length / at.viscosity
        good = abs(own / at.reynolds - 1.0) <= REYNOLDS
        yield Check.of(
            "conditions.reynolds", f"{t.campaign} Reynolds number", Severity.PASS if good else Severity.WARN, own=own,
            length=t.scaling.length_name, stated=at.reynolds, share=REYNOLDS, match="good" if good else "bad",
        )  # fmt: skip
