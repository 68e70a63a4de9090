"""What an export loses, as tables and as the text beside the files.

A model file as tables: what it holds, and what was found.

The parameter file field by field, as a page in Markdown; the JSON Schema is its only source.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.stored import FIRST_VERSION
from coeflab.core.table import ABSENT, Table, coefficient, number, with_u95
from coeflab.core.text.json import parse_json
from coeflab.core.texts import known, remark
from coeflab.formats.export import LOSSLESS, RARE, Kind
from coeflab.law.added_mass import potential_part
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative, primed
from coeflab.report.tables.own_numbers_page import OWN_NUMBERS
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.inertia import MEASURED, stated_accelerations
from coeflab.vehicle.parameter_file import SCHEMA_VERSION, VERSIONS, ParameterFile, is_later, schema
from coeflab.vehicle.second_order import ROUNDING, products_once

if TYPE_CHECKING:
    from coeflab.formats.export import Apart, Loss
    from coeflab.vehicle.inertia import WaterInertia
    from coeflab.vehicle.law_at_points import LawAtPoints

NAMED = 3
MOST_APART = 1000.0  # per cent of a force; a larger difference is not told from this one
IN_PERCENT = (
    "Largest and rms: difference of law and points, in % of the largest force of the component in that table; where: the point with the largest difference. Two errors of the set-up are subtracted from the points first: a force "
    "at zero angle and rate that the law does not contain, and the part of X that is odd in the drift."
)


def forces(loss: Loss) -> Table:
    """Difference of the target's force, and of the acceleration it gives the vehicle, from the file's."""
    rows = [_row(c, "N*m" if c in "KMN" else "N", loss.forces, i) for i, c in enumerate(COMPONENTS)]
    if loss.accelerations is not None:
        rows += [
            _row(f"d{m}/dt", "rad/s^2" if m in "pqr" else "m/s^2", loss.accelerations, i) for i, m in enumerate(MOTIONS)
        ]
    notes = [
        f"At {loss.grid}; in steady motion, FRD, about the file's reference point.",
        f"0: below {LOSSLESS:g} of the largest value.",
        *loss.controls,
    ]
    if (rare := in_rare_states(loss)) and loss.rare is not None:
        notes.append(rare)
    if loss.accelerations is not None:
        notes.append(
            "du/dt to dr/dt: accelerations of the file's rigid body in these states, and from rest under a force along each axis as "
            "large as the file's largest; those of the target use the added mass in its own files."
        )
    if loss.not_compared:
        notes.append(loss.not_compared)
    notes.append(loss.water.source)
    notes += [
        f"worse than no force at all: {c}, whose rms difference is {number(loss.rms[i], 3)} where the file's own rms is {number(loss.size[i], 3)}"
        for i, c in enumerate(COMPONENTS)
        if c in loss.worse_than_nothing
    ]
    notes += [f"not held: {what}" for what in loss.not_held]
    notes += [str(each) for each in loss.lost]
    notes += [f"changed: {what}" for what in loss.changes]
    headers = ("", "unit", "largest value", "max. difference", "rms difference", "max. in %")
    return Table(
        f"Force law of {loss.target} against the parameter file", headers, tuple(rows), tuple(notes), frozenset({0, 1})
    )


def in_rare_states(loss: Loss) -> str:
    """The differences astern, broadside and at rest, in words; empty where there is none."""
    if loss.rare is None or not loss.rare.furthest[1] > LOSSLESS:
        return ""
    each = zip(COMPONENTS, loss.rare.worst, loss.rare.relative, strict=True)
    said = [f"{c} {number(w, 3)} {'N*m' if c in 'KMN' else 'N'} ({percent(s)})" for c, w, s in each if s > LOSSLESS]
    return f"{RARE}, which the rows above do not hold, the largest differences are {', '.join(said)}"


def at_points(found: Sequence[LawAtPoints], whose: str, *, controls: bool = True) -> Table:
    """A law against the measured points, by component and table; no rows where the file has no points.

    Parameters
    ----------
    found : sequence of LawAtPoints
    whose : str
        Whose law it is, in words.
    controls : bool
        Whether rows with a control off zero are among the points.
    """
    rows = tuple(
        (f.component, f.table, str(f.n_points - len(f.beyond)),
         *(ABSENT if f.small or len(f.beyond) == f.n_points else percent(x) for x in (f.share, f.rms_share)), f.worst_at,
         ABSENT if f.small else percent(f.allowed / f.largest if f.largest else 0.0), at_points_verdict(f))
        for f in found
    )  # fmt: skip
    notes = [IN_PERCENT]
    if not controls:
        notes.append("Points with a deflected control are left out: no force of controls is compared.")
    notes += [
        f"{f.component}, {f.table}: points {', '.join(f.beyond)} lie outside the range of the law; the largest difference there is "
        f"{percent(f.worst_beyond / f.largest if f.largest else 0.0)}."
        for f in found
        if f.beyond
    ]
    headers = ("force", "table", "points", "largest", "rms", "where", "allowed", "verdict")
    return Table(f"{whose} against its points", headers, rows, tuple(notes), frozenset({0, 1, 5, 7}), ("where", "rms"))


def at_points_verdict(f: LawAtPoints) -> str:
    """One word or two on a component."""
    if f.small:
        return "too small to judge"
    if f.missed:
        return f"misses {len(f.missed)}"
    n = len(f.beyond)
    if n == f.n_points:
        return "not compared: no point in its range"
    return f"holds; {n} point{'s' * (n > 1)} outside its range" if n else "holds"


def _row(name: str, unit: str, found: Apart, i: int) -> tuple[str, ...]:
    """One component; no number where it is not compared."""
    share = found.relative[i]
    if not share <= LOSSLESS and not share > LOSSLESS:
        return name, unit, *[ABSENT] * 4
    seen = float(share > LOSSLESS)
    worst, rms = (number(x[i] * seen, 3) for x in (found.worst, found.rms))
    return name, unit, number(found.largest[i], 4), worst, rms, percent(share)


def percent(share: float) -> str:
    """A relative difference in per cent, 0 where it is rounding."""
    value = 100.0 * share if share > LOSSLESS else 0.0
    return f"> {MOST_APART:.0f} %" if value > MOST_APART else f"{value:.0f} %" if value >= 99.5 else f"{value:.2g} %"


def in_short(loss: Loss) -> str:
    """The loss on one line: what is not held, what else is lost, and the largest difference of a force and of an acceleration."""
    terms = [what.partition(" (")[0].partition(": ")[0] for what in loss.not_held]
    said = [f"no {_some(terms, NAMED)}"] if terms else []
    others: dict[str, list[str]] = {}
    for x in loss.lost:
        others.setdefault(x.kind, []).append(x.what.partition("; ")[0].partition(": ")[0])
    said += [f"{kind}: {_some(whats, 1)}" for kind, whats in others.items()]
    found: list[tuple[int, float, Sequence[str]]] = [(*loss.forces.furthest, COMPONENTS)]
    if loss.accelerations is not None:
        found.append((*loss.accelerations.furthest, tuple(f"d{m}/dt" for m in MOTIONS)))
    if loss.rare is not None and loss.rare.furthest[1] > LOSSLESS and loss.furthest[1] <= LOSSLESS:
        i, share = loss.rare.furthest
        said.append(f"{COMPONENTS[i]} differs {RARE} by up to {percent(share)} of its largest")
    for i, share, names in found:
        if share > LOSSLESS or not said:
            by = percent(share).replace(">", "more than") if 100.0 * share > MOST_APART else f"up to {percent(share)}"
            said.append(f"{names[i]} differs by {by} of its largest")
    return ", and ".join(said)


def counted(loss: Loss) -> str:
    """How much is lost, by kind."""
    kinds = Counter(x.kind for x in loss.lost)
    kinds[Kind.NOT_HELD] += len(loss.not_held)
    return ", ".join(f"{kinds[kind]} {kind}" for kind in Kind if kinds[kind])


def _some(words: Sequence[str], most: int) -> str:
    return ", ".join(words) if len(words) <= most + 1 else f"{', '.join(words[:most])} and {len(words) - most} more"


def parts(parameters: ParameterFile, water: WaterInertia | None = None) -> Table:
    """Total, potential and viscous part of every coefficient; no rows without added mass.

    Parameters
    ----------
    parameters : ParameterFile
    water : WaterInertia, optional
        The added mass that gives the potential parts; without it that of the file, as booked there.
    """
    hull = parameters.added_mass
    booked = [(c, c.value, c.potential) for c in parameters.coefficients]
    if water is not None and hull is not None:
        noun, primes, density = water.as_noun(parameters), parameters.scaling, parameters.conditions.density
        booked = [(c, v, None if p is None else potential_part(c.symbol, noun, primes, density)) for c, v, p in booked]
    rows = tuple(
        (c.symbol, coefficient(v), coefficient(p), coefficient(v - p), c.origin)
        for c, v, p in booked
        if v is not None and p is not None
    )
    notes = []
    if hull is not None:
        by = f"the added mass of {hull.body}, method {hull.method}"
        notes.append(f"potential part by {by if water is None else f'the added mass in use; {water.source}'}")
        if water is not None and water.used == MEASURED:
            notes.append(f"the parameter file books other potential parts, by {by} alone; the totals are the same")
        elif water is None and stated_accelerations(parameters):
            notes.append(
                "motions and exports take the acceleration derivatives of the file first, and subtract what these give"
            )
        if hull.body != parameters.body:
            notes.append(f"not of one body: the coefficients are those of {parameters.body}")
    headers = ("", "total", "potential", "viscous", "origin")
    return Table("Parts of the coefficients", headers, rows, tuple(notes), frozenset({0, 4}))


def as_text(loss: Loss, parameters: ParameterFile) -> str:
    """The loss report: plain text, the same bytes for the same file."""
    lines = [f"Loss report: {parameters.name} ({parameters.body}) for {loss.target}", ""]
    lines.append(
        "Lossless."
        if loss.lossless
        else f"This export is not lossless: {counted(loss) or 'force or acceleration differs'}."
    )
    lines += [f"Of the parameter file, {f.severity}: {remark(f)}" for f in parameters.findings]
    measured = at_points(loss.at_points, f"Force law of {loss.target}", controls=False)
    own = at_points(points_of(parameters), "Force law of the parameter file")
    if not own.rows:
        lines.append("The parameter file has no measured points to compare the two laws with.")
    for table in (forces(loss), measured, own, parts(parameters, loss.water)):
        if table.rows:
            lines += ["", table.title, *_aligned(table), *(f"  {n}" for n in table.notes)]
    return "\n".join(lines) + "\n"


def _aligned(table: Table) -> list[str]:
    rows = [table.headers, *table.rows]
    widths = [max(len(r[i]) for r in rows) for i in range(len(table.headers))]
    return [
        "  "
        + "  ".join(
            cell.ljust(w) if i in table.left else cell.rjust(w)
            for i, (cell, w) in enumerate(zip(r, widths, strict=True))
        ).rstrip()
        for r in rows
    ]


def contents(parameters: ParameterFile, kind: str) -> Table:
    """Every coefficient, primed and in SI; findings of the file are printed with the checks."""
    p = parameters
    noted = tuple(remark(f) for f in p.findings if not known(f))
    remarks = tuple(dict.fromkeys((*p.provenance.notes, *noted)))
    rows = tuple(
        (c.symbol, with_u95(c.value, c.u95)[0], number(c.value_si), c.unit_si, with_u95(c.value, c.u95)[1], c.status.replace("_", " "),
         c.origin, c.estimator or ABSENT)
        for c in p.coefficients
    )  # fmt: skip
    point = ", ".join(f"{x:g}" for x in p.reference_point.point)
    notes = (
        f"primed by {_length(p)}; SI at {p.conditions.speed:g} m/s and {p.conditions.density:g} kg/m^3; about ({point}) m from: {p.reference_point.datum}",
        f"schema {p.schema_version}, written by coeflab {p.provenance.coeflab_version}; valid"
        if kind == "coeflab"
        else f"read as {kind}",
        *(
            (
                f"schema {p.schema_version} is later than {SCHEMA_VERSION}, which this release writes; empty keys passed over",
            )
            if is_later(p.schema_version, SCHEMA_VERSION)
            else ()
        ),
        *remarks,
        *(
            ("values are totals: -C_A(nu) nu of the added mass is in them",)
            if p.added_mass is not None and kind != "coeflab"
            else ("accelerations and products by the added mass of the file are listed with --wide",)
            if p.added_mass is not None
            else ()
        ),
    )
    headers = ("", "value", "SI", "unit", "U95", "status", "origin", "how")
    return Table(f"{p.name} ({p.body})", headers, rows, notes, frozenset({0, 3, 5, 6, 7}), ("how", "origin"))


def left_out(names: Mapping[str, Sequence[str]], whose: str) -> Table:
    """What a model states and its parameter file does not hold."""
    rows = tuple((kind, ", ".join(held)) for kind, held in names.items())
    return Table(f"Left out of {whose}", ("kind", "names"), rows or (("nothing", ""),), (), frozenset({0, 1}))


def by_added_mass(parameters: ParameterFile) -> Table:
    """Acceleration derivatives and products of velocities that follow from the added mass and are no coefficients of the file.

    Without rows where the file has no added mass; without products where its fitted tables may speak of them.
    """
    p, hull = parameters, parameters.added_mass
    headers, title = ("", "value", "SI", "unit"), "By the added mass, besides these coefficients"
    if hull is None:
        return Table(title, headers, ())
    own = {_product(c.symbol) for c in p.coefficients}
    products = products_once(ideal_quadratics(hull.matrix))
    accelerations = [(f"{COMPONENTS[i]}{MOTIONS[j]}dot", -hull.matrix[i, j]) for i, j in np.ndindex(6, 6)]
    others = [
        (f"{c}{MOTIONS[j]}{MOTIONS[k]}", products[i, j, k])
        for i, c in enumerate(COMPONENTS) for j, k in np.ndindex(6, 6)
        if abs(products[i, j, k]) > ROUNDING * np.max(np.abs(products[i]))
    ]  # fmt: skip
    every = accelerations if p.models else [*accelerations, *others]
    left = [(s, v) for s, v in every if v and _product(s) not in own]
    rows = tuple(
        (primed(s), coefficient(float(v / p.scaling.unit(s, p.conditions.density))), number(float(v)), derivative(s).unit)
        for s, v in left
    )  # fmt: skip
    notes = (f"added mass of {hull.body}, {hull.method}" + "; products as in -C_A(nu) nu" * (every != accelerations),)
    return Table(title, headers, rows, notes, frozenset({0, 3}))


def _product(symbol: str) -> tuple[str, tuple[str, ...]]:
    """Component and factors in no order; the speed along x of a first-order derivative is one of them."""
    d = derivative(symbol)
    factors = ("u", *d.factors) if len(d.factors) == 1 and d.factors[0] in MOTIONS else d.factors
    return d.component, ("u", "u") if not factors else tuple(sorted(factors)) + ("|",) * ("|" in d.text)


def _length(p: ParameterFile) -> str:
    size = f"{p.scaling.length:.6g} m"
    return size if p.scaling.length_name == size else f"{p.scaling.length_name} {size}"


Json = dict[str, Any]
HEAD = f"""# The parameter file, version {SCHEMA_VERSION}

