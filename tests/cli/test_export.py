"""``coeflab export`` as a real process."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.vehicle.parameter_file import read_parameter_file
from tests.cli.conftest import Run, flat
from tests.vehicle.test_inertia import accelerating

PARAMS = Path(__file__).parents[1] / "data" / "parameters_1_2.json"


def test_a_target_that_holds_everything_needs_no_word(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("export", PARAMS, "--to", "mss", "--out", tmp_path / "m", "--strict")
    assert done.returncode == 0, done.stderr
    written = {p.suffix for p in (tmp_path / "m").iterdir()}
    assert written == {".m", ".txt"}
    (report,) = (tmp_path / "m").glob("*.loss.txt")
    assert "Lossless." in report.read_text()


def test_a_loss_is_shown_and_must_be_accepted(coeflab: Run, tmp_path: Path) -> None:
    out = tmp_path / "g"
    refused = coeflab("export", PARAMS, "--to", "gazebo", "--out", out)
    assert refused.returncode == 2
    assert "--accept-loss" in refused.stderr
    assert "gazebo does not hold all of" in flat(refused.stdout)
    assert len(refused.stdout.splitlines()) <= 7
    assert "astern, broadside and at rest" in flat(refused.stdout)
    whole = coeflab("export", PARAMS, "--to", "gazebo", "--out", out, "--wide")
    assert "Force law of gazebo against the parameter file" in flat(whole.stdout)
    assert not out.exists()
    strict = coeflab("export", PARAMS, "--to", "gazebo", "--out", out, "--accept-loss", "--strict")
    assert strict.returncode == 2
    assert not out.exists()
    done = coeflab("export", PARAMS, "--to", "gazebo", "--out", out, "--accept-loss")
    assert done.returncode == 0, done.stderr
    first = {p.name: p.read_bytes() for p in out.iterdir()}
    assert any(name.endswith(".sdf") for name in first)
    coeflab("export", PARAMS, "--to", "gazebo", "--out", out, "--accept-loss")
    assert {p.name: p.read_bytes() for p in out.iterdir()} == first


def test_json_says_what_is_lost_even_when_it_is_refused(coeflab: Run, tmp_path: Path) -> None:
    refused = coeflab("export", PARAMS, "--to", "gazebo", "--out", tmp_path / "g", "--json")
    assert refused.returncode == 2
    said = json.loads(refused.stdout)
    assert said["files"] == []
    assert said["lossless"] is False
    assert max(said["worst_difference"]) > 0.0
    assert not (tmp_path / "g").exists()


def test_an_unknown_target_and_a_file_that_is_none(coeflab: Run, tmp_path: Path) -> None:
    wrong = coeflab("export", PARAMS, "--to", "gazeboo")
    assert wrong.returncode == 2
    assert "gazebo" in wrong.stderr
    (tmp_path / "p.json").write_text("{}")
    assert coeflab("export", tmp_path / "p.json", "--to", "mss").returncode == 2


def changed(folder: Path, **keys: object) -> Path:
    """The sample file with some keys changed; what holds a mapping is changed within."""
    content = json.loads(PARAMS.read_text())
    for key, value in keys.items():
        content[key] = {**content[key], **value} if isinstance(value, dict) else value
    path = folder / "changed.parameters.json"
    path.write_text(json.dumps(content))
    return path


def test_without_a_target_they_are_listed(coeflab: Run) -> None:
    done = coeflab("export", PARAMS)
    assert (done.returncode, done.stdout) == (2, "")
    assert '"--to": found no target; expected one of c, csv, fmi, gazebo' in flat(done.stderr)


def test_a_loss_in_short_has_no_reasons_and_no_impossible_bound(coeflab: Run) -> None:
    """REMUS 100 for MuJoCo: what is not held is named, why stands in the report; a huge difference is *more than*, not *up to >*."""
    done = coeflab("export", "remus100", "--to", "mujoco")
    first = flat(done.stdout.partition("Force law")[0])
    assert "no added inertia, " in first
    assert "MuJoCo has no force" not in first
    assert "up to >" not in first


def test_strict_refuses_the_added_mass_of_another_body(coeflab: Run, tmp_path: Path) -> None:
    file = changed(tmp_path, added_mass={"body": "another"})
    strict = coeflab("export", file, "--to", "mss", "--strict", "--accept-loss")
    assert strict.returncode == 2
    assert "mismatch: the added mass is that of another" in flat(strict.stdout)
    assert not list(tmp_path.glob("*.mss"))
    assert coeflab("export", file, "--to", "mss").returncode == 2
    accepted = coeflab("export", file, "--to", "mss", "--accept-loss")
    assert accepted.returncode == 0, accepted.stderr
    (report,) = tmp_path.glob("*.mss/*.loss.txt")
    assert "mismatch: the added mass is that of another" in report.read_text()


def test_a_mass_that_xdyn_needs_and_that_is_not_there_is_refused(coeflab: Run, tmp_path: Path) -> None:
    file = changed(tmp_path, mass=None)
    assert coeflab("export", file, "--to", "mss", "--out", tmp_path / "m", "--strict").returncode == 0
    for option in ("--strict", "--accept-loss"):
        refused = coeflab("export", file, "--to", "xdyn", "--out", tmp_path / "x", option)
        assert refused.returncode == 2
        assert "found no mass, mass.centre and mass.inertia_matrix" in flat(refused.stderr)
        assert not (tmp_path / "x").exists()


def test_a_name_that_leads_elsewhere_stays_in_the_folder(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    file = changed(tmp_path / "in", name="../../up/sin")
    for target in ("mss", "csv"):
        done = coeflab("export", file, "--to", target)
        assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["in"]
    written = sorted(p.relative_to(tmp_path / "in").as_posix() for p in (tmp_path / "in").rglob("*.*") if p.is_file())
    assert written == [
        "changed.parameters.json", "up_sin_46c498a5.csv/up_sin_46c498a5.coefficients.csv",
        "up_sin_46c498a5.csv/up_sin_46c498a5.table_1_Y.csv", "up_sin_46c498a5.mss/up_sin.m",
        "up_sin_46c498a5.mss/up_sin_46c498a5.mss.loss.txt",
    ]  # fmt: skip


def test_the_choice_of_accelerations_is_named(coeflab: Run, tmp_path: Path) -> None:
    file = tmp_path / "a.parameters.json"
    file.write_bytes(accelerating().to_json())
    for accelerations, lossless in (("measured", True), ("computed", False)):
        out = tmp_path / accelerations
        done = coeflab(
            "export", file, "--to", "xdyn", "--out", out, "--accept-loss", "--accelerations", accelerations, "--json"
        )
        assert done.returncode == 0, done.stderr
        said = json.loads(done.stdout)
        assert said["accelerations"]["used"] == accelerations
        assert said["lossless"] is lossless
        assert (max(said["accelerations_compared"]["worst_difference"]) > 0.01) is not lossless
        word = "accelerations: " if accelerations == "measured" else "accelerations computed, "
        assert f"# Inertia of the water: {word}" in (out / "file.yml").read_text()
    refused = coeflab("export", file, "--to", "xdyn", "--accelerations", "computed", "--strict")
    assert "/dt differs by up to" in refused.stderr


def flipped(folder: Path, *symbols: str) -> Path:
    """REMUS 100 with coefficients of the other sign."""
    file = read_parameter_file(Path("remus100"))
    changed = tuple(
        replace(c, value=-c.value, value_si=-c.value_si)
        if c.symbol.removesuffix("'") in symbols and c.value is not None and c.value_si is not None
        else c
        for c in file.coefficients
    )
    (folder / "flipped.json").write_bytes(file.model_copy(update={"coefficients": changed}).to_json())
    return folder / "flipped.json"


@pytest.mark.slow
def test_a_wrong_sign_in_the_file_is_said_by_what_uses_it(coeflab: Run, tmp_path: Path) -> None:
    path = flipped(tmp_path, "Yuv", "Nuv", "Zuw", "Muw")
    made = coeflab("export", path, "--to", "mss", "--out", tmp_path / "m", "--accept-loss")
    moved = coeflab("simulate", path, "--manoeuvre", "zigzag")
    for done in (made, moved):
        assert done.returncode == 1
        assert "Yuv': dY/dv = 44 N/(m/s) at 1.54 m/s" in flat(done.stdout)
    assert list((tmp_path / "m").glob("*.m"))
    told = json.loads(coeflab("export", path, "--to", "mss", "--out", tmp_path / "j", "--json").stdout)
    assert "Yuv'" in {f["what"] for f in told["findings"] if f["severity"] == "fail"}
    right = coeflab("simulate", "remus100", "--manoeuvre", "zigzag")
    assert "params check" not in right.stdout
    assert right.returncode == 0


def by_name(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_every_target_of_several_is_written(coeflab: Run, tmp_path: Path) -> None:
    """`--to xdyn --to mss` wrote the last alone; the files are those of one target at a time."""
    alone: dict[str, bytes] = {}
    for target in ("xdyn", "mss"):
        assert coeflab("export", "remus100", "--to", target, "--out", tmp_path / target).returncode == 0
        alone |= by_name(tmp_path / target)
    for words in (("--to", "xdyn", "--to", "mss"), ("--to", "xdyn,mss")):
        out = tmp_path / str(len(words))
        done = coeflab("export", "remus100", *words, "--out", out)
        assert (done.returncode, done.stderr) == (0, "")
        assert by_name(out) == alone
        assert "xdyn holds all of remus100." in done.stdout
        assert "mss holds all of remus100." in done.stdout
    said = json.loads(coeflab("export", "remus100", "--to", "xdyn,mss", "--out", tmp_path / "j", "--json").stdout)
    assert [one["target"] for one in said["exports"]] == ["xdyn", "mss"]
    assert len(said["files"]) == len(alone)


@pytest.mark.slow
def test_targets_with_the_same_names_have_folders(coeflab: Run, tmp_path: Path) -> None:
    both = ("export", "remus100", "--to", "gazebo,gazebo_plugin", "--out", tmp_path / "b", "--accept-loss")
    assert coeflab(*both).returncode == 0
    assert {name.partition("/")[0] for name in by_name(tmp_path / "b")} == {"gazebo", "gazebo_plugin"}
    one = ("export", "remus100", "--to", "gazebo", "--out", tmp_path / "g", "--accept-loss")
    assert coeflab(*one).returncode == 0
    assert by_name(tmp_path / "b" / "gazebo") == by_name(tmp_path / "g")


def test_one_refused_target_does_not_keep_the_others(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("export", "remus100", "--to", "gazebo,xdyn", "--out", tmp_path / "x")
    assert done.returncode == 1
    assert done.stderr.count("error: ") == 1
    assert "gazebo, a target that loses part of" in done.stderr
    assert {p.suffix for p in (tmp_path / "x").iterdir()} == {".yml", ".txt"}
    neither = coeflab("export", "remus100", "--to", "gazebo,mujoco", "--out", tmp_path / "n")
    assert neither.returncode == 2
    assert "gazebo, a target" in neither.stderr
    assert "mujoco, a target" in neither.stderr
    assert not (tmp_path / "n").exists()
    unknown = coeflab("export", "remus100", "--to", "xdyn,gazeboo", "--out", tmp_path / "u")
    assert unknown.returncode == 2
    assert not (tmp_path / "u").exists()
