"""Tuning of a parameter file: planted values, priors, what is open, the written file, and bad plans."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.identify.tune import tune, tuning_problem, write
from coeflab.identify.tuning import BOUND, OK, OPEN, PRIOR, SIGN, TunedParameter, driving
from coeflab.identify.tuning_plan import moved, place, read_tuning_plan, value_at
from coeflab.motion.steady_state import steady_motions, wrenches
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.parameter_file import read_parameter_file

HUUV = shipped("cfd_data") / "huuv"
PLANTED = {
    "thruster left ahead c0": -2.0,
    "thruster right ahead c0": -2.0,
    "C_D 1": 0.09,
    "C_S beta": -0.3,
    "C_n beta": 0.05,
}
COMMANDS = [(0, 60), (20, 60), (30, 80), (40, 100), (0, 100), (20, 90), (60, 60), (60, 20)]
FREE = """
[[free]]
name = "intercept"
places = ["thruster left ahead c0", "thruster right ahead c0"]
[[free]]
places = ["C_D 1"]
[[free]]
places = ["C_S beta"]
[[free]]
places = ["C_n beta"]
"""
HEAD = '[tune]\nname = "planted"\nparameters = "PARAMETERS"\n[measured]\ntable = "turns.csv"\n'
ERRORS = 'errors = { u = "0.01 m/s", beta = "0.3 deg", r = "1 deg/s" }\n'
Write = Callable[..., Path]


def table(noise: float = 0.0) -> str:
    """Turns of a vehicle with planted values, r signed; the straight course has beta and r of zero."""
    p = read_parameter_file(HUUV / "huuv.parameters.json")
    p = moved(p, {place(t, p): v for t, v in PLANTED.items()})
    made = vehicle(p, free=("u", "v", "r"))
    nu, found = steady_motions(made, wrenches(made, [{"left": a, "right": b} for a, b in COMMANDS]))
    assert found.all()
    rng = np.random.default_rng(4)
    lines = ["left [%],right [%],u [m/s],beta [deg],r [deg/s]"]
    for (a, b), (u, v, _, _, _, r) in zip(COMMANDS, nu, strict=True):
        figures = np.array([u, np.degrees(np.arcsin(v / np.hypot(u, v))), np.degrees(r)])
        figures += noise * np.array([0.01, 0.3, 1.0]) * rng.normal(size=3)
        lines.append(f"{a},{b}," + ",".join(f"{f:.12g}" for f in figures))
    return "\n".join(lines) + "\n"


@pytest.fixture
def plan(tmp_path: Path) -> Write:
    """Write a plan and its table; keywords replace their parts."""

    def made(free: str = FREE, measured: str = ERRORS, csv: str | None = None, head: str = HEAD) -> Path:
        (tmp_path / "turns.csv").write_text(table() if csv is None else csv)
        text = head.replace("PARAMETERS", str(HUUV / "huuv.parameters.json")) + measured + free
        (tmp_path / "plan.toml").write_text(text)
        return tmp_path / "plan.toml"

    return made


def test_planted_values_come_back(plan: Write) -> None:
    tuned = tune(read_tuning_plan(plan()))
    assert tuned.tuning.converged
    assert [p.status for p in tuned.tuning.parameters] == [OK] * 4
    assert [p.after for p in tuned.tuning.parameters] == pytest.approx([-2.0, 0.09, -0.3, 0.05], rel=1e-6)
    for q in tuned.tuning.quantities:
        assert q.rms() < 1e-6 < q.rms(after=False)
    p = tuned.parameters
    assert value_at(p, place("thruster right ahead c0", p)) == pytest.approx(-2.0, rel=1e-6)
    assert p.thrusters[0].curve.segments[1].low == pytest.approx(2.0 / 0.1654, rel=1e-6)


def test_noise_is_covered_by_the_intervals(plan: Write) -> None:
    tuned = tune(read_tuning_plan(plan(csv=table(noise=1.0))))
    for p, truth in zip(tuned.tuning.parameters, (-2.0, 0.09, -0.3, 0.05), strict=True):
        assert p.u95 is not None
        assert 0.0 < abs(p.after - truth) < 2.0 * p.u95


def test_columns_that_follow_from_others_count_once(plan: Write) -> None:
    """V, v, and a radius computed from u, beta and r are no further readings; a radius with noise of its own is one."""
    rng, lines = np.random.default_rng(7), table(noise=1.0).splitlines()
    more, noisy = [f"{lines[0]},V [m/s],radius [m]"], [f"{lines[0]},radius [m]"]
    for line in lines[1:]:
        u, beta, r = map(float, line.split(",")[2:])
        speed = u / np.cos(np.radians(beta))
        radius = speed / abs(np.radians(r))
        more.append(f"{line},{speed:.4f},{radius:.4f}")
        noisy.append(f"{line},{radius + 0.1 * rng.normal():.4f}")
    own = ERRORS.replace("}", ', V = "0.01 m/s", radius = "0.1 m" }')
    alone = tune(read_tuning_plan(plan(csv="\n".join(lines)))).tuning
    both = read_tuning_plan(plan(csv="\n".join(more), measured=own))
    assert both.cases.names == ("u", "beta", "r")
    assert [(f["case"], f.subject) for f in both.findings] == [("left", "V"), ("left", "radius")]
    repeated = tune(both).tuning
    assert [p.u95 for p in repeated.parameters] == [p.u95 for p in alone.parameters]
    assert sum("follows from the other columns" in s for s in repeated.statements) == 2
    other = read_tuning_plan(plan(csv="\n".join(noisy), measured=ERRORS.replace("}", ', radius = "0.1 m" }')))
    assert [(f["case"], f.subject) for f in other.findings] == [("counted", "radius")]
    assert other.cases.names == ("u", "beta", "r", "radius")


def test_derivatives_are_those_of_solved_motions(plan: Write) -> None:
    p = tuning_problem(read_tuning_plan(plan()))
    by_solving = replace(p, jacobian=None).slopes(p.start)
    assert p.slopes(p.start) == pytest.approx(by_solving, rel=1e-4, abs=1e-6 * np.max(np.abs(by_solving)))


def test_the_written_file_says_what_moved_and_why(plan: Write, tmp_path: Path) -> None:
    path = plan()
    tuned = tune(read_tuning_plan(path))
    paths = write(tuned, tmp_path / "out")
    assert [p.name for p in paths] == ["planted.parameters.json", "planted.motions.csv", "planted.agreement.svg"]
    p = read_parameter_file(paths[0])
    assert p == tuned.parameters
    assert p.name == "planted"
    inputs = {i.name: i.sha256 for i in p.provenance.inputs}
    for file in (path, tmp_path / "turns.csv", HUUV / "huuv.parameters.json"):
        assert inputs[file.name] == hashlib.sha256(file.read_bytes()).hexdigest()
    notes = " ".join(p.provenance.notes)
    assert "intercept: from -2.33800 to -2.00 +- " in notes
    assert "at thruster left ahead c0, thruster right ahead c0" in notes
    side = next(m for m in p.models if m.response == "C_S")
    half = tuned.tuning.parameter("C_S beta").u95
    assert [t.half_width_95 for t in side.terms] == [half, None]
    assert side.covariance[0][0] == pytest.approx((half / 2.0) ** 2)  # type: ignore[operator]
    assert side.covariance[0][1] is None
    head, first = paths[1].read_text().splitlines()[:2]
    assert head.startswith("line,left,right,u measured [m/s],u before [m/s],u after [m/s],beta measured [deg]")
    assert first.startswith("2,0,60,")
    before = [f.read_bytes() for f in paths]
    assert [f.read_bytes() for f in write(tune(read_tuning_plan(path)), tmp_path / "out")] == before


def test_side_force_and_mass_are_known_only_together(plan: Write) -> None:
    """Signed r in place of a radius, and u: the forces scale with the thrust, but C_S and mass hide each other."""
    free = FREE + '[[free]]\nplaces = ["C_S beta^3"]\n[[free]]\nplaces = ["mass"]\n'
    tuned = tune(read_tuning_plan(plan(free=free, csv=table(noise=1.0))))
    status = {p.name: p.status for p in tuned.tuning.parameters}
    assert status["mass"] == status["C_S beta^3"] == OPEN
    assert status["C_D 1"] == OK
    assert any("mass" in text and "C_S beta" in text for text in tuned.tuning.together)
    assert tuned.tuning.parameter("mass").u95 is None
    assert any("C_S beta^3" in n and "not identifiable" in n for n in tuned.parameters.provenance.notes)


def test_priors_and_bounds(plan: Write) -> None:
    mass = '[[free]]\nplaces = ["mass"]\nprior = { mean = 19.0, error = 0.01 }\n'
    held = FREE.replace('places = ["C_D 1"]', 'places = ["C_D 1"]\nhigh = 0.08')
    tuned = tune(read_tuning_plan(plan(free=held + mass)))
    parts = {p.name: p for p in tuned.tuning.parameters}
    assert parts["C_D 1"].status == BOUND
    assert parts["C_D 1"].after == pytest.approx(0.08, abs=1e-5)
    assert parts["C_D 1"].u95 is None
    assert parts["mass"].status == PRIOR
    assert parts["mass"].prior_share > 0.9


@pytest.mark.slow
def test_errors_from_the_residuals(plan: Write) -> None:
    tuned = tune(read_tuning_plan(plan(csv=table(noise=1.0), measured='errors = "from residuals"\n')))
    assert tuned.tuning.statements[0].startswith("Standard errors are those of the residuals")
    for q, error in zip(tuned.tuning.quantities, (0.01, 0.3, 1.0), strict=True):
        assert q.error[0] == pytest.approx(q.rms(), rel=1e-3)
        assert error / 3.0 < q.rms() < 2.0 * error


def test_magnitudes_and_blank_cells(plan: Write) -> None:
    csv = table().replace(",u [m/s],", ",u [m/s],", 1)
    rows = [line.split(",") for line in csv.splitlines()]
    for row in rows[1:]:
        row[3] = row[3].removeprefix("-")
    rows[2][2] = ""
    text = "\n".join(",".join(row) for row in rows) + "\n"
    tuned = tune(read_tuning_plan(plan(csv=text, measured=ERRORS + 'magnitudes = ["beta"]\n')))
    assert [p.after for p in tuned.tuning.parameters] == pytest.approx([-2.0, 0.09, -0.3, 0.05], rel=1e-6)
    assert tuned.tuning.quantity("u").count == len(COMMANDS) - 1


BAD: dict[str, tuple[dict[str, str], str]] = {
    "no free parameter": ({"free": ""}, r"plan\.toml, \"free\""),
    "an unknown place": ({"free": '[[free]]\nplaces = ["C_X beta"]\n'}, r'free\[0\]\.places.*"C_X beta"'),
    "no place": ({"free": '[[free]]\nname = "x"\n'}, r"free\[0\]\.places"),
    "a place twice": ({"free": FREE + '[[free]]\nname = "y"\nplaces = ["C_D 1"]\n'}, "C_D 1 more than once"),
    "different values": ({"free": '[[free]]\nplaces = ["C_D 1", "C_S beta"]\n'}, "different values"),
    "bounds about another value": ({"free": '[[free]]\nplaces = ["mass"]\nlow = 20\n'}, "bounds 20 and inf about 19"),
    "a prior without width": ({"free": '[[free]]\nplaces = ["mass"]\nprior = { error = 0 }\n'}, "above zero"),
    "an unknown key": ({"free": '[[free]]\nplaces = ["mass"]\nhi = 20\n'}, "Did you mean free"),
    "no errors": ({"measured": ""}, "measured.errors"),
    "an error missing": ({"measured": 'errors = { u = "0.01 m/s", beta = "0.3 deg" }\n'}, r"measured\.errors\.r"),
    "an error of zero": ({"measured": ERRORS.replace("0.01", "0")}, "above zero"),
    "a magnitude of nothing": ({"measured": ERRORS + 'magnitudes = ["v"]\n'}, "magnitudes"),
    "rows that are not there": ({"measured": ERRORS + 'where = { run = "a" }\n'}, 'no column "run"'),
    "an unknown column": ({"csv": table().replace("u [m/s]", "speed [m/s]")}, 'the column "speed"'),
    "a header without unit": ({"csv": table().replace("u [m/s]", "u")}, "without unit"),
    "a command in another unit": ({"csv": table().replace("left [%]", "left [rpm]")}, r"\[%\], the unit of the curve"),
    "an angle as a length": ({"csv": table().replace("beta [deg]", "beta [m]")}, "another dimension"),
    "a text in a cell": ({"csv": table().replace("0,60,", "0,sixty,")}, r"turns\.csv, line 2"),
    "a blank command": ({"csv": table().replace("\n0,60,", "\n,60,")}, "a blank cell"),
    "a path as a name": ({"head": HEAD.replace('"planted"', '"../planted"')}, r"tune\.name"),
    "no such file": ({"head": HEAD.replace("PARAMETERS", "none.json")}, "none.json"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_plans_are_refused_in_words(what: str, plan: Write) -> None:
    parts, message = BAD[what]
    with pytest.raises(InputError, match=message):
        read_tuning_plan(plan(**parts))


def test_a_radius_of_a_straight_course_is_named(plan: Write) -> None:
    csv = "left [%],right [%],u [m/s],radius [m]\n0,60,0.5,0.6\n60,60,0.8,3.0\n"
    with pytest.raises(InputError, match=r"turns\.csv, line 3.*no radius"):
        tune(read_tuning_plan(plan(csv=csv, measured='errors = { u = "0.01 m/s", radius = "0.1 m" }\n')))


def test_the_shipped_plan_is_sound() -> None:
    plan = read_tuning_plan(HUUV / "tune.toml")
    assert len(plan.cases.lines) == 28
    assert len(plan.free) == 7


def test_only_what_cannot_be_a_vehicle_is_without_output(plan: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    p = tuning_problem(read_tuning_plan(plan(free='[[free]]\nplaces = ["mass"]\n')))
    assert np.isnan(p.outputs(np.array([-100.0]))).all()
    assert np.isnan(p.slopes(np.array([-100.0]))).all()

    def fault(*_: object) -> None:
        raise InputError("a fault", "none")

    monkeypatch.setattr("coeflab.identify.tune.steady_motions", fault)
    with pytest.raises(InputError, match="a fault"):
        p.outputs(p.start * 1.01)


def test_damping_that_drives_is_called_so() -> None:
    """Along the motion positive: -0.048 N m s taken off in the equations drives at +0.048."""
    told = driving(TunedParameter("Nr", "N m s", 0.0, 0.048, 0.028, 0.0, OK))
    left_open = driving(TunedParameter("Nr|r|", "N m s^2", -1.0, 0.21, None, 0.0, OPEN))
    assert (told["case"], left_open["case"]) == ("told", "open")
    assert driving(TunedParameter("Nr", "N m s", 0.0, -0.033, 0.033, 0.0, SIGN)) is None
