"""The panel kernel against capytaine 3.0 on the same triangles; numbers and meshes by data/capytaine/make.py."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.panel_solver.solve import panel_added_mass

KEPT = json.loads((Path(__file__).parent / "data" / "capytaine" / "capytaine.json").read_text(encoding="utf-8"))


def gaps(name: str, method: str) -> np.ndarray:
    """Differences over the root of both diagonal entries."""
    body = KEPT[name]
    corners = np.array(body["vertices"])[np.array(body["faces"])]
    ours = panel_added_mass(corners, np.zeros(3), compiled=False).matrix
    theirs = np.array(body[method])
    root = np.sqrt(np.diag(ours))
    return np.asarray(np.abs((theirs + theirs.T) / 2.0 - ours) / np.outer(root, root))


@pytest.mark.parametrize("name", ["ellipsoid", "box"])
def test_the_direct_formulation_agrees(name: str) -> None:
    """Inertias agree less closely: the layer of y x n is exact here and constant on each panel there."""
    found = gaps(name, "direct")
    assert np.max(found[:3, :3]) < 1e-3
    assert np.max(found) < 5e-3


@pytest.mark.parametrize("name", ["ellipsoid", "box"])
def test_the_source_formulation_is_per_cents_away_on_so_few_panels(name: str) -> None:
    assert np.min(np.diag(gaps(name, "indirect"))) > 5e-3
