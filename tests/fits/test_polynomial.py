"""Polynomials in one variable: planted coefficients come back, intervals hold what they claim, doubts are said."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.provenance import Source
from coeflab.fits import FITS
from coeflab.law.coefficient import Status
from coeflab.law.domain import Extrapolation
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.report.tables.nouns import window_text
from coeflab.tables.force_table import ForceTable

LENGTH, SPEED, DENSITY = 1.6, 2.0, 1000.0
SCALING = Scaling(LENGTH, "LOA")
PLANTED = np.array([4e-4, -0.03, 0.006, -0.11])
DRIFT = np.sin(np.radians(np.linspace(-15.0, 20.0, 15)))


def sweep(primed: dict[str, np.ndarray], **motion: np.ndarray) -> ForceTable:
    """A synthetic table of primed forces over primed motion."""
    n = len(next(iter(motion.values())))
    scale = {m: SPEED / LENGTH if m in "pqr" else SPEED for m in MOTIONS}
    nu = {m: scale[m] * motion.get(m, np.zeros(n)) for m in MOTIONS}
    nu["u"] = np.sqrt(np.maximum(SPEED**2 - nu["v"] ** 2 - nu["w"] ** 2, 0.0))
    q = 0.5 * DENSITY * SPEED**2 * LENGTH**2
    forces = {c: y * q * (LENGTH if c in "KMN" else 1.0) for c, y in primed.items()}
    return ForceTable(
        name="planted/table.csv", campaign="planted", title="synthetic", body="synthetic", motion=nu,
        controls={k: x for k, x in motion.items() if k not in MOTIONS}, speed=np.full(n, SPEED), forces=forces,
        errors={}, usable={c: np.ones(n, dtype=bool) for c in forces}, exclusions=(), labels=tuple(map(str, range(n))),
        reference_point=np.zeros(3), datum=Datum("nose"), conditions=Conditions(DENSITY, SPEED), scaling=SCALING,
        source=Source("synthetic", kind="synthetic"),
    )  # fmt: skip


def fit(table: ForceTable, **options):
    return FITS.load("polynomial").fit([table], SCALING, options)


def cubic(x: np.ndarray) -> np.ndarray:
    return np.polynomial.polynomial.polyval(x, PLANTED)


def test_planted_coefficients_come_back_by_their_names():
    found = fit(sweep({"Y": cubic(DRIFT), "N": 2.0 * cubic(DRIFT)}, v=DRIFT), variable="v")
    assert [m.response for m in found.models] == ["Y'", "N'"]
    assert found.models[0].symbols == ("Y0'", "Yv'", "Yvv'", "Yvvv'")
    np.testing.assert_allclose(found.models[0].fit.coefficients, PLANTED, rtol=1e-9)
    np.testing.assert_allclose([c.value for c in found.coefficients.coefficients[4:]], 2.0 * PLANTED, rtol=1e-9)
    assert found.coefficients.symbols == ("Y0", "Yv", "Yvv", "Yvvv", "N0", "Nv", "Nvv", "Nvvv")
    assert found.settings["area_name"] == "L^2"


def test_windows_of_a_rate_are_rates_and_those_of_drift_are_degrees():
    """Y0' of a sweep over r' has its window in r', though its symbol does not say so."""
    rate = np.linspace(-0.4, 0.4, 9)
    turned = fit(sweep({"Y": cubic(rate)}, r=rate), variable="r").coefficients
    assert [window_text(c) for c in turned.coefficients] == ["-0.400 .. 0.400"] * 4
    assert [c.with_rates(2.0).window for c in turned.coefficients] == [(-0.8, 0.8)] * 4
    drifted = fit(sweep({"Y": cubic(DRIFT)}, v=DRIFT), variable="v").coefficients
    assert [window_text(c) for c in drifted.coefficients] == ["-15.0 .. 20.0 deg"] * 4


