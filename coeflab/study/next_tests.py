"""Which test to run next, and at which settings: what each kind of test takes off the variance of a wanted figure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.machine import stage
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.statistics.designs import FINAL, Response, designed, predicted_u95
from coeflab.fits.statistics.origin_slope import OriginSlope, curve, curve_spread, estimate
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import ANGULAR, CONTROLS, derivative, primed
from coeflab.motion.uncertainty.draws import uncertain
from coeflab.motion.uncertainty.tests import Kind, kind_of, tests_of
from coeflab.motion.uncertainty.uncertainty import Question, uncertainty
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import INDICES, index_gradient, stability_index

SEEN = 0.01  # of the variance: tests that hold less are left out
LEVELS = 12
MEMBERS = 200
NOISE = 0.01  # of the largest reading, where no row shows any
FEWEST, MOST = 3, 24


class Reached(StrEnum):
    """Whether the runs bring the figure to its target."""

    YES = "reached"
    NO = "not reached"
    OPEN = "no target"


@dataclass(frozen=True, slots=True)
class Ranges:
    """What the tests may run: largest angle of drift and attack, of a control, rad, and largest r', q'."""

    angle: float = float(np.radians(12.0))
    control: float = float(np.radians(15.0))
    rate: float = 0.4

    def levels(self, variable: str) -> Array:
        """Sizes of settings, primed, at round steps of the angle or the rate."""
        if variable in ANGULAR:
            return _round_steps(self.rate)
        angles = np.radians(_round_steps(np.degrees(self.control if variable in CONTROLS else self.angle)))
        return np.asarray(angles if variable in CONTROLS else np.sin(angles))


def _round_steps(largest: float) -> Array:
    """Multiples of 1, 2 or 5 times a power of ten, at most twelve, up to the largest."""
    step = 10.0 ** np.floor(np.log10(largest / LEVELS))
    step *= next(k for k in (1.0, 2.0, 5.0, 10.0) if k * step >= largest / LEVELS * (1.0 - 1e-9))
    return np.asarray(np.round(step * np.arange(1.0, np.floor(largest / step + 1e-6) + 1.0), 12))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ProposedTest:
    """One kind of test and what it would do.

    Attributes
    ----------
    kind : Kind
    variable : str
        Empty where the test is none of one variable, so that no settings are given.
    symbols : tuple of str
        Coefficients of the wanted figure that it gives, primed.
    share : float
        Of the variance of the wanted figure: what it could take off at most, over `NextTests.overlap`.
    settings : (n,) array
        Of the proposed runs, as the variable's prime: sine of an angle, rad of a control, r'.
    u95 : tuple of (now, then)
        Of every symbol.
    equal : tuple of float
        U95 of every symbol by as many runs at equal spacing.
    wanted_then : float
        U95 of the wanted figure after these runs alone.
    rows : int
        That were run already.
    fixed : tuple of float
        Of U95 squared of every symbol what no run of its sweep narrows: grid, other studies, declared inputs.
    """

    kind: Kind
    variable: str
    symbols: tuple[str, ...]
    share: float
    settings: Array
    u95: tuple[tuple[float, float], ...]
    equal: tuple[float, ...]
    wanted_then: float
    rows: int = 0
    fixed: tuple[float, ...] = ()

    @property
    def angles(self) -> Array:
        """The settings as a person sets them: rad of drift, attack and controls, else r' or q'."""
        return np.arcsin(self.settings) if self.variable in ("v", "w") else self.settings


@brief
@dataclass(frozen=True, slots=True, eq=False)
class NextTests:
    """Tests by what they take off, largest first.

    Attributes
    ----------
    wanted : str
        Coefficient or figure.
    value, u95 : float
        Of it now.
    tests : tuple of Test
    target : float or None
        Wanted U95.
    noise : float or None
        Of one reading, as a share of the reading at the largest setting, assumed where nothing was run; None where all was.
    assumed : tuple of str
        Symbols whose curve comes from a parameter file or an estimate, without rows.
    given : Finding or None
        What the question was asked of.
    correlated : bool
        Whether coefficients have a covariance, which U95 and shares then take into account.
    of_rows : mapping of component to float
        Scatter of one reading, primed, that rows of the component show and runs of another sweep of it are taken to have.
    overlap : float
        What the tests would take off the variance one by one, in all; above 1 where they tell of each other's coefficients, and
        every share is then divided by it.
    """

    wanted: str
    value: float
    u95: float
    tests: tuple[ProposedTest, ...]
    target: float | None
    noise: float | None
    assumed: tuple[str, ...]
    given: Finding | None = None
    correlated: bool = False
    of_rows: Mapping[str, float] = field(default_factory=dict)
    overlap: float = 1.0

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What the prediction rests on, and whether the target is reached."""
        out = [] if self.given is None else [self.given]
        out += [Finding.of("design.predicted", self.wanted, Severity.NOTE, draws=FINAL)]
        if sum(len(t.symbols) for t in self.tests) > 1:
            out += [
                Finding.of("design.correlated" if self.correlated else "design.independent", self.wanted, Severity.NOTE)
            ]
        if self.overlap > 1.0 + SEEN:
            out += [Finding.of("design.overlap", self.wanted, Severity.NOTE, statistic=self.overlap)]
        out += [
            Finding.of("design.fixed", symbol, Severity.WARN, statistic=share, threshold=0.5)
            for t in self.tests for symbol, share in zip(t.symbols, t.fixed) if share > 0.5
        ]  # fmt: skip
        if self.noise is not None:
            out += [
                Finding.of(
                    "design.assumed",
                    self.wanted,
                    Severity.NOTE,
                    statistic=self.noise,
                    advice="--noise",
                    symbols=self.assumed,
                )
            ]
        out += [Finding.of("design.scatter", c, Severity.NOTE, statistic=v) for c, v in self.of_rows.items()]
        if self.target is not None:
            severity = Severity.PASS if self.reached is Reached.YES else Severity.WARN
            out += [
                Finding.of(
                    "design.target", self.wanted, severity, statistic=self.best, threshold=self.target, advice="--runs",
                    reached=str(self.reached),
                )
            ]  # fmt: skip
        return tuple(out)

    @property
    def best(self) -> float:
        """U95 after the runs of all tests together."""
        left = 1.0 - sum(1.0 - (t.wanted_then / self.u95) ** 2 for t in self.tests)
        return self.u95 * float(np.sqrt(max(left, 0.0)))

    @property
    def reached(self) -> Reached:
        """Whether all these runs bring U95 to the target."""
        if self.target is None:
            return Reached.OPEN
        return Reached.YES if self.best <= self.target else Reached.NO


