"""Figures and tables of glides."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.glider import tables as glide_tables
from coeflab.glider.figures import curve, motion_figure, polar_figure
from coeflab.glider.glide import GlideRun, steady_glides
from coeflab.glider.glider_file import gliders_at
from coeflab.glider.simulators.glider import simulate
from coeflab.report.figures.panel import ticks

(SLOCUM,) = gliders_at(shipped("cfd_data") / "slocum")


@pytest.fixture(scope="module")
def run() -> GlideRun:
    return GlideRun(SLOCUM, simulate(SLOCUM, SLOCUM.manoeuvre(1), {"step": 5.0}))


def test_depth_grows_downward(run: GlideRun) -> None:
    lines = re.findall(r'y="([\d.]+)"[^>]*>([^<]*)\n?<', motion_figure([run], "m").svg)
    depth = next(i for i, (_, text) in enumerate(lines) if text.startswith("depth"))
    ticks_of_depth = {text: float(y) for y, text in lines[depth - 3 : depth]}
    assert ticks_of_depth["0"] < ticks_of_depth["20"] < ticks_of_depth["40"]


def test_falling_ranges_have_the_same_ticks() -> None:
    assert list(ticks((100.0, 0.0), 5)) == list(ticks((0.0, 100.0), 5))


def test_equal_input_gives_equal_bytes(run: GlideRun) -> None:
    assert motion_figure([run], "m").svg == motion_figure([run], "m").svg
    steady = [s for p in SLOCUM.phases for s in steady_glides(SLOCUM, p)]
    figure = polar_figure(SLOCUM, steady, "p")
    assert figure.svg == polar_figure(SLOCUM, steady, "p").svg
    assert "2 steady glides marked" in figure.description


def test_the_polar_goes_through_its_steady_glides() -> None:
    alpha, zeta, speed = curve(SLOCUM, SLOCUM.phases[0].net_mass)
    (steady,) = steady_glides(SLOCUM, SLOCUM.phases[0])
    order = np.argsort(alpha)
    assert np.interp(steady.alpha, alpha[order], speed[order]) == pytest.approx(steady.speed, abs=1e-4)
    assert np.interp(steady.alpha, alpha[order], zeta[order]) == pytest.approx(steady.zeta, abs=2e-3)


def test_tables(run: GlideRun) -> None:
    steady = [s for p in SLOCUM.phases for s in steady_glides(SLOCUM, p)]
    table = glide_tables.steady(SLOCUM, steady)
    assert [r[0] for r in table.rows] == ["dive", "climb"]
    assert table.rows[0][3:6] == ("0.3000", "2.023", "-25.000")
    assert "-6.31 and 6.31 deg" in table.notes[0]
    ends = glide_tables.phases(run)
    assert [(r[0], r[2], r[3], r[7]) for r in ends.rows] == [
        ("dive", "depth", "50.00", "yes"),
        ("climb", "depth", "5.00", "yes"),
    ]
    assert len(table.notes) == 1
    twice = replace(SLOCUM, phases=(*SLOCUM.phases, replace(SLOCUM.phases[0], name="dive again")))
    assert len(glide_tables.steady(twice, steady).notes) == 1
    assert "no steady glide ahead" in " ".join(glide_tables.steady(SLOCUM, []).notes)


def test_a_neutral_phase_has_no_steady_glide() -> None:
    neutral = replace(SLOCUM, phases=(replace(SLOCUM.phases[0], net_mass=0.0, until_depth=None, lasts=20.0),))
    assert steady_glides(neutral, neutral.phases[0]) == ()
    run = GlideRun(neutral, simulate(neutral, neutral.manoeuvre(1), {}))
    assert run.nearest(0) is None
    assert not run.settled(0)
    assert glide_tables.phases(run).rows[0][6] == "-"


def test_figures_tell_speeds_and_steady_glides(run: GlideRun) -> None:
    panels = motion_figure([run], "m").panels
    assert [(p.name_up, p.unit_up) for p in panels] == [("V", "m/s"), ("x", "m"), ("depth", "m"), ("alpha", "deg")]
    assert panels[2].up[0] > panels[2].up[1]
    (depth,) = panels[2].series
    assert depth.y == pytest.approx(np.interp(depth.x, run.time, run.depth), abs=1e-3)
    steady = [s for p in SLOCUM.phases for s in steady_glides(SLOCUM, p)]
    upper, _ = polar_figure(SLOCUM, steady, "p").panels
    dots = next(s for s in upper.series if s.key == "dots")
    assert dots.y == pytest.approx([s.speed for s in steady], rel=1e-5)
