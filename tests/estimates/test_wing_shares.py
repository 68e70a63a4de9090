"""A wing added to or taken from a body moves each derivative by the wing's own share, within the U95 of the body with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.bodies.outline import Foil, Outline
from coeflab.estimates import Estimates
from tests.estimates.bodies import RING, SAIL, estimates_of, outline, tail

DERIVATIVES = ("Yv", "Nv", "Yr", "Nr", "Zw", "Mw", "Zq", "Mq", "Kv", "Kr", "Kp")


def sail_planes() -> tuple[Foil, ...]:
    """A pair on the sail, halfway up; each stands on its root."""
    middle = (SAIL.root + SAIL.tip) / 2.0
    out = []
    for name, side in (("plane_starboard", 1.0), ("plane_port", -1.0)):
        root = middle + np.array([0.0, side * 0.01, 0.0])
        tip = root + np.array([0.0, side * SAIL.span, 0.0])
        out.append(replace(SAIL, name=name, root=root, tip=tip, root_chord=SAIL.root_chord / 2.0,
                           tip_chord=SAIL.tip_chord / 2.0, stand=root[1:]))  # fmt: skip
    return tuple(out)


def of(*names: str) -> Outline:
    foils = [*((SAIL,) if "sail" in names else ()), *(tail() if "tail" in names else ())]
    foils += sail_planes() if "planes" in names else ()
    return outline(*foils, rings=(RING,) if "ring" in names else ())


def moved_and_own(names: tuple[str, ...], wing: str) -> tuple[Estimates, dict[str, tuple[float, float, float]]]:
    """Of each derivative: what the wing moves it by, its own share, and the half-width with it."""
    without = tuple(n for n in names if n != wing)
    large, small = estimates_of(of(*names)), estimates_of(of(*without))
    parts = {f.name for f in (*of(*names).foils, *of(*names).rings)} - {
        f.name for f in (*of(*without).foils, *of(*without).rings)
    }
    found = {}
    for symbol in DERIVATIVES:
        if symbol not in large.coefficients.symbols:
            continue
        one = large.coefficients[symbol]
        before = small.coefficients[symbol].value if symbol in small.coefficients.symbols else 0.0
        own = sum(v for key, v in large.shares[symbol].items() if any(p in key for p in parts))
        if (
            "ring" in without
        ):  # what the wing takes from a ring in its wake is its doing too, as its sidewash on foils is
            own += sum(sign * v for made, sign in ((large, 1.0), (small, -1.0))
                       for key, v in made.shares.get(symbol, {}).items() if key.startswith("ring"))  # fmt: skip
        assert one.u95 is not None
        found[symbol] = (one.value - (before or 0.0), own, one.u95)
    return large, found


@pytest.mark.parametrize(
    ("names", "wing"),
    [
        (("sail", "tail", "planes"), "planes"),
        (("sail", "tail"), "tail"),
        (("tail",), "tail"),
        (("sail", "tail"), "sail"),
        (("sail", "tail", "ring"), "ring"),
        (("ring",), "ring"),
        (("tail", "ring"), "tail"),
    ],
)
def test_a_wing_moves_a_derivative_by_its_own_share(names: tuple[str, ...], wing: str) -> None:
    _, found = moved_and_own(names, wing)
    assert len(found) > 6
    for symbol, (moved, own, u95) in found.items():
        assert abs(moved - own) <= u95 + 1e-9, (symbol, moved, own, u95)
    if wing != "ring":  # no test of half-widths that hold anything; a ring behind a tail has little left
        assert any(abs(own) > 0.5 * u95 for _, own, u95 in found.values())
