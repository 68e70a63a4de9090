"""MSS files: published vehicles come in with their units; nothing is run; what cannot be known is refused or said."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.formats.mss import write as exporter
from coeflab.formats.mss.read import read
from coeflab.law.rigid_body import ideal_force
from coeflab.vehicle.force_law import force_law

DATA = Path(__file__).parent / "data"
SI = "rho = 1025; Yv = -20; Yvdot = -30;\n"


def reading(folder: Path, text: str | bytes) -> object:
    path = folder / "model.m"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read(path)


def refused(folder: Path, text: str | bytes) -> str:
    with pytest.raises(InputError) as caught:
        reading(folder, text)
    return str(caught.value)


def test_primes_of_the_nps_auv() -> None:
    file = read(DATA / "nps_auv2.m")
    assert (file.scaling.length, file.scaling.length_name, file.conditions.density) == (5.3, "L", 1025.0)
    stated = {
        "Yv": -1.0e-1,
        "Nr": -1.6e-2,
        "Xwq": -2.0e-1,
        "Kvw": -1.9e-1,
        "Muw": 1.0e-1,
        "Nvdot": 1.2e-3,
        "Ndr": -1.3e-2,
    }
    for symbol, value in stated.items():
        c = file.coefficient(symbol)
        assert (c.value, c.law, c.status, c.u95) == (value, "motion", "stated", None)
    assert len(file.coefficients) == 67
    assert any("primed derivatives" in n for n in file.provenance.notes)
    v, length = 0.1, 5.3
    yaw = force_law(file).force(np.array([[1.0, v, 0.0, 0.0, 0.0, 0.0]]))[0, 5]
    assert yaw == pytest.approx(0.5 * 1025.0 * length**3 * -7.4e-3 * np.hypot(1.0, v) * v)


def test_si_values_of_the_bluerov() -> None:
    file = read(DATA / "bluerov2_heavy.m")
    assert file.scaling.length_name == "1 m"
    assert file.coefficient("Xu").law == "rest"
    assert file.coefficient("Xu").value_si == pytest.approx(-13.7, rel=1e-12)
    assert file.coefficient("Xuu") is None
    force = force_law(file).force(np.array([[-0.5, 0.0, 0.2, 0.0, 0.0, 0.3]]))[0]
    expected = [13.7 * 0.5 + 141.0 * 0.25, 0.0, -33.0 * 0.2 - 190.0 * 0.04, 0.0, 0.0, -1.5 * 0.09]
    np.testing.assert_allclose(force, expected, atol=1e-12)
    assert any("Xuu read as Xu|u|" in n for n in file.provenance.notes)


@pytest.mark.parametrize(
    ("stated", "law", "si"), [("Yvv = -131; Nvv = -3.18;", "Nv|v|", -3.18), ("Mqq = -9.4; Zqq = -0.63;", "Zq|q|", -0.63),
                              ("Nvv = -3.18;", "Nvv", -3.18), ("Zww = -131; Mww = 3.18;", "Mw|w|", 3.18),
                              ("Zww = -131; Zrr = 2;", "Zrr", 2)]
)  # fmt: skip
def test_squares_of_a_motion_are_odd_as_its_damping_is(stated: str, law: str, si: float, tmp_path: Path) -> None:
    """Before: Prestero's Nvv, Yrr, Mww, Zqq were even, so that drift to either side turned the bow to port."""
    assert reading(tmp_path, SI + stated).coefficient(law).value_si == pytest.approx(si)


def test_slug_and_foot_become_si() -> None:
    file = read(DATA / "torpedo_imperial.m")
    pound, foot = 4.4482216152605, 0.3048
    slug = pound / foot
    assert file.conditions.density == pytest.approx(1.94 * slug / foot**3)
    assert file.coefficient("Xudot").value_si == pytest.approx(-0.35 * slug)
    assert file.coefficient("Kpdot").value_si == pytest.approx(-0.025 * slug * foot**2)
    assert file.coefficient("Nuv").value_si == pytest.approx(-1.57 * pound * foot / foot**2)
    assert file.coefficient("Yv|v|").value_si == pytest.approx(-3.0 * pound / foot**2)
    assert any("slug, foot and pound" in n for n in file.provenance.notes)


