"""Surfaces over two variables, on the synthetic campaign and on planted tables."""

from __future__ import annotations

import importlib.util
from dataclasses import replace
from functools import cache
from hashlib import sha256

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.statistics.least_squares import factorise, solve
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor
from coeflab.law.terms import design
from coeflab.law.transforms import wind_errors, wind_forces
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS

FRONTAL = {"area": 0.04, "area_name": "frontal"}
SYMMETRIC = {"degree": 3, "parity": "beta=symmetric", **FRONTAL}


@cache
def maker():
    path = shipped("cfd_data") / "make_synthetic_huuv.py"
    spec = importlib.util.spec_from_file_location("make_synthetic_huuv", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def campaign() -> ForceTable:
    return IMPORTERS.load("csv").read(read_campaign(shipped("cfd_data") / "huuv_synthetic" / FILE))[0]


def fit(table: ForceTable, **options) -> FitResult:
    return FITS.load("surface").fit([table], table.scaling, options)


@cache
def symmetric() -> FitResult:
    return fit(campaign(), **SYMMETRIC)


def model(result: FitResult, response: str):
    return next(m for m in result.models if m.response == response)


def interaction(result: FitResult) -> str:
    return next(s for s in result.models[0].statements if "dditive" in s or "not tested" in s)


def planted(values: np.ndarray, noise: np.ndarray) -> ForceTable:
    """The synthetic campaign's angles with M = q A L values, plus noise."""
    table = campaign()
    q = 0.5 * 998.0 * 1.0**2 * 0.04 * 1.2
    return replace(table, forces={**table.forces, "M": q * (values + noise)})


def angles() -> tuple[np.ndarray, np.ndarray]:
    m = campaign().motion
    return np.arctan2(m["w"], m["u"]), np.arcsin(m["v"])


def test_the_campaign_is_what_its_script_makes_and_says_that_it_is_synthetic():
    folder = shipped("cfd_data") / "huuv_synthetic"
    raw = (folder / "table.csv").read_bytes()
    assert maker().table().encode() == raw
    assert sha256(raw).hexdigest() in (folder / FILE).read_text()
    table = campaign()
    assert table.source.kind == "synthetic"
    assert "ynthetic" in table.title
    for terms in maker().TRUTH.values():
        for value in terms.values():
            assert f"{abs(value):.2f}" in table.source.how_obtained
    alpha, beta = np.degrees(angles())
    assert (alpha.min(), alpha.max()) == pytest.approx((-25.0, 25.0))
    assert (beta.min(), beta.max()) == pytest.approx((0.0, 25.0))


@pytest.mark.parametrize("response", ["C_D", "C_S", "C_L", "C_m", "C_n"])
def test_stated_coefficients_come_back_within_their_intervals(response):
    found = model(symmetric(), response)
    truth = maker().TRUTH[response]
    seen = 0
    for symbol, term in zip(found.symbols, found.terms, strict=True):
        powers = tuple(sum(n for v, n, _ in term.factors if v == name) for name in ("alpha", "beta"))
        value, half = found.named(symbol)
        assert abs(value - truth.get(powers, 0.0)) <= 1.5 * half, symbol
        seen += powers in truth
    assert seen == len(truth)
    assert found.fit.rms == pytest.approx(maker().NOISE, rel=0.1)


def test_signs_that_can_be_seen():
    """Drag brakes, side force is against the drift, lift is with the attack, the moments turn the bow away."""
    at = {"alpha": np.array([0.2]), "beta": np.array([0.2])}
    signs = {m.response: float(np.sign(m.evaluate(at)[0][0])) for m in symmetric().models}
    assert signs == {"C_D": 1.0, "C_S": -1.0, "C_L": 1.0, "C_m": 1.0, "C_n": -1.0}


def test_the_symmetry_of_the_hull_gives_every_response_its_parity():
    for m in symmetric().models:
        odd = m.response in ("C_S", "C_n")
        assert all(t.odd_in("beta") == odd for t in m.terms)


@pytest.mark.parametrize(
    ("form", "terms"), [("tensor", 9), ("total", 6), ("additive", 5)]
)  # fmt: skip
def test_planted_surfaces_come_back_exactly(form, terms):
    a, b = angles()
    values = 0.3 - 0.2 * a + 1.1 * a**2 + 0.4 * b + 0.7 * b**2
    found = model(fit(planted(values, 0.0), degree=2, form=form, parity="beta=full", responses="C_m", **FRONTAL), "C_m")
    assert len(found.terms) == terms
    wanted = {"C_m_0": 0.3, "C_m_alpha": -0.2, "C_m_alpha^2": 1.1, "C_m_beta": 0.4, "C_m_beta^2": 0.7}
    for symbol, value in zip(found.symbols, found.fit.coefficients, strict=True):
        assert value == pytest.approx(wanted.get(symbol, 0.0), abs=1e-10)


@pytest.mark.parametrize("form", ["additive", "total"])
def test_random_intervals_cover_the_truth_as_often_as_they_say(form):
    """20,000 seeded campaigns on every third row, their noise growing with the angles.

    The plugin fits the first ten; for the others its arithmetic is repeated on all of them at once.
    """
    rng = np.random.default_rng(20)
    a, b = angles()
    truth = {"C_m_0": 0.3, "C_m_alpha": -0.2, "C_m_alpha^2": 1.1, "C_m_beta": 0.4, "C_m_beta^2": 0.7}
    clean = 0.3 - 0.2 * a + 1.1 * a**2 + 0.4 * b + 0.7 * b**2
    mask = np.arange(len(a)) % 3 == 0
    noise = (0.002 * (1.0 + np.abs(a) + b))[:, None] * rng.standard_normal((len(a), 20_000))
    options = {"degree": 2, "form": form, "parity": "beta=full", "responses": "C_m", **FRONTAL}
    usable = {**campaign().usable, "M": mask}
    fitted = [fit(replace(planted(clean, e), usable=usable), **options).models[0] for e in noise.T[:10]]
    f = factorise(design(fitted[0].terms, {"alpha": a[mask], "beta": b[mask]}))
    coefficients, residuals = solve(f, (clean[:, None] + noise)[mask])
    half = np.sqrt(hc_variance(f, residuals, 2)) * t_factor(bell_mccaffrey(f))[:, None]
    for k, m in enumerate(fitted):
        np.testing.assert_allclose(coefficients[:, k], m.fit.coefficients, atol=1e-10)
        np.testing.assert_allclose(half[:, k], m.fit.half_width, rtol=1e-8)
    wanted = np.array([truth.get(s, 0.0) for s in fitted[0].symbols])
    share = np.mean(np.abs(coefficients - wanted[:, None]) <= half, axis=1)
    assert np.all((share >= 0.93) & (share <= 0.97)), share


def test_interaction_is_found_where_there_is_one_and_not_elsewhere():
    said = {m.response: next(s for s in m.statements if "Additive" in s) for m in symmetric().models}
    chance = {r: float(s.rpartition(" ")[2].rstrip(".")) for r, s in said.items()}
    assert chance["C_D"] < 1e-50
    assert all(p > 0.01 for r, p in chance.items() if r != "C_D")
    for text in said.values():
        for word in ("rms", "left out", "AICc", "F = "):
            assert word in text


@pytest.mark.slow
def test_the_interaction_test_is_right_as_often_as_it_says():
    """Without interaction its probability is even between 0 and 1: 200 seeded campaigns."""
    rng = np.random.default_rng(5)
    a, b = angles()
    found = []
    for _ in range(200):
        table = planted(0.3 + a**2 + b, 0.002 * rng.standard_normal(len(a)))
        said = interaction(fit(table, degree=2, form="additive", parity="beta=full", responses="C_m", **FRONTAL))
        found.append(float(said.rpartition(" ")[2].rstrip(".")))
    deciles = np.histogram(found, bins=10, range=(0.0, 1.0))[0]
    assert np.sum((deciles - 20.0) ** 2 / 20.0) < 27.9


def test_the_printed_sum_of_two_slices_counts_the_value_at_rest_twice():
    """HUUV paper, eq. 8: C_Dab ~ C_Da + C_Db holds C_D0 twice; the corrected form takes it off once."""
    a, b = angles()
    additive = model(fit(campaign(), form="additive", **FRONTAL), "C_D")
    at_rest = additive.named("C_D_0")[0]
    assert at_rest == pytest.approx(0.3, abs=0.02)
    printed = sum(
        additive.evaluate({"alpha": x, "beta": y})[0] for x, y in ((a, np.zeros_like(b)), (np.zeros_like(a), b))
    )
    np.testing.assert_allclose(printed - at_rest, additive.evaluate({"alpha": a, "beta": b})[0], rtol=1e-12)
    full = model(symmetric(), "C_D")
    half = additive.named("C_D_0")[1]
    said = [s for s in additive.statements if "twice" in s]
    assert said == [
        f"The printed form C_D(alpha) + C_D(beta) counts C_D_0 = {at_rest:.4g} +- {half:.2g} twice and is wrong by that "
        "much everywhere; this fit counts it once."
    ]
    assert not any("twice" in s for s in full.statements)


def test_a_value_at_rest_that_is_not_told_from_zero_is_no_matter():
    a, b = angles()
    noise = 0.002 * np.random.default_rng(2).standard_normal(len(a))
    found = fit(planted(a**2 + b**2, noise), form="additive", degree=2, responses="C_m", **FRONTAL).models[0]
    value, half = found.named("C_m_0")
    assert abs(value) < half
    assert not any("twice" in s for s in found.statements)


def test_terms_keep_the_symmetry_of_the_hull_unless_asked_otherwise():
    default, asked, free = (fit(campaign(), degree=3, **FRONTAL, **o) for o in (
        {}, {"parity": "beta=symmetric"}, {"parity": "beta = full"}))  # fmt: skip
    for m, n, f in zip(default.models, asked.models, free.models, strict=True):
        assert m.terms == n.terms
        assert len(f.terms) == 2 * len(m.terms) == 16
        assert m.form.endswith("odd in beta" if m.response in ("C_S", "C_n") else "even in beta")
    assert default.settings["parity"] == "port-starboard symmetry"


def test_two_variables_that_the_symmetry_turns_around_count_by_their_product():
    table = campaign()
    turning = replace(
        table, motion={**table.motion, "r": 0.3 * np.sin(np.arange(len(table)) * 1.0), "w": table.motion["w"] * 0}
    )
    even, odd = (fit(turning, variables="v r", responses=r, degree=2, form="total").models[0] for r in ("X", "Y"))
    assert [str(t) for t in even.terms] == ["1", "r^2", "v r", "v^2"]
    assert [str(t) for t in odd.terms] == ["r", "v"]


def test_a_variable_that_never_varies_is_named():
    table = campaign()
    flat = replace(table, motion={**table.motion, "w": np.zeros(len(table))})
    with pytest.raises(InputError, match=r"found alpha never varies in the rows of C_D .*polynomial for beta alone"):
        fit(flat, degree=3, responses="C_D")


def test_a_degree_that_is_too_low_is_said_to_be():
    said = " ".join(model(fit(campaign(), degree=1, responses="C_D", **FRONTAL), "C_D").statements)
    assert "The residuals are not random" in said
    assert "Try a higher degree, such as degree = 2, or parity = beta=full." in said


def test_only_the_responses_that_the_table_allows():
    table = campaign()
    without = replace(table, forces={c: table.forces[c] for c in ("Y", "N")})
    with pytest.raises(InputError, match="no X"):
        fit(without, responses="C_D", degree=2)
    assert [m.response for m in fit(without, degree=2).models] == ["C_n"]
    in_plane = replace(table, forces={c: table.forces[c] for c in ("Z", "M")})
    assert [m.response for m in fit(in_plane, degree=2).models] == ["C_m"]


def test_other_variables_and_primes():
    table = campaign()
    found = fit(table, variables="w v", responses="Z", degree=3, form="total")
    assert found.models[0].response == "Z'"
    assert found.models[0].domain.variables == ("w", "v")
    assert found.settings["area_name"] == "L^2"
    assert float(found.settings["area"]) == pytest.approx(1.44)


def test_rows_that_turn_are_left_out():
    table = campaign()
    turning = replace(table, motion={**table.motion, "r": np.where(np.arange(len(table)) < 31, 0.3, 0.0)})
    found = fit(turning, degree=2, responses="C_D").models[0]
    assert found.n_points == 208
    assert found.statements[0].startswith("31 of 239 rows")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"variables": "alpha"}, "two different ones"),
        ({"variables": "alpha alpha"}, "two different ones"),
        ({"variables": "alpha gamma"}, '"gamma"'),
        ({"parity": "beta=weird"}, "beta=weird"),
        ({"parity": "v=odd"}, "v=odd"),
        ({"parity": "alpha=symmetric"}, "port-starboard"),
        ({"variables": "v r", "parity": "v=symmetric"}, "port-starboard"),
        ({"area": 1.0}, "an area above zero with its name"),
        ({"degree": 1, "form": "additive", "parity": "alpha=odd beta=odd"}, "at least one term"),
        ({"form": "cubic"}, "one of tensor, total, additive"),
        ({"responses": "C_Q"}, "C_Q"),
    ],
)
def test_misuse_is_one_clear_error(options, said):
    with pytest.raises(InputError) as caught:
        fit(campaign(), **options)
    assert said in str(caught.value)


