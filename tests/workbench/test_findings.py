"""Findings that a study adds to its fits, and plans that cannot be meant."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.toml import read_toml
from coeflab.model.check import Severity
from coeflab.model.input_uncertainty import read_input_uncertainty
from coeflab.model.plan import read_plan
from coeflab.model.scaling import Scaling
from coeflab.model.study import Plan, PlannedTable, Study
from coeflab.workbench import run


def study(campaign: str, fit: str, **options: object) -> Study:
    table = PlannedTable(shipped("cfd_data") / campaign, (fit,), {fit: options})
    return run(Plan(name="s", title="", tables=(table,), wanted=()))


def test_a_model_that_predicts_worse_than_the_mean_is_warned_of() -> None:
    wild = study("suboff_roddy_2", "polynomial", variable="beta", degree=16, responses=("Y",))
    (found,) = [c for c in wild.checks if c.name == "prediction"]
    assert found.severity is Severity.WARN
    model = wild.fits[0].models[0]
    assert model.fit.press_rms > np.std(model.y)
    tame = study("suboff_roddy_2", "polynomial", variable="beta", degree=5, responses=("Y",))
    assert not [c for c in tame.checks if c.name == "prediction"]


def test_a_parameter_file_says_what_its_angles_mean() -> None:
    tame = study("suboff_roddy_2", "polynomial", variable="beta", degree=5, responses=("Y",))
    (model,) = next(iter(tame.parameter_files.values())).models
    assert any("v = +V sin(beta)" in s for s in model.statements)
    value = model.evaluate({"beta": np.radians([10.0])})[0][0]
    assert value < 0.0, "a flow from port pushes to port"


def test_options_of_a_fit_that_is_not_run_are_refused(tmp_path: Path) -> None:
    plan = tmp_path / "plan.toml"
    plan.write_text(
        '[study]\nname = "s"\n[[table]]\ncampaign = "suboff_roddy_2"\n[table.options.polynomial]\ndegree = 3\n'
    )
    with pytest.raises(InputError, match="polynomial"):
        read_plan(plan)


def test_an_angle_in_radians_that_was_meant_in_degrees_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "campaign.toml"
    file.write_text("[uncertainty]\nangle = 0.1\n")
    with pytest.raises(InputError, match=r"0\.1 deg"):
        read_input_uncertainty(read_toml(file).section("uncertainty"))


def test_the_added_mass_of_a_plan_reaches_file_and_study() -> None:
    hull = shipped("geometry") / "spheroid_example"
    table = PlannedTable(shipped("cfd_data") / "suboff_cfd_barehull", ("slope_at_origin",))
    plan = Plan(name="s", title="", tables=(table,), wanted=(), hull=hull, method="ellipsoid")
    with pytest.raises(Exception, match="datum"):
        run(plan)
    bare = Plan(
        name="s",
        title="",
        tables=(table,),
        wanted=(),
        hull=shipped("geometry") / "suboff_bare_hull",
        method="strip:lamb",
    )
    found = run(bare)
    (file,) = found.parameter_files.values()
    assert file.added_mass is not None
    assert file.added_mass.method == "strip:lamb"
    nv = file.coefficient("Nv")
    assert nv is not None
    assert nv.potential is not None
    assert nv.potential < nv.value < 0.0, "viscous lift takes some of the Munk moment back"
    assert set(found.hulls) == set(found.parameter_files)
    assert any(i.name.startswith("suboff_bare_hull/") for i in found.inputs)


def test_the_added_mass_of_another_vehicle_fails(tmp_path: Path) -> None:
    """A hull of the right datum and three and a half times the length."""
    (tmp_path / "body.toml").write_text(
        '[body]\nname = "giant"\nreader = "primitives"\ndatum = "nose, on the hull\'s axis"\nreference_point = [0, 0, 0]\n'
        '[source]\ncitation = "synthetic"\n[[part]]\nname = "hull"\nform = "spheroid"\nlength = 15.0\ndiameter = 2.0\n'
        "centre = [-7.5, 0, 0]\n"
    )
    table = PlannedTable(shipped("cfd_data") / "suboff_cfd_barehull", ("slope_at_origin",))
    found = run(Plan(name="s", title="", tables=(table,), wanted=(), hull=tmp_path, method="ellipsoid"))
    assert found.failed
    (length,) = [c for c in found.checks if c.name == "hull" and c.severity is Severity.FAIL]
    assert "15 m against 4.261 m" in length.statistic


def test_a_name_too_long_for_the_file_is_one_error() -> None:
    table = PlannedTable(shipped("cfd_data") / "suboff_roddy_3", ("slope_at_origin",), {})
    plan = Plan(name="s", title="", tables=(table,), wanted=(), scaling=Scaling(4.26086, "L" * 800))
    with pytest.raises(InputError, match="at most 200 characters") as why:
        run(plan)
    assert "length_name" in str(why.value)
    assert len(str(why.value)) < 500
