"""The C source of a vehicle: its numbers as arrays, the kernel below them; and the law read back from such a source."""

from __future__ import annotations

import re
from collections.abc import Sequence
from importlib.resources import files as resources
from typing import Any

import numpy as np

from coeflab.core.text.bounded import own_bytes
from coeflab.core.types import Array
from coeflab.core.wording import one_line
from coeflab.formats.coded_thrusters import coded_thrusters
from coeflab.formats.flat_law import RULES, FlatLaw, Readings, place_at, table_of
from coeflab.law.domain import Domain
from coeflab.law.force_law import AHEAD, BASE, ForceLaw, ForceTerm, place_of
from coeflab.law.symbols import CONTROLS
from coeflab.law.terms import Factor, Term
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCurve

UNLIMITED = 1e300
_PLAIN = re.compile(r"[^A-Za-z0-9 .,:;()_+=|<>%'^&!-]")
_ARRAY = re.compile(r"(?:static )?const (double|int) (\w+)\[\d+\] = \{([^}]*)\};")
_COUNT = re.compile(r"#define (\w+) (\d+)\b")


def remark(text: str) -> str:
    """A text as a comment of C can hold it: no end of comment, no trigraph, no line that goes on."""
    return _PLAIN.sub("_", one_line(text))


LEAST = 12  # numbers of an array, so that a compiler sees no reading beyond the end of one that is never read


def _array(name: str, values: Sequence[Any], kind: str = "double", head: str = "static const") -> str:
    held = [*values, *[0] * (LEAST - len(values))]
    words = [repr(float(x) + 0.0) if kind == "double" else str(int(x)) for x in held]
    lines, line = [], ""
    for w in words:
        if len(line) + len(w) > 110:
            lines.append(line.rstrip())
            line = ""
        line += f"{w}, "
    inner = "\n    ".join([*lines, line.removesuffix(", ")])
    return f"{head} {kind} {name}[{len(held)}] = {{{inner}}};"


def _padded(rows: Array, d: int) -> list[float]:
    """Rows of d variables and a constant, the constant in the place of the last."""
    out = np.zeros((len(rows), d + 1))
    if len(rows):
        out[:, : rows.shape[1] - 1], out[:, d] = rows[:, :-1], rows[:, -1]
    return [float(x) for x in out.ravel()]


