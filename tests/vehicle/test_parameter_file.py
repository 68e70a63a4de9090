"""The parameter file: schema, bytes, and everything that is none."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from coeflab.core.errors import InputError
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import SCHEMA_FILE, ParameterFile, read_parameter_file, schema
from coeflab.vehicle.schema_versions import SCHEMA_VERSION, VERSIONS, is_later

SAMPLE = Path(__file__).parents[1] / "data" / "parameters_1_0.json"
NEWEST = SAMPLE.with_name("parameters_1_3.json")
FILES = ("suboff_fully_appended", "suboff_bare_hull", "suboff_bare_hull_cfd")


def test_shipped_schema_is_the_models() -> None:
    assert SCHEMA_FILE.read_bytes() == schema()
    jsonschema.Draft202012Validator.check_schema(json.loads(schema()))


@pytest.mark.parametrize("name", FILES)
def test_files_of_the_study_hold_to_the_schema(suboff: Study, name: str) -> None:
    content = json.loads(suboff.parameter_files[name].to_json())
    jsonschema.validate(content, json.loads(SCHEMA_FILE.read_text()), jsonschema.Draft202012Validator)
    content["surprise"] = 1
    with pytest.raises(jsonschema.ValidationError, match="surprise"):
        jsonschema.validate(content, json.loads(SCHEMA_FILE.read_text()))


@pytest.mark.parametrize("name", FILES)
def test_bytes_round_trip(suboff: Study, tmp_path: Path, name: str) -> None:
    raw = suboff.parameter_files[name].to_json()
    (tmp_path / "p.json").write_bytes(raw)
    back = read_parameter_file(tmp_path / "p.json")
    assert back == suboff.parameter_files[name]
    assert back.to_json() == raw
    assert raw.endswith(b"}\n")
    assert b"NaN" not in raw


@pytest.mark.parametrize("version", VERSIONS)
def test_a_sample_of_every_version_loads_and_is_written_back_as_it_is(version: str) -> None:
    """Each was written by a study when its version was the newest; those of 1.2 and 1.3 are of a synthetic vehicle."""
    sample = SAMPLE.with_name(f"parameters_{version.replace('.', '_')}.json")
    file = read_parameter_file(sample)
    assert file.schema_version == version
    assert file.to_json() == sample.read_bytes()
    jsonschema.validate(json.loads(sample.read_bytes()), json.loads(schema()), jsonschema.Draft202012Validator)


def test_the_first_version_means_what_it_meant() -> None:
    file = read_parameter_file(SAMPLE)
    yv = file.coefficient("Yv")
    assert yv.value == pytest.approx(-0.006, abs=0.001)
    assert (yv.law, yv.potential, file.models, file.added_mass) == ("motion", None, (), None)


def test_version_1_2_means_what_it_meant() -> None:
    """A spheroid's Munk moment in Nv', mass away from the reference point, intervals that hold declared inputs."""
    file = read_parameter_file(NEWEST)
    nv, yr = file.coefficient("Nv"), file.coefficient("Yr")
    matrix, density, length = file.added_mass.matrix, file.conditions.density, file.scaling.length
    assert nv.potential == pytest.approx((matrix[0][0] - matrix[1][1]) / (0.5 * density * length**3))
    assert yr.potential == pytest.approx(-matrix[0][0] / (0.5 * density * length**3))
    assert file.mass.centre == pytest.approx((0.01, 0.0, 0.02))
    assert file.mass.inertia_matrix[0][2] == pytest.approx(-0.01 - 40.0 * 0.01 * 0.02)
    assert file.models[0].holds == ("random", "angle beta", "speed")


def test_version_1_3_means_what_it_meant() -> None:
    """Two thrusters with a dead zone, of opposite hands; a rudder that needs four seconds to its limit."""
    file = read_parameter_file(NEWEST)
    left, right = file.thrusters
    assert [left.curve.at(c) for c in (-100.0, -10.0, 10.0, 100.0)] == pytest.approx([-14.2244, 0.0, 0.0, 14.2244])
    assert left.curve.at(150.0) == left.curve.at(100.0)
    assert (left.handedness, right.handedness, right.position[1]) == (1, -1, 0.1)
    assert file.surfaces[0].limit / file.surfaces[0].rate == pytest.approx(4.0)
    assert file.hydrostatics.gravity == 9.81


THRUSTER: list[tuple[str, Callable[[dict[str, Any]], object]]] = [
    ("left occurs more than once", lambda d: d["thrusters"][1].update(name="left")),
    ("direction is 2 long, not 1", lambda d: d["thrusters"][0].update(direction=[2.0, 0.0, 0.0])),
    (
        "thrust falls at a command of",
        lambda d: d["thrusters"][0]["curve"]["segments"][1].update(coefficients=[9.0, -0.1]),
    ),
    ("lie over each other", lambda d: d["thrusters"][0]["curve"]["segments"][1].update(low=-20.0)),
    ("a segment from 100 to 100", lambda d: d["thrusters"][0]["curve"]["segments"][1].update(low=100.0)),
    ("without room or axis", lambda d: d["thrusters"][0].update(tilt_axis=None)),
    ("without room or axis", lambda d: d["thrusters"][0].update(tilt_low=1.0)),
    ("greater than 0", lambda d: d["surfaces"][0].update(limit=0.0)),
    ("greater than 0", lambda d: d["hydrostatics"].update(volume=-1.0)),
]


@pytest.mark.parametrize(("says", "broken"), THRUSTER, ids=range(len(THRUSTER)))
def test_a_vehicle_that_cannot_be(tmp_path: Path, says: str, broken: Callable[[dict[str, Any]], object]) -> None:
    content = json.loads(NEWEST.read_bytes())
    broken(content)
    (tmp_path / "p.json").write_text(json.dumps(content))
    assert says in refused(tmp_path / "p.json")


def bare(content: dict[str, Any]) -> None:
    """Without thrusters, surfaces and hydrostatics."""
    content.update(hydrostatics=None, thrusters=[], surfaces=[])


def unbooked(content: dict[str, Any]) -> None:
    """Without centre of gravity, potential parts and what makes it a vehicle."""
    content["mass"] = None
    bare(content)
    for coefficient in content["coefficients"]:
        coefficient["potential"] = None


LATER: list[tuple[str, Callable[[dict[str, Any]], object]]] = [
    ("mass.centre", bare),
    (
        "hydrostatics",
        lambda d: d.update(
            mass=None, coefficients=[], covariance={"symbols": [], "matrix": []}, models=[], added_mass=None
        ),
    ),
    ("coefficients.potential", lambda d: (bare(d), d.update(mass=None))),
    ("models", unbooked),
    ("added_mass", lambda d: (unbooked(d), d.update(models=[]))),
]


@pytest.mark.parametrize(("named", "without"), LATER, ids=[name for name, _ in LATER])
def test_what_came_later_is_refused_in_an_earlier_version(
    tmp_path: Path, named: str, without: Callable[[dict[str, Any]], object]
) -> None:
    content = json.loads(NEWEST.read_bytes())
    without(content)
    content["schema_version"] = "1.0"
    (tmp_path / "p.json").write_text(json.dumps(content))
    message = refused(tmp_path / "p.json")
    assert f"{named} came with version 1." in message
    assert "this file says 1.0" in message


def test_versions_are_ordered_by_their_numbers() -> None:
    assert is_later("1.10", "1.9")
    assert not is_later("1.2", "1.2")
    assert not is_later("1.1", "1.2")


@pytest.mark.parametrize("source", ["study", "sample"])
def test_an_illegible_digit_stays_visible_without_a_value(suboff: Study, source: str) -> None:
    file = read_parameter_file(SAMPLE) if source == "sample" else suboff.parameter_files["suboff_bare_hull"]
    c = file.coefficient("Yvdot'")
    assert (c.value, c.u95, c.value_si, c.status, c.origin) == (None, None, None, "not_determined", "literature")
    assert "-0.01327?" in c.estimator
    row = file.covariance.symbols.index("Yvdot'")
    assert set(file.covariance.matrix[row]) == {None}
    legible = file.coefficient("Yrdot'")
    assert legible.value == pytest.approx(0.000060)


@pytest.mark.parametrize("name", FILES)
def test_values_agree_with_each_other(suboff: Study, name: str) -> None:
    """SI by the file's own length, density and speed; variance by U95 / 2; intervals only with values."""
    file = suboff.parameter_files[name]
    half_rho, u, length = file.conditions.density / 2.0, file.conditions.speed, file.scaling.length
    units = {
        "Yv'": u * length**2,
        "Nv'": u * length**3,
        "Yr'": u * length**3,
        "Nr'": u * length**4,
        "Yrdot'": length**4,
    }
    checked = 0
    for i, c in enumerate(file.coefficients):
        if c.symbol in units and c.value is not None:
            assert c.value_si == pytest.approx(c.value * half_rho * units[c.symbol], rel=1e-12)
            checked += 1
        variance = file.covariance.matrix[i][i]
        assert (variance is None) == (c.u95 is None)
        if variance is not None and c.u95 is not None:
            assert 2.0 * variance**0.5 == pytest.approx(c.u95, rel=1e-9)
    assert checked >= 2


