"""``coeflab vehicle`` and ``coeflab merge`` as a user types them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from coeflab.core.files import shipped
from tests.cli.conftest import Run, flat

MESH = shipped("geometry") / "huuv_mesh"
BODY = "finned_spheroid"
QUICK = ("--method", "strip:lamb")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory, forks: object) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("vehicle")
    arguments = ("vehicle", BODY, *QUICK, "--mass", "22 kg", "--out", "made", "--to", "xdyn", "--accept-loss")
    done = forks.run(arguments, folder)  # type: ignore[attr-defined]
    assert done.returncode == 0, done.stderr
    return folder / "made", done.stdout


@pytest.mark.slow
def test_the_answer_comes_first_and_says_estimate(made: tuple[Path, str]) -> None:
    folder, printed = made
    lines = printed.splitlines()
    assert all(len(line) <= 80 for line in lines)
    first = flat(printed.partition("\n\n")[0])
    assert "22 kg in" in first
    assert "estimates from the shape" in first
    assert "tactical diameter" in first
    assert first.endswith("estimate.")
    assert "too heavy" in flat(printed)
    assert "no thruster: write [[thruster]]" in flat(printed)
    assert "not stated: --cg, --inertia" in flat(printed)
    assert "xdyn holds all of finned_spheroid" in flat(printed)
    assert "% of the length from the bow" in flat(printed)
    assert (folder / "report.html").is_file()
    assert list(folder.glob("*.xdyn/*.yml"))


@pytest.mark.slow
def test_the_parameter_file_is_sound(coeflab: Run, made: tuple[Path, str]) -> None:
    done = coeflab("params", "check", made[0] / f"{BODY}.parameters.json")
    assert done.returncode == 0, done.stdout
    assert "estimate" in done.stdout


@pytest.mark.slow
def test_a_campaign_replaces_what_it_gives(coeflab: Run, made: tuple[Path, str], tmp_path: Path) -> None:
    own = made[0] / f"{BODY}.parameters.json"
    content = json.loads(own.read_bytes())
    kept = [c for c in content["coefficients"] if c["symbol"] in ("Yv'", "Nv'")]
    rows = [{**c, "value": 1.1 * c["value"], "value_si": 1.1 * c["value_si"], "u95": abs(0.01 * c["value"]), "status": "ok",
             "origin": "fit", "campaign": "tank"} for c in kept]  # fmt: skip
    other = {**content, "name": "tank", "coefficients": rows, "covariance": {"symbols": [], "matrix": []}}
    (tmp_path / "tank.json").write_text(json.dumps(other))
    done = coeflab("merge", own, "tank.json", "--out", "merged", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert [r["symbol"] for r in found["replaced"]] == ["Yv'", "Nv'"]
    assert "Yv'" not in found["estimates"]
    assert "Nr'" in found["estimates"]
    assert (tmp_path / "merged" / "report.html").is_file()
    done = coeflab("merge", own, own)
    assert done.returncode == 2
    assert "none of an estimate" in flat(done.stderr)


@pytest.mark.slow
def test_simplified_mesh_and_table_make_a_vehicle_that_moves_without_a_hand_edit(coeflab: Run, tmp_path: Path) -> None:
    """One command: estimates, a fitted campaign in their place, a parameter file, first manoeuvres, a report."""
    done = coeflab("vehicle", "huuv_mesh_simplified", "--speed", "1 m/s", "--method", "primitives", "--campaign",
                   "huuv_synthetic", "--out", "made", "--json")  # fmt: skip
    assert done.returncode == 0, done.stderr
    merged = json.loads(done.stdout)["merged"]
    by_symbol = {r["symbol"]: r["after"] for r in merged["replaced"]}
    assert by_symbol["Yv'"]["campaign"] == "huuv_synthetic"
    assert {"Yr'", "Nr'", "Mq'"} <= set(merged["estimates"])
    folder = tmp_path / "made" / "merged"
    assert (folder / "report.html").is_file()
    moved = coeflab("simulate", folder / "huuv_mesh_simplified_merged.parameters.json", "--manoeuvre", "straight_run")
    assert moved.returncode == 0, moved.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("huuv_mesh_simplified", "--campaign", "nowhere"), "nowhere"),
        (("{mesh}", "--axes", "FRD"), '"--unit"'),
        (("{mesh}", "--unit", "m"), '"--axes"'),
        ((BODY, "--mass", "heavy"), '"--mass"'),
        ((BODY, "--mass", "-1"), "above zero"),
        ((BODY, "--cg", "1,2"), "three numbers"),
        ((BODY, "--to", "simulink"), "simulink"),
        (("nowhere",), "nowhere"),
    ],
)
def test_wrong_input_is_one_error(coeflab: Run, tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    mesh = next(p for p in sorted(MESH.iterdir()) if p.suffix in (".stl", ".obj", ".ply", ".glb"))
    done = coeflab("vehicle", *(a.format(mesh=mesh) for a in arguments))
    assert done.returncode == 2
    assert said in flat(done.stderr)
    assert done.stderr.startswith("error: ")
    assert not list(tmp_path.iterdir())
