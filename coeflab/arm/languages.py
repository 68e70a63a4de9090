"""Closed forms as files: C, Python, Octave and MATLAB, LaTeX. Equal input gives equal bytes; no clock is read."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp  # type: ignore[import-untyped]

from coeflab.arm.chain import NODES
from coeflab.arm.latex import STRIP, document
from coeflab.arm.tape import ClosedForm, Function, Line
from coeflab.core.types import brief
from coeflab.core.version import VERSION
from coeflab.core.wording import identifier, matlab, one_line, python

WIDTH = 100
C_WORDS = (
    "auto break case char const continue default do double else enum extern float for goto if inline int long register restrict "
    "return short signed sizeof static struct switch typedef union unsigned void volatile while main"
)
ARGUMENTS = {
    "q": "joint positions, rad or m",
    "s": "generalised speeds: u v w of the vehicle's centre of mass, m/s; p q r, rad/s; joint rates, rad/s or m/s",
    "down": "unit vector down: -sin(theta), cos(theta) sin(phi), cos(theta) cos(phi)",
    "current": "velocity of the water, m/s, seen from the earth",
    "acceleration": "acceleration of the water, m/s^2, seen from the earth",
}
FRAMES = (
    "M ds/dt + h = weight + buoyancy + fluid_acceleration + drag + drives, generalised forces that go with s: X Y Z, N, at the vehicle's "
    "centre of mass; K M N, N m, about it; then one for each joint, N m or N.",
    "Vectors stand along the vehicle's axes: x forward, y starboard, z down. SI units, radians.",
)
STAY = (
    "Every parameter stands alone: where the density rho is changed, added masses and volumes stay as given. For another water change "
    "them too, or derive again with its density in the body.toml."
)


@brief
@dataclass(frozen=True, slots=True)
class Origin:
    """What the equations were derived from.

    Attributes
    ----------
    file, sha256 : str
        Name and sum of the body.toml.
    statements : tuple of str
        What it assumes.
    """

    file: str
    sha256: str
    statements: tuple[str, ...] = ()


def in_code(expression: Any) -> str:
    """An expression of scalars as C, Python and Octave all read it; numbers as short as they can be read back."""
    if expression.is_Symbol:
        return str(STRIP.sub(r"strip\1[\2]", expression.name))
    if expression.is_Integer:
        return str(int(expression))
    if expression.is_Float:
        return repr(float(expression))
    if expression.is_Add:
        terms = [in_code(e) for e in expression.args]
        return terms[0] + "".join(f" - {x[1:]}" if x.startswith("-") else f" + {x}" for x in terms[1:])
    if expression.is_Mul:
        factors = list(expression.args)
        sign = "-" if factors[0] == -1 else ""
        return sign + "*".join(_factor(e) for e in factors[len(sign) :])
    if expression.is_Pow and expression.exp == 2:
        return f"{_factor(expression.base)}*{_factor(expression.base)}"
    name = "sqrt" if expression.is_Pow and expression.exp == sp.S.Half else expression.func.__name__
    return f"{name}({in_code(expression.args[0])})"


def _factor(e: Any) -> str:
    return f"({in_code(e)})" if e.is_Add else in_code(e)


def _nodes() -> tuple[list[str], list[str]]:
    """Places and weights of a strip's rule on 0 to 1."""
    place, weight = np.polynomial.legendre.leggauss(NODES)
    return [repr(float(x)) for x in (1.0 + place) / 2.0], [repr(float(x)) for x in weight / 2.0]


def _folded(text: str, before: str, behind: str = "") -> list[str]:
    """A statement on lines of at most `WIDTH` letters, broken between terms."""
    lines = textwrap.wrap(text, WIDTH - len(before) - len(behind) - 4, break_long_words=False, break_on_hyphens=False)
    return [
        before + ("    " if i else "") + line.replace("\0", " ") + (behind if i < len(lines) - 1 else "")
        for i, line in enumerate(lines)
    ]


