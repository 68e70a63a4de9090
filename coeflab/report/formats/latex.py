"""One LaTeX file: every table of the report with booktabs, its caption, its notes below, numbers and units by siunitx; and BibTeX of the works used."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from importlib.resources import files
from math import ceil
from typing import NamedTuple

from coeflab.core.table import ABSENT, Table, percent, plus_minus
from coeflab.core.text.bounded import own_text
from coeflab.core.version import VERSION
from coeflab.report.document import Answer, AnswerRow, Document, Section
from coeflab.report.notation import (
    DOT,
    GREEK,
    Command,
    Factor,
    Raised,
    Run,
    cell_runs,
    keeping,
    runs,
    unit_runs,
    verbatim,
)
from coeflab.report.printable import shortened, visible

summary = "one LaTeX file with every table: booktabs, siunitx, captions, notes; and BibTeX of the works used"
suffix = ".tex"
citations: tuple[str, ...] = ()

FILE, WORKS = "report.tex", "report.bib"
_NUMBER = r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
VALUE = re.compile(rf"({_NUMBER})(?: \+- ({_NUMBER}))?")
LITERAL = re.compile(
    r"[A-Za-z]+(?:\^-?\d+)?(?:[*/]\(?[A-Za-z]+(?:\^-?\d+)?\)?)*"
)  # units that siunitx sets as they are written
LONGEST_TITLE, LONGEST_COLUMN, LONGEST_KEY = 300, 160, 40  # letters
ON_A_PAGE = 30  # lines of rows; a longer table goes on over pages
LINE = 112  # letters of footnote size in a line, with three for the gap between two columns
WIDE, NARROW, FOLDED = (
    28,
    14,
    18,
)  # letters: a column beyond the first folds, the second may, the third it then has at least
LEVELS = ("section", "subsection", "subsubsection", "paragraph")
SPECIAL = {
    "/": r"\slash{}", "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}",
    "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "`": r"\textasciigrave{}", "\u2026": r"\ldots{}", "\u2013": r"\textendash{}",
    "\u2014": r"\textemdash{}", "\u202f": r"\,", "\u00a0": "~", "\u2018": r"\textquoteleft{}", "\u2019": r"\textquoteright{}",
    "\u201c": r"\textquotedblleft{}", "\u201d": r"\textquotedblright{}", "\u00a7": r"\S{}",
}  # fmt: skip
IN_MATH = {
    "\u2212": "-", "\u00b1": r"\pm", "\u00d7": r"\times", "\u00b0": r"{}^{\circ}", "\u2264": r"\le", "\u2265": r"\ge", "\u00b7": r"\cdot",
    "/": "/", "\u2032": "'", "\u00bd": r"\frac{1}{2}", "\u221a": r"\surd", "<": "<", ">": ">", "|": "|", "\u00b5": r"\mu", "\u00b2": "^{2}",
    "\u00b3": "^{3}", "\u202f": r"\,",
} | {letter: rf"\{name}" for name, letter in GREEK.items()}  # fmt: skip
PLAIN = re.compile(r"\u2212?(?<![\w.])\d[\d.]*(?:\u202f×\u202f10)?|.", re.DOTALL)
END = "\\end{document}\n"


class Piece(NamedTuple):
    """A part of a text, set as mathematics or not."""

    math: bool
    tex: str


def render(document: Document) -> Mapping[str, bytes]:
    """The tables of a report as a file.

    Parameters
    ----------
    document : Document

    Returns
    -------
    mapping of file name to bytes
        ``report.tex``, and ``report.bib`` where works were used; equal documents give equal bytes. Characters that pdflatex has no letter for stand as ``U+XXXX``.
    """
    with keeping(document.verbatim):
        title = shortened(visible(document.title), LONGEST_TITLE)
        digest = f", inputs {document.digest}" if document.digest else ""
        head = own_text(files("coeflab.report.formats") / "_latex" / "head.tex")
        for name, value in (("version", VERSION), ("digest", digest), ("file", FILE), ("title", _comment(title))):
            head = head.replace(f"@{name}@", value)
        result = [head]
        result.append(f"\\section*{{{tex(title)}}}\n")
        tables = [*_first(document.answer), *(part for s in document.sections for part in _section(s, 0))]
        result += tables or ["This report has no tables.\n"]
        works = {WORKS: _bibtex(document.works).encode()} if document.works else {}
    return {FILE: "\n".join([*result, END]).encode(), **works}


def _bibtex(works: Sequence[tuple[str, str]]) -> str:
    """One entry a work, its reference as a note."""
    out, taken = [], set[str]()
    for name, text in works:
        base = re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:LONGEST_KEY] or "work"
        key, n = base, 2
        while key in taken:
            key, n = f"{base}-{n}", n + 1
        taken.add(key)
        note = tex(text.translate(str.maketrans("{}", "()")))
        out.append(f"@misc{{{key},\n  key = {{{key}}},\n  note = {{{note}}}\n}}\n")
    return "\n".join(out)


def _comment(text: str) -> str:
    return "".join(ch if " " <= ch <= "~" else "?" for ch in text)


def _first(answer: Answer | None) -> Iterator[str]:
    """The table of the first page, if there is one."""
    if answer is None:
        return
    found = answer.table or (_wanted(answer) if answer.rows else None)
    if found is not None:
        yield set_table(found, "answer-table")


def _wanted(answer: Answer) -> Table:
    """The wanted coefficients beside published ones."""
    compared = bool(answer.compared)
    headers = ("", "ours +- U95", "U95 %", *answer.columns, *(("difference", "difference / U95") * compared), "from")
    rows = tuple((*_ours(r), *_published(r, answer), *(r.apart * compared), r.source) for r in answer.rows)
    title = "Primed coefficients with their 95 % half-width U95" + " and published values" * compared
    return Table(title, headers, rows, answer.notes, frozenset({0, len(headers) - 1}))


def _ours(row: AnswerRow) -> tuple[str, str, str]:
    if row.value is None:
        return row.name, row.status or "no data", ABSENT
    words = " ".join(filter(None, (plus_minus(row.value, row.u95), row.status)))
    return row.name, words, percent(row.u95, row.value)


def _published(row: AnswerRow, answer: Answer) -> tuple[str, ...]:
    shown = (*row.shown, *[None] * len(answer.columns))[: len(answer.columns)]
    return tuple("no data" if value is None else value for value in shown)


def _section(section: Section, level: int) -> Iterator[str]:
    """Its heading and tables, where it or a part of it has any."""
    parts = [set_table(t, f"{section.anchor}-table-{k}") for k, t in enumerate(section.tables, 1)]
    parts += [result for inner in section.subsections for result in _section(inner, level + 1)]
    if parts:
        yield f"\\{LEVELS[min(level, len(LEVELS) - 1)]}*{{{tex(shortened(section.title, LONGEST_TITLE))}}}\n"
        yield from parts


def set_table(table: Table, name: str) -> str:
    """A table as LaTeX, where it stands; one that is longer than a page goes on over several.

    Parameters
    ----------
    table : Table
    name : str
        Of its label, after ``tab:``.
    """
    caption = f"\\caption{{{tex(shortened(table.title, LONGEST_TITLE))}}}\\label{{tab:{name}}}"
    head = _row([tex(shortened(h, LONGEST_COLUMN)) for h in table.headers])
    units = {i for i, h in enumerate(table.headers) if h == "unit"}
    rows = [_row([_cell(c, i in units, i in table.left) for i, c in enumerate(row)]) for row in table.rows]
    notes = [f"\\par\\noindent {tex(note)}" for note in table.notes]
    folds = _folding(table)
    columns = f"@{{}}{''.join(_columns(table, folds))}@{{}}"
    is_wide = _room(table, folds) > LINE
    if _lines(table, folds) > ON_A_PAGE:
        size = r"\scriptsize\setlength{\tabcolsep}{2pt}" if is_wide else r"\footnotesize"
        opening = [rf"\begingroup{size}\setlength{{\LTcapwidth}}{{\linewidth}}", f"\\begin{{longtable}}{{{columns}}}"]
        above = [r"\toprule", head, r"\midrule"]
        again = [caption + r" \\", *above, r"\endfirsthead", *above, r"\endhead", r"\bottomrule", r"\endfoot"]
        return "\n".join([*opening, *again, *rows, r"\end{longtable}", *notes, r"\par\endgroup", ""])
    opening = [
        r"\begin{table}[H]",
        r"\centering\footnotesize",
        caption,
        *([r"\resizebox{\linewidth}{!}{%"] * is_wide),
    ]
    body = [f"\\begin{{tabular}}{{{columns}}}", r"\toprule", head, r"\midrule", *rows, r"\bottomrule"]
    body.append(r"\end{tabular}" + "}" * is_wide)
    below = [r"\par\smallskip\begin{minipage}{\linewidth}\footnotesize", *notes, r"\end{minipage}"] if notes else []
    return "\n".join([*opening, *body, *below, r"\end{table}", ""])


def _row(cells: Sequence[str]) -> str:
    """Cells as a row; a bracket or a star at its beginning is not an option of the row before."""
    line = " & ".join(cells)
    return ("{}" if line[:1] in ("[", "*") else "") + line + r" \\"


def _widths(table: Table) -> list[int]:
    return [max(map(len, (h, *(row[i] for row in table.rows)))) for i, h in enumerate(table.headers)]


def _room(table: Table, folds: Collection[int]) -> int:
    """Letters that a line needs at least."""
    return sum((min(width, FOLDED) if i in folds else width) + 3 for i, width in enumerate(_widths(table)))


def _folding(table: Table) -> set[int]:
    """Columns of text that fold: long ones, and where the line has no room others that have words."""
    widths = _widths(table)
    folds = {i for i in table.left if i < len(widths) and widths[i] > WIDE}
    for i in sorted((table.left - folds) & set(range(len(widths))), key=lambda i: (-widths[i], i)):
        if _room(table, folds) <= LINE:
            break
        if widths[i] > NARROW and any(" " in row[i] for row in table.rows):
            folds.add(i)
    return folds


def _letters(table: Table, folds: Collection[int]) -> dict[int, float]:
    """What columns that fold have of the line, in letters."""
    widths = _widths(table)
    rest = LINE - sum(width + 3 for i, width in enumerate(widths) if i not in folds) - 3 * len(folds)
    wanted = sum(min(widths[i], 2 * WIDE) for i in folds)
    return {i: max(FOLDED, min(widths[i], rest * min(widths[i], 2 * WIDE) / wanted)) for i in folds}


def _lines(table: Table, folds: Collection[int]) -> int:
    """Lines of all rows, with the cells folded."""
    letters = _letters(table, folds)
    return sum(max((ceil(len(row[i]) / width) for i, width in letters.items()), default=1) for row in table.rows)


def _columns(table: Table, folds: Collection[int]) -> list[str]:
    """``l``, ``r``, or for text that has to fold its share of the line."""
    letters = _letters(table, folds)
    return [
        rf">{{\raggedright\arraybackslash}}p{{{min(letters[i] / LINE, 0.95):.2f}\linewidth}}"
        if i in folds
        else "l"
        if i in table.left
        else "r"
        for i in range(len(table.headers))
    ]


def _cell(text: str, unit: bool, left: bool) -> str:
    """A number of a column of numbers, with its U95, and a unit by siunitx; all else as text."""
    if not left and (value := VALUE.fullmatch(text)):
        digits, _, power = value[1].partition("e")
        if value[2] and power == value[2].partition("e")[2]:  # siunitx takes one power of ten, behind both
            return rf"\num{{{digits} \pm {value[2]}}}"
        return rf"\num{{{value[1]}}}" + (rf" $\pm$ \num{{{value[2]}}}" if value[2] else "")
    if unit and LITERAL.fullmatch(text):
        return r"\unit{" + text.replace("*", ".") + "}"
    return _set(unit_runs(text) if unit else cell_runs(text, verbatim()))


def tex(text: str) -> str:
    """A text as LaTeX; what a user wrote is set letter by letter."""
    return _set(runs(" ".join(text.split()), verbatim()))


def _set(pieces: Iterable[Run]) -> str:
    """Runs as LaTeX, neighbouring formulas as one."""
    out: list[Piece] = []
    for piece in (p for run in pieces for p in _pieces(run)):
        if out and out[-1].math is piece.math:
            joined = _joined(out[-1].tex, piece.tex) if piece.math else out[-1].tex + piece.tex
            out[-1] = Piece(piece.math, joined)
        else:
            out.append(piece)
    return "".join(f"${p.tex}$" if p.math else re.sub(r"(?<=[-,'])(?=[-,'])", "{}", p.tex) for p in out).strip()


def _pieces(run: Run) -> Sequence[Piece]:
    if isinstance(run, str):
        return [_letter(found[0]) for found in PLAIN.finditer(visible(run))]
    if isinstance(run, Raised):
        return [Piece(True, f"^{{{_formula(run.text)}}}")]
    if isinstance(run, Command):
        return [Piece(False, r"\texttt{" + "".join(_letter(ch, typed=True).tex for ch in visible(run.text)) + "}")]
    under = f"\\mathrm{{{_formula(run.index)}}}" if run.index.isalpha() and run.index.isascii() else _formula(run.index)
    below = "".join(map(_factor, run.factors)) or under
    return [Piece(True, _formula(run.letter) + f"_{{{below}}}" * bool(below) + "'" * run.primed)]


def _factor(factor: Factor) -> str:
    letter = _formula(factor.letter)
    result = f"\\dot{{{letter}}}" if factor.dotted else letter
    result += f"_{{{factor.index}}}" * bool(factor.index)
    return f"|{result}|" if factor.absolute else result


def _formula(text: str) -> str:
    """Letters of a symbol or an exponent inside a formula."""
    out = ""
    for ch in unicodedata.normalize("NFD", text):
        if ch == DOT:
            out = f"{out[:-1]}\\dot{{{out[-1:]}}}"
        else:
            out = _joined(out, IN_MATH.get(ch) or SPECIAL.get(ch, ch if ch.isascii() else f"\\mbox{{U+{ord(ch):04X}}}"))
    return out


def _joined(formula: str, more: str) -> str:
    """Two formulas as one; a command's name ends before a letter, and no power has a power."""
    if more.startswith("^") and re.search(r"\^\{[^{}]*\}$", formula):
        return formula + "{}" + more
    return formula + " " * bool(re.search(r"\\[A-Za-z]+$", formula) and more[:1].isalpha()) + more


def _letter(text: str, typed: bool = False) -> Piece:
    """A character of plain text, or a negative number."""
    if len(text) > 1:
        is_math = text[0] == "\u2212" or text.endswith("\u202f10")
        return Piece(is_math, "".join(IN_MATH.get(ch, ch) for ch in text))
    if typed and text in "<>|'\"-":
        return Piece(False, {"'": r"\textquotesingle{}", "-": "-{}"}.get(text, text))
    if text in IN_MATH and text not in SPECIAL:
        return Piece(True, IN_MATH[text])
    return Piece(False, SPECIAL.get(text) or (text if text.isascii() or _has_type(text) else f"U+{ord(text):04X}"))


def _has_type(ch: str) -> bool:
    """Whether it is a letter of western or central Europe, which T1 fonts have."""
    try:
        ch.encode("iso8859-1")
    except UnicodeError:
        try:
            ch.encode("iso8859-2")
        except UnicodeError:
            return False
    return ch.isalpha()
