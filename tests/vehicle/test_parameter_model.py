"""Fitted tables in parameter files: written, read back, evaluated inside and outside; older files still load."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.law.domain import TAPER, Domain, Extrapolation
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from coeflab.tables.importers import PlannedTable
from coeflab.vehicle.parameter_file import SCHEMA_FILE, ParameterFile, read_parameter_file, schema
from coeflab.vehicle.parameter_model import ParameterModel, chosen, from_angles
from coeflab.vehicle.recorded import record, recorded

DATA = Path(__file__).parents[1] / "data"
NEW, OLD = DATA / "parameters_1_1.json", DATA / "parameters_1_0.json"
SURFACE = {"degree": 3, "area": 0.04, "area_name": "frontal"}


@cache
def study() -> Study:
    options = {"surface": SURFACE, "polynomial": {"variable": "v", "degree": 3}}
    table = PlannedTable(shipped("cfd_data") / "huuv_synthetic", ("surface", "polynomial"), options)
    return run(Plan(name="tables", title="Tables", tables=(table,)))


@cache
def written() -> ParameterFile:
    return next(iter(study().parameter_files.values()))


def fitted(response: str = "C_D", rule: Extrapolation = Extrapolation.REFUSE) -> FittedModel:
    model = next(m for f in study().fits for m in f.models if m.response == response)
    return replace(model, domain=replace(model.domain, rule=rule))


def points(alpha: list[float], beta: list[float]) -> dict[str, np.ndarray]:
    return {"alpha": np.radians(alpha), "beta": np.radians(beta)}


def test_every_model_of_a_study_comes_back_from_its_file(tmp_path):
    (tmp_path / "p.json").write_bytes(written().to_json())
    back = read_parameter_file(tmp_path / "p.json")
    assert back == written()
    models = [m for f in study().fits for m in f.models]
    assert [m.response for m in back.models] == [m.response for m in models]
    rng = np.random.default_rng(1)
    for old, new in zip(models, back.models, strict=True):
        at = {v: rng.uniform(a, b, 30) for v, a, b in zip(new.names, new.domain.low, new.domain.high, strict=True)}
        values, half, inside = new.evaluate(at)
        wanted, _, within = old.evaluate(at)
        np.testing.assert_allclose(values, wanted, rtol=1e-12, atol=1e-15)
        np.testing.assert_array_equal(inside, within)
        assert np.all(half > 0.0)
        assert new.statements[: len(old.statements)] == old.statements
        said = {"alpha", "beta"} & set(new.names)
        assert {s.split(" ")[0] for s in new.statements[len(old.statements) :]} == said
        assert new.n_points == old.n_points


def test_units_and_areas_are_stated():
    by = {m.response: m for m in written().models}
    assert [(v.name, v.unit) for v in by["C_D"].variables] == [("alpha", "rad"), ("beta", "rad")]
    assert [(v.name, v.unit) for v in by["Y'"].variables] == [("v", "1")]
    assert (by["C_D"].area.value, by["C_D"].area.name) == (0.04, "frontal")
    assert by["Y'"].area.name == "L^2"
    dimensional = record(replace(fitted("Y'"), unit="N"))
    assert dimensional.variables[0].unit == "m/s"
    assert dimensional.area is None


def test_the_covariance_is_of_standard_uncertainties():
    for m in written().models:
        matrix = np.array(m.covariance)
        np.testing.assert_allclose(np.sqrt(np.diag(matrix)) * 2.0, [t.half_width_95 for t in m.terms], rtol=1e-9)
        assert np.linalg.eigvalsh(matrix / np.outer(*[np.sqrt(np.diag(matrix))] * 2)).min() > -1e-9
    origin = written().models[0].evaluate(points([0.0], [0.0]))[1][0]
    assert origin == pytest.approx(written().models[0].terms[0].half_width_95, rel=1e-9)


def test_refused_points_have_no_number():
    values, half, inside = record(fitted()).evaluate(points([0, 24, 26, 0], [10, 24, 10, -26]))
    assert inside.tolist() == [True, True, False, False]
    assert np.isnan(values).tolist() == np.isnan(half).tolist() == [False, False, True, True]


def test_a_form_that_is_even_or_odd_port_to_starboard_holds_the_mirror_image_of_its_data():
    drag, side = (record(fitted(name)).evaluate(points([5, 5], [10, -10])) for name in ("C_D", "C_S"))
    assert drag[2].tolist() == side[2].tolist() == [True, True]
    assert drag[0][1] == pytest.approx(drag[0][0], rel=1e-12)
    assert side[0][1] == pytest.approx(-side[0][0], rel=1e-12)


def test_clamped_points_have_the_value_of_the_nearest_edge():
    model = record(fitted(rule=Extrapolation.CLAMP))
    values, half, inside = model.evaluate(points([40, 25, -90, -25, 5], [10, 10, -30, -25, 5]))
    assert inside.tolist() == [False, True, False, True, True]
    assert values[0] == pytest.approx(values[1], rel=1e-12)
    assert values[2] == pytest.approx(values[3], rel=1e-12)
    assert half[0] == pytest.approx(half[1], rel=1e-12)


@cache
def diamond(rule: Extrapolation) -> ParameterModel:
    """The synthetic table's drag, with the hull of its rows within alpha + beta of 25 degrees in size."""
    model = fitted()
    near = np.abs(model.x["alpha"]) + model.x["beta"] <= np.radians(25.0) + 1e-12
    return record(replace(model, domain=Domain.of({v: x[near] for v, x in model.x.items()}, rule)))