def _head(form: ClosedForm, origin: Origin) -> list[str]:
    """What stands above every file."""
    joints = ", ".join(f"{name} ({'rad' if kind == 'revolute' else 'm'})" for name, kind in form.links)
    words = [
        f"Equations of motion of {form.name}, a vehicle with an arm of {len(form.links)} link{'s' * (len(form.links) > 1)}, by Kane's method.",
        f"Written by coeflab {VERSION} with sympy {sp.__version__} from {origin.file}, sha256 {origin.sha256}.",
        *FRAMES,
        *(f"{name} ({form.length(name)}): {what}." for name, what in ARGUMENTS.items()),
        f"Joints: {joints}.",
        "Strips drag across their own axis, by Gauss's rule of 12 points along each.",
        *([STAY] if form.parameters else []),
        *origin.statements,
    ]
    return [one_line(line) for line in words]


def _comment(lines: Sequence[str], mark: str) -> list[str]:
    """Comment lines that hang below their first."""
    out = []
    for line in lines:
        out += textwrap.wrap(
            line, WIDTH - 4, initial_indent=mark, subsequent_indent=f"{mark}    ", break_long_words=False,
            break_on_hyphens=False,
        )  # fmt: skip
    return out


def _used(function: Function) -> set[str]:
    """Symbols that lines and outputs hold."""
    found = {s for line in function.lines for e in line.of for s in e.free_symbols}
    found |= {s for m, _ in function.outputs.values() for s in m.free_symbols}
    return {s.name for s in found}


def _entries(matrix: Any) -> list[tuple[int, int, Any]]:
    return [(i, j, matrix[i, j]) for i in range(matrix.rows) for j in range(matrix.cols)]


def _parameters_of(form: ClosedForm, used: set[str]) -> list[str]:
    return [p.symbol.name for p in form.parameters if p.symbol.name in used]


def c_files(form: ClosedForm, origin: Origin, stem: str) -> dict[str, str]:
    """Header and source, C99 without anything but math.h."""
    name = identifier(stem, frozenset(C_WORDS.split()))
    comments = [line.replace("*/", "* /").replace("/*", "/ *") for line in _comment(_head(form, origin), "  ")]
    guard, n, size = f"{name.upper()}_H", len(form.links), form.size
    first = f"const\0{name}_parameters\0*of, " if form.parameters else ""
    header = ["/*", *comments, "*/", f"#ifndef {guard}", f"#define {guard}", "", "#ifdef __cplusplus", 'extern "C" {']
    header += ["#endif", "", f"#define {name.upper()}_JOINTS {n}", f"#define {name.upper()}_SPEEDS {size}", ""]
    source = ["/*", *comments, "*/", f'#include "{name}.h"', "", "#include <math.h>", "#include <string.h>", ""]
    if form.parameters:
        header += [
            "/* Numbers of the file, as NAME_of_file holds them: the first argument of every function. */".replace(
                "NAME", name
            ),
            "typedef struct {",
        ]
        words = [one_line(p.meaning).replace("*/", "* /") for p in form.parameters]
        header += [f"    double {p.symbol.name}; /* {s}, {p.unit} */" for p, s in zip(form.parameters, words)]
        header += [f"}} {name}_parameters;", f"extern const {name}_parameters {name}_of_file;", ""]
        source += [f"const {name}_parameters {name}_of_file = {{"]
        source += [f"    {p.value!r}, /* {p.symbol.name} */" for p in form.parameters] + ["};", ""]
    if any(len(line.names) > 1 for f in form.functions for line in f.lines):
        source += _c_strip()
    for function in form.functions:
        taken = ", ".join(f"const\0double\0{a}[{form.length(a)}]" for a in function.arguments)
        shapes = {key: (m.rows, m.cols) for key, (m, _) in function.outputs.items()}
        given = ", ".join(f"double\0{k}[{r}]" + (f"[{c}]" if c > 1 else "") for k, (r, c) in shapes.items())
        signature = f"void {name}_{function.name}({first}{taken}, {given})"
        units = "; ".join(f"{key} in {unit}" for key, (_, unit) in function.outputs.items())
        header += [*_folded(f"/* {function.meaning} {units}. */", ""), *_folded(f"{signature};", ""), ""]
        source += [*_folded(signature, ""), "{"]
        used = _used(function)
        source += [f"    const double {p} = of->{p};" for p in _parameters_of(form, used)]
        if form.parameters and not _parameters_of(form, used):
            source.append("    (void)of;")
        for argument in function.arguments:
            own = [(f"{argument}{k}", k - 1) for k in range(1, form.length(argument) + 1)]
            source += [f"    const double {symbol} = {argument}[{k}];" for symbol, k in own if symbol in used]
            if not any(symbol in used for symbol, _ in own):
                source.append(f"    (void){argument};")
        source += _body(function, "    ", "/* {} */", _c_line)
        for key, (matrix, _) in function.outputs.items():
            source.append(f"    memset({key}, 0, {matrix.rows * matrix.cols} * sizeof(double));")
            for i, j, e in _entries(matrix):
                at = f"{key}[{i}]" + (f"[{j}]" if matrix.cols > 1 else "")
                if matrix.cols > 1 and j < i:
                    source += [f"    {at} = {key}[{j}][{i}];"] if e != 0 else []
                elif e != 0:
                    source += _folded(f"{at} = {in_code(e)};", "    ")
        source += ["}", ""]
    header += ["#ifdef __cplusplus", "}", "#endif", "", "#endif", ""]
    return {f"{name}.h": "\n".join(header), f"{name}.c": "\n".join(source)}


