"""A body that is declared to be its own mirror image: parity is fixed, and what the mirror repeats never narrows an interval."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.statistics import origin_slope
from coeflab.fits.statistics.many_rows import images
from coeflab.law.coefficient import Status
from coeflab.study.checks import coverage
from coeflab.tables.campaign import read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables

DENSITY, SPEED, LENGTH = 1000.0, 2.0, 4.0
ANGLES = np.radians(np.arange(2.0, 13.0, 2.0))
NOISE = np.random.default_rng(18).standard_normal((2, 3, 13))
BOTH = '["port-starboard", "up-down", "fourfold"]'
CAMPAIGN = """
[campaign]
name = "synthetic"
title = "Synthetic"
body = "synthetic_body"
{symmetry}
[axes]
frame = "FRD"
datum = "nose"
reference_point = [-2.0, 0.0, 0.0]
[scaling]
length = 4.0
length_name = "LBP"
[conditions]
speed = 2.0
density = 1000.0
[source]
citation = "synthetic"
kind = "synthetic"
{tables}
"""


def forces(angles: Sequence[float], side: str = "v", noise: int = 0) -> list[list[float]]:
    """u, v or w, X, Y or Z, N or M of a fourfold body, with noise that its mirror image repeats."""
    rows = []
    for a in angles:
        s, x = np.sign(a), np.sin(abs(a))
        i = round(float(np.degrees(abs(a))))
        lift = -s * (0.02 * x + 0.15 * x * x) * 0.5 * DENSITY * SPEED**2 * LENGTH**2 + s * 0.4 * NOISE[noise, 0, i]
        turn = -s * (0.014 * x - 0.03 * x * x) * 0.5 * DENSITY * SPEED**2 * LENGTH**3 + s * 0.4 * NOISE[noise, 1, i]
        ahead = -40.0 - 30.0 * x * x + 0.05 * NOISE[noise, 2, i]
        turn = turn if side == "v" else -turn
        rows.append([SPEED * np.cos(a), s * SPEED * x, ahead, lift, turn])
    return rows


def csv_of(angles: Sequence[float], side: str = "v", noise: int = 0) -> str:
    head = "u [m/s],v [m/s],X [N],Y [N],N [N*m]" if side == "v" else "u [m/s],w [m/s],X [N],Z [N],M [N*m]"
    return "\n".join([head, *(",".join(f"{x:.9g}" for x in row) for row in forces(angles, side, noise))]) + "\n"


Reader = Callable[..., tuple[ForceTable, ...]]


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Reader:
    def read(symmetry: str = "", stated: str = "", **contents: str) -> tuple[ForceTable, ...]:
        folder = tmp_path_factory.mktemp("campaign")
        said = "".join(f'[[table]]\nfile = "{name}.csv"\n{stated if name == "attack" else ""}\n' for name in contents)
        declared = f"symmetry = {symmetry}" if symmetry else ""
        (folder / "campaign.toml").write_text(CAMPAIGN.format(symmetry=declared, tables=said))
        for name, text in contents.items():
            (folder / f"{name}.csv").write_text(text)
        return read_tables(PlannedTable(folder, ()))

    return read


@pytest.fixture(scope="module")
def one_side(tables: Reader) -> FitResult:
    return fitted(tables(BOTH, drift=csv_of([0.0, *ANGLES])))


def fitted(of: tuple[ForceTable, ...], name: str = "slope_at_origin", **options: object) -> FitResult:
    return FITS.load(name).fit(of, of[0].scaling, options)


def values(found: FitResult) -> dict[str, tuple[float | None, float | None]]:
    return {c.symbol: (c.value, c.u95) for c in found.coefficients.coefficients}


class _Study:
    def __init__(self, *fits: FitResult) -> None:
        self.fits, self.tables, self.by_body = fits, (), {}


def sides(found: FitResult) -> list[Check]:
    return [c for c in coverage.check(_Study(found)) if "side" in c.statistic]  # type: ignore[arg-type]


def test_one_side_is_enough_by_declaration(one_side: FitResult) -> None:
    sweep = one_side.sweep("Yv")
    assert sweep.symmetry == "port-starboard"
    assert [p.label for p in sweep.left_out] == ["line 2"]
    assert "zero by declared symmetry" in sweep.left_out[0].reason
    assert len(sweep.x) == len(ANGLES)
    assert sweep.at_rest == pytest.approx((0.0, 0.0), abs=1e-6)
    assert np.allclose(sweep.curve[1], -sweep.curve[1][::-1], atol=1e-9)
    value, u95 = values(one_side)["Yv"]
    assert abs(value + 0.02) < u95
    (check,) = sides(one_side)
    assert check.severity is Severity.PASS
    assert "declared port-starboard symmetry" in check.statistic
    assert not any("cannot be told apart" in n for n in sweep.notes)
    assert len(one_side.sweep("X0").x) == len(ANGLES) + 1


def test_without_a_declaration_one_side_is_a_warning(tables: Reader) -> None:
    for symmetry in ("", '["up-down"]'):
        found = fitted(tables(symmetry, drift=csv_of([0.0, *ANGLES])))
        assert found.sweep("Yv").symmetry == ""
        assert [c.severity for c in sides(found)] == [Severity.WARN]


@pytest.mark.parametrize("copied", [3, 6])
def test_a_mirrored_row_narrows_nothing(tables: Reader, one_side: FitResult, copied: int) -> None:
    again = fitted(tables(BOTH, drift=csv_of([*-ANGLES[:copied], 0.0, *ANGLES])))
    alone, both = values(one_side), values(again)
    assert set(alone) == set(both)
    for symbol, (value, u95) in alone.items():
        assert both[symbol][0] == pytest.approx(value, rel=1e-6)
        assert both[symbol][1] == pytest.approx(u95, rel=1e-6)
    assert sum("counts once" in p.reason for p in again.sweep("Yv").left_out) == copied


def test_both_sides_that_were_run_both_count(tables: Reader) -> None:
    text = csv_of([0.0, *ANGLES]) + csv_of(-ANGLES, noise=1).partition("\n")[2]
    found = fitted(tables(BOTH, drift=text))
    assert found.sweep("Yv").symmetry == ""
    assert len(found.sweep("Yv").x) == 2 * len(ANGLES) + 1


def test_attack_from_drift_is_said_and_adds_nothing(tables: Reader, one_side: FitResult) -> None:
    drift, attack = csv_of([0.0, *ANGLES]), csv_of([0.0, *ANGLES], "w")
    stated = 'by_symmetry = "drift.csv"'
    both = tables(BOTH, stated, drift=drift, attack=attack)
    assert [t.by_symmetry for t in both] == ["", "synthetic/drift.csv"]
    found_both = fitted(both)
    slopes = values(found_both)
    names = [c.symbol for c in found_both.coefficients.coefficients]
    cross = found_both.coefficients.covariance[names.index("Yv"), names.index("Zw")]
    yv, zw = (found_both.coefficients.coefficients[names.index(s)] for s in ("Yv", "Zw"))
    assert cross == pytest.approx((zw.parts.random or 0.0) ** 2 / 4.0, rel=1e-5)
    assert "not run: synthetic/drift.csv turned by symmetry" in zw.estimator
    assert "not run" not in yv.estimator
    assert (yv.status, zw.status) == (Status.OK, Status.SYMMETRY_ASSUMED)
    assert zw.said.endswith(" (symmetry assumed)")
    assert "assumed" not in yv.said
    for symbol, found in values(one_side).items():
        assert slopes[symbol] == pytest.approx(found, rel=1e-9)
    assert slopes["Zw"] == pytest.approx(slopes["Yv"], rel=1e-6)
    assert slopes["Mw"][0] == pytest.approx(-slopes["Nv"][0], rel=1e-6)
    alone = tables(BOTH, drift=drift)
    for name, options in (("tied_law", {}), ("manoeuvring_model", {"terms": "Yv Yv|v| Nv Nv|v| X0 Xvv"})):
        without, having = (values(fitted(t, name, **options)) for t in (alone, both))
        for symbol, (value, u95) in without.items():
            assert having[symbol] == pytest.approx((value, u95), rel=1e-6), (name, symbol)


def test_no_equation_over_rows_and_their_own_images(tables: Reader) -> None:
    drift, attack = csv_of([0.0, *ANGLES]), csv_of([0.0, *ANGLES], "w")
    both = tables(BOTH, 'by_symmetry = "drift.csv"', drift=drift, attack=attack)
    with pytest.raises(InputError, match="turned by symmetry"):
        fitted(both, "manoeuvring_model", terms="Yv Yv|v| Zw Zw|w|", constraints="Zw = Yv")


@pytest.mark.parametrize(
    ("symmetry", "attack", "words"),
    [
        ('["port-starboard", "sideways"]', "", "each once of port-starboard, up-down, fourfold"),
        ('["up-down", "up-down"]', "", "each once of"),
        ("", 'by_symmetry = "drift.csv"', "Add campaign.symmetry"),
        (BOTH, 'by_symmetry = "roll.csv"', "a table that was run: drift.csv"),
        (BOTH, 'by_symmetry = "attack.csv"', "a table that was run: drift.csv"),
    ],
)
def test_declarations_that_cannot_be(tmp_path: Path, symmetry: str, attack: str, words: str) -> None:
    said = f'[[table]]\nfile = "drift.csv"\n[[table]]\nfile = "attack.csv"\n{attack}\n'
    path = tmp_path / "campaign.toml"
    path.write_text(CAMPAIGN.format(symmetry=f"symmetry = {symmetry}" if symmetry else "", tables=said))
    with pytest.raises(InputError, match=words):
        read_campaign(path)


def test_of_a_pair_the_image_on_the_side_with_fewer_rows_goes() -> None:
    x, y = np.array([0.0, 1.0, -1.0, 0.0, -2.0, 2.0, 3.0]), np.array([0.5, 3.0, -3.0, -0.5, 4.0, 4.0, 9.0])
    assert np.flatnonzero(images(x, y, -1.0)).tolist() == [2]
    assert np.flatnonzero(images(x, y, 1.0)).tolist() == [4]
    assert np.flatnonzero(images(-x, y, 1.0)).tolist() == [4]


def test_a_mirrored_side_adds_no_degree_of_freedom() -> None:
    x = np.sin(ANGLES)
    y = x + 0.5 * x * np.abs(x) + 0.01 * NOISE[0, 0, : len(x)]
    one = origin_slope.estimate(x, y, odd=True)
    two = origin_slope.estimate(np.r_[x, -x], np.r_[y, -y], odd=True)
    assert (two.value, two.u95, two.noise) == pytest.approx((one.value, one.u95, one.noise), rel=1e-12)
    at_rest, half = origin_slope.curve(one, np.zeros(1))
    assert abs(at_rest[0]) < 1e-5
    assert half[0] < 1e-3 * one.noise + 1e-9


def as_cfd(of: tuple[ForceTable, ...]) -> tuple[ForceTable, ...]:
    return tuple(replace(t, source=replace(t.source, kind="cfd")) for t in of)


def shifted(text: str, by: float) -> str:
    """The same rows with a side force of so many N more."""
    head, *rows = text.splitlines()
    cells = [row.split(",") for row in rows]
    return "\n".join([head, *(",".join([*c[:3], f"{float(c[3]) + by:.9g}", c[4]]) for c in cells)]) + "\n"


def test_what_a_straight_run_has_of_a_force_that_is_zero_by_symmetry_is_in_u95(
    tables: Reader, one_side: FitResult
) -> None:
    """A bias of b moves a slope by b times the sum of what each reading moves it by: here by hand from the rows themselves."""
    unit = 0.5 * DENSITY * SPEED**2 * LENGTH**2
    at_rest = csv_of([0.0]).replace(csv_of([0.0]).splitlines()[1].split(",")[3], "16.0", 1)
    biased = fitted(tables(BOTH, drift=at_rest + csv_of(ANGLES).partition("\n")[2]))
    sweep, plain = biased.sweep("Yv"), one_side.sweep("Yv")
    assert sweep.bias == pytest.approx(16.0 / unit, rel=1e-6)
    assert sweep.value == pytest.approx(plain.value)
    moved = sweep.bias * plain.by_row.sum()
    assert sweep.u95 == pytest.approx(np.hypot(plain.u95, moved), rel=1e-6)
    lifted, below = (
        fitted(tables(BOTH, drift=shifted(csv_of(ANGLES), by * unit))).sweep("Yv").value or 0.0 for by in (1e-4, -1e-4)
    )
    assert moved == pytest.approx(
        sweep.bias * (lifted - below) / 2e-4, rel=0.15
    )  # the weights of the forms follow, too
    assert biased.sweep("X0").bias == 0.0


def test_a_computed_pair_counts_once_and_without_its_bias(tables: Reader, one_side: FitResult) -> None:
    """Both sides of 4 deg with a bias of 20 N, the others without: half the difference of the pair is the unbiased force."""
    unit = 0.5 * DENSITY * SPEED**2 * LENGTH**2
    rest, pair = csv_of([0.0]), csv_of([ANGLES[1], -ANGLES[1]])
    others = csv_of([a for a in ANGLES if a != ANGLES[1]])
    text = rest + others.partition("\n")[2] + shifted(pair, 20.0).partition("\n")[2]
    sweep = fitted(as_cfd(tables(BOTH, drift=text))).sweep("Yv")
    assert sweep.symmetry == "port-starboard"
    assert len(sweep.x) == len(ANGLES)
    assert sum("half the difference" in p.reason for p in sweep.left_out) == 1
    place = int(np.argmin(np.abs(sweep.x - np.sin(ANGLES[1]))))
    there = one_side.sweep("Yv")
    assert sweep.y[place] == pytest.approx(there.y[1], abs=1e-9)
    assert abs(sweep.y[place] * unit) > 20.0
    assert sweep.value == pytest.approx(there.value, rel=1e-6)
    measured = fitted(tables(BOTH, drift=text)).sweep("Yv")
    assert len(measured.x) == len(ANGLES) + 2


# A symmetry that the points rule out


@pytest.mark.parametrize(("constant", "withdrawn"), [(0.0, False), (0.05, True), (-0.1, True)])
def test_a_symmetry_that_the_points_rule_out_is_withdrawn(tables: Reader, constant: float, withdrawn: bool) -> None:
    """A constant of 5 % of the largest Y; Nv' of the same runs keeps the declaration."""
    angles = np.radians(np.arange(1.0, 13.0))
    head, *rows = csv_of(angles).splitlines()
    cells = np.array([[float(x) for x in row.split(",")] for row in rows])
    cells[:, 3] += constant * np.abs(cells[:, 3]).max()
    text = "\n".join([head, *(",".join(f"{x:.9g}" for x in row) for row in cells)]) + "\n"
    found = fitted(tables('["port-starboard"]', drift=text))
    codes = {f.subject: f for f in found.findings if f.code == "symmetry.withdrawn"}
    assert set(codes) == ({"synthetic Yv'"} if withdrawn else set())
    assert found.sweep("Yv").symmetry == ("" if withdrawn else "port-starboard")
    assert found.sweep("Nv").symmetry == "port-starboard"
    value, u95 = values(found)["Yv"]
    assert abs(value + 0.02) <= u95


