"""The page's numbers are those of the Python code, edit by edit."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from coeflab.fits.statistics import origin_slope, slope_mixture
from coeflab.motion.manoeuvres import zigzag
from coeflab.motion.marching import Ensemble, march
from coeflab.motion.simulation import determined_until, moved
from coeflab.vehicle.stability import sense, stability
from tests.workbench_page.conftest import SCALING, TABLES, fitted, parameter_file

SLOPE, MOTION, PICTURE = 1e-9, 1e-6, 1e-6
ANSWER = """edits => {
  const b = document.getElementById("bench").bench.local(), campaigns = b.answer(edits), data = document.getElementById("bench").bench.data;
  return {
    rows: Object.values(campaigns).flatMap(c => c.rows.map(r => [data.sweeps[r.index].symbol, r.value, r.u95])),
    indices: data.files.map(f => f.indices.map(i => b.indexOf(i, campaigns))),
  };
}"""
FITTED = """([i, edit]) => {
  const r = document.getElementById("bench").bench.local().fitted(i, edit, true);
  return [r.value, r.fit, r.random, r.curve, r.half, r.removed, r.reason];
}"""
MOVED = """([values, file, which]) => {
  const { data } = document.getElementById("bench").bench, z = data.files[file].zigzags[which];
  const m = zigzagOf(z, values || z.law.coefficient);
  return { time: m.time, state: m.state.map(s => Array.from(s)), figures: m.figures, determined: m.determined === Infinity ? null : m.determined };
}"""


def edits_of(bench, seed: int, parts: bool = False):
    """Random edits by sweep: some points left out, sometimes a largest setting, sometimes fewer parts."""
    rng = np.random.default_rng(seed)
    out = {}
    for i, s in enumerate(bench.sweeps):
        x = np.abs(s["x"])
        limit = float(np.sort(x)[len(x) * 2 // 3]) if rng.random() < 0.4 else None
        without = [p for p in slope_mixture.PARTS if parts and rng.random() < 0.4]
        out[i] = {"limit": limit, "dropped": np.flatnonzero(rng.random(len(x)) < 0.12).tolist(), "without": without}
    return out


def kept(s, edit):
    x = np.abs(s["x"])
    inside = np.ones(len(x), dtype=bool) if edit["limit"] is None else x <= edit["limit"] * 1.02
    inside[edit["dropped"]] = False
    return inside


def close(ours, theirs, within=SLOPE, size=0.0):
    return abs(ours - theirs) <= within * max(abs(theirs), size)


@pytest.mark.parametrize("seeds", [[1], pytest.param(range(2, 12), marks=pytest.mark.slow, id="many")])
def test_slope_and_band_of_any_points_and_parts(page, bench, seeds):
    for seed, (i, s) in product(seeds, enumerate(bench.sweeps)):
        edit = edits_of(bench, seed, parts=True)[i]
        rows = kept(s, edit)
        found = origin_slope.estimate(np.array(s["x"])[rows], np.array(s["y"])[rows], without=tuple(edit["without"]))
        value, u95, _, curve, half, removed, _ = page.evaluate(FITTED, [i, edit])
        assert close(value, found.value, size=found.u95), s["symbol"]
        assert close(u95, found.u95), s["symbol"]
        assert removed == np.flatnonzero(rows)[~found.used].tolist()
        reach = np.abs(np.array(s["x"])[rows]).max() * np.linspace(-1.0, 1.0, len(curve))
        # Between rows many members fit alike, and which of them are among the hundred that are drawn is a matter of rounding.
        measured = [j for j, at in enumerate(reach) if np.min(np.abs(np.array(s["x"])[rows] - at)) < 1e-12]
        mean, band = origin_slope.curve(found, reach[measured])
        assert measured
        np.testing.assert_allclose(np.array(curve)[measured], mean, rtol=0.0, atol=PICTURE * np.abs(mean).max())
        np.testing.assert_allclose(np.array(half)[measured], band, rtol=0.0, atol=PICTURE * np.abs(mean).max())


ESTIMATED = """([x, y, se, odd]) => {
  const f = slopeAtOrigin(document.getElementById("bench").bench.data.constants).estimate(x, y, se, { odd });
  return [f.value, f.u95, f.status, f.removed];
}"""
KINDS = ("stated errors", "wrong point", "one side", "odd by symmetry", "mirrored", "repeated")


@pytest.mark.parametrize("kind", KINDS)
def test_sweeps_of_every_kind(page, kind):
    rng = np.random.default_rng(KINDS.index(kind))
    x, se = np.linspace(-0.3, 0.3, 13), None
    if kind in ("one side", "odd by symmetry"):
        x = np.linspace(0.05, 0.3, 9)
    y = -0.03 * x - 0.1 * x * np.abs(x) + (0.0 if kind == "mirrored" else 1e-4) + 5e-5 * rng.standard_normal(len(x))
    if kind == "stated errors":
        se = rng.uniform(3e-5, 1e-4, len(x))
    if kind == "wrong point":
        y[10] += 3e-3
    if kind == "mirrored":
        x, y = np.concatenate([x[7:], -x[7:]]), np.concatenate([y[7:], -y[7:]])
    if kind == "repeated":
        x, y = np.concatenate([x, x[:4], x[8:]]), np.concatenate([y, y[:4], y[8:] + 1e-4])
    odd = kind == "odd by symmetry"
    found = origin_slope.estimate(x, y, se, odd=odd)
    value, u95, status, removed = page.evaluate(
        ESTIMATED, [x.tolist(), y.tolist(), None if se is None else se.tolist(), odd]
    )
    # Exact mirror images leave no noise to the even part: rows in another order move Python's own value by 4e-8.
    within = 1e-6 if kind == "mirrored" else SLOPE
    assert close(value, found.value, within, found.u95)
    assert close(u95, found.u95, within)
    assert status == found.status.value
    assert (removed == [10]) == (kind == "wrong point")


def refitted(bench, edits):
    """The campaign without the rows that the edits leave out, through the whole of fit, budget and parameter file."""
    gone = {(s["table"], s["component"]): kept(s, edits[i]) for i, s in enumerate(bench.sweeps)}
    tables = []
    for t in TABLES:
        rows = {c: t.forces[c] for c in ("Y", "N")}
        tables.append(replace(t, forces=rows, usable={c: t.usable[c] & gone[t.name, c] for c in rows}))
    fit, _ = fitted(tables)
    return fit, parameter_file([fit], tables)


@pytest.mark.slow
def test_value_u95_and_index_of_the_whole_pipeline(page, bench):
    edits = edits_of(bench, 5)
    fit, file = refitted(bench, edits)
    answer = page.evaluate(ANSWER, {str(i): e for i, e in edits.items()})
    for symbol, value, u95 in answer["rows"]:
        c = fit.coefficients[symbol]
        assert close(value, c.value, size=c.u95), symbol
        assert close(u95, c.u95), symbol
    (now,) = answer["indices"][0]
    (index,) = stability(file)
    assert close(now["value"], index.value)
    assert close(now["u95"], index.result.linear)
    assert now["sense"] == sense(index)


def test_the_page_begins_with_the_study(page, bench, boat):
    answer = page.evaluate(ANSWER, {})
    for symbol, value, u95 in answer["rows"]:
        c = boat.fits[0].coefficients[symbol]
        assert (value, pytest.approx(u95, rel=1e-12)) == (c.value, c.u95)
    (index,) = stability(boat.parameter_files["boat"])
    assert answer["indices"][0][0]["u95"] == pytest.approx(index.result.linear, rel=1e-9)
    untouched = {"limit": None, "dropped": [], "without": []}
    value, fit, *_ = page.evaluate(FITTED, [0, untouched])
    assert close(value, bench.sweeps[0]["value"])
    assert close(fit, bench.sweeps[0]["base"]["fit"])


def test_too_few_settings_are_not_determined(page, bench):
    edit = {"limit": None, "dropped": list(range(2, len(bench.sweeps[0]["x"]))), "without": []}
    value, _, _, _, _, _, reason = page.evaluate(FITTED, [0, edit])
    assert value is None
    assert reason == "2 different settings, at least 3 are needed"
    index = page.evaluate(ANSWER, {"0": edit})["indices"][0][0]
    assert index["value"] is None
    assert index["sense"] == "no value"


@pytest.mark.parametrize(("which", "change"), [(0, 0.8), (1, 1.0)])
def test_zigzag(page, bench, boat, which, change):
    vehicle = moved(boat.parameter_files["boat"], "zigzag")
    z = bench.files[0]["zigzags"][which]
    values = vehicle.law.coefficient.copy()
    values[[i for i, _, _ in z["links"]]] *= change
    options = {"rudder": float(np.radians([10.0, 20.0][which]))}
    marched = march(
        Ensemble(vehicle, values[None, :]), zigzag.plan(vehicle, options), z["step"], kernel="numpy"
    )  # fmt: skip
    motion, member = marched.trajectory(), marched.ensemble.member(0)
    found = page.evaluate(MOVED, [values.tolist(), 0, which])
    state = np.array(found["state"])
    np.testing.assert_allclose(found["time"], motion.time, rtol=MOTION)
    np.testing.assert_allclose(state[:, :3], motion.position, atol=MOTION * SCALING.length)
    np.testing.assert_allclose(state[:, 7:13], motion.velocity, atol=MOTION)
    np.testing.assert_allclose(state[:, 13], motion.heading, atol=MOTION)
    for ours, theirs in zip(found["figures"], zigzag.figures(motion, member, options), strict=True):
        assert (ours["name"], ours["unit"], ours["status"]) == (theirs.name, theirs.unit, theirs.status)
        assert (ours["value"] is None) == (theirs.value is None)
        assert theirs.value is None or close(ours["value"], theirs.value, MOTION)
    until, _ = determined_until(motion, member)
    assert (found["determined"] is None) == np.isinf(until)