def _c_strip() -> list[str]:
    place, weight = _nodes()
    return [
        "/* Integrals of |u| u and of t |u| u over t from 0 to 1, u = (ax, ay, az) + t (bx, by, bz). */",
        "static void strip(double ax, double ay, double az, double bx, double by, double bz, double out[6])",
        "{",
        f"    static const double place[{NODES}] = {{",
        *_folded(", ".join(place), "        "),
        "    };",
        f"    static const double weight[{NODES}] = {{",
        *_folded(", ".join(weight), "        "),
        "    };",
        "    int k;",
        "    memset(out, 0, 6 * sizeof(double));",
        f"    for (k = 0; k < {NODES}; k++) {{",
        "        const double t = place[k], x = ax + t*bx, y = ay + t*by, z = az + t*bz;",
        "        const double f = weight[k]*sqrt(x*x + y*y + z*z), g = f*t;",
        "        out[0] += f*x;",
        "        out[1] += f*y;",
        "        out[2] += f*z;",
        "        out[3] += g*x;",
        "        out[4] += g*y;",
        "        out[5] += g*z;",
        "    }",
        "}",
        "",
    ]


def _strip_name(line: Line) -> str:
    return str(line.names[0].name.partition("_")[0])


def _c_line(line: Line) -> list[str]:
    if len(line.names) == 1:
        return _folded(f"const double {line.names[0].name} = {in_code(line.of[0])};", "    ")
    name = _strip_name(line)
    return [f"    double {name}[6];", *_folded(f"strip({', '.join(map(in_code, line.of))}, {name});", "    ")]


def _body(function: Function, before: str, comment: str, written: Callable[[Line], list[str]]) -> list[str]:
    """Lines, each stage below its name."""
    out, stage = [], ""
    for line in function.lines:
        if line.stage != stage:
            stage = line.stage
            out.append(before + comment.format(stage))
        out += written(line)
    return out


