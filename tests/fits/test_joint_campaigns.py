"""Joint fits over several campaigns: planted coefficients, own intercepts, noise and points, agreement, bad input."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.pooling import Pooling
from coeflab.law.coefficient import Status
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Plan, PlannedJoint, Study
from coeflab.tables.force_table import ForceTable
from coeflab.tables.reading import table_at
from tests.fits.shipped import tables

pytestmark = pytest.mark.usefixtures("one_thread")

MOTION = ("u", "v", "w", "p", "q", "r")
POINT, OTHER = np.array([-0.5, 0.0, 0.0]), np.array([-0.3, 0.0, 0.0])
TRUTH = {"Yv": -0.028, "Yv|v|": -0.06, "Yr": 0.005, "Nv": -0.0128, "Nv|v|": 0.02, "Nr": -0.004}
NAMES = " ".join(TRUTH)
DRIFT, SHORT, ARM = np.linspace(-0.3, 0.3, 15), np.linspace(-0.2, 0.25, 10), np.linspace(-0.6, 0.6, 11)
Z15, Z10, Z11 = np.zeros(15), np.zeros(10), np.zeros(11)


def synthetic(campaign: str, rows: dict[str, np.ndarray], forces: dict[str, np.ndarray]) -> ForceTable:
    """Steady runs at U = 1 m/s, L = 1 m, density 2 kg/m^3, so that primed and SI values are the same numbers."""
    like = tables("suboff_cfd_barehull")[0]
    n = len(next(iter(rows.values())))
    return replace(
        like,
        name=f"{campaign}/table",
        campaign=campaign,
        motion={m: rows.get(m, np.ones(n) if m == "u" else np.zeros(n)) for m in MOTION},
        controls={},
        speed=np.ones(n),
        forces=forces,
        errors={},
        usable={c: np.ones(n, dtype=bool) for c in forces},
        exclusions=(),
        cells=None,
        labels=tuple(map(str, range(n))),
        reference_point=POINT,
        conditions=replace(like.conditions, density=2.0, speed=1.0, viscosity=1e-6),
        scaling=replace(like.scaling, length=1.0),
    )


def planted(
    campaign: str, v: np.ndarray, r: np.ndarray, sigma: float, rng: np.random.Generator, trim: float = 0.0
) -> ForceTable:
    """TRUTH about POINT, noise, and forces at rest of the campaign's own."""
    y = TRUTH["Yv"] * v + TRUTH["Yv|v|"] * v * np.abs(v) + TRUTH["Yr"] * r + trim
    n = TRUTH["Nv"] * v + TRUTH["Nv|v|"] * v * np.abs(v) + TRUTH["Nr"] * r - trim
    noise = sigma * rng.standard_normal((2, len(v)))
    return synthetic(campaign, {"v": v, "r": r}, {"Y": y + noise[0], "N": n + noise[1]})


def pair(seed: int, quiet: float = 1e-4, loud: float = 6e-4) -> tuple[ForceTable, ForceTable]:
    """A quiet campaign of drift and arm; a loud drift campaign about another point, with a large trim."""
    rng = np.random.default_rng(seed)
    a = planted("a", np.r_[DRIFT, Z11], np.r_[Z15, ARM], quiet, rng, 1e-4)
    b = planted("b", np.r_[DRIFT, SHORT], np.r_[Z15, Z10], loud, rng, -3e-3)
    return a, b.about(OTHER)


def fitted(used: tuple[ForceTable, ...], **options: object) -> FitResult:
    return FITS.load("manoeuvring_model").fit(used, used[0].scaling, options)


def value(result: FitResult, symbol: str) -> float:
    found = result.coefficients[symbol].value
    assert found is not None
    return found


def pooling(result: FitResult, response: str) -> Pooling:
    return next(p for p in result.poolings if p.response == response)


def said(result: FitResult, response: str) -> str:
    return "\n".join(next(m for m in result.models if m.response == response).statements)


def studied(*campaigns: Path | str, **options: object) -> Study:
    paths = [shipped("cfd_data") / c if isinstance(c, str) else c for c in campaigns]
    joint = PlannedJoint(tuple(map(table_at, paths)), "manoeuvring_model", options)
    return run(Plan(name="joint", title="joint", tables=(), joint=(joint,)))


# Planted coefficients


