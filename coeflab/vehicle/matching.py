"""What is one number in two files under other names: Yv' and Yuv', a single added mass and an entry of a matrix, a point and its datum.

Yv U v, Yuv u v and Yv|u| |u| v are one slope on a straight course ahead, and one prime: all three go with 1/2 rho L^2 U. So are X0 U^2, Xuu u^2
and Xu|u| u|u|, and Ydr U^2 and Yuudr u^2. Added masses are M_A = -Xudot ... about the same point.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.axes import ANYWHERE
from coeflab.core.finding import Finding, Severity
from coeflab.core.wording import listed
from coeflab.law.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative, primed
from coeflab.law.terms import parse_suffix
from coeflab.vehicle.inertia import centre_of_gravity
from coeflab.vehicle.parameter_file import ParameterFile

ORIGIN = "stated"
AXIS = "u"
ONE_MASS = 0.01  # of two vehicles that are taken as one: then so are their centres of gravity


def on_one_datum(a: ParameterFile, b: ParameterFile) -> tuple[ParameterFile, Finding | None]:
    """The second file with its reference point from the datum of the first, by the centre of gravity that both state, and what says so.

    As it is where the datums are one already or one is anywhere, or where a mass is not stated or another.
    """
    if a.reference_point.origin in (b.reference_point.origin, ANYWHERE) or b.reference_point.origin == ANYWHERE:
        return b, None
    if a.mass is None or b.mass is None:
        return b, None
    if abs(b.mass.mass / a.mass.mass - 1.0) > ONE_MASS:
        return b, None
    x, y, z = (float(v) for v in np.array(a.reference_point.point) + centre_of_gravity(a) - centre_of_gravity(b))
    found = Finding.of(
        "move.by_centres",
        b.name,
        Severity.NOTE,
        theirs=b.reference_point.datum,
        ours=a.reference_point.datum,
        x=x,
        y=y,
        z=z,
    )
    point = a.reference_point.model_copy(update={"point": (x, y, z)})
    return b.model_copy(update={"reference_point": point}), found


def plain_name(symbol: str) -> str:
    """The name without u of a term that is linear in one other variable ahead; any other symbol as it is.

    Examples
    --------
    >>> plain_name("Yuv"), plain_name("Nr|u|"), plain_name("Xu|u|"), plain_name("Yvv"), plain_name("Yvdot")
    ('Yv', 'Nr', 'X0', 'Yvv', 'Yvdot')
    """
    bare = symbol.removesuffix("'")
    d = derivative(bare)
    if any(f.endswith("dot") for f in d.factors) or len(d.factors) < 2:
        return bare
    factors = parse_suffix(d.text[1:]).factors
    ahead = sum(n for v, n, _ in factors if v == AXIS)
    others = [(v, n, a) for v, n, a in factors if v != AXIS]
    if not others:
        return "X0" if d.component == "X" and ahead == 2 else bare
    if len(others) != 1 or others[0][1:] != (1, False):
        return bare
    variable = others[0][0]
    due = 1 if variable in MOTIONS else 2 if variable in CONTROLS else 0
    return d.component + variable if ahead == due else bare


def by_plain_names(found: CoefficientSet) -> tuple[CoefficientSet, dict[str, str]]:
    """The set with every slope under its plain name, sums where several are one, and which name each had first.

    Damping about a state of rest, which does not go with the speed, keeps its name and is no part of a sum. A sum is worth what
    its weakest part is: no value, an estimate, no U95; its tables are those of all parts.
    """
    names = _plain_names(found)
    order = list(dict.fromkeys(names))
    if order == list(found.symbols):
        return found, {n: n for n in order}
    fold = np.array([[1.0 if n == wanted else 0.0 for n in names] for wanted in order])
    covariance = fold @ np.nan_to_num(found.covariance) @ fold.T
    undetermined = fold @ np.isnan(np.diag(found.covariance)) > 0.0
    covariance[undetermined, :] = covariance[:, undetermined] = np.nan
    out = []
    first: dict[str, str] = {}
    for i, wanted in enumerate(order):
        mine = [c for n, c in zip(names, found.coefficients, strict=True) if n == wanted]
        first[wanted] = mine[0].symbol
        if len(mine) == 1:
            out.append(replace(mine[0], symbol=wanted))
            continue
        values = [c.value for c in mine]
        value = None if any(v is None for v in values) else float(sum(v for v in values if v is not None))
        u95 = None if undetermined[i] or value is None else float(2.0 * np.sqrt(max(covariance[i, i], 0.0)))
        weakest = min(mine, key=lambda c: (c.value is not None, c.status is not Status.ESTIMATE, c.u95 is not None))
        table, campaign = (_together(c.table for c in mine), _together(c.campaign for c in mine))
        out.append(replace(weakest, symbol=wanted, value=value, u95=u95, parts=Parts(), table=table, campaign=campaign))
    return replace(found, coefficients=tuple(out), covariance=covariance), first


def sums_in_words(found: CoefficientSet, name: str, among: Container[str]) -> list[str]:
    """Which plain names of a file's set, before it is brought to these, are sums of several; one statement each."""
    own = [c.symbol for c in found.coefficients if c.law != "rest"]
    return [
        f"{plain} of {name} is the sum of its {listed(of)}"
        for plain, of in one_slope(own).items()
        if plain[:-1] in among
    ]


