"""What a user wrote is set as it stands: in the page, in print, in drawings and on the terminal."""

from __future__ import annotations

import html
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from coeflab.core.wording import Verbatim
from coeflab.report import markup
from coeflab.report.content import document
from coeflab.report.figures.sweep import sweep_figure
from coeflab.report.first_page import study_summary
from coeflab.report.formats import html as page
from coeflab.report.formats import pdf
from coeflab.report.notation import Symbol, cell_runs, keeping, runs, users_texts, verbatim
from coeflab.report.printable import shortened
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study
from tests.report.studies import HALF, small_study

TITLE = "Tank tests of Xu, Wang and Li in Yr 2024"
HOSTILE = [
    TITLE,
    "Yv",
    "beta trials of U",
    "Team N and team K, 10^3 runs",
    "Mr Nu, Yv' against Nr'",
    "alpha_2 psi, C_D and 3 x 4 -2.5e-3",
    "U95  of\tYr",
    "Yvdot' " * 30 + "end",
    "$ Yv $ \\alpha",
]
ADJACENT = ["{}", "campaign {}", '"{}"', "{}/table.csv", "{}'s points", "Yv' of {}: -0.03", "{}, {} and {}", "({})"]


def symbols(text: str, user: str) -> list[str]:
    """What is a symbol or an exponent in the text beside a user's."""
    with keeping(users_texts(Verbatim(user))):
        return [p.text for p in runs(text, verbatim()) if not isinstance(p, str)]


@pytest.mark.parametrize("user", HOSTILE)
@pytest.mark.parametrize("around", ADJACENT)
def test_no_symbol_in_what_a_user_wrote_and_ours_stay(user: str, around: str) -> None:
    text = around.replace("{}", user)
    assert symbols(text, user) == (["Yv'"] if around.startswith("Yv'") else [])


def test_the_same_texts_without_marking_hold_symbols() -> None:
    """The search alone cannot tell: this is what it makes of them."""
    assert [p.text for p in runs(TITLE) if isinstance(p, Symbol)] == ["Xu", "Yr"]
    assert all(any(not isinstance(p, str) for p in cell_runs(t)) for t in HOSTILE if "$" not in t)


@pytest.mark.parametrize("longest", [8, 12, 16, 20, 24, 30, 36, 300])
def test_a_title_that_was_cut_is_still_the_users(longest: int) -> None:
    user = "Mr Nu saw Yv' rise and Nr' fall in Yr 2024, U95 and all"
    assert symbols(shortened(f"Title {user}", longest), user) == []


def test_cells_and_drawings() -> None:
    with keeping(users_texts(Verbatim("Yv"), Verbatim("U"))):
        assert cell_runs("Yv", verbatim()) == ("Yv",)
        assert markup.cell_html("Yv") == markup.html("Yv") == markup.drawn("Yv") == markup.label("Yv") == "Yv"
        assert markup.cell_html("Yv'") != "Yv'"
        assert markup.drawn("U95 and U^2") != "U95 and U^2"
    assert markup.cell_html("Yv") != "Yv"


def test_names_that_hold_no_symbol_change_nothing() -> None:
    assert users_texts(*map(Verbatim, ("suboff", "tow 2", "12", "-1.5", "1e-3", "nose, on the hull's axis"))) == ()


def named_study(text: str) -> Study:
    study = small_study(HALF)
    tables = tuple(replace(t, campaign=text, title=text, body=text, labels=(text,) * len(t)) for t in study.tables)
    fits = tuple(replace(f, campaign=text, body=text) for f in study.fits)
    return replace(study, plan=replace(study.plan, title=text, name=text), tables=tables, fits=fits)


def pieces(value: Any) -> Iterator[Any]:
    """Every list of a text's pieces in the data that the typesetter is given."""
    if isinstance(value, dict):
        for v in value.values():
            yield from pieces(v)
    elif isinstance(value, list):
        if value and all(isinstance(v, str) or (isinstance(v, dict) and {"up", "letter"} & v.keys()) for v in value):
            yield value
        else:
            for v in value:
                yield from pieces(v)


