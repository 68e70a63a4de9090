"""Estimates from the shape against Roddy's measurements on SUBOFF, and beside others' estimates of REMUS, HUUV and THAUV.

The outline of configurations 1 and 2 includes ring wing 1, whose edges are those of the program in Groves et al.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.outline import RingWing
from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.machine import one_thread
from coeflab.core.table import Table
from coeflab.core.types import brief
from coeflab.estimates import Estimates, Water, estimated
from coeflab.estimates.crossflow import contributions
from coeflab.law.coefficient import Coefficient, CoefficientSet
from coeflab.law.symbols import primed
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Acceptance
from coeflab.study.plan import read_plan
from coeflab.vehicle.parameter_file import read_parameter_file
from coeflab.vehicle.published_values import Reference, read_references

PAPER = publication("estimates")

FOOT = 0.3048
LEADING, TRAILING = (13.46990, 0.43004), (14.21661, 0.35659)  # ft aft of the nose, radius: Groves et al., DARPA2WINGS
RING_THICKNESS = 0.10
VISCOSITY = 1.05e-6  # m^2/s, fresh water of the density of the tests (998 kg/m^3, 18 deg C)
MAIN = ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr", "Zq", "Mq")
# A plane tail is alike in both planes: its effect counts once.
COPIES = {("Roddy configuration 1", "Zds"), ("Roddy configuration 1", "Mds")}
INSIDE, WIDE, APART = 0.90, 0.50, 0.25


@brief
@dataclass(frozen=True, slots=True)
class Measured:
    """One measured derivative.

    Attributes
    ----------
    configuration, symbol : str
    measured : float
    found : Coefficient
    counts : bool
        Not a copy by symmetry of another row.
    """

    configuration: str
    symbol: str
    measured: float
    found: Coefficient
    counts: bool

    @property
    def value(self) -> float:
        """The estimate."""
        return float(self.found.value or 0.0)

    @property
    def ratio(self) -> float:
        """Estimate over measurement."""
        return self.value / self.measured

    @property
    def width(self) -> float:
        """U95 of the estimate over its value."""
        return float(self.found.u95 or 0.0) / abs(self.value)

    @property
    def inside(self) -> bool:
        """Whether the measured value lies within the U95 of the estimate alone."""
        return abs(self.value - self.measured) <= float(self.found.u95 or 0.0)


def ring_wing() -> RingWing:
    """Ring wing 1 of SUBOFF."""
    edges = FOOT * np.array([LEADING, TRAILING])
    quarter = 0.75 * edges[0] + 0.25 * edges[1]
    chord = float(np.hypot(*(edges[1] - edges[0])))
    return RingWing("ring wing 1", np.array([-quarter[0], 0.0, 0.0]), 2.0 * float(quarter[1]), chord, RING_THICKNESS)


def suboff(name: str, with_ring: bool) -> Body:
    """A shipped SUBOFF with its outline, and ring wing 1 on request.

    Parameters
    ----------
    name : str
        Of its folder.
    with_ring : bool

    Raises
    ------
    InputError
        Its reader gives no outline.
    """
    body = read_body(Path(shipped("geometry")) / name / "body.toml")
    seen = body.outline
    if seen is None:
        raise InputError(f"{name} without an outline", "a body whose reader knows its hull and fins")
    whole = replace(seen, rings=(ring_wing(),) if with_ring else ())
    return replace(body, outlined=lambda: whole)


def rows() -> tuple[Measured, ...]:
    """Every measured derivative of configurations 3, 2 and 1, in that order."""
    folder = Path(shipped("cfd_data")) / "suboff"
    plan = read_plan(folder / "plan.toml")
    if plan.conditions is None or plan.scaling is None:
        raise InputError("a plan without conditions or scaling", "those of the tests", file=folder / "plan.toml")
    water = Water(plan.conditions.density, VISCOSITY, plan.conditions.speed)
    by_name = {r.name: r for r in read_references(folder / "published.toml")}
    whole = estimated(replace(suboff("suboff_aff8", True), scaling=plan.scaling), water)
    bare = estimated(replace(suboff("suboff_bare_hull", False), scaling=plan.scaling), water)
    out = []
    for name, result in (("3", bare), ("2", whole), ("1", whole)):
        reference = by_name[f"Roddy configuration {name}"]
        out += [
            Measured(name, s, v, result.coefficients[s], (reference.name, s) not in COPIES)
            for s, v in _measured(reference).items()
            if s in result.coefficients
        ]
    return tuple(out)


def _measured(reference: Reference) -> dict[str, float]:
    """Static, control and rotary derivatives as printed."""
    found = {v.symbol: v.value for v in reference.values if v.value is not None}
    for kind in reference.literature:
        found |= {v.symbol: v.value for v in kind.values if v.value is not None and not v.symbol.endswith("dot")}
    return found


def table(found: tuple[Measured, ...]) -> Table:
    """Every derivative, the answer of the validation: 79 columns at most."""
    cells = tuple(
        (r.configuration, primed(r.symbol), f"{r.value:.5f}", f"{r.measured:.5f}", f"{r.ratio:.2f}", f"{100 * r.width:.0f} %",
         ("inside" if r.inside else "outside") + ("" if r.counts else ", copy"))
        for r in found
    )  # fmt: skip
    counted = [r for r in found if r.counts]
    main = [r for r in counted if r.symbol in MAIN]
    errors = [r.ratio - 1.0 for r in main]
    worst = max(main, key=lambda r: abs(r.ratio - 1.0))
    width = 100 * np.median([r.width for r in counted])
    notes = (
        PAPER.text("inside", inside=sum(r.inside for r in counted), count=len(counted), width=width),
        PAPER.text(
            "main", apart=100 * np.median(np.abs(errors)), mean=100 * np.mean(errors), worst=primed(worst.symbol),
            configuration=worst.configuration, most=100 * (worst.ratio - 1.0),
        ),
        PAPER.text("revised"), goals(found), PAPER.text("configurations"),
    )  # fmt: skip
    headers = ("config", "", "estimate", "measured", "ratio", "U95", "")
    return Table(
        "SUBOFF: estimates from the shape against Roddy's measurements", headers, cells, notes, frozenset({0, 1, 6})
    )


def goals(found: tuple[Measured, ...]) -> str:
    """What the project asks of the estimates, and whether they reach it; a goal is no measured number and does not count."""
    counted = [r for r in found if r.counts]
    share = sum(r.inside for r in counted) / len(counted)
    wide = float(np.median([r.width for r in counted]))
    apart = float(np.median([abs(r.ratio - 1.0) for r in counted if r.symbol in MAIN]))
    each = (
        ("inside", share, "at least", INSIDE, share >= INSIDE),
        ("median U95", wide, "at most", WIDE, wide <= WIDE),
        ("median |error| of the main ones", apart, "at most", APART, apart <= APART),
    )
    words = [
        f"{what} {100 * value:.0f} %, goal {bound} {100 * limit:.0f} %, {'met' if met else 'missed'}"
        for what, value, bound, limit, met in each
    ]
    return f"Goals of the project, not counted: {'; '.join(words)}."


@one_thread()
def acceptance() -> Acceptance:
    """Rows, and what has no verdict; goals are statements."""
    found = rows()
    derivatives = [
        Row(f"configuration {r.configuration}", primed(r.symbol), "1", r.measured, r.value, float(r.found.u95 or 0.0))
        for r in found
        if r.counts
    ]
    answer = table(found)
    tables = (PAPER.table("derivatives", derivatives), PAPER.table("levers", levers()))
    return PAPER.acceptance(tables, (*answer.notes, *_comparison_only()), shown=(answer,))


def levers() -> tuple[Row, ...]:
    """Where the drag across the bare hull acts in a pure sway or heave: at the centroid of its plane across the stream."""
    seen = suboff("suboff_bare_hull", False).outline
    if seen is None:
        raise InputError("suboff_bare_hull without an outline", "a body whose reader knows its hull")
    hull = seen.hulls[0]
    drag = next(c.forces for c in contributions(seen, Water(1000.0, VISCOSITY, 1.0)) if c.kind == "cross-flow drag")
    rows = []
    for what, along, about, sign, width in (("sway", 1, 5, 1.0, hull.depth), ("heave", 2, 4, -1.0, hull.breadth)):
        force = drag(np.eye(6)[along][None, :], {})[0]
        due = float(np.trapezoid(width * hull.x, hull.x) / np.trapezoid(width, hull.x))
        found = float(sign * force[about] / force[along]) if force[along] < 0.0 else None
        rows.append(Row(f"bare hull, {what}", "x of the cross-flow drag from the nose", "m", due, found))
    return tuple(rows)


def _comparison_only() -> tuple[str, ...]:
    """Vehicles whose numbers are others' estimates or CFD: no verdict."""
    words = [PAPER.text("no_shape")]
    body = read_body(Path(shipped("geometry")) / "remus100" / "body.toml")
    if body.outline is None:
        return tuple(words)
    theirs = read_parameter_file(Path(shipped("cfd_data")) / "remus100" / "remus100.parameters.json")
    water = Water(theirs.conditions.density, VISCOSITY, theirs.conditions.speed)
    ours = estimated(replace(body, scaling=theirs.scaling), water)
    printed = {c.symbol.removesuffix("'"): c.value for c in theirs.coefficients}
    pairs = {"Yv": "Yuv", "Nv": "Nuv", "Yr": "Yur", "Nr": "Nur", "Yv|v|": "Yv|v|", "Nr|r|": "Nr|r|"}
    parts = [
        f"{primed(s)} {_value(ours, s):.4f} for {printed[p]:.4f}"
        for s, p in pairs.items()
        if printed.get(p) is not None
    ]
    return (*words, PAPER.text("remus"), f"REMUS 100: {', '.join(parts)}.")


def _value(estimates: Estimates, symbol: str) -> float:
    among: CoefficientSet | Mapping[str, Coefficient] = estimates.coefficients
    return float(among[symbol].value or 0.0) if symbol in estimates.coefficients else 0.0