@dataclass(frozen=True, slots=True)
class Wanted:
    """A figure, and how its variance divides among coefficients: symbol without prime to (share, U95 now).

    Where errors of coefficients go together (``correlated``), a test's share is what knowing all its coefficients takes off, and
    shares that overlap are divided by their sum, ``overlap``.
    """

    name: str
    value: float
    u95: float
    shares: Mapping[str, tuple[float, float]]
    correlated: bool = False
    overlap: float = 1.0


def of_symbol(coefficient: Coefficient) -> Wanted:
    """A coefficient as the wanted figure.

    Raises
    ------
    InputError
        No value, or no U95 that could become smaller.
    """
    name = primed(coefficient.symbol.removesuffix("'"))
    if coefficient.value is None or not coefficient.u95:
        raise input_error(
            "study.give_body_whose", column="--for", name=name, value="a value" if coefficient.value is None else "U95",
        )  # fmt: skip
    return Wanted(name, coefficient.value, coefficient.u95, {name.removesuffix("'"): (1.0, coefficient.u95)})


def of_index(parameters: ParameterFile, name: str) -> Wanted:
    """G_h or G_v, first order, with the covariance of its four coefficients.

    Raises
    ------
    InputError
        No mass, no value, or no U95 of one of them.
    """
    *symbols, sign = INDICES[name]
    found = [c for s in symbols if (c := parameters.coefficient(str(s))) is not None and c.value is not None and c.u95]
    if parameters.mass is None or len(found) < len(symbols):
        raise input_error(
            "study.file_without", column="--for", name=name,
            value="mass" if parameters.mass is None else "U95 of all four coefficients", map=", ".join(map(str, symbols)),
        )  # fmt: skip
    values = [float(c.value or 0.0) for c in found]
    mass = float(sign) * parameters.mass.mass_prime, parameters.mass.mass_moment_prime
    varied = uncertain(parameters, ())
    at = [varied.symbols.index(str(s)) for s in symbols]
    covariance = 4.0 * varied.covariance[np.ix_(at, at)]
    felt = covariance @ (gradient := index_gradient(values[0], values[1], values[2], values[3], *mass))
    variance = float(gradient @ felt)
    known = {str(s): float(f**2 / v / variance) for s, f, v in zip(symbols, felt, np.diag(covariance), strict=True)}
    by_test = {}
    for test, those in tests_of(tuple(known)).items():
        own = [list(known).index(s) for s in those]
        by_test[test] = float(felt[own] @ np.linalg.pinv(covariance[np.ix_(own, own)]) @ felt[own]) / variance
    slope, lever, rate, damping = (np.array(v) for v in values)
    value = float(stability_index(slope, lever, rate, damping, *mass))
    apart = bool(np.any(covariance - np.diag(np.diag(covariance))))
    return Wanted(name, value, variance**0.5, *_divided(known, by_test, parameters, apart))