def test_planted_coefficients_come_back_about_the_point_of_the_first_campaign() -> None:
    result = fitted(pair(1), terms=NAMES)
    for symbol, true in TRUTH.items():
        c = result.coefficients[symbol]
        assert abs(value(result, symbol) - true) <= 2.0 * c.u95, symbol
    assert np.array_equal(result.coefficients.reference_point, POINT)
    assert (result.campaign, result.campaigns) == ("a, b", ("a", "b"))
    assert {c.campaign for c in result.coefficients.coefficients} == {"a, b"}


def test_a_term_that_both_campaigns_have_and_the_law_lacks_is_in_u95() -> None:
    result = fitted(pair(1, 1e-5, 6e-5), terms="Yv Yr Nv Nv|v| Nr")
    assert "most likely a term v |v|" in said(result, "Y")
    assert "The residuals are not random" not in said(result, "N")
    c = result.coefficients["Yv"]
    assert c.parts.model_form > 3.0 * c.parts.random
    assert abs(value(result, "Yv") - TRUTH["Yv"]) <= np.hypot(c.parts.random, c.parts.model_form)


def test_without_noise_the_law_and_the_own_intercepts_are_exact_wherever_the_moments_were_read() -> None:
    result = fitted(pair(1, 0.0, 0.0), terms=NAMES)
    for symbol, true in TRUTH.items():
        assert value(result, symbol) == pytest.approx(true, rel=1e-9)
    assert [s.intercept for s in pooling(result, "Y").shares] == pytest.approx([1e-4, -3e-3], rel=1e-9)
    assert [s.intercept for s in pooling(result, "N").shares] == pytest.approx([-1e-4, 3e-3], rel=1e-9)
    model = next(m for m in result.models if m.response == "Y")
    values, _, _ = model.evaluate({"v": np.array([0.1]), "r": np.array([0.2])})
    assert values[0] == pytest.approx(-0.0028 - 0.0006 + 0.001, rel=1e-9)
    assert "Y0" not in result.coefficients


def test_campaigns_weigh_by_their_own_noise() -> None:
    """The weighted fit by hand: rows over their campaign's scatter, one column of ones a campaign."""
    a, b = pair(3)
    result = fitted((a, b), terms="Yv Yv|v| Yr")
    v, r = (np.r_[a.motion[m], b.about(POINT).motion[m]] for m in ("v", "r"))
    of_b = np.repeat([0.0, 1.0], [len(a), len(b)])
    sigma = np.repeat([s.noise for s in pooling(result, "Y").shares], [len(a), len(b)])
    design = np.column_stack([v, v * np.abs(v), r, 1.0 - of_b, of_b]) / sigma[:, None]
    by_hand = np.linalg.lstsq(design, np.r_[a.forces["Y"], b.forces["Y"]] / sigma, rcond=None)[0]
    assert [value(result, s) for s in ("Yv", "Yv|v|", "Yr")] == pytest.approx(by_hand[:3], rel=1e-9)
    assert [s.noise for s in pooling(result, "Y").shares] == pytest.approx([1e-4, 6e-4], rel=0.35)


def test_a_named_intercept_is_one_for_all_campaigns() -> None:
    result = fitted(pair(1, 0.0, 0.0), terms="Y0 Yv Yv|v| Yr")
    assert result.coefficients["Y0"].value is not None
    assert [s.intercept for s in pooling(result, "Y").shares] == [None, None]
    assert pooling(result, "Y").rejected
    none = fitted(pair(1), terms="Yv Yv|v| Yr", intercepts="no")
    assert "Y0" not in none.coefficients
    assert [s.intercept for s in pooling(none, "Y").shares] == [None, None]


@pytest.mark.slow
def test_intervals_cover_over_two_campaigns_with_noise_and_points_of_their_own() -> None:
    """500 seeded pairs of campaigns, the noise of the second six times that of the first."""
    inside, by_scatter = np.zeros((2, len(TRUTH)))
    for seed in range(500):
        result = fitted(pair(seed), terms=NAMES)
        for i, (symbol, true) in enumerate(TRUTH.items()):
            c = result.coefficients[symbol]
            inside[i] += abs(value(result, symbol) - true) <= c.u95
            by_scatter[i] += abs(value(result, symbol) - true) <= c.parts.random
    assert np.all(inside / 500 >= 0.93), inside
    assert np.all((by_scatter / 500 >= 0.92) & (by_scatter / 500 <= 0.98)), by_scatter


# Across planes


