from __future__ import annotations

import pytest

from coeflab.core.wording import finite, listed


@pytest.mark.parametrize(("names", "said"), [("a", "a"), ("ab", "a and b"), ("abc", "a, b and c")])
def test_names_in_a_row(names: str, said: str) -> None:
    assert listed(list(names)) == said


def test_numbers_that_json_cannot_hold() -> None:
    assert finite(0.5) == 0.5
    assert [finite(float(v)) for v in ("nan", "inf", "-inf")] == [None] * 3
