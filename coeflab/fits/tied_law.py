"""The force law beyond its slopes: v|v|, v^3, their like and cross terms, tied to the recommended slopes at the origin.

A law that is to hold over the whole range of the data is fitted with its linear part held at the slope that
`coeflab.fits.slope_at_origin` recommends, so that the two never contradict each other at rest. Of the forms none, x|x|, x^3
and both the one with the least AICc counts (Hurvich & Tsai 1989); within 2 of it the simplest. Variables take turns.
Cross terms are those of the standard sets (Gertler & Hagen 1967, Feldman 1979) whose motions the data combine; drift and attack together
come in as groups, such as v|w| with v w^2, of which AICc takes one or none.
A reading that the slopes left out because it does not fit the others is left out of the law too.
A curvature in a rate that the slopes have about the arm's point alone (Xrr) is fitted about the study's, together with the product of
drift and rate (Xvr) into which the move turns it. Runs of one ratio of both give one number: then Xrr is that of no Xvr.
What no symmetric body has is the set-up's: it is fitted with the law, taken off the points and stated, never in the law.

With y = s x + A b the coefficients are b = A+ (y - s x), so that they move by -A+ x with the slope: that share of the
slope's uncertainty is carried (GUM, JCGM 100:2008, 5.2).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Finding, Severity
from coeflab.core.options import one_of, parse_options
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import finite
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult, Sweep, Tied, independent, result_of
from coeflab.fits.rows.sweeps import not_belonging
from coeflab.fits.statistics.diagnostics import NARROWEST, allowed_miss, scatter_of_replicates
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.law.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.law.named_terms import SETS, NamedTerm, read_term
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS, primed
from coeflab.tables.campaign import PORT_STARBOARD
from coeflab.tables.campaign import UP_DOWN as ALIKE
from coeflab.tables.force_table import AT_REST, ForceTable, counted_once

summary = "force law (v|v|, v^3, cross terms) over the widest range without a missed point; slopes from slope_at_origin"
citations = ("hurvich1989", "gertler1967", "feldman1979", "mackinnon1985", "bell2002")
completes = "slope_at_origin"
SIMPLER = 2.0  # AICc that a longer form has to gain
EXACT = 1e-12  # residuals over the largest force that count as none
STEP = 0.995  # by which a range shrinks at the least
UP_DOWN, SIDEWAYS = ("w", "q"), ("v", "r")
CROSSFLOW = (("v", "w"), ("w", "v"))
ONE_ANGLE = 1e-3  # rad, of the arctangent of drift over rate, of runs of one ratio
TOGETHER = 4  # rows in which two motions move, for a cross term
DRIFTS = {"r": "v", "q": "w"}  # what a rate becomes about another point
ONE_RATIO, FEW_APART = "law.one_ratio", "law.few_apart"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    at_rest : str
        ``law`` puts the force at no angle and no rate into the law where the body's symmetry allows it (Z0, M0);
        ``apart`` leaves it out. Y0, K0 and N0 of a symmetric body are the set-up's and never part of the law.
    """

    at_rest: str = one_of("law", "law", "apart")


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """Rows of one component: primed motions, primed force, which table each row is of."""

    x: Mapping[str, Array]
    y: Array
    table: NDArray[np.intp]
    names: tuple[str, ...]

    def within(self, caps: Mapping[str, float]) -> _Rows:
        keep = np.ones(len(self.y), dtype=bool)
        for v, cap in caps.items():
            keep &= np.abs(self.x[v]) <= cap
        return _Rows({v: x[keep] for v, x in self.x.items()}, self.y[keep], self.table[keep], self.names)

    def moved(self, variable: str) -> NDArray[np.bool_]:
        return np.abs(self.x[variable]) > AT_REST


