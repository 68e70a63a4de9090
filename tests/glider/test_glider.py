"""Cycles of a glider in time settle on its steady glides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.glider.glide import GlideRun, steady_glides
from coeflab.glider.glider import Glider
from coeflab.glider.glider_file import gliders_at
from coeflab.glider.simulators.glider import simulate
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.trajectory import Ended

THAUV = gliders_at(shipped("cfd_data") / "thauv")
(SLOCUM,) = gliders_at(shipped("cfd_data") / "slocum")


def _run(glider: Glider, cycles: int = 1, **options: float) -> GlideRun:
    return GlideRun(glider, simulate(glider, glider.manoeuvre(cycles), options))


@pytest.mark.parametrize("glider", THAUV, ids=lambda g: g.name)
def test_every_phase_settles_on_its_steady_glide(glider: Glider) -> None:
    run = _run(glider)
    assert run.trajectory.ended is Ended.COMPLETE
    for i, row in enumerate(run.ends):
        (steady,) = steady_glides(glider, run.phase_of(i))
        assert run.settled(i)
        assert run.speed[row] == pytest.approx(steady.speed, rel=1e-6)
        assert run.alpha[row] == pytest.approx(steady.alpha, abs=1e-6)
        assert run.theta[row] == pytest.approx(steady.theta, abs=1e-6)
        sinking = (run.depth[row] - run.depth[row - 1]) / (run.time[row] - run.time[row - 1])
        assert sinking == pytest.approx(steady.sinking, rel=1e-5)


def test_leonard_and_gravers_glide() -> None:
    """25 degrees at 0.3 m/s, down to 50 m and up to 5 m, twice."""
    run = _run(SLOCUM, 2)
    assert [run.depth[e] for e in run.ends] == pytest.approx([50.0, 5.0, 50.0, 5.0], abs=1e-6)
    assert [run.trajectory.reached[i] for i in range(4)] == [run.time[e] for e in run.ends]
    for p, sign in zip(SLOCUM.phases, (-1.0, 1.0), strict=True):
        (steady,) = steady_glides(SLOCUM, p)
        assert steady.speed == pytest.approx(0.3, abs=1e-6)
        assert np.degrees(steady.zeta) == pytest.approx(25.0 * sign, abs=1e-4)
        assert steady.stable
    assert run.speed[run.ends[0]] == pytest.approx(0.3, abs=2e-4)


def test_a_climb_mirrors_a_dive_of_a_symmetric_glider() -> None:
    """Exactly so where the engine's lever tilts it; a sliding mass is not its own mirror image while it moves."""
    lever = replace(
        SLOCUM, sliding_mass=replace(SLOCUM.sliding_mass, mass=0.0), mass=replace(SLOCUM.mass, moment_below=4.4),
        engine=replace(SLOCUM.engine, ahead=3.77),
    )  # fmt: skip
    down, up = (
        simulate(lever, Manoeuvre("one", (Phase("p", {"net_mass": m}, 300.0),), np.zeros(6)), {"tolerance": 1e-10})
        for m in (0.0473, -0.0473)
    )
    assert up.position[:, 0] == pytest.approx(down.position[:, 0], abs=1e-6)
    assert up.position[:, 2] == pytest.approx(-down.position[:, 2], abs=1e-6)
    assert up.velocity[:, 2] == pytest.approx(-down.velocity[:, 2], abs=1e-6)
    assert down.position[-1, 2] > 20.0


def test_energy_of_a_whole_dive() -> None:
    """Work of the net weight less work of the drag is the kinetic energy and that of the moments gained."""
    glider = replace(SLOCUM, phases=(SLOCUM.phases[0],))
    start = Phase("dive", {"net_mass": 0.0473, "position": 0.0198}, 200.0)
    t = simulate(
        glider, Manoeuvre("one", (start,), np.zeros(6), orders={"net_mass": 0.0473, "position": 0.0198}),
        {"step": 0.05, "tolerance": 1e-10},
    )  # fmt: skip
    run, body = GlideRun(glider, t), glider.body
    drag = body.polar.drag_at(np.nan_to_num(run.alpha)) * run.speed**3
    moment = body.polar.moment_at(np.nan_to_num(run.alpha)) * run.speed**2 * t.velocity[:, 4]
    u, w, q = t.velocity[:, 0], t.velocity[:, 2], t.velocity[:, 4]
    sliding = body.sliding * ((u + q * body.sliding_below) ** 2 + (w - q * 0.0198) ** 2)
    kinetic = 0.5 * (body.surge * u**2 + body.heave * w**2 + body.inertia * q**2 + sliding)
    ahead, below = body.moments(0.0473, 0.0198)
    potential = ahead * np.sin(run.theta) - below * np.cos(run.theta) - 0.0473 * body.gravity * run.depth
    gained = kinetic[-1] + potential[-1] - kinetic[0] - potential[0]
    assert gained == pytest.approx(np.trapezoid(moment - drag, run.time), abs=2e-4)
    assert abs(gained) > 0.5