@pytest.mark.parametrize("name", ["nps_auv2", "bluerov2_heavy", "torpedo_imperial"])
def test_export_and_import_return_it(name: str, tmp_path: Path) -> None:
    file = read(DATA / f"{name}.m")
    for written, content in exporter.render(file).items():
        (tmp_path / written).write_bytes(content)
        again = read(tmp_path / written)
    for c in file.coefficients:
        back = again.coefficient(c.symbol)
        assert (back.value, back.value_si) == pytest.approx((c.value, c.value_si), rel=1e-12)
    nu = np.random.default_rng(1).normal(size=(30, 6))
    force = force_law(file).force(nu)
    np.testing.assert_allclose(exporter.force(exporter.render(file), nu), force, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(force_law(again).force(nu), force, rtol=1e-9, atol=1e-9)


def test_arithmetic_structs_comments_and_continuation(tmp_path: Path) -> None:
    file = reading(
        tmp_path,
        "%{\nYv = 7;\n%}\nh.rho = 1.025*10^3; % Yv = 8\nh.L = 5.3;\nh.B = [1, 2; 3 4]';\nD = 0.5; name = 'it''s; Yv = 9';\n"
        "h.Yv = -(h.rho/2)*h.L^2 ...\n   * 1.0e-2; h.Nvav = -2^2/4;\nfunction y = f(x)\ny = x; Zq = -3.5 # Octave\n",
    )
    assert file.coefficient("Yv").value_si == pytest.approx(-0.5 * 1025.0 * 5.3**2 * 1e-2, rel=1e-12)
    assert file.coefficient("Nv|v|").value_si == pytest.approx(-1.0)
    assert file.coefficient("Zq").value_si == pytest.approx(-3.5)
    assert len(file.coefficients) == 3


def test_a_model_that_adds_coriolis_states_viscous_parts(tmp_path: Path) -> None:
    masses = "Xudot = -5; Yvdot = -40; Zwdot = -41; Kpdot = -0.1; Mqdot = -9; Nrdot = -9.5; Yrdot = 2; Nvdot = 2;\n"
    file = reading(tmp_path, "rho = 1025; Yv = -20;\n" + masses + "CA = m2c(MA, nu);\n")
    nu = np.random.default_rng(2).normal(size=(10, 6))
    expected = ideal_force(np.array(file.added_mass.matrix), nu)
    expected[:, 1] -= 20.0 * nu[:, 1]
    np.testing.assert_allclose(force_law(file).force(nu), expected, atol=1e-9)
    assert file.added_mass.matrix[1][5] == -2.0
    alone = reading(tmp_path, "rho = 1025; Yv = -20;\n" + masses)
    assert alone.added_mass is None
    assert any("no C_A" in n for n in alone.provenance.notes)


def test_a_primed_model_that_adds_coriolis_gives_totals(tmp_path: Path) -> None:
    text = "rho = 1000; L = 2; r3 = rho*L^3/2; Xudot = -0.002; Yvdot = -0.03; Zwdot = -0.03; Nv = -0.004; CA = m2c(MA, nu);"
    c = reading(tmp_path, text).coefficient("Nv")
    assert c.potential == pytest.approx(-0.028)
    assert c.value == pytest.approx(-0.004 - 0.028)


@pytest.mark.parametrize(
    ("masses", "said"),
    [
        ("Yvdot = -40; Nrdot = -9; Yrdot = 2; Nvdot = 3;", "not symmetric: Yrdot 2 against Nvdot 3"),
        ("Yvdot = 40; Nrdot = -9;", "negative added mass: Yvdot 40"),
        ("Yvdot = -4; Nrdot = -1; Yrdot = 3; Nvdot = 3;", "not positive definite"),
    ],
)
def test_doubtful_added_mass_is_said(masses: str, said: str, tmp_path: Path) -> None:
    file = reading(tmp_path, "rho = 1000; CA = m2c(MA, nu);\n" + masses)
    assert any(said in n for n in file.provenance.notes)
    assert file.added_mass is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Yv = -20;", "no density"),
        ("rho = -1025; Yv = -20;", "a density above zero"),
        ("rho = NaN; Yv = -20;", "line 1: found \"NaN\""),
        ("rho = 1e400; Yv = -20;", "not finite"),
        ("rho = 1025; Yv = -20;" + " " * 262144, "at most 262144 bytes"),
        ("x = 3;", "no derivative"),
        ("rho = 1025;\nYv = Cd*3;", "line 2: found \"Cd*3\": Cd, which has no number above"),
        ("rho = 1025; Yv = system('x');", "is no arithmetic"),
        ("rho = 1025; Yv = sqrt(4);", "sqrt(...), which is not computed here"),
        ("rho = 1025; Yv = [1 2];", "is no arithmetic"),
        ("rho = 1025; Yv = -1;\nYv = -2;", "line 2: found Yv = -2 after -1"),
        ("rho = 1025; Yv = 1/0;", "division by zero"),
        ("rho = 1025; Yv = 9^9^9^9;", "too large"),
        ("rho = 1025; Yv = 1e999;", "not finite"),
        ("rho = 1025; Yv = (-8)^(1/3);", "root of a negative number"),
        ("rho = 1025; Yv = " + "(" * 5000 + "1" + ")" * 5000, "too deep"),
        ("rho = 1025; L = -5; Yv = -3;", "a length above zero"),
        ("h.coeflab = 1; h.rho = 1000; h.Yv = -0.1;", "no U0, L, x_ref"),
        (b"Yv = \xff\xfe", "UTF-8"),
        ("", "empty file"),
    ],
)  # fmt: skip
def test_refused(text: str | bytes, said: str, tmp_path: Path) -> None:
    assert said in refused(tmp_path, text)


def test_a_huge_file_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "model.m"
    with path.open("wb") as stream:
        stream.truncate(1 << 32)
    tracemalloc.start()
    with pytest.raises(InputError, match="at most"):
        read(path)
    assert tracemalloc.get_traced_memory()[1] < 1 << 20
    tracemalloc.stop()


def test_numbers_that_make_no_file_are_refused(tmp_path: Path) -> None:
    """A value that overflows on the way to its prime, and a body whose inertia no mass has."""
    facts = "h.coeflab = 1; h.rho = 1e3; h.U0 = 1; h.L = {}; h.x_ref = 0; h.y_ref = 0; h.z_ref = 0;\n"
    assert "finite" in refused(tmp_path, facts.format("1e9") + "h.Nr = 1e300;")
    inertia = " ".join(f"h.I{i}{j} = {float(i == j) * (9.0 if i == 1 else 1.0)};" for i in (1, 2, 3) for j in (1, 2, 3))
    body = "h.m = 5; h.mxG = 0; h.xG = 0; h.yG = 0; h.zG = 0; "
    assert "expected numbers that make a parameter file" in refused(
        tmp_path, facts.format("1") + body + inertia + "h.Yv = -1;"
    )
