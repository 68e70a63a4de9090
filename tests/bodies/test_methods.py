"""The three methods on bodies whose answer is known, and on SUBOFF beside the measurement."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.added_mass import ADDED_MASS, ellipsoid, primitives, strip
from coeflab.bodies.added_masses import added_masses, methods
from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.closed_forms.parts import plate_coefficient
from coeflab.bodies.readers import read_body
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, PluginError
from coeflab.core.files import shipped
from coeflab.law.added_mass import AddedMass
from coeflab.law.scaling import Scaling
from coeflab.report.tables.added_mass import derivatives

RHO = 1000.0
BODIES = ("suboff_bare_hull", "spheroid_example", "huuv")


def shipped_body(name: str) -> Body:
    return read_body(shipped("geometry") / name / "body.toml")


def body(folder: Path, parts: str, point: str = "[0.0, 0.0, 0.0]") -> Body:
    (folder / "body.toml").write_text(
        f'[body]\nname = "b"\nreader = "primitives"\ndatum = "d"\nreference_point = {point}\n'
        f'[source]\ncitation = "synthetic"\n{parts}'
    )
    return read_body(folder / "body.toml")


@pytest.mark.parametrize("name", BODIES)
def test_every_method_gives_a_kinetic_energy(name: str) -> None:
    found = added_masses(shipped_body(name), RHO)
    assert found.results
    for result in found.results:
        assert result.definiteness.holds
        assert result.verdict == "symmetric, positive semidefinite"
        assert np.max(np.abs(result.matrix - result.matrix.T)) == 0.0


def test_methods_agree_on_a_spheroid() -> None:
    exact = ellipsoid_added_mass(np.array([1.5, 0.25, 0.25]), RHO)
    results = {r.method: r.matrix for r in added_masses(shipped_body("spheroid_example"), RHO).results}
    assert set(results) == {"ellipsoid", "primitives", "primitives:huuv", "panel", "strip", "strip:lamb"}
    for name in set(results) - {"panel", "strip"}:
        assert results[name] == pytest.approx(exact, rel=1e-10, abs=1e-9)
    assert np.diag(results["panel"]) == pytest.approx(np.diag(exact), rel=1e-3)
    assert results["strip"][1, 1] == pytest.approx(RHO * 4.0 / 3.0 * np.pi * 1.5 * 0.0625, rel=1e-10)


def test_a_turned_ellipsoid_off_the_point_is_exact(tmp_path: Path) -> None:
    """Yawed by 90 deg: the entries of x and y change places; then the parallel axes."""
    parts = (
        '[[part]]\nname = "p"\nform = "ellipsoid"\nsemi_axis_x = 3\nsemi_axis_y = 2\nsemi_axis_z = 1\n'
        'centre = [4.0, 0.0, 0.0]\nrotation = [0, 0, "90 deg"]'
    )
    own = np.diag(ellipsoid_added_mass(np.array([3.0, 2.0, 1.0]), RHO))
    for method in (ellipsoid, primitives):
        found = method.added_mass(body(tmp_path, parts, "[1.0, 0.0, 0.0]"), RHO).matrix
        assert np.diag(found)[:3] == pytest.approx(own[[1, 0, 2]], rel=1e-12)
        assert found[3, 3] == pytest.approx(own[4], rel=1e-12)
        assert found[4, 4] == pytest.approx(own[3] + 9.0 * own[2], rel=1e-12)
        assert found[5, 5] == pytest.approx(own[5] + 9.0 * own[0], rel=1e-12)
        assert found[1, 5] == pytest.approx(3.0 * own[0], rel=1e-12)
        assert found[2, 4] == pytest.approx(-3.0 * own[2], rel=1e-12)


def test_equivalent_ellipsoid_of_suboff() -> None:
    result = ellipsoid.added_mass(shipped_body("suboff_bare_hull"), RHO)
    volume, length = shipped_body("suboff_bare_hull").require_shape().volume, 14.291667 * 0.3048
    b = np.sqrt(3.0 * volume / (2.0 * np.pi * length))
    exact = ellipsoid_added_mass(np.array([length / 2.0, b, b]), RHO)
    assert np.diag(result.matrix)[:3] == pytest.approx(np.diag(exact)[:3], rel=1e-12)


def test_huuv_equations_as_corrected() -> None:
    """Equations 28-32 written out for hull, mast and two elevators about the middle of the hull."""
    rh, lh, rm, lm, xm, c, b, xe, ye = 0.07, 1.2, 0.02, 0.3, 0.1, 0.12, 0.24, -0.5, 0.19
    hull, mast = RHO * np.pi * rh**2 * lh, RHO * np.pi * rm**2 * lm
    plate = plate_coefficient(b / c) * np.pi / 4.0 * RHO * c**2 * b
    found = primitives.added_mass(shipped_body("huuv"), RHO, primitives.presets["huuv"]).matrix
    mast_cubed = RHO * np.pi * rm**2 * ((rh + lm) ** 3 - rh**3) / 3.0
    zm = -(rh + lm / 2.0)
    assert found[0, 0] == pytest.approx(0.1 * hull + mast, rel=1e-12)
    assert found[1, 1] == pytest.approx(hull + mast, rel=1e-12)
    assert found[2, 2] == pytest.approx(hull + 0.1 * mast + 2.0 * plate, rel=1e-12)
    own = found[3, 3] - mast_cubed - 2.0 * plate * ye**2
    disc = ellipsoid_added_mass(np.array([c, b, 0.0]) / np.sqrt(np.pi), RHO)
    assert own == pytest.approx(2.0 * disc[3, 3], rel=1e-9)
    pitch = hull * lh**2 / 12.0 + mast_cubed + 0.1 * mast * xm**2 + 2.0 * (plate * xe**2 + disc[4, 4])
    assert found[4, 4] == pytest.approx(pitch, rel=1e-12)
    assert found[5, 5] == pytest.approx(hull * lh**2 / 12.0 + mast * xm**2, rel=1e-12)
    assert found[0, 4] == pytest.approx(mast * zm, rel=1e-12)
    assert found[1, 3] == pytest.approx(-mast * zm, rel=1e-12)
    assert found[1, 5] == pytest.approx(mast * xm, rel=1e-12)
    assert found[2, 4] == pytest.approx(-(0.1 * mast * xm + 2.0 * plate * xe), rel=1e-12)
    assert found[3, 5] == pytest.approx(-mast * xm * zm, rel=1e-12)


def test_symmetry_of_the_huuv_shows_in_its_zeros() -> None:
    """Port-starboard symmetry: u, w, q never couple to v, p, r."""
    found = primitives.added_mass(shipped_body("huuv"), RHO).matrix
    assert np.max(np.abs(found[np.ix_([0, 2, 4], [1, 3, 5])])) < 1e-14


def test_suboff_beside_roddy_is_not_tuned() -> None:
    """Lamb-corrected Yvdot' about -0.0172 and strip -0.0181 against a measured -0.0133: 28 to 37 per cent above."""
    hull = shipped_body("suboff_bare_hull")
    lbp = hull.scaling
    assert lbp == Scaling(13.9792 * 0.3048, "LBP")
    results = {r.method: r for r in added_masses(hull, RHO).results}
    assert results["strip"].primed("Yvdot", lbp, RHO) == pytest.approx(-0.0181, abs=5e-5)
    assert results["strip:lamb"].primed("Yvdot", lbp, RHO) == pytest.approx(-0.0171, abs=5e-5)
    measured = {m.symbol: m.bounds for m in hull.measured}
    for name, low, high in (("ellipsoid", 1.28, 1.29), ("strip", 1.36, 1.37)):
        assert low < results[name].primed("Yvdot", lbp, RHO) / measured["Yvdot"][0] < high
    assert results["strip:lamb"].primed("Nrdot", lbp, RHO) / measured["Nrdot"][0] == pytest.approx(1.30, abs=0.01)
    volume = hull.require_shape().volume
    assert results["strip"].primed("Yvdot", lbp, RHO) == pytest.approx(-volume / (0.5 * lbp.length**3), rel=1e-12)


