"""What a table rests on that no source states: keys of campaign.toml that were accepted, and which coefficients hang on each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from coeflab.core.finding import Finding, Severity
from coeflab.law.symbols import ANGULAR, CONTROLS, MOMENTS, MOTIONS, derivative, primed

CODE, INERTIA = "assumed.key", "assumed.inertia"
FLAG = " *"  # behind a coefficient that hangs on something which no source states


class Moves(NamedTuple):
    """Which coefficients a key moves: those in one of the motions, and those of one of the components; both empty: all."""

    motions: tuple[str, ...] = ()
    components: tuple[str, ...] = ()


_RATES = Moves(ANGULAR)
_POINT = Moves(ANGULAR, MOMENTS)
MOVES = {
    "axes.alpha": Moves(("w",)),
    "axes.beta": Moves(("v",)),
    **dict.fromkeys(("axes.reference_point", "axes.datum", "table.reference_point"), _POINT),
    **dict.fromkeys(("table.arm_point", "table.centre", "table.contains_inertia"), _RATES),
    **dict.fromkeys(("inertia.mass", "inertia.centre_of_gravity", "inertia.inertia"), _RATES),
    "coefficients.length": Moves((), MOMENTS),
}


def moved_by(key: str) -> Moves:
    """Which coefficients a key of a campaign moves; ``columns.beta`` and ``columns.Y`` are the unit of one column.

    Examples
    --------
    >>> moved_by("table.arm_point").motions
    ('p', 'q', 'r')
    """
    name = key.removeprefix("columns.")
    if name != key and name in (*MOTIONS, *CONTROLS):
        return Moves((name,))
    if name != key and name in ("alpha", "beta"):
        return MOVES[f"axes.{name}"]
    if name != key and name[:1] in "XYZKMN" and len(name) == 1:
        return Moves((), (name,))
    return MOVES.get(key, Moves())


def assumed(key: str, table: str, value: Any, severity: Severity = Severity.WARN) -> Finding:
    """A key that was accepted and that no source states.

    Parameters
    ----------
    key : str
        Of campaign.toml, such as ``table.arm_point``.
    table : str
        Name of the table.
    value : object
        What it is taken for; shown.
    severity : Severity
    """
    motions, components = moved_by(key)
    of = " or ".join(
        [*([f"in {', '.join(motions)}"] * bool(motions)), *([f"of {', '.join(components)}"] * bool(components))]
    )
    return Finding.of(
        CODE, table, severity, advice=key, key=key, value=str(value), motions=motions, components=components,
        symbols=(f"every coefficient {of}".strip(),),
    )  # fmt: skip


def depends(found: Finding, symbol: str, table: str | None = None) -> bool:
    """Whether a coefficient hangs on what a finding says of a table.

    Parameters
    ----------
    found : Finding
        With the facts ``motions`` and ``components``; one without them concerns every coefficient of its table.
    symbol : str
    table : str, optional
        Tables of the coefficient, where they are known.

    Examples
    --------
    >>> here = assumed("table.arm_point", "tank/arm.csv", "reference point")
    >>> depends(here, "Yr"), depends(here, "Yv"), depends(here, "Yr", "tank/drift.csv")
    (True, False, False)
    """
    if table and found.subject not in table:
        return False
    facts: dict[str, Any] = dict(found.facts)
    motions, components = facts.get("motions", ()), facts.get("components", ())
    of = derivative(symbol.removesuffix("'"))
    return (
        not (motions or components)
        or of.component in components
        or any(m.strip("|").removesuffix("dot") in motions for m in of.factors)
    )


def carried(findings: Iterable[Finding], coefficients: Sequence[Any]) -> tuple[Finding, ...]:
    """Findings of tables as a result carries them: each with the symbols of the coefficients that hang on it; idle ones left out.

    Parameters
    ----------
    findings : iterable of Finding
        Of the tables.
    coefficients : sequence of Coefficient
    """
    out = []
    for one in dict.fromkeys(findings):
        symbols = [primed(c.symbol) for c in coefficients if c.value is not None and depends(one, c.symbol, c.table)]
        if symbols:
            facts = {name: value for name, value in one.facts if name != "symbols"}
            out.append(
                Finding.of(
                    one.code, one.subject, one.severity, statistic=one.statistic, threshold=one.threshold, advice=one.advice,
                    **facts, symbols=tuple(dict.fromkeys(symbols)),
                )
            )  # fmt: skip
    return tuple(out)
