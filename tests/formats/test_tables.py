"""Tables for look-up simulators: every coefficient, every fitted model on a grid, whatever the names are."""

from __future__ import annotations

import csv
import io
import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.core.provenance import work
from coeflab.core.text.toml import toml_text
from coeflab.formats.csv import write as csv_exporter
from coeflab.formats.export import export
from coeflab.formats.look_up import look_up
from coeflab.formats.toml import write as toml_exporter
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile, read_parameter_file
from tests.formats import files as made

SAMPLE = Path(__file__).parents[1] / "data" / "parameters_1_1.json"


def sample() -> ParameterFile:
    return read_parameter_file(SAMPLE)


def only(files: dict[str, bytes]) -> dict:
    (content,) = files.values()
    return tomllib.loads(content.decode())


def test_toml_holds_every_coefficient_and_the_added_mass() -> None:
    file = made.full(1)
    read = only(toml_exporter.render(file))
    assert [c["symbol"] for c in read["coefficient"]] == [c.symbol for c in file.coefficients]
    for row, c in zip(read["coefficient"], file.coefficients, strict=True):
        assert (row.get("value"), row.get("value_si"), row.get("potential"), row["law"]) == (
            c.value, c.value_si, c.potential, c.law,
        )  # fmt: skip
    assert read["added_mass"]["matrix"] == [list(r) for r in file.added_mass.matrix]
    assert read["scaling"] == {"length": 2.0, "length_name": "LOA"}
    assert read["reference_point"]["axes"] == "FRD"
    assert "mass" not in read


def test_toml_tables_are_the_models_on_their_grids() -> None:
    file = sample()
    read = only(toml_exporter.render(file))["table"]
    assert len(read) == len(file.models) > 0
    for table, model in zip(read, file.models, strict=True):
        assert table["variables"] == list(model.names)
        assert [a[0] for a in table["axes"]] == list(model.domain.low)
        assert [a[-1] for a in table["axes"]] == list(model.domain.high)
        points = np.meshgrid(*table["axes"], indexing="ij")
        columns = {n: p.ravel() for n, p in zip(model.names, points, strict=True)}
        values, half, inside = model.evaluate(columns)
        np.testing.assert_array_equal(np.ravel(table["values"]), values)
        np.testing.assert_array_equal(np.ravel(table["half_widths_95"]), half)
        np.testing.assert_array_equal(np.ravel(table["inside"]), inside)


def test_csv_tables_are_the_same_numbers() -> None:
    file = sample()
    written = csv_exporter.render(file)
    assert f"{file.name}.coefficients.csv" in written
    tables = [content for name, content in written.items() if ".table_" in name]
    assert len(tables) == len(file.models)
    for content, model in zip(tables, file.models, strict=True):
        header, *rows = csv.reader(io.StringIO(content.decode()))
        d = len(model.names)
        assert [h.partition(" ")[0] for h in header[:d]] == list(model.names)
        columns = {n: np.array([float(r[k]) for r in rows]) for k, n in enumerate(model.names)}
        values, half, inside = model.evaluate(columns)
        np.testing.assert_array_equal([float(r[d] or "nan") for r in rows], values)
        np.testing.assert_array_equal([float(r[d + 1] or "nan") for r in rows], half)
        assert [r[d + 2] == "true" for r in rows] == list(inside)


def test_a_row_of_a_csv_says_what_it_is_about() -> None:
    file = sample()
    given = {"Yv'": "v", "Nr'": "r", "Ydr'": "dr"}
    fitted = [c for c in file.coefficients if c.symbol in given]
    rest = replace(fitted[0], symbol="X0'", citation="roddy1990", campaign="tow", window=(-0.2, 0.1))
    rows = [*(replace(c, window=(-0.3, 0.2)) for c in fitted), rest]
    ranges = [
        CoveredRange(variable="asin(v/U)", low=-0.2, high=0.1, unit="rad", campaign="tow"),
        CoveredRange(variable="r'", low=-0.2, high=0.1, unit="1", campaign="arm"),
    ]
    made = csv_exporter.render(file.model_copy(update={"coefficients": tuple(rows), "covered": tuple(ranges)}))
    read = list(csv.DictReader(io.StringIO(made[f"{file.name}.coefficients.csv"].decode())))
    windows = {r["symbol"]: (r["window_over"], r["window_unit"]) for r in read}
    known = {"Yv'": ("asin(v/U)", "rad"), "Nr'": ("r'", "1"), "Ydr'": ("dr", "rad"), "X0'": ("asin(v/U)", "rad")}
    assert windows == {c.symbol: known[c.symbol] for c in rows}
    point = file.reference_point
    for row in read:
        assert float(row["length [m]"]) == file.scaling.length
        assert row["length_name"] == file.scaling.length_name
        assert [float(row[f"reference_point_{x} [m]"]) for x in "xyz"] == list(point.point)
        assert row["datum"] == str(point.datum)
        assert float(row["density [kg/m^3]"]) == file.conditions.density
        assert float(row["speed [m/s]"]) == file.conditions.speed
        assert row["body"] == file.body
    assert read[-1]["source"] == work("roddy1990")
    assert read[-1]["citation"] == "roddy1990"
    assert read[-1]["campaign"] == "tow"


def test_outside_the_data_nothing_is_written() -> None:
    """A domain that is half its box, and a reader who is refused beyond it."""
    model = next(m for m in sample().models if len(m.names) == 2)
    (a, b), (c, d) = model.domain.low, model.domain.high
    corner = (1.0 / (c - a), 1.0 / (d - b), -1.0 - a / (c - a) - b / (d - b))
    half = model.domain.model_copy(update={"half_spaces": (corner,), "extrapolation": "refuse"})
    table = look_up(model.model_copy(update={"domain": half}))
    assert 0.4 < np.mean(~table.inside) < 0.5
    assert np.array_equal(np.isnan(table.values), ~table.inside)
    file = sample().model_copy(update={"models": (table.model,)})
    values = only(toml_exporter.render(file))["table"][0]["values"]
    assert math.isnan(values[-1][-1])
    (_, cells) = csv_exporter.render(file).values()
    assert cells.decode().splitlines()[-1].endswith(",,,false")


def test_zero_is_on_the_grid() -> None:
    for model in sample().models:
        for axis in look_up(model).axes:
            assert axis[0] >= 0.0 or axis[-1] <= 0.0 or 0.0 in axis
            assert np.all(np.diff(axis) > 0.0)


@pytest.mark.parametrize("name", made.HOSTILE)
def test_hostile_names_are_text(name: str) -> None:
    file = made.named(name)
    assert only(toml_exporter.render(file))["name"] == name
    for target in ("toml", "csv", "mss"):
        for written in export(file, target).files:
            assert re.fullmatch(r"\w[\w .+-]{0,110}", written)


TEXTS = st.text(max_size=20)
VALUES = st.one_of(TEXTS, st.booleans(), st.integers(-(2**60), 2**60), st.floats(allow_nan=False, allow_infinity=False))
LISTS = st.lists(VALUES, max_size=4)
TABLES = st.dictionaries(TEXTS, VALUES | LISTS, max_size=4)


@given(st.dictionaries(TEXTS, VALUES | LISTS | TABLES | st.lists(TABLES, min_size=1, max_size=3), max_size=5))
def test_toml_comes_back(content: dict) -> None:
    assert tomllib.loads(toml_text(content)) == content
