"""Tables as people have them of a craft without a bow, and of coefficients over two angles: numbers by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError

AT = {
    "frame": "FRD",
    "about": "midship",
    "density": 1000,
    "length": 0.5,
    "contains_inertia": False,
    "arm_point": "reference point",
}
A, B = (0.3, 0.2, 0.1), (12.0, 9.0, 0.2)


def one_at_a_time() -> dict[str, Any]:
    """u, v and r, each alone, with a row at rest each."""
    each = np.linspace(-1.0, 1.0, 9)
    v = np.zeros((27, 3))
    for i in range(3):
        v[9 * i : 9 * i + 9, i] = each
    f = -(np.array(A) + np.array(B) * np.abs(v)) * v
    motion = dict(zip(("u [m/s]", "v [m/s]", "r [rad/s]"), v.T, strict=True))
    return motion | dict(zip(("X [N]", "Y [N]", "N [N m]"), f.T, strict=True))


def test_rows_that_stand_still_are_primed_by_the_speed_that_is_said() -> None:
    with pytest.raises(InputError, match="speed"):
        cf.read_table(one_at_a_time(), **AT)
    table = cf.read_table(one_at_a_time(), speed=0.9, **AT)
    u, v = table.motion["u"], table.motion["v"]
    np.testing.assert_allclose(table.speed, np.where(u + v == 0.0, 0.9, np.hypot(u, v)))
    (found,) = (f for f in table.findings if f.code == "assumed.on_the_spot")
    assert (found["rows"], found.statistic) == (11, 0.9)
    result = cf.fit(table, "linear_quadratic_damping")
    for symbol, a, b in (("Xu", *_of(0)), ("Yv", *_of(1)), ("Nr", *_of(2))):
        unit = table.scaling.unit(symbol, 1000.0, 0.9)
        square = f"{symbol}|{symbol[1]}|"
        assert result[symbol].value * unit == pytest.approx(-a, rel=1e-6)
        assert result[square].value * table.scaling.unit(square, 1000.0, 0.9) == pytest.approx(-b, rel=1e-6)


def _of(i: int) -> tuple[float, float]:
    return A[i], B[i]


@pytest.mark.parametrize("said", ["side", "side [coefficient]"])
def test_coefficients_take_the_area_that_all_share(said: str) -> None:
    beta = np.radians(np.arange(-20.0, 21.0, 4.0))
    drag, side, yaw = 0.4 + beta**2, -2.0 * beta, 0.5 * beta
    table = {"beta [deg]": np.degrees(beta), "C_D [-]": drag, "C_S [-]": side, "C_n [-]": yaw}
    at = {
        "frame": "FRD",
        "about": "midship",
        "density": 1010,
        "speed": 1.5,
        "beta": "+",
        "length": "1.4 m hull",
        "moment_length": "1.4 m",
    }
    found = cf.read_table(table, columns={"C_S": said, "C_D": "drag", "C_n": "N"}, area="0.03 m^2", **at)
    q = 0.5 * 1010 * 1.5**2 * 0.03
    np.testing.assert_allclose(found.forces["Y"], q * (side * np.cos(beta) - drag * np.sin(beta)), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found.forces["N"], q * 1.4 * yaw, rtol=1e-9, atol=1e-9)
    primed = cf.read_table(table, columns={"C_S": said, "C_D": "drag", "C_n": "N"}, area="prime", **at)
    np.testing.assert_allclose(primed.forces["N"], 0.5 * 1010 * 1.5**2 * 1.4**3 * yaw, rtol=1e-9, atol=1e-9)
    with pytest.raises(InputError, match="area"):
        cf.read_table(table, columns={"C_S": said}, **at)


@pytest.mark.parametrize("length", [1900, "1900", "1900 LOA", 0.004])
def test_a_bare_length_of_no_hull_is_asked_back(length: Any, tmp_path: Path) -> None:
    """mm without their unit: primes of forces would be 1e6 too small. With its unit it counts."""
    table = {"v [m/s]": np.linspace(-0.3, 0.3, 5), "Y [N]": np.linspace(30.0, -30.0, 5)}
    at = {"frame": "FRD", "about": "midship", "density": 1000, "speed": 2.0}
    with pytest.raises(InputError, match=r'Then write "(1900 mm|0.004 km)"; if not, "(1900|0.004) m"'):
        cf.read_table(table, length=length, **at)
    assert cf.read_table(table, length="1900 mm LOA", **at).scaling.length == pytest.approx(1.9)
    assert cf.read_table(table, length="1900 m LOA", **at).scaling.length == 1900.0
    with pytest.raises(InputError, match="without a unit"):
        cf.fit(cf.read_table(table, length=1.9, **at), length=float(str(length).split()[0]), length_name="LOA")
    (tmp_path / "plan.toml").write_text(
        f'[study]\nname = "a"\n[scaling]\nlength = {str(length).split()[0]}\nlength_name = "L"\n[[table]]\ncampaign = "suboff_roddy_2"\n'
    )
    with pytest.raises(InputError, match=r"line 4.*without a unit"):
        cf.read_plan(tmp_path / "plan.toml")


def test_forces_alone_need_no_point() -> None:
    """A drift test of forces without moments and rates holds about every point: nobody is asked, and others give the point."""
    beta, rate = np.radians(np.arange(-12.0, 13.0, 3.0)), np.linspace(-0.3, 0.3, 9)
    at = {"frame": "FRD", "length": 2.0, "density": 1000, "speed": 2.0}
    drift = cf.read_table(
        {"beta [deg]": np.degrees(beta), "Y [N]": -480.0 * np.sin(beta)}, name="drift", beta="+", **at
    )
    assert (drift.datum.id, drift.reference_point.tolist()) == ("anywhere", [0.0, 0.0, 0.0])
    assert cf.fit(drift)["Yv'"].value == pytest.approx(-480.0 / 8000.0)
    for more in ({"N [N m]": beta}, {"r [rad/s]": beta}):
        with pytest.raises(InputError, match="about"):
            cf.read_table({"beta [deg]": np.degrees(beta), "Y [N]": beta} | more, beta="+", **at)
    turning = {"r [rad/s]": rate, "Y [N]": 20.0 * rate, "N [N m]": -30.0 * rate}
    arm = cf.read_table(
        turning, name="arm", about="nose, 1 m aft", contains_inertia=False, arm_point="reference point", **at
    )
    joint = cf.fit([drift, arm], terms=["Yv", "Yr", "Nr"])
    assert joint.fits[0].coefficients.datum.id == "nose"
    assert (joint["Yv'"].value, joint["Nr'"].value) == pytest.approx((-0.06, -30.0 / 16000.0))
    auv = cf.vehicle("spheroid_example", mass=390, coefficients=cf.fit(drift))
    assert auv["Yv'"].value * auv.file.scaling.length**2 == pytest.approx(-0.06 * 4.0, rel=1e-3)
