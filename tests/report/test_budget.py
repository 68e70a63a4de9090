from __future__ import annotations

import re
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from coeflab.fits.uncertainty.budget import MODEL, OpenGrid
from coeflab.fits.uncertainty.grid_convergence import Convergence
from coeflab.fits.uncertainty.grid_studies import VariantStudy
from coeflab.law.coefficient import COVERS
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.tornado import tornado_figure
from coeflab.report.sections.coefficients import coefficients_section
from coeflab.report.tables import budgets as budget_tables
from coeflab.report.tables import results
from coeflab.study.validation import validation
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.vehicle.stability import centre_of_pressure
from tests.report.studies import FULL, HOSTILE, budgets, small_study

DECLARED = InputUncertainty(angle=float(np.radians(0.1)), speed=0.005, reference_point=0.01)


def declared_study(angles=FULL, named="tow"):
    study = small_study(angles, named=named)
    return replace(study, tables=tuple(replace(t, uncertainty=DECLARED) for t in study.tables))


def test_every_table_has_cells_for_its_headers():
    study = declared_study()
    found = budgets(study)
    fit = study.fits[0]
    made = [
        budget_tables.overview(found),
        *(budget_tables.budget(b) for b in found),
        budget_tables.grids(found),
        budget_tables.validation([validation(found[0], found[0])]),
        budget_tables.derived(centre_of_pressure(fit.coefficients, fit.campaign)),
    ]
    for table in made:
        assert all(len(row) == len(table.headers) for row in table.rows)
        assert "nan" not in str(table.rows)
    assert len(made[0].rows) == len(found)
    assert made[-1].rows


def test_a_budget_shows_both_ways_and_what_is_missing():
    b = budgets(declared_study())[1]
    table = budget_tables.budget(b)
    assert [row[0] for row in table.rows] == [*(p.name for p in b.parts), "U95"]
    assert any("Monte Carlo" in n and "seed 1" in n for n in table.notes)
    assert table.notes[-1] == "Not assessed: moment, length, density."


def test_parts_that_are_not_assessed_are_a_dash_and_not_zero():
    table = budget_tables.overview(budgets(small_study(FULL)))
    assert "speed" not in table.headers
    assert not any(cell in ("0", "0.0 %") for cell in table.rows[0][5:7])


def test_u95_covers_what_entered_and_names_what_entered_only_some():
    plain, declared = small_study(FULL), declared_study()
    assert results.covers(replace(plain, budgets=budgets(plain))) == COVERS
    found = budgets(declared)
    with_inputs = replace(declared, budgets=found)
    assert results.covers(with_inputs) == f"{COVERS}, declared inputs"
    covered = "covers declared inputs, scatter, smooth curvature and onset of stall at an unknown angle;"
    assert covered in " ".join(coefficients_section(with_inputs).texts)
    assert f"covers {results.covers(with_inputs)})." in results.headline(with_inputs)
    grid = tuple(
        replace(b, parts=(*b.parts, replace(b.parts[0], name="grid"))) if b.symbol == "Yv" else b for b in found
    )
    in_some = replace(declared, budgets=grid)
    assert results.covers(in_some) == f"{COVERS}, declared inputs, grid (only Yv')"
    sway = in_some.fits[0].coefficients["Yv"]
    assert results.covers(in_some, [sway]) == f"{COVERS}, declared inputs, grid"
    models = VariantStudy(MODEL, "drift", "Y", "v = 0.1 m/s", ("v",), -12.0, (("kEpsilon", -13.0),), 1.2, "")
    beside = replace(declared, budgets=tuple(replace(b, studies=(models,)) for b in found))
    assert results.covers(beside) == f"{COVERS}, declared inputs"  # no part of U95: its spread stands beside


def test_the_core_names_the_rows_that_no_fit_uses_and_the_coefficients_without_a_grid_part():
    study = declared_study()
    left = tuple(replace(t, exclusions=tuple(replace(e, of_source=True) for e in t.exclusions)) for t in study.tables)
    found = tuple(
        replace(b, unassessed=("grid (study divergent)",), open_grid=OpenGrid(Convergence.DIVERGENT))
        if b.symbol == "Nv"
        else replace(b, parts=(*b.parts, replace(b.parts[0], name="grid")))
        for b in budgets(study)
    )
    (table,) = coefficients_section(replace(study, tables=left, budgets=found)).tables
    assert any(n.startswith("Readings left out (point, components): ") and " Y" in n for n in table.notes)
    assert any("grid, for Nv' (grid study divergent)" in n for n in table.notes)


@pytest.mark.parametrize("angles", [FULL, [-4.0, -2.0, 0.0, 2.0]])
def test_the_tornado_is_well_formed_and_named_by_the_page(angles):
    for i, b in enumerate(budgets(declared_study(angles, HOSTILE))):
        figure = tornado_figure(b, f"t{i}")
        root = ET.fromstring(figure.svg)
        assert root.find("{http://www.w3.org/2000/svg}title").text
        assert "<script" not in figure.svg
        bare = re.sub(r"var\(--fig-\w+, #[0-9a-f]{6}\)", "", figure.svg)
        assert not re.search(r"#[0-9a-f]{6}\b", bare)
        assert set(re.findall(r"--fig-(\w+)", figure.svg)) <= set(COLOURS)
        assert figure.svg == tornado_figure(b, f"t{i}").svg


def test_the_longest_bar_stands_on_top_and_u95_below():
    b = budgets(declared_study())[0]
    figure = tornado_figure(b, "t")
    said = figure.description
    order = sorted(b.parts, key=lambda p: -p.half_width)
    places = [said.index(f"{p.name} ") for p in order] + [said.index("U95")]
    assert places == sorted(places)
