"""What every exporter to a simulator keeps, shown on the SUBOFF study's own parameter files; a new target is taken in by itself."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import cast

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.formats import EXPORTERS, SimulatorExporter, SteeredExporter
from coeflab.formats import loss as losses
from coeflab.formats.export import export
from coeflab.formats.loss import DEFLECTED, rare_states
from coeflab.law.force_law import CONTROLS, ForceLaw
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law, steered_terms
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats.files import HOSTILE, slopes_alone

TARGETS = [n for n in EXPORTERS.names() if isinstance(EXPORTERS.load(n), SimulatorExporter)]
BODIES = ["suboff_fully_appended", "suboff_bare_hull"]
BETA = 0.15
ANY = np.random.default_rng(8).normal(size=(7, 6))
each_target = pytest.mark.parametrize("target", TARGETS)
each_body = pytest.mark.parametrize("body", BODIES)


def plugin(target: str) -> SimulatorExporter:
    return cast("SimulatorExporter", EXPORTERS.load(target))


def file(suboff: Study, body: str = BODIES[0]) -> ParameterFile:
    return suboff.parameter_files[body]


def test_the_simulators_are_here() -> None:
    known = {
        "c",
        "fmi",
        "gazebo",
        "holoocean",
        "mss",
        "mujoco",
        "python_vehicle_simulator",
        "stonefish",
        "uuv_simulator",
        "xdyn",
    }
    assert known <= set(TARGETS)


def in_drift(target: str, given: ParameterFile, beta: float) -> tuple[float, float, float]:
    """Yaw moments odd in steady drift: by the target's own law, as measured, and of the ideal fluid alone; N m."""
    speed, to, nv = given.conditions.speed, plugin(target), given.coefficient("Nv")
    u, v = speed * np.cos(beta), speed * np.sin(beta)
    drifts = np.array([[u, v, 0.0, 0.0, 0.0, 0.0], [u, -v, 0.0, 0.0, 0.0, 0.0]])
    moments = to.force(to.render(given), drifts)[:, 5]
    scale = 0.5 * given.conditions.density * given.scaling.length**3 * speed * v
    return float(moments[0] - moments[1]) / 2.0, float(nv.value * scale), float(nv.potential * scale)


@each_target
@each_body
def test_the_munk_moment_is_counted_once(suboff: Study, target: str, body: str) -> None:
    """The yaw moment in steady drift is the measured one, but for u where the target has it in the place of U; or the target
    says that it holds Nv at straight motion alone, or not at all, and then has at most one Munk moment.
    """
    given, to = slopes_alone(file(suboff, body)), plugin(target)
    found, measured, munk = in_drift(target, given, BETA)
    assert abs(munk) > 1000.0
    assert abs(found - (measured + munk)) > 0.8 * abs(munk)
    if "Nv" in to.not_held(given):
        assert abs(found) <= max(abs(measured), abs(munk)) * (1.0 + 1e-6)
        return
    assert abs(found - (measured - munk)) > 0.8 * abs(munk)
    if any("met at straight motion" in c for c in to.changes(given)):
        found, measured, _ = in_drift(target, given, 1e-4)
        assert found == pytest.approx(measured, rel=1e-5)
    else:
        assert abs(found - measured) <= (1.0 - np.cos(BETA)) * abs(measured) * (1.0 + 1e-6)


@each_target
@pytest.mark.parametrize("name", HOSTILE)
def test_names_that_hurt(suboff: Study, target: str, name: str) -> None:
    to, given = plugin(target), file(suboff, BODIES[1])
    rendered = to.render(given.model_copy(update={"name": name, "body": name}))
    for written in rendered:
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,62}\.[a-z]{1,4}", written, re.ASCII)
    np.testing.assert_array_equal(to.force(rendered, ANY), to.force(to.render(given), ANY))


@each_target
@each_body
def test_the_same_bytes_twice(suboff: Study, target: str, body: str) -> None:
    given = file(suboff, body)
    again = ParameterFile.model_validate_json(given.model_dump_json())
    assert dict(plugin(target).render(again)) == dict(plugin(target).render(given))


def to_force(target: str, files: Mapping[str, bytes], nu: Array) -> Array:
    """The target's force, no control deflected."""
    return np.asarray(plugin(target).force(files, nu))


def both_forces(target: str, given: ParameterFile, files: Mapping[str, bytes], nu: Array) -> tuple[Array, Array]:
    """The target's and the file's; where the target holds controls, each state again with each of them to either side."""
    to, turned = plugin(target), steered_terms(given)
    names = [n for n in CONTROLS if any(n in t.variables for t in turned)]
    if not names or not isinstance(to, SteeredExporter):
        return to.force(files, nu), force_law(given).force(nu)
    rows = [np.zeros(3)]
    for n in names:
        data = [abs(x) for c in given.offered if c.variable == n for x in (c.low, c.high)]
        side = np.eye(3)[CONTROLS.index(n)] * max(data, default=DEFLECTED)
        rows += [-side, side]
    states, controls = np.tile(nu, (len(rows), 1)), np.repeat(rows, len(nu), axis=0)
    ours = force_law(given).force(states) + ForceLaw(turned, np.zeros((6, 6, 6))).force(states, controls)
    return to.steered_force(files, states, controls), ours


@pytest.mark.usefixtures("few_states")
@each_target
@each_body
def test_the_loss_report_is_there_and_true(suboff: Study, target: str, body: str) -> None:
    """Worst differences computed once more, from the files alone; lossless only if nothing is missing and nothing differs."""
    given = file(suboff, body)
    made = export(given, target)
    loss = made.loss
    nu, grid = losses.covered_grid(given)
    files = {n: c for n, c in made.files.items() if not n.endswith(".loss.txt")}
    theirs, ours = both_forces(target, given, files, nu)
    apart = np.abs(theirs - ours)
    whole = np.abs(ours).max(axis=0)
    rounding = 1e-14 * whole.max()  # the law sums controls and the rest at once
    np.testing.assert_allclose(loss.worst, apart.max(axis=0), rtol=1e-12, atol=rounding)
    np.testing.assert_allclose(loss.rms, np.sqrt((apart**2).mean(axis=0)), rtol=1e-12, atol=rounding)
    close = bool(np.all(apart.max(axis=0)[whole > 1e-6] <= 1e-9 * whole[whole > 1e-6]))
    rare = rare_states(given)
    far, size = (
        np.abs(to_force(target, files, rare) - force_law(given).force(rare)),
        np.abs(force_law(given).force(rare)),
    )
    close &= bool(np.all(far.max(axis=0) <= 1e-9 * np.maximum(size.max(axis=0), 1e-6 * size.max())))
    assert loss.lossless == (close and not loss.not_held and not loss.lost)
    text = made.files[f"{body}.{target}.loss.txt"].decode()
    assert grid in text
    for said in (*loss.not_held, *map(str, loss.lost), *loss.changes, *loss.controls):
        assert said in text
    assert loss.changes
    assert ("This export is not lossless" in text) != loss.lossless


@each_target
def test_what_is_not_held_is_a_term_of_the_file_or_said_in_words(suboff: Study, target: str) -> None:
    given = file(suboff)
    terms = {c.symbol.removesuffix("'") for c in given.coefficients}
    for said in plugin(target).not_held(given):
        assert said in terms or " " in said
