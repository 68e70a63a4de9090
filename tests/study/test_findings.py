"""Findings that a study adds to its fits, and plans that cannot be meant."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.declarations import declared_key
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.text.toml import read_toml
from coeflab.fits.results.fit_result import Sweep
from coeflab.formats.missing_parts import common_losses
from coeflab.law.scaling import Conditions, Scaling
from coeflab.report.sections.conventions import conventions_section
from coeflab.study.checks import data_gate, sizes, symmetry
from coeflab.study.checks.coverage import replicates
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from coeflab.tables.importers import PlannedTable
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.vehicle.inertia import water_inertia


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
        declared_key(read_toml(file), "uncertainty", InputUncertainty)


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
    assert file.added_mass.method == "strip:lamb"
    nv = file.coefficient("Nv")
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


def of_hull(folder: Path, hull: Path, campaign: str = "suboff_roddy_2", body: str = "suboff_fully_appended") -> Study:
    """A parameter file of one campaign with a body's added mass, and Roddy's particulars beside it."""
    (folder / "plan.toml").write_text(
        f'[study]\nname = "s"\nwanted = ["Yv"]\n[body]\npath = "suboff"\n'
        f'[[table]]\ncampaign = "{shipped("cfd_data") / campaign}"\nfits = ["slope_at_origin"]\n'
        f'[[parameter_file]]\nname = "p"\nbody = "{body}"\ncampaigns = ["{campaign}"]\n'
        f'added_mass = "{hull}"\nadded_mass_method = "ellipsoid"\n'
    )
    return run(read_plan(folder / "plan.toml"))


def alarms(study: Study) -> tuple[list[str], list[str]]:
    """Findings, and what the parameter file itself says."""
    (file,) = study.parameter_files.values()
    lost = [str(each) for each in common_losses(file, frozenset(), water_inertia(file)) if "another shape" in str(each)]
    notes = [n for n in file.provenance.notes if "another shape" in n]
    return [c.comment for c in study.checks if "another shape" in c.comment], lost + notes


@pytest.mark.slow
def test_one_body_under_two_names_raises_no_alarm(tmp_path: Path) -> None:
    """AFF-8 has the volume and the surface of Roddy's fully appended model within one per cent."""
    study = of_hull(tmp_path, shipped("geometry") / "suboff_aff8")
    assert alarms(study) == ([], [])
    (file,) = study.parameter_files.values()
    assert file.added_mass.body == "suboff_fully_appended"
    (said,) = [n for n in file.provenance.notes if "suboff_aff8" in n]
    assert "no ring wing" in said
    assert "wetted surface 6.352 against 6.285 m^2" in said


@pytest.mark.parametrize("renamed", [False, True])
def test_another_body_still_does(tmp_path: Path, renamed: bool) -> None:
    """The bare hull in the appended hull's file, under its own name and under the appended hull's."""
    hull = shipped("geometry") / "suboff_bare_hull"
    if renamed:
        text = (hull / "body.toml").read_text()
        hull = tmp_path / "body.toml"
        hull.write_text(text.replace('name = "suboff_bare_hull"', 'name = "suboff_fully_appended"'))
    found, said = alarms(of_hull(tmp_path, hull))
    assert found
    assert said[0].startswith("mismatch: ")
    assert "wetted surface 5.988 against 6.285 m^2" in said[1]


def test_a_body_of_the_vehicles_name_raises_none(tmp_path: Path) -> None:
    study = of_hull(tmp_path, shipped("geometry") / "suboff_bare_hull", "suboff_roddy_3", "suboff_bare_hull")
    assert alarms(study) == ([], [])


def with_replicates(k: int, rng: np.random.Generator, off: float = 0.0) -> Sweep:
    """Ten settings and k readings at rest, one of them off by so many standard deviations."""
    x = np.concatenate([np.linspace(-0.2, 0.2, 10), np.zeros(k)])
    y = -0.03 * x + 1e-4 * rng.standard_normal(len(x))
    y[-1] += 1e-4 * off
    labels = tuple(map(str, range(len(x))))
    of_rows = np.zeros(len(x))
    return Sweep(
        "Yv", "v", "Y", "odd", "x", x, y, None, labels, (), None, None, None, "", (), np.ones(len(x), bool),
        np.zeros(0, int), None, of_rows, of_rows, (0.0, 0.0), of_rows, (), (), False, "t", "c", "b",
    )  # fmt: skip


@pytest.mark.parametrize("k", [2, 6])
def test_replicates_fail_equally_rarely_whatever_their_number(k: int) -> None:
    """1 % for pairs and for groups of six, where three standard deviations failed 27 % of them."""
    rng = np.random.default_rng(k)
    false = np.mean([bool(replicates(with_replicates(k, rng), 1)) for _ in range(1000)])
    assert 0.001 <= false <= 0.02
    assert np.mean([bool(replicates(with_replicates(k, rng, off=10.0), 1)) for _ in range(50)]) > 0.9


