"""Stability of straight motion with controls fixed: indices with U95, roots against speed, critical speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import CoeflabError
from coeflab.core.table import ABSENT, Table, number
from coeflab.core.wording import collected, grouped, in_sentences, listed
from coeflab.law.symbols import primed
from coeflab.motion.root_locus import DRAWN, RootLocus, root_locus
from coeflab.report.document import Figure, Section
from coeflab.report.figures.root_locus import IN_PLANE, root_locus_figure
from coeflab.report.tables.added_mass import mass_table
from coeflab.report.texts import table_of, text_of, texts_of
from coeflab.study.study import Study
from coeflab.vehicle.criteria import REVERSAL, TURNING, criteria
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.published_values import Relation
from coeflab.vehicle.stability import FAST, INDICES, SEED, Derived, Verdict, by_mass, sense, stability, verdict

RUDDER = float(np.radians(15.0))  # at which the diameter of the linear turn is stated

NOT_KNOWN = "no value: no added mass"
NO_ADDED_MASS = (
    "Without added mass roots, times and critical speed would be those in air. Under [[parameter_file]] of the plan, added_mass names a body with a "
    "shape to compute it from, literature a column of published.toml with the acceleration derivatives named."
)
DRAWN_TEXT = f"95 % limits: {DRAWN} draws of the four derivatives with their covariance, seed {SEED}; added mass and mass have no error in them."


def in_words(study: Study) -> list[str]:
    """Which parameter files are unstable, and which are not, plane by plane; none where no index can be given."""
    named: dict[str, dict[tuple[Verdict, str], dict[str, list[str]]]] = {index: {} for index in IN_PLANE}
    for parameters in study.parameter_files.values():
        for d in stability(parameters):
            named[d.name].setdefault((verdict(d), sense(d)), {}).setdefault(parameters.name, []).append(_value(d))
    lacking = {p.name: p.conditions.speed for p in study.parameter_files.values() if p.hydrostatics is None}
    out: list[str] = []
    for index, senses in named.items():
        each = [
            named
            for v in sorted(senses, key=lambda v: (v[0] is not Verdict.UNSTABLE, v[1]))
            for named in _of_one_sense(index, *v, senses[v], lacking)
        ]
        if each:
            start = (
                f"In {IN_PLANE[index]}, it is"
                if out
                else f"With controls fixed, straight motion in {IN_PLANE[index]} is"
            )
            out.append(f"{start} {'. It is '.join(each)}.")
    return [" ".join((*out, *_one_body(study), *_by_others(study)))] if out else []


PLACES = 170  # letters of the parameter files that one sentence names beside its verdict
SOURCES = {"experiment": "test", "cfd": "CFD"}


def _one_body(study: Study) -> list[str]:
    """Which parameter files with an index are of one body, and what each comes from."""
    by: dict[str, dict[str, str]] = {}
    for p in study.parameter_files.values():
        if stability(p):
            of = {name for c in p.coefficients for name in (c.campaign or "").split(", ")}
            kinds = dict.fromkeys(SOURCES.get(t.source.kind, t.source.kind) for t in study.tables if t.campaign in of)
            by.setdefault(p.body, {})[p.name] = " and ".join(kinds)
    return [
        f"The parameter files {listed([f'{name} ({kind})' for name, kind in files.items()])} describe one body, the {body.replace('_', ' ')}."
        for body, files in by.items()
        if len(files) > 1
    ]


def _of_one_sense(
    index: str, says: Verdict, words: str, places: Mapping[str, Sequence[str]], lacking: Mapping[str, float]
) -> list[str]:
    """The parameter files that one verdict holds for, so many at a time; at high speed also what is open at their own."""
    each = [f"{name} ({', '.join(values)})" for name, values in places.items()]
    open_at = ""
    if says.decided and index == "G_v":
        speeds = listed([number(u, 3) for u in dict.fromkeys(lacking[n] for n in places if n in lacking)] or [""])
        open_at = f". {index} gives no verdict at {speeds} m/s, because BG is unknown" if speeds else ""
    undecided = {Verdict.SIGN_OPEN: f"undecided (sign of {index} open)", Verdict.NONE: "without a verdict"}
    words = undecided.get(says, words.replace(FAST, f"{FAST} (restoring moment left out)"))
    groups = [f"{words}: {', '.join(group)}" for group in grouped(each, PLACES, ", ".join)]
    return [*groups[:-1], groups[-1] + open_at]


def _by_others(study: Study) -> list[str]:
    """Which derivatives of the indices are from literature, file by file; none where an index has no other."""
    each = []
    for p in study.parameter_files.values():
        stated = [from_literature(p, d.name) for d in stability(p)]
        symbols = dict.fromkeys(s for few in stated if len(few) < len(INDICES["G_h"]) - 1 for s in few)
        each += [f"{listed([primed(s) for s in symbols])} of {p.name}"] if symbols else []
    start = "Where the data give no value, the indices use published ones: "
    return [in_sentences(start, each)] if each else []


def no_index(lacking: Sequence[str]) -> str:
    """What a stability index lacks that has no value, in words."""
    mass = ["mass"] * ("mass" in lacking)
    symbols = [s for s in lacking if s != "mass"]
    named = symbols if len(lacking) < 3 else [f"{len(symbols)} derivatives"]
    return f"no value: {listed([*named, *mass])} missing"


def from_literature(parameters: ParameterFile, index: str) -> list[str]:
    """Derivatives of a stability index that no campaign of the study gave."""
    found = [parameters.coefficient(str(s)) for s in INDICES[index][:-1]]
    return [c.symbol for c in found if c is not None and c.origin == "literature"]


def _value(d: Derived) -> str:
    if d.result is None:
        return f"{d.name} = {d.value:.3g}"
    extended = d.limits and d.represented
    skewed = f"; Monte Carlo {number(d.result.low, 3)} to {number(d.result.high, 3)}" if extended else ""
    return f"{d.name} = {d.in_words}{skewed}"


def stability_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no parameter file has any derivative that an index needs."""
    rows: list[tuple[str, ...]] = []
    roots: list[tuple[str, ...]] = []
    figures: list[Figure] = []
    refused: list[str] = []
    for i, (name, parameters) in enumerate(study.parameter_files.items()):
        found = _indices(parameters)
        rows += [*found, *_other_criteria(parameters)]
        for index in (row[1] for row in found if row[2] != ABSENT):
            try:
                locus = root_locus(parameters, index)
            except CoeflabError as why:
                refused.append(f"{name}, {IN_PLANE[index]}: no roots, as the file has {why}")
                continue
            roots.append(_roots(name, locus))
            if not locus.lacking:
                figures.append(root_locus_figure(locus, name, f"roots-{i}-{index[-1]}"))
    if not rows:
        return ()
    tables = [_shown(rows, study)]
    if roots:
        heads = (
            "parameter file",
            "plane",
            "roots 1/s",
            "time to double or halve s",
            "critical speed m/s",
            "95 % limits m/s",
        )
        speeds = collected(
            (f"{number(study.parameter_files[name].conditions.speed, 3)} m/s", name)
            for name in dict.fromkeys(row[0] for row in roots)
        )
        at = (
            f"Roots at {next(iter(speeds))}, the speed of the parameter file"
            if len(speeds) == 1
            else "Roots at the speed of the parameter file"
        )
        each = "; ".join(f"{u}: {listed(names)}" for u, names in speeds.items())
        notes = [f"speed of the parameter file: {each}."] if len(speeds) > 1 else []
        notes += [NO_ADDED_MASS] * any(NOT_KNOWN in row[4] for row in roots)
        notes += [DRAWN_TEXT] * any(row[5] != ABSENT for row in roots)
        tables.append(Table(at, heads, tuple(roots), tuple(notes), frozenset({0, 1, 2, 4, 5})))
    inputs_table_ = _inputs_table(study, {(row[0], row[1]) for row in rows if row[2] != ABSENT})
    used = (*((inputs_table_,) if inputs_table_.rows else ()), *mass_table(study))
    mass = Section("mass-used", "What the indices are computed from", tables=used, appendix=True)
    given = {row[1] for row in rows}
    also = [
        text
        for name, text in ((TURNING, text_of("stability.turning")), (REVERSAL, text_of("stability.reversal")))
        if name in given
    ]
    return (
        Section(
            "stability",
            "Stability",
            (texts_of("stability.section")[0], *also, *texts_of("stability.section")[1:], *refused),
            tuple(tables),
            tuple(figures),
            (mass,),
        ),
    )


