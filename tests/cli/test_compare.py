"""``coeflab compare``: conversions that must not change a verdict, and what cannot be compared."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from coeflab.law.symbols import derivative
from coeflab.vehicle.comparison import compare
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.shared_tables import Verdict
from tests.cli.conftest import Run, flat

VALUES = {"Yv'": (-0.028, 0.002), "Nv'": (-0.014, 0.001), "Yr'": (0.005, 0.001), "Nr'": (-0.0045, 0.0004)}
LENGTH = 4.26086


def made(values: dict[str, tuple[float | None, float | None]], **changes: Any) -> ParameterFile:
    """A synthetic parameter file; covariance diagonal."""
    symbols = list(values)
    matrix = [
        [None if u is None or v[1] is None else ((u / 2) ** 2 if s == t else 0.0) for t, v in values.items()]
        for s, (_, u) in values.items()
    ]
    content: dict[str, Any] = {
        "name": "first",
        "body": "hull",
        "scaling": {"length": LENGTH, "length_name": "LBP"},
        "reference_point": {"point": [-2.0, 0.0, 0.0], "datum": "nose"},
        "conditions": {"density": 1000.0, "speed": 2.0},
        "mass": None,
        "coefficients": [
            {
                "symbol": s, "value": v, "u95": u, "unit": "1", "value_si": None, "unit_si": derivative(s).unit,
                "status": "no_table" if v is None else "ok", "origin": "none" if v is None else "fit", "parts": {},
            }
            for s, (v, u) in values.items()
        ],
        "covariance": {"symbols": symbols, "matrix": matrix},
        "covered": [],
        "provenance": {"coeflab_version": "0", "study": "s", "inputs": [], "citations": []},
    }  # fmt: skip
    return ParameterFile.model_validate(content | changes)


@pytest.fixture
def write(tmp_path: Path) -> Callable[[ParameterFile, str], Path]:
    def to(content: ParameterFile, name: str) -> Path:
        path = tmp_path / name
        path.write_bytes(content.to_json())
        return path

    return to


def changed(**new: tuple[float | None, float | None]) -> dict[str, tuple[float | None, float | None]]:
    return {**VALUES, **{f"{s}'": v for s, v in new.items()}}


def test_difference_ratio_and_verdict() -> None:
    found = compare(made(VALUES), made(changed(Yv=(-0.031, 0.0015), Nv=(-0.016, 0.001)), name="second"))
    yv, nv, yr, _ = found.rows
    assert yv.difference == pytest.approx(-0.003)
    assert yv.combined == pytest.approx(0.0025)
    assert yv.ratio == pytest.approx(1.2)
    assert [r.verdict for r in (yv, nv, yr)] == [Verdict.APART, Verdict.APART, Verdict.WITHIN]
    assert yr.ratio == 0.0
    assert found.statements == ()
    assert found.same_body


def test_another_length_is_converted_by_its_powers() -> None:
    ratio = LENGTH / 4.356
    powers = {"Yv'": 2, "Nv'": 3, "Yr'": 3, "Nr'": 4}
    other = {s: (v * ratio ** powers[s], u * ratio ** powers[s]) for s, (v, u) in VALUES.items()}
    found = compare(made(VALUES), made(other, scaling={"length": 4.356, "length_name": "LOA"}, name="loa"))
    for r in found.rows:
        assert r.b == pytest.approx(VALUES[r.symbol][0], rel=1e-12)
        assert r.u95_b == pytest.approx(VALUES[r.symbol][1], rel=1e-12)
        assert r.verdict is Verdict.WITHIN
    assert found.statements == ("loa converted from LOA 4.356 m to LBP 4.26086 m",)


def test_another_reference_point_is_transferred() -> None:
    yv, nv, yr, nr = (v for v, _ in VALUES.values())
    dx = 0.5 / LENGTH
    moved = {"Yv'": yv, "Nv'": nv - dx * yv, "Yr'": yr - dx * yv, "Nr'": nr - dx * (nv + yr) + dx**2 * yv}
    there = {s: (v, VALUES[s][1]) for s, v in moved.items()}
    point = {"point": [-1.5, 0.0, 0.0], "datum": "nose"}
    found = compare(made(VALUES), made(there, reference_point=point, name="second"))
    for r in found.rows:
        assert r.b == pytest.approx(VALUES[r.symbol][0], rel=1e-12)
        assert r.verdict is Verdict.WITHIN
    assert "second moved to the reference point of first, (-2, 0, 0) m" in found.statements
    alone = compare(made(VALUES), made({"Nr'": there["Nr'"]}, reference_point=point)).rows
    reasons = {r.symbol: r.reason for r in alone}
    assert {r.verdict for r in alone} == {Verdict.NOT_COMPARABLE}
    assert "needs coefficients" in reasons["Nr'"]
    assert reasons["Yv'"] == "not in the second file"


def test_a_move_that_needs_an_unbounded_coefficient_has_no_interval() -> None:
    point = {"point": [-1.5, 0.0, 0.0], "datum": "nose"}
    found = compare(made(VALUES), made(changed(Yv=(-0.028, None)), reference_point=point))
    reasons = {r.symbol: r.reason for r in found.rows}
    assert set(reasons.values()) == {"no U95 on one side"}
    assert all(r.b is not None and r.u95_b is None for r in found.rows)


def test_other_datums_leave_only_forces_by_velocities() -> None:
    other = {"point": [-2.0, 0.0, 0.0], "datum": "centre of buoyancy"}
    wanted = {**VALUES, "X0'": (-0.001, 0.0001), "Ydr'": (0.006, 0.001), "Kv'": (0.001, 0.001)}
    found = compare(made(wanted), made(wanted, reference_point=other))
    assert {r.symbol for r in found.rows if r.verdict is Verdict.WITHIN} == {"Yv'", "X0'", "Ydr'"}
    assert "other datums" in found.statements[0]


def test_other_bodies_are_flagged() -> None:
    found = compare(made(VALUES), made(VALUES, body="hull with sail"))
    assert not found.same_body
    assert "different bodies" in found.statements[0]


def test_what_has_no_value_or_no_interval_is_not_compared() -> None:
    found = compare(made(VALUES), made(changed(Yv=(-0.03, None), Nv=(None, None), Zw=(0.1, 0.1))))
    reasons = {r.symbol: (r.verdict, r.reason) for r in found.rows}
    assert reasons["Yv'"] == (Verdict.NOT_COMPARABLE, "no U95 on one side")
    assert reasons["Nv'"] == (Verdict.NOT_COMPARABLE, "no value in the second file (no table)")
    assert reasons["Zw'"] == (Verdict.NOT_COMPARABLE, "not in the first file")
    assert found.rows[0].difference == pytest.approx(-0.002)
    assert found.rows[0].ratio is None


@pytest.mark.parametrize(
    ("value", "verdict", "code"),
    [
        (0.028, Verdict.OTHER_SIGN, 1), (-0.043, Verdict.OTHER_SIZE, 0), (-0.018, Verdict.OTHER_SIZE, 0),
        (-0.041, Verdict.NOT_COMPARABLE, 0), (0.0, Verdict.OTHER_SIZE, 0),
    ],
)  # fmt: skip
def test_without_u95_signs_and_sizes_are_marked(
    coeflab: Run, write: Callable[[ParameterFile, str], Path], value: float, verdict: Verdict, code: int
) -> None:
    first, second = made(changed(Yv=(-0.028, None))), made(changed(Yv=(value, None)), name="second")
    found = compare(first, second)
    assert {r.symbol: r.verdict for r in found.rows}["Yv'"] is verdict
    assert found.disagrees == (code == 1)
    if verdict is Verdict.OTHER_SIGN:
        done = coeflab("compare", write(first, "a.json"), write(second, "b.json"))
        assert done.returncode == 1
        assert "1 other sign" in done.stdout
        assert {-0.028, 0.028} <= {float(w) for w in done.stdout.split() if w.strip("-").startswith("0.028")}
        other = made(changed(Yv=(value, None)), body="another")
        assert coeflab("compare", write(first, "a.json"), write(other, "c.json")).returncode == 0


def resting(on: dict[str, str], inputs: dict[str, str], campaign: str = "tow", **changes: Any) -> ParameterFile:
    """A file whose coefficients rest on tables, among inputs with a hash each."""
    content = made(VALUES, **changes).model_dump(mode="json")
    for c in content["coefficients"]:
        c.update(table=on.get(c["symbol"]), campaign=campaign)
    content["provenance"]["inputs"] = [{"name": n, "sha256": h * 64} for n, h in inputs.items()]
    return ParameterFile.model_validate(content)


INPUTS = {"plan.toml": "a", "published.toml": "b", "tow/campaign.toml": "c", "tow/drift.csv": "d", "tow/arm.csv": "e"}
TABLES = {"Yv'": "tow/drift.csv", "Nv'": "tow/drift.csv", "Yr'": "tow/arm.csv", "Nr'": "tow/arm.csv, tow/drift.csv"}


def test_only_tables_behind_both_values_are_named() -> None:
    other = {"Yv'": "tank/sway.csv", "Nv'": "tow/arm.csv", "Yr'": "tow/arm.csv", "Nr'": "tow/arm.csv"}
    found = compare(resting(TABLES, INPUTS), resting(other, {**INPUTS, "tank/sway.csv": "d"}, name="second"))
    assert {r.symbol: r.shared for r in found.rows} == {
        "Yv'": ("tow/drift.csv",), "Nv'": (), "Yr'": ("tow/arm.csv",), "Nr'": ("tow/arm.csv",),
    }  # fmt: skip
    assert found.statements == (
        "tow/drift.csv is behind Yv' of both files: their errors are not independent",
        "tow/arm.csv is behind Yr'; Nr' of both files: their errors are not independent",
    )
    assert [r.reason for r in found.rows][:2] == ["both rest on tow/drift.csv", ""]


def test_inputs_of_the_study_that_no_value_rests_on_are_not_named() -> None:
    first, second = dict.fromkeys(VALUES, "tow/drift.csv"), dict.fromkeys(VALUES, "tow/arm.csv")
    assert compare(resting(first, INPUTS), resting(second, INPUTS)).statements == ()
    values = dict.fromkeys(VALUES, (None, None))
    both = resting(first, INPUTS), ParameterFile.model_validate(made(values).model_dump())
    assert compare(*both).statements == ()


def test_without_a_table_the_campaign_counts_but_not_its_declaration() -> None:
    ours = resting({}, INPUTS)
    assert {r.shared for r in compare(ours, ours).rows} == {("tow/arm.csv", "tow/drift.csv")}
    assert {r.shared for r in compare(ours, resting({}, INPUTS, campaign="other")).rows} == {()}


def test_a_moved_coefficient_rests_on_those_it_is_made_of() -> None:
    tables = {"Yv'": "tow/drift.csv", "Nv'": "tow/arm.csv", "Yr'": "tow/arm.csv", "Nr'": "tow/arm.csv"}
    ours = resting(dict.fromkeys(VALUES, "tow/drift.csv"), INPUTS)
    point = {"point": [-1.5, 0.0, 0.0], "datum": "nose"}
    assert [bool(r.shared) for r in compare(ours, resting(tables, INPUTS)).rows] == [True, False, False, False]
    found = compare(ours, resting(tables, INPUTS, reference_point=point))
    assert [bool(r.shared) for r in found.rows] == [True, True, True, True]


def test_the_command_prints_a_table_and_exits_zero_even_when_apart(
    coeflab: Run, write: Callable[[ParameterFile, str], Path]
) -> None:
    a = write(made(VALUES), "a.json")
    b = write(made(changed(Yv=(-0.05, 0.001)), name="second", body="other"), "b.json")
    done = coeflab("compare", a, b)
    assert done.returncode == 0, done.stderr
    assert "first first, second second" in flat(done.stdout)
    assert "1 apart" in flat(done.stdout)
    assert "different bodies" in flat(done.stdout)
    content = json.loads(coeflab("compare", a, b, "--json").stdout)
    assert content["same_body"] is False
    assert [c["verdict"] for c in content["coefficients"]] == ["apart", "within", "within", "within"]
    assert content["coefficients"][0]["difference"] == pytest.approx(-0.022)


def test_files_of_one_name_are_called_by_their_paths(coeflab: Run, write: Callable[[ParameterFile, str], Path]) -> None:
    point = {"point": [-1.5, 0.0, 0.0], "datum": "nose"}
    one, other = write(made(VALUES), "old.json"), write(made(VALUES, reference_point=point), "new.json")
    said = flat(coeflab("compare", one.name, other.name, cwd=one.parent).stdout)
    assert "first old.json, second new.json" in said
    assert "new.json moved to the reference point of old.json" in said
    named = write(made(VALUES, name="second"), "named.json")
    assert "first first, second second" in flat(coeflab("compare", one.name, named.name, cwd=one.parent).stdout)


def test_files_of_one_body_that_are_apart_exit_one(coeflab: Run, write: Callable[[ParameterFile, str], Path]) -> None:
    a = write(made(VALUES), "a.json")
    assert coeflab("compare", a, write(made(VALUES, name="second"), "b.json")).returncode == 0
    assert coeflab("compare", a, write(made(changed(Yv=(-0.05, 0.001)), name="third"), "c.json")).returncode == 1


@pytest.mark.parametrize("content", [None, b"", b"{", b'{"schema_version": "9"}', b"[1, 2]"])
def test_bad_input_exits_two_with_one_message(
    coeflab: Run, tmp_path: Path, write: Callable[[ParameterFile, str], Path], content: bytes | None
) -> None:
    good, bad = write(made(VALUES), "a.json"), tmp_path / "bad.json"
    if content is not None:
        bad.write_bytes(content)
    for pair in ((good, bad), (bad, good)):
        done = coeflab("compare", *pair)
        assert done.returncode == 2
        assert done.stdout == ""
        assert done.stderr.startswith("error: ")
        assert "bad.json" in done.stderr
        assert "Traceback" not in done.stderr


def test_a_file_that_was_written_is_within_itself(write: Callable[[ParameterFile, str], Path]) -> None:
    p = read_parameter_file(write(made(VALUES), "a.json"))
    assert {r.verdict for r in compare(p, p).rows} == {Verdict.WITHIN}
