"""The page that plays a vehicle with an arm, in a real browser, and the pictures that belong to it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.arm.figures import (
    FRAMES,
    ArmMotion,
    animation,
    frames_figure,
    hull_of,
    joint_plots,
    parts_at,
    path_figure,
    poses_figure,
)
from coeflab.arm.motion import at_rest
from coeflab.bodies.readers.particulars import read as read_other
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.published.urv.model import hull, wet
from coeflab.report.figures.palette import COLOURS


@pytest.fixture(scope="module")
def motion() -> ArmMotion:
    """A made-up one: the shoulder turns while the vehicle drifts north."""
    chain, time = wet(), np.linspace(0.0, 0.4, 9)
    states = np.array([at_rest(chain) for _ in time])
    states[:, 0], states[:, 7] = time, 0.3 + time
    return ArmMotion(chain, hull(), time, states)


@pytest.fixture(scope="module")
def address(motion: ArmMotion, tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("arm") / "motion.html"
    path.write_bytes(animation(motion, "A <b>made-up</b> motion", 'The shoulder "turns" & drifts.'))
    return path.as_uri()


def data_of(page: bytes) -> dict[str, Any]:
    text = page.decode()
    return dict(json.loads(text.partition('id="data">')[2].partition("</script>")[0]))


def test_equal_input_gives_an_equal_page_that_needs_nothing_else(motion: ArmMotion) -> None:
    page = animation(motion, "t", "s")
    assert page == animation(motion, "t", "s")
    assert b"http" not in page
    assert b"@@" not in page
    long = ArmMotion(motion.chain, motion.hull, np.arange(1000.0), np.repeat(motion.states[:1], 1000, axis=0))
    few = data_of(animation(long, "t", "s"))
    assert len(few["time"]) == len(few["poses"]) == len(few["ends"]) == FRAMES
    assert (few["time"][0], few["time"][-1]) == (0.0, 999.0)


def test_what_the_page_draws_is_where_the_equations_have_it(motion: ArmMotion) -> None:
    data = data_of(animation(motion, "t", "s"))
    assert np.array(data["ends"]) == pytest.approx(motion.ends, abs=1e-4)
    last = data["poses"][-1]
    assert last[0][9:] == pytest.approx([0.4, 0.0, 0.0])
    assert np.array(last[1][9:]) == pytest.approx(parts_at(motion, 8).parts[1].centre, abs=1e-4)
    facets = np.array(data["bodies"][0]["facets"])
    assert np.abs(facets).max(axis=(0, 1)) == pytest.approx([1.0, 0.4, 0.4])
    outward = np.sum(np.array(data["bodies"][0]["normals"]) * facets.mean(axis=1), axis=1)
    assert (outward > 0.0).all()


def test_it_plays_once_and_stops(visit: Callable[..., Any], address: str) -> None:
    page = visit(address)
    assert page.inner_text("h1") == "A <b>made-up</b> motion"
    page.wait_for_function("document.getElementById('now').textContent === '0.40 s'")
    page.wait_for_function("document.getElementById('play').textContent === 'Play'")
    assert (page.heard, page.fetched) == ([], [address])
    before = page.evaluate("document.getElementById('picture').toDataURL()")
    page.locator("#azimuth").fill("-40")
    assert page.evaluate("document.getElementById('picture').toDataURL()") != before


def test_it_stands_still_where_less_motion_is_asked_for_and_axe_finds_nothing(
    visit: Callable[..., Any], address: str
) -> None:
    from axe_playwright_python.sync_playwright import Axe

    page = visit(address, reduced_motion="reduce")
    assert (page.inner_text("#play"), page.inner_text("#now")) == ("Play", "0.00 s")
    page.locator("#time").fill("4")
    assert page.inner_text("#now") == "0.20 s"
    assert [v["id"] for v in Axe().run(page).response["violations"]] == []


def test_pictures_name_what_they_show(motion: ArmMotion) -> None:
    frames = frames_figure(motion, "frames", "caption")
    for name in ("x₀", "z₀", "y₁", "x₃", "c₀", "north", "east", "down"):
        assert f">{name}<" in frames.svg
    poses = poses_figure(motion, "poses", "title", "caption")
    assert poses.svg == poses_figure(motion, "poses", "title", "caption").svg
    assert "0.2 s" in poses.description


def test_a_body_without_an_arm_has_no_hull_for_these_pictures() -> None:
    with pytest.raises(InputError, match="a vehicle with an arm"):
        hull_of(read_other(Path(str(shipped("geometry"))) / "suboff" / "body.toml"))


@pytest.mark.parametrize(("size", "seen"), [(3.0, False), (0.01, True)])
def test_a_link_inside_the_hull_is_not_painted_over_it(motion: ArmMotion, size: float, seen: bool) -> None:
    hidden = ArmMotion(motion.chain, np.full(3, size), motion.time, motion.states)
    assert (COLOURS["a"] in poses_figure(hidden, "poses", "title", "caption").svg) is seen


def test_slides_have_panels_of_their_own(motion: ArmMotion) -> None:
    turning = motion.chain.joints[0]
    sliding = replace(turning, name="slide", kind="prismatic")
    plots = joint_plots([turning, sliding], np.arange(2.0), np.full((2, 2), 0.1), np.full((2, 2), 7.0))
    assert [p.name_up for p in plots] == ["angle  [deg]", "torque  [N m]", "travel  [mm]", "force  [N]"]
    assert [[t.name for t in p.traces] for p in plots] == [["shoulder"], ["shoulder"], ["slide"], ["slide"]]
    assert plots[2].traces[0].y[0] == pytest.approx(100.0)
    assert [p.is_scaled for p in plots] == [False, False, False, True]


def test_down_is_drawn_downward() -> None:
    sinking = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 5.0]])
    level, upright = path_figure(sinking, None, "path", "title", "caption").panels
    assert (level.name_up, upright.name_up, upright.unit_up) == ("east", "down", "m")
    assert level.up[0] < level.up[1]
    assert upright.up == pytest.approx((5.4, -0.4))


def test_names_of_axes_do_not_overlap(motion: ArmMotion) -> None:
    svg = frames_figure(motion, "frames", "caption").svg
    places = re.findall(r"<text [^>]*?translate\(([\d.]+) ([\d.]+)\)[^>]*>[xyzc][₀-₉]<", svg)
    places = places or re.findall(r'<text [^>]*?x="([\d.]+)" y="([\d.]+)"[^>]*>[xyzc][₀-₉]<', svg)
    at = np.array(places, dtype=float)
    assert len(at) > 8
    apart = np.abs(at[:, None] - at[None])[np.triu_indices(len(at), 1)]
    assert ((apart[:, 0] >= 8.0) | (apart[:, 1] >= 7.0)).all()