@dataclass(frozen=True, slots=True, eq=False)
class _Law:
    """Terms of one component beyond the tied ones, as fitted: those of the set-up first, table by table, then the law's."""

    rows: _Rows
    set_up: tuple[tuple[int, NamedTerm], ...]
    form: tuple[NamedTerm, ...]
    columns: Array
    tied: Array
    values: Array
    residuals: Array

    @property
    def aicc(self) -> float:
        n, k = len(self.residuals), len(self.values) + 1
        floor = n * (EXACT * float(np.max(np.abs(self.rows.y), initial=0.0))) ** 2 + np.finfo(float).tiny
        squares = max(float(self.residuals @ self.residuals), floor)
        return n * float(np.log(squares / n)) + 2.0 * k + 2.0 * k * (k + 1) / (n - k - 1)


def _bases(component: str, among: CoefficientSet) -> dict[str, tuple[NamedTerm, float]]:
    """The slopes (of X: the force ahead and the curvatures) with a value, by their symbols."""
    out = {}
    for c in among.coefficients:
        if c.symbol[:1] != component or c.value is None:
            continue
        out[c.symbol] = read_term(c.symbol, completes), c.value
    return out


def _curvatures_of_rates(component: str, found: FitResult) -> tuple[NamedTerm, ...]:
    """Curvatures in a rate whose sweep has a value, about the point where its runs do not drift, and that the set has not about its own."""
    swept = {s.symbol for s in found.sweeps if s.component == component and s.value is not None}
    known = found.coefficients.available
    return tuple(
        read_term(symbol, completes)
        for rate, drift in DRIFTS.items()
        if (symbol := f"{component}{rate}{rate}") in swept - known and f"{component}{drift}{drift}" in known
    )


def _of_one_ratio(law: _Law, bent: Sequence[NamedTerm], campaign: str) -> Iterator[Finding]:
    """Curvatures in a rate whose runs have one ratio of drift to rate: they hold what the product of both makes of it."""
    for t in bent:
        rate = t.term.factors[0][0]
        product = f"{t.component}{DRIFTS[rate]}{rate}"
        if product not in (own.symbol for own in law.form):
            drift, turning = law.rows.x[DRIFTS[rate]], law.rows.x[rate]
            ratio = float(drift @ turning / (turning @ turning))
            yield Finding.of(
                ONE_RATIO, f"{campaign} {primed(t.symbol)}", Severity.NOTE, statistic=ratio, by="zero", symbol=t.symbol,
                product=primed(product), taken=0.0,
            )  # fmt: skip


def _apart(t: NamedTerm, rows: _Rows) -> int:
    """Rows that tell a product of two motions apart from its squares: those off the ratio that an arm's runs share."""
    a, b = (rows.x[v] for v in {v: None for v, _, _ in t.term.factors})
    both = (np.abs(a) > AT_REST) & (np.abs(b) > AT_REST)
    angle = np.arctan(a[both] / b[both])
    alike = np.abs(angle[:, None] - angle) <= ONE_ANGLE
    shared = alike.sum(axis=1) >= TOGETHER
    return int(both.sum()) - (int(np.max(alike.sum(axis=1)[shared])) if np.any(shared) else 0)


def _of_few_apart(law: _Law, bent: Sequence[NamedTerm], campaign: str) -> Iterator[tuple[set[str], Finding]]:
    """Curvatures in a rate and products that less than `TOGETHER` rows tell apart: no error of their form is seen, and none has a U95."""
    for t in bent:
        rate = t.term.factors[0][0]
        product = f"{t.component}{DRIFTS[rate]}{rate}"
        found = next((own for own in law.form if own.symbol == product), None)
        if found is not None and (rows := _apart(found, law.rows)) < TOGETHER:
            yield (
                {product, t.symbol},
                Finding.of(
                    FEW_APART, f"{campaign} {primed(product)}", Severity.WARN, statistic=rows, threshold=TOGETHER, other=primed(t.symbol),
                ),
            )  # fmt: skip