def planes(seed: int, factor: float = 1.0, sigma: float = 1e-4) -> tuple[ForceTable, ForceTable]:
    """A body of revolution: drift in one campaign, attack in another, with Mw = -factor Nv."""
    rng = np.random.default_rng(seed)
    x, e = DRIFT, sigma * rng.standard_normal((4, 15))
    side = {"Y": -0.006 * x - 0.1 * x * np.abs(x) + e[0], "N": -0.0128 * x + 0.02 * x**3 + e[1]}
    down = {"Z": -0.006 * x - 0.1 * x * np.abs(x) + e[2], "M": factor * 0.0128 * x - 0.02 * x**3 + 1e-3 + e[3]}
    return synthetic("horizontal", {"v": x}, side), synthetic("vertical", {"w": x}, down)


PLANES = "Yv Yv|v| Zw Zw|w| Nv Nvvv Mw Mwww"


def test_equations_hold_across_campaigns_and_narrow_the_interval() -> None:
    tied, free = (fitted(planes(2), terms=PLANES, constraints=c) for c in ("Mw = -Nv, Zw = Yv", ""))
    assert value(tied, "Mw") == pytest.approx(-value(tied, "Nv"), rel=1e-12)
    assert value(tied, "Zw") == pytest.approx(value(tied, "Yv"), rel=1e-12)
    assert abs(value(free, "Mw") + value(free, "Nv")) > 1e-7
    for symbol in ("Mw", "Nv", "Zw", "Yv"):
        narrow, wide = tied.coefficients[symbol].u95, free.coefficients[symbol].u95
        assert narrow < wide
    assert "The data do not contradict Mw = -Nv" in said(tied, "M")
    assert "Only vertical has rows of M: one law for several campaigns is not tested" in said(tied, "M")


def test_an_equation_that_the_campaigns_contradict_is_rejected() -> None:
    assert "The data reject Mw = -Nv (p < 0.001)" in said(
        fitted(planes(2, 1.2), terms=PLANES, constraints="Mw = -Nv"), "M"
    )


def test_equations_that_no_coefficients_meet_are_refused() -> None:
    with pytest.raises(InputError, match=r"cannot hold.*contradict"):
        fitted(planes(2), terms=PLANES, constraints="Mw = -Nv, Nv = 0.01, Mw = 0.01")


def test_a_plane_is_predicted_from_the_other_through_the_equations_alone() -> None:
    result = fitted(planes(2), terms="Nv Nvvv Mw Mwww", constraints="Mw = -Nv, Mwww = -Nvvv")
    share = pooling(result, "M").shares[0]
    assert share.left_out.predicted == 15
    assert 0.001 < share.left_out.rms < 0.05
    assert "vertical left out, but for one constant of its own: the left-out rows are predicted to" in said(result, "M")


# Agreement and prediction


def test_campaigns_of_one_law_are_not_called_different() -> None:
    p = pooling(fitted(pair(1), terms=NAMES), "Y")
    assert p.rejected is False
    assert p.test.restrictions == 2  # Yr is of one campaign only
    assert p.statistic.startswith("F(2, ")


def test_campaigns_of_two_laws_are_called_different_and_both_values_are_said() -> None:
    a, b = pair(1)
    wrong = b.about(POINT)
    wrong = replace(wrong, forces=dict(wrong.forces) | {"Y": wrong.forces["Y"] - 0.02 * wrong.motion["v"]})
    result = fitted((a, wrong), terms=NAMES)
    p = pooling(result, "Y")
    assert p.rejected
    alone = {c: v for c, v, _ in dict(p.alone)["Yv"]}
    assert alone["a"] == pytest.approx(-0.028, abs=2e-3)
    assert alone["b"] == pytest.approx(-0.048, abs=8e-3)
    assert "The campaigns disagree: one law does not fit them all" in said(result, "Y")
    assert "U95 does not include their difference" in said(result, "Y")
    assert "disagree" not in said(result, "N")


def test_a_campaign_left_out_is_predicted_by_hand() -> None:
    """b from the law of a alone, one constant free; error as a share of the range of b."""
    a, b = pair(4)
    result = fitted((a, b), terms="Yv Yv|v| Yr")
    v, r = a.motion["v"], a.motion["r"]
    law = np.linalg.lstsq(np.column_stack([v, v * np.abs(v), r, np.ones(len(v))]), a.forces["Y"], rcond=None)[0]
    x = b.motion["v"]
    error = b.forces["Y"] - np.column_stack([x, x * np.abs(x)]) @ law[:2]
    error = (error - error.mean()) / np.ptp(b.forces["Y"])
    shares = {s.campaign: s for s in pooling(result, "Y").shares}
    assert shares["b"].left_out.rms == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-6)
    assert shares["b"].left_out.largest == pytest.approx(np.abs(error).max(), rel=1e-6)
    assert shares["b"].left_out.is_known
    assert shares["a"].left_out.predicted < shares["a"].left_out.rows  # nobody else turns


