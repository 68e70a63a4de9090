"""What the symmetry of a body makes zero: the derivatives that a mirror, or half a turn about x, gives the other sign."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import read_factors
from coeflab.study.study import Study
from coeflab.tables.campaign import FOURFOLD, PORT_STARBOARD, UP_DOWN

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
