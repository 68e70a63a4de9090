"""`Result`: what a fit or an estimate gives: coefficients with U95, their covariance, points and pictures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.missed import suggesting, was_method
from coeflab.core.table import Check, percent, with_u95
from coeflab.core.table import Table as Shown
from coeflab.core.texts import input_error, remark
from coeflab.core.types import Array, in_angles
from coeflab.fits.joint.moving import LEFT_OUT
from coeflab.fits.results.fit_result import FitResult, Sweep, covariance_of
from coeflab.fits.rows.too_few import FEW_ROWS
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import primed

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from coeflab.api.fitted_law import FittedLaw
    from coeflab.fits.results.straight_runs import StraightRuns
    from coeflab.tables.force_table import ForceTable

LACKING = (FEW_ROWS, LEFT_OUT)  # why a coefficient has no value


class Points(NamedTuple):
    """What a coefficient was fitted to, primed.

    Attributes
    ----------
    x : (n,) array
        v' = v/U, w', r' = r L/U, or the angle of a control, rad; of X0' of straight runs the speed, m/s.
    y : (n,) array
        Force component, primed.
    used : (n,) boolean array
        Rows that carry the value; the others are repeated or do not fit.
    labels : tuple of str
    """

    x: Array
    y: Array
    used: NDArray[np.bool_]
    labels: tuple[str, ...]


@suggesting
@dataclass(frozen=True, slots=True, eq=False)
class Result(Mapping[str, Coefficient]):
    """Coefficients by symbol: ``result["Yv'"].value``, ``.u95``, ``.status``.

    Attributes
    ----------
    fits : tuple of FitResult
        One a campaign, or one of all jointly.
    tables : tuple of ForceTable
        What was fitted.

    Examples
    --------
    >>> import coeflab as cf
    >>> result = cf.fit("suboff_roddy_2")
    >>> round(result["Yv'"].value, 4), round(result["Yv'"].u95, 4)
    (-0.0262, 0.0027)
    >>> "Nv'" in result, len(result) > 1
    (True, True)
    """

    fits: tuple[FitResult, ...]
    tables: tuple[ForceTable, ...] = ()
    _found: list[tuple[Check, ...]] = field(default_factory=list, repr=False)

    def __repr__(self) -> str:
        laws = f"laws of {', '.join(self.laws)}" if not len(self) and self.laws else "no coefficient"
        return in_angles(self, ", ".join(c.said for c in self._all() if c.value is not None) or laws)

    def _repr_html_(self) -> str:
        from coeflab.core.cards import html_by

        return "".join(html_by("fit", f) for f in self.fits)

    def _all(self) -> list[Coefficient]:
        every = [c for f in self.fits for c in f.coefficients.coefficients]
        return [every[i] for i in self._rows()]

    def _rows(self) -> list[int]:
        """Places among all coefficients of those that stand in the result: without a value none that another campaign gives."""
        every = [c for f in self.fits for c in f.coefficients.coefficients]
        valued = {c.symbol for c in every if c.value is not None}
        return [i for i, c in enumerate(every) if c.value is not None or c.symbol not in valued]

    def _given_elsewhere(self) -> Iterator[Finding]:
        """Which campaign has no value of what another one gives."""
        shown_here = {id(c) for c in self._all()}
        for f in self.fits:
            if lacks := [primed(c.symbol) for c in f.coefficients.coefficients if id(c) not in shown_here]:
                yield Finding.of("sweep.given_elsewhere", f.campaign, Severity.NOTE, symbols=lacks)

    def __getitem__(self, symbol: str) -> Coefficient:
        """A coefficient by its symbol, with or without prime.

        Raises
        ------
        KeyError
            No fit has it.
        InputError
            Several campaigns give it a value.
        """
        own = [f for f in self.fits if symbol in f.coefficients]
        own = [f for f in own if f.coefficients[symbol].value is not None] or own[:1]
        if len(own) > 1:
            names = [f.campaign for f in own]
            raise input_error(
                "front_door.result_cf_fit", column=symbol, removesuffix=primed(symbol.removesuffix(chr(39))),
                count_of_own=len(own), names=", ".join(names), names_2=names[0], symbol=symbol,
            )  # fmt: skip
        if not own:
            law = f'; a law is result.laws["{symbol}"]' if symbol in self.laws else ""
            raise KeyError(f"no {shown(symbol)} among {', '.join(self) or 'no coefficients'}{law}")
        return own[0].coefficients[symbol]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(primed(c.symbol) for c in self._all()))

    def __len__(self) -> int:
        return len(dict.fromkeys(c.symbol for c in self._all()))

    def __contains__(self, symbol: object) -> bool:
        return isinstance(symbol, str) and any(symbol in f.coefficients for f in self.fits)

    def of(self, campaign: str) -> Result:
        """The same of one campaign.

        Parameters
        ----------
        campaign : str

        Examples
        --------
        >>> import coeflab as cf
        >>> len(cf.fit("suboff_roddy_2").of("suboff_roddy_2").fits)
        1
        """
        own = tuple(f for f in self.fits if f.campaign == campaign)
        if not own:
            raise InputError(
                f"no campaign {shown(campaign)}",
                f"one of {', '.join(f.campaign for f in self.fits)}",
                column="campaign",
            )
        return Result(own, tuple(t for t in self.tables if t.campaign in own[0].campaigns))

    @property
    def laws(self) -> Mapping[str, FittedLaw]:
        """Polynomials and surfaces by what they give: ``result.laws["C_D"].evaluate(alpha="7 deg")``.

        Examples
        --------
        >>> import coeflab as cf
        >>> list(cf.fit("suboff_roddy_2", "polynomial", variable="beta", degree=2, responses=["X", "N"]).laws)
        ["X'", "N'"]
        """
        from coeflab.api.fitted_law import FittedLaw

        several = len(self.fits) > 1
        return {
            f"{m.response} of {f.campaign}" if several else m.response: FittedLaw(m)
            for f in self.fits
            for m in f.models
        }

    @property
    def symbols(self) -> tuple[str, ...]:
        """Symbols with prime, as rows of `covariance` and `frame`; one that several campaigns give stands several times."""
        return tuple(primed(c.symbol) for c in self._all())

    @property
    def covariance(self) -> Array:
        """(k, k) of standard uncertainties (U95 / 2), in the order of `symbols`; NaN where a U95 is not known.

        Examples
        --------
        >>> import coeflab as cf
        >>> result = cf.fit("suboff_roddy_2")
        >>> i = result.symbols.index("Yv'")
        >>> round(float(2.0 * result.covariance[i, i] ** 0.5 / result["Yv'"].u95), 6)
        1.0
        """
        rows = self._rows()
        return np.asarray(covariance_of(self.fits)[np.ix_(rows, rows)])

    def frame(self) -> pd.DataFrame:
        """A row a coefficient: value, u95, status, points, window, campaign; primed, NaN without a value. Of laws alone a row a term.

        Examples
        --------
        >>> import coeflab as cf
        >>> round(float(cf.fit("suboff_roddy_2").frame().loc["Yv'", "value"]), 4)
        -0.0262
        """
        import pandas as pd

        rows = [
            {
                "value": np.nan if c.value is None else c.value, "u95": np.nan if c.u95 is None else c.u95, "status": str(c.status),
                "points": c.n_points, "low": np.nan if c.window is None else c.window[0],
                "high": np.nan if c.window is None else c.window[1], "campaign": c.campaign, "estimator": c.estimator,
            }
            for c in self._all()
        ]  # fmt: skip
        if not rows and self.laws:
            return pd.concat({name: law.frame() for name, law in self.laws.items()}, names=["response", "term"])
        return pd.DataFrame(rows, index=pd.Index(self.symbols, name="symbol"))

    def summary(self) -> Shown:
        """Value, U95, its share, points and status, to be printed or shown in a notebook.

        Examples
        --------
        >>> import coeflab as cf
        >>> print(cf.fit("suboff_roddy_2").summary())  # doctest: +ELLIPSIS
        suboff_roddy_2, primed by ...
        """
        rows: list[tuple[str, ...]] = [
            (
                primed(c.symbol),
                *with_u95(c.value, c.u95),
                percent(c.u95, c.value),
                str(c.n_points),
                str(c.status).replace("_", " "),
            )
            for c in self._all()
        ]
        if not rows:
            rows = [
                (s, *with_u95(v, u), percent(u, v), str(len(law.model.y)), law.response)
                for law in self.laws.values()
                for s, v, u in zip(law.model.symbols, law.frame()["value"], law.frame()["u95"], strict=True)
            ]
        names = ", ".join(dict.fromkeys(f.campaign for f in self.fits))
        headers: tuple[str, ...] = ("", "value", "U95", "U95 %", "points", "status")
        if len(set(self.symbols)) < len(self.symbols):
            headers, rows = (
                (*headers, "campaign"),
                [(*row, c.campaign or "") for row, c in zip(rows, self._all(), strict=True)],
            )
        by = self.fits[0].coefficients.scaling
        return Shown(
            f"{names}, primed by {by.length_name} {by.length:.5g} m", headers, tuple(rows),
            tuple(map(remark, [*dict.fromkeys(f for fit in self.fits for f in fit.findings if f.code in LACKING), *self._given_elsewhere()])),
            left=frozenset({0, 5, 6}),
        )  # fmt: skip

    def samples(self, n: int, seed: int = 1) -> pd.DataFrame:
        """Draws of the coefficients from a normal distribution with their values and `covariance`.

        Parameters
        ----------
        n : int
        seed : int

        Returns
        -------
        DataFrame
            n rows, a column a coefficient that has a value and a U95; ``attrs["without_u95"]`` names the others.

        Examples
        --------
        >>> import coeflab as cf
        >>> result = cf.fit("suboff_roddy_2")
        >>> drawn = result.samples(1000)
        >>> len(drawn), abs(float(drawn["Yv'"].std()) / (result["Yv'"].u95 / 2) - 1) < 0.1
        (1000, True)
        """
        import pandas as pd

        if n < 1:
            raise InputError(f"{n}", "a number of draws from 1", column="n")
        every, covariance = self._all(), self.covariance
        selected = [i for i, c in enumerate(every) if c.value is not None and np.isfinite(covariance[i, i])]
        drawn = np.random.default_rng(seed).multivariate_normal(
            [float(every[i].value or 0.0) for i in selected], covariance[np.ix_(selected, selected)], n, method="eigh"
        )
        out = pd.DataFrame(drawn, columns=[self.symbols[i] for i in selected])
        out.attrs["without_u95"] = [self.symbols[i] for i in range(len(every)) if i not in selected]
        return out

    @property
    def checks(self) -> tuple[Check, ...]:
        """What the checks of a study find in tables and fits, the gravest of which a reader should know; computed once.

        Examples
        --------
        >>> import coeflab as cf
        >>> {str(c.severity) for c in cf.fit("suboff_roddy_2").checks} <= {"pass", "note", "warn", "fail"}
        True
        """
        if not self._found:
            from coeflab.study.checking import checked
            from coeflab.study.study import Plan, Study

            name = self.fits[0].campaign
            study = Study(
                plan=Plan(name[:80], name, ()), tables=self.tables, fits=self.fits, missing=(), body=None, references=(),
                comparisons=(), parameter_files={}, inputs=(),
            )  # fmt: skip
            self._found.append(tuple(c for c in checked(study).checks if c.name != "law at points"))
        return was_method("checks", tuple(c.spoken() for c in self._found[0]))

    def _straight(self, symbol: str) -> StraightRuns | None:
        """Runs at several speeds that give X0', where no sweep does."""
        if symbol.removesuffix("'") != "X0" or any(s.symbol == "X0" for f in self.fits for s in f.sweeps):
            return None
        self[symbol]  # one campaign, and a coefficient that there is
        return next((r for f in self.fits for r in f.straight), None)

    def _sweep(self, symbol: str) -> Sweep:
        self[symbol]  # one campaign, and a coefficient that there is
        name = symbol.removesuffix("'")
        for f in self.fits:
            for s in f.sweeps:
                if s.symbol == name:
                    return s
        known = [primed(s.symbol) for f in self.fits for s in f.sweeps]
        raise input_error(
            "front_door.no_such_coefficient", column="symbol", symbol=shown(symbol),
            expected=f"one of {', '.join(known)}" if known else 'a fit of slopes, such as slope_at_origin',
        )  # fmt: skip

    def _plot_tied(self, symbol: str, ax: Axes | None) -> Axes | None:
        """The law of a term that is tied to a slope, over the points of that slope; None of any other coefficient."""
        from coeflab.law.named_terms import read_term
        from coeflab.report.plots import plot_tied

        c = self[symbol]
        tied = next((f for f in self.fits if f.tied is not None and c in f.coefficients.coefficients), None)
        variables = set() if tied is None else {v for v, _, _ in read_term(c.symbol, "symbol").term.factors}
        if tied is None or tied.tied is None or c.value is None or c.window is None or len(variables) != 1:
            return None
        (variable,) = variables
        slopes = next(f for f in self.fits if f.fit == tied.tied.fit and f.campaign == c.campaign)
        sweep = next(s for s in slopes.sweeps if s.component == c.symbol[0] and s.variable == variable)
        every = (*slopes.coefficients.coefficients, *tied.coefficients.coefficients)
        law = {
            x.symbol: x.value for x in every
            if x.value is not None and x.symbol[0] == c.symbol[0] and {v for v, _, _ in read_term(x.symbol, "symbol").term.factors} == variables
        }  # fmt: skip
        low, high = np.sin(c.window) if variable in ("v", "w") else c.window
        rest = [v for table, term, v in tied.tied.set_up if table == sweep.table and term == f"{c.symbol[0]}0"]
        return plot_tied(sweep, c.symbol, law, (float(low), float(high)), sum(rest), ax)

    def points(self, symbol: str) -> Points:
        """What a slope was fitted to, primed.

        Parameters
        ----------
        symbol : str

        Examples
        --------
        >>> import coeflab as cf
        >>> x, y, used, labels = cf.fit("suboff_roddy_2").points("Yv'")
        >>> x.shape == y.shape == used.shape
        True
        """
        if (runs := self._straight(symbol)) is not None:
            return Points(runs.speed, runs.primes, np.isfinite(runs.primes), runs.labels)
        s = self._sweep(symbol)
        return Points(s.x, s.y, s.used, s.labels)

    def plot(self, symbol: str | Sequence[str] | None = None, ax: Axes | None = None, *, kind: str = "") -> Axes:
        """A slope with its points and interval; without a symbol every coefficient with its interval.

        Parameters
        ----------
        symbol : str or sequence of str, optional
            One symbol: the points, the curve and the slope with U95; of ``Yv|v|'`` the law that it belongs to, of a cross term such as
            ``Yv|r|'`` its slices; of `laws` that law. None or several: a forest, or the one law.
        ax : Axes, optional
            To draw into, in the style that is set; by default that of a new figure. A colour of your own:
            ``with matplotlib.pyplot.style.context({"lines.color": "k"})``, or of the Axes that come back ``ax.lines[0].set_color("k")``.
        kind : {"", "forms"}
            ``forms``: what single forms would have given over growing ranges.

        Returns
        -------
        Axes

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.fit("suboff_roddy_2").plot("Yv'").get_ylabel()
        "Y'"
        """
        if kind not in ("", "forms"):
            raise InputError(shown(kind), '"forms", or nothing', column="kind")
        if symbol is None and not len(self) and len(self.laws) == 1:
            (symbol,) = self.laws
        if isinstance(symbol, str) and symbol in self.laws and symbol not in self:
            return self.laws[symbol].plot(ax=ax)
        if symbol is None and not len(self):
            raise InputError("no coefficient", f"one of {', '.join(self.laws) or 'no law'}", column="symbol")
        if isinstance(symbol, str) and (runs := self._straight(symbol)) is not None:
            from coeflab.report.plots import plot_straight_runs

            return plot_straight_runs(runs, ax)
        if isinstance(symbol, str):
            if not any(f.sweeps for f in self.fits):
                from coeflab.report.plots import plot_model

                self[symbol]
                return plot_model([m for f in self.fits for m in f.models], symbol, ax)
            if (drawn := self._plot_tied(symbol, ax)) is not None:
                return drawn
            from coeflab.report.plots import plot_forms, plot_slope

            return (plot_forms if kind else plot_slope)(self._sweep(symbol), ax)
        from coeflab.report.plots import plot_forest

        named = [self[s] for s in symbol] if symbol is not None else [c for c in self._all() if c.value is not None]
        return plot_forest([(primed(c.symbol.removesuffix("'")), [(c.value, c.u95)]) for c in named], (), ax)