def _indices(parameters: ParameterFile) -> list[tuple[str, ...]]:
    """A row for every plane of which the file has at least one derivative."""
    given = {d.name: d for d in stability(parameters)}
    out: list[tuple[str, ...]] = []
    for index, (*symbols, _) in INDICES.items():
        found = [parameters.coefficient(str(s)) for s in symbols]
        lacking = [str(s) for s, c in zip(symbols, found, strict=True) if c is None or c.value is None]
        if len(lacking) == len(symbols):
            continue
        if index not in given:
            lacking += ["m'"] if parameters.mass is None else []
            remark = f"missing: {', '.join(lacking)}"
            out.append((parameters.name, index, ABSENT, ABSENT, "no value", remark))
            continue
        d = given[index]
        half = d.half_width
        stated = from_literature(parameters, index)
        remarks = [f"{', '.join(stated)} published"] if stated else []
        remarks += [d.statement] if d.result is None else []
        remarks += [d.limits] if d.limits else []
        remarks.append(f"1 % of m' changes {index} by {number(by_mass(parameters, d), 2)}")
        out.append((parameters.name, index, number(d.value), number(half, 2), sense(d), "; ".join(remarks)))
    return out


def _other_criteria(parameters: ParameterFile) -> list[tuple[str, ...]]:
    """Turning ability and the critical speed of the stern planes, a row each."""
    index = next((d for d in stability(parameters) if d.name == "G_h"), None)
    out: list[tuple[str, ...]] = []
    for d in criteria(parameters):
        remarks = [d.statement] if d.result is None else [d.limits] if d.limits else []
        if d.name == TURNING:
            holds = index is not None and verdict(index) is Verdict.STABLE
            says: str = f"D/L = {number(2.0 / (abs(d.value) * RUDDER), 3)}" if holds else Verdict.NONE
            open_one = index is None or not index.decided
            without = (
                "a steady linear turn only if stable, which is open"
                if open_one
                else "no steady linear turn: not stable"
            )
            remarks.insert(0, "steady turn at 15 deg of rudder, linear" if holds else without)
        else:
            slower = parameters.conditions.speed < d.value
            says = "planes reversed" if slower else "planes as ordered"
            remarks.insert(0, f"at {number(parameters.conditions.speed, 3)} m/s")
        out.append((parameters.name, d.name, number(d.value), number(d.half_width, 2), says, "; ".join(remarks)))
    return out


