"""A box as a mesh: one added mass in estimates, parameter file and export, and no term that its symmetry forbids."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from coeflab.bodies.simplify.source import subject
from coeflab.core.finding import Severity
from coeflab.study.checks import ideal_fluid
from coeflab.study.estimated_vehicle import asked, from_shape
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile

SIZE = (0.6, 0.45, 0.35)


@pytest.fixture(scope="module")
def rov(tmp_path_factory: pytest.TempPathFactory) -> Study:
    path = tmp_path_factory.mktemp("rov") / "box.stl"
    trimesh.creation.box(SIZE).export(path)
    body = subject(str(path), "m", "FLU")
    plan, stated = asked(body, mass="95 kg", method="panel")
    return from_shape(plan, body, stated)


def file_of(study: Study) -> ParameterFile:
    return next(iter(study.parameter_files.values()))


@pytest.mark.slow
def test_the_ideal_fluid_of_a_box_is_its_added_mass(rov: Study) -> None:
    p = file_of(rov)
    m = np.diag(p.added_mass.matrix)
    half, length = 0.5 * p.conditions.density, p.scaling.length
    for symbol, expected in (
        ("Yur'", -m[0] / (half * length**3)), ("Zuq'", m[0] / (half * length**3)),
        ("Xvr'", m[1] / (half * length**3)), ("Xwq'", -m[2] / (half * length**3)),
        ("Nuv'", (m[0] - m[1]) / (half * length**3)), ("Muw'", (m[2] - m[0]) / (half * length**3)),
    ):  # fmt: skip
        c = p.coefficient(symbol)
        assert c.value == pytest.approx(expected, rel=1e-8), symbol
        assert c.potential == pytest.approx(expected, rel=1e-8), symbol


@pytest.mark.slow
def test_a_box_mesh_has_no_term_that_its_symmetry_forbids(rov: Study) -> None:
    p = file_of(rov)
    for symbol in ("Nv|v|", "Mw|w|", "Y|v|r", "Z|w|q", "Nv", "Mw", "Yr", "Zq", "M0", "Z0", "Kv"):
        assert p.coefficient(symbol) is None, symbol


@pytest.mark.slow
def test_values_that_leave_their_potential_part_are_found(rov: Study) -> None:
    (found,) = ideal_fluid.check(rov)
    assert found.severity is Severity.PASS
    p = file_of(rov)
    wrong = tuple(replace(c, value=0.5 * c.value) if c.symbol == "Yur'" and c.value else c for c in p.coefficients)
    shares = {**rov.shape.estimates.shares} if rov.shape else {}
    shares["Yur"] = {k: 0.5 * v for k, v in shares["Yur"].items()}
    off = replace(
        rov, parameter_files={p.name: p.model_copy(update={"coefficients": wrong})},
        shape=replace(rov.shape, estimates=replace(rov.shape.estimates, shares=shares)),
    )  # fmt: skip
    (said,) = ideal_fluid.check(off)
    assert said.severity is Severity.FAIL
    assert "Yur'" in said.statistic
