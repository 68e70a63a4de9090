"""A force component of a joint fit, and the equations that tie components together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.fits.joint.rows import JointRows
from coeflab.fits.statistics.groups import noise_of_groups
from coeflab.law.named_terms import Equation, NamedTerm, read_term
from coeflab.law.terms import design

Constraint = tuple[Array, Array]


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """One force component of a joint fit.

    Attributes
    ----------
    name : str
    terms : tuple of NamedTerm
        Common to all campaigns.
    data : JointRows
    errors : (n,) array or None
        Standard deviations that weigh the rows.
    own : bool
        Every campaign has an intercept of its own, in columns behind those of the terms.
    lines : bool
        A slope without another power of its variable may lack x|x|, whatever the residuals show: nobody chose the form.
    """

    name: str
    terms: tuple[NamedTerm, ...]
    data: JointRows
    errors: Array | None = None
    own: bool = False
    lines: bool = False

    @property
    def common(self) -> Array:
        """Design of the terms, shape (n, p)."""
        return design(tuple(t.term for t in self.terms), self.data.rows.x)

    @property
    def intercepts(self) -> Array:
        """Which campaign every row is of, as columns of 0 and 1, shape (n, campaigns); none where they are shared."""
        present = np.array(self.data.present if self.own else (), dtype=np.int64)
        return np.asarray(self.data.campaign[:, None] == present, dtype=np.float64)

    @property
    def matrix(self) -> Array:
        """Design, shape (n, p + intercepts)."""
        return np.column_stack([self.common, self.intercepts])

    @property
    def width(self) -> int:
        """Columns of the design."""
        return len(self.terms) + (len(self.data.present) if self.own else 0)

    @property
    def symbols(self) -> tuple[str, ...]:
        """Names of the common coefficients."""
        return tuple(t.symbol for t in self.terms)

    @property
    def idle(self) -> tuple[str, ...]:
        """Common coefficients whose motion occurs in no row."""
        return tuple(s for s, column in zip(self.symbols, self.common.T, strict=True) if not np.any(column))

    @property
    def every_symbol(self) -> tuple[str, ...]:
        """Names of all columns."""
        campaigns = [self.data.campaigns[k] for k in self.data.present] if self.own else []
        return (*self.symbols, *(f"{self.name}0 of {c}" for c in campaigns))

    def weighed(self, *, stated: bool) -> Component:
        """With the weights of the rows: several campaigns by the scatter of each about its own law.

        Parameters
        ----------
        stated : bool
            Weigh the rows of a campaign by their standard errors.
        """
        errors = self.data.rows.errors if stated else None
        if len(self.data.present) > 1:
            errors = noise_of_groups(self.matrix, self.data.rows.y, self.data.campaign, errors)
        return replace(self, errors=errors)


def constraint_of(equations: Sequence[Equation], parts: Sequence[Component], place: str) -> Constraint:
    """C and d of C b = d over all columns of ``parts``.

    Raises
    ------
    InputError
        An equation names a coefficient that the model does not have.
    """
    starts = accumulate((p.width for p in parts), initial=0)
    index = {t.key: start + i for p, start in zip(parts, starts, strict=False) for i, t in enumerate(p.terms)}
    matrix = np.zeros((len(equations), sum(p.width for p in parts)))
    for row, equation in enumerate(equations):
        for symbol, weight in equation.weights:
            named = read_term(symbol, place)
            if named.key not in index:
                names = ", ".join(s for p in parts for s in p.symbols)
                apart = not named.term.factors and any(p.own and p.name == named.component for p in parts)
                raise input_error(
                    "fits.coefficients_model", column=place, symbol=shown(symbol), equation=shown(equation), names=names,
                    advice=f"Add {symbol} to the terms" + ("; one value then serves all campaigns." if apart else "."),
                )  # fmt: skip
            matrix[row, index[named.key]] += weight
    return matrix, np.array([e.right for e in equations])


def linked(components: Sequence[str], equations: Sequence[Equation]) -> list[tuple[str, ...]]:
    """Components that equations tie together, in the order given."""
    group = {c: {c} for c in components}
    for equation in equations:
        tied = {symbol[0] for symbol, _ in equation.weights}
        merged = set().union(*(group.get(c, set()) for c in tied))
        for c in merged:
            group[c] = merged
    out: list[tuple[str, ...]] = []
    for c in components:
        if not any(c in g for g in out):
            out.append(tuple(k for k in components if k in group[c]))
    return out
