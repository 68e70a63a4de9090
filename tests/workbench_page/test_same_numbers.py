"""The page's numbers are those of the Python code, edit by edit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.motion.ensemble import Ensemble
from coeflab.motion.manoeuvres import zigzag
from coeflab.motion.marching import march
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
MOVED = """([values, file, which]) => {
  const { data } = document.getElementById("bench").bench, z = data.files[file].zigzags[which];
  const m = zigzagOf(z, values || z.law.coefficient);
  return { time: m.time, state: m.state.map(s => Array.from(s)), figures: m.figures, determined: m.determined === Infinity ? null : m.determined };
}"""


def edits_of(bench, seed: int):
    """A choice of points by sweep: up to a smaller setting, or without one point."""
    rng = np.random.default_rng(seed)
    choices = [rng.choice([c for c in s["choices"] if c["value"] is not None]) for s in bench.content()["sweeps"]]
    return {i: {"limit": c["limit"], "dropped": c["dropped"]} for i, c in enumerate(choices)}


def kept(s, edit):
    x = np.abs(s["x"])
    inside = np.ones(len(x), dtype=bool) if edit["limit"] is None else x <= edit["limit"] * 1.02
    if edit["dropped"] is not None:
        inside[edit["dropped"]] = False
    return inside


def close(ours, theirs, within=SLOPE, size=0.0):
    return abs(ours - theirs) <= within * max(abs(theirs), size)


def refitted(bench, edits):
    """The campaign without the rows that the edits leave out, through the whole of fit, budget and parameter file."""
    gone = {(s["table"], s["component"]): kept(s, edits[i]) for i, s in enumerate(bench.sweeps)}
    tables = []
    for t in TABLES:
        rows = {c: t.forces[c] for c in ("Y", "N")}
        tables.append(replace(t, forces=rows, usable={c: t.usable[c] & gone[t.name, c] for c in rows}))
    fit, _ = fitted(tables)
    return fit, parameter_file([fit], tables)


@pytest.mark.parametrize("seed", [5, 6, 7])
def test_value_u95_and_index_of_the_whole_pipeline(page, bench, seed):
    edits = edits_of(bench, seed)
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


def test_a_choice_without_enough_settings_has_no_value(page, bench):
    first = bench.content()["sweeps"][0]["choices"][0]
    assert first["value"] is None
    assert "cannot be separated" in first["reason"]
    index = page.evaluate(ANSWER, {"0": {"limit": first["limit"], "dropped": None}})["indices"][0][0]
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
