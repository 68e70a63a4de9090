"""Signs that every ordinary hull has: the quickest way to catch a wrong axis or angle, in a table or in a printed value."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import COMPONENTS, MOTIONS, primed
from coeflab.vehicle.plausible_added_mass import MISTYPED

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.vehicle.parameter_file import ParameterFile

summary = "Yv', Zw', Nr', Mq', X0' and accelerations negative, added mass symmetric; fitted and literature"
citations = ("gertler1967",)

NEGATIVE = {
    "Yv": "side force opposes side velocity",
    "Zw": "normal force opposes normal velocity",
    "Nr": "yaw moment opposes yaw rate",
    "Mq": "pitch moment opposes pitch rate",
    "X0": "drag points aft",
} | {f"{c}{m}dot": "water moves with the body" for c, m in zip(COMPONENTS, MOTIONS, strict=True)}
SYMBOLS = {"alpha": "Zw", "beta": "Yv"}  # whose sign an angle was inferred from
BY_PLACE = ("Nv", "Mw")  # signs that the place of a force on a known body shows
TWINS = (("Nvdot", "Yrdot"), ("Mwdot", "Zqdot"))


def check(study: Study) -> Sequence[Check]:
    """One finding per coefficient whose sign is known, and per pair of acceleration derivatives that ought to be equal."""
    assumed = {(t.campaign, SYMBOLS[a]): a for t in study.tables for a in t.assumed}
    out = []
    for c in study.coefficients:
        angle = assumed.get((c.campaign or "", c.symbol.removesuffix("'")))
        found = _signed(c.campaign, c, "") if angle is None else _inferred(c, angle)
        out += [] if found is None else [replace(found, campaign=c.campaign or "", symbol=c.symbol)]
    for name, file in study.parameter_files.items():
        for stated in (c for c in file.coefficients if c.origin == "literature"):
            found = _signed(name, stated, f"Stated in {stated.estimator}.")
            out += [] if found is None else [found]
        out += _twins(name, file)
    return [*out, *(as_check("signs", found) for found in unseen_columns(study))]


def unseen_columns(study: Study) -> tuple[Finding, ...]:
    """Columns whose sign, were it wrong all over, nothing would show: one note a campaign.

    The slopes of a motion's own force have a sign that every hull has. Nv' and Mw' are seen where an added mass is known: a wrong one
    moves the point where the force acts off the body (``coeflab params check``). Of others, such as Yr' or Kv', either sign is possible.
    """
    with_hull = {
        c.campaign
        for p in study.parameter_files.values()
        if p.added_mass is not None
        for c in p.coefficients
        if c.campaign
    }
    sure = {
        (c.campaign, c.symbol.removesuffix("'")) for c in study.coefficients
        if c.origin == "fit" and c.value is not None and c.u95 is not None and abs(c.value) > c.u95
    }  # fmt: skip
    unseen: dict[str, list[str]] = {}
    for t in study.tables:
        for component in t.forces:
            symbols = [f"{component}{v}" for v in t.varies if v in MOTIONS and (t.campaign, f"{component}{v}") in sure]
            seen = any(s in NEGATIVE or (s in BY_PLACE and t.campaign in with_hull) for s in symbols)
            if symbols and not seen:
                unseen.setdefault(t.campaign, []).append(f"{component} of {t.name} ({', '.join(map(primed, symbols))})")
    return tuple(
        Finding.of(
            "signs.column_not_seen", campaign, Severity.NOTE, columns=tuple(columns), hull="known" if campaign in with_hull else "unknown",
            advice="" if campaign in with_hull else "added_mass under [[parameter_file]]",
        )
        for campaign, columns in unseen.items()
    )  # fmt: skip


def _inferred(c: Coefficient, angle: str) -> Check | None:
    """A sign that was used to find that of the angle proves nothing."""
    if c.value is None:
        return None
    return Check.of(
        "signs.inferred", f"{c.campaign} {primed(c.symbol)}", Severity.NOTE, symbol=primed(c.symbol), value=c.value, angle=angle
    )  # fmt: skip


def _signed(owner: str | None, c: Coefficient, source: str) -> Check | None:
    symbol = c.symbol.removesuffix("'")
    if symbol not in NEGATIVE or c.value is None:
        return None
    good = c.value < 0.0
    sure = c.u95 is not None and abs(c.value) > c.u95
    open_ = c.u95 is not None and not sure
    severity = Severity.PASS if good else Severity.FAIL if sure else Severity.NOTE if open_ else Severity.WARN
    reason = (
        "good" if good
        else "estimate" if c.status is Status.ESTIMATE
        else "open" if open_
        else "printed" if source
        else "fitted"
    )  # fmt: skip
    half = f" +- {c.u95:.2g}" if open_ and not good else ""
    return Check.of(
        "signs.negative", f"{owner} {primed(symbol)}", severity, symbol=primed(symbol), value=c.value, half=half, reason=reason,
        expected=NEGATIVE[symbol], source=f"{source} " * bool(source),
    )  # fmt: skip


def _twins(name: str, file: ParameterFile) -> Iterator[Check]:
    """Nvdot and Yrdot, Mwdot and Zqdot, as both stand for one entry of the symmetric added mass."""
    for symbols in TWINS:
        one, other = (file.coefficient(s) for s in symbols)
        size = _size(file, symbols)
        if one is None or other is None or one.value is None or other.value is None or not size:
            continue
        apart = abs(one.value - other.value)
        good = apart <= max(MISTYPED * size, float(np.hypot(one.u95 or 0.0, other.u95 or 0.0)))
        yield Check.of(
            "signs.twins", f"{name} {one.symbol}, {other.symbol}", Severity.PASS if good else Severity.WARN, one=one.value,
            other=other.value, share=MISTYPED, diagonal=size, match="good" if good else "bad",
        )  # fmt: skip


def _size(file: ParameterFile, symbols: tuple[str, str]) -> float:
    """Root of the two diagonal entries that a pair lies between, primed; zero where one is not known."""
    out = 1.0
    for symbol in symbols[::-1]:
        at = COMPONENTS.index(symbol[0])
        name = f"{COMPONENTS[at]}{MOTIONS[at]}dot"
        own = file.coefficient(name)
        if own is not None and own.value is not None:
            out *= abs(own.value)
        elif file.added_mass is not None:
            out *= file.added_mass.matrix[at][at] / file.scaling.unit(name, file.added_mass.density)
        else:
            return 0.0
    return float(np.sqrt(out))