def python_files(form: ClosedForm, origin: Origin, stem: str) -> dict[str, str]:
    """A module of functions of numpy arrays."""
    out = [*_comment(_head(form, origin), "# "), *_comment(
        ["Arguments are arrays of these lengths, or of columns: (length, many) gives results whose last axis is many."], "# "
    ), '"""Equations of motion of a vehicle with an arm, by Kane\'s method."""', "", "import math", "", "import numpy as np", ""]  # fmt: skip
    if form.parameters:
        out += [
            "# Numbers of the file; every function takes such a dictionary as its last argument, of.",
            "PARAMETERS = {",
        ]
        out += [f'    "{p.symbol.name}": {p.value!r},  # {one_line(p.meaning)}, {p.unit}' for p in form.parameters]
        out += ["}", ""]
    if any(len(line.names) > 1 for f in form.functions for line in f.lines):
        place, weight = _nodes()
        out += ["PLACE = np.array([", *_folded(", ".join(place), "    "), "])"]
        out += ["WEIGHT = np.array([", *_folded(", ".join(weight), "    "), "])", "", ""]
        out += PYTHON_STRIP.splitlines()
    for function in form.functions:
        used = _used(function)
        more = ", of=PARAMETERS" if form.parameters else ""
        out += ["", "", f"def {function.name}({', '.join(function.arguments)}{more}):"]
        units = "; ".join(f"{key} in {unit}" for key, (_, unit) in function.outputs.items())
        out += [*_folded(f'"""{function.meaning} {units}."""', "    ")]
        out += ["    cos, sin, sqrt = (math.cos, math.sin, np.sqrt) if np.ndim(q) == 1 else (np.cos, np.sin, np.sqrt)"]
        shapes = ", ".join(f"np.shape({a})[1:]" for a in function.arguments)
        out += [f"    many = np.broadcast_shapes({shapes})"]
        out += [f'    {p} = of["{p}"]' for p in _parameters_of(form, used)]
        for a in function.arguments:
            names = ", ".join(f"{a}{k}" for k in range(1, form.length(a) + 1))
            out += _folded(f"{names}{',' * (form.length(a) == 1)} = np.asarray({a}, dtype=float).tolist() if np.ndim({a}) == 1 "
                           f"else np.asarray({a}, dtype=float)", "    ", " \\")  # fmt: skip
        out += _body(function, "    ", "# {}", _python_line)
        for key, (matrix, _) in function.outputs.items():
            square = matrix.cols > 1
            shape = f"({matrix.rows}, {matrix.cols}, *many)" if square else f"({matrix.rows}, *many)"
            out.append(f"    {key} = np.zeros({shape})")
            for i, j, e in _entries(matrix):
                at = f"{key}[{i}, {j}]" if square else f"{key}[{i}]"
                if square and j < i:
                    out += [f"    {at} = {key}[{j}, {i}]"] if e != 0 else []
                elif e != 0:
                    out += _folded(f"{at} = {in_code(e)}", "    ", " \\")
        out.append(f"    return {', '.join(function.outputs)}")
    return {f"{identifier(stem, python())}.py": "\n".join([*out, ""])}


PYTHON_STRIP = '''def strip(ax, ay, az, bx, by, bz):
    """Integrals of |u| u and of t |u| u over t from 0 to 1, u = (ax, ay, az) + t (bx, by, bz)."""
    x, y, z = (np.expand_dims(np.asarray(a, float), -1) + np.expand_dims(np.asarray(b, float), -1) * PLACE
               for a, b in ((ax, bx), (ay, by), (az, bz)))
    f = WEIGHT * np.sqrt(x * x + y * y + z * z)
    g = f * PLACE
    return [np.sum(k * u, axis=-1) for k in (f, g) for u in (x, y, z)]
'''


def _python_line(line: Line) -> list[str]:
    if len(line.names) == 1:
        return _folded(f"{line.names[0].name} = {in_code(line.of[0])}", "    ", " \\")
    return _folded(f"{_strip_name(line)} = strip({', '.join(map(in_code, line.of))})", "    ", " \\")


