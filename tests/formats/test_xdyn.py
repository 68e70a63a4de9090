"""The xdyn file: the law read back from its own expressions is that of the parameter file."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.yaml import parse_yaml
from coeflab.formats.export import export
from coeflab.formats.missing_parts import Kind
from coeflab.formats.xdyn import read as importer
from coeflab.formats.xdyn import write as xdyn
from coeflab.formats.xdyn.law import xdyn_body
from coeflab.law.transforms import moved
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import CENTRE, MASS, OWN, torpedo, with_mass

GOLDEN = Path(__file__).parent / "golden" / "file.yml"


def weighed(file: ParameterFile) -> ParameterFile:
    """With a mass in the reference point: xdyn runs no file without."""
    return with_mass(file, np.zeros(3))


FILES = [
    weighed(made.full(1)), weighed(made.plain()), weighed(made.at_rest()), torpedo(), with_mass(made.full(2)),
    with_mass(made.at_rest()),
]  # fmt: skip


def velocities(n: int = 50) -> np.ndarray:
    return np.random.default_rng(5).normal(size=(n, 6)) + np.array([1.5, 0, 0, 0, 0, 0])


def content(file: object) -> dict:
    return parse_yaml(xdyn.render(file)["file.yml"].decode())


def test_golden() -> None:
    """Regenerate by hand: write xdyn.render(torpedo()) to golden/file.yml and read the difference."""
    assert xdyn.render(torpedo()) == {"file.yml": GOLDEN.read_bytes()}


@pytest.mark.parametrize("file", FILES)
def test_its_force_is_the_files(file: object) -> None:
    nu = velocities()
    expected = force_law(file).force(nu)
    np.testing.assert_allclose(xdyn.force(xdyn.render(file), nu), expected, rtol=1e-11, atol=1e-8)


def test_at_rest_nothing_is_divided_by_zero() -> None:
    assert np.all(np.isfinite(xdyn.force(xdyn.render(weighed(made.full(1))), np.zeros((1, 6)))))


def test_the_munk_moment_is_counted_once() -> None:
    """In steady drift the yaw moment is the measured Nv, Nv|v| and Nuv alone; the added mass adds none."""
    speed, beta, length = 2.0, 0.1, 2.0
    v = speed * np.sin(beta)
    nu = np.array([[speed * np.cos(beta), v, 0.0, 0.0, 0.0, 0.0]])
    moment = xdyn.force(xdyn.render(with_mass(made.plain())), nu)[0, 5]
    stated = 500.0 * length**3 * (-1.4e-2 * speed * v - 1e-2 * v * abs(v) + 1e-3 * nu[0, 0] * v)
    assert moment == pytest.approx(stated, rel=1e-11)


def test_inertia_stands_about_the_centre_of_gravity() -> None:
    body = xdyn_body(content(torpedo()), "file.yml")
    np.testing.assert_allclose(body.rigid[3:, 3:], OWN, rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(body.rigid[:3], MASS * np.eye(6)[:3])
    np.testing.assert_allclose(body.added, moved(water_inertia(torpedo()).matrix, CENTRE), rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(body.centre, np.zeros(3))
    np.testing.assert_allclose(body.mesh, CENTRE)


def test_without_inertia_the_export_is_refused() -> None:
    """As xdyn refuses to run it; `accept_loss` does not help."""
    whole = torpedo()
    assert whole.mass is not None
    for mass, lacking in (
        (None, "mass"),
        (replace(whole.mass, inertia_matrix=None, inertia=14.0), "mass.inertia_matrix"),
        (replace(whole.mass, inertia_matrix=None, centre=None), "mass.centre"),
    ):
        with pytest.raises(InputError) as refused:
            export(whole.model_copy(update={"mass": mass}), "xdyn", accept_loss=True)
        assert refused.value.column == lacking
    assert xdyn.missing(whole) == ()


def test_negative_added_mass_is_refused() -> None:
    file = with_mass(made.parameters({"Yvdot": 0.1, "Yv": -0.03}))
    with pytest.raises(InputError, match="not positive definite"):
        xdyn.render(file)


def test_nothing_is_lost() -> None:
    loss = export(torpedo(), "xdyn").loss
    assert loss.lossless


def test_a_product_with_an_acceleration_is_not_held() -> None:
    file = made.parameters({"Yv": -0.03, "Yvvdot": 0.1, "Yvdot": -0.02})
    assert xdyn.not_held(file) == ("Yvvdot (product with an acceleration)",)


def test_rest_damping_stands_as_positive_matrices() -> None:
    forces = content(weighed(made.at_rest()))["bodies"][0]["external forces"]
    assert [f["model"] for f in forces] == ["linear damping", "quadratic damping", "maneuvering"]
    linear = forces[0]["damping matrix at the center of gravity projected in the body frame"]
    assert linear["row 2"][1] == pytest.approx(3e-2 * 500.0 * 1.5 * 4.0)


@pytest.mark.parametrize("name", made.HOSTILE)
def test_names_that_hurt(name: str) -> None:
    rendered = xdyn.render(weighed(made.named(name)))
    ((file, raw),) = rendered.items()
    assert re.fullmatch(r"[A-Za-z]\w{0,62}\.yml", file, re.ASCII)
    read = parse_yaml(raw.decode())
    assert list(read) == list(content(weighed(made.plain())))
    assert re.fullmatch(r"[A-Za-z]\w{0,62}", read["bodies"][0]["name"], re.ASCII)
    nu = velocities(5)
    np.testing.assert_array_equal(xdyn.force(rendered, nu), xdyn.force(xdyn.render(weighed(made.plain())), nu))


@pytest.mark.parametrize("file", FILES[:5])
def test_it_comes_back(tmp_path: Path, file: object) -> None:
    (tmp_path / "file.yml").write_bytes(xdyn.render(file)["file.yml"])
    back = importer.read(tmp_path / "file.yml")
    for c in file.coefficients:
        found = back.coefficient(c.symbol)
        value, law = (found.value, found.law) if found.status == "stated" else (None, None)
        if c.law == "rest":
            assert found.value_si == pytest.approx(c.value_si, rel=1e-12)
        else:
            assert value == pytest.approx(c.value, rel=1e-12)
            assert law == c.law
    assert (back.added_mass is None) == (file.added_mass is None)
    if file.added_mass is not None:
        largest = np.max(np.abs(file.added_mass.matrix))
        np.testing.assert_allclose(back.added_mass.matrix, file.added_mass.matrix, rtol=1e-12, atol=1e-12 * largest)
        assert len(back.coefficients) == len(file.coefficients)
    if file.mass is not None:
        np.testing.assert_allclose(back.mass.inertia_matrix, file.mass.inertia_matrix, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(back.mass.centre, file.mass.centre, rtol=1e-12)
    np.testing.assert_allclose(back.reference_point.point, file.reference_point.point, atol=1e-15)
    nu = velocities(20)
    np.testing.assert_allclose(force_law(back).force(nu), force_law(file).force(nu), rtol=1e-10, atol=1e-8)


@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull"])
def test_suboff(suboff: Study, tmp_path: Path, name: str) -> None:
    """Measured yaw moment in drift, Munk moment counted once, and every coefficient comes back."""
    file = made.slopes_alone(suboff.parameter_files[name])
    rendered = xdyn.render(file)
    v, speed, length = 0.3, 3.0, file.scaling.length
    forward = np.sqrt(speed**2 - v**2)
    drifts = np.array([[forward, v, 0.0, 0.0, 0.0, 0.0], [forward, -v, 0.0, 0.0, 0.0, 0.0]])
    measured = 0.5 * file.conditions.density * length**3 * file.coefficient("Nv").value * speed * v
    starboard, port = xdyn.force(rendered, drifts)[:, 5]
    assert (starboard - port) / 2.0 == pytest.approx(measured, rel=1e-11)
    loss = export(file, "xdyn").loss
    assert loss.relative.max() < 1e-9
    kinds = {x.kind for x in loss.lost}
    assert kinds == set()
    computed = export(file, "xdyn", "computed").loss
    assert {x.kind for x in computed.lost} == {Kind.REPLACED}
    assert loss.lossless
    path = tmp_path / f"{name}.yml"
    path.write_bytes(rendered[f"{name}.yml"])
    back = importer.read(path)
    np.testing.assert_allclose(back.reference_point.point, file.reference_point.point, rtol=1e-12)
    for c in file.coefficients:
        if c.value is not None and "dot" not in c.symbol:
            assert back.coefficient(c.symbol).value == pytest.approx(c.value, rel=1e-12), c.symbol
    measured = water_inertia(file).matrix
    np.testing.assert_allclose(back.added_mass.matrix, measured, rtol=1e-12, atol=1e-12 * measured.max())
    assert np.abs(measured - file.added_mass.matrix).max() > 20.0
