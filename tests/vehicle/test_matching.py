"""One vehicle in two spellings and about two points is one vehicle; a single added mass is an entry of a matrix."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import ScalingMismatchError
from coeflab.law.added_mass import AddedMass
from coeflab.motion.behaviour import behaviour
from coeflab.vehicle.comparison import compare
from coeflab.vehicle.matching import plain_name
from coeflab.vehicle.merge import merged
from coeflab.vehicle.own_numbers import as_file, own_numbers, typed_file
from coeflab.vehicle.parameter_file import ParameterFile, ParameterPoint

YV, NV, YR, NR, X = -0.031, -0.012, 0.006, -0.0055, 0.07  # X: in lengths, ahead; all made up
M = {"m": 46.0, "xg": 0.01}


def file(slope: str, ahead: float, added: str = "stated", u95: str = "") -> ParameterFile:
    """About a point ``ahead`` of the nose's datum, in lengths of 2.5 m: the transfer of conventions.md by hand."""
    nv, yr = NV - ahead * YV, YR - ahead * YV
    nr = NR - ahead * (NV + YR) + ahead**2 * YV
    names = {"plain": ("Yv", "Nv", "Yr", "Nr", "X0"), "products": ("Yuv", "Nuv", "Yur", "Nur", "Xu|u|")}[slope]
    numbers = [f"{n}'={v!r}{u95}" for n, v in zip(names, (YV, nv, yr, nr, -0.003), strict=True)]
    a22, a26, a66 = 0.03, 0.001, 0.0016
    mine = {
        "Yvdot": -a22,
        "Nvdot": -(a26 - ahead * a22),
        "Yrdot": -(a26 - ahead * a22),
        "Nrdot": -(a66 - 2.0 * ahead * a26 + ahead**2 * a22),
    }
    if added == "stated":
        numbers += [f"{n}'={v!r}" for n, v in mine.items()]
    x = M["xg"] - ahead * 2.5
    made = typed_file("auv", numbers, length="2.5 m", length_name="LOA", speed="1.5 m/s", density="1025", about="nose", mass="46",
                      cg=f"{x},0,0.02", inertia="1,20,20")  # fmt: skip
    point = made.reference_point.model_copy(update={"point": (ahead * 2.5, 0.0, 0.0)})
    made = made.model_copy(update={"reference_point": point})
    if added == "matrix":
        unit = {(1, 1): "Yvdot", (1, 5): "Yrdot", (5, 1): "Nvdot", (5, 5): "Nrdot"}
        matrix = np.zeros((6, 6))
        for at, symbol in unit.items():
            matrix[at] = -mine[symbol] * made.scaling.unit(symbol, 1025.0)
        hull = AddedMass(matrix, np.array(point.point), point.origin, "auv", "stated", density=1025.0)
        made = made.model_copy(update={"added_mass": hull})
    return made


def test_names() -> None:
    assert [plain_name(s) for s in ("Yuv'", "Y|u|v", "Nur", "Xuu", "Yuudr", "Yuvv", "Yvr", "Yvdot")] == [
        "Yv", "Yv", "Nr", "X0", "Ydr", "Yuvv", "Yvr", "Yvdot",
    ]  # fmt: skip


def test_one_vehicle_in_two_spellings_about_two_points_differs_by_zero() -> None:
    found = compare(file("plain", 0.0), file("products", 0.3, "matrix"))
    rows = {r.symbol: r for r in found.rows}
    assert set(rows) == {"Yv'", "Nv'", "Yr'", "Nr'", "X0'", "Yvdot'", "Nvdot'", "Yrdot'", "Nrdot'"}
    for r in found.rows:
        assert r.difference == pytest.approx(0.0, abs=1e-12), r.symbol
    assert any("Yuv'" in s for s in found.statements)
    assert any("added mass matrix" in s and "Nrdot'" in s for s in found.statements)


def test_points_of_two_datums_are_placed_by_the_centre_of_gravity() -> None:
    """The same vehicle about its nose and about a point called midship; not where a mass is another, nor where one states none."""
    a, b = file("plain", -0.5), file("products", 0.3, "matrix")
    named = ParameterPoint(point=(0.0, 0.0, 0.0), datum="midship")
    a = a.model_copy(update={"reference_point": named})
    for r in compare(a, b).rows:
        assert r.difference == pytest.approx(0.0, abs=1e-12), r.symbol
    found = {r.name: r for r in behaviour(a, b, 1.5)}
    assert found["G_h"].difference == pytest.approx(0.0, abs=1e-9)
    assert b.mass is not None
    heavier = b.model_copy(update={"mass": replace(b.mass, mass=47.0)})
    for other in (heavier, b.model_copy(update={"mass": None})):
        assert [r.symbol for r in compare(a, other).rows if r.symbol == "Nv'" and r.difference is None] == ["Nv'"]


def test_a_slope_five_per_cent_apart_is_seen() -> None:
    wrong = merged(
        file("products", 0.3), as_file(file("products", 0.3), own_numbers(["Yuv'=-0.03255"])), alone=True
    ).parameters
    rows = {r.symbol: r for r in compare(file("plain", 0.0), wrong).rows}
    assert rows["Yv'"].difference == pytest.approx(0.05 * YV)


