"""Lean artists draw what Matplotlib's own draw, in fewer pieces, and leave nothing behind."""

import re

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coeflab.report.figures.artists import bare, label, strokes, text_width
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import drawing, legend, panel
from coeflab.report.figures.series import tagged
from coeflab.report.figures.svg import settings, svg_text


def drawn(make):
    with settings():
        figure = drawing()
        make(figure)
        return svg_text(figure, "p", "title", "description")


def test_strokes_are_one_path_with_the_ends_of_each():
    def make(figure):
        axes = bare(figure, (0.0, 0.0, 1.0, 1.0))
        axes.set_xlim(0.0, 340.0)
        axes.set_ylim(336.0, 0.0)
        strokes(axes, ([10.0, 20.0], [10.0, 25.0]), (30.0, [40.0, 50.0]))

    (path,) = re.findall(r'<path d="([^"]*)" clip', drawn(make))
    assert [float(n) for n in re.findall(r"[\d.]+", path)] == [10.0, 30.0, 10.0, 40.0, 20.0, 30.0, 25.0, 50.0]
    assert path.count("M") == 2


def test_a_label_hangs_on_its_point():
    def make(figure):
        label(figure, 0.5, 0.25, "up", "right", rotation=90)

    (element,) = re.findall(r"<text [^>]*>up</text>", drawn(make))
    assert 'x="170"' in element
    assert 'y="252"' in element
    assert "text-anchor: end" in element
    assert "rotate(-90" in element


def test_a_legend_names_every_handle_and_marks_the_tagged():
    def make(figure):
        axes = panel(figure, 34.0, 200.0, across=(0.0, 1.0), up=(0.0, 1.0), name_up="y")
        band = axes.fill_between([0.0, 1.0], 0.0, 1.0, color=COLOURS["band"], label="band")
        line = Line2D([], [], color=COLOURS["a"], marker="o", label="line")
        legend(figure, [tagged(line, "one"), Patch(color=COLOURS["b"], label="patch"), band])

    svg = drawn(make)
    group = svg[svg.index("data-legend") :]
    assert re.findall(r">(line|patch|band)</text>", group) == ["line", "patch", "band"]
    assert re.findall(r'data-swatch="([^"]*)"', group) == ["one", "", ""]
    assert all(f"var(--fig-{name}," in group for name in ("a", "b", "band"))


def test_columns_of_a_legend_do_not_meet():
    def make(figure):
        legend(figure, [Line2D([], [], label=text) for text in ("a rather long name of a form", "short", "third")])

    places = [float(x) for x in re.findall(r'<text [^>]*x="([\d.]+)"', drawn(make))]
    assert places[0] == places[1]
    assert places[2] > places[0] + text_width("a rather long name of a form", 8.75) + 20.0


def test_settings_within_settings_hold_until_the_outer_end():
    before = dict(mpl.rcParams)
    with settings():
        with settings():
            pass
        assert mpl.rcParams["svg.fonttype"] == "none"
    assert dict(mpl.rcParams) == before


def test_text_width_grows_with_size():
    assert np.isclose(text_width("form", 20.0), 2.0 * text_width("form", 10.0), rtol=0.05)