def one_slope(symbols: Iterable[str]) -> dict[str, list[str]]:
    """Slopes that stand under several names, by their plain name; all with prime.

    Examples
    --------
    >>> one_slope(["Yuv'", "Nr'", "Yv'", "Yvv'"])
    {"Yv'": ["Yuv'", "Yv'"]}
    """
    parts: dict[str, list[str]] = {}
    for symbol in dict.fromkeys(primed(s.removesuffix("'")) for s in symbols):
        parts.setdefault(primed(plain_name(symbol)), []).append(symbol)
    return {plain: of for plain, of in parts.items() if len(of) > 1}


def _plain_names(found: CoefficientSet) -> list[str]:
    """Of each coefficient, by which those that are one slope go together."""
    resting = {c.symbol for c in found.coefficients if c.law == "rest"}
    plain = [c.symbol if c.law == "rest" else plain_name(c.symbol) for c in found.coefficients]
    return [c.symbol if n in resting else n for n, c in zip(plain, found.coefficients, strict=True)]


def _together(names: Iterable[str | None]) -> str | None:
    """A comma list of those that are stated, each once; None of none."""
    return ", ".join(dict.fromkeys(n for n in names if n)) or None


def with_matrix(found: CoefficientSet, parameters: ParameterFile) -> tuple[CoefficientSet, frozenset[str]]:
    """The primed set with the entries of the file's added mass, zeros too, that it does not state one by one, and their names."""
    hull = parameters.added_mass
    if hull is None:
        return found, frozenset()
    more = []
    for i, c in enumerate(COMPONENTS):
        for j, m in enumerate(MOTIONS):
            symbol = f"{c}{m}dot"
            if symbol in found:
                continue
            unit = found.scaling.unit(symbol, hull.density)
            half = None if hull.u95 is None else float(hull.u95[i, j]) / unit
            more.append(
                Coefficient(
                    symbol, 0.0 - float(hull.matrix[i, j]) / unit, half, Status.STATED, parameters.body, origin=ORIGIN
                )
            )
    k, extra = len(found.coefficients), len(more)
    covariance = np.zeros((k + extra, k + extra))
    covariance[:k, :k] = found.covariance
    for i, one in enumerate(more, k):
        covariance[i, i] = np.nan if one.u95 is None else (one.u95 / 2.0) ** 2
        if one.u95 is None:
            covariance[i, :] = covariance[:, i] = np.nan
    void = np.isnan(np.diag(covariance))
    covariance[void, :] = covariance[:, void] = np.nan
    return replace(found, coefficients=(*found.coefficients, *more), covariance=covariance), frozenset(
        c.symbol for c in more
    )


def spelled_as(found: CoefficientSet, first: Mapping[str, str], wanted: Sequence[str]) -> CoefficientSet:
    """The set with the names that another file has for the same numbers; the others under the name that they had.

    Parameters
    ----------
    found : CoefficientSet
        Under plain names.
    first : mapping
        Plain names to those that they had.
    wanted : sequence of str
        Names of the other file.
    """
    theirs: dict[str, str] = {}
    for name in wanted:
        theirs.setdefault(plain_name(name), name)
    for name in wanted:
        if name == plain_name(name):
            theirs[name] = name
    renamed = tuple(
        replace(c, symbol=c.symbol if c.law == "rest" else theirs.get(c.symbol, first.get(c.symbol, c.symbol)))
        for c in found.coefficients
    )
    if len({c.symbol for c in renamed}) < len(renamed):
        return found
    return replace(found, coefficients=renamed)
