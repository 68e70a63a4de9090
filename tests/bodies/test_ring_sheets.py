"""A ring without thickness, against the strip limit: rho pi c^2 / 4 a length, of which sway takes half of the circle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from manifold3d import CrossSection

from coeflab.bodies.added_mass import panel
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.ring_sheets import ring_sheets
from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.outline import RingWing
from tests.estimates.bodies import plain

DIAMETER, CHORD = 0.6, 0.1


def strip_limit(chord: float) -> float:
    return 1000.0 * np.pi * chord**2 / 4.0 * np.pi * DIAMETER / 2.0


def test_sway_of_a_ring_goes_to_that_of_a_strip_bent_to_a_circle() -> None:
    """Of a chord of a sixth of the diameter, by sheets; 2 % is more than its curvature gives."""
    ring = RingWing("ring", np.array([0.0, 0.0, 0.0]), DIAMETER, CHORD, 0.0)
    found = panel.added_mass(replace(plain(), shape=ring_sheets([ring]), reference_point=np.zeros(3)), 1000.0)
    own, error = np.diag(found.matrix), np.diag(found.error)
    assert own[1] == pytest.approx(strip_limit(CHORD), abs=error[1] + 0.02 * own[1])
    assert error[1] < 0.2 * own[1]
    assert own[2] == pytest.approx(own[1], rel=1e-3)
    assert own[0] == pytest.approx(0.0, abs=1e-3 * own[1])


@pytest.mark.slow
def test_a_thin_closed_ring_is_taken_by_its_middle_surface() -> None:
    flat = CrossSection.circle(DIAMETER / 2.0 + 0.001, 64) - CrossSection.circle(DIAMETER / 2.0 - 0.001, 64)
    shape = TriangleMesh(*surface(flat.extrude(CHORD).rotate((0.0, 90.0, 0.0))))
    found = panel.added_mass(replace(plain(), shape=shape, reference_point=np.zeros(3)), 1000.0)
    assert "middle surface" in found.statements[0]
    own, error = np.diag(found.matrix), np.diag(found.error)
    assert own[1] == pytest.approx(strip_limit(CHORD), abs=error[1])
    assert error[0] >= 1000.0 * shape.volume  # its thickness
