"""What a fixed form leaves out: a remainder of unknown size, and what it does to the coefficients.

``y = H b + g + noise``. g is nothing, or one function that H lacks (a constant, the next powers, products of two
variables, a bend), or a smooth sum of them; its size is that of largest restricted likelihood (Patterson & Thompson
1971), so that residuals without a pattern give the size zero. Each of these gives the least-squares b a shift, and an error of that
shift. Their mean square, weighted by likelihood and prior odds, is the form's part of U95 (Kennedy & O'Hagan 2001, with
a finite dictionary). The odds were chosen on the simulated truths of ``tests/coverage/forms_campaigns.py``.

A misfit of the size of the noise is not seen and not covered: no method that leaves clean intervals as they are can.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from coeflab.core.types import Array, dataclass, locked
from coeflab.fits.statistics.cross_validation import constrained_space, unit_columns
from coeflab.fits.statistics.least_squares import BLOCK, factorise
from coeflab.law.terms import Term

NONE = 6.0  # odds of no remainder against all others together
SMOOTH, ROUGH, ANY = 0.5, 0.5, 0.25  # odds of sums against single ones: powers and all of the parity of the form, all
HIGHER, OTHER_PARITY, OFFSET, BENT = 0.5, 0.25, 0.5, 0.4
BENDS = (0.2, 0.35, 0.5, 0.65, 0.8)  # of the largest |x|
BEYOND, TOTAL = 2, 3  # powers above those of the form, total degree of products of two variables
SIZES = 10.0 ** np.arange(-1.5, 6.01, 0.25)
VISIBLE, ROUNDING, LEAST = 1e-4, 1e-20, 1e-12
UNLIKELY, MANY_TIMES, SHARE = 0.02, 3.0, 0.5  # of a right form; of the scatter; of the value


@dataclass(frozen=True, slots=True)
class Missing:
    """A function that the form lacks: a term, or where ``bend`` is positive the part of it beyond that share of max|x|.

    ``alike``: of the parity of the form, which may be odd or even in all variables together.
    """

    term: Term
    odds: float
    alike: bool
    bend: float = 0.0

    def __str__(self) -> str:
        if self.bend:
            return f"a bend in {self.term.factors[0][0]}"
        return f"a term {self.term}" if self.term.factors else "a constant"

    def of(self, columns: Mapping[str, Array]) -> Array:
        """Values (n,) over columns scaled to a largest size of one."""
        if not self.bend:
            return self.term.evaluate(columns)
        x = columns[self.term.factors[0][0]]
        beyond = np.maximum(np.abs(x) - self.bend, 0.0) / (1.0 - self.bend)
        return np.asarray(beyond if self.term.factors[0][2] else np.sign(x) * beyond)


@dataclass(frozen=True, slots=True, eq=False)
class Remainder:
    """What the residuals say of a form.

    Attributes
    ----------
    covariance : (p, p) array
        The form's part of the 95 % half-widths: its diagonal is their square.
    none : float
        Probability that the form lacks nothing, of these.
    likeliest : str
        The likeliest missing function in words; empty where ``none`` is above one half.
    rejected : (p,) bool array
        Coefficients without an interval: a right form is improbable, and another would move the value by more than three
        times its scatter and half of itself.
    """

    covariance: Array
    none: float
    likeliest: str
    rejected: NDArray[np.bool_]

    def __post_init__(self) -> None:
        object.__setattr__(self, "covariance", locked(self.covariance))
        object.__setattr__(self, "rejected", locked(self.rejected, bool))

    def over(self, shares: Array) -> Remainder:
        """That of coefficients ``shares @ b``, each a multiple of one b, shape (q, p)."""
        return Remainder(
            shares @ self.covariance @ shares.T, self.none, self.likeliest, (shares != 0.0) @ self.rejected
        )

    @property
    def half_width(self) -> Array:
        """(p,) 95 % half-widths."""
        return np.asarray(np.sqrt(np.maximum(np.diag(self.covariance), 0.0)))


def missing(terms: Sequence[Term], variables: Sequence[str]) -> tuple[Missing, ...]:
    """Functions that a form may lack, with their odds.

    Parameters
    ----------
    terms : sequence of Term
        Of the form.
    variables : sequence of str
        Over which it lies; those of its terms where it has any.
    """
    own = [dict.fromkeys(variables, 0) for _ in terms]
    for powers, term in zip(own, terms, strict=True):
        for v, n, _ in term.factors:
            powers[v] = powers.get(v, 0) + n
    used = [v for v in dict.fromkeys(v for p in own for v in p) if any(p.get(v, 0) for p in own)] or list(variables)
    top = {v: max(p.get(v, 0) for p in own) for v in used}
    parities = {sum(t.odd_in(v) for v in used) % 2 for t in terms if t.factors} or {0, 1}

    def both(v: str, n: int) -> tuple[Term, Term]:
        lower = ((v, n - 1, False),) if n > 1 else ()
        return Term(((v, n, False),)), Term((*lower, (v, 1, True)))

    def missing_term(term: Term, excess: int, share: float = 1.0, bend: float = 0.0) -> Missing:
        alike = sum(term.odd_in(v) for v in used) % 2 in parities
        return Missing(term, share * (1.0 if alike else OTHER_PARITY) * HIGHER ** max(excess - 1, 0), alike, bend)

    out = [missing_term(Term(), 0, OFFSET)]
    for v in used:
        for n in range(1, top[v] + BEYOND + 1):
            out += [missing_term(t, n - top[v]) for t in both(v, n)]
        out += [missing_term(t, 1, BENT, bend) for bend in BENDS for t in both(v, 1)]
    degree = max(TOTAL, max(top.values(), default=0) + 1)
    for a, b in combinations(used, 2):
        for i, j in product(range(1, degree), repeat=2):
            if i + j <= degree:
                each = (Term((*p.factors, *q.factors)) for p in both(a, i) for q in both(b, j))
                out += [missing_term(t, max(i - top[a], j - top[b])) for t in each]
    return tuple(out)


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """The rows of one response in a fit: its terms, and their variables (n,).

    ``lines``: slopes that are lines by a set that nobody chose have x|x| in their part of the form, seen or not.
    """

    rows: slice
    terms: tuple[Term, ...]
    columns: Mapping[str, Array]
    lines: bool = False

    @property
    def companions(self) -> frozenset[Term]:
        """Of its terms, where ``lines`` asks for them."""
        return companions(self.terms) if self.lines else frozenset()


def companions(terms: Sequence[Term]) -> frozenset[Term]:
    """x|x| of every slope in x without another power of x alone.

    Over several motions such a slope is the line through a range of x: what bends there goes into it, and the scatter hides it.

    Examples
    --------
    >>> line, bent = Term((("r", 1, False),)), Term((("r", 1, False), ("r", 1, True)))
    >>> companions([line]) == {bent}, companions([line, bent])
    (True, frozenset())
    """
    alone = [t for t in terms if len({v for v, _, _ in t.factors}) == 1]
    bent = {t.factors[0][0] for t in alone if t.degree > 1}
    slopes = {v for t in alone for v, _, _ in t.factors if t.degree == 1 and t.odd_in(v)} - bent
    return frozenset(Term(((v, 1, False), (v, 1, True))) for v in slopes)


def left_out(
    design: Array,
    residuals: Array,
    errors: Array | None,
    constraint: tuple[Array, Array] | None,
    blocks: Sequence[Block],
) -> tuple[Array, tuple[tuple[float, str], ...]]:
    """What the forms of a fit may leave out.

    Parameters
    ----------
    design : (n, p) array
    residuals : (n,) array
        Of the response, unweighted.
    errors : (n,) array or None
        Standard errors that weighed the rows.
    constraint : ((k, p) array, (k,) array) or None
        C and d of C b = d.
    blocks : sequence of Block
        One a response.

    Returns
    -------
    covariance : (p, p) array
        The form's part of the 95 % half-widths, all responses together.
    found : tuple of (float, str)
        Of each block, ``none`` and ``likeliest`` of `Remainder`.
    """
    unit, size = unit_columns(design)
    free = constrained_space(None if constraint is None else (constraint[0] / size, constraint[1]), design.shape[1])[1]
    f = factorise(unit @ free, None if errors is None else errors**-2.0)
    back, weighted = free @ f.back / size[:, None], residuals * f.root_weights
    total = float(weighted @ weighted)
    covariance, found = np.zeros((design.shape[1], design.shape[1])), []
    for block in blocks:
        rows = block.rows
        functions = missing(block.terms, tuple(block.columns))
        part, none, likeliest = _of_block(
            functions,
            block.companions,
            block.columns,
            f.root_weights[rows],
            f.basis[rows],
            back,
            weighted[rows],
            f.freedom,
            total,
        )
        covariance += part
        found.append((none, likeliest))
    return covariance, tuple(found)


def _of_block(
    functions: Sequence[Missing],
    companions: Collection[Term],
    columns: Mapping[str, Array],
    root_weights: Array,
    basis: Array,
    back: Array,
    residuals: Array,
    freedom: int,
    total: float,
) -> tuple[Array, float, str]:
    """Of one response: covariance, ``none`` and ``likeliest``; (n,) arrays over its rows, ``total`` over all of them."""
    p, n = len(back), len(residuals)
    nothing = np.zeros((p, p)), 1.0, ""
    largest = {v: float(np.max(np.abs(x), initial=0.0)) or 1.0 for v, x in columns.items()}
    m = len(functions)
    gram, inside, moment = np.zeros((m, m)), np.zeros((basis.shape[1], m)), np.zeros(m)
    for low in range(0, n, BLOCK):
        rows = slice(low, low + BLOCK)
        scaled = {v: x[rows] / largest[v] for v, x in columns.items()}
        f = np.column_stack([g.of(scaled) for g in functions]) * root_weights[rows, None]
        gram += f.T @ f
        inside += basis[rows].T @ f
        moment += f.T @ residuals[rows]
    size = np.sqrt(np.diag(gram))
    gram = gram - inside.T @ inside
    keep = np.flatnonzero(np.diag(gram) > (VISIBLE * size) ** 2)
    if freedom < 2 or not len(keep) or total <= 0.0:
        return nothing
    retained = [functions[int(k)] for k in keep]
    odds = np.array([g.odds for g in retained])
    alike = np.array([g.alike for g in retained])
    smooth = alike & np.array([not g.bend for g in retained])
    gram, moment, moves = gram[np.ix_(keep, keep)], moment[keep], back @ inside[:, keep]
    # One function alone: the ratio of its square to the noise is its restricted likelihood's largest size plus one.
    level = np.diag(gram)
    seen = np.minimum(moment**2 / level, total)
    noise = np.maximum(total - seen, LEAST * total) / (freedom - 1)
    ratio = np.maximum(seen / noise, 1.0)
    share = 1.0 - 1.0 / ratio
    left = np.maximum(total - seen * share, LEAST * total)
    gains = [0.0, *(-0.5 * np.log(ratio) - 0.5 * freedom * np.log(left / total))]
    prior = [NONE * odds.sum(), *odds]
    shifts = moves * (share * moment / level)
    spreads = moves * np.sqrt(left / freedom * share / level)
    parts = [np.zeros((p, p))]
    parts += [np.outer(a, a) + np.outer(b, b) for a, b in zip(shifts.T, spreads.T, strict=True)]
    for chosen, weight in ((smooth, SMOOTH), (alike, ROUGH), (np.ones(len(keep), dtype=bool), ANY)):
        if chosen.sum() > 1:
            more, part = _sum(
                gram[np.ix_(chosen, chosen)], moment[chosen], moves[:, chosen], odds[chosen], freedom, total
            )
            gains.append(more)
            prior.append(weight * odds.sum())
            parts.append(part)
    # Only what a likelihood gains counts: a function without evidence has no weight.
    gain, most = np.array(gains), float(np.max(gains))
    shares = np.array(prior) * (np.exp(gain - most) - np.where(gain != 0.0, np.exp(-most), 0.0))
    shares[1:] = np.where(gain[1:] > 0.0, shares[1:], 0.0)
    shares /= shares.sum()
    weights = shares.copy()
    for k in (k for k, g in enumerate(retained) if g.term in companions and not g.bend):
        # As a term of the form: whole, whether the residuals ask for it or not, and whatever else they ask for.
        shift, spread = moves[:, k] * moment[k] / level[k], moves[:, k] * np.sqrt(noise[k] / level[k])
        weights[k + 1], parts[k + 1] = 1.0, np.outer(shift, shift) + np.outer(spread, spread)
    covariance = float(stdtrit(freedom, 0.975)) ** 2 * np.einsum("k,kij->ij", weights, np.array(parts))
    likeliest = str(retained[int(np.argmax(shares[1 : len(retained) + 1]))]) if shares[0] < 0.5 else ""
    return covariance, float(shares[0]), likeliest


def _sum(gram: Array, moment: Array, moves: Array, odds: Array, freedom: int, total: float) -> tuple[float, Array]:
    """Gain in log likelihood of a Gaussian process of these functions, and the mean square that it gives (p, p)."""
    root = np.sqrt(odds)
    level, turned = np.linalg.eigh(gram * np.outer(root, root))
    level = np.maximum(level, 0.0)
    seen = np.where(level > VISIBLE**2 * level[-1], turned.T @ (moment * root), 0.0)
    sizes = SIZES[:, None] ** 2 / level[-1]
    left = np.maximum(total - np.sum(sizes * seen**2 / (1.0 + sizes * level), axis=1), LEAST * total)
    gains = -0.5 * np.sum(np.log1p(sizes * level), axis=1) - 0.5 * freedom * np.log(left / total)
    best = int(np.argmax(gains))
    if gains[best] <= 0.0:
        return 0.0, np.zeros((len(moves), len(moves)))
    shrunk = sizes[best] / (1.0 + sizes[best] * level)
    along = (moves * root) @ turned
    shift = along @ (shrunk * seen)
    return float(gains[best]), np.outer(shift, shift) + left[best] / freedom * (along * shrunk) @ along.T


def judged(covariance: Array, none: float, likeliest: str, values: Array, scatter: Array) -> Remainder:
    """With the coefficients that have no interval.

    Parameters
    ----------
    covariance, none, likeliest
        Of `left_out`.
    values, scatter : (p,) array
        Coefficients and the 95 % half-widths of their scatter; NaN where there is none.
    """
    known = np.isfinite(scatter)
    covariance = np.where(known[:, None] & known, covariance, 0.0)
    half = np.sqrt(np.diag(covariance))
    beyond = (half > MANY_TIMES * np.nan_to_num(scatter)) & (half > SHARE * np.abs(np.nan_to_num(values)))
    return Remainder(covariance, none, likeliest, known & beyond & (none < UNLIKELY))