def test_they_do_the_same() -> None:
    a, b = file("plain", 0.0, u95=" +- 0.001"), file("products", 0.3, "matrix", u95=" +- 0.001")
    found = {r.name: r for r in behaviour(a, b, 1.5)}
    assert found["G_h"].difference == pytest.approx(0.0, abs=1e-9)
    # In drift the two spellings are two laws, U v and u v: apart by less than 1 - u/U at v/U = .25.
    for name in ("Y over v/U", "N over v/U"):
        assert abs(found[name].difference or 0.0) <= 0.032 * max(
            abs(found[name].a or 0.0), abs(found[name].b or 0.0)
        ), name
        assert found[name].combined is not None
    for k in (1, 2):
        one = found[f"eigenvalue {k}, horizontal"]
        assert one.difference == pytest.approx(0.0, abs=1e-6 * abs(one.a or 1.0))


def test_merge_takes_the_number_under_the_name_of_the_base() -> None:
    base = file("products", 0.3)
    other = typed_file(
        "tank",
        ["Yv'=-0.04", "Nv'=-0.02"],
        length="2.5 m",
        length_name="LOA",
        speed="1.5 m/s",
        density="1025",
        about="nose",
    )
    done = merged(base, other).parameters
    symbols = [c.symbol for c in done.coefficients]
    assert symbols.count("Yuv'") == 1
    assert "Yv'" not in symbols
    yuv, nuv = done.coefficient("Yuv"), done.coefficient("Nuv")
    assert yuv.value == pytest.approx(-0.04)
    assert nuv.value == pytest.approx(-0.02 - 0.3 * -0.04)


def test_zeros_of_a_matrix_are_numbers_that_a_move_needs() -> None:
    """A diagonal matrix at x = -1 m has Mqdot of Iyy + m33 x^2 and Mwdot of m33 x about the nose."""
    about = {"length": "2 m", "length_name": "LOA", "speed": "1.5 m/s", "density": "1025", "about": "nose"}
    diagonal = {"Zwdot": 55.0, "Mqdot": 12.0 + 55.0, "Mwdot": 55.0, "Zqdot": 55.0, "Xqdot": 0.0, "Mudot": 0.0}
    bare = typed_file("one", ["Yv'=-0.05"], **about)
    stated = [f"{s}'={0.0 - m / bare.scaling.unit(s, 1025.0)!r}" for s, m in diagonal.items()]
    point = bare.reference_point.model_copy(update={"point": (-1.0, 0.0, 0.0)})
    hull = AddedMass(np.diag([3.0, 50.0, 55.0, 0.5, 12.0, 13.0]), np.array(point.point), point.origin, "one", "stated",
                     density=1025.0)  # fmt: skip
    there = bare.model_copy(update={"reference_point": point, "added_mass": hull})
    rows = {r.symbol: r for r in compare(typed_file("one", ["Yv'=-0.05", *stated], **about), there).rows}
    for symbol in diagonal:
        assert rows[f"{symbol}'"].difference == pytest.approx(0.0, abs=1e-12), symbol


@pytest.mark.parametrize("turned", [False, True])
def test_what_holds_about_every_point_is_held_against_a_vehicle_of_any_datum(turned: bool) -> None:
    whole = cf.read_vehicle("remus100").file
    forces = tuple(replace(c, value=1.2 * c.value) for c in whole.coefficients if c.symbol in ("Yuv'", "Xu|u|'"))
    point = ParameterPoint(point=(0.3, 0.0, 0.1), datum="anywhere", axes="FRD")
    none = type(whole.covariance)(symbols=(), matrix=())
    free = whole.model_copy(
        update={
            "coefficients": forces,
            "reference_point": point,
            "covariance": none,
            "added_mass": None,
            "name": "free",
        }
    )
    found = compare(free, whole) if turned else compare(whole, free)
    ratios = {r.symbol: r.b / r.a for r in found.rows if r.a and r.b}
    assert ratios == pytest.approx(dict.fromkeys(("Yv'", "X0'"), 1 / 1.2 if turned else 1.2))
    assert not [s for s in found.statements if "datum" in s or "moved" in s or "placed" in s]


def test_coefficients_of_another_datum_go_in_once_their_file_states_the_point_from_this_one(tmp_path: Path) -> None:
    with pytest.raises(ScalingMismatchError, match=r'"datum": "nose", "point": \[x, y, z\]'):
        cf.vehicle("remus100", coefficients="remus100")
    content = json.loads(cf.read_vehicle("remus100").file.to_json())
    content["reference_point"].update(datum="nose", point=[-0.611, 0.0, 0.0])
    (tmp_path / "from_nose.parameters.json").write_text(json.dumps(content), encoding="utf-8")
    auv = cf.vehicle("remus100", coefficients=tmp_path / "from_nose.parameters.json")
    assert auv["Nv'"].value == pytest.approx(cf.read_vehicle("remus100")["Nuv'"].value, rel=1e-9)
