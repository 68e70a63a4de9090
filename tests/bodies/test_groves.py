"""The SUBOFF bare hull: integrals, continuity, offsets of another table, and its limits."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

from coeflab.bodies.profiles import CAP_END, FOOT, suboff_meridian, suboff_profile
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Revolution
from coeflab.core.files import shipped
from coeflab.vehicle.published_values import read_references

BODY = shipped("geometry") / "suboff_bare_hull" / "body.toml"
JOINTS = (3.333333, 10.645833, 13.979167)
# Station and B/Bmax: Roddy 1990, Table 2. Its last station, 20.4167, is the tail at 14.2917 ft: 0.7 ft a station.
STATION = 14.2917 / 20.4167
OFFSETS = [
    (0.1, 0.29058), (0.5, 0.56627), (1.0, 0.70744), (2.0, 0.84713), (3.0, 0.94066), (4.0, 0.99282), (10.0, 1.0),
    (16.0, 0.97598), (17.0, 0.81910), (18.0, 0.55025), (19.0, 0.26835), (20.0, 0.11724), (20.2, 0.10074),
    (20.4, 0.03178),
]  # fmt: skip


def suboff_radius(aft: float) -> float:
    """Radius of the bare hull, m."""
    return float(FOOT * suboff_profile(np.array([aft / FOOT]))[0][0])


@pytest.mark.parametrize(("station", "share"), OFFSETS)
def test_offsets_of_roddy(station: float, share: float) -> None:
    assert suboff_radius(station * STATION * FOOT) / (5.0 / 6.0 * FOOT) == pytest.approx(share, abs=4e-5)


@pytest.mark.parametrize("joint", JOINTS)
def test_pieces_meet(joint: float) -> None:
    before, after = suboff_radius((joint - 1e-9) * FOOT), suboff_radius((joint + 1e-9) * FOOT)
    assert before == pytest.approx(after, abs=1e-6)


def test_ends_close() -> None:
    assert suboff_radius(0.0) == pytest.approx(0.0, abs=1e-12)
    assert suboff_radius(CAP_END * FOOT) == pytest.approx(0.0, abs=1e-9)


def test_integrals_against_adaptive_quadrature() -> None:
    joints = (0.0, *JOINTS, CAP_END)
    pieces = [
        quad(lambda x, n=n: (x * FOOT) ** n * np.pi * suboff_radius(x * FOOT) ** 2 * FOOT, a, b, epsrel=1e-11, limit=300)[0]
        for n in (0, 1) for a, b in pairwise(joints)
    ]  # fmt: skip
    volume, moment = sum(pieces[:4]), sum(pieces[4:])
    hull = suboff_meridian()
    assert hull.volume == pytest.approx(volume, rel=1e-10)
    assert hull.centre_of_volume[0] == pytest.approx(-moment / volume, rel=1e-10)


def test_converged() -> None:
    once, twice = suboff_meridian().integrals, suboff_meridian(192).integrals
    assert once.volume == pytest.approx(twice.volume, rel=1e-11)
    assert once.wetted_surface == pytest.approx(twice.wetted_surface, rel=1e-10)


def test_slope_belongs_to_the_radius() -> None:
    """Central differences of the radius, at stations that are not about to change piece."""
    hull, h = suboff_meridian(24), 1e-5
    joints = np.array([0.0, *JOINTS, CAP_END]) * FOOT
    inside = [k for k, x in enumerate(hull.x) if np.min(np.abs(-x - joints)) > 0.005]
    assert len(inside) > 20
    for k in inside:
        x = hull.x[k]
        difference = (suboff_radius(-(x + h)) ** 2 - suboff_radius(-(x - h)) ** 2) / (4.0 * h)
        assert hull.radius[k] == pytest.approx(suboff_radius(-x), rel=1e-8)
        assert hull.radius_slope[k] == pytest.approx(difference, rel=1e-4, abs=1e-9)


def test_both_readings_are_there() -> None:
    body = read_body(BODY)
    assert isinstance(body.shape, Revolution)
    ours, printed = body.require("by_equations"), body.require("as_printed")
    assert ours.volume == pytest.approx(24.692 * FOOT**3, rel=5e-4)
    assert ours.volume == pytest.approx(0.69919, abs=5e-5)
    assert ours.centre_of_buoyancy[0] == pytest.approx(-2.0086, abs=1e-4)
    assert ours.centre_of_buoyancy[0] == pytest.approx(-6.59003 * FOOT, abs=1e-3)
    assert ours.wetted_surface == pytest.approx(5.988, abs=1e-3)
    assert printed.wetted_surface == pytest.approx(63.717 * FOOT**2)
    assert ours.wetted_surface / printed.wetted_surface == pytest.approx(1.0116, abs=5e-4)


def test_measured_values_keep_their_illegible_digit() -> None:
    found = {m.symbol: m for m in read_body(BODY).measured}
    assert found["Yvdot"].bounds == (-0.013270, -0.013279)
    assert found["Nrdot"].bounds == (-0.000676, -0.000676)
    published = read_references(shipped("cfd_data") / "suboff" / "published.toml")
    (rows,) = [
        k.values
        for r in published
        if r.name == "Roddy configuration 3"
        for k in r.literature
        if k.kind == "acceleration"
    ]
    assert {m.symbol: m.printed for m in found.values()} == {v.symbol: v.printed for v in rows}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"-0.01327?"', '"-0.013.7"', ['"measured[0].values.Yvdot"', 'ending in "?"']),
        ("Yvdot =", "Yv =", ['"measured[0].values.Yv"', "an acceleration derivative"]),
        ('[prime]\nlength = "13.9792 ft"\nlength_name = "LBP"', "", ['"measured"', "without a length"]),
        ('reader = "groves"', 'reader = "grooves"', ["grooves", "did you mean groves"]),
        ('datum = "nose', 'dtaum = "nose', ['"body.datum"', "found nothing"]),
    ],
)
def test_files_that_cannot_be(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    text = BODY.read_text()
    assert old in text
    (tmp_path / "body.toml").write_text(text.replace(old, new))
    with pytest.raises(Exception, match=r"expected|did you mean") as caught:
        read_body(tmp_path / "body.toml")
    for words in said:
        assert words in str(caught.value)