def _divided(
    known: Mapping[str, float], by_test: Mapping[str, float], parameters: ParameterFile, apart: bool
) -> tuple[dict[str, tuple[float, float]], bool, float]:
    """Shares and U95 by symbol, each test's share divided as its symbols' own and over their sum where they overlap; that sum."""
    out: dict[str, tuple[float, float]] = {}
    for test, symbols in tests_of(tuple(known)).items():
        total = sum(known[s] for s in symbols)
        for s in symbols:
            c = parameters.coefficient(s)
            if c is not None and c.u95 and total > 0.0:
                out[s.removesuffix("'")] = (known[s] / total * by_test.get(test, total), c.u95)
    most = max(1.0, sum(share for share, _ in out.values()))
    return {s: (share / most, u95) for s, (share, u95) in out.items()}, apart, most


def of_manoeuvre(parameters: ParameterFile, name: str, question: Question) -> Wanted:
    """A figure of a manoeuvre, by draws of the file's coefficients with their covariance, as `coeflab uncertainty` has it.

    Raises
    ------
    InputError
        No such figure, or one without an interval.
    """
    carried = uncertainty(parameters, question)
    near = [s for s in carried.spreads if s.figure.name.casefold().startswith(name.casefold())]
    if not near:
        figures = ", ".join(s.figure.name for s in carried.spreads)
        raise input_error(
            "study.another_manoeuvre_may", column="--for", found=shown(name), indices=", ".join(INDICES),
            manoeuvre=question.manoeuvre, value=figures or "none",
        )  # fmt: skip
    found = near[0]
    if found.low is None or found.high is None or found.figure.value is None:
        raise input_error("study.figure_interval", column="--for", name=found.figure.name, why=found.why)
    importance = next(i for i in carried.importances if i.figure == found.figure.name)
    known = {s: v for s, v in importance.known if parameters.coefficient(s) is not None}
    apart = np.array(carried.varied.covariance)
    np.fill_diagonal(apart, 0.0)
    shares = _divided(known, dict(importance.tests) if apart.any() else {}, parameters, bool(apart.any()))
    return Wanted(found.figure.name, found.figure.value, (found.high - found.low) / 2.0, *shares)


def next_tests(
    wanted: Wanted, coefficients: Sequence[Coefficient], sweeps: Sequence[Sweep], ranges: Ranges, runs: int, noise: float | None,
    *, target: float | None = None, computed: bool = False, given: Finding | None = None, others: Sequence[Sweep] = (),
) -> NextTests:  # fmt: skip
    """Tests by what they take off the variance of a figure, each with the settings of its best runs.

    Parameters
    ----------
    wanted : Wanted
    coefficients : sequence of Coefficient
        Expected curves where nothing was run: slopes, and Yv|v|.
    sweeps : sequence of Sweep
        What was run.
    ranges : Ranges
    runs : int
        Of each test.
    noise : float, optional
        Of one reading over the reading at the largest setting, where nothing was run; unless given that of the rows of the same
        component, else `NOISE`.
    target : float, optional
        U95 that is wanted.
    computed : bool
        Runs repeat the same number, so no setting twice.
    given : Finding, optional
        What the question was asked of.
    others : sequence of Sweep
        Of rows behind a joint fit, whose scatter alone counts.

    Raises
    ------
    InputError
        Fewer than three runs where nothing was run, or no coefficient that a test gives.
    """
    if not 1 <= runs <= MOST:
        raise InputError(f"{runs} runs", f"1 to {MOST}", column="--runs")
    groups: dict[tuple[Kind, str], list[str]] = {}
    for symbol in wanted.shares:
        groups.setdefault(kind_of(symbol), []).append(symbol)
    known = {c.symbol.removesuffix("'"): c for c in coefficients}
    ran = {s.symbol: s for s in reversed(sweeps) if s.parity == "odd" and s.value is not None}
    assumed: list[str] = []
    scatter = {c: v for c, v in _scatter((*others, *ran.values())).items() if noise is None}
    of_rows: dict[str, float] = {}
    out = []
    for (kind, variable), symbols in groups.items():
        share = sum(wanted.shares[s][0] for s in symbols)
        slopes = [s for s in symbols if variable and derivative(s).factors == (variable,)]
        if share < SEEN and len(groups) > 1:
            continue
        if not slopes:
            nothing = tuple((wanted.shares[s][1], wanted.shares[s][1]) for s in symbols)
            out.append(ProposedTest(kind, "", _primed(symbols), share, np.zeros(0), nothing, (), wanted.u95))
            continue
        stage(f"runs of {kind}")
        responses = []
        for s in slopes:
            own, now = wanted.shares[s]
            of_component = scatter.get(derivative(s).component)
            responses.append(
                _response(s, variable, ran.get(s), known, ranges, noise or NOISE, of_component, own / now**2)
            )
            if s not in ran and of_component is not None:
                of_rows[derivative(s).component] = of_component
            assumed += [] if s in ran or of_component is not None else [primed(s)]
        rows = len(responses[0].x)
        if not rows and runs < FEWEST:
            raise InputError(f"{runs} runs of {kind}, of which none was run", f"{FEWEST} or more", column="--runs")
        levels = _levels(variable, ranges, ran.get(slopes[0]))
        settings = designed(responses, runs, levels, distinct=computed)
        equal = _equal(runs, levels, responses[0].odd)
        after = [_after(wanted.shares[s][1], r, ran.get(s), settings) for s, r in zip(slopes, responses, strict=True)]
        plain = [_after(wanted.shares[s][1], r, ran.get(s), equal) for s, r in zip(slopes, responses, strict=True)]
        if not rows and _sum(plain, responses) < _sum(after, responses):
            settings, after = equal, plain
        gone = sum(wanted.shares[s][0] * (1.0 - (a / wanted.shares[s][1]) ** 2) for s, a in zip(slopes, after))
        then = wanted.u95 * float(np.sqrt(max(1.0 - gone, 0.0)))
        both = tuple((wanted.shares[s][1], a) for s, a in zip(slopes, after, strict=True))
        fixed = tuple(_fixed(wanted.shares[s][1], ran.get(s)) / wanted.shares[s][1] ** 2 for s in slopes)
        out.append(
            ProposedTest(kind, variable, _primed(slopes), share, settings, both, tuple(plain), then, rows, fixed)
        )
    if not out:
        raise InputError(f"{wanted.name}, on which no coefficient with U95 acts", "another figure", column="--for")
    ranked = tuple(sorted(out, key=lambda t: (t.wanted_then, -t.share)))
    return NextTests(
        wanted.name, wanted.value, wanted.u95, ranked, target, (noise or NOISE) if assumed else None, tuple(assumed), given,
        wanted.correlated, of_rows, wanted.overlap,
    )  # fmt: skip