def test_slopes_of_a_size_that_no_body_has_are_warned_of() -> None:
    """kN for N, N for kN, ten times the speed; the least friction is that of a plate, by hand at Re = 1e7."""
    own = study("suboff_roddy_3", "slope_at_origin")
    assert not [c for c in own.checks if c.name == "sizes"]

    def found(**factors: float) -> list[str]:
        changed = [
            replace(c, value=c.value * f, u95=c.u95 * f) for c in own.coefficients if (f := factors.get(c.symbol))
        ]
        checks = sizes.check(replace(own, fits=(), missing=tuple(changed)))
        assert all(c.severity is Severity.WARN for c in checks)
        return [f"{c.statistic}; {c.comment}" for c in checks]

    (large,) = found(Yv=1e4, Nv=1000.0, X0=1000.0)
    assert large.startswith("Yv' = -38 (2), Nv' = -13 (1); Are forces in N declared as kN")
    assert "the speed 3.34389 m/s too low" in large
    (small,) = found(Yv=0.001, Nv=0.001, X0=0.001)
    assert small.startswith("X0' = -1.1e-06 (0.00035), Yv' = -3.8e-06 (0.00017); Are forces in kN declared as N")
    assert [f.partition(" =")[0] for f in found(Yv=1.0, X0=0.01)] == ["X0'"]
    at = Conditions(density=1000.0, speed=2.0, viscosity=1e-6)
    by_hand = np.pi / 20.0 * (0.075 / 25.0 - 8700.0 / 1e7)
    assert sizes.least_friction(at, Scaling(5.0, "L")) == pytest.approx(by_hand, rel=1e-12)
    assert sizes.least_friction(replace(at, speed=0.02), Scaling(5.0, "L")) == pytest.approx(
        np.pi / 20.0 * 1.328 / 1e5**0.5, rel=1e-12
    )


def test_a_turn_within_the_length_of_the_body_is_warned_of() -> None:
    """Degrees a second as radians."""
    own = study("suboff_roddy_3", "slope_at_origin")
    (table,) = own.tables
    r = 1.1 * table.speed / table.scaling.length * np.linspace(-1.0, 1.0, len(table))

    def found(rate: np.ndarray) -> list[str]:
        turning = replace(table, motion={**table.motion, "r": rate})
        return [f"{c.subject}; {c.statistic}; {c.comment}" for c in sizes.check(replace(own, tables=(turning,)))]

    assert not found(r)
    (text,) = found(57.3 * r)
    assert "r'; largest |r'| = 63: a circle of 0.016 lengths in radius; Is r in deg/s declared as rad/s" in text


def test_moments_a_thousand_times_too_small_for_their_forces_are_warned_of() -> None:
    """kN m declared as N m; a moment that nobody measured is none."""
    own = study("suboff_roddy_3", "slope_at_origin")
    (table,) = own.tables

    def found(factor: float) -> list[str]:
        changed = replace(table, forces={**table.forces, "N": factor * table.forces["N"]})
        return [f"{c.statistic}; {c.comment}" for c in sizes.check(replace(own, tables=(changed,)))]

    assert not found(1.0)
    assert not found(0.1)
    assert not found(0.0)
    (text,) = found(0.001)
    assert text.startswith("largest |N'| = 0.0004 of the largest |Y'|; Are moments in kN m declared as N m")


def test_a_moved_reference_point_is_fitted_anew_and_said() -> None:
    """Rows moved and fitted against slopes moved: not the same number, but within U95."""
    own = study("suboff_roddy_3", "slope_at_origin")
    (table,) = own.tables
    dx = 0.05 * table.scaling.length
    planned = PlannedTable(shipped("cfd_data") / "suboff_roddy_3", ("slope_at_origin",), {})
    there = table.reference_point + np.array([dx, 0.0, 0.0])
    moved = run(Plan(name="s", title="", tables=(planned,), wanted=(), reference_point=there))
    first, second = ({c.symbol: c for c in one.coefficients if c.value is not None} for one in (own, moved))
    assert second["Yv"].value == first["Yv"].value
    by_hand = first["Nv"].value - 0.05 * first["Yv"].value
    assert second["Nv"].value != by_hand
    assert abs(second["Nv"].value - by_hand) < min(first["Nv"].u95, second["Nv"].u95)
    said = [
        any("moved there and then fitted" in t for t in conventions_section(one).paragraphs) for one in (own, moved)
    ]
    assert said == [False, True]


def test_numerical_zeros_are_no_findings() -> None:
    """K of 1e-13 beside N of 10: neither a bias nor readings that do not belong."""
    own = study("suboff_roddy_3", "slope_at_origin")
    (table,) = own.tables
    scatter = np.random.default_rng(5).standard_normal(len(table)) ** 5

    def found(size: float) -> tuple[int, int]:
        k = size * float(np.nanmax(np.abs(table.forces["N"]))) * scatter
        wild = replace(table, forces={**table.forces, "K": k}, usable={**table.usable, "K": np.ones(len(table), bool)})
        gate = [c for c in data_gate.check(replace(own, tables=(wild,))) if "K" in c.subject + c.statistic]
        fits = [
            replace(f, sweeps=tuple(replace(s, y=s.y * size) if s.component == "N" else s for s in f.sweeps))
            for f in own.fits
        ]
        of_n = [c for c in symmetry.check(replace(own, fits=tuple(fits))) if c.statistic.startswith("N'")]
        return len(gate), len(of_n)

    assert all(n > 0 for n in found(1e-3))
    assert found(1e-13) == (0, 0)


@pytest.mark.parametrize("campaign", ["tank_spheroid", "thauv_case_03_synthetic", "flyingfish_water_synthetic"])
def test_shipped_campaigns_have_sizes_of_bodies(campaign: str) -> None:
    fit = "manoeuvring_model" if campaign.startswith("flyingfish") else "slope_at_origin"
    assert not [c for c in study(campaign, fit).checks if c.name == "sizes"]