def _rows(
    component: str, tables: Sequence[ForceTable], variables: Sequence[str], length: float, sweeps: Sequence[Sweep]
) -> _Rows:
    """Usable rows ahead in which nothing but these variables moves, but for those that the slopes left out."""
    xs: dict[str, list[Array]] = {v: [] for v in variables}
    ys, at, names = list[Array](), list[NDArray[np.intp]](), list[str]()
    for table in tables:
        if component not in table.forces:
            continue
        keep = np.asarray(table.usable[component] & (table.motion["u"] > 0.0))
        keep &= ~not_belonging(table, component, sweeps, length)
        for v in (*MOTIONS[1:], *table.controls):
            if v not in variables:
                keep &= np.abs(table.primed_motion(v, length)) <= AT_REST
        if not np.any(keep):
            continue
        for v in variables:
            known = v in MOTIONS or v in table.controls
            xs[v].append(table.primed_motion(v, length)[keep] if known else np.zeros(int(keep.sum())))
        ys.append(table.primed_force(component, length)[keep])
        at.append(np.full(int(keep.sum()), len(names)))
        names.append(table.name)
    if not ys:
        return _Rows({v: np.zeros(0) for v in variables}, np.zeros(0), np.zeros(0, dtype=np.intp), ())
    return _Rows({v: np.concatenate(p) for v, p in xs.items()}, np.concatenate(ys), np.concatenate(at), tuple(names))


def _plane(component: str) -> str:
    """The symmetry of a body that leaves no such force at rest; none does so for X."""
    return "" if component == "X" else ALIKE if component in "ZM" else PORT_STARBOARD


def _forms(component: str, v: str, alike: bool) -> list[tuple[NamedTerm, ...]]:
    """Forms over one variable to choose from, the simplest first.

    ``alike``: the body is declared to be alike above and below.
    """

    def named(*suffixes: str) -> tuple[NamedTerm, ...]:
        return tuple(read_term(component + s, "tied_law") for s in suffixes)

    odd = [named(), named(f"{v}|{v}|"), named(v * 3), named(f"{v}|{v}|", v * 3)]
    even = [named(), named(v * 4)]
    own, other, least = (even, odd, v) if component == "X" else (odd, [named()], v * 2)
    # Unless that is declared, a body is not alike above and below: there what is even has an odd part, and the reverse.
    both = (
        [(*f, *named(least), *g) for f in own for g in other]
        if v in UP_DOWN and component in "XZM" and not alike
        else []
    )
    return sorted((*own, *both), key=len)


def _cross_terms(component: str, variables: Sequence[str]) -> Iterator[NamedTerm]:
    """Products of two of the motions in the standard sets."""
    for symbol in dict.fromkeys((*SETS["horizontal"], *SETS["vertical"])):
        t = read_term(symbol, "set") if symbol[0] == component else None
        if (
            t is not None
            and len({v for v, _, _ in t.term.factors}) == 2
            and {v for v, _, _ in t.term.factors} <= set(variables)
        ):
            yield t


def _crossflow(component: str, rows: _Rows) -> list[tuple[NamedTerm, ...]]:
    """What drift and attack do together, as groups that come in whole, the simplest first; none where no rows combine them.

    Of a body alike port and starboard. As |v|w and vw^2 go together over most grids, each alone would look superfluous beside the other.
    """
    groups = {
        "Y": ("v|w|", "vw", "v|w| vw", "v|w| vww", "v|w| vw vww"), "Z": ("vv", "w|v|", "vv w|v|", "vv w|v| vvw"), "K": ("vw", "v|w|", "vw v|w|"),
    }  # fmt: skip
    chosen = groups.get({"N": "Y", "M": "Z"}.get(component, component), ())
    if not {"v", "w"} <= set(rows.x) or not chosen or not _both_move(read_term(f"{component}vw", "tied_law"), rows):
        return [()]
    return [(), *(tuple(read_term(component + t, "tied_law") for t in g.split()) for g in chosen)]


