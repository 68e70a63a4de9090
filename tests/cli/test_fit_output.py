"""What ``coeflab fit`` prints and draws on demand, and where options are explained."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.cli.conftest import Run, flat


def test_diagnostics_are_printed_on_demand(coeflab: Run) -> None:
    polynomial = ("fit", "suboff_roddy_2", "--fit", "polynomial", "--variable", "v", "--responses", "Y")
    without = coeflab(*polynomial, "--wide").stdout
    done = coeflab(*polynomial, "--diagnostics", "--wide")
    assert done.returncode == 0, done.stderr
    for text in (
        "Diagnostics of the fitted models",
        "Most influential points",
        "Correlations",
        "PRESS",
        "predicted R2",
    ):
        assert text in flat(done.stdout)
    assert "Most influential points" not in without
    assert "v' -0.310 .. 0.232" in without


def test_many_terms_show_only_the_close_pairs(coeflab: Run) -> None:
    done = coeflab("fit", "huuv_synthetic", "--fit", "surface", "--responses", "C_D", "--diagnostics", "--wide")
    assert "pairs lie beyond 0.9" in flat(done.stdout)
    assert "alpha -25.0 .. 25.0 deg" in flat(done.stdout)


def test_a_figure_is_one_file_with_equal_bytes(coeflab: Run, tmp_path: Path) -> None:
    call = ("fit", "huuv_synthetic", "--fit", "surface", "--responses", "C_D", "--figure", "out.svg")
    done = coeflab(*call)
    assert done.returncode == 0, done.stderr
    assert "out.svg" in flat(done.stdout)
    first = (tmp_path / "out.svg").read_bytes()
    assert len(ET.fromstring(first).findall("{http://www.w3.org/2000/svg}svg")) == 3
    coeflab(*call)
    assert (tmp_path / "out.svg").read_bytes() == first


def test_slopes_of_an_arm_about_another_point_say_what_their_move_lacks(coeflab: Run, tmp_path: Path) -> None:
    assert coeflab("new", "mine").returncode == 0
    campaign = tmp_path / "mine" / "campaign"
    text = (campaign / "campaign.toml").read_text()
    stated = "arm_point = [-0.80, 0.0, 0.0]"
    assert stated in text
    head, drift, arm = text.partition("[[table]]")[0], *text.split("[[table]]")[1:]
    assert "Primed by LOA = 1.6 m, about x = -0.8 m from nose." in flat(coeflab("fit", "mine/campaign").stdout)
    elsewhere = arm.replace(stated, "arm_point = [-0.30, 0.0, 0.0]")
    (campaign / "campaign.toml").write_text(f"{head}[[table]]{elsewhere}")
    said = flat(coeflab("fit", "mine/campaign").stdout)
    assert "x = -0.3 m from nose, 0.5 m ahead of the study's point" in said
    assert "a move takes its Yv' and Nv'" in said
    (campaign / "campaign.toml").write_text(f"{head}[[table]]{drift}[[table]]{elsewhere}")
    assert "a move takes" not in flat(coeflab("fit", "mine/campaign").stdout)
    (campaign / "campaign.toml").write_text(f"{head}[[table]]{arm.replace(stated, '')}")
    said = flat(coeflab("fit", "mine/campaign").stdout)
    assert "U and drift are taken to hold at the reference point, (-0.8, 0, 0) m" in said


def test_a_reading_that_the_slope_leaves_out_is_left_out_of_the_law_and_named(coeflab: Run, tmp_path: Path) -> None:
    assert coeflab("new", "mine").returncode == 0
    file = tmp_path / "mine" / "campaign" / "drift.csv"
    file.write_text(file.read_text().replace("10,6,-12.7208,18.9707,", "10,6,-12.7208,-18.9707,"))
    checks = json.loads(coeflab("run", "mine/plan.toml", "--json").stdout)["checks"]
    assert not [c for c in checks if c["severity"] == "fail"]
    assert [c["subject"] for c in checks if c["severity"] == "warn"] == ["my_campaign/drift.csv line 12"]
    (law,) = [c for c in checks if c["subject"] == "my_vehicle Y my_campaign/drift.csv"]
    assert law["comment"].startswith("10 is left out of Yv' (data gate), and of the law.")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("huuv_synthetic", "--fit", "surface", "--figure", "out.gif"), "ends in .svg"),
        (("suboff_roddy_2", "--symbol", "Yw", "--figure", "out.svg"), "no sweep"),
        ((), "campaign folder"),
        (("huuv_synthetic", "--fit", "surface", "--degre", "3"), "`coeflab formats surface` explains every option"),
        (("huuv_synthetic", "--fit", "surface", "--area", "3 kg", "--area-name", "frontal"), "unit of area"),
    ],
)
def test_wrong_calls_write_nothing(coeflab: Run, tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    done = coeflab("fit", *arguments)
    assert done.returncode == 2
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_an_area_with_its_unit_is_that_in_si(coeflab: Run) -> None:
    def drag(area: str) -> object:
        done = coeflab("fit", "huuv_synthetic", "--fit", "surface", "--responses", "C_D", "--area", area,
                       "--area-name", "frontal", "--json")  # fmt: skip
        return json.loads(done.stdout)["models"][0]["coefficients"]

    assert drag("0.04") == drag("0.04 m^2")


def test_options_are_explained(coeflab: Run) -> None:
    by_fit = coeflab("fit", "--fit", "surface", "--help-options", "--wide").stdout
    by_name = coeflab("formats", "surface", "--wide").stdout
    assert "Options of surface" in by_fit
    assert by_fit.strip() in by_name
    for text in ("degree", "whole number, 1 to 8", "refuse, clamp, taper", "[table.options.surface]"):
        assert text in by_fit
    every = coeflab("formats", "fits").stdout
    assert "Options of manoeuvring_model" in every
    assert "openfoam" not in every
    found = json.loads(coeflab("formats", "polynomial", "--json").stdout)["plugins"]
    assert found[0]["options"][2] == {
        "name": "degree", "takes": "whole number, 0 to 20", "default": "3", "meaning": "The highest power.",
    }  # fmt: skip
    wrong = coeflab("formats", "sufrace")
    assert wrong.returncode == 2
    assert "Did you mean surface?" in wrong.stderr


def test_symbols_are_fitted_by_name_and_next_runs_have_their_own_command(coeflab: Run) -> None:
    only = json.loads(coeflab("fit", "suboff_roddy_3", "--symbol", "Nv", "--symbol", "Kv", "--json").stdout)
    assert [c["symbol"] for c in only["coefficients"]] == ["Nv'", "Kv'"]
    misspelt = coeflab("fit", "suboff_roddy_3", "--symbol", "nv")
    assert misspelt.returncode == 2
    assert "Did you mean Nv?" in misspelt.stderr
    gone = coeflab("fit", "suboff_roddy_3", "--next", "2")
    assert (gone.returncode, "coeflab next" in gone.stderr) == (2, True)