def octave_files(form: ClosedForm, origin: Origin, stem: str) -> dict[str, str]:
    """One function a file, as MATLAB and Octave look them up."""
    name = identifier(stem, matlab(), 40)
    head = _comment(_head(form, origin), "% ")
    files = {}
    if form.parameters:
        own = [
            f"function of = {name}_parameters()",
            *_comment(["Numbers of the file: the first argument of every function."], "% "),
            *head,
        ]
        own += [f"    of.{p.symbol.name} = {p.value!r}; % {one_line(p.meaning)}, {p.unit}" for p in form.parameters]
        files[f"{name}_parameters.m"] = "\n".join([*own, "end", ""])
    for function in form.functions:
        used = _used(function)
        given = ", ".join(function.outputs)
        taken = ", ".join((*(("of",) if form.parameters else ()), *function.arguments))
        units = "; ".join(f"{key} in {unit}" for key, (_, unit) in function.outputs.items())
        out = [f"function [{given}] = {name}_{function.name}({taken})"]
        out += [*_comment([f"{function.meaning} {units}."], "% "), *head]
        out += [f"    {p} = of.{p};" for p in _parameters_of(form, used)]
        for a in function.arguments:
            symbols = [(f"{a}{k}", k) for k in range(1, form.length(a) + 1)]
            out += [f"    {symbol} = {a}({k});" for symbol, k in symbols if symbol in used]
        out += _body(function, "    ", "% {}", _octave_line)
        for key, (matrix, _) in function.outputs.items():
            out.append(f"    {key} = zeros({matrix.rows}, {matrix.cols});")
            for i, j, e in _entries(matrix):
                at = f"{key}({i + 1}, {j + 1})" if matrix.cols > 1 else f"{key}({i + 1})"
                if matrix.cols > 1 and j < i:
                    out += [f"    {at} = {key}({j + 1}, {i + 1});"] if e != 0 else []
                elif e != 0:
                    out += _folded(f"{at} = {in_code(e)};", "    ", " ...")
        out.append("end")
        if any(len(line.names) > 1 for line in function.lines):
            place, weight = _nodes()
            out += ["", "function out = strip(a, b)"]
            out += ["    % Integrals of |u| u and of t |u| u over t from 0 to 1, u = a + t b."]
            out += _folded(f"t = [{', '.join(place)}];", "    ", " ...")
            out += _folded(f"k = [{', '.join(weight)}];", "    ", " ...")
            out += ["    u = a(:)*ones(size(t)) + b(:)*t;", "    f = k.*sqrt(sum(u.*u, 1));"]
            out += ["    out = [u*f.'; u*(f.*t).'];", "end"]
        text = re.sub(r"(strip\d+)\[(\d)\]", lambda m: f"{m[1]}({int(m[2]) + 1})", "\n".join([*out, ""]))
        files[f"{name}_{function.name}.m"] = text
    return files


def _octave_line(line: Line) -> list[str]:
    if len(line.names) == 1:
        return _folded(f"{line.names[0].name} = {in_code(line.of[0])};", "    ", " ...")
    a, b = (", ".join(map(in_code, part)) for part in (line.of[:3], line.of[3:]))
    return _folded(f"{_strip_name(line)} = strip([{a}], [{b}]);", "    ", " ...")


def latex_files(form: ClosedForm, origin: Origin, stem: str) -> dict[str, str]:
    """One document."""
    head = _head(form, origin)
    return {f"{identifier(stem)}.tex": "\n".join([*_comment(head, "% "), document(form, head)])}


LANGUAGES: Mapping[str, Callable[[ClosedForm, Origin, str], dict[str, str]]] = {
    "c": c_files,
    "python": python_files,
    "latex": latex_files,
    "octave": octave_files,
}


def written(
    form: ClosedForm, language: str, origin: Origin, say: Callable[[str], None] = lambda _: None
) -> dict[str, bytes]:
    """The files of a language, by name.

    Parameters
    ----------
    form : ClosedForm
    language : {"c", "python", "latex", "octave"}
    origin : Origin
    say : callable
        Is handed what is written next.
    """
    say(f"writing {language}")
    return {name: text.encode() for name, text in LANGUAGES[language](form, origin, form.name).items()}