Edit = Callable[[dict[str, Any]], object]
BAD: list[tuple[Edit, list[str]]] = [
    (lambda d: d["coefficients"].append(d["coefficients"][0]), ["occurs more than once"]),
    (lambda d: d["coefficients"][0].update(symbol="Yv"), ["without prime", "Yv'"]),
    (lambda d: d["coefficients"][0].update(symbol="Qv'"), ["coefficients.Qv'", "SNAME derivative"]),
    (lambda d: d["coefficients"][0].update(value="big"), ["coefficients.Yv'.value", 'found "big"', "a valid number"]),
    (lambda d: d["coefficients"][0].update(value=None), ["coefficients.Yv'", "does not go with status"]),
    (lambda d: d["coefficients"][0].update(u95=-1), ["coefficients.Yv'.u95", 'found "-1"']),
    (lambda d: d["coefficients"][0].update(unit="N"), ["coefficients.Yv'.unit"]),
    (lambda d: d["coefficients"][0].pop("value"), ["coefficients.Yv'.value", "found nothing"]),
    (lambda d: d["coefficients"][0].update(colour=1), ["coefficients.Yv'.colour", "an unknown key"]),
    (lambda d: d.pop("scaling"), ['"scaling": found nothing']),
    (lambda d: d.pop("schema_version"), ["schema_version"]),
    (
        lambda d: d.update(schema_version="2.0"),
        ['schema_version "2.0"', f"expected 1.0 to {SCHEMA_VERSION}", "release that wrote it"],
    ),
    (lambda d: d.update(schema_version=1), ['schema_version "1"']),
    (lambda d: d["scaling"].update(length=0), ["scaling.length", "greater than 0"]),
    (lambda d: d["conditions"].update(density=-1), ["conditions.density", "greater than 0"]),
    (lambda d: d["reference_point"].update(axes="FLU"), ["reference_point.axes", "'FRD'"]),
    (lambda d: d["reference_point"].update(point=[1, 2]), ["reference_point.point"]),
    (lambda d: d["covariance"]["matrix"][0].__setitem__(1, 1.0), ["covariance", "not symmetric"]),
    (lambda d: d["covariance"]["matrix"][0].__setitem__(1, None), ["covariance", "not symmetric"]),
    (lambda d: d["covariance"]["matrix"][0].__setitem__(0, -1e-9), ["the variance of", "is negative"]),
    (lambda d: d["covariance"]["matrix"].pop(), ["covariance", "must be"]),
    (lambda d: d["covariance"]["symbols"].__setitem__(0, "Kp'"), ["the covariance names Kp'", "no coefficients"]),
    (lambda d: d["covariance"]["symbols"].__setitem__(0, d["covariance"]["symbols"][1]), ["names a coefficient twice"]),
    (lambda d: d["provenance"]["inputs"][0].update(sha256="xyz"), ["provenance.inputs.0.sha256"]),
]


def refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_parameter_file(path)
    message = str(caught.value)
    assert path.name in message
    assert "\n" not in message
    assert len(message) < 500
    return message


@pytest.mark.parametrize(("edit", "said"), BAD, ids=range(len(BAD)))
def test_files_that_break_the_schema(tmp_path: Path, edit: Edit, said: list[str]) -> None:
    content = json.loads(SAMPLE.read_bytes())
    edit(content)
    (tmp_path / "p.json").write_text(json.dumps(content))
    message = refused(tmp_path / "p.json")
    for text in said:
        assert text in message


def in_place_of_a_value(token: str) -> bytes:
    text = SAMPLE.read_text()
    at = text.index('"value": ') + len('"value": ')
    return (text[:at] + token + text[text.index(",", at) :]).encode()


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (SAMPLE.read_bytes()[:700], ["line 33", "expected JSON"]),
        (b"", ["an empty file"]),
        (b"{", ["line 1", "expected JSON"]),
        (b"[" * 100 + b"]" * 100, ["an object"]),
        (b"[" * 100_000, ["a parameter file in JSON"]),
        (b"[]", ['"file"', "an object"]),
        (b"\xff\xfe{}", ["the byte 0xff", "UTF-8"]),
        (SAMPLE.read_bytes().replace(b'"name":', b'"name": "a", "name":', 1), ['found "name" twice in one object']),
        (in_place_of_a_value("NaN"), ["NaN is no JSON number"]),
        (in_place_of_a_value("-Infinity"), ["-Infinity is no JSON number"]),
        (in_place_of_a_value("1e999"), ["coefficients.Yv'.value", "finite number"]),
        (in_place_of_a_value("1" * 5000), ["p.json"]),
        (in_place_of_a_value('"\\ud800"'), ["p.json"]),
    ],
    ids=range(13),
)
def test_files_that_are_no_json(tmp_path: Path, content: bytes, said: list[str]) -> None:
    (tmp_path / "p.json").write_bytes(content)
    message = refused(tmp_path / "p.json")
    for text in said:
        assert text in message


