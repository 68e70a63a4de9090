"""Where fins stand along a hull, in words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.bodies.outlining import fins_along
from tests.estimates.bodies import SAIL, box, outline, tail


def test_fins_are_told_by_their_stations_from_the_bow() -> None:
    found = fins_along(outline(SAIL, *tail()))
    assert found.words == (
        "1 fin at x = -1.2 m, 30 % of the length from the bow; 4 fins at x = -3.5 m, 88 % of the length from the bow"
    )
    assert not found.ahead


def test_fins_at_the_bow_are_all_ahead() -> None:
    forward = np.array([3.0, 0.0, 0.0])
    found = fins_along(outline(*(replace(f, root=f.root + forward, tip=f.tip + forward) for f in tail())))
    assert found.ahead


def test_without_hull_or_fins_there_is_nothing_to_say() -> None:
    assert fins_along(outline()) is None
    assert fins_along(outline(hulls=(), bluff=(box(),))) is None