@pytest.mark.parametrize(("variable", "column"), [("v", "v"), ("beta", "v"), ("alpha", "w"), ("r", "r"), ("dr", "dr")])
def test_every_kind_of_variable(variable, column):
    x = np.arcsin(DRIFT) if variable in ("alpha", "beta") else DRIFT
    model = fit(sweep({"Z": cubic(x)}, **{column: DRIFT}), variable=variable).models[0]
    np.testing.assert_allclose(model.fit.coefficients, PLANTED, rtol=1e-7)
    np.testing.assert_allclose(model.x[variable], x, atol=1e-15)
    assert model.domain.variables == (variable,)


@pytest.mark.parametrize(("parity", "kept"), [("odd", [1, 3]), ("even", [0, 2])])
def test_parity_keeps_its_powers_only(parity, kept):
    x = np.linspace(-0.3, 0.3, 13)
    model = fit(sweep({"Y": cubic(x)}, v=x), variable="v", parity=parity).models[0]
    assert [t.degree for t in model.terms] == kept
    np.testing.assert_allclose(model.fit.coefficients, PLANTED[kept], rtol=1e-9)


def test_by_an_area_the_coefficients_carry_its_name_and_no_sname_symbols():
    table = sweep({"X": -cubic(DRIFT), "Y": np.zeros(15)}, v=DRIFT)
    found = fit(table, variable="beta", responses="X C_D", area=0.5, area_name="frontal")
    model = found.models[0]
    assert model.response == "C_X"
    np.testing.assert_allclose(model.y, -cubic(DRIFT) * LENGTH**2 / 0.5, rtol=1e-12)
    np.testing.assert_allclose(found.models[1].y, -model.y * np.cos(np.arcsin(DRIFT)), rtol=1e-12)
    assert not found.coefficients.coefficients
    assert found.coefficients.covariance.shape == (0, 0)
    assert (found.settings["area"], found.settings["area_name"]) == ("0.5", "frontal")


