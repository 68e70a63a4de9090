"""Every work says who, when, and where; what is not known is said."""

from __future__ import annotations

import re

import pytest

from coeflab.core.provenance import work, works

BODIES = ("SNAME,", "IMO,", "ITTC,", "JCGM", "ASME", "Modelica", "Open Source", "Sirehna,", "coeflab,")
PERSON = re.compile(r"[A-Z]\.[ -]")
NO_AUTHORS = {"steady_cfd", "tj_flyingfish", "thauv"}


@pytest.mark.parametrize("key", works())
def test_a_work_has_authors_and_a_year_or_says_that_they_are_not_known(key: str) -> None:
    text = works()[key]
    if key in NO_AUTHORS:
        assert "names no authors" in text
    else:
        assert text.startswith(BODIES) or PERSON.match(text)
        assert re.search(r"\b(18|19|20)\d\d\b", text)
    assert text.endswith(".")
    assert "et al., " not in text.split(", in ")[0]


def test_a_text_that_is_no_key_is_returned() -> None:
    assert work("My own notes") == "My own notes"