def test_with_one_campaign_there_is_none_to_leave_out() -> None:
    result = fitted(tables("suboff_cfd_barehull"), terms="Yv Yv|v| Yr")
    assert result.poolings == ()
    assert "Each campaign left out in turn: needs two campaigns." in said(result, "Y")


def test_a_campaign_at_rest_in_every_motion_of_a_component_is_not_used() -> None:
    a, b = pair(1)
    vertical = synthetic("c", {"w": DRIFT * (np.abs(DRIFT) > 0.1)}, {"Y": np.full(15, 0.1), "N": np.zeros(15)})
    result = fitted((a, b, vertical), terms=NAMES)
    assert "c is at rest in v, r: no row of it is used." in said(result, "Y")
    assert [s.campaign for s in pooling(result, "Y").shares] == ["a", "b"]
    assert value(result, "Yv") == pytest.approx(value(fitted((a, b), terms=NAMES), "Yv"), rel=1e-12)


# SUBOFF


def test_the_towed_bare_hull_and_the_computed_one_do_not_obey_one_law() -> None:
    """Side force of Roddy's configuration 3 and of the RANS campaign: slopes at the origin differ by more than noise."""
    study = studied("suboff_roddy_3", "suboff_cfd_barehull", terms="Yv Yv|v| Yvvv Yr Yr|r| Nv Nv|v| Nr Nr|r|")
    found = {c.subject.rpartition(" ")[2]: c for c in study.checks if c.name == "poolability"}
    assert found["Y'"].severity is Severity.WARN
    assert "Yv' -0.0026 +- 0.0014" in found["Y'"].comment
    notes = " ".join(study.fits[0].differences)
    for text in (
        "1.4e+07 (suboff_roddy_3), 8.52e+06 (suboff_cfd_barehull)",
        "experiment (suboff_roddy_3), cfd",
        "Moved",
    ):
        assert text in notes
    names = {i.name for i in study.inputs}
    assert {"drift.csv", "rotating_arm.csv", "table.csv"} <= {n.rpartition("/")[2] for n in names}
    file = study.parameter_files["suboff_bare_hull"]
    assert {c.campaign for c in file.covered} == {"suboff_roddy_3", "suboff_cfd_barehull"}
    assert {"roddy1990", "coeflab_cfd"} <= set(file.provenance.citations)


def test_the_appended_hull_is_not_axisymmetric() -> None:
    """Configurations 1 and 2, vertical and horizontal: the sail makes Yv two times Zw, and the equation is rejected."""
    used = (*tables("suboff_roddy_2"), *tables("suboff_roddy_1"))
    free = fitted(used, terms="Yv Yv|v| Zw Zw|w|")
    assert value(free, "Yv") / value(free, "Zw") > 1.3
    assert "The data reject Zw = Yv" in said(fitted(used, terms="Yv Yv|v| Zw Zw|w|", constraints="Zw = Yv"), "Z")


def test_the_bare_hull_in_one_plane_leaves_the_other_to_the_equations() -> None:
    """No vertical table of the bare hull exists: Zw and Mw are Yv and -Nv by the equations, and said to be."""
    used = (*tables("suboff_roddy_3"), *tables("suboff_cfd_barehull"))
    tied = fitted(used, terms="Yv Yv|v| Nv Nv|v| Zw Mw", constraints="Mw = -Nv, Zw = Yv")
    assert value(tied, "Mw") == pytest.approx(-value(tied, "Nv"), rel=1e-12)
    assert tied.coefficients["Mw"].n_points == 0
    assert "from the equations alone" in tied.coefficients["Mw"].estimator
    assert "Not tested, since without the equations the rows do not determine a coefficient: Mw = -Nv." in said(
        tied, "M"
    )
    assert "nan" not in said(tied, "M") + said(tied, "Z")