Generated by `coeflab params schema` from the models that read and write the file; `coeflab params schema --json` prints the
JSON Schema. A program that reads these files should refuse a first digit of `schema_version` other than 1.

- One JSON object in UTF-8. A key that is not named here is refused, and so are NaN and infinity; what is not known is null.
- SI units and radians. Axes x forward, y starboard, z down; forces are those of the water on the body.
- Primes: `Y' = Y / (1/2 rho U^2 L^2)`, `N' = N / (1/2 rho U^2 L^3)`, `v' = v/U`, `r' = r L/U`.
- Values are totals: a measured velocity derivative contains its potential part, an entry of `-C_A(nu) nu`. A simulator that
  adds `C_A(nu) nu` itself must be given `value - potential`.
- The force is a sum over coefficients, fitted tables, controls and the ideal fluid, each of the products of variables that it speaks
  of: [which source speaks of what](force_law.md).
- A fitted table in `models` holds whole forces, potential part and all, and a simulation leaves out the products of
  `-C_A(nu) nu` that it speaks of. Where only viscous parts are tabulated, `contains_potential` is false.
- U95 is a 95 % half-width, twice the standard uncertainty of the covariances.
- A file of an earlier version loads in every later release, and is written back as what it is.
- A later minor version adds keys and changes the meaning of none; its writers set what says nothing to null or leave it empty.
  So a file of a later version is read where every key that is not named here is null or empty: those are passed over.
  Otherwise it is refused, because a key that is not understood may change what the rest means, as `law` did in 1.2.
{OWN_NUMBERS}
## Versions