def test_rows_in_which_something_else_moves_are_left_out_and_counted():
    attack = np.where(np.arange(15) % 3 == 0, 0.2, 0.0)
    y = cubic(DRIFT) + 5.0 * attack
    model = fit(sweep({"Y": y}, v=DRIFT, w=attack), variable="v").models[0]
    assert model.n_points == 10
    assert model.statements[0].startswith("5 of 15 rows of planted/table.csv are left out")
    np.testing.assert_allclose(model.fit.coefficients, PLANTED, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("parity", ["full", "odd"])
def test_random_intervals_cover_the_truth_as_often_as_they_say(parity):
    """1,200 seeded campaigns (six components in each of 200 tables) whose noise grows with the angle."""
    rng = np.random.default_rng(77)
    x = np.linspace(-0.3, 0.3, 17)
    truth = PLANTED if parity == "full" else PLANTED[[1, 3]]
    powers = np.arange(4) if parity == "full" else np.array([1, 3])
    clean = x[:, None] ** powers @ truth
    hits = []
    for _ in range(200):
        noise = 1e-4 * (1.0 + 2.0 * np.abs(x)) * rng.standard_normal((6, 17))
        found = fit(
            sweep({c: clean + e for c, e in zip(COMPONENTS, noise, strict=True)}, v=x), variable="v", parity=parity
        )
        hits += [np.abs(m.fit.coefficients - truth) <= m.fit.half_width for m in found.models]
    share = np.mean(hits, axis=0)
    assert np.all((share >= 0.93) & (share <= 0.97)), share


def test_u95_and_covariance_hold_scatter_and_form():
    y = cubic(DRIFT) + 1e-4 * np.random.default_rng(4).standard_normal(15)
    found = fit(sweep({"Y": y, "N": y[::-1]}, v=DRIFT), variable="v")
    set_ = found.coefficients
    scatter = np.concatenate([m.fit.half_width for m in found.models])
    form = np.concatenate([m.remainder.half_width for m in found.models])
    assert form.max() > 0.0
    for c, random, model_form in zip(set_.coefficients, scatter, form, strict=True):
        assert c.u95 == pytest.approx(np.hypot(random, model_form))
        assert (c.parts.random, c.parts.model_form) == (random, model_form)
    np.testing.assert_allclose(np.diag(set_.covariance), [(c.u95 / 2.0) ** 2 for c in set_.coefficients], rtol=1e-12)
    expected = (
        found.models[0].fit.correlation * np.outer(scatter[:4], scatter[:4]) + found.models[0].remainder.covariance
    )
    np.testing.assert_allclose(set_.covariance[:4, :4], expected / 4.0, rtol=1e-9)
    assert not np.any(set_.covariance[:4, 4:])


def test_what_the_abscissae_leave_open_has_no_number():
    x = np.repeat([-0.2, 0.0, 0.2], 3)
    found = fit(sweep({"Y": cubic(x)}, v=x), variable="v")
    status = {c.symbol: c.status for c in found.coefficients.coefficients}
    assert status == {
        "Y0": Status.FORM_ASSUMED, "Yv": Status.TOO_FEW_POINTS, "Yvv": Status.FORM_ASSUMED, "Yvvv": Status.TOO_FEW_POINTS,
    }  # fmt: skip
    assert any("Yv', Yvvv' are determined only in combination" in s for s in found.models[0].statements)
    assert np.isnan(found.coefficients.covariance[1]).all()


def test_the_rule_outside_is_the_one_asked_for():
    model = fit(sweep({"Y": cubic(DRIFT)}, v=DRIFT), variable="v", extrapolation="taper").models[0]
    assert model.domain.rule is Extrapolation.TAPER
    assert model.domain.contains(np.array([[DRIFT.min()], [0.0], [DRIFT.max() + 1e-6]])).tolist() == [
        True,
        True,
        False,
    ]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"variable": "v", "degree": 14}, "15 usable rows for 15 terms"),
        ({"variable": "v", "degree": 0, "parity": "odd"}, "odd polynomial of degree 0"),
        ({"variable": "v", "area": 0.1}, "an area above zero with its name"),
        ({"variable": "v", "area_name": "wetted"}, "an area above zero with its name"),
        ({"variable": "v", "responses": "K"}, "no usable rows for K"),
        ({"variable": "v", "responses": "Q"}, '"Q"'),
        ({"variable": "v", "responses": "C_D"}, "no X in planted/table.csv"),
        ({"variable": "w"}, "zero on every row"),
        ({"variable": "speed"}, "one of"),
        ({"parity": "ood"}, "Did you mean odd?"),
    ],
)
def test_misuse_is_one_clear_error(options, said):
    with pytest.raises(InputError) as caught:
        fit(sweep({"Y": cubic(DRIFT)}, v=DRIFT), **options)
    assert said in str(caught.value)


def test_a_sweep_that_is_not_in_the_tables_is_refused():
    drift = np.linspace(0.1, 0.3, 9)
    with pytest.raises(InputError, match="no row in which only r may move"):
        fit(sweep({"Y": drift}, v=drift), variable="r")


def test_a_table_without_forces_of_use_is_refused():
    table = sweep({"Y": cubic(DRIFT)}, v=DRIFT)
    object.__setattr__(table, "usable", {"Y": np.zeros(15, dtype=bool)})
    with pytest.raises(InputError, match="no usable force"):
        fit(table, variable="v")


def test_a_degree_that_is_too_low_is_said_to_be_and_the_right_one_is_not():
    x = np.linspace(-0.3, 0.3, 41)
    y = x - 5.0 * x**3 + 1e-3 * np.random.default_rng(8).standard_normal(41)
    low, right = (fit(sweep({"Y": y}, v=x), variable="v", parity="odd", degree=d).models[0] for d in (1, 3))
    said = next(s for s in low.statements if "not random" in s)
    assert said.endswith("Try a higher degree, such as degree = 3, or parity = full.")
    assert not any("not random" in s for s in right.statements)


def test_residuals_that_change_sign_at_every_row_are_no_misfit_of_the_form():
    x = np.linspace(-0.3, 0.3, 40)
    y = x + 1e-3 * (-1.0) ** np.arange(40)
    said = next(s for s in fit(sweep({"Y": y}, v=x), variable="v", degree=1).models[0].statements if "not random" in s)
    assert "more often than by chance" in said
    assert "form misses" not in said
