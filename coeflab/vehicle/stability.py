"""Quantities made of several coefficients: centre of pressure and stability indices, with their uncertainty.

Linear propagation with covariance beside Monte Carlo of the same function. Both are ratios: where the interval of a
denominator holds zero, neither is an interval, and none is given.

Directional stability indices of a submerged body, with their first-order uncertainty.

Feldman (1979); Roddy (1990) Table 4: G = 1 - N_v (Y_r - m) / [Y_v (N_r - x_G m)], all primed; positive is stable.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import StrEnum

import numpy as np

from coeflab.core.table import number, plus_minus, with_u95
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import listed
from coeflab.fits.uncertainty.propagation import Propagated, propagate, reaches_zero
from coeflab.law.coefficient import CoefficientSet
from coeflab.law.symbols import primed
from coeflab.vehicle.parameter_file import ParameterFile


def stability_index(
    force_slope: Array, moment_slope: Array, force_rate: Array, moment_rate: Array, mass: float, mass_moment: float
) -> Array:
    """G_h from (Yv', Nv', Yr', Nr', m', xG'm'), numbers or arrays of one shape.

    For G_v pass (Zw', Mw', Zq', Mq', -m', xG'm'): there the mass term changes its sign, G_v = 1 - Mw'(Zq' + m') /
    [Zw'(Mq' - xG'm')], the limit of high speed without restoring moment.
    """
    lever = moment_slope * (np.asarray(force_rate) - mass)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray(1.0 - lever / (force_slope * (np.asarray(moment_rate) - mass_moment)))


def index_gradient(
    force_slope: float, moment_slope: float, force_rate: float, moment_rate: float, mass: float, mass_moment: float
) -> Array:
    """Derivatives of the index by its first four arguments, shape (4,); not finite where a denominator is zero."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        slope, lever = np.float64(force_slope), np.float64(moment_slope)
        a, b = force_rate - mass, np.float64(moment_rate - mass_moment)
        product = lever * a / (slope * b)
        return np.array([product / slope, -a / (slope * b), -lever / (slope * b), product / b])


CENTRES = {"Nv'/Yv'": ("Nv", "Yv", 1.0), "-Mw'/Zw'": ("Mw", "Zw", -1.0)}
INDICES = {"G_h": ("Yv'", "Nv'", "Yr'", "Nr'", 1.0), "G_v": ("Zw'", "Mw'", "Zq'", "Mq'", -1.0)}
FAST = "at high speed"
DRAWS, SEED = 20_000, 1
LARGE_SPREAD = 0.25  # of a denominator, above which the interval of a ratio is not symmetric
APART = 0.1  # of the Monte Carlo half-width, by which the linear one may differ and still stand for it
FRACTION = (
    0.25  # of the Monte Carlo half-width: a smaller linear one is no half-width, as with a product of two small numbers
)


@dataclass(frozen=True, slots=True)
class Derived:
    """One quantity.

    Attributes
    ----------
    name, subject : str
        ``subject`` is the campaign or parameter file.
    value : float
    result : Propagated or None
        None where no interval can be given.
    statement : str
        Why not, or how far the two half-widths agree.
    driven : str
        Of a stability index: the denominator that is not below zero. The sign of the index is no criterion then.
    spread : float
        95 % half-width of the product of its denominators over that product, first order, without their covariance.
    """

    name: str
    subject: str
    value: float
    result: Propagated | None
    statement: str
    driven: str = ""
    spread: float = 0.0

    @property
    def by_draws(self) -> bool:
        """Whether the Monte Carlo limits are the interval: a denominator is uncertain, or the linear half-width differs from theirs."""
        return self.result is not None and (self.spread > LARGE_SPREAD or _apart(self.result) > APART)

    @property
    def represented(self) -> bool:
        """Whether the linear half-width may stand beside the value: it is no small part of that by Monte Carlo."""
        return self.result is not None and not (
            self.by_draws and self.result.linear < FRACTION * self.result.monte_carlo
        )

    @property
    def half_width(self) -> float | None:
        """The linear one, where there is one that represents the interval."""
        return self.result.linear if self.result is not None and self.represented else None

    @property
    def interval(self) -> tuple[float, float] | None:
        """The 95 % limits that the index is judged by; None without any."""
        if self.result is None:
            return None
        if self.by_draws:
            return self.result.low, self.result.high
        return self.value - self.result.linear, self.value + self.result.linear

    @property
    def limits(self) -> str:
        """The 95 % limits by Monte Carlo where they are the interval, and what the linear half-width is then; else empty."""
        if self.result is None or not self.by_draws:
            return ""
        r = self.result
        drawn = f"({r.draws} draws, seed {r.seed})"
        if self.represented:
            return f"U95 is linearised; 95 % Monte Carlo limits {number(r.low, 3)} .. {number(r.high, 3)} {drawn}"
        return (
            f"95 % Monte Carlo limits {' .. '.join(self._ends)} {drawn}; the linearised U95, {number(r.linear, 2)}, leaves out "
            "the product of two small uncertain numbers"
        )

    @property
    def _ends(self) -> tuple[str, str]:
        r = self.result
        return ("", "") if r is None else (with_u95(r.low, r.monte_carlo)[0], with_u95(r.high, r.monte_carlo)[0])

    @property
    def in_words(self) -> str:
        """Value and interval: ``0.65 +- 0.32``, or with Monte Carlo limits where the linear half-width does not represent them."""
        if self.result is None:
            return f"{self.value:.3g}"
        if self.represented:
            return plus_minus(self.value, self.result.linear)
        value, _ = with_u95(self.value, self.result.monte_carlo)
        return f"{value}, 95 % limits {' to '.join(self._ends)}"

    @property
    def decided(self) -> bool:
        """Whether the sign of a stability index is: damping damps, and the interval, where there is one, leaves zero out."""
        held = self.interval
        return not self.driven and (held is None or held[0] > 0.0 or held[1] < 0.0)


class Verdict(StrEnum):
    """What a stability index says of straight motion."""

    STABLE = "stable"
    UNSTABLE = "unstable"
    SIGN_OPEN = "sign open"  # its interval holds zero
    NONE = "no verdict"  # side force or turning moment drives

    @property
    def decided(self) -> bool:
        """Whether it is one of the two."""
        return self in (Verdict.STABLE, Verdict.UNSTABLE)


def verdict(index: Derived) -> Verdict:
    """What a stability index says: positive is stable only where side force and turning moment damp."""
    if not index.decided:
        return Verdict.NONE if index.driven else Verdict.SIGN_OPEN
    held = index.interval
    return Verdict.STABLE if (index.value if held is None else held[0]) > 0.0 else Verdict.UNSTABLE


def sense(index: Derived) -> str:
    """The verdict in words: G_v leaves out the restoring moment and holds at high speed only; an index may lack its U95."""
    says = verdict(index)
    if not says.decided:
        return says
    return says + f" {FAST}" * (index.name == "G_v") + ", no U95" * (index.result is None)


def without_restoring(parameters: ParameterFile) -> str:
    """What G_v leaves out, a sentence."""
    words = "G_v is the limit of high speed, without the restoring moment of weight and buoyancy"
    if parameters.hydrostatics is None:
        speed = number(parameters.conditions.speed, 3)
        words += f"; it gives no verdict at {speed} m/s, the speed of the parameter file, because BG is unknown"
    return f"{words}."


def by_mass(parameters: ParameterFile, index: Derived, share: float = 0.01) -> float:
    """How much an index of `stability` changes where the mass is larger by a share, about the same centre of gravity."""
    *symbols, sign = INDICES[index.name]
    chosen = [c for s in symbols if (c := parameters.coefficient(str(s)))]
    if parameters.mass is None:
        return 0.0
    slope, lever, rate, moment_rate = (np.array(float(c.value or 0.0)) for c in chosen)
    mass, moment = float(sign) * parameters.mass.mass_prime, parameters.mass.mass_moment_prime
    more = stability_index(slope, lever, rate, moment_rate, mass * (1.0 + share), moment * (1.0 + share))
    return float(more) - index.value


def centre_of_pressure(
    among: CoefficientSet, subject: str, draws: int = DRAWS, seed: int = SEED
) -> tuple[Derived, ...]:
    """x/L = Nv'/Yv' and -Mw'/Zw', forward of the reference point, of the planes that a set has."""
    whole = among.covariance
    out = []
    for name, (moment, force, sign) in CENTRES.items():
        if any(s not in among or among[s].value is None for s in (moment, force)):
            continue
        at = [among.symbols.index(s) for s in (moment, force)]
        m, f = (float(among.coefficients[i].value or 0.0) for i in at)
        if f == 0.0:
            continue
        cells = whole[np.ix_(at, at)]
        gradient = sign * np.array([1.0 / f, -m / f**2])

        def ratio(d: Array, m: float = m, f: float = f, sign: float = sign) -> Array:
            return np.asarray(sign * (m + d[:, 0]) / (f + d[:, 1]))

        denominators = [(primed(force), f, 2.0 * float(cells[1, 1]) ** 0.5)]
        out.append(
            derived(name, subject, sign * m / f, ratio, gradient, cells, denominators, (moment, force), draws, seed)
        )
    return tuple(out)


def stability(parameters: ParameterFile, draws: int = DRAWS, seed: int = SEED) -> tuple[Derived, ...]:
    """G_h and G_v of a parameter file that has the mass and all four derivatives of a plane."""
    out = []
    for name, (*symbols, sign) in INDICES.items():
        chosen = [c for s in symbols if (c := parameters.coefficient(str(s))) is not None and c.value is not None]
        if parameters.mass is None or len(chosen) < len(symbols):
            continue
        values = np.array([float(c.value or 0.0) for c in chosen])
        mass, moment = float(sign) * parameters.mass.mass_prime, parameters.mass.mass_moment_prime
        place = {s: i for i, s in enumerate(parameters.covariance.symbols)}
        rows = [place.get(c.symbol) for c in chosen]
        cells = [[None if i is None or j is None else parameters.covariance.matrix[i][j] for j in rows] for i in rows]
        whole = np.array([[np.nan if v is None else v for v in row] for row in cells])
        gradient = index_gradient(
            float(values[0]), float(values[1]), float(values[2]), float(values[3]), mass, moment
        )  # fmt: skip

        def index(d: Array, at: Array = values, mass: float = mass, moment: float = moment) -> Array:
            force_slope, moment_slope, force_rate, moment_rate = (at + d).T
            return stability_index(force_slope, moment_slope, force_rate, moment_rate, mass, moment)

        halves = 2.0 * np.sqrt(np.diag(whole))
        denominators = [
            (chosen[0].symbol, float(values[0]), float(halves[0])),
            (f"{chosen[3].symbol} - xG'm'", float(values[3]) - moment, float(halves[3])),
        ]
        value = float(index(np.zeros((1, 4)))[0])
        wanted = [c.symbol for c in chosen]
        found = derived(name, parameters.name, value, index, gradient, whole, denominators, wanted, draws, seed)
        out.append(replace(found, driven=next((label for label, size, _ in denominators if size >= 0.0), "")))
    return tuple(out)


def missing_for_stability(parameters: ParameterFile) -> tuple[str, ...]:
    """What the one of G_h and G_v lacks that lacks less: derivatives, and ``mass``; () where one can be had."""
    known = {c.symbol for c in parameters.coefficients if c.value is not None}
    lacks = [tuple(str(s) for s in symbols if s not in known) for *symbols, _ in INDICES.values()]
    return min(lacks, key=len) + ("mass",) * (parameters.mass is None)


def _apart(result: Propagated) -> float:
    """How far the linear half-width is from that by Monte Carlo, as a share of the latter."""
    return abs(result.linear / result.monte_carlo - 1.0) if result.monte_carlo > 0.0 else 0.0


def derived(
    name: str,
    subject: str,
    value: float,
    function: Callable[[Array], Array],
    gradient: Array,
    cells: Array,
    denominators: Sequence[tuple[str, float, float]],
    symbols: Sequence[str],
    draws: int,
    seed: int,
) -> Derived:
    """A quantity with both half-widths; none where a coefficient or a denominator allows none."""
    without = [s for s, half in zip(symbols, np.diag(cells), strict=True) if not np.isfinite(half)]
    if not np.all(np.isfinite(cells)):
        without = without or list(symbols)
        return Derived(
            name, subject, value, None, f"no U95: {listed(without)} {'has' if len(without) == 1 else 'have'} none"
        )
    for label, size, half in denominators:
        if reaches_zero(size, half):
            text = f"no U95: {name} divides by {label} = {size:.3g} +- {half:.2g}, whose interval contains zero"
            return Derived(name, subject, value, None, text)
    spread = sum((half / size) ** 2 for _, size, half in denominators) ** 0.5
    result = propagate(function, gradient, cells, draws, seed)
    apart = _apart(result)
    text = f"linear and Monte Carlo half-widths differ by {100.0 * apart:.1f} %"
    if apart > APART:
        text += ": the interval is skew, use the percentiles"
    return Derived(name, subject, value, result, text, spread=spread)