def test_primes_do_not_depend_on_density() -> None:
    hull = shipped_body("suboff_bare_hull")
    one, two = (strip.added_mass(hull, rho) for rho in (998.0, 1025.0))
    for symbol in ("Yvdot", "Yrdot", "Nrdot", "Nvdot"):
        assert one.primed(symbol, Scaling(4.0, "L"), 998.0) == pytest.approx(
            two.primed(symbol, Scaling(4.0, "L"), 1025.0), rel=1e-12
        )


def test_primes_by_hand() -> None:
    mass = AddedMass(np.diag([1.0, 2, 3, 4, 5, 6]), np.zeros(3), Datum("d"), "b", "m")
    assert mass.primed("Yvdot", Scaling(2.0, "L"), 1000.0) == pytest.approx(-2.0 / (500.0 * 8.0))
    assert mass.primed("Nrdot", Scaling(2.0, "L"), 1000.0) == pytest.approx(-6.0 / (500.0 * 32.0))


def test_about_another_point() -> None:
    result = primitives.added_mass(shipped_body("huuv"), RHO)
    there = result.about(np.array([1.0, -2.0, 0.5]))
    assert there.about(result.reference_point).matrix == pytest.approx(result.matrix, abs=1e-11)
    assert there.matrix[5, 5] > result.matrix[5, 5]


