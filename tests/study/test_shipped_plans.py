"""Shipped plans of published systems: table -> fit -> parameter file -> manoeuvre -> report, as `coeflab run NAME` takes them."""

from __future__ import annotations

import csv
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.formats.export import export
from coeflab.motion.simulation import simulate
from coeflab.motion.vehicle import vehicle
from coeflab.report.first_page import answer
from coeflab.report.rendered import rendered
from coeflab.report.sections.coefficients import coefficients_section
from coeflab.report.tables.models import qualities
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

DATA = shipped("cfd_data")
NAMES = ("flyingfish_air_synthetic", "flyingfish_water_synthetic", "huuv_synthetic", "thauv_synthetic")
DIVES = [(case, stage) for case in ("01", "02", "03") for stage in ("1", "2")]
STILL = np.zeros((1, 3))


@pytest.fixture(scope="module")
def carried_out() -> Callable[[str], Study]:
    """A shipped plan, carried out once."""
    return cache(lambda name: run(read_plan(DATA / name / "plan.toml")))


def made(study: Study, name: str) -> ParameterFile:
    """A file of the study as a reader of the written one has it."""
    return ParameterFile.model_validate_json(study.parameter_files[name].to_json())


def base_of(name: str) -> ParameterFile:
    return read_parameter_file(next(DATA.glob(f"*/{name}.parameters.json")))


def attacked(file: ParameterFile, degrees: np.ndarray, speed: float = 0.5) -> np.ndarray:
    alpha = np.radians(degrees)
    nu = np.zeros((len(alpha), 6))
    nu[:, 0], nu[:, 2] = speed * np.cos(alpha), speed * np.sin(alpha)
    return vehicle(file).force(nu, np.zeros((len(alpha), 3)))[:, [0, 2, 4]]


@pytest.mark.parametrize("name", NAMES)
def test_a_shipped_plan_moves_what_it_writes(carried_out: Callable[[str], Study], name: str) -> None:
    study = carried_out(name)
    assert not study.failed
    assert study.manoeuvres
    planned = read_plan(DATA / name / "plan.toml").manoeuvres
    for asked, flown in zip(planned, study.manoeuvres, strict=True):
        assert not [s for s in flown.statements if "stopped at" in s]
        assert len(flown.trajectory.time) > 10
        assert asked.parameter_file in study.parameter_files


@pytest.mark.slow
def test_the_report_shows_the_manoeuvre(carried_out: Callable[[str], Study]) -> None:
    files = rendered(carried_out("huuv_synthetic"))
    assert {"report.html", "huuv_like_synthetic.parameters.json"} <= set(files)
    assert b"steady speed" in files["report.html"]


def test_what_is_said_of_coefficients_is_true_of_the_fit(carried_out: Callable[[str], Study]) -> None:
    """A polar and surfaces were reported as slopes of a weighted mixture of forms."""
    said = {n: " ".join(coefficients_section(carried_out(n)).texts) for n in ("thauv_synthetic", "huuv_synthetic")}
    assert "fit of the form" in said["thauv_synthetic"]
    assert "no coefficient with a SNAME symbol" in said["huuv_synthetic"]
    assert not [n for n, text in said.items() if "weighted" in text]


def test_the_first_page_says_how_the_printed_polar_compares(carried_out: Callable[[str], Study]) -> None:
    """It said that nothing was published, and not whence the sign of Mw' comes."""
    found = answer(carried_out("thauv_synthetic"), drawn=False)
    assert "both wanted coefficients found" in found.sentence
    assert "18 of 18 printed coefficients inside their fitted U95" in found.sentence
    said = " ".join(found.notes)
    assert "Ours: coeflab's fits to thauv_case_01_synthetic." in said
    assert "Munk moment (m3 - m1) u w of 236.7 kg that the plan adds, which turns its sign" in said
    models = tuple(m for f in carried_out("thauv_synthetic").fits for m in f.models)
    titles = [t.title for t in qualities(models)]
    assert titles == [f"Quality of the fitted models, thauv_case_0{n}_synthetic" for n in (1, 2, 3)]


