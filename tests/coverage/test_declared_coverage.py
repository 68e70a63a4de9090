"""What the page says of declarations, and of G_h, is what the committed tables say."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from scipy import stats

from tests.coverage.declared_campaigns import CASES, NOISE, TABLE
from tests.coverage.stability_campaigns import TABLE as OF_HULLS

PAGE = (Path(__file__).parents[2] / "docs" / "slope_at_origin.md").read_text()


def rows(path: Path) -> list[dict[str, str]]:
    with path.open() as lines:
        return list(csv.DictReader(lines))


def test_declarations_cover_where_they_are_true() -> None:
    found = rows(TABLE)
    assert len(found) == len(CASES) * len(NOISE)
    assert min(int(r["cover %"]) for r in found if r["true"] == "yes" and r["declared"] != "sign") >= 90
    assert min(int(r["cover %"]) for r in found if r["true"] == "yes") >= 85
    true = [r for r in found if (r["declared"], r["true"]) == ("odd", "yes")]
    withdrawn = sum(round(int(r["withdrawn %"]) * int(r["campaigns"]) / 100.0) for r in true)
    assert (sum(int(r["campaigns"]) for r in true), withdrawn) == (320, 2)


@pytest.mark.parametrize(
    ("curve", "text"),
    [
        ("slow power", "slow powers {}"), ("twice M", "twice M: {}"), ("saturating", "; saturating {}"),
        ("one power and a constant", "beside one power {}"), ("saturating and a constant", "beside a saturating bend {}"),
        ("one power: opposed", "the other sign, one power {}"), ("saturating: opposed", "; the other sign, saturating {}; where true"),
        ("one power: 5 % apart", "planes 5 % apart {}"), ("one power: 20 % apart", "; 20 % apart {} |"),
    ],
)  # fmt: skip
def test_the_page_says_what_a_wrong_declaration_covers(curve: str, text: str) -> None:
    wrong = [r["cover %"] for r in rows(TABLE) if (r["curve"], r["true"]) == (curve, "no")]
    assert text.format(", ".join(wrong)) in PAGE


def test_no_declaration_can_keep_90_percent_and_be_shorter_than_the_page_says() -> None:
    nine, nineteen = (p * stats.norm.ppf(p) + stats.norm.pdf(stats.norm.ppf(p)) for p in (0.9, 0.95))
    assert f"no shorter than {nine / nineteen:.2f} times".replace("0.", ".") in PAGE
    assert f"{nine:.2f} and {nineteen:.2f}" in PAGE


def test_every_decided_sign_of_g_h_was_right() -> None:
    for r in rows(OF_HULLS):
        assert float(r["cover %"]) >= 93.0
        assert float(r["sign right of decided %"]) == 100.0
        assert r["decided"] in PAGE


def test_g_h_is_as_wide_as_its_slopes_and_no_wider() -> None:
    """Its error over its interval is within a fifth of theirs over theirs; by the errors that occurred the draws cover what they should."""
    for r in rows(OF_HULLS):
        slopes = [float(e) for e in r["error of slopes"].split()]
        assert 0.8 * min(slopes) < float(r["error"]) < 1.2 * max(slopes)
        assert 93.0 <= float(r["cover by errors %"]) <= 99.0
        assert f"cover {r['cover by errors %']} %" in PAGE
