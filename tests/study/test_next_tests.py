"""Tests ranked by what they take off the variance of a figure."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.core.texts import remark
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.motion.uncertainty.tests import Kind, kind_of
from coeflab.motion.uncertainty.uncertainty import Question, uncertainty
from coeflab.study.next_tests import Ranges, Reached, Wanted, next_tests, of_index, of_manoeuvre
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCovariance
from coeflab.vehicle.stability import stability_index


def coefficient(symbol: str, value: float, u95: float | None) -> Coefficient:
    return Coefficient(symbol, value, u95, Parts(), Status.ESTIMATE, "by hand")


@pytest.mark.parametrize(
    ("symbol", "kind", "variable"),
    [
        ("Yv", Kind.DRIFT, "v"), ("Yv|v|", Kind.DRIFT, "v"), ("Mw", Kind.ATTACK, "w"), ("Nr", Kind.YAW, "r"), ("Mq", Kind.PITCH, "q"),
        ("Ydr", Kind.RUDDER, "dr"), ("Zds", Kind.STERN, "ds"), ("X0", Kind.RESISTANCE, ""), ("Xu|u|", Kind.RESISTANCE, ""),
        ("Yvdot", Kind.ADDED_MASS, ""), ("Yvr", Kind.OTHER, ""), ("Yuv", Kind.DRIFT, "v"), ("Kp", Kind.ROLL, ""),
    ],
)  # fmt: skip
def test_which_test_gives_a_coefficient(symbol: str, kind: Kind, variable: str) -> None:
    assert kind_of(symbol) == (kind, variable)


def test_levels_are_round() -> None:
    ranges = Ranges(np.radians(12.0), np.radians(15.0), 0.4)
    np.testing.assert_allclose(np.degrees(np.arcsin(ranges.levels("v"))), np.arange(1.0, 13.0))
    np.testing.assert_allclose(np.degrees(ranges.levels("dr")), np.arange(2.0, 15.0, 2.0))
    np.testing.assert_allclose(ranges.levels("r"), np.arange(0.05, 0.41, 0.05))


@pytest.fixture(scope="module")
def file() -> ParameterFile:
    return cf.vehicle("suboff_bare_hull", mass=700.0).file


def apart(file: ParameterFile) -> ParameterFile:
    return file.model_copy(update={"covariance": ParameterCovariance(symbols=(), matrix=())})


def test_u95_of_g_h_is_that_of_its_covariance_and_a_test_takes_what_its_coefficients_tell(file: ParameterFile) -> None:
    """By 400,000 linear draws; as if independent it was .61 times that."""
    found, four = of_index(file, "G_h"), ["Yv'", "Nv'", "Yr'", "Nr'"]
    place = [file.covariance.symbols.index(s) for s in four]
    covariance = np.array(file.covariance.matrix, dtype=float)[np.ix_(place, place)]
    mass = file.mass
    assert mass is not None
    at = np.array([float(c.value or 0.0) for s in four if (c := file.coefficient(s)) is not None])
    steps = 1e-6 * np.eye(4)
    more = mass.mass_prime, mass.mass_moment_prime
    slope = (
        np.array([float(stability_index(*(at + s), *more) - stability_index(*(at - s), *more)) for s in steps]) / 2e-6
    )
    assert found.u95 == pytest.approx(2.0 * np.sqrt(slope @ covariance @ slope), rel=1e-4)
    assert found.u95 > 1.5 * of_index(apart(file), "G_h").u95 > 0.0
    assert (found.correlated, of_index(apart(file), "G_h").correlated) == (True, False)
    draws = np.random.default_rng(1).multivariate_normal(np.zeros(4), covariance, 400_000)
    index = draws @ slope
    gone, shares = [], []
    for pair in (["Yv", "Nv"], ["Yr", "Nr"]):
        own = draws[:, [four.index(f"{s}'") for s in pair]]
        left = index - own @ np.linalg.lstsq(own, index, rcond=None)[0]
        gone.append(1.0 - np.var(left) / np.var(index))
        shares.append(sum(found.shares[s][0] for s in pair))
    assert sum(gone) > 1.9  # either test tells of the other's coefficients: both together take no more than all
    assert shares == pytest.approx([g / sum(gone) for g in gone], abs=0.005)
    assert (found.overlap, of_index(apart(file), "G_h").overlap) == (pytest.approx(sum(gone), abs=0.005), 1.0)
    (overlaps,) = [f for f in cf.next_tests(file, "G_h", runs=3).findings if f.code == "design.overlap"]
    assert f"{sum(gone):.0%}" in remark(overlaps)


def test_u95_of_a_figure_is_that_of_uncertainty(file: ParameterFile) -> None:
    """The coefficients' errors go together here; as if independent, it was another."""
    bare = cf.read_vehicle("remus100").file
    some = [c if c.value is None else replace(c, u95=0.1 * abs(c.value)) for c in bare.coefficients]
    pair = ("Nuv'", "Nur'")
    half = [0.05 * abs(float(c.value or 0.0)) for s in pair if (c := bare.coefficient(s)) is not None]
    cells = np.outer(half, half) * np.array([[1.0, 0.9], [0.9, 1.0]])
    together = ParameterCovariance(symbols=pair, matrix=tuple(map(tuple, cells.tolist())))
    model = bare.model_copy(update={"coefficients": tuple(some), "covariance": together})
    asked = Question("turning_circle", {"rudder": "10 deg"}, members=60)
    spread = next(s for s in uncertainty(model, asked).spreads if s.figure.name == "tactical diameter")
    found = of_manoeuvre(model, "tactical", asked)
    assert found.u95 == pytest.approx((float(spread.high or 0.0) - float(spread.low or 0.0)) / 2.0, rel=1e-12)
    assert found.correlated
    assert abs(found.u95 / of_manoeuvre(apart(model), "tactical", asked).u95 - 1.0) > 0.05