def unset(text: str) -> str:
    return re.sub(r"\s+", " ", text.replace("\u200b", "").replace("\u00a0", " "))


@pytest.mark.parametrize("make", [document, study_summary])
def test_reports_show_the_title_as_it_stands(make: Callable[[Study], Any]) -> None:
    made = make(named_study(TITLE))
    shown = page.render(made)["report.html"].decode()
    visible = re.sub(r"<(?:style|script).*?</(?:style|script)>", "", shown, flags=re.DOTALL)
    plain = unset(html.unescape(re.sub(r"<[^>]+>", "", visible)))
    assert plain.count("Li in Y") == plain.count(TITLE) > 2
    assert "in <i>Y" not in visible
    assert "of <i>X" not in visible
    content = pdf.content(made)
    holding = [p for p in pieces(content) if "Wang" in unset("".join(x for x in p if isinstance(x, str)))]
    assert len(holding) > 1
    assert all("Li in Yr 2024" in unset("".join(x if isinstance(x, str) else "\0" for x in p)) for p in holding)
    assert any(isinstance(x, dict) for p in pieces(content) for x in p), "our own symbols are set"


def test_the_pdf_prints_it() -> None:
    pymupdf = pytest.importorskip("pymupdf")
    made = pymupdf.open(stream=pdf.render(study_summary(named_study(TITLE)))["report.pdf"], filetype="pdf")
    spans = [s for p in made for b in p.get_text("dict")["blocks"] for n in b.get("lines", ()) for s in n["spans"]]
    heading = [s for s in spans if "Tank tests" in s["text"]]
    assert heading
    assert any("Xu, Wang and Li in Yr 2024" in s["text"] for s in heading)


def test_a_drawing_alone() -> None:
    sweep = replace(named_study("Yv of Yr").fits[0].sweeps[0], symbol="Yv")
    with keeping(("Yv of Yr",)):
        drawn = sweep_figure(sweep, "a").svg
    assert "<tspan" in drawn, "our own symbols are set"


@pytest.mark.slow
def test_from_the_files_of_a_user(write_campaign: Callable[..., Path], tmp_path: Path) -> None:
    """Titles, body, datum, length, row labels and file names of real files, all through; the terminal prints them raw."""
    folder = write_campaign(
        campaign=f'title = "{TITLE}"\nbody = "Mr Nu of Yv"',
        scaling='length = 4.0\nlength_name = "L of Xu"',
        source='citation = "Xu and Li, Nr 7"\nkind = "synthetic"',
        csv="point,beta [deg],Y [N],N [N*m]\nYr 1,-4,-20.5,-30.25\nYr 2,0,0.5,0.25\nYr 3,4,21.5,30.75\n",
    )
    (folder / "plan.toml").write_text(
        f'[study]\nname = "t"\ntitle = "{TITLE}"\n[[table]]\ncampaign = "."\nfits = ["slope_at_origin"]\n'
    )
    study = run(read_plan(folder / "plan.toml"))
    found = users_texts(study)
    assert {TITLE, "Mr Nu of Yv", "L of Xu", "Xu and Li, Nr 7", "Yr 1"} <= set(found)
    assert not {"nose", "t", "Yv", "deg"} & set(found)
    shown = page.render(document(study))["report.html"].decode()
    for text in (TITLE, "Mr Nu of Yv", "L of Xu", "Xu and Li, Nr 7"):
        assert text in shown
    assert "in <i>Y" not in shown
    assert "<i>Y</i><sub><i>v</i></sub>" in shown, "our own symbols are set"
    start = "import sys; from coeflab.cli import main; main()"
    command = [sys.executable, "-c", start, "run", folder / "plan.toml", "--out", tmp_path / "out"]
    printed = subprocess.run(command, capture_output=True, text=True, check=False)
    assert printed.stdout.startswith(TITLE)