# Rows turned by symmetry, beside runs in their plane


def beside(tables: Reader, apart: float, degrees: Sequence[float]) -> FitResult:
    """Attack turned from drift, and runs at some angles of a body whose vertical plane answers so much more, with noise of their own."""
    head, *rows = csv_of(np.radians(degrees), "w", noise=1).splitlines()
    cells = np.array([[float(x) for x in row.split(",")] for row in rows])
    cells[:, 3:] *= 1.0 + apart
    runs = "\n".join([head, *(",".join(f"{x:.9g}" for x in row) for row in cells)]) + "\n"
    drift, attack = csv_of([0.0, *ANGLES]), csv_of([0.0, *ANGLES], "w")
    return fitted(tables(BOTH, 'by_symmetry = "drift.csv"', drift=drift, attack=attack, runs=runs))


def planes(found: FitResult) -> Severity:
    (one,) = (f.severity for f in found.findings if f.code == "symmetry.planes")
    return one


@pytest.mark.parametrize("apart", [0.0, 0.2])
def test_runs_of_a_plane_count_in_the_place_of_rows_turned_into_it(tables: Reader, apart: float) -> None:
    found = beside(tables, apart, [-10.0, -8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0])
    zw = found.coefficients["Zw"]
    assert (zw.table, zw.status) == ("synthetic/runs.csv", Status.OK)
    assert abs((zw.value or 0.0) + 0.02 * (1.0 + apart)) <= (zw.u95 or 0.0)
    assert planes(found) is (Severity.WARN if apart else Severity.PASS)


@pytest.mark.parametrize(("apart", "status"), [(0.0, Status.SYMMETRY_ASSUMED), (0.2, Status.TOO_FEW_POINTS)])
def test_two_runs_withdraw_turned_rows_that_are_not_like_them(tables: Reader, apart: float, status: Status) -> None:
    found = beside(tables, apart, [6.0, 12.0])
    assert found.coefficients["Zw"].status is status
    assert (found.coefficients["Zw"].value is None) is bool(apart)
    assert planes(found) is (Severity.WARN if apart else Severity.PASS)
    assert found.coefficients["Yv"].status is Status.OK
