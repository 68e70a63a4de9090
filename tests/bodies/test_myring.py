"""Myring hulls: REMUS beside Prestero's figures, closed forms, and parameters that cannot be."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from coeflab.bodies.added_masses import added_masses
from coeflab.bodies.mesh.decimation import is_closed
from coeflab.bodies.mesh.meshing import dense_meridian, meshed
from coeflab.bodies.profiles import Myring
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Revolution
from coeflab.core.errors import InputError
from coeflab.core.files import shipped

BODY = shipped("geometry") / "remus100" / "body.toml"
REMUS = Myring(0.191, 0.654, 0.541, 0.191, 2.0, 0.436, 0.0165, 0.0368)


def prestero(x: float) -> float:
    """His equations 2.1-2.3, with the numbers of Table 2.1."""
    a, b, c, d, n, theta, cut = 0.191, 0.654, 0.541, 0.191, 2.0, 0.436, 0.0165
    forward = a + b - cut
    if x <= a - cut:
        return d / 2 * (1 - ((x + cut - a) / a) ** 2) ** (1 / n)
    if x <= forward:
        return d / 2
    s = x - forward
    square, cube = 3 * d / (2 * c**2) - np.tan(theta) / c, d / c**3 - np.tan(theta) / c**2
    return d / 2 - square * s**2 + cube * s**3


def test_profile_of_the_thesis() -> None:
    hull = REMUS.meridian()
    assert hull.radius == pytest.approx([prestero(-x) for x in hull.x], rel=1e-9)
    start = (0.0, 0.1745, 0.8285)
    volume = sum(quad(lambda x: np.pi * prestero(x) ** 2, lo, hi)[0] for lo, hi in zip(start, (*start[1:], 1.3327)))
    assert hull.volume == pytest.approx(volume, rel=1e-10)
    assert hull.length == pytest.approx(1.33, abs=5e-3)
    assert REMUS.joints[2] == pytest.approx(0.828, abs=1e-3)


def test_figures_of_the_thesis() -> None:
    """Table 2.7. Its frontal area, 2.85e-2 m^2, is that of 7.5 in; with it the rest falls into place."""
    assert np.pi / 4.0 * 0.1905**2 == pytest.approx(2.85e-2, abs=5e-5)
    stated, meant = REMUS.meridian(), replace(REMUS, diameter=0.1905).meridian()
    assert stated.volume == pytest.approx(3.15e-2, rel=6e-3)
    assert meant.volume == pytest.approx(3.15e-2, abs=5e-5)
    projected = 2.0 * float(meant.weight @ meant.radius)
    assert projected == pytest.approx(2.26e-1, abs=5e-4)
    assert np.pi * projected == pytest.approx(7.09e-1, abs=1e-3)
    assert stated.centre_of_volume[0] == pytest.approx(-0.611 + 5.54e-3, abs=5e-4)


def test_shipped_body() -> None:
    body = read_body(BODY)
    ours, printed = body.require("by_equations"), body.require("as_printed")
    assert isinstance(body.shape, Revolution)
    assert ours.volume / printed.volume == pytest.approx(1.0049, abs=1e-4)
    assert ours.centre_of_buoyancy == pytest.approx(printed.centre_of_buoyancy, abs=5e-4)
    assert body.require("as_measured").volume == pytest.approx(306.0 / 1030.0 / 9.81, rel=1e-3)
    ends = np.pi * (prestero(0.0) ** 2 + prestero(1.3327) ** 2)
    assert ours.wetted_surface == pytest.approx(body.shape.integrals.wetted_surface + ends, rel=1e-9)


@pytest.mark.slow
def test_added_mass_by_sections_and_by_an_ellipsoid() -> None:
    found = {r.method: r.matrix for r in added_masses(read_body(BODY), 1000.0).results}
    mass = 1000.0 * REMUS.meridian().volume
    assert found["strip"][1, 1] == pytest.approx(mass, rel=1e-9)
    assert 0.9 * mass < found["ellipsoid"][1, 1] < mass


def test_mesh_has_the_flat_ends() -> None:
    hull = REMUS.meridian()
    mesh = meshed(hull, 8000)
    assert is_closed(mesh.faces)
    assert -8e-3 < mesh.discretisation_error < 0.0
    assert mesh.extents[0] == pytest.approx(hull.length, rel=1e-12)
    for end, radius in ((0.0, prestero(0.0)), (-1.3327, prestero(1.3327))):
        ring = mesh.vertices[np.abs(mesh.vertices[:, 0] - end) < 1e-9]
        assert np.max(np.hypot(ring[:, 1], ring[:, 2])) == pytest.approx(radius, rel=1e-6)
    assert mesh.integrals.area == pytest.approx(hull.integrals.wetted_surface + REMUS.flat_ends, rel=5e-3)


def test_half_an_ellipse_and_a_cubic() -> None:
    """n = 2 gives half a spheroid, 2/3 of its cylinder; theta = 0 the tail (1 - u)^2 (1 + 2u)."""
    hull = Myring(0.5, 0.0, 1.0, 0.4, 2.0, 0.0).meridian()
    tail = quad(lambda u: ((1.0 - u) ** 2 * (1.0 + 2.0 * u)) ** 2, 0.0, 1.0)[0]
    assert hull.volume == pytest.approx(np.pi * 0.04 * (0.5 * 2.0 / 3.0 + tail), rel=1e-12)


@given(
    exponent=st.floats(0.5, 5.0),
    steepness=st.floats(0.0, 1.0),
    middle=st.floats(0.0, 3.0),
    cut=st.floats(0.0, 0.5),
)
def test_every_hull_is_whole(exponent: float, steepness: float, middle: float, cut: float) -> None:
    angle = float(np.arctan(1.5 * 0.3 / 0.8)) * steepness
    form = Myring(0.4, middle, 0.8, 0.3, exponent, angle, 0.4 * cut, 0.8 * cut)
    hull = form.meridian()
    assert np.all(hull.radius <= 0.15 + 1e-12)
    assert np.all(np.isfinite(hull.radius_slope))
    assert 0.0 < hull.volume < np.pi / 4.0 * 0.3**2 * hull.length
    x, radius = dense_meridian(hull)
    assert x[-1] == pytest.approx(0.0, abs=1e-9)
    assert x[0] == pytest.approx(-hull.length, rel=1e-9)
    assert np.all(radius <= 0.15 + 1e-6)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("nose = 0.191", "nose = 0.0", ['"hull.nose"', "a length above zero"]),
        ("nose = 0.191", 'nose = "19.1"', ['"hull.nose"', "m"]),
        ("middle = 0.654", "middle = -0.1", ['"hull.middle"', "zero or more"]),
        ("diameter = 0.191\nexponent", "diameter = -1.0\nexponent", ['"hull.diameter"', "above zero"]),
        ("nose_offset = 0.0165", "nose_offset = 0.2", ['"hull.nose_offset"', "less than 0.191 m"]),
        ("tail_offset = 0.0368", "tail_offset = -0.1", ['"hull.tail_offset"', "zero or more"]),
        ("exponent = 2.0", "exponent = 9.0", ['"hull.exponent"', "from 0.5 to 5"]),
        (
            'tail_angle = "0.436 rad"',
            'tail_angle = "-0.1 rad"',
            ['"hull.tail_angle"', "a negative radius", "0 to 27.9"],
        ),
        (
            'tail_angle = "0.436 rad"',
            'tail_angle = "40 deg"',
            ['"hull.tail_angle"', "40 deg", "swells beyond the diameter"],
        ),
        ('tail_angle = "0.436 rad"', "tail_angle = 25", ['"hull.tail_angle"', 'Write "25 deg"']),
        ("tail = 0.541\n", "", ['"hull.tail"', "nothing"]),
        ("[hull]", "[hulk]", ['"hull"', "a table"]),
    ],
)
def test_files_that_cannot_be(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    text = BODY.read_text()
    assert old in text
    (tmp_path / "body.toml").write_text(text.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_body(tmp_path / "body.toml")
    for words in said:
        assert words in str(caught.value)
