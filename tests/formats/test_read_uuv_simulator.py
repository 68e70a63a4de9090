"""URDF and xacro models: LAUV, RexROV, and our own exports come back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.text.xml import read_xml
from coeflab.formats.uuv_simulator import read as uuv_simulator
from coeflab.formats.uuv_simulator import write as exporter
from coeflab.formats.uuv_simulator.law import read_fossen_link
from coeflab.law.transforms import derivative_transfer
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import of_second_order as second

DATA = Path(__file__).parent / "data"
LAUV, REXROV = DATA / "lauv.urdf.xacro", DATA / "rexrov.urdf"


def round_trip(file: ParameterFile, folder: Path) -> ParameterFile:
    ((name, content),) = exporter.render(file).items()
    (folder / name).write_bytes(content)
    return uuv_simulator.read(folder / name, length=file.scaling.length, speed=file.conditions.speed)


def test_lauv_as_it_is_stated() -> None:
    file = uuv_simulator.read(LAUV)
    assert (file.scaling.length, file.scaling.length_name) == (1.08, "length of the box")
    assert file.conditions.density == 1028.0
    stated = {c.symbol: c.value_si for c in file.coefficients}
    expected = {
        "Xu'": -2.4, "Yv'": -23.0, "Yr'": 11.5, "Zw'": -23.0, "Zq'": -11.5, "Kp'": -0.3, "Mw'": 3.1, "Mq'": -9.7, "Nv'": -3.1,
        "Nr'": -9.7, "Xu|u|'": -2.4, "Yv|v|'": -80.0, "Zw|w|'": -80.0, "Kp|p|'": -0.0006, "Mq|q|'": -9.1, "Nr|r|'": -9.1,
    }  # fmt: skip
    assert stated == pytest.approx(expected, rel=1e-12)
    assert {c.law for c in file.coefficients if "|" not in c.symbol} == {"rest"}
    assert np.diag(file.added_mass.matrix).tolist() == [1.0, 16.0, 16.0, 0.005, 1.3, 1.3]
    assert file.mass.mass == 18.0
    assert file.mass.inertia == pytest.approx(18.0 * (3.0 * 0.075**2 + 1.08**2) / 12.0)


@pytest.mark.parametrize("path", [LAUV, REXROV], ids=["lauv", "rexrov"])
def test_foreign_models_keep_the_plugins_law(path: Path) -> None:
    """All motions, the ideal fluid's Munk moment of the added mass among it, whether the matrix is symmetric or not."""
    nu = np.random.default_rng(2).normal(size=(50, 6))
    link, file = read_fossen_link(read_xml(path)), uuv_simulator.read(path)
    np.testing.assert_allclose(force_law(file).force(nu), link.force(nu), rtol=1e-10, atol=1e-8)


def test_rexrovs_matrix_is_symmetric_but_for_rounding() -> None:
    """10.774 against 10.775 is one number of four digits; before it made 90 rows of products."""
    file = uuv_simulator.read(REXROV)
    assert file.added_mass.matrix[2, 4 + 1] == file.added_mass.matrix[5, 2] == pytest.approx(10.7745)
    assert len(file.coefficients) < 30
    assert any("1028" in n for n in file.provenance.notes)


def test_lauv_comes_back_from_a_second_export(tmp_path: Path) -> None:
    first = uuv_simulator.read(LAUV)
    back = round_trip(first, tmp_path)
    assert {c.symbol for c in back.coefficients} == {c.symbol for c in first.coefficients}
    for c in first.coefficients:
        assert back.coefficient(c.symbol).value_si == pytest.approx(c.value_si, rel=1e-12)
    np.testing.assert_allclose(back.added_mass.matrix, first.added_mass.matrix, rtol=1e-12)
    np.testing.assert_allclose(back.mass.inertia_matrix, first.mass.inertia_matrix, rtol=1e-12)


def test_bluerov2_comes_back(tmp_path: Path) -> None:
    file = second.bluerov2_heavy()
    back = round_trip(file, tmp_path)
    assert len(back.coefficients) == 9
    for c in file.coefficients:
        assert back.coefficient(c.symbol).value == pytest.approx(c.value, rel=1e-12)
        assert "|" in c.symbol or back.coefficient(c.symbol).law == "rest"