def _of_set_up(component: str, v: str, rows: _Rows, declared: tuple[str, ...]) -> list[tuple[NamedTerm, ...]]:
    """What a set-up may add over one variable that no body of port-starboard symmetry has: X that is odd in drift.

    Only rows on both sides tell it from the law's part: each side reaches at least half as far as the other.
    """
    x = rows.x[v]
    shorter, longer = sorted((float(x.max()), -float(x.min())))
    if component != "X" or v not in SIDEWAYS or PORT_STARBOARD in declared or shorter < NARROWEST * longer:
        return [()]
    odd = read_term(f"X{v}", "tied_law"), read_term(f"X{v}|{v}|", "tied_law")
    return [(), odd[:1], odd[1:], odd]


def _both_move(t: NamedTerm, rows: _Rows) -> bool:
    """Whether enough rows combine the motions of a term, not one as a multiple of the other."""
    a, b = (rows.x[v] for v in {v: None for v, _, _ in t.term.factors})
    both = (np.abs(a) > AT_REST) & (np.abs(b) > AT_REST)
    ratio = a[both] / b[both]
    return int(both.sum()) >= TOGETHER and float(np.ptp(ratio)) > 1e-3 * float(np.abs(ratio).max())


def _fitted(
    rows: _Rows, bases: Mapping[str, tuple[NamedTerm, float]], form: tuple[NamedTerm, ...], apart: tuple[NamedTerm, ...]
) -> _Law | None:
    """The law of one form by least squares, ``apart`` the set-up's terms of every table that moves so; None if undetermined."""
    tied = np.column_stack([t.term.evaluate(rows.x) for t, _ in bases.values()])
    set_up = [(int(i), t, t.term.evaluate(rows.x) * (rows.table == i)) for t in apart for i in np.unique(rows.table)]
    set_up = [(i, t, column) for i, t, column in set_up if np.any(column)]
    parts = [*(column for _, _, column in set_up), *(t.term.evaluate(rows.x) for t in form)]
    columns = np.column_stack(parts) if parts else np.zeros((len(rows.y), 0))
    size = np.linalg.norm(columns, axis=0)
    if len(rows.y) < columns.shape[1] + 3 or np.any(size == 0.0):
        return None
    left = rows.y - tied @ np.array([value for _, value in bases.values()])
    scaled, _, rank, _ = np.linalg.lstsq(columns / size, left, rcond=None)
    if rank < columns.shape[1]:
        return None
    values = scaled / size
    return _Law(rows, tuple((i, t) for i, t, _ in set_up), form, columns, tied, values, left - columns @ values)


_Form = tuple[tuple[NamedTerm, ...], tuple[NamedTerm, ...]]  # terms of the law over one variable, and of the set-up


def _simplest(laws: Sequence[tuple[_Form, _Law]]) -> tuple[_Form, _Law] | None:
    """The first of the laws, the simplest first, that is within `SIMPLER` of the least AICc."""
    best = min((f.aicc for _, f in laws), default=0.0)
    return next(((form, f) for form, f in laws if f.aicc <= best + SIMPLER), None)


