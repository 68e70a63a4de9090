"""``coeflab vehicle`` and ``coeflab merge`` as a user types them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

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
    (model,) = folder.glob("*.xdyn/*.yml")
    assert f"made/{model.relative_to(folder)}" in printed  # what a simulator loads is named, with its path from here


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
    (tmp_path / "same.json").write_text(json.dumps({**other, "name": BODY}))
    done = coeflab("merge", own, "same.json", "--out", "again")
    assert "2 numbers from same.json" in flat(done.stdout)  # a tow bears the name of its body
    done = coeflab("merge", own, own)
    assert done.returncode == 2
    assert f"estimates only in {BODY}, nothing to replace others with" in flat(done.stderr)
    assert "Give a campaign" in flat(done.stderr)


@pytest.mark.slow
def test_simplified_mesh_and_table_make_a_vehicle_that_moves_without_a_hand_edit(coeflab: Run, tmp_path: Path) -> None:
    """One command: estimates, a fitted campaign in their place, a parameter file, first manoeuvres, a report."""
    done = coeflab("vehicle", "huuv_mesh_simplified", "--speed", "1 m/s", "--method", "primitives", "--campaign",
                   "huuv_synthetic", "--to", "mujoco", "--accept-loss", "--out", "made", "--json")  # fmt: skip
    assert done.returncode == 0, done.stderr
    merged = json.loads(done.stdout)["merged"]
    by_symbol = {r["symbol"]: r["after"] for r in merged["replaced"]}
    assert by_symbol["Yv'"]["campaign"] == "huuv_synthetic"
    assert {"Yr'", "Nr'", "Mq'"} <= set(merged["estimates"])
    folder = tmp_path / "made" / "merged"
    assert (folder / "report.html").is_file()
    file = folder / "huuv_mesh_simplified_merged.parameters.json"
    exported = coeflab("export", file, "--to", "mujoco", "--accept-loss", "--out", "again")
    assert exported.returncode == 0, exported.stderr
    (model,) = (tmp_path / "again").rglob("*.xml")  # of the merged file, not of the estimates
    (made,) = (tmp_path / "made").rglob("*.xml")
    assert made.parent.parent == folder
    assert made.read_bytes() == model.read_bytes()
    moved = coeflab("simulate", file, "--manoeuvre", "straight_run")
    assert moved.returncode == 0, moved.stderr


@pytest.mark.slow
def test_two_shells_that_overlap_are_united_and_it_is_said(coeflab: Run, tmp_path: Path) -> None:
    """A long hull and a ball that stands out of it."""
    hull = trimesh.creation.icosphere(3).apply_scale([0.5, 0.08, 0.08])
    ball = trimesh.creation.icosphere(2, 0.05).apply_translation([0.1, 0.0, 0.08])
    trimesh.util.concatenate([hull, ball]).export(tmp_path / "pair.stl")
    typed = ("vehicle", "pair.stl", "--unit", "m", "--axes", "FLU", *QUICK)
    done = coeflab(*typed)
    assert done.returncode == 2
    assert "2 shells of which 1 pairs overlap" in flat(done.stderr)
    done = coeflab(*typed, "--repair", "--out", "made")
    assert done.returncode == 0, done.stderr
    assert "repaired: 2 shells united" in flat(done.stdout)
    assert "at rest:" not in done.stdout  # centres in one point: nothing to hang from
    done = coeflab(*typed, "--repair", "--out", "again", "--json")
    found = json.loads(done.stdout)
    assert found["mesh"] == ["repaired: 2 shells united"]
    assert found["at_rest"] is None
    assert found["volume"] == pytest.approx(hull.union(ball).volume, rel=1e-6)


@pytest.mark.slow
def test_a_hole_is_filled_and_the_attitude_at_rest_is_said(coeflab: Run, tmp_path: Path) -> None:
    """The centre of gravity 10 mm ahead of that of buoyancy and 50 mm below hangs 11.3 deg bow down; 1 mm to starboard, over 1.1 deg."""
    hull = trimesh.creation.icosphere(3).apply_scale([0.5, 0.08, 0.08])
    around = np.any(hull.faces == 40, axis=1)
    trimesh.Trimesh(hull.vertices, hull.faces[~around]).export(tmp_path / "holed.stl")
    typed = ("vehicle", "holed.stl", "--unit", "m", "--axes", "FLU", *QUICK, "--fill", "--cg=0.01,0.001,0.05")
    done = coeflab(*typed, "--out", "made")
    assert done.returncode == 0, done.stderr
    assert "1 hole of up to 1% of the surface filled" in flat(done.stdout)
    assert "For a simulator: coeflab export made/holed.parameters.json --to TARGET" in flat(done.stdout)
    assert "at rest: pitch" in flat(done.stdout)
    done = coeflab(*typed, "--out", "again", "--json")
    found = json.loads(done.stdout)
    assert found["mesh"] == ["1 hole of up to 1% of the surface filled"]
    away = np.array(found["centre_of_gravity"]) - found["centre_of_buoyancy"]
    pitch, roll = -np.arctan2(away[0], np.hypot(*away[1:])), np.arctan2(away[1], away[2])
    assert found["at_rest"] == pytest.approx({"pitch": pitch, "roll": roll}, rel=1e-3)


def test_a_plate_across_needs_a_length_of_the_primes(coeflab: Run, tmp_path: Path) -> None:
    corners = [[0.0, y, z] for y, z in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]]).export(tmp_path / "plate.stl")
    done = coeflab("vehicle", "plate.stl", "--unit", "m", "--axes", "FLU", "--sheets")
    assert done.returncode == 2
    assert "found a body 0 m long along x" in flat(done.stderr)
    assert "--length" in flat(done.stderr)
    assert "A vehicle needs a closed hull" in flat(done.stderr)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("huuv_mesh_simplified", "--campaign", "nowhere"), "nowhere"),
        (("{mesh}", "--axes", "FRD"), "found no unit; expected --unit mm"),
        (("{mesh}", "--unit", "m"), "found no axes; expected --axes FLU (x forward, y port, z up)"),
        (("{mesh}",), "found no unit and no axes"),
        (("{mesh}", "--unit", "m", "--axes", "ABC"), "three directions like forward,port,up"),
        ((BODY, "--cg", "-500,0,10"), "Another unit goes beside each number"),
        ((BODY, "--mass", "heavy"), '"--mass"'),
        ((BODY, "--mass", "-1"), "above zero"),
        ((BODY, "--mass", "nan"), '"--mass": found "nan"; expected a finite number'),
        ((BODY, "--mass", "22", "--density", "1.025"), "1.025 kg/m^3, which is thin air"),
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


@pytest.mark.slow
def test_a_bare_mesh_brings_a_body_file_to_complete_which_is_never_overwritten(coeflab: Run, tmp_path: Path) -> None:
    from tests.bodies.twelve import TWELVE

    TWELVE["torpedo"]().export(tmp_path / "torpedo.stl")
    bare = ("vehicle", "torpedo.stl", "--unit", "m", "--axes", "FLU", *QUICK, "--out", "made")
    done = coeflab(*bare)
    assert done.returncode == 0, done.stderr
    assert (
        "made/body.toml: the fins that were found, rudder and thruster to complete; then coeflab vehicle made"
        in flat(done.stdout)
    )
    file = tmp_path / "made" / "body.toml"
    first = file.read_bytes()
    assert b'# name = "dr"' in first
    coeflab(*bare)
    assert file.read_bytes() == first
    coeflab(*(("FRD" if word == "FLU" else word) for word in bare))  # axes were wrong: an untouched one follows
    assert 'axes = "FRD"' in file.read_text()
    file.write_text(file.read_text() + "# mine\n")
    done = coeflab(*bare)
    assert (
        "made/body.toml was edited and is kept, with the unit and axes that it states; coeflab vehicle made takes it"
        in flat(done.stdout)
    )
    assert file.read_text().endswith("# mine\n")
    own = coeflab("vehicle", "made", *QUICK, "--mass", "78")
    assert own.returncode == 0, own.stderr
    assert "draft " not in own.stdout
    assert file.read_text().endswith("# mine\n")
