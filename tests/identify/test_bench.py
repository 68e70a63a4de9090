"""Thrust and torque curves from bench tests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.identify.thruster import BenchTest, bench_test, with_curves
from coeflab.vehicle.own_numbers import typed_file
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

THRUST, TORQUE = (3.0e-5, 1.2e-7), (2.0e-6, 1.5e-9)
LEVELS = (1000.0, 2500.0, 4000.0, 6000.0, 8000.0)


@pytest.fixture(scope="module")
def air() -> ParameterFile:
    return read_parameter_file(Path("flyingfish_air"))


def series(
    folder: Path, noise: float = 0.0, rest: float = 0.0, header: str = "t [s],speed [rpm],T [N],Q [N*m]"
) -> Path:
    """Five levels of 3 s at 20 rows a second, each reached within half a second."""
    time = np.arange(0.0, 15.0, 0.05)
    level = np.array(LEVELS)[np.minimum((time / 3.0).astype(int), 4)]
    before = np.concatenate([[0.0], LEVELS])[np.minimum((time / 3.0).astype(int), 4)]
    speed = before + (level - before) * np.clip((time % 3.0) / 0.5, 0.0, 1.0)
    rng = np.random.default_rng(3)
    loads = [a * speed + b * speed**2 for a, b in (THRUST, TORQUE)]
    thrust, torque = (x + noise * x.max() * rng.normal(size=len(x)) for x in loads)
    rows = [f"{t:.3f},{n:.6f},{a + rest:.9f},{b:.12f}" for t, n, a, b in zip(time, speed, thrust, torque, strict=True)]
    path = folder / "bench.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_exact_series_give_back_their_factors(tmp_path: Path, air: ParameterFile) -> None:
    found = bench_test([series(tmp_path)], air, "rotor1")
    assert found.command == pytest.approx(LEVELS, abs=1e-6)
    for law, due in zip(found.laws, (THRUST, TORQUE), strict=True):
        assert law.value == pytest.approx(due, rel=1e-6)
        assert not law.biased
    assert found.laws[0].file_value == pytest.approx((2.8619e-5, 1.1587e-7))
    assert [row[-1] for row in found.table().rows] == ["no"] * 4


def test_noise_widens_and_a_load_at_rest_is_said(tmp_path: Path, air: ParameterFile) -> None:
    found = bench_test([series(tmp_path, noise=0.01, rest=0.5)], air, "rotor2")
    assert found.laws[0].rest == pytest.approx(0.5, abs=found.laws[0].rest_u95)
    assert any("the balance reads a thrust at rest" in s for s in found.statements)
    torque = found.laws[1]
    assert np.all(np.abs(torque.value - TORQUE) <= torque.u95)
    assert np.all(torque.u95 > 0.0)


def test_thrust_alone_is_enough(tmp_path: Path, air: ParameterFile) -> None:
    found = bench_test([series(tmp_path, header="t [s],rotor1 [rpm],thrust [kN],other [1]")], air, "rotor1")
    assert [law.load for law in found.laws] == ["thrust"]
    assert found.laws[0].value == pytest.approx(np.array(THRUST) * 1e3, rel=1e-6)


@pytest.mark.parametrize(
    ("header", "name", "says"),
    [
        ("t [s],speed [rpm],T [N],Q [N*m]", "rotor7", "one of rotor1, rotor2, rotor3, rotor4"),
        ("t [s],speed [rad/s],T [N],Q [N*m]", "rotor1", r"\[rpm\], as the curve has it"),
        ("t [s],speed [rpm],lift [N],Q [N*m]", "rotor1", "no column T or thrust"),
        ("t [s],speed [rpm],T [kg],Q [N*m]", "rotor1", "kg"),
    ],
)
def test_what_cannot_be_read(tmp_path: Path, air: ParameterFile, header: str, name: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        bench_test([series(tmp_path, header=header)], air, name)


def test_a_speed_that_never_stands_is_refused(tmp_path: Path, air: ParameterFile) -> None:
    path = tmp_path / "ramp.csv"
    rows = [f"{t:.3f},{500.0 * t:.3f},{t:.3f},{t:.3f}" for t in np.arange(0.0, 10.0, 0.05)]
    path.write_text("\n".join(["t [s],speed [rpm],T [N],Q [N*m]", *rows]) + "\n")
    with pytest.raises(InputError, match="0 steady stretches"):
        bench_test([path], air, "rotor1")


def both_ways(folder: Path, torque_astern: float = -1.0) -> tuple[ParameterFile, BenchTest]:
    """60 N and 2 N m at 720 rpm, 30 N and 2 N m at -720, with the square of the command on each side."""
    base = typed_file(
        "auv", ["Xuu=-10 N/(m/s)^2"], length="2 m", length_name="LOA", speed="2 m/s", density="1000", about="cg",
        mass="50", thrusters=["main; bollard = 60 N; rate = 720"],
    )  # fmt: skip
    commands = np.repeat((-720.0, -500.0, -300.0, 300.0, 500.0, 720.0), 60)
    shares = (commands / 720.0) ** 2
    thrust, torque = (
        shares * np.where(commands < 0.0, -30.0, 60.0),
        shares * np.where(commands < 0.0, 2.0 * torque_astern, 2.0),
    )
    rows = [f"{0.05 * k:.3f},{n},{a},{b}" for k, (n, a, b) in enumerate(zip(commands, thrust, torque, strict=True))]
    path = folder / "bench.csv"
    path.write_text("\n".join(["t [s],speed [rpm],T [N],Q [N*m]", *rows]) + "\n")
    found = bench_test([path], base, "main")
    return with_curves(base, found), found


def test_each_side_of_zero_has_its_own_thrust(tmp_path: Path) -> None:
    made, found = both_ways(tmp_path)
    main = made.thrusters[0]
    assert found.factors == ("n^2 ahead", "n^2 astern")
    assert found.laws[0].value * 720.0**2 == pytest.approx(
        [60.0, -30.0]
    )  # before: a n + b n^2 of both, 75 % off astern
    assert found.at(found.laws[0], np.array([-360.0, 0.0, 360.0])) == pytest.approx([-7.5, 0.0, 15.0])
    assert [main.curve.at(n) for n in (-720.0, -360.0, 0.0, 360.0, 720.0)] == pytest.approx([-30, -7.5, 0, 15, 60])
    assert main.torque_curve is not None
    assert [main.torque_curve.at(n) for n in (-720.0, -360.0, 720.0)] == pytest.approx([-2.0, -0.5, 2.0])
    assert sum("scatter" in n for n in made.provenance.notes) == 2


def test_torque_astern_has_the_sign_of_the_command(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="sign of its command"):
        both_ways(tmp_path, torque_astern=1.0)


def test_a_tachometer_at_rest_turns_no_rotor_astern(tmp_path: Path, air: ParameterFile) -> None:
    """A stretch at rest that reads -0.4 rpm: the curve is that of the stretches ahead, and begins at zero."""
    path = series(tmp_path)
    head, *rows = path.read_text().splitlines()
    still = [f"{-3.0 + 0.05 * i:.3f},-0.4,0.001,-0.0000001" for i in range(60)]
    path.write_text("\n".join([head, *still, *rows]) + "\n")
    found = bench_test([path], air, "rotor1")
    assert found.command == pytest.approx((0.0, *LEVELS), abs=1e-6)
    curve = next(t for t in with_curves(air, found).thrusters if t.name == "rotor1").curve
    assert [(s.low, *s.coefficients) for s in curve.segments] == [
        pytest.approx((0.0, 0.0, *THRUST), rel=1e-3, abs=1e-9)
    ]