def source(parameters: ParameterFile, law: FlatLaw, name: str) -> str:
    """The C file, without its header."""
    terms = [*law.coefficients, *(t for table in law.tables for t in table.terms)]
    d = max((len(t.hull.variables) for t in law.tables), default=1)
    factors, begins = list[int](), [0]
    for t in law.coefficients:
        factors += [x for v, n, a in t.product.factors for x in (BASE.index(v), n, int(a))]
        begins.append(len(factors) // 3)
    for table in law.tables:
        for t in table.terms:
            factors += [x for v, n, a in table.factors(t) for x in (v, n, int(a))]
            begins.append(len(factors) // 3)
    count = len(law.coefficients)
    term_begin = [count + int(x) for x in np.cumsum([0, *(len(t.terms) for t in law.tables)])]
    spaces = [0, *np.cumsum([len(t.faces) for t in law.tables]).tolist()]
    maps = [0, *np.cumsum([len(t.maps) for t in law.tables]).tolist()]
    each = {s.control: s for s in parameters.surfaces}
    limits = [each[c].limit if c in each else UNLIMITED for c in CONTROLS]
    turns = [(each[c].rate or 0.0) if c in each else 0.0 for c in CONTROLS]

    def wide(values: Sequence[float]) -> list[float]:
        return [*map(float, values), *[0.0] * (d - len(values))]

    def over(rows: Sequence[Sequence[float]]) -> list[float]:
        return [x for row in rows for x in wide(row)]

    map_rows = [
        x for t in law.tables for m in t.maps for x in _padded(np.vstack([m, np.zeros((d - len(m), m.shape[1]))]), d)
    ]
    angled = any(t.component in "DSL" for t in terms) or any({10, 11} & set(t.base) for t in law.tables)
    segments, thrusters, curves, tilts, width = _thrusters(parameters)
    lines = [
        f"/* {remark(parameters.name)}, body: {remark(parameters.body)} */",
        f'#include "{name}.h"',
        "#include <math.h>",
        "",
        f"#define COEFFICIENTS {count}",
        f"#define TABLES {len(law.tables)}",
        f"#define PRODUCTS {len(law.ideal)}",
        f"#define THRUSTERS {len(parameters.thrusters)}",
        f"#define ANGLED {int(angled)}",
        f"#define WINDS {len(law.law.wind)}",
        f"#define D {d}",
        f"#define W {d + 1}",
        f"#define S {width}",
        "",
        "/* Terms: SI value, component of X Y Z K M N, then D S L of each row of SPEAKS, power of U, course; factors: variable, power,",
        "   absolute */",
        *(f"/* {n}: {remark(t.symbol)} {remark(t.note)} */" for n, t in enumerate(terms)),
        _array("VALUES", [t.coefficient for t in terms]),
        _array("PLACE", [place_of(t, law.law.wind) for t in terms], "int"),
        _array("SPEED", [t.speed_power for t in terms], "int"),
        _array("COURSE", [t.ahead for t in terms], "int"),
        _array("FACTOR_BEGIN", begins, "int"),
        _array("FACTORS", factors, "int"),
        _array("SPEAKS", [x for into in law.law.wind for x in into], "int"),
        "/* Products of two velocities of the ideal fluid: force, velocity, velocity; SI value */",
        _array("PRODUCT", [x for i, j, k, _ in law.ideal for x in (i, j, k)], "int"),
        _array("IDEAL", [x for *_, x in law.ideal]),
        "/* Tables and their hulls; rule 0 clamp, 1 taper, 2 refuse */",
        *(f"/* {k}: {remark(t.name)} */" for k, t in enumerate(law.tables)),
        _array("DIMENSION", [len(t.base) for t in law.tables], "int"),
        _array("RULE", [RULES.index(t.hull.rule) for t in law.tables], "int"),
        _array("BOXED", [t.boxed for t in law.tables], "int"),
        _array("RESTS", [t.rests for t in law.tables], "int"),
        _array("VARIABLE", [x for t in law.tables for x in (*t.base, *[0] * (d - len(t.base)))], "int"),
        _array("PRIME", over([t.prime for t in law.tables])),
        _array("LOW", over([t.hull.low.tolist() for t in law.tables])),
        _array("HIGH", over([t.hull.high.tolist() for t in law.tables])),
        _array("SIZE", over([t.size.tolist() for t in law.tables])),
        _array("TERM_BEGIN", term_begin, "int"),
        _array("SPACE_BEGIN", spaces, "int"),
        _array("SPACE_END", spaces[1:], "int"),
        _array("SPACES", [x for t in law.tables for x in _padded(t.hull.spaces, d)]),
        _array("FACES", [x for t in law.tables for x in _padded(t.faces, d)]),
        _array("MAP_BEGIN", maps, "int"),
        _array("MAP_END", maps[1:], "int"),
        _array("MAPS", map_rows),
        "/* Rigid body, kg m; accelerations of unit forces; weight less buoyancy, N, and W r_G - B r_B, N m */",
        _array("RIGID", law.rigid.ravel().tolist()),
        _array("INVERSE", law.inverse.ravel().tolist()),
        f"#define EXCESS ({law.excess!r})",
        _array("LEVER", law.lever.tolist()),
        "/* dr ds db: largest angle, rad; rate, rad/s, 0: at once */",
        _array("LIMIT", limits),
        _array("TURNS", turns),
        "/* Thrusters: position, direction, axis, lowest and highest tilt, handedness; segments of thrust and of torque */",
        *(f"/* {k}: {remark(t.name)} by {remark(t.curve.command)}, {remark(t.curve.unit)} */" for k, t in enumerate(parameters.thrusters)),
        _array("THRUSTER", thrusters),
        _array("TILTS", tilts, "int"),
        "/* Lag, s, 0: at once */",
        _array("LAG", [t.lag or 0.0 for t in parameters.thrusters]),
        _array("CURVES", curves, "int"),
        _array("SEGMENTS", segments),
        "",
    ]  # fmt: skip
    kernel = own_bytes(resources("coeflab.formats.c_program") / "kernel.c").decode()
    return "\n".join(lines) + "\n" + kernel.replace("@NAME@", name).replace("@UPPER@", name.upper())


def _thrusters(parameters: ParameterFile) -> tuple[list[float], list[float], list[int], list[bool], int]:
    """Segments, thrusters, curves, whether each tilts, and the width of a segment."""
    every = [c for t in parameters.thrusters for c in (t.curve, t.torque_curve) if c is not None]
    width = 2 + max((len(s.coefficients) for c in every for s in c.segments), default=1)
    segments, curves = list[float](), list[int]()

    def add(c: ParameterCurve | None) -> None:
        first = len(segments) // width
        for s in c.segments if c is not None else ():
            segments.extend([s.low, s.high, *s.coefficients, *[0.0] * (width - 2 - len(s.coefficients))])
        curves.extend([first, len(segments) // width])

    for t in parameters.thrusters:
        add(t.curve)
        add(t.torque_curve)
    rows = [x for row in coded_thrusters(parameters)[0] for x in row]
    return segments, rows, curves, [t.tilt_axis is not None for t in parameters.thrusters], width


def numbers(text: str) -> dict[str, Any]:
    """Arrays and counts of a source."""
    out: dict[str, Any] = {n: int(x) for n, x in _COUNT.findall(text)}
    for kind, name, values in _ARRAY.findall(text):
        of = float if kind == "double" else int
        out[name] = [of(x) for x in values.split(",")]
    return out


def law_of(text: str) -> ForceLaw:
    """The law that a source computes, from its arrays."""
    a = numbers(text)
    d, w = a["D"], a["W"]
    terms: list[ForceTerm] = []
    tables = [_table(a, k, d, w) for k in range(a["TABLES"])]
    for n in range(a["TERM_BEGIN"][a["TABLES"]]):
        rows = range(a["FACTOR_BEGIN"][n], a["FACTOR_BEGIN"][n + 1])
        k = next((k for k in range(a["TABLES"]) if a["TERM_BEGIN"][k] <= n < a["TERM_BEGIN"][k + 1]), None)
        hull, readings = (None, ()) if k is None else tables[k]
        names = BASE if hull is None else hull.variables
        factors = tuple(
            Factor(names[a["FACTORS"][3 * f]], a["FACTORS"][3 * f + 1], bool(a["FACTORS"][3 * f + 2])) for f in rows
        )
        if a["COURSE"][n]:
            factors, readings = (Factor("u", 1),), (("u", AHEAD),)
        component, into = place_at(a["PLACE"][n], np.reshape(a["SPEAKS"][: 3 * a["WINDS"]], (-1, 3)).tolist())
        whole = Term(factors), a["VALUES"][n], a["SPEED"][n], 1.0
        terms.append(ForceTerm(str(n), component, *whole, readings=readings, hull=hull, into=into))
    ideal = np.zeros((6, 6, 6))
    for n in range(a["PRODUCTS"]):
        i, j, k = a["PRODUCT"][3 * n : 3 * n + 3]
        ideal[i, j, k] = ideal[i, k, j] = a["IDEAL"][n] * (1.0 if j == k else 0.5)
    return ForceLaw(tuple(terms), ideal)


def _table(a: dict[str, Any], k: int, d: int, w: int) -> tuple[Domain, Readings]:
    size = a["DIMENSION"][k]
    at = slice(d * k, d * k + size)
    names = tuple(BASE[v] for v in a["VARIABLE"][at])
    rows = np.array(a["SPACES"][: w * a["SPACE_BEGIN"][a["TABLES"]]]).reshape(-1, w)
    rows = rows[a["SPACE_BEGIN"][k] : a["SPACE_END"][k]]
    spaces = np.column_stack([rows[:, :size], rows[:, d]])
    return table_of(str(k), names, (a["LOW"][at], a["HIGH"][at]), spaces, a["RULE"][k], a["PRIME"][at], a["BOXED"][k])
