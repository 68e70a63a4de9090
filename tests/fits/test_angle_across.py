"""A sweep of one angle at another of the other plane: its slopes, with that word."""

from __future__ import annotations

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.fits.rows.sweeps import ACROSS_AT
from coeflab.tables.force_table import ForceTable

KEYS = {"frame": "FRD", "length": 2.0, "density": 1000, "speed": 2.0, "about": "nose, 1.0 m aft"}
UNIT = 0.5 * 1000 * 2.0**2 * 2.0**2
ANGLES = np.arange(-8.0, 8.1, 2.0)


def swept(alpha: np.ndarray, beta: np.ndarray, name: str = "pitch") -> ForceTable:
    a, b = np.radians(alpha), np.radians(beta)
    v, w = np.sin(b), np.sin(a) * np.cos(b)
    forces = {
        "Y [N]": -0.04 * v, "Z [N]": -0.03 * w * (1.0 + 2.0 * v * v), "M [N m]": 0.02 * w, "X [N]": -0.002 - 0.01 * v * v,
    }  # fmt: skip
    return cf.read_table(
        {"alpha [deg]": alpha, "beta [deg]": beta, **{k: f * UNIT * (2.0 if k[0] == "M" else 1.0) for k, f in forces.items()}},
        name=name, alpha="w = +U sin(alpha)", beta="v = +U sin(beta)", **KEYS,
    )  # fmt: skip


def test_alpha_at_one_drift_angle_gives_zw_there_with_a_warning() -> None:
    result = cf.fit(swept(ANGLES, np.full(9, 4.0)))
    assert set(result.symbols) == {"Zw'", "Mw'"}  # X0' of these rows is that at drift
    assert result["Zw'"].value == pytest.approx(-0.03 * (1.0 + 2.0 * np.sin(np.radians(4.0)) ** 2), rel=1e-6)
    assert result["Mw'"].value == pytest.approx(0.02, rel=1e-6)
    assert result["Zw'"].estimator.endswith("at beta = 4 deg")
    (found,) = [f for f in result.fits[0].findings if f.code == ACROSS_AT]
    assert (found["at"], found["symbols"]) == ("beta = 4 deg", ("Zw'", "Mw'"))
    assert any(c.finding == found for c in result.checks)


def test_drift_at_one_angle_of_attack_gives_yv_there() -> None:
    result = cf.fit(swept(np.full(9, -3.0), ANGLES))
    assert result["Yv'"].value == pytest.approx(-0.04, rel=1e-6)
    assert result["Yv'"].estimator.endswith("at alpha = -3 deg")


def test_rows_at_rest_across_come_first() -> None:
    """Nine rows at drift, five at none: the five give Zw'."""
    own = swept(np.arange(-8.0, 8.1, 4.0), np.zeros(5), "rest")
    both = [swept(ANGLES, np.full(9, 4.0)), own]
    found = cf.fit([cf.read_table(t) if isinstance(t, str) else t for t in both]).of("rest")["Zw'"]
    assert found.value == pytest.approx(-0.03, rel=1e-6)


def test_two_drift_angles_are_refused_as_before() -> None:
    with pytest.raises(InputError, match="combine motions"):
        cf.fit(swept(np.tile([-4.0, 4.0], 5), np.repeat([2.0, 3.0, 4.0, 5.0, 6.0], 2)))