def _chosen(
    component: str,
    rows: _Rows,
    bases: Mapping[str, tuple[NamedTerm, float]],
    *,
    constant: bool,
    declared: tuple[str, ...],
    partner: str = "",
    bent: tuple[NamedTerm, ...] = (),
) -> _Law | None:
    """The law over the whole range or, where it misses points there, over the widest range in which it meets them."""
    variables = [v for v in rows.x if np.any(rows.moved(v))]
    at_rest = (read_term(f"{component}0", "tied_law"),)
    own = (*(at_rest if constant else ()), *bent)
    free = not any(not t.term.factors for t, _ in bases.values()) and _plane(component) not in declared
    apart = at_rest if free and not constant else ()

    def over(some: _Rows) -> _Law | None:
        crossed = tuple(t for t in _cross_terms(component, variables) if _both_move(t, some))
        laws = [(((*own, *crossed, *g), ()), by_turns(some, (*own, *crossed, *g))) for g in _crossflow(component, some)]
        found = _simplest([(form, law) for form, law in laws if law is not None])
        return found[1] if found is not None else by_turns(some, own)

    def by_turns(some: _Rows, always: tuple[NamedTerm, ...]) -> _Law | None:
        """One variable after the other, its form with those of the others as they are; twice."""
        law, chosen = None, dict.fromkeys(variables, (tuple[NamedTerm, ...](), tuple[NamedTerm, ...]()))
        for v in (*variables, *variables):
            laws = []
            forms = [()] if v == partner else _forms(component, v, ALIKE in declared)
            both = product(forms, _of_set_up(component, v, some, declared))
            for form in sorted(both, key=lambda f: len(f[0]) + len(f[1])):
                terms, added = zip(*(chosen | {v: form}).values(), strict=True)
                laws.append((form, _fitted(some, bases, (*always, *chain(*terms)), (*apart, *chain(*added)))))
            found = _simplest([(form, f) for form, f in laws if f is not None])
            if found is None:
                return None
            chosen[v], law = found
        return law

    largest = float(np.max(np.abs(rows.y), initial=0.0))
    whole = law = over(rows)
    caps = {v: float(np.abs(rows.x[v]).max()) for v in variables}
    reach = dict(caps)
    while law is not None and float(np.abs(law.residuals).max()) > allowed_miss(_scatter(law), largest):
        x, worst = law.rows.x, int(np.abs(law.residuals).argmax())
        shares = {v: abs(float(x[v][worst])) / reach[v] for v in variables}
        v = max(shares, key=shares.__getitem__)
        inner = np.abs(x[v])
        caps[v] = float(inner[inner <= caps[v] * STEP].max(initial=0.0))
        if shares[v] < NARROWEST or caps[v] < NARROWEST * reach[v]:
            return whole
        law = over(rows.within(caps))
    return law or whole


def _scatter(law: _Law) -> float | None:
    """Scatter of the runs that repeat a setting about the law."""
    shares = [x / max(float(np.abs(x).max()), AT_REST) for x in law.rows.x.values()]
    return scatter_of_replicates(np.column_stack([*shares, law.rows.table]), law.residuals)


def _window(variable: str, x: Array) -> tuple[float, float]:
    low, high = float(x.min()), float(x.max())
    if variable in ("v", "w"):
        return float(np.arcsin(max(low, -1.0))), float(np.arcsin(min(high, 1.0)))
    return low, high


def _coefficients(
    law: _Law, among: CoefficientSet, bases: Mapping[str, tuple[NamedTerm, float]], first: ForceTable, few: set[str]
) -> tuple[list[Coefficient], Array, Array]:
    """The terms of one component, the covariance of their scatter, and how they move with every coefficient of the slopes."""
    k = len(law.set_up)
    fit = fit_linear(law.columns, law.residuals + law.columns @ law.values)
    symbols = [c.symbol for c in among.coefficients]
    moves = np.zeros((len(law.form), len(symbols)))
    moves[:, [symbols.index(s) for s in bases]] = (-np.linalg.pinv(law.columns) @ law.tied)[k:]
    carried = 2.0 * np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", moves, np.nan_to_num(among.covariance), moves), 0.0))
    void = (moves != 0.0) @ np.array([c.u95 is None for c in among.coefficients], dtype=float) > 0.0
    out = []
    held = ", ".join(f"{s}'" for s in bases)
    for i, t in enumerate(law.form):
        value, half = float(law.values[k + i]), finite(float(fit.half_width[k + i]))
        u95 = None if half is None or void[i] or t.symbol in few else float(np.hypot(half, carried[i]))
        names = [v for v, _, _ in t.term.factors]
        moved = (
            np.logical_and.reduce([law.rows.moved(v) for v in names]) if names else np.ones(len(law.rows.y), dtype=bool)
        )
        tables = dict.fromkeys(law.rows.names[n] for n in law.rows.table[moved])
        out.append(
            Coefficient(
                symbol=t.symbol,
                value=value,
                u95=u95,
                status=Status.SINGLE_ESTIMATOR if u95 is None else Status.FORM_ASSUMED,
                body=first.body,
                parts=Parts(random=half, input=None if void[i] else float(carried[i])),
                origin="fit",
                table=", ".join(tables),
                campaign=first.campaign,
                estimator=f"least squares beyond {held} as recommended; the form by AICc, its error not assessed",
                window=_window(names[0], law.rows.x[names[0]]) if len(set(names)) == 1 else None,
                n_points=int(moved.sum()),
                citation=first.source.citation,
            )
        )
    half_width = np.nan_to_num(fit.half_width[k:]) / 2.0
    return out, fit.correlation[k:, k:] * np.outer(half_width, half_width), moves


