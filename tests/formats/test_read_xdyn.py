"""xdyn files of others: their law multiplied out; what no parameter file holds, and every trick of YAML, is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.yaml import parse_yaml
from coeflab.formats.xdyn import write as exporter
from coeflab.formats.xdyn.law import xdyn_body
from coeflab.formats.xdyn.read import read
from coeflab.law.transforms import force_transfer, velocity_transfer
from coeflab.vehicle.force_law import force_law
from tests.formats.massed import torpedo
from tests.vehicle.test_force_law import parameters

ROV = Path(__file__).parent / "data" / "bluerov2_heavy.yml"
FRAME = """
      - model: maneuvering
        name: made
        reference frame: {frame: BlueROV2 Heavy, x: {value: 1.5, unit: m}, y: {value: 0, unit: m}, z: {value: 0.2, unit: m},
            phi: {value: 0, unit: rad}, theta: {value: 0, unit: rad}, psi: {value: 0, unit: rad}}
        commands: []
"""
SIX = {"X": "0", "Y": "0", "Z": "0", "K": "0", "M": "0", "N": "0"}


def reading(folder: Path, text: str) -> object:
    (folder / "model.yml").write_text(text, encoding="utf-8")
    return read(folder / "model.yml")


def refused(folder: Path, text: str) -> str:
    with pytest.raises(InputError) as caught:
        reading(folder, text)
    return str(caught.value)


def manoeuvring(expressions: dict[str, str], *, alone: bool = False) -> str:
    text = ROV.read_text(encoding="utf-8")
    if alone:
        text = text.partition("      - model: linear damping")[0]
    return text.rstrip() + FRAME + "".join(f"        {k}: {v}\n" for k, v in {**SIX, **expressions}.items())


def test_a_published_vehicle() -> None:
    file = read(ROV)
    assert file.body == "BlueROV2 Heavy"
    assert (file.scaling.length_name, file.conditions.density) == ("1 m", 1000.0)
    stated = {"Xu": -13.7, "Zw": -33.0, "Mq": -0.8, "Xu|u|": -141.0, "Yv|v|": -217.0, "Kp|p|": -1.19, "Xudot": -6.36,
              "Kpdot": -0.189, "Nrdot": -0.222}  # fmt: skip
    for symbol, value in stated.items():
        c = file.coefficient(symbol)
        assert c.value_si == pytest.approx(value, rel=1e-12), symbol
        assert c.law == ("rest" if symbol in ("Xu", "Zw", "Mq") else "motion")
    assert len(file.coefficients) == 15
    assert file.mass.mass == 13.5
    np.testing.assert_allclose(file.mass.inertia_matrix, np.diag([0.26, 0.23, 0.37]))
    notes = " ".join(file.remarks)
    for said in (
        "Left out, weight and buoyancy: gravity",
        "1 m: the file states none",
        "no C_A(nu) nu",
        "initial speed is zero",
    ):
        assert said in notes


def test_an_export_of_it_comes_back(tmp_path: Path) -> None:
    file = read(ROV)
    ((name, content),) = exporter.render(file).items()
    (tmp_path / name).write_bytes(content)
    back = read(tmp_path / name)
    for c in file.coefficients:
        assert back.coefficient(c.symbol).value_si == pytest.approx(c.value_si, rel=1e-12), c.symbol
    assert len(back.coefficients) == len(file.coefficients)


def test_any_point_of_calculation(tmp_path: Path) -> None:
    """Damping at its own point, a manoeuvring force at another, a centre of gravity away from the origin."""
    text = manoeuvring({"Y": "-3*u(t)*v(t) + 2*r(t)*abs(r(t))", "K": "0.5*w(t)^2", "N": "v(t)*(u(t) - 2*p(t))/4"})
    text = text.replace("in body frame:\n            x: {value: 0", "in body frame:\n            x: {value: 0.7")
    text = text.replace("frame: BlueROV2 Heavy\n            x: {value: 0, unit: m}",
                        "frame: BlueROV2 Heavy\n            x: {value: 0.3, unit: m}")  # fmt: skip
    body = xdyn_body(parse_yaml(text), "model.yml")
    np.testing.assert_allclose((body.centre[0], body.damping_point[0]), (0.3, 0.7))
    file = reading(tmp_path, text)
    np.testing.assert_allclose(file.reference_point.point, (0.3, 0.0, 0.0))
    nu = np.random.default_rng(4).normal(size=(30, 6))
    np.testing.assert_allclose(force_law(file).force(nu), body.force(nu), rtol=1e-12, atol=1e-10)
    u, v, w, p, q, r = nu.T
    side = -3 * u * v + 2 * r * abs(r)
    yaw = 0.25 * v * (u - 2 * p) + 1.2 * side - 0.8 * 0 * q
    linear = np.diag([13.7, 0, 33, 0, 0.8, 0])
    square = np.diag([141, 217, 190, 1.19, 0.47, 1.5])
    damping = -(nu @ linear + (np.abs(nu) * nu) @ square) @ force_transfer(np.array([-0.4, 0, 0])).T
    np.testing.assert_allclose(body.force(nu)[:, 5], yaw + damping[:, 5], rtol=1e-12)
    np.testing.assert_allclose(body.force(nu)[:, 3], 0.5 * w**2 - 0.2 * side + damping[:, 3], rtol=1e-12)


def test_velocities_at_the_point_make_it_the_reference_point(tmp_path: Path) -> None:
    text = manoeuvring(
        {"Y": "5*L^2*Yv*sqrt(u_^2 + v_^2)*v_", "v_": "v(t) + 1.5*r(t) - 0.2*p(t)", "u_": "u(t) + q(t)*0.2",
         "L": "0.5", "Yv": "-2"}, alone=True,
    )  # fmt: skip
    file = reading(tmp_path, text)
    assert file.reference_point.point == (1.5, 0.0, 0.2)
    assert (file.scaling.length, file.scaling.length_name) == (0.5, "L")
    assert file.coefficient("Yv").value == pytest.approx(5 * -2 / 500)
    assert any("root of u^2 + v^2" in n for n in file.provenance.notes)
    nu = np.array([[1.0, 0.2, 0.0, 0.1, 0.0, 0.3]])
    here = velocity_transfer(np.array([1.5, 0.0, 0.2])) @ nu[0]
    side = 5 * 0.25 * -2 * np.hypot(*here[:2]) * here[1]
    assert force_law(file).force(here[None, :])[0, 1] == pytest.approx(side)


def test_products_of_the_ideal_fluid_are_left_to_the_added_mass(tmp_path: Path) -> None:
    """All of C_A in the file: added mass as such. One product changed: booked as a coefficient, and the rest kept."""
    text = exporter.render(torpedo())["file.yml"].decode()
    assert reading(tmp_path, text).coefficient("Xwq") is None
    changed = reading(tmp_path, text.replace("Xwq_ideal: -0.013", "Xwq_ideal: -0.02"))
    assert changed.coefficient("Xwq").value == pytest.approx(-0.02)
    assert changed.added_mass is not None
    less = reading(tmp_path, text.replace(" + r3*Xwq_ideal*w*q", ""))
    assert less.added_mass is None
    assert less.coefficient("Zwdot") is not None
    np.testing.assert_allclose(force_law(less).force(np.array([[0, 0, 1.0, 0, 1.0, 0]]))[0, 0],
                               force_law(torpedo()).force(np.array([[0, 0, 1.0, 0, 1.0, 0]]))[0, 0] + 52.0)  # fmt: skip


def test_doubtful_added_mass_is_said(tmp_path: Path) -> None:
    notes = " ".join(reading(tmp_path, ROV.read_text().replace("[6.36,", "[-6.36,")).provenance.notes)
    assert "negative added mass: Xudot" in notes
    notes = " ".join(reading(tmp_path, ROV.read_text().replace("[6.36,", "[-26.36,")).provenance.notes)
    assert "no simulation survives" in notes
    notes = " ".join(reading(tmp_path, ROV.read_text().replace("[6.36, 0", "[6.36, 5")).provenance.notes)
    assert "not symmetric" in notes


@pytest.mark.parametrize(
    ("expression", "said"),
    [
        ("cos(u(t))", "cos of a velocity"),
        ("-u(t)", "stops reading"),
        ("1 + -v(t)", "stops reading"),
        ("2*(u(t)", "not closed"),
        ("u(t)*rudder", "rudder"),
        ("X", "needs itself"),
        ("1/(u(t) + v(t))", "dividing by a sum"),
        ("u(t)^0.5", "whole number"),
        ("sqrt(u(t)^2 + r(t)^2)", "root"),
        ("abs(u(t) + v(t))", "absolute value of a sum"),
        ("(u(t)+v(t)+w(t)+p(t)+q(t)+r(t)+1)^12", "products"),
        ("u(t)/v(t)", "X with"),
        ("u(t)^7", "X with"),
        ("10^400", "large"),
        ("1/0", "zero"),
        ("__import__('os')", "stops reading"),
        ("x(t)", "not computed"),
    ],
)
def test_what_is_no_product_of_velocities(tmp_path: Path, expression: str, said: str) -> None:
    assert said in refused(tmp_path, manoeuvring({"X": expression})).lower().replace("x with", "X with")


def test_one_velocity_with_and_without_speed_is_no_one_derivative(tmp_path: Path) -> None:
    text = manoeuvring({"Y": "v(t) + v(t)*sqrt(u(t)^2 + v(t)^2 + w(t)^2)"}, alone=True)
    assert "with and without the speed" in refused(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: !!python/object/apply:os.system [ls]\n", "tag"),
        ("a: &a [1]\nb: *a\n", "alias"),
        ("a: 1\na: 2\n", "second time"),
        ("a: {b: 1, b: 2}\n", "second time"),
        ("a: " + "[" * 100 + "]" * 100 + "\n", "nesting"),
        ("- 1\n", "no mapping"),
        ("a: [1\n", "line"),
        ("a: 1\n---\nb: 2\n", "YAML"),
        ("bodies: []\n", "one body"),
        ("bodies: 3\n", "one body"),
        ("? [a]\n: b\n", "collection"),
        ("a: \x07\n", "YAML"),
        ("", "empty"),
        ("x" * (2 << 20), "bytes"),
    ],
)
def test_yaml_that_is_no_model(tmp_path: Path, text: str, said: str) -> None:
    assert said in refused(tmp_path, text)


@pytest.mark.parametrize(
    ("found", "instead", "said"),
    [
        ("{value: 1000, unit: kg/m^3}", "{value: 1000}", "rho"),
        ("{value: 1000, unit: kg/m^3}", "{value: yes, unit: kg/m^3}", "rho"),
        ("{value: 1000, unit: kg/m^3}", "{value: .nan, unit: kg/m^3}", "rho"),
        ("{value: 1000, unit: kg/m^3}", "{value: -5, unit: kg/m^3}", "density"),
        ("row 3: [0, 0, 18.68, 0, 0, 0]", "row 3: [0, 0, 18.68, 0, 0]", "row 3"),
        ("row 3: [0, 0, 18.68, 0, 0, 0]", "row 3: [0, 0, a, 0, 0, 0]", "row 3"),
        ("row 3: [0, 0, 18.68, 0, 0, 0]", "row 3: [0, 0, 1e308, 0, 0, 0]", "row 3"),
        ("    dynamics:", "    dynamic:", "dynamics"),
        ("      - model: gravity", "      - mode: gravity", "model"),
    ],
)
def test_what_is_missing_is_named(tmp_path: Path, found: str, instead: str, said: str) -> None:
    text = ROV.read_text()
    assert found in text
    assert said in refused(tmp_path, text.replace(found, instead, 1))


def test_imperial_units_are_converted(tmp_path: Path) -> None:
    text = ROV.read_text().replace(
        "frame: BlueROV2 Heavy\n            x: {value: 0, unit: m}",
        "frame: BlueROV2 Heavy\n            x: {value: 1, unit: ft}",
    )
    assert reading(tmp_path, text).reference_point.point[0] == pytest.approx(0.3048)


def test_the_same_law_in_other_words(tmp_path: Path) -> None:
    """Primes written as in xdyn's own manual, u_ = u/Vs, against the exporter's way of writing them."""
    plain = parameters({"Xvv": -0.041, "Yv": -0.13, "Yv|v|": -0.18, "Yr": 0.015, "Nr": -0.1})
    text = manoeuvring(
        {"X": "0.5*rho*Vs^2*L^2*X_", "Y": "0.5*rho*Vs^2*L^2*Y_", "N": "0.5*rho*Vs^2*L^3*N_",
         "Vs": "sqrt(u(t)^2+v(t)^2+w(t)^2)", "L": "2.0", "X_": "Xvv*v_^2", "Y_": "Yv*v_ + Yvv*v_*abs(v_) + Yr*r_",
         "N_": "Nr*r_", "v_": "v(t)/Vs", "r_": "r(t)/Vs*L", "Xvv": "-0.041", "Yv": "-0.13", "Yvv": "-0.18",
         "Yr": "0.015", "Nr": "-0.1"}, alone=True,
    ).replace("x: {value: 1.5, unit: m}", "x: {value: 0, unit: m}").replace("z: {value: 0.2,", "z: {value: 0,")  # fmt: skip
    back = reading(tmp_path, text)
    for c in plain.coefficients:
        assert back.coefficient(c.symbol).value == pytest.approx(c.value, rel=1e-12)
        assert back.coefficient(c.symbol).law == "motion"
