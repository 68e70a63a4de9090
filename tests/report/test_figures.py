from __future__ import annotations

import re
from xml.etree import ElementTree as ET

import matplotlib as mpl
import numpy as np
import pytest

from coeflab.report.figures.estimator import estimator_figure
from coeflab.report.figures.palette import COLOURS, power_of_ten
from coeflab.report.figures.panel import drawing, limits, panel, tick_texts, ticks
from coeflab.report.figures.series import on_axis
from coeflab.report.figures.sweep import at_rest, sweep_figure
from tests.report.studies import FEW, FULL, HALF, HOSTILE, small_study

SVG = "{http://www.w3.org/2000/svg}"


def both(study, prefix="f"):
    for i, sweep in enumerate(study.fits[0].sweeps):
        yield sweep_figure(sweep, f"{prefix}{i}-data")
        yield estimator_figure(sweep, study.comparisons, f"{prefix}{i}-estimators")


@pytest.mark.parametrize("angles", [FULL, HALF, FEW, [3.0], [-4.0, -2.0, 0.0]])
@pytest.mark.parametrize("errors", [False, True])
def test_every_sweep_draws_well_formed_svg_with_title_and_description(angles, errors):
    for figure in both(small_study(angles, errors=errors, published=True)):
        root = ET.fromstring(figure.svg)
        assert root.tag == f"{SVG}svg"
        assert "width" not in root.attrib
        assert root.find(f"{SVG}title").text
        assert root.find(f"{SVG}desc").text
        assert "nan" not in re.sub(r"<(title|desc).*?</\1>", "", figure.svg).lower()


def test_equal_sweeps_give_equal_bytes_and_leave_the_settings_of_the_user_alone():
    before = dict(mpl.rcParams)
    with mpl.rc_context({"font.size": 30.0, "lines.linewidth": 9.0}):
        first = [f.svg for f in both(small_study(FULL))]
    assert first == [f.svg for f in both(small_study(FULL))]
    assert dict(mpl.rcParams) == before


def test_drawings_on_one_page_share_no_identifier():
    found = [i for f in both(small_study(FULL)) for i in re.findall(r'\bid="([^"]+)"', f.svg)]
    assert len(found) == len(set(found))


def test_all_references_inside_a_drawing_resolve():
    for figure in both(small_study(FULL)):
        known = set(re.findall(r'\bid="([^"]+)"', figure.svg))
        assert set(re.findall(r'href="#([^"]+)"|url\(#([^)]+)\)', figure.svg))
        assert all((a or b) in known for a, b in re.findall(r'href="#([^"]+)"|url\(#([^)]+)\)', figure.svg))


def test_every_colour_can_be_set_by_the_page():
    for figure in both(small_study(FULL, published=True)):
        bare = re.sub(r"var\(--fig-\w+, #[0-9a-f]{6}\)", "", figure.svg)
        assert not re.search(r"#[0-9a-f]{6}\b", bare)
        assert set(re.findall(r"--fig-(\w+)", figure.svg)) <= set(COLOURS)


def test_names_of_users_are_text_in_a_drawing():
    for figure in both(small_study(FULL, named=HOSTILE, published=True)):
        ET.fromstring(figure.svg)
        assert "<script" not in figure.svg


def test_points_left_out_are_named_in_the_legend():
    figure = next(both(small_study(FULL)))
    assert "left out (1)" in figure.svg


def test_published_values_are_a_marked_line():
    assert "published" in list(both(small_study(FULL, published=True)))[1].svg
    assert ">published<" not in list(both(small_study(FULL)))[1].svg


def test_the_tangent_has_the_recommended_slope_and_half_width():
    sweep = small_study(FULL).fits[0].sweep("Yv")
    x = np.array([0.0, 0.1])
    y, half = at_rest(sweep, x)
    assert (y[1] - y[0]) / 0.1 == pytest.approx(sweep.value)
    assert half == pytest.approx([0.0, 0.1 * sweep.u95])


def test_sideslip_is_shown_in_degrees():
    sweep = small_study(FULL).fits[0].sweep("Yv")
    assert on_axis(sweep, np.sin(np.radians([-12.0, 8.0]))) == pytest.approx([-12.0, 8.0])


def test_axis_numbers():
    assert power_of_ten(0.012) == (1e3, " × 10³")
    assert power_of_ten(2e-5)[0] == 1e6
    assert power_of_ten(0.0) == (1.0, "")
    assert power_of_ten(float("nan")) == (1.0, "")
    assert tick_texts(ticks((-0.3, 1.1), 5)) == ["0.0", "0.5", "1.0"]
    assert tick_texts(np.array([-10.0, 0.0, 10.0])) == ["−10", "0", "10"]


@pytest.mark.parametrize("value", [0.0, 5e-324, 1e-20, 0.08, -3.0, 1e6, 1e20])
def test_a_constant_gets_an_axis_with_ticks(value: float) -> None:
    """Also where it differs by rounding: an axis of 1e-16 m has no ticks."""
    values = value * (1.0 + np.array([0.0, 2.2e-16, -1.1e-16]))
    found = limits(values, 0.08)
    assert found is not None
    low, high = found
    assert low < values.min() <= values.max() < high
    assert len(ticks(found, 5)) >= 2
    panel(drawing(), 40.0, 100.0, across=found, up=found, name_up="east  [m]", name_across="down  [m]")


def test_a_small_change_about_a_large_value_is_shown() -> None:
    low, high = limits(np.array([1e6, 1e6 + 1e-3]), 0.1) or (0.0, 0.0)
    assert high - low == pytest.approx(1.2e-3, rel=1e-5)