def complete(found: FitResult, tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """The terms beyond the slopes that a fit has found.

    Parameters
    ----------
    found : FitResult
        Of `completes`, over the same tables.
    tables, scaling, options
        As for `fit`.

    Returns
    -------
    FitResult
        With ``tied``: to which fit, how the terms move with its coefficients, and the forces at rest that no law holds.
    """
    chosen = parse_options(Options, options, "tied_law")
    among, length, tables = found.coefficients, scaling.length, counted_once(tables)
    declared = tuple(s for s in tables[0].symmetry if all(s in t.symmetry for t in tables))
    every: list[Coefficient] = []
    blocks, moves, rest, findings = [], [], [], list[Finding]()
    for component in COMPONENTS:
        bases = _bases(component, among)
        bent = _curvatures_of_rates(component, found)
        terms = [*(t for t, _ in bases.values()), *bent]
        variables = list(dict.fromkeys(v for t in terms for v, _, _ in t.term.factors))
        if not variables:
            continue
        rows = _rows(component, tables, variables, length, found.sweeps)
        partner = next((o for v, o in CROSSFLOW if v in variables and o not in variables and component != "X"), "")
        combined = _rows(component, tables, [*variables, partner], length, found.sweeps) if partner else rows
        if len(_crossflow(component, combined)) > 1:
            rows = combined
        else:
            partner = ""
        constant = chosen.at_rest == "law" and component in "ZM" and ALIKE not in declared
        law = (
            _chosen(component, rows, bases, constant=constant, declared=declared, partner=partner, bent=bent)
            if len(rows.y)
            else None
        )
        if law is None:
            continue
        rest += [
            (law.rows.names[i], t.symbol, float(value)) for (i, t), value in zip(law.set_up, law.values, strict=False)
        ]
        findings += _of_one_ratio(law, bent, tables[0].campaign)
        few = list(_of_few_apart(law, bent, tables[0].campaign))
        findings += [finding for _, finding in few]
        if law.form:
            unknown = {symbol for symbols, _ in few for symbol in symbols}
            some, block, moved = _coefficients(law, among, bases, tables[0], unknown)
            every += some
            blocks.append(block)
            moves.append(moved)
    sensitivity = np.vstack(moves) if moves else np.zeros((0, len(among.coefficients)))
    covariance = sensitivity @ np.nan_to_num(among.covariance) @ sensitivity.T + independent(blocks)
    np.fill_diagonal(covariance, [np.nan if c.u95 is None else (c.u95 / 2.0) ** 2 for c in every])
    tied = Tied(found.fit, tuple(c.symbol for c in among.coefficients), sensitivity, tuple(rest))
    return result_of(
        "tied_law", tables[0], scaling, every, covariance, citations=citations, settings={"at_rest": chosen.at_rest}, tied=tied,
        findings=tuple(findings),
    )  # fmt: skip


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """The terms beyond the slopes, with the slopes by `completes` and its default options.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point.
    scaling : Scaling
        Length of the primes.
    options : mapping
        See `Options`.
    """
    return complete(FITS.load(completes).fit(tables, scaling, {}), tables, scaling, options)
