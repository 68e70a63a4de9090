"""``coeflab params check``: any model file by its content, findings as a table, exit code 1 where one fails."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from coeflab.vehicle.schema_versions import SCHEMA_VERSION
from tests.cli.conftest import Run, flat

DATA = Path(__file__).parents[1] / "formats" / "data"
OWN = Path(__file__).parents[1] / "data" / "parameters_1_0.json"


@pytest.mark.parametrize(
    ("name", "kind"),
    [("lauv.urdf.xacro", "uuv_simulator"), ("rexrov.urdf", "uuv_simulator"), ("tethys_like.sdf", "gazebo"),
     ("nps_auv2.m", "mss")],
)  # fmt: skip
def test_formats_are_told_by_content(coeflab: Run, tmp_path: Path, name: str, kind: str) -> None:
    shutil.copy(DATA / name, tmp_path / "model.txt")
    done = coeflab("params", "check", "model.txt", "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["format"] == kind
    assert told["passed"] is True
    assert "Yv'" in told["coefficients"]
    assert {f["severity"] for f in told["findings"]} <= {"pass", "note", "warn"}


def test_findings_are_listed(coeflab: Run) -> None:
    done = coeflab("params", "check", DATA / "rexrov.urdf")
    assert done.returncode == 0
    assert "M_A" not in flat(done.stdout)  # 10.774 and 10.775 are one number
    assert "-74.82" in flat(done.stdout)


def test_a_failing_finding_is_exit_code_1(coeflab: Run, tmp_path: Path) -> None:
    text = (DATA / "lauv.urdf.xacro").read_text(encoding="utf-8")
    wrong = text.replace("0 -23 0 0 0 11.5", "0 23 0 0 0 11.5").replace("0 16 0 0 0 0", "0 -16 0 0 0 0")
    (tmp_path / "m.xacro").write_text(wrong, encoding="utf-8")
    done = coeflab("params", "check", "m.xacro")
    assert done.returncode == 1
    assert done.stderr == ""
    assert "M_A Yv" in flat(done.stdout)
    assert "It drives the motion that it should damp" in flat(done.stdout)
    told = json.loads(coeflab("params", "check", "m.xacro", "--json").stdout)
    assert told["passed"] is False
    assert [f["what"] for f in told["findings"] if f["severity"] == "fail"] == ["M_A Yv", "Yv'"]


def test_a_parameter_file_is_checked_too(coeflab: Run) -> None:
    done = coeflab("params", "check", OWN)
    assert done.returncode == 0, done.stderr
    assert "schema 1.0" in flat(done.stdout)
    assert "1 warn, 0 fail." in flat(done.stdout)


def test_a_later_minor_version_is_read_with_a_word(coeflab: Run, tmp_path: Path) -> None:
    content = {**json.loads(OWN.read_bytes()), "schema_version": "1.9", "tethers": None}
    (tmp_path / "p.json").write_text(json.dumps(content))
    done = coeflab("params", "check", "p.json")
    assert done.returncode == 0, done.stderr
    assert f"schema 1.9 is later than {SCHEMA_VERSION}, which this release writes" in flat(done.stdout)
    (tmp_path / "p.json").write_text(json.dumps({**content, "tethers": [1]}))
    done = coeflab("params", "check", "p.json")
    assert done.returncode == 2
    assert '"tethers": found an unknown key in a file of schema_version 1.9' in done.stderr
    assert "Update coeflab" in done.stderr


def test_a_density_that_the_file_lacks(coeflab: Run, tmp_path: Path) -> None:
    text = (DATA / "tethys_like.sdf").read_text(encoding="utf-8").replace("uniform_fluid_density", "something")
    (tmp_path / "m.sdf").write_text(text, encoding="utf-8")
    stood_in = coeflab("params", "check", "m.sdf")
    assert stood_in.returncode == 0, stood_in.stderr
    assert "1000 kg/m^3 is assumed" in flat(stood_in.stdout)
    given = coeflab("params", "check", "m.sdf", "--density", "1020")
    assert "is assumed" not in flat(given.stdout)
    assert "1020" in flat(given.stdout)
    assert coeflab("params", "check", "m.sdf", "--density", "-1").returncode == 2


@pytest.mark.parametrize(
    "content",
    [
        '<!DOCTYPE a [<!ENTITY b "c">]><sdf version="1.9"/>', "<sdf version='1.9'/>", "<html/>", "hello", "", "\x00\x01",
        "<sdf" + "<a>" * 100_000, "[]",
    ],
    ids=range(8),
)  # fmt: skip
def test_what_cannot_be_read_is_one_error(coeflab: Run, tmp_path: Path, content: str) -> None:
    (tmp_path / "m.sdf").write_text(content, encoding="utf-8")
    done = coeflab("params", "check", "m.sdf")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "m.sdf" in done.stderr
    assert "Traceback" not in done.stderr
    assert len(done.stderr) < 1000


def test_the_schema_is_printed_as_a_page_and_as_json(coeflab: Run) -> None:
    page, schema = coeflab("params", "schema"), coeflab("params", "schema", "--json")
    assert (page.returncode, schema.returncode) == (0, 0)
    assert page.stdout == (Path(__file__).parents[2] / "docs" / "parameter_file.md").read_text(encoding="utf-8")
    assert json.loads(schema.stdout)["properties"]["added_mass"]["since"] == "1.2"


@pytest.mark.slow
@pytest.mark.parametrize("target", ["xdyn", "gazebo", "mss"])
def test_nothing_of_an_export_is_missing_in_its_list(coeflab: Run, tmp_path: Path, target: str) -> None:
    """xdyn and Gazebo came back without the added mass and the ten products that are just its own."""
    done = coeflab("export", "remus100", "--to", target, "--out", tmp_path / "out", "--accept-loss")
    assert done.returncode == 0, done.stderr
    (model,) = [f for f in (tmp_path / "out").glob("*remus100.*") if f.suffix in (".yml", ".sdf", ".m")]
    listed = json.loads(coeflab("params", "check", model, "--json").stdout)
    whole = {"".join(sorted(s.removesuffix("'"))) for s in (*listed["coefficients"], *listed["by_added_mass"])}
    wanted = (
        "Xwq Xqq Xvr Xrr Ywp Ypq Zvp Zrp Mvp Nwp Xudot Yvdot Yrdot Zwdot Zqdot Kpdot Mwdot Mqdot Nvdot Nrdot Nuv Muw"
    )
    assert {"".join(sorted(s)) for s in wanted.split()} <= whole
    if target != "mss":
        text = coeflab("params", "check", model).stdout
        assert "values are totals" in flat(text)
        assert "Yvdot'" in text
        assert "-35.50" in text


@pytest.mark.parametrize("command", [("export", "urv_puma", "--to", "mss"), ("params", "check", "urv_puma")])
def test_a_vehicle_with_an_arm_has_no_parameter_file(coeflab: Run, command: tuple[str, ...]) -> None:
    done = coeflab(*command)
    assert done.returncode == 2
    assert "a vehicle with an arm, which has no parameter file" in flat(done.stderr)
    assert "coeflab derive urv_puma --to c" in flat(done.stderr)


NEW = (
    "params",
    "new",
    "own",
    "--about",
    "cg",
    "--length",
    "2 m",
    "--speed",
    "1",
    "--density",
    "1000",
    "--mass",
    "40 kg",
)


def test_a_file_of_ones_own_numbers(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab(*NEW, "--set", "Yv'=-0.03 +- 0.003", "--set", "Nv=-48 Nm/(m/s)", "--out", "files")
    assert done.returncode == 0, done.stderr
    assert "-60.00" in done.stdout
    path = tmp_path / "files" / "own.parameters.json"
    content = json.loads(path.read_bytes())
    assert [(c["value"], c["status"], c["origin"]) for c in content["coefficients"]] == [
        (-0.03, "stated", "stated"), (-0.012, "stated", "stated"),
    ]  # fmt: skip
    assert content["mass"]["mass_prime"] == 0.01
    assert coeflab("params", "check", path).returncode == 0
    before = path.read_bytes()
    again = coeflab(*NEW, "--set", "Yv'=-0.04", "--out", "files")
    assert again.returncode == 2
    assert "exists" in again.stderr
    assert path.read_bytes() == before


def test_a_wrong_number_writes_nothing(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab(*NEW, "--set", "Yv'=-0.03", "--set", "Y_r=1")
    assert done.returncode == 2
    assert "Did you mean Yr'?" in done.stderr
    assert not list(tmp_path.iterdir())


def test_one_number_of_ones_own_goes_into_a_file(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("merge", "remus100", "--set", "Nr|r|'=-0.05 +- 0.005", "--out", "merged")
    assert done.returncode == 0, done.stderr
    assert "1 number from --set" in done.stdout
    content = json.loads((tmp_path / "merged" / "remus100_merged.parameters.json").read_bytes())
    (changed,) = (c for c in content["coefficients"] if c["origin"] == "stated")
    assert (changed["symbol"], changed["value"], changed["u95"]) == ("Nr|r|'", -0.05, 0.005)


@pytest.mark.parametrize(
    ("words", "said"),
    [((), "nothing to merge"), (("campaign", "--set", "Yv'=1"), "OTHER and --set together"),
     (("--set", "Yv'=-0.03", "--set", "Yv'=1 N"), "no unit")],
)  # fmt: skip
def test_what_cannot_be_merged_writes_nothing(coeflab: Run, tmp_path: Path, words: tuple[str, ...], said: str) -> None:
    done = coeflab("merge", "remus100", *words, "--out", "merged")
    assert done.returncode == 2
    assert said in done.stderr
    assert not (tmp_path / "merged").exists()