def test_the_step_between_rows_does_not_touch_the_motion() -> None:
    coarse, fine = _run(THAUV[1], step=10.0), _run(THAUV[1], step=0.5)
    assert coarse.x[-1] == pytest.approx(fine.x[-1], abs=1e-5)
    assert np.isin(coarse.time, fine.time).all()


def test_engine_and_sliding_mass_keep_to_their_rates() -> None:
    run = _run(THAUV[0])
    rate = np.abs(np.diff(run.trajectory.controls["position"]) / np.diff(run.time))
    assert rate.max() == pytest.approx(0.001, rel=1e-6)
    assert run.trajectory.controls["net_mass"][run.ends[0]] == 0.48302


def test_what_the_polar_does_not_cover_is_flagged() -> None:
    narrow = replace(THAUV[0], polar=replace(THAUV[0].polar, covered=(-0.1, 0.2)))
    run = _run(narrow)
    outside = run.trajectory.outside["alpha"]
    assert 0.0 < outside.mean() < 0.2
    assert any("outside of the angles of attack" in s for s in run.statements)
    assert not _run(THAUV[0]).trajectory.outside
    assert any("does not say which angles" in s for s in _run(THAUV[0]).statements)


def test_without_pitch_damping_thauv_does_not_settle() -> None:
    bare = replace(THAUV[0], polar=replace(THAUV[0].polar, pitch_damping=0.0))
    (steady,) = steady_glides(bare, bare.phases[0])
    assert not steady.stable
    assert not _run(bare, tolerance=1e-6).settled(0)


@pytest.mark.parametrize("inertia", [10.0, 50.0, 200.0])
def test_that_holds_for_any_inertia(inertia: float) -> None:
    bare = replace(
        THAUV[1], polar=replace(THAUV[1].polar, pitch_damping=0.0), mass=replace(THAUV[1].mass, pitch_inertia=inertia)
    )
    assert not any(s.stable for p in bare.phases for s in steady_glides(bare, p))


def test_numbers_that_leave_all_bounds_stop_with_time_and_state() -> None:
    run = _run(replace(THAUV[0], polar=replace(THAUV[0].polar, K_M=1e150)))
    assert run.trajectory.ended is Ended.NOT_FINITE
    assert "in dive, stage 1, after" in run.trajectory.why
    assert np.isfinite(run.trajectory.velocity).all()
    assert run.trajectory.reached == (None,) * 4


@pytest.mark.slow
def test_a_motion_too_stiff_keeps_what_came_before() -> None:
    run = _run(replace(THAUV[0], polar=replace(THAUV[0].polar, K_M=1e5)))
    assert run.trajectory.ended is Ended.STEP_TOO_SMALL
    assert "too stiff or too fast" in run.trajectory.why
    assert 5.0 < run.time[-1] < 30.0
    assert any("ended early" in s for s in run.statements)


def test_a_depth_that_is_not_met_and_a_surface_that_is_not_known() -> None:
    phases = (replace(SLOCUM.phases[0], lasts=30.0), replace(SLOCUM.phases[1], until_depth=-20.0))
    run = _run(replace(SLOCUM, phases=phases))
    said = " ".join(run.statements)
    assert "Not met within the time of the phase: the depth of dive." in said
    assert "20.0 m above the surface" in said


@pytest.mark.parametrize(
    ("manoeuvre", "options", "words"),
    [
        (Manoeuvre("m", (Phase("p", {"dr": 0.1}, 1.0),), np.zeros(6)), {}, '"dr"'),
        (Manoeuvre("m", (Phase("p", {}, 1.0, Until("heading", True, 1.0)),), np.zeros(6)), {}, "until heading"),
        (Manoeuvre("m", (Phase("p", {}, 1.0),), np.array([0, 1.0, 0, 0, 0, 0])), {}, "vertical plane"),
        (Manoeuvre("m", (Phase("p", {}, 1e7),), np.zeros(6)), {"step": 0.01}, "at most 1,000,000"),
        (Manoeuvre("m", (Phase("p", {}, 1.0),), np.zeros(6)), {"step": 0.0}, "glider.step"),
    ],
)
def test_what_it_cannot_fly(manoeuvre: Manoeuvre, options: dict[str, float], words: str) -> None:
    with pytest.raises(InputError, match=words):
        simulate(SLOCUM, manoeuvre, options)


def test_it_starts_where_the_manoeuvre_says() -> None:
    half = 0.15
    start = Manoeuvre(
        "m", (Phase("p", {}, 5.0),), np.array([0.4, 0.0, 0.02, 0.0, 0.1, 0.0]), np.array([np.cos(half), 0.0, np.sin(half), 0.0]),
        {"net_mass": 0.05, "position": 0.02},
    )  # fmt: skip
    t = simulate(SLOCUM, start, {})
    assert t.velocity[0] == pytest.approx([0.4, 0.0, 0.02, 0.0, 0.1, 0.0], abs=1e-12)
    assert t.angles[0, 1] == pytest.approx(0.3)
    assert set(t.controls["net_mass"]) == {0.05}