def test_more_terms_than_rows_is_refused_and_the_comparison_says_so():
    table = campaign()
    few = replace(table, usable={**table.usable, "M": np.arange(len(table)) % 16 == 0})
    with pytest.raises(InputError, match="15 usable rows of C_m"):
        fit(few, degree=4, parity="beta=full", responses="C_m")
    said = interaction(fit(few, degree=3, form="additive", parity="beta=full", responses="C_m"))
    assert said.startswith("Additive against full")
    assert "full: 10 terms" in said
    assert "not tested" in interaction(fit(few, degree=6, form="additive", parity="beta=full", responses="C_m"))


def test_stated_errors_of_components_weigh_drag() -> None:
    """Drag of a turned force: its error is that of X, Y and Z, each by its share; a wild row of large error hardly counts."""
    table, rng = campaign(), np.random.default_rng(3)
    wild = np.zeros(len(table), dtype=bool)
    wild[7] = True
    forces = {c: table.forces[c] + np.where(wild, 5.0, 0.01 * rng.normal(size=len(table))) for c in ("X", "Y", "Z")}
    stated = {c: np.where(wild, 5.0, 0.01) for c in forces}
    clean = model(fit(table, responses="C_D", **SYMMETRIC), "C_D")
    apart = model(fit(replace(table, forces=forces), responses="C_D", **SYMMETRIC), "C_D")
    weighed = model(fit(replace(table, forces=forces, errors=stated), responses="C_D", **SYMMETRIC), "C_D")
    off = [np.abs(m.fit.coefficients[0] - clean.fit.coefficients[0]) for m in (apart, weighed)]
    assert off[1] < 0.05 * off[0]
    partly = replace(table, forces=forces, errors={"X": stated["X"]})
    np.testing.assert_array_equal(
        model(fit(partly, responses="C_D", **SYMMETRIC), "C_D").fit.coefficients, apart.fit.coefficients
    )


def test_errors_turn_as_forces_do() -> None:
    alpha, beta = (np.array(a) for a in ([0.0, 0.3, -0.2], [0.0, 0.0, 0.4]))
    rng = np.random.default_rng(5)
    sizes = np.array([1.0, 2.0, 3.0])
    noise = sizes[:, None, None] * rng.normal(size=(3, 40_000, 1))
    drawn = wind_forces(alpha, beta, *noise)
    for found, expected in zip(wind_errors(alpha, beta, *(np.full(3, s) for s in sizes)), drawn, strict=True):
        np.testing.assert_allclose(found, expected.std(axis=0), rtol=0.02)