def test_a_corner_of_the_box_outside_the_hull_has_the_value_of_the_nearest_point_of_the_hull():
    """In box widths a' = a / 50 + 0.5, b' = b / 25 the slope is a' + b' / 2 = 1; (25, 25) falls on (5, 20) degrees."""
    model = diamond(Extrapolation.CLAMP)
    values, half, inside = model.evaluate(points([25, -25, 5, 60, 25, 0, 0], [25, 25, 20, 5, 0, 90, 25]))
    assert inside.tolist() == [False, False, True, False, True, False, True]
    for outside, edge in ((0, 2), (3, 4), (5, 6)):
        assert values[outside] == pytest.approx(values[edge], rel=1e-12)
        assert half[outside] == pytest.approx(half[edge], rel=1e-9)
    corner = record(fitted()).evaluate(points([25], [25]))[0][0]
    assert abs(values[0] - corner) > 0.1


def test_between_hull_and_box_the_taper_ends_at_the_nearest_point_too():
    model = diamond(Extrapolation.TAPER)
    normal = np.array([1.0, 0.5]) / np.hypot(1.0, 0.5) * np.array([50.0, 25.0])
    track = np.array([5.0, 20.0]) + np.outer([0.0, 0.5 * TAPER, TAPER, 0.3], normal)
    values = model.evaluate(points(list(track[:, 0]), list(track[:, 1])))[0]
    free = fitted().evaluate(points(list(track[:, 0]), list(track[:, 1])))[0]
    wanted = [free[0], 0.5 * (free[0] + free[1]), free[0], free[0]]
    np.testing.assert_allclose(values, wanted, rtol=1e-9)
    assert abs(free[1] - free[0]) > 0.01


def test_the_taper_joins_with_its_slope_and_ends_at_the_edge():
    model = record(fitted(rule=Extrapolation.TAPER))
    edge = np.radians(25.0)
    width = 2.0 * edge

    def value(alpha: np.ndarray) -> np.ndarray:
        return model.evaluate({"alpha": alpha, "beta": np.full_like(alpha, 0.1)})[0]

    h = 1e-6
    before, at, after = value(edge + np.array([-h, 0.0, h]))
    assert (after - at) / h == pytest.approx((at - before) / h, rel=1e-3)
    assert abs((at - before) / h) > 0.5
    far = value(edge + width * np.array([TAPER, 2.0 * TAPER, 50.0]))
    np.testing.assert_allclose(far, at, rtol=1e-12)
    free = fitted().evaluate({"alpha": np.array([edge + 0.5 * TAPER * width]), "beta": np.array([0.1])})[0][0]
    assert value(np.array([edge + 0.5 * TAPER * width]))[0] == pytest.approx(0.5 * (free + at), rel=1e-9)


@settings(max_examples=50, deadline=None)
@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_outside_values_stay_within_those_of_the_box_and_its_rim(alpha, beta):
    """Neither rule may run away, however far outside."""
    a, b = np.meshgrid(np.linspace(-0.53, 0.53, 80), np.linspace(-0.05, 0.49, 60))
    free = fitted().evaluate({"alpha": a.ravel(), "beta": b.ravel()})[0]
    for rule in (Extrapolation.CLAMP, Extrapolation.TAPER):
        value = record(fitted(rule=rule)).evaluate({"alpha": np.array([alpha]), "beta": np.array([beta])})[0][0]
        assert free.min() - 1e-3 <= value <= free.max() + 1e-3


