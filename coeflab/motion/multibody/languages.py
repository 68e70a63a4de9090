"""Closed forms as files: C, Python, Octave and MATLAB, LaTeX. Equal input gives equal bytes; no clock is read."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp  # type: ignore[import-untyped]
from sympy.printing.c import C99CodePrinter  # type: ignore[import-untyped]
from sympy.printing.latex import LatexPrinter  # type: ignore[import-untyped]
from sympy.printing.octave import OctaveCodePrinter  # type: ignore[import-untyped]
from sympy.printing.pycode import PythonCodePrinter  # type: ignore[import-untyped]

from coeflab.core.types import brief
from coeflab.core.version import VERSION
from coeflab.core.wording import identifier, matlab, one_line, python
from coeflab.motion.multibody.chain import NODES
from coeflab.motion.multibody.tape import ClosedForm, Function, Line

WIDTH = 100
STRIP = re.compile(r"strip(\d+)_(\d)")
C_WORDS = frozenset(
    "auto break case char const continue default do double else enum extern float for goto if inline int long register restrict "
    "return short signed sizeof static struct switch typedef union unsigned void volatile while main".split()
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


class _Floats:
    """Numbers as short as they can be read back, squares as products."""

    def _print_Float(self, expr: Any) -> str:
        return repr(float(expr))

    def _print_Pow(self, expr: Any, **more: Any) -> str:
        if expr.exp == 2 and expr.base.is_Atom:
            base = self._print(expr.base)  # type: ignore[attr-defined]
            return f"({base}*{base})"
        return str(super()._print_Pow(expr, **more))  # type: ignore[misc]


class _C(_Floats, C99CodePrinter):  # type: ignore[misc]
    def _print_Symbol(self, expr: Any) -> str:
        return STRIP.sub(r"strip\1[\2]", expr.name)


class _Python(_Floats, PythonCodePrinter):  # type: ignore[misc]
    def _print_Symbol(self, expr: Any) -> str:
        return STRIP.sub(r"strip\1[\2]", expr.name)


class _Octave(_Floats, OctaveCodePrinter):  # type: ignore[misc]
    def _print_Symbol(self, expr: Any) -> str:
        return STRIP.sub(lambda m: f"strip{m[1]}({int(m[2]) + 1})", expr.name)


class _Latex(LatexPrinter):  # type: ignore[misc]
    """Symbols as papers write them."""

    def _print_Float(self, expr: Any) -> str:
        mantissa, _, power = repr(float(expr)).partition("e")
        return mantissa if not power else rf"{mantissa} \cdot 10^{{{int(power)}}}"

    def _print_Symbol(self, expr: Any, **_: Any) -> str:
        return in_letters(expr.name)


AXES = ("x", "y", "z")
SPEEDS = ("u", "v", "w", "p", "q", "r")
NAMED = {"cos": r"\mathrm{c}", "sin": r"\mathrm{s}", "angle": r"\theta", "x": "x", "q": "q"}
VECTORS = {"down": r"\hat{e}", "current": "v^f", "acceleration": "a^f"}


def in_letters(name: str) -> str:
    """A symbol in LaTeX: c_1 and s_1 for cosine and sine of a joint, u to r and dq/dt for generalised speeds."""
    if found := STRIP.fullmatch(name):
        return f"d{chr(39) if int(found[2]) > 2 else ''}_{{{found[1]}{AXES[int(found[2]) % 3]}}}"
    word, digits = re.fullmatch(r"(.*?)(\d*)", name).groups()  # type: ignore[union-attr]
    if word == "s" and digits:
        k = int(digits)
        return SPEEDS[k - 1] if k <= 6 else rf"\dot{{q}}_{{{k - 6}}}"
    if word in VECTORS:
        return f"{VECTORS[word]}_{{{AXES[int(digits) - 1]}}}"
    if word in NAMED and digits:
        return f"{NAMED[word]}_{{{digits}}}"
    head, _, behind = name.partition("_")
    greek = {"alpha": r"\alpha", "theta": r"\theta", "rho": r"\rho"}
    return greek.get(head, head) + (f"_{{{behind.replace('_', ',')}}}" if behind else "")


def _printers() -> dict[str, Any]:
    plain = {"order": "none"}
    names = {"fully_qualified_modules": False}
    return {
        "c": _C(plain), "python": _Python({**plain, **names}), "octave": _Octave({**plain, "inline": True}),
        "latex": _Latex({**plain, "mul_symbol": r" \,"}),
    }  # fmt: skip


def _nodes() -> tuple[list[str], list[str]]:
    """Places and weights of a strip's rule on 0 to 1."""
    place, weight = np.polynomial.legendre.leggauss(NODES)
    return [repr(float(x)) for x in (1.0 + place) / 2.0], [repr(float(x)) for x in weight / 2.0]


