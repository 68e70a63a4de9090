"""Figures of fitted models: which model gets which, what stands in them, equal bytes for equal models."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.fits import FITS
from coeflab.report.figures.law_along import along
from coeflab.report.figures.model import distinct, model_figures
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.slices import slices_of
from coeflab.report.figures.surface import is_surface
from coeflab.report.figures.svg_file import sheet
from coeflab.report.figures.variables import (
    axis_name,
    band_in_words,
    domain_in_words,
    law_in_words,
    moving,
    scale_of,
    scatter_in_words,
)
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.report.studies import LENGTH

SVG = "{http://www.w3.org/2000/svg}"
POLYNOMIAL = {"variable": "v", "degree": 5, "responses": "Y"}
CASES = [
    ("suboff_roddy_2", "polynomial", tuple(POLYNOMIAL.items()), ["curve"]),
    ("thauv_case_01_synthetic", "glide_polar", (), ["curve"]),
    ("huuv_elevator_synthetic", "control_surface", (), ["curve"]),
    ("flyingfish_water_synthetic", "linear_quadratic_damping", (), ["curve"]),
    ("huuv_synthetic", "surface", (("degree", 3),), ["surface", "slices", "residuals"]),
    ("suboff_cfd_barehull", "manoeuvring_model", (), ["along", "residuals"]),
]


@cache
def models(campaign, fit, options=()):
    tables = read_tables(PlannedTable(shipped("cfd_data") / campaign, (), {}))
    return FITS.load(fit).fit(tables, LENGTH, dict(options)).models


def words(svg):
    return ["".join(t.itertext()) for t in ET.fromstring(svg).iter(f"{SVG}text")]


@pytest.mark.parametrize(("campaign", "fit", "options", "kinds"), CASES, ids=[c[1] for c in CASES])
def test_every_fit_has_its_pictures(campaign, fit, options, kinds):
    m = distinct(models(campaign, fit, options))[-1]
    made = model_figures(m, "m")
    assert [f.anchor for f in made] == [f"m-{k}" for k in kinds]
    assert [f.svg for f in made] == [f.svg for f in model_figures(m, "m")]
    for figure in made:
        root = ET.fromstring(figure.svg)
        assert root.find(f"{SVG}title").text == figure.title
        assert root.find(f"{SVG}desc").text == figure.description
        assert figure.caption.endswith(".")
        assert "nan" not in figure.svg + figure.caption
        bare = re.sub(r"var\(--fig-\w+, #[0-9a-f]{6}\)", "", figure.svg)
        assert not re.search(r"#[0-9a-f]{6}\b", bare)
        assert set(re.findall(r"--fig-(\w+)", figure.svg)) <= set(COLOURS)
        named = [t for t in words(figure.svg) if "[" in t]
        assert len(named) >= 2, "every axis but that of residuals names its unit"


def test_angles_are_drawn_in_degrees_and_primes_without_unit():
    surface = models("huuv_synthetic", "surface", (("degree", 3),))[0]
    assert axis_name("alpha", surface) == "angle of attack alpha  [deg]"
    assert domain_in_words(surface) == "alpha -25.0 .. 25.0 deg; beta -25.0 .. 25.0 deg"
    line = models("suboff_roddy_2", "polynomial", tuple(POLYNOMIAL.items()))[0]
    assert axis_name("v", line) == "sway velocity v' = v/U  [-]"
    assert domain_in_words(line) == "v' -0.310 .. 0.232"
    damping = models("flyingfish_water_synthetic", "linear_quadratic_damping")
    assert [domain_in_words(m).split(" ")[-1] for m in damping] == ["m/s"] * 3 + ["rad/s"] * 3
    assert "20" in words(model_figures(surface, "m")[0].svg)


def test_the_band_and_what_lies_beyond_are_named():
    m = models("suboff_roddy_2", "polynomial", tuple(POLYNOMIAL.items()))[0]
    figure = model_figures(m, "m")[0]
    assert {"95 % band of the mean", "beyond the data", "rejected or doubtful (1)"} <= set(words(figure.svg))
    assert "a reader is to refuse" in figure.caption
    assert "the scatter of the points, what they show that the form leaves out, angle" in band_in_words(
        replace(m, shared={"angle": np.zeros(6)})
    )
    assert "too narrow" in band_in_words(replace(m, post_selection=True))


def test_without_covariance_there_is_no_band():
    m = models("suboff_roddy_2", "polynomial", tuple(POLYNOMIAL.items()))[0]
    bare = replace(m, fit=replace(m.fit, half_width=np.full(6, np.nan)))
    figure = model_figures(bare, "m")[0]
    assert "95 % band of the mean" not in words(figure.svg)
    assert "no covariance" in figure.caption


def test_two_writings_of_one_fit_are_drawn_once_in_the_fewest_variables():
    tied = models("huuv_elevator_synthetic", "control_surface")
    assert len(tied) == 6
    assert [moving(m) for m in distinct(tied)] == [("e",)] * 3
    polar = models("thauv_case_01_synthetic", "glide_polar")
    assert distinct(polar) == polar[:3]
    surface = models("huuv_synthetic", "surface", (("degree", 3),))
    assert distinct(surface) == surface


def test_a_surface_needs_rows_in_which_both_variables_move():
    assert all(is_surface(m) for m in models("huuv_synthetic", "surface", (("degree", 3),)))
    cross = models("suboff_cfd_barehull", "manoeuvring_model")[1]
    assert moving(cross) == ("v", "r")
    assert not is_surface(cross)
    assert along(cross) == ("v", "r")


def test_slices_stand_at_values_of_the_grid():
    m = models("huuv_synthetic", "surface", (("degree", 3),))[0]
    assert np.degrees(slices_of(m)) == pytest.approx([0.0, 7.5, 17.5, 25.0], abs=0.01)
    assert "β = 17.5°" in words(model_figures(m, "m")[1].svg)
    scattered = replace(m, x={**m.x, "beta": m.x["beta"] + 1e-2 * np.arange(m.n_points) / m.n_points})
    assert slices_of(scattered) == ()


def test_contours_carry_their_values():
    m = models("huuv_synthetic", "surface", (("degree", 3),))[1]
    figure = model_figures(m, "m")[0]
    low, high = float(m.y.min()) * 1e3, float(m.y.max()) * 1e3
    found = [float(t.replace("−", "-")) for t in re.findall(r"lines from (\S+) to (\S+)\.", figure.description)[0]]
    assert low < found[0] < found[1] < high
    assert {t.replace("−", "-") for t in words(figure.svg)} >= {f"{v:g}" for v in found}


def test_words_below_the_figures():
    m = models("flyingfish_water_synthetic", "linear_quadratic_damping")[0]
    assert law_in_words(m) == "X = Xu u + Xu|u| u |u|"
    assert law_in_words(m, 1) == m.form
    assert " N rms" in scatter_in_words(m)
    assert scale_of(np.array([-0.4])) == (1.0, "")
    assert scale_of(np.array([0.04])) == (1e3, " × 10³")


def test_a_sheet_holds_all_figures_in_plain_colours():
    rows = [model_figures(m, f"m{i}") for i, m in enumerate(models("huuv_synthetic", "surface", (("degree", 3),))[:2])]
    content = sheet(rows)
    root = ET.fromstring(content)
    assert len(root.findall(f"{SVG}svg")) == 6
    assert "var(" not in content.decode()
    identifiers = re.findall(r' id="([^"]+)"', content.decode())
    assert len(identifiers) == len(set(identifiers))
    singles = sheet([row[:1] for row in rows])
    assert len({s.get("y") for s in ET.fromstring(singles).findall(f"{SVG}svg")}) == 1
