"""What a new user types, and what comes back."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
import trimesh

from coeflab.law.coefficient import COVERS
from tests.cli.conftest import Run, Validated, files, flat
from tests.cli.survey import too_long

SIX = {"Yv'", "Nv'", "Zw'", "Mw'", "Yr'", "Nr'"}
CONTRACT = {
    "symbol", "value", "u95", "unit", "table", "campaign", "body", "scaling", "estimator", "window", "n_points",
    "status", "parts", "assumed",
}  # fmt: skip


@pytest.mark.slow
def test_validation_prints_the_verdict(validated: Validated) -> None:
    folder, done, _, again = validated
    content = json.loads(again.stdout)
    judged = [c["passed"] for c in content["comparisons"] if c["passed"] is not None]
    assert done.returncode == (0 if all(judged) else 1), done.stderr
    assert done.stderr == ""
    assert too_long(done.stdout) == []
    assert done.stdout.count("\n") <= 60
    assert all(judged)
    assert "SUBOFF: our fits to the data of experiment 1990 reproduce its Yv', Nv', Zw' and Mw' within U95" in flat(
        done.stdout
    )
    for column in ("experiment", "publ. CFD", "PMM CFD"):
        assert column in done.stdout
    assert re.search(r"\n  Yr' +no result ", done.stdout)
    assert "Yr', Nr': our CFD suboff_tow_aff8, of body suboff_aff8; no verdict." in flat(done.stdout)
    written = set(files(folder / "reports" / "suboff"))
    assert {"report.html", "suboff_fully_appended.parameters.json", "suboff_bare_hull.coefficients.csv"} <= written
    assert f"({len(written)} of {len(written)} files changed)" in flat(done.stdout)
    for target, ending in (("mss", "m"), ("xdyn", "yml"), ("gazebo", "sdf")):
        place = f"suboff_bare_hull.{target}/suboff_bare_hull"
        assert {f"{place}.{ending}", f"{place}.{target}.loss.txt"} <= written


@pytest.mark.slow
def test_a_second_run_changes_no_byte(validated: Validated) -> None:
    folder, _, before, again = validated
    assert again.returncode == validated[1].returncode
    assert before
    assert files(folder) == before


@pytest.mark.slow
def test_json_is_one_object_that_keeps_the_contract(
    validated: Validated,
) -> None:
    content = json.loads(validated[3].stdout)
    assert content["passed"] is all(c["passed"] is not False for c in content["comparisons"])
    for c in content["coefficients"]:
        assert set(c) == CONTRACT
        assert c["symbol"].endswith("'")
        assert set(c["parts"]) == {"random", "model_form", "window", "input"}
        assert (c["value"] is None) == (c["status"] in ("no_table", "too_few_points", "not_determined"))
    assert {c["symbol"] for c in content["coefficients"]} >= SIX
    by = {(c["symbol"], c["campaign"]): c for c in content["coefficients"]}
    yv = by["Yv'", "suboff_roddy_2"]
    assert yv["unit"] == "1"
    assert yv["u95"] == pytest.approx((yv["parts"]["random"] ** 2 + yv["parts"]["model_form"] ** 2) ** 0.5)
    assert -0.32 < yv["window"][0] < 0 < yv["window"][1] < 0.32
    assert by["Yr'", "suboff_roddy_2, suboff_roddy_1"]["status"] == "no_table"
    assert by["Yr'", "suboff_cfd_barehull"]["value"] > 0


def test_template_runs_as_it_stands_and_recovers_what_was_planted(coeflab: Run, tmp_path: Path) -> None:
    assert coeflab("new", "mine").returncode == 0
    done = coeflab("run", "mine/plan.toml", "--json")
    assert done.returncode == 0, done.stderr
    found = {c["symbol"]: c for c in json.loads(done.stdout)["coefficients"]}
    for symbol, planted in {"Yv'": -0.030, "Nv'": -0.010, "Yr'": 0.006, "Nr'": -0.005, "X0'": -0.0025}.items():
        assert abs(found[symbol]["value"] - planted) <= found[symbol]["u95"], symbol
    assert "(0 of " in coeflab("run", "mine/plan.toml").stdout
    assert coeflab("new", "mine").returncode == 2
    assert coeflab("params", "check", "reports/my_study/my_vehicle.parameters.json").returncode == 0


def test_fit_shows_the_slope_first_and_other_forms_after_it(coeflab: Run) -> None:
    done = coeflab("fit", "suboff_roddy_2", "--symbol", "Yv'")
    assert done.returncode == 0
    assert done.stdout.startswith("Yv' = -0.02")
    assert f"(U95; covers {COVERS})" in " ".join(done.stdout.split())
    assert len(done.stdout.splitlines()) < 25
    assert "Nv'" not in done.stdout
    assert (
        coeflab("fit", "suboff_roddy_2", "--symbol", "Yv'", "--strict").returncode == 0
    )  # no warning that is not shown
    for text in ("Other forms for Yv'", "Yv' by largest setting", "doubtful"):
        assert text in flat(done.stdout)


def test_other_forms_are_shown_where_none_can_be_tested(coeflab: Run, tmp_path: Path) -> None:
    """A sweep without a repeated setting has no scatter of its own: p is a dash, and the forms stand there all the same."""
    coeflab("new", "mine")
    file = tmp_path / "mine/campaign/drift.csv"
    lines = file.read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if "beta [deg]" in line)
    at = lines[head].split(",").index("beta [deg]")
    first = {line.split(",")[at]: line for line in reversed(lines[head + 1 :])}
    file.write_text("\n".join([*lines[: head + 1], *reversed(first.values())]) + "\n")
    said = flat(coeflab("fit", "mine/campaign/drift.csv", "--symbol", "Yv").stdout)
    assert "Other forms for Yv'" in said
    assert "Not tested (p): no setting is repeated" in said


def test_fit_on_another_length_scales_by_its_powers(coeflab: Run) -> None:
    lbp = json.loads(coeflab("fit", "suboff_roddy_2", "--json").stdout)["coefficients"]
    loa = json.loads(
        coeflab("fit", "suboff_roddy_2", "--json", "--length", "14.2917 ft", "--length-name", "LOA").stdout
    )["coefficients"]
    ratio = 14.2917 / 13.9792
    assert loa[0]["symbol"] == "Yv'"
    assert loa[0]["value"] == pytest.approx(lbp[0]["value"] / ratio**2, rel=1e-12)
    assert loa[1]["value"] == pytest.approx(lbp[1]["value"] / ratio**3, rel=1e-12)
    assert loa[0]["scaling"].startswith("LOA")


def test_inspect_and_formats(coeflab: Run) -> None:
    assert "excluded, grid B" in coeflab("inspect", "suboff_cfd_barehull").stdout
    assert "slope_at_origin" in coeflab("formats").stdout
    assert json.loads(coeflab("formats", "--json").stdout)["plugins"]
    assert json.loads(coeflab("inspect", "suboff_roddy_1", "--json").stdout)["tables"][0]["rows"] == 64


def test_strict_turns_a_warning_into_exit_code_1(coeflab: Run, tmp_path: Path) -> None:
    """A decimal slip in one cell: said by inspect, exit code 0; with --strict 1."""
    coeflab("new", "study")
    table = tmp_path / "study" / "campaign" / "drift.csv"
    table.write_text(table.read_text().replace("11.7982,5.8252", "117.982,5.8252"))
    done = coeflab("inspect", "study/campaign")
    assert done.returncode == 0
    assert "my_campaign/drift.csv line 11" in flat(done.stdout)
    assert "without it" in flat(done.stdout)
    fitted = coeflab("fit", "study/campaign", "--strict", "--json")
    assert fitted.returncode == 1
    said = [c for c in json.loads(fitted.stdout)["checks"] if c["severity"] == "warn"]
    assert [c["subject"] for c in said if c["check"] == "data_gate"] == ["my_campaign/drift.csv line 11"]


def test_inspect_of_a_mesh_shows_its_checks(coeflab: Run, tmp_path: Path) -> None:
    """A bar of 2000 x 200 x 100 mm, off its origin: volume, centre in FRD, areas, inertia, and that it is sound."""
    bar = trimesh.creation.box(extents=(2000.0, 200.0, 100.0))
    bar.apply_translation([100.0, 20.0, 30.0])
    bar.export(tmp_path / "bar.stl")
    asked = ("inspect", tmp_path / "bar.stl", "--unit", "mm", "--axes", "FLU")
    done = coeflab(*asked)
    assert (done.returncode, done.stderr) == (0, "")
    for words in ("0.0400000", "0.1000 -0.0200 -0.0300", "1.2400", "the mesh of 12 faces is closed, wound outward"):
        assert words in flat(done.stdout)
    assert "2 x 0.2 x 0.1 m along x forward" in flat(done.stdout)
    (found,) = json.loads(coeflab(*asked, "--density", "500", "--json").stdout)["configurations"]
    assert found["projected_areas"] == pytest.approx([0.02, 0.2, 0.4], rel=1e-6)
    assert found["displaced_inertia"][0][0] == pytest.approx(20.0 * (0.04 + 0.01) / 12.0, rel=1e-6)
    bare = coeflab("inspect", tmp_path / "bar.stl")
    assert bare.returncode == 0
    assert "--unit mm --axes FLU" in flat(bare.stdout)


def test_inspect_of_a_mesh_that_is_not_closed(coeflab: Run, tmp_path: Path) -> None:
    bar = trimesh.creation.box(extents=(2.0, 0.2, 0.1))
    trimesh.Trimesh(bar.vertices, bar.faces[1:]).export(tmp_path / "open.stl")
    done = coeflab("inspect", tmp_path / "open.stl", "--unit", "m", "--axes", "FLU")
    assert (done.returncode, done.stdout) == (2, "")
    assert "open.stl" in done.stderr
    assert "campaign.toml" not in done.stderr
    bar.invert()
    bar.export(tmp_path / "inward.stl")
    asked = ("inspect", tmp_path / "inward.stl", "--unit", "m", "--axes", "FLU")
    assert coeflab(*asked).returncode == 2
    assert "by_mesh" in coeflab(*asked, "--repair").stdout


def test_inspect_of_a_body_and_options_for_a_table(coeflab: Run) -> None:
    shown = coeflab("inspect", "remus100")
    assert "0.0316552" in flat(shown.stdout)
    assert "is closed" not in flat(shown.stdout)
    done = coeflab("inspect", "suboff_roddy_1", "--unit", "m")
    assert done.returncode == 2
    assert "a mesh file with them" in done.stderr


def test_completion_is_offered(coeflab: Run) -> None:
    assert "--install-completion" in coeflab("--help").stdout


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (("export", "remus100", "--to", "mss", "--out", "a", "--out", "b"), "--out"),
        (("trim", "remus100", "--speed", "1", "--speed=2"), "--speed"),
        (("simulate", "remus100", "--rudder", "10", "--rudder", "20"), "--rudder"),
        (("simulate", "remus100", "--manoeuvre", "zigzag", "--manoeuvre", "spiral"), "--manoeuvre"),
        (("params", "check", "remus100", "--density", "1000", "--density", "1025"), "--density"),
        (("derive", "urv_puma", "--symbols", "--to", "c", "--numbers"), "--symbols"),
    ],
)
def test_an_option_given_twice_is_refused_where_only_the_last_would_count(
    coeflab: Run, tmp_path: Path, words: tuple[str, ...], option: str
) -> None:
    done = coeflab(*words, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("error: ") == 1
    assert f"{option} given twice" in done.stderr
    assert not list(tmp_path.iterdir())


def test_options_that_repeat_and_switches_do(coeflab: Run) -> None:
    once = coeflab("trim", "remus100", "--speed", "1", "--commands", "dr=0", "--commands", "ds=0", "--json", "--json")
    assert once.returncode == 0, once.stderr