def _folded(text: str, before: str, behind: str = "") -> list[str]:
    """A statement on lines of at most `WIDTH` letters, broken between terms."""
    lines = textwrap.wrap(text, WIDTH - len(before) - len(behind) - 4, break_long_words=False, break_on_hyphens=False)
    return [
        before + ("    " if i else "") + line.replace("\0", " ") + (behind if i < len(lines) - 1 else "") for i, line in enumerate(lines)
    ]


def _head(form: ClosedForm, origin: Origin) -> list[str]:
    """What stands above every file."""
    joints = ", ".join(f"{name} ({'rad' if kind == 'revolute' else 'm'})" for name, kind in form.links)
    said = [
        f"Equations of motion of {form.name}, a vehicle with an arm of {len(form.links)} links, by Kane's method.",
        f"Written by coeflab {VERSION} with sympy {sp.__version__} from {origin.file}, sha256 {origin.sha256}.",
        *FRAMES,
        *(f"{name} ({form.length(name)}): {what}." for name, what in ARGUMENTS.items()),
        f"Joints: {joints}.",
        "Strips drag across their own axis, by Gauss's rule of 12 points along each.",
        *origin.statements,
    ]
    return [one_line(line) for line in said]


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
    name = identifier(stem, C_WORDS)
    printed = _printers()["c"]._print
    comments = [line.replace("*/", "* /").replace("/*", "/ *") for line in _comment(_head(form, origin), "  ")]
    guard, n, size = f"{name.upper()}_H", len(form.links), form.size
    first = f"const\0{name}_parameters\0*of, " if form.parameters else ""
    header = ["/*", *comments, "*/", f"#ifndef {guard}", f"#define {guard}", "", "#ifdef __cplusplus", 'extern "C" {']
    header += ["#endif", "", f"#define {name.upper()}_JOINTS {n}", f"#define {name.upper()}_SPEEDS {size}", ""]
    source = ["/*", *comments, "*/", f'#include "{name}.h"', "", "#include <math.h>", "#include <string.h>", ""]
    if form.parameters:
        header += ["/* Numbers of the file; NAME_of_file holds them. */".replace("NAME", name), "typedef struct {"]
        said = [one_line(p.said).replace("*/", "* /") for p in form.parameters]
        header += [f"    double {p.symbol.name}; /* {s}, {p.unit} */" for p, s in zip(form.parameters, said)]
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
        header += [*_folded(f"/* {function.said} {units}. */", ""), *_folded(f"{signature};", ""), ""]
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
        source += _body(function, "    ", "/* {} */", lambda line: _c_line(line, printed))
        for key, (matrix, _) in function.outputs.items():
            source.append(f"    memset({key}, 0, {matrix.rows * matrix.cols} * sizeof(double));")
            for i, j, e in _entries(matrix):
                at = f"{key}[{i}]" + (f"[{j}]" if matrix.cols > 1 else "")
                if matrix.cols > 1 and j < i:
                    source += [f"    {at} = {key}[{j}][{i}];"] if e != 0 else []
                elif e != 0:
                    source += _folded(f"{at} = {printed(e)};", "    ")
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


