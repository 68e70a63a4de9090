"""Tables over two variables: drag, side force, lift and moments over angles of attack and drift.

The additive form C_D(a, b) = C_Da(a) + C_Db(b) - C_D0 is the corrected one: the sum of the two slices that the HUUV
paper (Talarczyk et al. 2025) prints holds the force at rest twice; a statement of the fit says by how much.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.options import bounded, measured, one_of, parse_options, words
from coeflab.core.texts import input_error
from coeflab.fits.results.fit_result import FitResult, result_of
from coeflab.fits.results.fitted_model import FittedModel, in_words
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.fits.rows import only_moving
from coeflab.fits.rows.regression import MOMENT_COEFFICIENTS, Area, Rows, collect, model_of
from coeflab.fits.rows.too_few import TooFewRowsError, each_with_rows
from coeflab.fits.statistics.extended_precision import sharpened
from coeflab.fits.statistics.nested_test import nested_test
from coeflab.law.domain import Extrapolation
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import PORT_STARBOARD
from coeflab.law.terms import Term, power_terms
from coeflab.tables.force_table import ForceTable

summary = "polynomial surfaces in two variables, additive or with interaction, each measured against the other"
citations = ("huuv2025", "allen1974", "hurvich1989", "mackinnon1985", "bell2002")
USUAL = ("C_D", "C_S", "C_L", "C_m", "C_n")
FORMS = ("tensor", "total", "additive")
PARITIES = ("full", "odd", "even", "symmetric")
ODD_RESPONSES = frozenset({"C_S", *(r for r, c in MOMENT_COEFFICIENTS.items() if c in "KN"), *"YKN"})


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    variables : tuple of str
        Two of alpha, beta, v, w, p, q, r and controls.
    responses : tuple of str
        By default those of C_D C_S C_L C_m C_n that the tables allow.
    degree : int
        Of each variable (``tensor``, ``additive``) or of the product (``total``).
    form : str
        ``tensor``: every product of powers up to the degree in each variable; ``total``: those whose powers add up to the
        degree; ``additive``: a curve in each variable, no products.
    parity : tuple of str
        ``variable=odd|even|full|symmetric``. ``symmetric`` takes the parity of each response from port-starboard
        symmetry: side force, roll and yaw odd in beta, the others even. That is the default of the variables which the
        symmetry turns around (beta, v, p, r, dr; of two such variables their product counts); others are full.
    extrapolation : str
        What a reader outside the data is to do.
    area : float
        0 is the square of the primes' length.
    area_name : str
        What the area is.
    """

    variables: tuple[str, ...] = words("alpha", "beta")
    responses: tuple[str, ...] = words()
    degree: int = bounded(4, 1, 8)
    form: str = one_of("tensor", *FORMS)
    parity: tuple[str, ...] = words()
    extrapolation: str = one_of("refuse", "refuse", "clamp", "taper")
    area: float = measured(0.0, 0.0, 1e6, "area")
    area_name: str = one_of(only_moving.PRIMES, *only_moving.AREAS)


def _sided(chosen: Options) -> list[str]:
    """Variables that port-starboard symmetry turns around."""
    return [v for v in chosen.variables if v == "beta" or v in PORT_STARBOARD]


def _mirrored(terms: tuple[Term, ...], chosen: Options, name: str) -> tuple[Term, ...]:
    """The terms that symmetry allows, unless the parity of a variable that it turns around is asked for."""
    sided = _sided(chosen)
    if not sided or any(word.partition("=")[0] in sided for word in chosen.parity):
        return terms
    odd = name in ODD_RESPONSES
    return tuple(t for t in terms if sum(t.odd_in(v) for v in sided) % 2 == odd)


def _parities(chosen: Options, name: str) -> dict[str, str]:
    """Parity of every variable for one response."""
    out: dict[str, str] = {}
    sided = _sided(chosen)
    for word in chosen.parity:
        variable, _, rule = word.partition("=")
        if variable not in chosen.variables or rule not in PARITIES:
            raise input_error(
                "fits.variable_rule_one", column="surface.parity", found=shown(word), variables=", ".join(chosen.variables),
                parities=", ".join(PARITIES),
            )  # fmt: skip
        if rule == "symmetric":
            if sided != [variable]:
                raise input_error("fits.symmetric_for_one_variable", column="surface.parity", found=shown(word))
            rule = "odd" if name in ODD_RESPONSES else "even"
        out[variable] = rule
    return out


def _fitted(rows: Rows, chosen: Options, form: str, area: Area) -> FittedModel | None:
    """One form; None where it has no terms or more than the rows can carry."""
    variables = tuple(rows.x)
    rule = _parities(chosen, rows.response)
    only_moving.check_varies(rows)
    every = power_terms(variables, chosen.degree, form, rule)
    terms = _mirrored(every, chosen, rows.response)
    if not terms or len(terms) >= len(rows.y):
        return None
    name = only_moving.named_response(rows.response, area)
    symbols = tuple(f"{name}_{t if t.factors else 0}" for t in terms)
    parities = "".join(f", {r} in {v}" for v, r in rule.items() if r != "full")
    if len(terms) < len(every):
        parities += f", {'odd' if rows.response in ODD_RESPONSES else 'even'} in {' times '.join(_sided(chosen))}"
    shape = {
        "tensor": f"surface of degree {chosen.degree} in each of {' and '.join(variables)}",
        "total": f"surface of total degree {chosen.degree} in {' and '.join(variables)}",
        "additive": f"sum of curves of degree {chosen.degree} in {' and '.join(variables)}, value at rest once",
    }[form]
    model = model_of(rows, terms, symbols, shape + parities, rule=Extrapolation(chosen.extrapolation))
    return replace(model, response=name, fit=sharpened(model.fit, terms, rows.x, rows.y, rows.errors))