@pytest.mark.parametrize(("case", "stage"), DIVES)
def test_a_dive_from_the_sweep_has_the_printed_speed(
    carried_out: Callable[[str], Study], case: str, stage: str
) -> None:
    """Within 0.005 m/s, as `coeflab validate thauv` has them."""
    with (DATA / "thauv" / "published.csv").open(encoding="utf-8", newline="") as lines:
        printed = {
            (r["case"], r["stage"]): r["V [m/s]"] for r in csv.DictReader(lines) if r["table"] == "published_speed"
        }
    study = carried_out("thauv_synthetic")
    flown = study.manoeuvres[DIVES.index((case, stage))]
    found = {f.name: f.value for f in flown.figures}
    assert found["steady speed"] == pytest.approx(float(printed[case, stage]), abs=0.005)


def test_a_dive_s_file_from_the_sweep_moves_as_that_of_the_validation(carried_out: Callable[[str], Study]) -> None:
    """All but the noise of the table, 0.5 % of the largest force, and of the drag's curvature."""
    options = {"pitch": -0.2617993877991494, "speed": 0.3, "duration": 900.0}
    name = "thauv_case_02_dive_1"
    ours, theirs = made(carried_out("thauv_synthetic"), f"{name}_fitted"), base_of(name)
    assert ours.hydrostatics == theirs.hydrostatics
    assert str(ours.mass) == str(theirs.mass)
    degrees = np.linspace(-8.0, 8.0, 9)
    left = np.abs(attacked(ours, degrees) - attacked(theirs, degrees)) / np.abs(attacked(theirs, degrees)).max(axis=0)
    assert left.max(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=0.02)
    figures = [{f.name: f.value for f in simulate(p, "glide", options).figures} for p in (ours, theirs)]
    for quantity, within in (("steady speed", 0.005), ("glide angle", 0.005), ("angle of attack", 0.002)):
        assert figures[0][quantity] == pytest.approx(figures[1][quantity], abs=within)


def test_the_polar_of_a_dive_goes_to_simulators_whole(carried_out: Callable[[str], Study]) -> None:
    loss = export(made(carried_out("thauv_synthetic"), "thauv_case_01_dive_1_fitted"), "mss").loss
    assert [str(lost) for lost in loss.lost if "thrusters" not in str(lost)] == []
    assert np.nanmax(loss.forces.relative) < 1e-9


@pytest.mark.parametrize("medium", ["air", "water"])
def test_the_flyingfish_of_the_sweeps_is_that_of_the_validation(
    carried_out: Callable[[str], Study], medium: str
) -> None:
    """Damping within the noise of the table, 0.2 % of the largest force; all else is the shipped file's."""
    study = carried_out(f"flyingfish_{medium}_synthetic")
    ours, theirs = (vehicle(p) for p in (made(study, f"flyingfish_{medium}_fitted"), base_of(f"flyingfish_{medium}")))
    rows = np.diag([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    expected = np.diag(theirs.force(rows, np.zeros((6, 3))))
    assert np.diag(ours.force(rows, np.zeros((6, 3)))) == pytest.approx(expected, rel=0.02)
    assert (ours.weight, ours.buoyancy, ours.thrusters) == (theirs.weight, theirs.buoyancy, theirs.thrusters)
    again = simulate(
        base_of(f"flyingfish_{medium}"),
        "steady_motion",
        dict(read_plan(DATA / f"flyingfish_{medium}_synthetic" / "plan.toml").manoeuvres[0].options),
    )
    for a, b in zip(study.manoeuvres[0].figures, again.figures, strict=True):
        assert (a.value or 0.0) == pytest.approx(b.value or 0.0, rel=1e-3, abs=1e-6)


def test_the_huuv_s_tables_and_simplified_mesh_make_a_vehicle(carried_out: Callable[[str], Study]) -> None:
    """The stated laws at attack 10 and drift 15 degrees, and buoyancy and added mass without a hand edit."""
    file = made(carried_out("huuv_synthetic"), "huuv_like_synthetic")
    assert file.added_mass is not None
    assert file.hydrostatics is not None
    a, b, q = np.radians(10.0), np.radians(15.0), 0.5 * 998.0 * 0.04
    nu = np.array([[np.cos(a) * np.cos(b), np.sin(b), np.sin(a) * np.cos(b), 0.0, 0.0, 0.0]])
    moments = vehicle(file).force(nu, STILL)[0, 4:]
    expected = 1.2 * q * np.array([0.35 * a - 0.30 * a**3, -0.40 * b + 0.50 * b**3])
    assert moments == pytest.approx(expected, rel=0.03)
