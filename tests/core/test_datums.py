"""Datums that are one under two texts."""

from __future__ import annotations

import pytest

from coeflab.core.datums import same_datum


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("nose", "nose, on the hull's axis", True),
        ("Nose, on the hull's axis", "the nose, at the hull's axis", True),
        ("centre of gravity", "Centre gravity", True),
        ("nose, on the deck", "nose, on the hull's axis", False),
        ("nose", "tail, on the hull's axis", False),
        ("nose", "nose of the sail", False),
        ("centre of buoyancy", "centre of gravity", False),
    ],
)
def test_what_is_added_after_a_comma_may_be_left_out(one: str, other: str, same: bool) -> None:
    assert same_datum(one, other) is same
    assert same_datum(other, one) is same
    assert same_datum(one, one)
