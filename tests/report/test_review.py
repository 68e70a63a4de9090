"""A report for a reviewer: files by their sha256, rows used and left out, every derivative's curve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.api.documents import report_of
from coeflab.core.provenance import InputFile
from coeflab.fits.slope_at_origin import fit
from coeflab.report.document import Document, Section
from coeflab.report.formats import pdf
from coeflab.report.tables.traceability import traceability
from coeflab.tables.force_table import Declared, Exclusion
from tests.report.studies import FULL, HOSTILE, LENGTH, small_study, small_table


def section(document: Document, name: str) -> Section:
    return next(s for s in document.sections if s.anchor == name)


def test_every_file_stands_with_what_was_used_of_it() -> None:
    study = small_study(FULL)
    whole = tuple(Exclusion(k, k + 2, "", "too short", status="too short") for k in (3, 4))
    usable = {c: np.array(mask) for c, mask in study.tables[0].usable.items()}
    for mask in usable.values():
        mask[[3, 4]] = False
    files = (InputFile("tow/campaign.toml", "1" * 64), InputFile("tow/table.csv", "0" * 64))
    told = Declared("FLU", (("beta", "v = -U sin(beta)"),), (-1.0, 0.0, 0.0))
    table = replace(
        study.tables[0], exclusions=(*study.tables[0].exclusions, *whole), usable=usable, files=files, declared=told,
        notes=("moments moved by (+1, 0, 0) m",),
    )  # fmt: skip
    inputs = (InputFile("plan.toml", "2" * 64), *files)
    data, *others = traceability(replace(study, tables=(table,), inputs=inputs)).rows
    assert data[:4] == ("tow/table.csv", "tow/table.csv", "0" * 64, "11 of 13")
    assert data[4] == f"tow 1 Y: {HOSTILE}; tow 3, tow 4: too short"
    assert data[5].startswith("axes FLU to FRD; beta: v = -U sin(beta); primes by LOA = 2 m, moments about")
    assert data[5].endswith("moments moved by (+1, 0, 0) m")
    assert [row[1:3] for row in others] == [("tow/campaign.toml", "1" * 64), ("plan.toml", "2" * 64)]


def test_a_point_that_a_fit_leaves_aside_is_named() -> None:
    study = small_study(FULL)
    table = small_table(FULL)
    forces = {c: np.array(f) for c, f in table.forces.items()}
    forces["N"][9] *= 5.0
    table = replace(table, forces=forces)
    row = traceability(replace(study, tables=(table,), fits=(fit([table], LENGTH, {}),))).rows[0]
    assert "tow 9 of Nv': does not fit the other points" in row[4]


def test_every_derivative_has_its_curve_two_a_page() -> None:
    study = small_study(FULL)
    document = report_of(study, review=True).document
    curves = section(document, "every-curve")
    drawn = [s.symbol for f in study.fits for s in f.sweeps if len(s.x)]
    assert len(curves.figures) == len(drawn) >= 2
    assert all(symbol in figure.title for symbol, figure in zip(drawn, curves.figures, strict=True))
    assert curves.plates
    pages = []
    for count in (2, 4, 6):
        again = replace(curves, figures=tuple(replace(curves.figures[k % 2], anchor=f"f{k}") for k in range(count)))
        pages.append(len(pdf.page_pictures(replace(document, sections=(*document.sections[:-1], again)), 20)))
    assert np.diff(pages).tolist() == [1, 1]


@pytest.mark.parametrize("whole", [False, True])
def test_the_command_that_makes_it_again_names_what_was_asked(whole: bool) -> None:
    document = report_of(small_study(FULL), full=whole, review=not whole).document
    code = section(document, "reproduce").code
    assert all(line.endswith("--full" if whole else "--for-review") for line in code)