| Version | What came with it |
| --- | --- |
"""
COLUMNS = "| Key | Type | Unit | Since | If absent | Meaning |\n| --- | --- | --- | --- | --- | --- |\n"


def schema_page() -> bytes:
    """The page, the same bytes for the same schema."""
    content = parse_json(schema().decode())
    out = [HEAD, *(f"| {version} | {_cell(what)} |\n" for version, what in VERSIONS.items())]
    for place, name, table, since in _tables(content):
        out += [f"\n## {place}\n\n", f"{_plain(table.get('description', name))}\n\n", COLUMNS]
        required = table.get("required", ())
        for key, field in table["properties"].items():
            absent = "refused" if key in required else f"`{json.dumps(field['default'])}`"
            came = _later(field.get("since", since), since)
            cells: tuple[str, ...] = (
                f"`{key}`",
                _type(field),
                field.get("unit", ""),
                came,
                absent,
                _plain(field["description"]),
            )
            out.append(f"| {' | '.join(map(_cell, cells))} |\n")
    return "".join(out).encode()


def _tables(content: Json) -> Iterator[tuple[str, str, Json, str]]:
    """Every table of the schema: where it stands, its name, itself, and the version that brought it; the file first."""
    waiting = [("The file", ParameterFile.__name__, content, FIRST_VERSION)]
    seen = set()
    while waiting:
        place, name, table, since = waiting.pop(0)
        yield place, name, table, since
        inner = []
        for key, field in table["properties"].items():
            for kind, many in _named(field):
                if kind not in seen:
                    seen.add(kind)
                    path = (
                        f"{'' if name == ParameterFile.__name__ else place.strip('`') + '.'}{key}{'[]' if many else ''}"
                    )
                    inner.append((f"`{path}`", kind, content["$defs"][kind], _later(field.get("since", since), since)))
        waiting = inner + waiting


def _later(one: str, other: str) -> str:
    return one if is_later(one, other) else other


def _named(field: Json, many: bool = False) -> Iterator[tuple[str, bool]]:
    """Tables that a field holds, and whether it holds a list of them."""
    if "$ref" in field:
        yield field["$ref"].rpartition("/")[2], many
    for choice in field.get("anyOf", ()):
        yield from _named(choice, many)
    if isinstance(field.get("items"), dict):
        yield from _named(field["items"], True)


def _type(field: Json) -> str:
    if "$ref" in field:
        return "object"
    if "anyOf" in field:
        return " or ".join(_type(choice) for choice in field["anyOf"])
    if "const" in field or "enum" in field:
        return ", ".join(f"`{value}`" for value in field.get("enum", [field.get("const")]))
    if field["type"] == "array":
        if "prefixItems" in field:
            first = _type(field["prefixItems"][0])
            return f"{len(field['prefixItems'])} {'numbers' if first == 'number' else f'x {first}'}"
        each = _type(field["items"])
        return f"list of ({each})" if " or " in each else f"list of {each}"
    bounds = {"exclusiveMinimum": ">", "minimum": ">=", "maximum": "<="}
    limits = [f"{sign} {field[name]:g}" for name, sign in bounds.items() if name in field]
    limits += [f"of at most {field['maxLength']} characters"] if "maxLength" in field else []
    limits += [f"like `{field['pattern']}`"] if "pattern" in field else []
    kind = str(field["type"])
    words = {"string": "text", "boolean": "true or false", "integer": "whole number"}
    return " ".join([words.get(kind, kind), *limits])


def _plain(text: str) -> str:
    """One line, however the docstring is broken."""
    return " ".join(text.split()).rstrip(".")


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
