"""The LaTeX of a report: tables parsed back, symbols as mathematics, nothing of a user's taken for markup."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from coeflab.core.table import Table
from coeflab.report.content import core, document
from coeflab.report.document import Document, Section
from coeflab.report.formats import REPORTERS, Renderer, latex
from coeflab.report.notation import keeping
from tests.report.studies import FULL, HALF, HOSTILE, small_study

EVIL = r"50 % of a_b & #1 \input{x} ~^ {c} `q` -- <|> $"
BEGINS = re.compile(r"\\(begin|end)\{(\w+)\}")


def made(what: Document) -> str:
    return latex.render(what)["report.tex"].decode()


def of_one(table: Table, verbatim: tuple[str, ...] = ()) -> str:
    return made(Document("Title", "", (Section("here", "Here", tables=(table,)),), verbatim=verbatim))


def balanced(text: str) -> None:
    """Every environment and brace is closed in order, every row has as many cells as its table has columns."""
    bare = re.sub(r"(?m)(?<!\\)%.*$", "", text)
    still = []
    for what, name in BEGINS.findall(bare):
        still.append(name) if what == "begin" else None
        assert what == "begin" or still.pop() == name
    assert still == []
    depth = 0
    for sign in re.findall(r"(?<!\\)[{}]", bare.replace("\\\\", "")):
        depth += 1 if sign == "{" else -1
        assert depth >= 0
    assert depth == 0
    assert len(re.findall(r"(?<!\\)\$", bare)) % 2 == 0
    for columns, rows in re.findall(
        r"\\begin\{(?:tabular|longtable)\}\{@\{\}([^\n]*)@\{\}\}\n(.*?)\\end\{", bare, re.DOTALL
    ):
        wide = len(re.findall("[lrp]", re.sub(r">\{[^{}]*\}|\{[^{}]*\}", "", columns)))
        for row in re.findall(r"(?m)^(.*[^}]) \\\\$", rows):
            if not row.startswith("\\caption"):
                assert len(re.split(r"(?<!\\)&", row)) == wide, row


def test_it_is_a_plugin() -> None:
    assert "latex" in REPORTERS.names()
    assert isinstance(REPORTERS.load("latex"), Renderer)


@pytest.mark.parametrize("whole", [False, True])
def test_a_study_has_its_tables_with_captions_and_notes(whole: bool) -> None:
    study = small_study(FULL, published=True)
    found = document(study) if whole else core(document(study))
    text = made(found)
    balanced(text)
    assert text == made(found)
    assert r"\documentclass" in text
    assert text.endswith("\\end{document}\n")

    def tables(sections: tuple[Section, ...]) -> list[Table]:
        return [t for s in sections for t in (*s.tables, *tables(s.subsections))]

    shown = tables(found.sections)
    assert text.count(r"\begin{tabular}") + text.count(r"\begin{longtable}") == len(shown) + 1
    assert text.count(r"\caption{") == len(shown) + 1
    assert text.count(r"\par\noindent ") == sum(len(t.notes) for t in shown) + len(found.answer.notes)
    labels = re.findall(r"\\label\{(.*?)\}", text)
    assert len(set(labels)) == len(labels)
    assert "$Y_{v}'$ & " in text


def test_hostile_texts_are_set_letter_by_letter() -> None:
    for name in (HOSTILE, EVIL):
        study = small_study(HALF, named=name)
        balanced(made(document(study)))
    table = Table(EVIL, ("", EVIL, "n"), (("[x", EVIL, "1"),), (EVIL,), frozenset({0, 1}))
    text = of_one(table, (EVIL,))
    balanced(text)
    spelled = r"50 \% of a\_b \& \#1 \textbackslash{}input\{x\} \textasciitilde{}\textasciicircum{} \{c\} \textasciigrave{}q\textasciigrave{} -{}- $<|>$ \$"
    assert text.count(spelled) == 4
    assert "\n{}[$x$ & " in text
    assert "\\input{" not in text[text.index(r"\begin{document}") :]
    title = replace(Document(f"%\n\\end{{document}} {EVIL}", "", ()))
    head = made(title).partition(r"\documentclass")[0]
    assert all(line.startswith("%") for line in head.splitlines())
    assert "\\end{document}" in head
    assert made(title).count("\n\\end{document}") == 1


@pytest.mark.parametrize(
    ("written", "set_as"),
    [
        ("Yv'", "$Y_{v}'$"),
        ("Nv|v|'", "$N_{v|v|}'$"),
        ("Yvdot'", r"$Y_{\dot{v}}'$"),
        ("Ydr'", r"$Y_{\delta_{r}}'$"),
        ("X0'", "$X_{0}'$"),
        ("U95", "$U_{95}$"),
        ("v'^3", "$v'^{3}$"),
        ("L^2^3", "$L^{2}{}^{3}$"),
        ("-0.0147", "$-0.0147$"),
        ("-0.0147 +- 0.0019", r"$-0.0147$ $\pm$ 0.0019"),
        ("1.2e-05", r"$1.2\,\times\,10^{-5}$"),
        ("beta = 2 deg", r"$\beta$ = 2${}^{\circ}$"),
        ("Überführung α", r"Überführung $\alpha$"),
        ("水", "U+6C34"),
        ("it's --full", r"it's -{}-full"),
    ],
)
def test_symbols_numbers_and_letters(written: str, set_as: str) -> None:
    assert latex.tex(written) == set_as


def test_numbers_and_units_are_those_of_siunitx() -> None:
    rows = (
        ("a 1", "-0.0147 +- 0.0019", "N*m/(rad/s)", "1.2e-05"),
        ("012", "+3", "deg", "-"),
        ("x", "3 of 5", "%", "1,2"),
        ("y", "-0.8e-05 +- 1.5e-05", "-", "-0.8e-05 +- 0.1"),
    )
    text = of_one(Table("T", ("", "ours", "unit", "n"), rows, (), frozenset({0, 2})))
    balanced(text)
    assert r"\usepackage{siunitx}" in text
    assert r"a 1 & \num{-0.0147 \pm 0.0019} & \unit{N.m/(rad/s)} & \num{1.2e-05} \\" in text
    assert r"012 & \num{+3} & \unit{deg} & " in text
    assert r"$x$ & 3 of 5 & \% & 1,2 \\" in text
    assert r"$y$ & \num{-0.8 \pm 1.5e-05} & - & \num{-0.8e-05} $\pm$ \num{0.1} \\" in text  # one power, behind both


def test_works_are_bibtex_whatever_their_key() -> None:
    works = (("roddy1990", "R. F. Roddy, 5 % & more, 1990."), ("A. B, {C}", "A. B, {C}"), ("A. B, C", "A. B, C"))
    text = latex.render(replace(Document("Title", "", ()), works=works))["report.bib"].decode()
    assert re.findall(r"@misc\{([\w-]+),", text) == ["roddy1990", "A-B-C", "A-B-C-2"]
    assert "note = {R. F. Roddy, 5 \\% \\& more, 1990.}" in text
    assert text.count("{") == text.count("}") == 9
    assert list(latex.render(Document("Title", "", ()))) == ["report.tex"]


def test_a_table_of_few_rows_that_fold_over_a_page_goes_on_too() -> None:
    """A float taller than its page is cut off by LaTeX with a warning alone."""
    words = " ".join(["word"] * 120)
    for rows, longer in ((3, True), (1, False)):
        text = of_one(Table("Tall", ("n", "what", "why"), ((("1", words, words),) * rows), (), frozenset({1, 2})))
        assert (r"\begin{longtable}" in text) is longer
        assert (r"\begin{table}[H]" in text) is not longer


def test_a_users_text_holds_no_symbol() -> None:
    with keeping(("Yv' of us",)):
        assert latex.tex("Yv' of us: Yv'") == "Yv' of us: $Y_{v}'$"


def test_a_long_table_goes_on_and_text_folds() -> None:
    rows = tuple((str(k), "a text that is far too long for one line of a page") for k in range(latex.ON_A_PAGE + 1))
    text = of_one(Table("Long", ("n", "what"), rows, ("Note.",), frozenset({1})))
    balanced(text)
    assert r"\begin{longtable}{@{}r>{\raggedright\arraybackslash}p{" in text
    assert text.index(r"\endfirsthead") < text.index(r"\endhead") < text.index("\n\\num{0} & ")
    assert text.count("n & what") == 2
    assert text.count("Long") == 1


def test_a_report_without_tables_says_so() -> None:
    assert "This report has no tables." in made(Document("Title", "", (Section("here", "Here"),)))