@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull"])
def test_suboff_comes_back_about_its_centre_of_gravity(name: str, suboff: Study, tmp_path: Path) -> None:
    """First-order derivatives, total again with the Munk moment, moved by the congruence of the transfer."""
    file = suboff.parameter_files[name]
    back = round_trip(file, tmp_path)
    pairs = [("Y", "v"), ("Y", "r"), ("Z", "w"), ("Z", "q"), ("K", "v"), ("M", "w"), ("M", "q"), ("N", "v"), ("N", "r")]
    held = [(f, m) for f, m in pairs if (c := file.coefficient(f + m)) and c.value is not None]
    total = np.zeros((6, 6))
    for f, m in held:
        total["XYZKMN".index(f), "uvwpqr".index(m)] = file.coefficient(f + m).value_si
    shift = np.array([file.mass.mass_moment / file.mass.mass, 0.0, 0.0])
    left, right = derivative_transfer(shift)
    expected = left @ total @ right
    assert len(held) >= 5
    for f, m in held:
        at = "XYZKMN".index(f), "uvwpqr".index(m)
        assert back.coefficient(f + m).value_si == pytest.approx(expected[at], rel=1e-12)
    assert back.coefficient("Xu|u|").value == pytest.approx(file.coefficient("X0").value, rel=1e-12)


def test_what_the_format_lets_go_wrong(tmp_path: Path) -> None:
    told = {c.statistic: c.severity for c in uuv_simulator.examine(LAUV)}
    assert told["4 off-diagonal entries"] is Severity.WARN
    assert Severity.FAIL not in told.values()
    text = LAUV.read_text(encoding="utf-8")
    feet = tmp_path / "feet.xacro"
    feet.write_text(text.replace("0.017551374956865266", "0.6198"), encoding="utf-8")
    assert any(c.severity is Severity.FAIL and c.statistic.startswith("rho V / m") for c in uuv_simulator.examine(feet))
    ahead = tmp_path / "ahead.xacro"
    ahead.write_text(text.replace('xyz="0 0 0"', 'xyz="0.1 0 -0.02"'), encoding="utf-8")
    assert any("0.10198 m from the link's origin" in c.statistic for c in uuv_simulator.examine(ahead))
    moved, nu = uuv_simulator.read(ahead), np.random.default_rng(3).normal(size=(20, 6))
    np.testing.assert_allclose(force_law(moved).force(nu), read_fossen_link(read_xml(ahead)).force(nu), atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("<type>fossen</type>", "<type>sphere</type>", "sphere"),
        ("<linear_damping_forward_speed>0 0 0 0 0 0<", "<linear_damping_forward_speed>0 0 0<", "3 numbers"),
        ("${0.5 * width}", "${0.5 * wide}", "wide, which has no number above"),
        ("${mass}", "${weight}", "weight"),
        ("${mass}", "${__import__('os')}", "no arithmetic"),
        ("1 0 0 0 0 0", "inf 0 0 0 0 0", '"inf"'),
        ("<hydrodynamic_model>", "<hydrodynamics>", "mismatched"),
        ('value="18"', 'value="${mass}"', "deep"),
    ],
)
def test_unreadable_files_say_why(old: str, new: str, found: str, tmp_path: Path) -> None:
    path = tmp_path / "m.xacro"
    path.write_text(LAUV.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        uuv_simulator.read(path)
    assert found in str(caught.value)


def test_damping_beside_damping_at_rest_keeps_its_own_name(tmp_path: Path) -> None:
    """u v beside v: Yuv and Yv."""
    path = tmp_path / "m.xacro"
    text = LAUV.read_text(encoding="utf-8").replace(
        "<linear_damping_forward_speed>0 0 0 0 0 0<", "<linear_damping_forward_speed>0 -7 0 0 0 0<"
    )
    path.write_text(text, encoding="utf-8")
    file = uuv_simulator.read(path)
    assert file.coefficient("Yuv").value_si == pytest.approx(-7.0)
    assert file.coefficient("Yv").value_si == pytest.approx(-23.0)
