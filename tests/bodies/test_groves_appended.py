"""SUBOFF with sail and planes: exact integrals, a mesh that says its error, and Roddy's figures beside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.added_mass import panel
from coeflab.bodies.added_masses import added_masses
from coeflab.bodies.mesh.decimation import is_closed
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.profiles import FOOT, suboff_meridian
from coeflab.bodies.readers import read_body
from coeflab.bodies.readers.groves import appended, mesh
from coeflab.bodies.shape import Revolution
from coeflab.core.errors import InputError
from coeflab.core.files import shipped

BODY = shipped("geometry") / "suboff_aff8" / "body.toml"


@pytest.fixture(scope="module")
def whole() -> TriangleMesh:
    shape = read_body(BODY).require_shape()
    assert isinstance(shape, TriangleMesh)
    return shape


def test_integrals_of_aff8() -> None:
    """Groves' equations integrated elsewhere: 0.7057 m^3, 6.352 m^2, 2.0095 m aft of the nose."""
    found = read_body(BODY).require("by_equations")
    assert found.volume == pytest.approx(0.7057, rel=3e-4)
    assert found.wetted_surface == pytest.approx(6.352, abs=1e-3)
    assert found.centre_of_buoyancy == pytest.approx([-2.0095, 0.0, -0.00217], abs=1e-4)


def test_bare_hull_is_as_it_was() -> None:
    hull, found = suboff_meridian(), appended(False, False)
    assert found.title == "integrals of the equations"
    assert found.volume == hull.volume
    assert found.wetted_surface == hull.integrals.wetted_surface
    assert np.array_equal(found.centre_of_buoyancy, hull.centre_of_volume)
    assert isinstance(read_body(BODY.parent.parent / "suboff_bare_hull" / "body.toml").shape, Revolution)


def test_beside_roddy() -> None:
    """What he prints differs from the equations by 5 and 7 % of the appendages' volume; shown, not tuned away.

    Ours over his: hull and sail +0.031 %, hull and planes -0.022 %.
    """
    printed = read_body(BODY)
    rows = (("hull_sail_as_printed", True, False, 3.1e-4), ("hull_planes_as_printed", False, True, -2.2e-4))
    for name, with_sail, with_planes, gap in rows:
        ours, his = appended(with_sail, with_planes), printed.require(name)
        assert ours.volume / his.volume - 1.0 == pytest.approx(gap, abs=1e-5)
        assert ours.centre_of_buoyancy == pytest.approx(his.centre_of_buoyancy, abs=6e-4)
    bare = suboff_meridian().volume
    sail, planes = (appended(*on).volume - bare for on in ((True, False), (False, True)))
    assert sail / FOOT**3 == pytest.approx(0.14954, abs=1e-5)
    assert planes / FOOT**3 == pytest.approx(0.08487, abs=1e-5)
    assert appended(True, True).volume == pytest.approx(bare + sail + planes, rel=1e-14)


def test_mesh_says_its_error(whole: TriangleMesh) -> None:
    exact = appended(True, True)
    assert is_closed(whole.faces)
    assert whole.exact_volume == exact.volume
    assert whole.discretisation_error == pytest.approx(whole.volume / exact.volume - 1.0)
    assert -1e-3 < whole.discretisation_error < 0.0
    assert whole.centre_of_volume == pytest.approx(exact.centre_of_buoyancy, abs=1e-4)
    assert whole.integrals.area == pytest.approx(exact.wetted_surface, rel=1e-3)


def test_sail_is_up_and_planes_are_aft(whole: TriangleMesh) -> None:
    top = whole.vertices[np.argmin(whole.vertices[:, 2])]
    assert top[2] == pytest.approx(-1.5625 * FOOT, abs=1e-5)
    assert -4.241319 * FOOT < top[0] < -3.032986 * FOOT
    aft = whole.vertices[whole.vertices[:, 0] < -12.5 * FOOT]
    for axis in (1, 2):
        assert np.max(aft[:, axis]) == pytest.approx(5.0 / 6.0 * FOOT, rel=1e-9)
        assert np.min(aft[:, axis]) == pytest.approx(-5.0 / 6.0 * FOOT, rel=1e-9)
    assert np.max(whole.vertices[:, 0]) == pytest.approx(0.0, abs=1e-12)
    assert np.min(whole.vertices[:, 0]) == pytest.approx(-14.291667 * FOOT)


def test_port_is_starboard_mirrored(whole: TriangleMesh) -> None:
    cross = whole.integrals.second_moments
    assert abs(whole.centre_of_volume[1]) < 1e-12
    assert np.max(np.abs(cross[1, [0, 2]])) < 1e-12 * cross[0, 0]


def test_error_falls_with_the_hull(whole: TriangleMesh) -> None:
    coarse = mesh(True, True, 15_000)
    assert coarse.discretisation_error / whole.discretisation_error == pytest.approx(4.0, rel=0.15)


def test_added_mass_of_an_ellipsoid_as_heavy() -> None:
    found = added_masses(read_body(BODY), 1000.0, "ellipsoid").results[0]
    assert found.matrix[1, 1] > found.matrix[2, 2] > 0.9 * 1000.0 * 0.7057
    assert found.matrix[1, 3] > 0.0


def test_remade_for_a_solver(whole: TriangleMesh) -> None:
    """From the equations at any count, so that its error falls as the square of the panels' size."""
    fine, coarse = meshed(whole, 20_000), meshed(whole, 5000)
    for made, asked in ((fine, 20_000), (coarse, 5000)):
        assert len(made.faces) == pytest.approx(asked, rel=0.1)
        assert is_closed(made.faces)
        assert made.exact_volume == whole.exact_volume
    steps = len(fine.faces) / len(coarse.faces)
    assert coarse.discretisation_error / fine.discretisation_error == pytest.approx(steps, rel=0.1)


@pytest.mark.slow
def test_panels_on_aff8_hold_those_of_four_times_as_many() -> None:
    """Reference: this method from 24,280, 5,732 and 1,504 panels, within 0.2 %; roll and surge within 2 %."""
    fine = np.array([27.152, 703.47, 663.27, 1.982, 634.84, 666.52])
    share = np.array([0.018, 0.002, 0.002, 0.017, 0.0018, 0.0018])
    body = read_body(BODY)
    found = panel.added_mass(body, 1000.0).about(body.require_shape().centre_of_volume)
    assert found.error is not None
    error = np.diag(found.error)
    assert np.all(np.abs(np.diag(found.matrix) - fine) <= error + share * fine)
    # Beside what was asked before the estimate carried it: twice the 0.04 % of volume that extrapolation leaves.
    assert np.all(error[[1, 2, 4, 5]] < (0.015 + 2.0 * 0.0005) * fine[[1, 2, 4, 5]])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("sail = true", "sial = true", ['"hull.sial"', "Did you mean hull.sail?"]),
        ("planes = true", 'planes = "yes"', ['"hull.planes"', "true or false"]),
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
