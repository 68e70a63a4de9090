"""What the symmetry of a body makes zero: the derivatives that a mirror, or half a turn about x, gives the other sign."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from coeflab.core.finding import Finding, Severity
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import read_factors
from coeflab.study.study import Study
from coeflab.tables.campaign import FOURFOLD, PORT_STARBOARD, UP_DOWN

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.tables.force_table import ForceTable

# What changes sign in each symmetry: in a mirror the motions across and the turns along it, in half a turn about x both across.
FLIPS = {
    PORT_STARBOARD: frozenset(("Y", "K", "N", "v", "p", "r", "dr")),
    UP_DOWN: frozenset(("Z", "K", "M", "w", "p", "q", "ds", "db")),
    FOURFOLD: frozenset(("Y", "Z", "M", "N", "v", "w", "q", "r", "dr", "ds", "db")),
}
OF_SHAPES = {"port-starboard": PORT_STARBOARD, "top-bottom": UP_DOWN}


def symmetries(study: Study, campaign: str, body: str) -> frozenset[str]:
    """Symmetries that tables of a campaign declare, or the shape of its body has.

    Parameters
    ----------
    study : Study
    campaign, body : str
    """
    declared = {name for t in study.tables if t.campaign == campaign for name in t.symmetry}
    shapes = {p for h in study.hulls.values() if h.body.name == body for p in h.mirror_planes}
    return frozenset(declared | {OF_SHAPES[p] for p in shapes if p in OF_SHAPES})


def is_zero(symbol: str, under: frozenset[str]) -> bool:
    """Whether a body of these symmetries has zero for a derivative; factors between bars do not change sign.

    Parameters
    ----------
    symbol : str
        Such as ``Kv|v|``, with or without prime.
    under : frozenset of str
        Of `coeflab.tables.campaign.SYMMETRIES`.
    """
    plain = symbol.removesuffix("'")
    signed = [name.removesuffix("dot") for name, absolute in read_factors(plain[1:]) or () if not absolute]
    return any(sum(name in FLIPS[s] for name in (plain[0], *signed)) % 2 == 1 for s in under)


def zeros(study: Study, campaign: str, among: Sequence[Coefficient]) -> tuple[Coefficient, ...]:
    """Those that symmetry makes zero and whose interval holds zero; an asymmetry that was measured is none of them."""
    under = {body: symmetries(study, campaign, body) for body in {c.body or "" for c in among}}
    return tuple(
        c for c in among
        if c.value is not None and c.u95 is not None and abs(c.value) <= c.u95 and is_zero(c.symbol, under[c.body or ""])
    )  # fmt: skip


def of_bodies(
    tables: Sequence[ForceTable], bodies: Sequence[Body]
) -> tuple[list[ForceTable], frozenset[str], list[Finding]]:
    """The tables without those turned by a quarter of a turn that their body rules out; names of those that it confirms; what it rules out.

    Parameters
    ----------
    tables : sequence of ForceTable
    bodies : sequence of Body
        Those that a plan names. A table whose body is none of them, or counts from another datum, stays, and is not confirmed.
    """
    from coeflab.bodies.images import is_fourfold

    selected, right, found = [], set(), []
    moving = {t.name: set(t.varies) for t in tables}
    for t in tables:
        turned = FOURFOLD in t.symmetry and moving[t.name] != moving.get(t.by_symmetry, moving[t.name])
        body = next((b for b in bodies if turned and (b.name, b.datum) == (t.body, t.datum)), None)
        has = None if body is None else is_fourfold(body, t.reference_point)
        if has is False:
            found.append(Finding.of("symmetry.body", t.name, Severity.WARN, turned=t.by_symmetry, body=t.body))
            continue
        selected.append(t)
        right |= {t.name} if has else set()
    return selected, frozenset(right), found


def confirmed(fit: FitResult, by_body: frozenset[str]) -> FitResult:
    """The fit whose coefficients of the tables of these names assume no symmetry, since their body has it."""

    def of(c: Coefficient) -> Coefficient:
        if c.status is not Status.SYMMETRY_ASSUMED or c.table not in by_body:
            return c
        is_open = c.value is not None and c.u95 is not None and abs(c.value) <= c.u95
        return replace(c, status=Status.SIGN_OPEN if is_open else Status.OK)

    return replace(
        fit, coefficients=replace(fit.coefficients, coefficients=tuple(map(of, fit.coefficients.coefficients)))
    )