def test_rows_of_a_joint_fit_give_the_scatter_of_what_is_assumed() -> None:
    """The model has no sweeps; 1 % of the largest was assumed, four times what the rows of Roddy show."""
    result = cf.fit("suboff_roddy_2", "manoeuvring_model")
    found = cf.next_tests(result, "Yv'", runs=4)
    assert (found.noise, found.assumed) == (None, ())
    rows = [s for s in cf.fit("suboff_roddy_2").fits[0].sweeps if s.component == "Y" and s.parity == "odd"]
    rms = [float(np.std((s.y - s.fitted)[s.used])) for s in rows]
    assert 0.5 * min(rms) < found.of_rows["Y"] < 3.0 * max(rms)
    assert [f.code for f in found.findings if f.code in ("design.scatter", "design.assumed")] == ["design.scatter"]
    own = cf.next_tests(result, "Yv'", runs=4, noise="1%")
    assert (own.noise, own.assumed, own.of_rows) == (0.01, ("Yv'",), {})
    wide, curves = Wanted("Yv'", -0.02, 1.0, {"Yv": (1.0, 1.0)}), [coefficient("Yv'", -0.02, 1.0)]
    sweeps = cf.fit("suboff_roddy_2").fits[0].sweeps
    shown, loud = (next_tests(wide, curves, (), Ranges(), 5, n, others=sweeps).best for n in (None, 0.2))
    assert shown < 0.5 * loud


def test_shares_of_g_h_are_its_gradients(file: ParameterFile) -> None:
    """Of coefficients without covariance."""
    file = apart(file)
    found = of_index(file, "G_h")
    at = {s: float(c.value or 0.0) for s in ("Yv", "Nv", "Yr", "Nr") if (c := file.coefficient(f"{s}'")) is not None}
    mass = file.mass
    assert mass is not None

    def index(**moved: float) -> float:
        values = [at[s] + moved.get(s, 0.0) for s in at]
        return float(stability_index(*values, mass.mass_prime, mass.mass_moment_prime))

    assert found.value == pytest.approx(index())
    step = {s: (index(**{s: 1e-6}) - index(**{s: -1e-6})) / 2e-6 * found.shares[s][1] for s in at}
    assert found.u95 == pytest.approx(np.sqrt(sum(v**2 for v in step.values())), rel=1e-4)
    for s, v in step.items():
        assert found.shares[s][0] == pytest.approx(v**2 / found.u95**2, rel=1e-3)