def test_an_undetermined_term_leaves_no_number_where_it_counts():
    content = json.loads(record(fitted()).model_dump_json())
    i = next(k for k, t in enumerate(content["terms"]) if t["symbol"] == "C_D_alpha")
    content["terms"][i].update(value=None, half_width_95=None)
    for k in range(len(content["terms"])):
        content["covariance"][i][k] = content["covariance"][k][i] = None
    values, half, inside = ParameterModel.model_validate(content).evaluate(points([0, 5], [5, 5]))
    assert inside.all()
    assert np.isnan(values).tolist() == np.isnan(half).tolist() == [False, True]


def test_a_value_without_an_interval_has_none_for_the_point():
    content = json.loads(record(fitted()).model_dump_json())
    content["terms"][0]["half_width_95"] = None
    k = len(content["terms"])
    for j in range(k):
        content["covariance"][0][j] = content["covariance"][j][0] = None
    values, half, _ = ParameterModel.model_validate(content).evaluate(points([5], [5]))
    assert np.isfinite(values[0])
    assert np.isnan(half[0])


@pytest.mark.parametrize("columns", [{}, {"alpha": np.zeros(1)}, {**points([0], [0]), "r": np.zeros(1)}])
def test_other_variables_are_refused(columns):
    with pytest.raises(InputError, match="expected values for alpha, beta"):
        record(fitted()).evaluate(columns)


def test_of_two_fits_of_one_response_the_earlier_counts_and_a_note_says_so():
    fit = study().fits[0]
    models, notes = recorded([fit, fit])
    assert len(models) == len(fit.models)
    assert len(notes) == len(fit.models)
    assert "C_D over alpha, beta" in notes[0]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda m: m["terms"][0].update(value=None), "interval without a value"),
        (lambda m: m["terms"][1]["factors"][0].update(variable="r"), "which is no variable"),
        (lambda m: m["domain"].update(low=[0.0]), "does not have 2 variables"),
        (lambda m: m["domain"].update(low=[1.0, 9.0]), "low is above its high"),
        (lambda m: m["covariance"].pop(), "must be"),
        (lambda m: m["covariance"][0].__setitem__(1, 7.0), "not symmetric"),
        (lambda m: m["covariance"][0].__setitem__(0, -1.0), "is negative"),
        (lambda m: m.update(rms=-1.0), "greater than or equal to 0"),
        (lambda m: m["domain"].update(extrapolation="guess"), "refuse"),
        (lambda m: m["variables"].append(m["variables"][0]), "more than once"),
        (lambda m: m.update(area={"value": 0.0, "name": "frontal"}), "greater than 0"),
        (lambda m: m.update(colour="red"), "colour"),
    ],
)
def test_a_model_that_contradicts_itself_is_refused(tmp_path, change, said):
    content = json.loads(NEW.read_text())
    change(content["models"][0])
    (tmp_path / "p.json").write_text(json.dumps(content))
    with pytest.raises(InputError) as caught:
        read_parameter_file(tmp_path / "p.json")
    assert said in str(caught.value)


def test_a_response_stands_once_per_set_of_variables(tmp_path):
    content = json.loads(NEW.read_text())
    content["models"].append(content["models"][0])
    (tmp_path / "p.json").write_text(json.dumps(content))
    with pytest.raises(InputError, match="C_D over alpha, beta occurs more than once"):
        read_parameter_file(tmp_path / "p.json")


def test_the_sample_of_1_1_loads_and_is_written_as_it_is():
    sample = read_parameter_file(NEW)
    assert sample.schema_version == "1.1"
    assert [m.response for m in sample.models] == ["C_D", "C_n", "Y'"]
    assert [m.domain.extrapolation for m in sample.models] == ["clamp", "clamp", "taper"]
    assert sample.to_json() == NEW.read_bytes()
    jsonschema.Draft202012Validator(json.loads(SCHEMA_FILE.read_text())).validate(json.loads(NEW.read_text()))


