from __future__ import annotations

import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.report.notation import MINUS, Factor, Raised, Symbol, cell_runs, runs, unit_runs


def spelled(text: str) -> list[str]:
    """Pieces as words: plain text as it is, symbols in braces, exponents after a caret."""
    return [p if isinstance(p, str) else f"^{p.text}" if isinstance(p, Raised) else f"{{{p.text}}}" for p in runs(text)]


@pytest.mark.parametrize(
    ("text", "pieces"),
    [
        ("Yv' = -0.0273", ["{Yv'}", f" = {MINUS}0.0273"]),
        ("-Mw'/Zw'", [MINUS, "{Mw'}", "/", "{Zw'}"]),
        ("v'|v'| + v'^3", ["{v'}", "|", "{v'}", "| + ", "{v'}", "^3"]),
        ("rho U^2 L^3, r L/U", ["{rho}", " ", "{U}", "^2", " ", "{L}", "^3", ", ", "{r}", " ", "{L}", "/", "{U}"]),
        ("2.87e-05 of 3.30e+09", ["2.87\u202f×\u202f10", f"^{MINUS}5", " of 3.30\u202f×\u202f10", "^9"]),
        ("kg/m3 and N*m, 5 N", ["kg/m", "^3", " and N·m, 5 N"]),
        ("10.1 .. 9.9 deg, 2 x 3 +- 4", ["10.1 … 9.9°, 2 × 3 ± 4"]),
        ("sin(beta), C_A(nu) nu", ["sin(", "{beta}", "), ", "{C_A}", "(", "{nu}", ") ", "{nu}"]),
        ("E = S - D at U95", [f"E = S {MINUS} D at ", "{U95}"]),
        ("m3 - m1", [f"m3 {MINUS} m1"]),
        ("2.0e+00 of 0.0e+00, 10⁻³", ["2.0 of 0.0, 10", f"^{MINUS}3"]),
        ("1/2 rho U^2 L^k", ["½ ", "{rho}", " ", "{U}", "^2", " ", "{L}", "^k"]),
        ("(Yr' - m') / (xG' m')", ["(", "{Yr'}", f" {MINUS} ", "{m'}", ") / (", "{xG'}", " ", "{m'}", ")"]),
        ("C_D(beta) - C_D(0)", ["{C_D}", "(", "{beta}", f") {MINUS} ", "{C_D}", "(0)"]),
        ("cos a F_x - sin a z_CG", ["cos a ", "{F_x}", f" {MINUS} sin a ", "{z_CG}"]),
        ("-1.10 b - 2.40 b^3, n - p", [f"{MINUS}1.10 b {MINUS} 2.40 b", "^3", f", n {MINUS} ", "{p}"]),
        ("R2 of 3 m^2", ["R", "^2", " of 3 m", "^2"]),
        ("angle  [deg], as angle deg", ["angle  [°], as angle °"]),
        ("terms X0 Yv Xvr, Xuq, Nur", ["terms ", "{X0}", " ", "{Yv}", " ", "{Xvr}", ", ", "{Xuq}", ", ", "{Nur}"]),
        ("Y|v|v, Nrdot, Ydr', dr'", ["{Y|v|v}", ", ", "{Nrdot}", ", ", "{Ydr'}", ", ", "{dr'}"]),
    ],
)
def test_symbols_and_numbers_are_found(text, pieces):
    assert spelled(text) == pieces


@pytest.mark.parametrize(
    "text",
    [
        "$a_b$ $x^2$ \\alpha \\frac{1}{2}",
        "huuv-5 and a-b, 2018-05-12, pages 7-5-1",
        "data/alpha.csv, drift.csv, beta_sweep, suboff_roddy_2",
        "M. Gertler, G. R. Hagen, NSRDC 2510, DTRC/SHD-1298-08",
        "don't, the author's own, 'quoted'",
        "Mr Yup and Zuma",
        "Nu Kp Nr 5",
        "C_D_alphabet, my_long_name, x_boat",
        "https://example.org/x?y=-",
        "`my_x` and ``coeflab``",
    ],
)
def test_what_is_no_symbol_stays_text(text):
    assert runs(text) == (text,)


def test_a_derivative_in_parts():
    (symbol,) = runs("Y|v|rdot'")
    assert symbol == Symbol("Y", "Y|v|rdot'", (Factor("v", absolute=True), Factor("r", dotted=True)), primed=True)
    (rudder,) = runs("Ndr'")
    assert isinstance(rudder, Symbol)
    assert rudder.factors == (Factor("δ", "r"),)
    (rest,) = runs("X0'")
    assert isinstance(rest, Symbol)
    assert (rest.letter, rest.index, rest.primed) == ("X", "0", True)


def test_a_coefficient_of_a_model_has_its_term_below():
    (squared,) = runs("C_D_alpha^2 beta")
    assert squared == Symbol("C", "C_D_alpha^2 beta", index="Dα²β")
    (slope,) = runs("X'_beta")
    assert slope == Symbol("X", "X'_beta", index="β", primed=True)
    (rest,) = cell_runs("C_L_0")
    assert rest == Symbol("C", "C_L_0", index="L0")


def test_controls_alone_in_a_cell_are_deflections():
    assert cell_runs("ds") == (Symbol("δ", "ds", index="s"),)
    assert runs("δs") == (Symbol("δ", "δs", index="s"),)


def test_a_unit_holds_no_symbol():
    assert unit_runs("N*m") == ("N·m",)
    assert unit_runs("kg*m^2") == ("kg·m", Raised("2"))
    assert unit_runs("m/s^-1") == ("m/s", Raised(f"{MINUS}1"))


def test_a_whole_cell_needs_no_prime():
    assert cell_runs("Yv") == (Symbol("Y", "Yv", (Factor("v"),)),)
    assert cell_runs("Mr Smith") == ("Mr Smith",)
    assert cell_runs("-") == ("–",)
    assert cell_runs("no table") == ("no table",)


@given(st.text())
def test_no_text_is_lost(text):
    pieces = runs(text)
    assert all(p != "" for p in pieces)
    assert not any(isinstance(a, str) and isinstance(b, str) for a, b in pairwise(pieces))
    letters = [c for c in text if c.isalpha()]
    words = "".join(p if isinstance(p, str) else p.text for p in pieces)
    kept = [c for c in words if c.isalpha()]
    assert len(kept) >= len(letters) - 4 * text.count("sqrt ") - 3 * len(re.findall(r"\bdeg\b", text)) - text.count(
        "e"
    ) - text.count(" x ")


@given(st.from_regex(r"[XYZKMN](\|[uvwpqr]\||[uvwpqr](dot)?|d[rsb]){1,4}'", fullmatch=True))
def test_every_primed_derivative_is_one_symbol(text):
    (symbol,) = runs(text)
    assert isinstance(symbol, Symbol)
    assert symbol.primed
    assert symbol.text == text