def _shown(rows: list[tuple[str, ...]], study: Study) -> Table:
    """The indices, and beside them those that the source of the same data prints."""
    headers = ("parameter file", "criterion", "value", "U95", "verdict", "remark")
    printed = [_printed(study, name, index) for name, index, *_ in rows]
    if not any(value for value, _ in printed):
        return Table("Standard criteria", headers, tuple(rows), (), frozenset({0, 1, 4, 5}))
    notes = tuple(dict.fromkeys(f"published: {source}" for _, source in printed if source))
    extended = [(*row[:4], value or ABSENT, *row[4:]) for row, (value, _) in zip(rows, printed, strict=True)]
    words = (
        "published: the index that the source prints. We do not judge ours by it, as ours uses our own Yv', Nv', Zw' or Mw'.",
        *notes,
    )
    return Table(
        "Standard criteria", (*headers[:4], "published", *headers[4:]), tuple(extended), words, frozenset({0, 1, 5, 6})
    )


def _inputs_table(study: Study, given: set[tuple[str, str]]) -> Table:
    """The numbers that the indices are computed from, a row an index, five digits, with their sources."""
    rows = []
    for p in study.parameter_files.values():
        for index, (*symbols, _) in INDICES.items():
            found = [c for s in symbols if (c := p.coefficient(str(s))) is not None and c.value is not None]
            if p.mass is None or (p.name, index) not in given:
                continue
            by: dict[str, list[str]] = {}
            for c in found:
                origin = "published" if c.origin == "literature" else c.origin
                by.setdefault(c.campaign if c.origin == "fit" and c.campaign else origin, []).append(c.symbol)
            sources = [f"{', '.join(those)}: {source}" for source, those in by.items()] if len(by) > 1 else list(by)
            derivatives = (f"{c.symbol} = {number(float(c.value or 0.0), 5)}" for c in found)
            centre = p.mass.mass_moment_prime / p.mass.mass_prime
            values = (*derivatives, f"m' = {number(p.mass.mass_prime, 5)}", f"xG' = {number(centre, 5)}")
            rows.append((p.name, index, ", ".join(values), "; ".join(sources)))
    return table_of("stability.made_of", rows)


def _printed(study: Study, name: str, index: str) -> tuple[str, str]:
    """An index as the authors of the data of a parameter file print it, and where; empty where none does."""
    parameters = next(p for p in study.parameter_files.values() if p.name == name)
    campaigns = {c.campaign for c in parameters.coefficients}
    for r in study.references:
        if r.relation is Relation.RE_ANALYSIS and r.body == parameters.body and campaigns & set(r.campaigns):
            for value in r.indices:
                if value.symbol == index:
                    return value.printed, f"{index} of {name}: {r.name} ({r.place})"
    return "", ""


def _roots(name: str, locus: RootLocus) -> tuple[str, ...]:
    plane = IN_PLANE[locus.index].removeprefix("the ")
    if locus.lacking:
        return name, plane, ABSENT, ABSENT, f"{NOT_KNOWN} ({', '.join(locus.lacking)})", ABSENT
    real = float(locus.at_speed[0].real)
    time = f"{'doubles' if real > 0.0 else 'halves'} in {number(np.log(2.0) / abs(real), 3)}" if real else ABSENT
    limits = ABSENT
    if locus.critical is not None:
        critical, limits = number(locus.critical), _limits(locus)
    else:
        critical = "none" if locus.is_restored or locus.index == "G_h" else "no value: no BG"
    left = "" if locus.is_restored or locus.index == "G_h" else ", BG left out"
    return name, plane + left, _pairs(locus.at_speed), time, critical, limits


def _limits(locus: RootLocus) -> str:
    """95 % limits of the critical speed, or why it has none."""
    if not locus.drawn.size:
        return "none: a derivative has no U95"
    if locus.limits is None:
        return f"none: {np.mean(np.isnan(locus.drawn)):.0%} of the draws have no critical speed up to {number(locus.speed[-1], 3)} m/s"
    return " .. ".join(number(x, 3) for x in locus.limits)


def _pairs(values: NDArray[np.complex128]) -> str:
    """Eigenvalues, conjugate ones together."""
    out = []
    for v in values:
        if v.imag > 0.0:
            out.append(f"{number(v.real, 3)} ± {number(v.imag, 3)} i")
        elif v.imag == 0.0:
            out.append(number(v.real, 3))
    return "; ".join(out)
