"""Two vehicles side by side: what has no U95, no datum in common or no plane gets none."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.behaviour import Behaviour, behaviour
from coeflab.vehicle.own_numbers import typed_file
from coeflab.vehicle.parameter_file import ParameterFile

SPEED = 1.5
ADDED = ("Yvdot'=-.01", "Nrdot'=-.0005")
HORIZONTAL = ("Yv'=-.05 +- .004", "Nv'=-.01 +- .002", "Yr'=.01 +- .001", "Nr'=-.006 +- .001")


def file(*numbers: str, about: str = "cg", mass: str = "46 kg") -> ParameterFile:
    at = {"cg": "0,0,0"} if about != "cg" else {}
    return typed_file(
        "auv", numbers, length="2 m", length_name="LOA", speed="1.5 m/s", density="1025", about=about, mass=mass,
        inertia="1,10,10", **at,
    )  # fmt: skip


def figures(a: ParameterFile, b: ParameterFile) -> dict[str, Behaviour]:
    return {r.name: r for r in behaviour(a, b, SPEED)}


def test_no_u95_where_a_coefficient_without_one_moves_the_force() -> None:
    a, b = (file("Yv'=-.03 +- .003", f"Yv|v|'={y}", "Nv'=-.01 +- .001") for y in (-0.2, -0.3))
    found = figures(a, b)
    side = found["Y over v/U"]
    assert side.combined is None
    assert side.ratio is None
    assert "no U95 of Yv|v|'" in side.reason
    turned = found["N over v/U"]
    # Both curves are alike: the first point stands, v = -U/4 at V = U sqrt(1 + 1/16).
    speed, drift = SPEED * np.sqrt(17.0 / 16.0), 0.25 * SPEED
    half = 0.5 * 1025.0 * 2.0**3 * 0.001 * speed * drift
    assert turned.combined == pytest.approx(np.hypot(half, half))
    assert "no U95" not in turned.reason


def test_indices_about_points_of_other_datums_have_no_difference() -> None:
    """Nor has the centre of gravity of two masses, which may be two points."""
    a, b = file(*HORIZONTAL), file(*HORIZONTAL, about="nose", mass="60 kg")
    found = figures(a, b)["G_h"]
    assert found.a is not None
    assert found.b is not None
    assert (found.difference, found.combined) == (None, None)
    assert "datums" in found.reason
    alike = figures(a, a)["G_h"]
    assert alike.difference == 0.0
    assert alike.combined is not None


def test_a_plane_that_a_file_knows_nothing_of_has_no_eigenvalues() -> None:
    found = figures(file(*HORIZONTAL, *ADDED), file(*HORIZONTAL[:2], *ADDED))
    for k in (1, 2):
        one = found[f"eigenvalue {k}, horizontal"]
        assert one.a is not None
        assert (one.b, one.difference) == (None, None)
        assert "no force by r" in one.reason
        other = found[f"eigenvalue {k}, vertical, no weight"]
        assert (other.a, other.b, other.difference) == (None, None, None)
        assert "no force by w" in other.reason


def test_without_added_mass_a_plane_has_no_eigenvalues() -> None:
    """Before: those of the rigid body alone, as in air, beside those of the other file."""
    found = figures(file(*HORIZONTAL, *ADDED), file(*HORIZONTAL))["eigenvalue 1, horizontal"]
    assert found.a is not None
    assert (found.b, found.difference) == (None, None)
    assert "no added mass" in found.reason
