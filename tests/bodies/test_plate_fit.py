"""The rectangle that stands for a thin body: its area, its span, its attitude."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import CrossSection, Manifold

from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.simplify.plate_fit import plate_fit


def plan(*corners: tuple[float, float]) -> Manifold:
    """10 mm thick across z."""
    return Manifold.extrude(CrossSection([np.array(corners)]), 0.01).translate((0.0, 0.0, -0.005))


def test_a_slanted_root_counts_with_its_mean() -> None:
    """Chord 0.2 m; the root runs from y = 0.05 to 0.1 m, the tip lies at 0.4 m."""
    found = plate_fit(surface(plan((0.0, 0.05), (0.2, 0.1), (0.2, 0.4), (0.0, 0.4))), np.eye(3))
    assert found.chord * found.span == pytest.approx(0.2 * 0.325, rel=1e-6)
    assert found.span == pytest.approx(0.325, rel=0.01)
    assert found.rotation == pytest.approx(np.eye(3), abs=1e-12)


def test_a_triangle_keeps_area_and_centre() -> None:
    found = plate_fit(surface(plan((0.0, 0.0), (1.0, 0.0), (0.0, 2.0))), np.eye(3))
    assert found.chord * found.span == pytest.approx(1.0, rel=1e-6)
    assert found.centre == pytest.approx([1.0 / 3.0, 2.0 / 3.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("angle", [10.0, 40.0, 80.0])
def test_a_rectangle_in_any_attitude_is_itself(angle: float) -> None:
    turned = plan((-0.35, -0.25), (0.35, -0.25), (0.35, 0.25), (-0.35, 0.25)).rotate((0.0, 0.0, angle))
    found = plate_fit(surface(turned), np.eye(3))
    assert sorted((found.chord, found.span)) == pytest.approx([0.5, 0.7], rel=1e-6)


def test_a_swept_fin_of_low_aspect_keeps_its_chord_fore_and_aft() -> None:
    fin = plan((0.0, 0.0), (0.4, 0.0), (0.3, 0.4), (0.0, 0.4))
    found = plate_fit(surface(fin), np.eye(3))
    assert found.rotation[:, 0] == pytest.approx([1.0, 0.0, 0.0])
    assert found.span == pytest.approx(0.4, rel=0.01)
