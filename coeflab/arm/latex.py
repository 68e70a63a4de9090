"""Closed forms as a LaTeX document, in symbols as papers write them."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Sequence
from typing import Any

from sympy.printing.latex import LatexPrinter  # type: ignore[import-untyped]

from coeflab.arm.tape import ClosedForm, Line
from coeflab.core.wording import one_line

LONG, WIDTH = 140, 100  # letters of an equation's line, of a line of text
DIGITS = 12  # the rest is rounding of products, which code needs and a reader does not
STRIP = re.compile(r"strip(\d+)_(\d)")
BEGINS, ENDS = r"\begin{", r"\end{"
AXES = ("x", "y", "z")
SPEEDS = ("u", "v", "w", "p", "q", "r")
NAMED = {"cos": r"\mathrm{c}", "sin": r"\mathrm{s}", "angle": r"\theta", "x": "x", "q": "q"}
VECTORS = {"down": r"\hat{e}", "current": "v^f", "acceleration": "a^f"}


class _Latex(LatexPrinter):  # type: ignore[misc]
    """Symbols as papers write them."""

    def _print_Float(self, expr: Any) -> str:  # noqa: N802 - sympy's name
        mantissa, _, power = f"{float(expr):.{DIGITS}g}".partition("e")
        return mantissa if not power else rf"{mantissa} \cdot 10^{{{int(power)}}}"

    def _print_Symbol(self, expr: Any, **_: Any) -> str:  # noqa: N802
        return in_letters(expr.name)


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


NOTATION = (
    r"In symbols: $\mathbf{s} = (u, v, w, p, q, r, \dot{q}_1, \dots)$; $\hat{e}$ is down, $v^f$ and $a^f$ are velocity and acceleration of "
    r"the water; $\mathrm{c}_j$ and $\mathrm{s}_j$ are cosine and sine of joint $j$. Numbers are rounded to 12 digits."
)
SPECIAL = str.maketrans({c: rf"\{c}" for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}",
                        "^": r"\textasciicircum{}"})  # fmt: skip


def document(form: ClosedForm, head: Sequence[str]) -> str:
    """A document that stands alone: names as they are worked out, then the entries.

    Parameters
    ----------
    form : ClosedForm
    head : sequence of str
        What is said above the equations.
    """
    printed = _Latex({"order": "none", "mul_symbol": r" \,"})._print
    out = [r"\documentclass{article}", r"\usepackage{amsmath}"]
    out += [r"\usepackage[margin=2cm]{geometry}", r"\allowdisplaybreaks", r"\begin{document}", r"\sloppy"]
    for line in head:
        out += [*textwrap.wrap(line.translate(SPECIAL), WIDTH, break_long_words=False, break_on_hyphens=False), ""]
    out += [NOTATION, ""]
    if form.parameters:
        out += [r"\section*{Parameters}", r"\begin{itemize}"]
        for p in form.parameters:
            value = _Latex()._print_Float(p.value)
            out.append(
                rf"\item ${in_letters(p.symbol.name)} = {value}$ {p.unit.translate(SPECIAL)}: {one_line(p.meaning).translate(SPECIAL)}"
            )
        out += [r"\end{itemize}"]
    for function in form.functions:
        out += [rf"\section*{{{function.name.replace('_', ' ').capitalize()}}}", function.meaning.translate(SPECIAL)]
        rows: list[tuple[str, str]] = []
        for one in function.lines:
            rows += _rows(one, printed)
        for key, (matrix, _) in function.outputs.items():
            for i, j in ((i, j) for i in range(matrix.rows) for j in range(matrix.cols)):
                e = matrix[i, j]
                if e != 0 and not (matrix.cols > 1 and j < i):
                    at = f"{i + 1},{j + 1}" if matrix.cols > 1 else f"{i + 1}"
                    rows.append((f"{key}_{{{at}}}", printed(e)))
        if not rows:
            out.append("It is zero.")
            continue
        out.append(r"\begin{align*}")
        for left, right in rows:
            lines = _between_terms(right)
            out.append(f"{left} &= {lines[0]} \\\\")
            out += [rf"&\quad {more} \\" for more in lines[1:]]
        out.append(r"\end{align*}")
    return "\n".join([*out, r"\end{document}", ""])


def _between_terms(text: str) -> list[str]:
    """A long sum on lines that begin with a sign, outside of braces, parentheses and matrices."""
    out, depth, start = [], 0, 0
    for i, letter in enumerate(text):
        depth += (letter in "{(") - (letter in "})") + text.startswith(BEGINS, i) - text.startswith(ENDS, i)
        if depth == 0 and i - start > LONG and text[i : i + 3] in (" + ", " - "):
            out.append(text[start:i])
            start = i
    return [*out, text[start:].strip()]


def _rows(line: Line, printed: Callable[[Any], str]) -> list[tuple[str, str]]:
    if len(line.names) == 1:
        return [(in_letters(line.names[0].name), printed(line.of[0]))]
    k = line.names[0].name.partition("_")[0].removeprefix("strip")
    a, b = (r" \\ ".join(map(printed, part)) for part in (line.of[:3], line.of[3:]))
    u = rf"\mathbf{{u}}_{{{k}}}(t)"
    return [
        (u, rf"\begin{{pmatrix}} {a} \end{{pmatrix}} + t \begin{{pmatrix}} {b} \end{{pmatrix}}"),
        (
            rf"\mathbf{{d}}_{{{k}}}, \mathbf{{d}}'_{{{k}}}",
            rf"\int_0^1 |{u}| \, {u} \, dt, \ \int_0^1 t \, |{u}| \, {u} \, dt",
        ),
    ]