# Input that cannot be used, or has to be said


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"terms": "Yv Yp"}, "Yp zero on every row of a, b"),
        ({"terms": "Yv", "constraints": "Y0 = 0"}, "Add Y0 to the terms; one value then serves all campaigns"),
        ({"terms": "Yv Yv|v| Nv", "weights": "yes"}, "no standard errors of Y"),
    ],
)  # fmt: skip
def test_wrong_input_is_one_clear_error(options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        fitted(pair(1), **options)


def test_more_terms_and_intercepts_than_rows_are_refused() -> None:
    few = tuple(synthetic(c, {"v": np.array([-0.1, 0.1])}, {"Y": np.array([1.0, 2.0])}) for c in "ab")
    with pytest.raises(InputError, match="4 usable rows for 4 free terms and intercepts of Y"):
        fitted(few, terms="Yv Yv|v|")


def test_a_coefficient_that_no_campaign_tells_from_another_is_not_a_number() -> None:
    one_sided = np.linspace(0.02, 0.3, 12)
    used = tuple(
        synthetic(
            c, {"v": one_sided}, {"Y": -0.02 * one_sided - 0.05 * one_sided**2 + 1e-5 * k * np.cos(9 * one_sided)}
        )
        for k, c in enumerate("ab", start=1)
    )
    result = fitted(used, terms="Yv Yvv Yv|v|")
    for symbol in ("Yvv", "Yv|v|"):
        assert (result.coefficients[symbol].value, result.coefficients[symbol].status) == (None, Status.NOT_DETERMINED)
    assert value(result, "Yv") == pytest.approx(-0.02, rel=0.05)


def test_different_bodies_are_said() -> None:
    a, b = pair(1)
    result = fitted((a, replace(b, body="another hull")), terms=NAMES)
    assert "Different bodies: suboff_bare_hull (a), another hull (b)." in result.differences
    assert result.body == "suboff_bare_hull, another hull"


def test_points_from_two_datums_do_not_mix() -> None:
    a, b = pair(1)
    with pytest.raises(ScalingMismatchError, match="one datum"):
        fitted((a, replace(b, datum=Datum("midship"))), terms=NAMES)


SWEEP = "beta [deg],Y [N],N [N*m]\n" + "".join(f"{b},{5 * b + b % 3},{7 * b - b % 2}\n" for b in range(-9, 10, 3))


def test_campaigns_of_two_lengths_do_not_mix_unless_one_is_named(write_campaign: Callable[..., Path]) -> None:
    a, b = write_campaign(SWEEP), write_campaign(SWEEP, scaling='length = 4.2\nlength_name = "LOA"')
    with pytest.raises(ScalingMismatchError, match="name one length for both"):
        studied(a, b, terms="Yv")


@pytest.mark.parametrize(
    ("joint", "message"),
    [
        ('campaigns = ["nowhere", "suboff_roddy_3"]', r"joint\[0\].campaigns.*nowhere"),
        ('campaigns = ["suboff_roddy_3"]', "two or more campaigns"),
        ('campaigns = ["suboff_roddy_3", "suboff_roddy_3"]', "twice"),
        ('campaigns = ["suboff_roddy_2", "suboff_roddy_1"]\nfit = "slope_at_origin"', "joins campaigns: manoeuvring_model"),
        ('campaigns = ["suboff_roddy_2", "suboff_roddy_1"]\ncampains = 1', "unknown key"),
        ('campaigns = ["suboff_roddy_2", "suboff_roddy_1"]\noptions = { terms = "Yv", termz = "Nv" }', "Did you mean terms"),
    ],
)  # fmt: skip
def test_a_plan_with_a_wrong_joint_is_one_clear_error(joint: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "plan.toml"
    file.write_text(f'[study]\nname = "x"\nwanted = ["Yv"]\n[[joint]]\n{joint}\n', encoding="utf-8")
    with pytest.raises(InputError, match=message):
        run(read_plan(file))


def test_a_plan_may_hold_tables_and_joint_fits_of_the_same_campaigns(write_campaign: Callable[..., Path]) -> None:
    other = SWEEP.replace("0,0,0", "0,1,2")
    a, b = write_campaign(SWEEP), write_campaign(other)
    file = a.parent / "plan.toml"
    file.write_text(
        '[study]\nname = "x"\n'
        f'[[table]]\ncampaign = "{a.name}"\n[table.options.slope_at_origin]\nlargest_angle = 20.0\n'
        f'[[joint]]\ncampaigns = ["{a.name}", "{b.name}"]\n[joint.options]\nterms = ["Yv", "Nv"]\n',
        encoding="utf-8",
    )
    study = run(read_plan(file))
    assert [f.campaign for f in study.fits] == [a.name, a.name, f"{a.name}, {b.name}"]
    assert [t.campaign for t in study.tables] == [a.name, b.name]
    assert [f.fit for f in study.fits] == ["slope_at_origin", "tied_law", "manoeuvring_model"]
