"""Fixed forms with few campaigns, through the array kernels, and what the committed table says."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from tests.coverage.forms_campaigns import SEEN, TABLE, cell, cells, truths

FORMS = {t.form: t for t in truths()}


@pytest.fixture(scope="module")
def table() -> list[dict[str, str]]:
    with TABLE.open() as lines:
        return list(csv.DictReader(lines))


@pytest.mark.parametrize(
    ("form", "missing"),
    [
        ("damping, both ways", "u^3"), ("damping, both ways", "bend"), ("damping, one way", "u^3"),
        ("polar, lift", "alpha^3"), ("polar, drag", "|alpha|^3"), ("surface", "alpha beta^2"), ("manoeuvring", "vrr"),
    ],
)  # fmt: skip
def test_a_missing_term_is_in_u95_or_the_coefficient_is_rejected(form: str, missing: str) -> None:
    found = cell(FORMS[form], missing, 0.3, 0.001, 10, (5, 1))
    assert float(str(found["scatter alone covers %"])) <= 60.0
    assert float(str(found["covers or rejected %"])) >= 90.0


def test_a_right_form_is_not_widened_and_not_rejected() -> None:
    for form in ("damping, both ways", "manoeuvring"):
        found = cell(FORMS[form], "", 0.0, 0.01, 20, (5, 2))
        assert float(str(found["median width ratio"])) <= 1.1
        assert found["rejected %"] == "0.0"


def test_the_committed_table_is_whole(table: list[dict[str, str]]) -> None:
    expected = [(t.form, m or "nothing", f"{100 * s:.0f}", f"{100 * n:g}") for t, m, s, n in cells()]
    assert [(r["form"], r["missing"], r["share %"], r["noise %"]) for r in table] == expected


def test_every_misfit_that_can_be_seen_is_covered_or_rejected(table: list[dict[str, str]]) -> None:
    seen = [r for r in table if float(r["seen"]) >= SEEN]
    assert len(seen) > 40
    assert min(float(r["covers or rejected %"]) for r in seen) >= 90.0
    assert {r["remark"] for r in seen} == {""}
    hidden = [r for r in table if r["missing"] != "nothing" and float(r["covers or rejected %"]) < 90.0]
    assert {r["remark"] for r in hidden} == {"hidden by the noise"}


def test_right_forms_keep_their_widths(table: list[dict[str, str]]) -> None:
    right = [r for r in table if r["missing"] == "nothing"]
    assert max(float(r["rejected %"]) for r in right) <= 5.0
    assert max(float(r["median width ratio"]) for r in right) <= 1.1
    gained = [float(r["covers or rejected %"]) - float(r["scatter alone covers %"]) for r in right]
    assert min(gained) >= 0.0
    assert np.mean([float(r["covers or rejected %"]) for r in right]) >= 93.0
