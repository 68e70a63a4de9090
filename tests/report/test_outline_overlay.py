"""The outline over a drawn body: every part where it is, by its name, and what no method sees."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.outline import Bluff, Outline, RingWing, Unseen
from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.report.figures.outline_overlay import drawn
from coeflab.report.figures.three_views import three_views
from tests.estimates.bodies import SAIL, hull


def test_lines_span_the_parts() -> None:
    ring = RingWing("duct", np.array([-1.0, 0.0, 0.0]), 0.4, 0.2, 0.1)
    block = Bluff("box", "box", np.array([0.3, 0.0, 0.2]), np.eye(3), np.array([0.1, 0.05, 0.02]), np.ones(3))
    deck = Unseen("deck", np.array([0.0, 0.0, -0.3]), np.array([0.02, 0.01, 0.5]))
    one = hull()
    found = {
        p.name: np.concatenate(p.lines)
        for p in drawn(Outline((one,), (SAIL,), (ring,), (block,), 1.0, 1.0, unseen=(deck,)))
    }
    assert set(found) == {one.name, SAIL.name, "duct", "box", "deck"}
    assert np.ptp(found["duct"], axis=0) == pytest.approx([0.2, 0.4, 0.4])
    assert found["duct"][:, 0].max() == pytest.approx(-1.0 + 0.05)
    assert np.ptp(found["box"], axis=0) == pytest.approx([0.2, 0.1, 0.04])
    assert np.ptp(found[one.name][:, 0]) == pytest.approx(one.length)
    assert found[SAIL.name][:, 0].max() == pytest.approx(SAIL.root[0] + SAIL.root_chord / 4.0)


def test_every_part_is_named_in_the_drawing() -> None:
    body = read_body(Path(shipped("geometry")) / "suboff_aff8" / "body.toml")
    text = three_views(body)["svg"].decode()
    for foil in body.outline.foils:
        assert foil.name in text
