"""Planted constants come back from speeds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.glider.steady_glide import Polar, glide
from coeflab.published.thauv.pitch_balance import GlideSpeed, calibrated, incidence_at, speed_of

PLANTED = np.array([150.0, 5.0, 2.0, 3.5])
POLARS = [Polar((l0, l1), (11.0, d2), (m0, m1)) for l0, l1, d2, m0, m1 in (
    (-2.0, 540.0, 700.0, 1.0, -80.0), (-1.8, 560.0, 800.0, 0.4, -140.0), (-1.2, 460.0, 670.0, 0.1, -165.0),
)]  # fmt: skip


def _glides() -> list[GlideSpeed]:
    near = [GlideSpeed(p, w, s, 0.4) for s, w in enumerate((4.74, 7.9)) for p in POLARS]
    return [replace(k, speed=speed_of(k, PLANTED)) for k in near]


def test_planted_constants_come_back() -> None:
    assert calibrated(_glides()) == pytest.approx(PLANTED, rel=1e-6)


def test_a_known_munk_mass_is_kept() -> None:
    found = calibrated(_glides(), 150.0)
    assert found[0] == 150.0
    assert found == pytest.approx(PLANTED, rel=1e-6)
    wrong = calibrated(_glides(), 0.0)
    assert max(abs(speed_of(k, wrong) - k.speed) for k in _glides()) > 1e-3


def test_incidence_of_a_speed() -> None:
    known = _glides()[0]
    assert glide(known.polar, known.net_weight, np.array(incidence_at(known)))[0] == pytest.approx(
        known.speed, abs=1e-12
    )
    assert np.isnan(incidence_at(replace(known, speed=9.0)))


def test_too_few_speeds_determine_nothing() -> None:
    assert np.isnan(calibrated(_glides()[:2])).all()
    assert np.isnan(calibrated([replace(k, speed=9.0) for k in _glides()])).all()