def _c_line(line: Line, printed: Callable[[Any], str]) -> list[str]:
    if len(line.names) == 1:
        return _folded(f"const double {line.names[0].name} = {printed(line.of[0])};", "    ")
    name = _strip_name(line)
    return [f"    double {name}[6];", *_folded(f"strip({', '.join(map(printed, line.of))}, {name});", "    ")]


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
    printed = _printers()["python"]._print
    out = [*_comment(_head(form, origin), "# "), *_comment(
        ["Arguments are arrays of these lengths, or of columns: (length, many) gives results whose last axis is many."], "# "
    ), '"""Equations of motion of a vehicle with an arm, by Kane\'s method."""', "", "import math", "", "import numpy as np", ""]  # fmt: skip
    if form.parameters:
        out += ["# Numbers of the file; every function takes such a dictionary in their place.", "PARAMETERS = {"]
        out += [f'    "{p.symbol.name}": {p.value!r},  # {one_line(p.said)}, {p.unit}' for p in form.parameters]
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
        out += [*_folded(f'"""{function.said} {units}."""', "    ")]
        out += ["    cos, sin, sqrt = (math.cos, math.sin, np.sqrt) if np.ndim(q) == 1 else (np.cos, np.sin, np.sqrt)"]
        shapes = ", ".join(f"np.shape({a})[1:]" for a in function.arguments)
        out += [f"    many = np.broadcast_shapes({shapes})"]
        out += [f'    {p} = of["{p}"]' for p in _parameters_of(form, used)]
        for a in function.arguments:
            names = ", ".join(f"{a}{k}" for k in range(1, form.length(a) + 1))
            out += _folded(f"{names}{',' * (form.length(a) == 1)} = np.asarray({a}, dtype=float).tolist() if np.ndim({a}) == 1 "
                           f"else np.asarray({a}, dtype=float)", "    ", " \\")  # fmt: skip
        out += _body(function, "    ", "# {}", lambda line: _python_line(line, printed))
        for key, (matrix, _) in function.outputs.items():
            square = matrix.cols > 1
            shape = f"({matrix.rows}, {matrix.cols}, *many)" if square else f"({matrix.rows}, *many)"
            out.append(f"    {key} = np.zeros({shape})")
            for i, j, e in _entries(matrix):
                at = f"{key}[{i}, {j}]" if square else f"{key}[{i}]"
                if square and j < i:
                    out += [f"    {at} = {key}[{j}, {i}]"] if e != 0 else []
                elif e != 0:
                    out += _folded(f"{at} = {printed(e)}", "    ", " \\")
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


def _python_line(line: Line, printed: Callable[[Any], str]) -> list[str]:
    if len(line.names) == 1:
        return _folded(f"{line.names[0].name} = {printed(line.of[0])}", "    ", " \\")
    return _folded(f"{_strip_name(line)} = strip({', '.join(map(printed, line.of))})", "    ", " \\")


def octave_files(form: ClosedForm, origin: Origin, stem: str) -> dict[str, str]:
    """One function a file, as MATLAB and Octave look them up."""
    name = identifier(stem, matlab(), 40)
    printed = _printers()["octave"]._print
    head = _comment(_head(form, origin), "% ")
    files = {}
    if form.parameters:
        own = [f"function of = {name}_parameters()", *_comment(["Numbers of the file."], "% "), *head]
        own += [f"    of.{p.symbol.name} = {p.value!r}; % {one_line(p.said)}, {p.unit}" for p in form.parameters]
        files[f"{name}_parameters.m"] = "\n".join([*own, "end", ""])
    for function in form.functions:
        used = _used(function)
        given = ", ".join(function.outputs)
        taken = ", ".join((*(("of",) if form.parameters else ()), *function.arguments))
        units = "; ".join(f"{key} in {unit}" for key, (_, unit) in function.outputs.items())
        out = [f"function [{given}] = {name}_{function.name}({taken})"]
        out += [*_comment([f"{function.said} {units}."], "% "), *head]
        out += [f"    {p} = of.{p};" for p in _parameters_of(form, used)]
        for a in function.arguments:
            symbols = [(f"{a}{k}", k) for k in range(1, form.length(a) + 1)]
            out += [f"    {symbol} = {a}({k});" for symbol, k in symbols if symbol in used]
        out += _body(function, "    ", "% {}", lambda line: _octave_line(line, printed))
        for key, (matrix, _) in function.outputs.items():
            out.append(f"    {key} = zeros({matrix.rows}, {matrix.cols});")
            for i, j, e in _entries(matrix):
                at = f"{key}({i + 1}, {j + 1})" if matrix.cols > 1 else f"{key}({i + 1})"
                if matrix.cols > 1 and j < i:
                    out += [f"    {at} = {key}({j + 1}, {i + 1});"] if e != 0 else []
                elif e != 0:
                    out += _folded(f"{at} = {printed(e)};", "    ", " ...")
        out.append("end")
        if any(len(line.names) > 1 for line in function.lines):
            place, weight = _nodes()
            out += ["", "function out = strip(a, b)"]
            out += ["    % Integrals of |u| u and of t |u| u over t from 0 to 1, u = a + t b."]
            out += _folded(f"t = [{', '.join(place)}];", "    ", " ...")
            out += _folded(f"k = [{', '.join(weight)}];", "    ", " ...")
            out += ["    u = a(:)*ones(size(t)) + b(:)*t;", "    f = k.*sqrt(sum(u.*u, 1));"]
            out += ["    out = [u*f.'; u*(f.*t).'];", "end"]
        files[f"{name}_{function.name}.m"] = "\n".join([*out, ""])
    return files


