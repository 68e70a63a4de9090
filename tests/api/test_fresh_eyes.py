"""What fresh eyes tried on motions and did not find: intervals of figures, another rudder limit, families, short reprs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.core.options import described
from coeflab.fits import FITS
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import stability


@pytest.fixture(scope="module")
def sure() -> ParameterFile:
    """REMUS 100 with U95 of 10 % of every coefficient, which its file has none of."""
    file = cf.read_vehicle("remus100").file
    some = [c if c.value is None else replace(c, u95=0.1 * abs(c.value)) for c in file.coefficients]
    return file.model_copy(update={"coefficients": tuple(some)})


def test_draws_give_every_figure_its_interval(sure: ParameterFile) -> None:
    how = {"rudder": "8 deg", "free": ("u", "v", "r")}
    run = cf.simulate(sure, "turning_circle", draws=60, **how)  # type: ignore[arg-type]
    plain = cf.simulate(sure, "turning_circle", **how)  # type: ignore[arg-type]
    wide, narrow = run["tactical diameter"], plain["tactical diameter"]
    assert wide.value == narrow.value
    assert narrow.u95 is None
    assert wide.low is not None
    assert wide.high is not None
    assert wide.low < float(wide.value or 0.0) < wide.high
    assert wide.u95 == pytest.approx((wide.high - wide.low) / 2.0)
    half = sure.model_copy(
        update={"coefficients": tuple(c if c.u95 is None else replace(c, u95=c.u95 / 2.0) for c in sure.coefficients)}
    )
    less = cf.simulate(half, "turning_circle", draws=60, **how)["tactical diameter"]  # type: ignore[arg-type]
    assert float(less.u95 or 0.0) == pytest.approx(0.5 * wide.u95, rel=0.1)
    assert "no interval" in repr(narrow)
    assert f"{wide.low:.4g} to {wide.high:.4g}" in repr(wide)
    assert "95 % interval" in run.summary().headers


def test_draws_of_a_file_without_u95_are_refused() -> None:
    with pytest.raises(InputError, match="without any stated uncertainty"):
        cf.simulate("remus100", "zigzag", draws=60)


def test_another_rudder_limit_of_a_shipped_vehicle_and_a_turn_within_it() -> None:
    auv = cf.read_vehicle("remus100").equipped(rudder="8 deg, 20 deg/s")
    assert [(s.control, round(float(np.degrees(s.limit)), 9)) for s in auv.file.surfaces] == [("dr", 8.0)]
    assert auv.equipped() is auv
    short = {"longest": 5.0, "free": ("u", "v", "r")}
    turn = auv.simulate("turning_circle", **short)
    assert np.abs(turn.trajectory.controls["dr"]).max() == pytest.approx(np.radians(8.0))
    wide = cf.simulate("remus100", "turning_circle", **short)  # type: ignore[arg-type]
    assert np.abs(wide.trajectory.controls["dr"]).max() == pytest.approx(np.radians(15.0))
    with pytest.raises(InputError, match="at most 8 deg"):
        auv.simulate("turning_circle", rudder="15 deg", **short)


def test_the_family_of_an_operating_point_solves_the_equations() -> None:
    point = cf.trim("remus100", speed=1.5).point
    assert len(point.family) == point.dimension > 0
    scale = {u.name: u.scale for u in point.unknowns}
    for direction in point.family:
        assert set(direction) == set(point.values)
        assert max(abs(v) / scale[n] for n, v in direction.items()) == pytest.approx(1.0)
    assert repr(point).startswith("<OperatingPoint family: ")


def test_numbers_of_a_scale_model_are_a_finding_that_travels() -> None:
    v = np.linspace(-0.3, 0.3, 9)
    rows = {"v [m/s]": v, "Y [N]": -120.0 * v, "N [N m]": -60.0 * v}
    codes = {}
    for length in (2.4, 1.4):
        told = {"frame": "FRD", "length": length, "density": 1000, "speed": 1.5, "about": "nose, 0.7 m aft"}
        table = cf.read_table(rows, name="drift", **told)  # type: ignore[arg-type]
        auv = cf.vehicle("remus100", mass=30.5, coefficients=cf.fit(table))
        codes[length] = [f for f in auv.file.findings if f.code == "merge.scaled"]
    (found,) = codes[2.4]
    assert (str(found.severity), codes[1.4]) == ("warn", [])
    assert found.statistic == pytest.approx((2.4 / auv.file.scaling.length) ** 2)


def test_short_reprs() -> None:
    auv = cf.read_vehicle("remus100")
    export = cf.export(auv, "xdyn")
    for noun in (auv.linear(speed=1.5), cf.compare(auv, "remus100"), export, export.loss):
        text = repr(noun)
        assert text.startswith(f"<{type(noun).__name__} ")
        assert "=<" not in text
    assert "lossless" in repr(export)
    assert not any("propulsion is not" in line for line in export.loss.changes)  # type: ignore[union-attr]


def test_an_angle_of_a_fit_has_its_unit_or_is_in_degrees() -> None:
    text, bare = (cf.fit("suboff_roddy_2", largest_angle=a)["Yv'"] for a in ("6 deg", 6.0))
    assert (text.value, text.u95) == (bare.value, bare.u95)
    assert text.value != cf.fit("suboff_roddy_2")["Yv'"].value
    with pytest.raises(InputError, match="from 1 to 90"):
        cf.fit("suboff_roddy_2", largest_angle="2 rad")


def test_plugins_and_their_options_are_listed() -> None:
    assert [r[1] for r in cf.plugins("fits").rows] == list(FITS.names())
    assert {"validation", "simulator", "fit"} <= {r[0] for r in cf.plugins().rows}
    assert [r[0] for r in cf.plugins("surface").rows] == [o.name for o in described(FITS.load("surface").Options)]
    with pytest.raises(InputError, match="Did you mean slope_at_origin"):
        cf.plugins("slope_at_orign")
    with pytest.raises(KeyError, match=r"simulators among campaigns.*coeflab\.plugins"):
        cf.shipped_names()["simulators"]


def test_stability_is_a_frame_with_its_interval() -> None:
    auv = cf.vehicle("remus100", mass=30.5)
    found, (first, *_) = auv.stability(), stability(auv.file)
    assert found.loc["G_h", "value"] == first.value
    assert tuple(found.loc["G_h", ["low", "high"]]) == first.interval
    assert found.loc["G_h", "low"] < first.value < found.loc["G_h", "high"]
    with pytest.raises(KeyError, match=r"\.stability\(\)"):
        auv["G_h"]
    with pytest.raises(InputError, match="remus100 without Yv', Nv', Yr', Nr'"):
        cf.read_vehicle("remus100").stability()


def test_a_loss_and_a_check_print_what_they_hold() -> None:
    loss = cf.export("remus100", "gazebo").loss
    lines = str(loss).splitlines()
    assert len(lines) == 1 + len(loss.not_held) + len(loss.lost) + len(loss.changes) > 2
    assert all(any(words in line for line in lines) for words in (*loss.not_held, *loss.changes))
    check = next(c for c in cf.read_vehicle("remus100").checks if c.comment)
    assert check.statistic in str(check)
    assert check.comment in str(check)


def test_the_text_of_a_matrix_is_no_path() -> None:
    with pytest.raises(InputError, match=r"write_text\(text\)"):
        cf.tow("suboff_bare_hull", "[matrix]\nyaw = [0.1]\n")