def test_a_file_of_1_0_loads_without_models_and_is_written_as_1_0(tmp_path):
    content = json.loads(NEW.read_text())
    content["schema_version"] = "1.0"
    del content["models"]
    (tmp_path / "old.json").write_bytes((json.dumps(content, indent=2, ensure_ascii=False) + "\n").encode())
    for path in (tmp_path / "old.json", *([OLD] if OLD.exists() else [])):
        old = read_parameter_file(path)
        assert old.models == ()
        assert old.to_json() == path.read_bytes()
        jsonschema.Draft202012Validator(json.loads(SCHEMA_FILE.read_text())).validate(json.loads(path.read_text()))
    content["models"] = json.loads(NEW.read_text())["models"]
    (tmp_path / "mixed.json").write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"models came with version 1\.1"):
        read_parameter_file(tmp_path / "mixed.json")


def test_the_shipped_schema_is_the_one_of_the_models():
    assert SCHEMA_FILE.read_bytes() == schema()


@pytest.mark.parametrize(
    ("response", "variables", "said"),
    [
        ("C_Q", ("alpha", "beta"), "no fitted table of"),
        ("C_D", ("alpha", "gamma"), "unknown variable"),
        ("C_D", ("alpha",), "expected values for alpha and beta"),
        ("", ("v", "alpha"), "expected values for alpha and beta, or for v"),
        ("", (), "no variable"),
    ],
)
def test_choosing_models(response, variables, said):
    models = read_parameter_file(NEW).models
    with pytest.raises(InputError) as caught:
        chosen(models, response, variables)
    assert said in str(caught.value)
    assert [m.response for m in chosen(models, "Y", ("v",))] == ["Y'"]
    assert [m.response for m in chosen(models, "", ("beta", "alpha"))] == ["C_D", "C_n"]
    with pytest.raises(InputError, match="without fitted tables"):
        chosen((), "", ("v",))


def over(*variables: str) -> ParameterModel:
    """A synthetic model over primed velocities: the sum of its variables."""
    content = json.loads(record(fitted("Y'")).model_dump_json())
    term = {"value": 1.0, "half_width_95": 0.0}
    k = len(variables)
    spaces = [[*(way * float(v == at) for v in variables), -1.0] for at in variables for way in (1.0, -1.0)]
    content.update(
        variables=[{"name": v, "unit": "1"} for v in variables],
        terms=[
            {"symbol": f"Y{v}", "factors": [{"variable": v, "power": 1, "absolute": False}], **term} for v in variables
        ],
        covariance=[[0.0] * k for _ in range(k)],
        domain={"low": [-1.0] * k, "high": [1.0] * k, "half_spaces": spaces, "extrapolation": "refuse"},
    )
    return ParameterModel.model_validate(content)


def test_angles_stand_for_primed_velocities():
    given = {"alpha": np.radians([20.0]), "beta": np.radians([30.0])}
    both = over("v", "w")
    assert chosen((both,), "", ("alpha", "beta")) == (both,)
    found = from_angles(both, given)
    assert found["v"][0] == pytest.approx(0.5)
    assert found["w"][0] == pytest.approx(np.sin(np.radians(20.0)) * np.cos(np.radians(30.0)))
    mixed = from_angles(both, {"alpha": given["alpha"], "v": np.array([0.5])})
    assert mixed["w"][0] == pytest.approx(found["w"][0])
    assert from_angles(over("w"), {"alpha": given["alpha"]})["w"][0] == pytest.approx(np.sin(np.radians(20.0)))
    r = {"r": np.array([0.2])}
    assert from_angles(over("v", "r"), {"beta": given["beta"], **r}).keys() == {"v", "r"}


@pytest.mark.parametrize("variables", [("beta",), ("v", "beta"), ("alpha", "beta", "r"), ("v", "w", "alpha")])
def test_angles_that_are_too_few_or_too_many_are_refused(variables):
    with pytest.raises(InputError):
        chosen((over("v", "w"),), "", variables)


def test_an_angle_is_itself_where_a_table_has_it_and_never_a_velocity_in_metres_per_second():
    models = read_parameter_file(NEW).models
    assert [m.response for m in chosen(models, "", ("alpha", "beta"))] == ["C_D", "C_n"]
    assert [m.response for m in chosen(models, "", ("beta",))] == ["Y'"]
    dimensional = record(replace(fitted("Y'"), unit="N"))
    with pytest.raises(InputError, match="unknown variable"):
        chosen((dimensional,), "", ("beta",))