def _squares(model: FittedModel, rows: Rows) -> float:
    """Weighted sum of squared residuals."""
    weights = np.ones(len(rows.y)) if rows.errors is None else rows.errors**-2.0
    return float(np.sum(weights * model.fit.residuals**2))


def compared(additive: FittedModel | None, full: FittedModel | None, rows: Rows) -> str:
    """The additive form against the full one, in words.

    Both by rms, by the rms of left-out points (PRESS) and by AICc; the F test of the interaction terms assumes equal,
    independent, normal noise.

    Parameters
    ----------
    additive, full : FittedModel or None
        None where it could not be fitted.
    rows : Rows
        What both were fitted to.
    """
    if additive is None or full is None:
        what = "additive form has no terms of this parity" if additive is None else "full form has too many terms"
        return f"The interaction of the variables is not tested: the {what}."
    test = nested_test(_squares(additive, rows), additive.fit.rank, _squares(full, rows), full.fit.rank, len(rows.y))
    if test.between <= 0:
        return "The additive and the full form have the same terms: there is no interaction to test."
    sides = "; ".join(
        f"{label}: {len(m.terms)} terms, rms {m.fit.rms:.3g}, left out {m.fit.press_rms:.3g}, AICc {m.fit.aicc:.1f}"
        for label, m in (("additive", additive), ("full", full))
    )
    probability = "not computable" if np.isnan(test.probability) else f"{test.probability:.3g}"
    return (
        f"Additive against full. {sides}. F = {test.ratio:.3g} on {test.between} and {test.within} degrees of freedom; "
        f"probability of such interaction terms by noise alone: {probability}."
    )


def _slices_in_words(model: FittedModel) -> tuple[str, ...]:
    """By how much the printed sum of slices is wrong, where the value at rest can be told from zero."""
    if Term() not in model.terms:
        return ()
    symbol = model.symbols[model.terms.index(Term())]
    value, half = model.named(symbol)
    if not (np.isfinite(half) and abs(value) > half):
        return ()
    first, second = model.domain.variables
    return (
        f"The printed form {model.response}({first}) + {model.response}({second}) counts {symbol} = {value:.4g} +- {half:.2g} twice and is wrong "
        f"by that much everywhere; this fit counts it once.",
    )


def _model(tables: Sequence[ForceTable], name: str, chosen: Options, area: Area, notes: tuple[str, ...]) -> FittedModel:
    first, second = chosen.variables
    rows = collect(tables, (first, second), name, area)
    fitted = {form: _fitted(rows, chosen, form, area) for form in FORMS}
    model = fitted[chosen.form]
    if model is None:
        raise TooFewRowsError(
            f"{len(rows.y)} usable rows of {name}", f"more rows than terms, and at least one term, for {chosen.form}", name, rows.labels,
            len(rows.y) + 1, column="surface.degree", advice="Run more points, ask for a lower degree or another parity.",
        )  # fmt: skip
    full = fitted["tensor"] or fitted["total"] if chosen.form == "additive" else model
    freer = f"Try a higher degree, such as degree = {chosen.degree + 1}"
    freer += ", or form = tensor" if chosen.form == "additive" else ""
    freer += "." if chosen.parity or not _sided(chosen) else f", or parity = {_sided(chosen)[0]}=full."
    words_ = (
        *notes,
        *residuals_in_words(model, freer),
        compared(fitted["additive"], full, rows),
        *(_slices_in_words(model) if chosen.form == "additive" else ()),
        *in_words(model.fit, model.symbols),
    )
    return replace(model, statements=words_)


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit a polynomial surface to every response.

    Only rows in which no third variable moves are used. Whatever form is asked for, the additive one is measured
    against the one with interaction, and the model says the outcome in words.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point.
    scaling : Scaling
        Length of the primes and of moment coefficients.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Without sweeps and without SNAME coefficients.

    Raises
    ------
    InputError
        No such rows, a response that the tables lack, more terms than rows of every response, or an area without its name.
    """
    chosen = parse_options(Options, only_moving.without_blanks(options, "parity"), "surface")
    if len(set(chosen.variables)) != 2 or len(chosen.variables) != 2:
        raise input_error(
            "fits.two_different_ones", column="surface.variables", what=", ".join(chosen.variables) or "none"
        )
    area = only_moving.area_of(chosen.area, chosen.area_name, scaling)
    used, notes = only_moving.only_moving(tables, chosen.variables, scaling.length)
    names = chosen.responses or tuple(n for n in USUAL if only_moving.allowed(used, n, area))
    if not names:
        raise InputError("no force that the tables give", f"one of {', '.join(USUAL)}", column="surface.responses")
    first = tables[0]
    settings = {
        "variables": " ".join(chosen.variables), "degree": str(chosen.degree), "form": chosen.form,
        "parity": " ".join(chosen.parity) or "port-starboard symmetry", "extrapolation": chosen.extrapolation,
        **only_moving.area_settings(area),
    }  # fmt: skip
    models, few = each_with_rows(
        tuple(dict.fromkeys(names)), lambda n: _model(only_moving.allowed(used, n, area) or used, n, chosen, area, notes), first.campaign
    )  # fmt: skip
    return result_of(
        "surface",
        first,
        scaling,
        (),
        np.zeros((0, 0)),
        citations=citations,
        settings=settings,
        models=models,
        findings=few,
    )
