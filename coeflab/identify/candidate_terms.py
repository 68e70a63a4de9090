"""Which terms an identification may choose from, by their SNAME symbols."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.identify.candidates import ALONG, allowed, candidates, same
from coeflab.identify.force_balance import Candidate
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.law.terms import Term, parse_suffix
from coeflab.vehicle.parameter_file import ParameterFile


def candidate_terms(
    parameters: ParameterFile,
    moving: frozenset[str],
    asked: Sequence[str],
    *,
    symmetric: bool,
    accelerations: bool,
    driven: frozenset[str],
) -> list[Candidate]:
    """Candidates of every component whose motion is there.

    Parameters
    ----------
    parameters : ParameterFile
        Its spelling and its scaling are taken.
    moving : frozenset of str
        Motions and controls that the series have.
    asked : sequence of str
        Symbols; ``file`` alone for those of the file; none for terms of the first and second order.
    symmetric : bool
        Leave out what a body symmetric port to starboard cannot have.
    accelerations : bool
        Acceleration derivatives are candidates too, where a force is known that tells them from the rest.
    driven : frozenset of str
        Components along which a force is known: of thrusters, weight or buoyancy.

    Raises
    ------
    InputError
        A symbol that is none, of a component whose motion the series do not have, or an acceleration along which no force
        is known: M nu_dot alone fixes no scale.
    """
    components = [c for c in COMPONENTS if ALONG[c] in moving]
    ordered = [m for m in (*MOTIONS, *CONTROLS) if m in moving]
    if asked and tuple(asked) != ("file",):
        named = [_named(s, parameters) for s in asked]
        strange = [t for t in named if t.component not in components]
        if strange:
            raise input_error(
                "identify.terms_series_have", column="identify.terms", found=strange[0].symbol,
                components=", ".join(components),
            )  # fmt: skip
        loose = [t for t in named if t.rate and t.component not in driven]
        if loose:
            raise input_error(
                "identify.without_known_force", column="identify.terms", symbol=loose[0].symbol, component=loose[0].component,
            )  # fmt: skip
        return named
    if asked:
        symbols = [c.symbol for c in parameters.coefficients if c.value is not None]
        listed = [t for t in (_named(s, parameters) for s in symbols) if t.component in components]
        return [t for t in listed if not t.rate or (accelerations and t.component in driven)]
    out: list[Candidate] = []
    for c in components:
        result = candidates(c, ordered, symmetric)
        out += [_named(_written(c, t, parameters), parameters) for t in result]
        if accelerations and c in driven:
            free = [m for m in MOTIONS if m in moving]
            dots = [m for m in free if not symmetric or allowed(c, Term(((m, 1, False),)))]
            out += [_named(f"{c}{m}dot", parameters) for m in dots]
    return out


def _written(component: str, term: Term, parameters: ParameterFile) -> str:
    """The symbol of a term as the file spells it, where it has it."""
    for c in parameters.coefficients:
        if c.symbol[0] == component and not any(f.endswith("dot") for f in derivative(c.symbol).factors):
            text = derivative(c.symbol).text
            if same(parse_suffix(text[1:]), term):
                return text
    return component + term.suffix


def _named(symbol: str, parameters: ParameterFile) -> Candidate:
    """A candidate by its SNAME symbol."""
    d = derivative(symbol)
    entry = parameters.coefficient(d.text)
    at, primes = parameters.conditions, parameters.scaling
    per_prime = primes.unit(d.text, at.density)
    dots = [f for f in d.factors if f.endswith("dot")]
    if dots:
        if len(d.factors) > 1 or "|" in d.text:
            raise InputError(shown(symbol), "an acceleration by itself, such as Yvdot", column="identify.terms")
        return Candidate(d.text, d.component, Term(), per_prime, rate=dots[0].removesuffix("dot"))
    rest = entry is not None and entry.law == "rest"
    if rest:
        per_prime = primes.unit(d.text, at.density, at.speed)
    return Candidate(d.text, d.component, parse_suffix(d.text[1:]), per_prime, rest)
