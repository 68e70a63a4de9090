"""Whether densities are those of water, and the declared Reynolds number that of speed, length and viscosity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from coeflab.core.table import Check, Severity
from coeflab.study.study import Study
from coeflab.tables.force_table import ForceTable

summary = "density of water, Reynolds number against speed, length and viscosity"
citations = ("ittc_water",)

WATER = (985.0, 1040.0)  # kg/m^3: fresh at 55 deg C to the Red Sea
LIQUID = 100.0  # kg/m^3; below, the tests are in air
REYNOLDS = 0.05  # what LOA in the place of LBP makes


def check(study: Study) -> Sequence[Check]:
    """Findings on every campaign that was run in water or states viscosity and Reynolds number."""
    found = [c for t in {t.campaign: t for t in study.tables}.values() for c in _found(t)]
    rows = [(t.name, t.density) for t in study.tables if t.density is not None]
    return found + [c for name, by_row in rows for c in _water(name, float(by_row.min()), float(by_row.max()))]


def _water(name: str, low: float, high: float) -> Iterator[Check]:
    if low > LIQUID:
        good = WATER[0] <= low and high <= WATER[1]
        found = f"{low:.5g} kg/m^3" if low == high else f"{low:.5g} to {high:.5g} kg/m^3"
        yield Check(
            "conditions", f"{name} density", Severity.PASS if good else Severity.WARN, found,
            f"{WATER[0]:g} to {WATER[1]:g} kg/m^3, water", "" if good else "Coefficients of dimensional forces go with 1/density.",
        )  # fmt: skip


def _found(t: ForceTable) -> Iterator[Check]:
    at = t.conditions
    yield from _water(t.campaign, at.density, at.density)
    if at.viscosity is not None and at.reynolds is not None:
        own = at.speed * t.scaling.length / at.viscosity
        good = abs(own / at.reynolds - 1.0) <= REYNOLDS
        yield Check(
            "conditions", f"{t.campaign} Reynolds number", Severity.PASS if good else Severity.WARN,
            f"{own:.3g} from speed, {t.scaling.length_name} and viscosity, stated {at.reynolds:.3g}", f"within {REYNOLDS:.0%}",
            "" if good else "Speed, length or viscosity is not that of the tests.",
        )  # fmt: skip