def test_the_test_of_the_uncertain_coefficient_comes_first_and_takes_its_share() -> None:
    wanted = Wanted("G_h", 0.2, 0.1, {"Yv": (0.05, 1e-3), "Nr": (0.95, 4e-3)})
    known = [coefficient("Yv'", -0.03, 1e-3), coefficient("Nr'", -0.004, 4e-3)]
    found = next_tests(wanted, known, (), Ranges(), 5, 0.01, target=0.03)
    first = found.tests[0]
    assert (first.kind, first.symbols) == (Kind.YAW, ("Nr'",))
    now, then = first.u95[0]
    assert first.wanted_then == pytest.approx(0.1 * np.sqrt(1.0 - 0.95 * (1.0 - (then / now) ** 2)))
    assert found.reached is (Reached.YES if found.best <= 0.03 else Reached.NO)
    assert set(found.assumed) == {"Yv'", "Nr'"}


def test_rows_that_were_run_are_taken_from_the_table() -> None:
    found = cf.next_tests("suboff_roddy_2", "Nv'", runs=4)
    assert (found.tests[0].rows > 0, found.assumed, found.noise) == (True, (), None)
    assert found.best < found.u95


def test_what_no_run_of_the_sweep_narrows_stays_and_is_found() -> None:
    """A U95 twice that of the sweep: three quarters of its square are grid or declared inputs."""
    fit = cf.fit("suboff_roddy_2").fits[0]
    sweep = next(s for s in fit.sweeps if s.symbol == "Nv")
    for times, fixed, codes in ((1.0, 0.0, set()), (2.0, 0.75, {"design.fixed"})):
        now = times * (sweep.u95 or 0.0)
        found = next_tests(Wanted("Nv'", sweep.value or 0.0, now, {"Nv": (1.0, now)}), (), (sweep,), Ranges(), 4, 0.01)
        assert found.tests[0].fixed == pytest.approx((fixed,))
        assert fixed <= (found.best / now) ** 2 < 1.0
        assert {f.code for f in found.findings} & {"design.fixed"} == codes


def test_runs_as_a_matrix_for_the_tank_and_a_frame() -> None:
    found = cf.next_tests("suboff_bare_hull", "Yr'", runs=4)
    settings = found.tests[0].settings
    assert found.matrix == (
        f"[matrix]\ndrift = []\nattack = []\nyaw = [{', '.join(f'{x:.4g}' for x in dict.fromkeys(settings))}]\npitch = []\n"
    )
    np.testing.assert_array_equal(found.frame()["setting"], settings)


def test_a_plan_is_taken_for_a_plan(tmp_path: Path) -> None:
    """It was read as a campaign."""
    text = '[study]\nname = "two"\n[[table]]\ncampaign = "suboff_roddy_3"\nfits = ["slope_at_origin"]\n'
    plan = tmp_path / "plan.toml"
    plan.write_text(text)
    for source in (plan, tmp_path):
        found = cf.next_tests(source, "Nv'", runs=1)
        assert (found.given.subject, found.given["kind"], found.given["campaigns"]) == (
            "two",
            "plan",
            ("suboff_roddy_3",),
        )
        assert found.tests[0].rows > 0
    with pytest.raises(InputError, match=r"a plan of \d vehicles"):
        cf.next_tests("suboff")


@pytest.mark.parametrize(
    ("source", "wanted", "more", "column"),
    [
        ("suboff_bare_hull", "G_h", {}, "wanted"), ("suboff_bare_hull", "Ydr'", {}, "wanted"), ("huuv", "G_h", {}, "wanted"),
        ("suboff_bare_hull", "Yr'", {"runs": 2}, "runs"), ("suboff_bare_hull", "Yr'", {"runs": 25}, "runs"),
        ("suboff_bare_hull", "Yr'", {"noise": "-1%"}, "noise"), ("suboff_bare_hull", "Yr'", {"angle": "12 deg", "rate": 0.0}, "rate"),
        ("nowhere.csv", "", {}, None),
    ],
)  # fmt: skip
def test_what_cannot_be_asked(source: str, wanted: str, more: dict[str, object], column: str | None) -> None:
    with pytest.raises(InputError) as why:
        cf.next_tests(source, wanted, **more)  # type: ignore[arg-type]
    assert column is None or why.value.column == column