def _octave_line(line: Line, printed: Callable[[Any], str]) -> list[str]:
    if len(line.names) == 1:
        return _folded(f"{line.names[0].name} = {printed(line.of[0])};", "    ", " ...")
    a, b = (", ".join(map(printed, part)) for part in (line.of[:3], line.of[3:]))
    return _folded(f"{_strip_name(line)} = strip([{a}], [{b}]);", "    ", " ...")


SPECIAL = str.maketrans({c: rf"\{c}" for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}",
                        "^": r"\textasciicircum{}"})  # fmt: skip


def latex_files(form: ClosedForm, origin: Origin, stem: str) -> dict[str, str]:
    """A document that stands alone: names as they are worked out, then the entries."""
    printed = _printers()["latex"]._print
    out = [*_comment(_head(form, origin), "% "), r"\documentclass{article}", r"\usepackage{amsmath}"]
    out += [r"\usepackage[margin=2cm]{geometry}", r"\allowdisplaybreaks", r"\begin{document}", r"\sloppy"]
    for line in _head(form, origin):
        out += [*textwrap.wrap(line.translate(SPECIAL), WIDTH, break_long_words=False, break_on_hyphens=False), ""]
    if form.parameters:
        out += [r"\section*{Parameters}", r"\begin{itemize}"]
        for p in form.parameters:
            value = _Latex()._print_Float(p.value)
            out.append(rf"\item ${in_letters(p.symbol.name)} = {value}$ {p.unit.translate(SPECIAL)}: {one_line(p.said).translate(SPECIAL)}")
        out += [r"\end{itemize}"]
    for function in form.functions:
        out += [rf"\section*{{{function.name.replace('_', ' ').capitalize()}}}", function.said.translate(SPECIAL)]
        rows: list[tuple[str, str]] = []
        for line in function.lines:
            rows += _latex_rows(line, printed)
        for key, (matrix, _) in function.outputs.items():
            for i, j, e in _entries(matrix):
                if e != 0 and not (matrix.cols > 1 and j < i):
                    at = f"{i + 1},{j + 1}" if matrix.cols > 1 else f"{i + 1}"
                    rows.append((f"{key}_{{{at}}}", printed(e)))
        if not rows:
            out.append("It is zero.")
            continue
        out.append(r"\begin{align*}")
        for left, right in rows:
            lines = textwrap.wrap(right, 150, break_long_words=False, break_on_hyphens=False) if len(right) > 170 else [right]
            lines = _between_terms(right) if len(lines) > 1 else lines
            out.append(f"{left} &= {lines[0]} \\\\")
            out += [rf"&\quad {more} \\" for more in lines[1:]]
        out.append(r"\end{align*}")
    return {f"{identifier(stem)}.tex": "\n".join([*out, r"\end{document}", ""])}


def _between_terms(text: str) -> list[str]:
    """A long sum on lines that begin with a sign, outside of braces and parentheses."""
    out, depth, start = [], 0, 0
    for i, letter in enumerate(text):
        depth += (letter in "{(") - (letter in "})")
        if depth == 0 and i - start > 140 and text[i : i + 3] in (" + ", " - "):
            out.append(text[start:i])
            start = i
    return [*out, text[start:].strip()]


def _latex_rows(line: Line, printed: Callable[[Any], str]) -> list[tuple[str, str]]:
    if len(line.names) == 1:
        return [(in_letters(line.names[0].name), printed(line.of[0]))]
    k = _strip_name(line).removeprefix("strip")
    a, b = (r" \\ ".join(map(printed, part)) for part in (line.of[:3], line.of[3:]))
    u = rf"\mathbf{{u}}_{{{k}}}(t)"
    return [
        (u, rf"\begin{{pmatrix}} {a} \end{{pmatrix}} + t \begin{{pmatrix}} {b} \end{{pmatrix}}"),
        (rf"\mathbf{{d}}_{{{k}}}, \mathbf{{d}}'_{{{k}}}", rf"\int_0^1 |{u}| \, {u} \, dt, \ \int_0^1 t \, |{u}| \, {u} \, dt"),
    ]


LANGUAGES: Mapping[str, Callable[[ClosedForm, Origin, str], dict[str, str]]] = {
    "c": c_files,
    "python": python_files,
    "latex": latex_files,
    "octave": octave_files,
}
