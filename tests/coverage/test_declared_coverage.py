"""What the page says of declarations, and of G_h, is what the committed tables say."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from scipy import stats

from tests.coverage.declared_campaigns import CASES, NOISE, TABLE, campaigns, read
from tests.coverage.stability_campaigns import TABLE as OF_HULLS

GUARDED = ("sign", "beside", "two runs")
PAGE = (Path(__file__).parents[2] / "docs" / "calibration.md").read_text()


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


def test_what_is_withdrawn_or_runs_decide_covers_where_it_is_wrong() -> None:
    """A false sign, and a false quarter of a turn beside runs of the plane: 300 campaigns a cell; without a guard 68, and 13 %."""
    found = [r for r in rows(TABLE) if r["declared"] in GUARDED and r["true"] == "no"]
    assert len(found) == 28
    assert {r["campaigns"] for r in found} == {"300"}
    assert min(int(r["cover %"]) for r in found) >= 90


NAMED = (("sign", "one power, opposed", 0.03), ("sign", "saturating, opposed", 0.03), ("beside", "one power, 20 % apart", 0.01),
         ("two runs", "one power, 20 % apart", 0.01))  # fmt: skip


@pytest.mark.parametrize(("kind", "curve", "noise"), NAMED)
def test_named_cells_with_few_campaigns(kind: str, curve: str, noise: float) -> None:
    """Ten of a third seed; a sign without its guard is covered in 68 to 84 % here, the turned rows in 77."""
    found = [read(kind, curve, t, y)[0] for t, y in campaigns(kind, curve, noise, 10, 7)]
    assert sum(abs(value - 1.0) <= u95 for value, u95, _ in found) >= 9
    assert sum(off for _, _, off in found) >= 9


@pytest.mark.parametrize(
    ("kind", "curve", "text"),
    [
        ("grows", "slow power", "slow powers {}"), ("bound", "twice M", "twice M: {}"), ("grows", "saturating", "; saturating {}"),
        ("odd", "one power and a constant", "beside one power {}"), ("odd", "saturating and a constant", "beside a saturating bend {}"),
        ("sign", "one power: opposed", "the other sign, one power {}"), ("sign", "saturating: opposed", "; the other sign, saturating {};"),
        ("sign", "three powers: opposed", "; the other sign, three powers {};"),
        ("sign", "late bend: opposed", "; the other sign, late bend {}; where true"),
        ("turned", "one power: 5 % apart", "planes 5 % apart {}"), ("turned", "one power: 20 % apart", "; 20 % apart {} |"),
        ("beside", "one power: 5 % apart", "runs count, planes 5 % apart {};"), ("beside", "one power: 20 % apart", "runs count, 20 % apart {} |"),
        ("two runs", "one power: 20 % apart", "withdrawn or right, 20 % apart {} |"),
    ],
)  # fmt: skip
def test_the_page_says_what_a_wrong_declaration_covers(kind: str, curve: str, text: str) -> None:
    wrong = [r["cover %"] for r in rows(TABLE) if (r["declared"], r["curve"], r["true"]) == (kind, curve, "no")]
    assert len(wrong) == len(NOISE)
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
