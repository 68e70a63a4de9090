"""SUBOFF's particulars as Roddy prints them, other units, and body files that cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.bodies.body_file import mass_from_primes
from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Scaling

SUBOFF = shipped("geometry") / "suboff" / "body.toml"
FOOT, POUND = 0.3048, 0.45359237
SYNTHETIC = """[body]
name = "b"
datum = "nose"
reference_point = [-1.0, 0.0, 0.0]

[source]
citation = "synthetic"

[[configuration]]
name = "bare"
mass = "100 lb"
centre_of_gravity_forward = "1 ft"
inertia = 12.0
"""


def test_suboff() -> None:
    body = read_body(SUBOFF)
    assert body.reference_point[0] == pytest.approx(-6.6042 * FOOT)
    assert body.lengths["length_between_perpendiculars"] == pytest.approx(4.26086, abs=5e-6)
    assert body.lengths["length_overall"] == pytest.approx(4.356, abs=5e-4)
    assert [c.name for c in body.configurations][:2] == ["suboff_fully_appended", "suboff_bare_hull"]
    full = body.require("suboff_fully_appended")
    assert full.volume == pytest.approx(24.98991 * FOOT**3)
    assert full.volume == pytest.approx(0.7076, abs=5e-5)
    assert list(full.centre_of_buoyancy) == pytest.approx([-6.613906 * FOOT, 0.0, -0.006669 * FOOT])


def test_mass_of_suboff_is_its_displacement() -> None:
    """Neutrally buoyant: m' from Roddy's buoyancy 1556.2363 lb, xG' m' from xG = xB."""
    body = read_body(SUBOFF)
    lbp, density = Scaling(13.9792 * FOOT, "LBP"), 62.27456 * POUND / FOOT**3
    for configuration in body.configurations:
        mass, volume, centre = configuration.mass, configuration.volume, configuration.centre_of_buoyancy
        assert mass.mass == pytest.approx(density * volume, rel=2e-4)
        forward = centre[0] - body.reference_point[0]
        if configuration.name == "suboff_bare_hull":
            # As printed, its xG' m' and its centre of buoyancy are 4.8 mm apart; the other four agree.
            assert mass.mass_moment / mass.mass - forward == pytest.approx(0.00484, abs=3e-5)
        else:
            assert mass.mass_moment / mass.mass == pytest.approx(forward, abs=3e-5)
    full = body.require("suboff_fully_appended").mass
    assert full.mass == pytest.approx(1556.2363 * POUND, rel=1e-4)
    made = full.primed(lbp, density)
    assert (made.mass_prime, made.mass_moment_prime) == pytest.approx((0.018296, -0.127467e-4), rel=1e-12)


def test_primes_by_hand() -> None:
    mass = mass_from_primes(0.02, -1e-5, 1e-3, Scaling(2.0, "L"), 1000.0)
    assert (mass.mass, mass.mass_moment, mass.inertia) == pytest.approx((80.0, -0.08, 16.0))
    back = MassProperties(80.0, -0.08).primed(Scaling(2.0, "L"), 1000.0)
    assert (back.mass_prime, back.mass_moment_prime) == pytest.approx((0.02, -1e-5))


def test_dimensional_mass(tmp_path: Path) -> None:
    (tmp_path / "body.toml").write_text(SYNTHETIC)
    mass = read_body(tmp_path / "body.toml").require("bare").mass
    assert mass.mass == pytest.approx(45.359237)
    assert mass.mass_moment == pytest.approx(45.359237 * FOOT)
    assert mass.inertia == 12.0


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('mass = "100 lb"', 'mass = "100 lbf"', ['"configuration[0].mass"', "a unit of mass"]),
        ('mass = "100 lb"', "mass = -1", ['"configuration[0].mass"', "above zero"]),
        ("inertia = 12.0", "inertia = 0", ['"configuration[0].inertia"', "above zero"]),
        ("inertia = 12.0", "inertai = 12.0", ["configuration[0].inertai", "Did you mean configuration[0].inertia?"]),
        ('name = "bare"\n', "", ['"configuration[0].name"', "found nothing"]),
        ("[-1.0, 0.0, 0.0]", "[-1.0]", ['"body.reference_point"', "a point [x, y, z]"]),
        ("inertia = 12.0", "mass_prime = 0.02", ['"prime.length"', "found nothing"]),
        ("[source]", "[sauce]", ['"source"', "found nothing"]),
        (
            "[source]",
            '[prime]\nlength = 2.0\nlength_name = "LOA"\n\n[source]',
            ['"prime"', "mass_prime", "Delete [prime]."],
        ),
        (
            'citation = "synthetic"',
            'citation = "c"\nkind = "drawn"',
            ['"source.kind"', 'found "drawn"', '"cfd" or', '"computed"'],
        ),
    ],
)
def test_bodies_that_cannot_be(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    assert old in SYNTHETIC
    (tmp_path / "body.toml").write_text(SYNTHETIC.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_body(tmp_path / "body.toml")
    assert "body.toml" in str(caught.value)
    for text in said:
        assert text in str(caught.value)


def test_unknown_configuration() -> None:
    with pytest.raises(InputError, match=r'no configuration "x" of suboff; expected one of suboff_fully_appended'):
        read_body(SUBOFF).require("x")


FULL = SYNTHETIC.replace(
    'centre_of_gravity_forward = "1 ft"\ninertia = 12.0\n',
    """centre_of_gravity = [-0.9, 0.0, 0.02]
inertia_matrix = [[0.9, 0.0, "-0.1 kg*m^2"], [0.0, 12.0, 0.0], [-0.1, 0.0, 12.5]]
""",
)


def test_centre_of_gravity_and_inertia_about_it(tmp_path: Path) -> None:
    (tmp_path / "body.toml").write_text(FULL)
    mass = read_body(tmp_path / "body.toml").configurations[0].mass
    kilograms = 100.0 * POUND
    assert mass.mass_moment == pytest.approx(0.1 * kilograms)
    assert list(mass.centre) == pytest.approx([0.1, 0.0, 0.02])
    assert mass.inertia_matrix[0, 0] == pytest.approx(0.9 + 0.02**2 * kilograms)
    assert mass.inertia_matrix[2, 2] == pytest.approx(12.5 + 0.1**2 * kilograms)
    assert mass.inertia_matrix[0, 2] == pytest.approx(-0.1 - 0.1 * 0.02 * kilograms)
    assert mass.inertia is None


@pytest.mark.parametrize(
    ("found", "instead", "said"),
    [
        ("inertia_matrix = [[0.9,", "inertia_matrix = [[0.3,", "larger than the others"),
        ("[-0.1, 0.0, 12.5]", "[0.1, 0.0, 12.5]", "not symmetric"),
        ("[-0.1, 0.0, 12.5]", "[-0.1, 0.0]", "three rows"),
        ("inertia_matrix", "inertia = 3.0\ninertia_matrix", "both"),
        ('"-0.1 kg*m^2"', '"-0.1 kg*m"', "inertia"),
    ],
)
def test_inertia_that_cannot_be(tmp_path: Path, found: str, instead: str, said: str) -> None:
    (tmp_path / "body.toml").write_text(FULL.replace(found, instead))
    with pytest.raises(InputError, match=said):
        read_body(tmp_path / "body.toml")