def later(**more: Any) -> str:
    return json.dumps({**json.loads(SAMPLE.read_bytes()), "schema_version": "1.9", **more})


def test_a_later_minor_version_is_read_where_nothing_is_lost(tmp_path: Path) -> None:
    """Keys that nobody here knows are passed over where they are null or empty."""
    path = tmp_path / "p.json"
    content = json.loads(later(tethers=None, sails=[]))
    content["conditions"]["salinity"] = None
    path.write_text(json.dumps(content))
    file = read_parameter_file(path)
    assert file.schema_version == "1.9"
    assert [c.symbol for c in file.coefficients] == [c["symbol"] for c in content["coefficients"]]
    assert "tethers" not in file.to_json().decode()


def test_a_later_minor_version_that_says_more_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    for content, place in ((later(tethers=[{"length": 3.0}]), '"tethers"'), (later(name=3), '"name"')):
        path.write_text(content)
        message = refused(path)
        assert place in message
        assert "schema_version 1.9" in message
        assert f"1.0 to {SCHEMA_VERSION}" in message
        assert f"Update coeflab, or have the file written as version {SCHEMA_VERSION}" in message
    path.write_text(later(tethers=None).replace('"1.9"', '"1.0"'))
    assert "an unknown key" in refused(path)


@pytest.mark.parametrize("version", ["1." + "9" * 5000, "1.x", "1", "2.0", None])
def test_versions_that_are_none(tmp_path: Path, version: object) -> None:
    path = tmp_path / "p.json"
    path.write_text(later(schema_version=version))
    assert "schema_version" in refused(path)


def test_places_without_a_file(tmp_path: Path) -> None:
    assert "found a folder; expected a parameter file, NAME.parameters.json." in refused(tmp_path)
    (tmp_path / "sub.parameters.json").write_bytes(SAMPLE.read_bytes())
    assert f"In it: {tmp_path / 'sub.parameters.json'}." in refused(tmp_path)
    (tmp_path / "hull.STL").write_bytes(bytes(84))
    assert "found a mesh; expected a parameter file. Make one: coeflab vehicle" in refused(tmp_path / "hull.STL")
    assert "no such file" in refused(tmp_path / "nowhere.json")


def test_a_bom_is_harmless(tmp_path: Path) -> None:
    (tmp_path / "p.json").write_bytes(b"\xef\xbb\xbf" + SAMPLE.read_bytes())
    assert read_parameter_file(tmp_path / "p.json").to_json() == SAMPLE.read_bytes()


def test_rounding_is_no_asymmetry() -> None:
    content = json.loads(SAMPLE.read_bytes())
    matrix = content["covariance"]["matrix"]
    matrix[0][1] = 1e-16 * matrix[0][0]
    matrix[1][0] = -matrix[0][1]
    ParameterFile.model_validate(content)