def _sum(u95: Sequence[float], responses: Sequence[Response]) -> float:
    return sum(r.weight * u**2 for u, r in zip(u95, responses, strict=True))


def _primed(symbols: Sequence[str]) -> tuple[str, ...]:
    return tuple(primed(s) for s in symbols)


def _present(sweep: Sweep) -> OriginSlope:
    return estimate(sweep.x, sweep.y, sweep.se, odd=bool(sweep.symmetry))


def _scatter(sweeps: Iterable[Sweep]) -> dict[str, float]:
    """Of one reading of each component that was run, primed: the median of its sweeps."""
    found: dict[str, list[float]] = {}
    for s in sweeps:
        found.setdefault(s.component, []).append(_present(s).noise)
    return {c: float(np.median(v)) for c, v in found.items()}


def _response(
    symbol: str, variable: str, sweep: Sweep | None, known: Mapping[str, Coefficient], ranges: Ranges, noise: float,
    scatter: float | None, weight: float,
) -> Response:  # fmt: skip
    if sweep is not None:
        present = _present(sweep)
        used = np.flatnonzero(present.used)
        return Response(
            lambda x: curve(present, x)[0],
            present.noise,
            weight,
            sweep.x[used],
            sweep.y[used],
            bool(sweep.symmetry),
            *curve_spread(present),
        )
    slope = float(known[symbol].value or 0.0)
    bent = known.get(f"{symbol}|{variable}|")
    bend = 0.0 if bent is None else float(bent.value or 0.0)

    def expected(x: Array) -> Array:
        return slope * x + bend * x * np.abs(x)

    largest = float(np.abs(expected(ranges.levels(variable))).max())
    return Response(expected, noise * largest if scatter is None else scatter, weight)


def _levels(variable: str, ranges: Ranges, sweep: Sweep | None) -> Array:
    """Those of the ranges; of rows that were run those within them, since beyond them nothing is known of the curve."""
    if sweep is None:
        return ranges.levels(variable)
    size = float(np.abs(sweep.x).max())
    angle = size if variable in CONTROLS else float(np.arcsin(min(size, 1.0)))
    return Ranges(angle, angle, size).levels(variable)


def _equal(runs: int, levels: Array, one_sided: bool) -> Array:
    if one_sided:
        return np.linspace(0.0, levels[-1], runs + 1)[1:]
    return np.linspace(-levels[-1], levels[-1], runs)


def _after(now: float, response: Response, sweep: Sweep | None, settings: Array) -> float:
    """U95 after the runs: of the scatter and form alone, with what a budget adds to it kept; never above that of now."""
    return min(now, float(np.sqrt(_fixed(now, sweep) + predicted_u95(response, settings) ** 2)))


def _fixed(now: float, sweep: Sweep | None) -> float:
    """Of U95 squared what is no scatter and form of a sweep that was run."""
    return 0.0 if sweep is None or sweep.u95 is None else max(now**2 - sweep.u95**2, 0.0)