def test_a_matrix_that_is_no_kinetic_energy_says_so() -> None:
    for matrix in (-np.eye(6), np.eye(6) + 2.0 * np.eye(6, k=1) + 2.0 * np.eye(6, k=-1)):
        assert "do not use it" in AddedMass(matrix, np.zeros(3), Datum("d"), "b", "m").verdict


def test_statements_name_what_is_estimated(tmp_path: Path) -> None:
    parts = (
        '[[part]]\nname = "slat"\nform = "plate"\nchord = 0.1\nspan = 2\ncentre = [0, 0, 0]\n'
        '[[part]]\nname = "puck"\nform = "cylinder"\nradius = 1\nlength = 1\ncentre = [0, 0, 0]\n'
        '[[part]]\nname = "box"\nform = "box"\nlength = 1\nwidth = 1\nheight = 1\ncentre = [0, 0, 0]\n'
    )
    said = " ".join(primitives.added_mass(body(tmp_path, parts), RHO).statements)
    for words in (
        "slat: aspect 20",
        "flat ends by our panel method",
        "tabulated at 36 proportions",
        "doublet lattice",
    ):
        assert words in said
    ends = " ".join(primitives.added_mass(body(tmp_path, parts), RHO, {"cylinder_ends": "huuv"}).statements)
    assert "puck: shorter than its diameter" in ends


def test_methods_that_do_not_apply() -> None:
    suboff, huuv = shipped_body("suboff_bare_hull"), shipped_body("huuv")
    with pytest.raises(InputError, match="which has no parts"):
        primitives.added_mass(suboff, RHO)
    with pytest.raises(InputError, match="no body of revolution about x"):
        strip.added_mass(huuv, RHO)
    assert set(added_masses(suboff, RHO).refused) == {"primitives"}
    for name in ADDED_MASS.names():
        with pytest.raises(InputError, match="without a shape"):
            ADDED_MASS.load(name).added_mass(shipped_body("suboff"), RHO)


def test_plates_alone_have_no_ellipsoid(tmp_path: Path) -> None:
    plate = '[[part]]\nname = "p"\nform = "plate"\nchord = 1\nspan = 1\ncentre = [0, 0, 0]'
    found = added_masses(body(tmp_path, plate), RHO)
    assert "displace nothing" in found.refused["ellipsoid"]
    by = {r.method: r.matrix[2, 2] for r in found.results}
    assert by["primitives"] == pytest.approx(0.579 * np.pi / 4.0 * RHO)
    assert by["panel"] == pytest.approx(by["primitives"], rel=5e-3)
    assert found.recommended.method == "panel"
    assert derivatives(found).rows


@pytest.mark.parametrize("density", [0.0, -1.0, np.nan, np.inf])
def test_densities_that_cannot_be(density: float) -> None:
    with pytest.raises(InputError, match="a density of"):
        added_masses(shipped_body("huuv"), density)


def test_names_of_methods() -> None:
    assert {"ellipsoid", "primitives", "strip", "strip:lamb"} <= set(methods())
    with pytest.raises(PluginError, match="did you mean strip"):
        added_masses(shipped_body("spheroid_example"), RHO, "stripe")
    with pytest.raises(InputError, match='unknown preset "lam" of strip'):
        added_masses(shipped_body("spheroid_example"), RHO, "strip:lam")
    with pytest.raises(InputError, match="one of none, lamb"):
        strip.added_mass(shipped_body("spheroid_example"), RHO, {"end_correction": "lam"})
