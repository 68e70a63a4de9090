"""``coeflab import`` of runs of half of a body: a symmetry plane in the domain has to be answered for, and never doubles by itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tables.campaign import read_campaign
from tests.cli.conftest import flat
from tests.cli.test_import import command_of, invoke, left_open, refused, table_of, without_slopes

__all__ = ["without_slopes"]

HEAD = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"
CUT = "    cut   { type symmetryPlane; }\n"
FORCE, MOMENT = (-9.0, -1.5, -8.0), (0.25, 0.5, -0.3)
KNOWN = ("--set", "axes.frame=FRD", "--set", "scaling.length=1 m LOA")


def case(
    folder: Path, degrees: float, *, plane: str = "v", cut: str = CUT, nu: float = 1e-6, force: np.ndarray | None = None
) -> None:
    """A synthetic steady run of simpleFoam in FRD at 1 m/s, of which the forces grow with the angle."""
    angle = np.radians(degrees)
    v, w = (np.sin(angle), 0.0) if plane == "v" else (0.0, np.sin(angle))
    water = " ".join(f"{-x + 0.0:.12g}" for x in (np.cos(angle), v, w))
    grown = np.array([FORCE[0], FORCE[1] * degrees, FORCE[2]]) if force is None else force
    rows = np.atleast_2d(grown) * np.ones((120, 3))
    files = {
        "system/controlDict": HEAD.format("dictionary", "controlDict")
        + "application simpleFoam;\nfunctions { forces { type forces; patches (hull); rho rhoInf; rhoInf 998; CofR (0 0 0); } }\n",
        "system/fvSchemes": HEAD.format("dictionary", "fvSchemes") + "ddtSchemes { default steadyState; }\n",
        "constant/transportProperties": HEAD.format("dictionary", "transportProperties") + f"nu {nu!r};\n",
        "0/U": HEAD.format("volVectorField", "U")
        + f"boundaryField\n{{\n    far {{ type fixedValue; value uniform ({water}); }}\n{cut}    hull {{ type noSlip; }}\n}}\n",
    }
    for name, kind, values in (("force", "Force", rows), ("moment", "Moment", np.tile(MOMENT, (120, 1)))):
        lines = [f"{t}\t{(n := ' '.join(map(repr, r.tolist())))}\t{n}\t0 0 0" for t, r in enumerate(values, start=1)]
        head = f"# {kind}\n# CofR : (0 0 0)\n#\n# Time \ttotal_x total_y total_z\tpressure_x pressure_y pressure_z\tviscous_x viscous_y viscous_z\n"
        files[f"postProcessing/forces/0/{name}.dat"] = head + "\n".join(lines) + "\n"
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


@pytest.fixture
def halves(tmp_path: Path) -> Path:
    for degrees in (0, 4, 8):
        case(tmp_path / "runs" / f"b{degrees}", degrees)
    return tmp_path / "runs"


def test_a_symmetry_plane_is_open_with_its_patch_and_file(halves: Path, tmp_path: Path) -> None:
    done = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--accept")
    assert left_open(done) == ["campaign.half_model"]
    assert "0/U:5: patch cut is of type symmetryPlane" in flat(done.output)
    assert not (tmp_path / "out").exists()
    seen = flat(invoke("inspect", halves).output)
    assert "campaign.half_model" in seen
    assert "patch cut is of type symmetryPlane" in seen


def test_a_symmetry_plane_that_only_the_mesh_states_is_open_too(tmp_path: Path) -> None:
    for degrees in (0, 4):
        case(tmp_path / "runs" / f"b{degrees}", degrees, cut="")
        mesh = tmp_path / "runs" / f"b{degrees}" / "constant/polyMesh/boundary"
        mesh.parent.mkdir()
        mesh.write_text(
            HEAD.format("polyBoundaryMesh", "boundary") + "1\n(\n    middle { type symmetry; nFaces 3; }\n)\n"
        )
    done = invoke("import", tmp_path / "runs", "--out", tmp_path / "out", *KNOWN, "--accept")
    assert left_open(done) == ["campaign.half_model"]
    assert "constant/polyMesh/boundary:4: patch middle is of type symmetry" in flat(done.output)


def test_a_domain_without_a_symmetry_plane_raises_no_question(tmp_path: Path) -> None:
    for degrees in (0, 4):
        case(tmp_path / "runs" / f"b{degrees}", degrees, cut="")
    done = invoke("import", tmp_path / "runs", "--out", tmp_path / "out", *KNOWN, "--accept")
    assert done.exit_code == 0, done.output
    assert set(table_of(tmp_path / "out").forces) == set("XYZKMN")


def test_the_upper_half_doubles_and_leaves_out_what_the_cut_loses(halves: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = invoke("import", halves, "--out", out, *KNOWN, "--set", "campaign.half_model=upper", "--accept")
    assert done.exit_code == 0, done.output
    table = table_of(out)
    assert sorted(table.forces) == ["N", "X", "Y"]
    np.testing.assert_allclose(table.forces["Y"], [0.0, -12.0, -24.0], atol=1e-12)
    np.testing.assert_allclose(table.forces["N"], -0.6)
    assert read_campaign(out / "campaign.toml").symmetry == ("up-down",)
    text = (out / "campaign.toml").read_text()
    assert (
        'half_model = "upper"                      # confirmed: cut at z = 0, X, Y, N are doubled; Z, K, M left out'
        in text
    )
    assert (out / "table.csv").read_text().splitlines()[1].split(",")[5:8] == ["X [N]", "Y [N]", "N [N m]"]


def test_false_says_that_forces_are_of_the_whole_body(halves: Path, tmp_path: Path) -> None:
    done = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--set", "campaign.half_model=false", "--accept")
    assert done.exit_code == 0, done.output
    table = table_of(tmp_path / "out")
    np.testing.assert_allclose(table.forces["Y"], [0.0, -6.0, -12.0], atol=1e-12)
    assert set(table.forces) == set("XYZKMN")
    assert "confirmed: forces are of the whole body" in (tmp_path / "out" / "campaign.toml").read_text()


def test_a_half_that_the_motion_does_not_lie_in_is_refused(halves: Path, tmp_path: Path) -> None:
    done = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--set", "campaign.half_model=port", "--accept")
    assert any("motion v on a half model cut at y = 0" in line for line in refused(done))
    wrong = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--set", "campaign.half_model=left", "--accept")
    assert any("campaign.half_model" in line and '"upper"' in line for line in refused(wrong))
    one_side = ("--set", "campaign.half_model=upper", "--set", "campaign.symmetry=port-starboard")
    bare = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, *one_side, "--accept")
    assert any("without declared up-down symmetry" in line for line in refused(bare))
    assert not (tmp_path / "out").exists()


def test_half_and_whole_bodies_are_no_one_table(halves: Path, tmp_path: Path) -> None:
    case(halves / "b12", 12, cut="")
    done = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--accept")
    assert any("symmetry plane in b8 (0/U:5: patch cut" in line and "none in b12" in line for line in refused(done))


def test_each_table_says_its_own_half(tmp_path: Path) -> None:
    runs = tmp_path / "runs"
    for degrees in (0, 4, 8):
        case(runs / f"drift{degrees}", degrees)
        case(runs / f"attack{degrees}", degrees, plane="w", cut=CUT.replace("symmetryPlane", "symmetry"))
        case(runs / f"whole{degrees}", degrees, cut="")
    named = [a for name in ("drift", "attack", "whole") for a in ("--name", f"{name}{{angle:text}}")]
    done = invoke("import", runs, "--out", tmp_path / "out", *named, *KNOWN, "--accept")
    assert sorted(k for k in left_open(done) if "half" in k) == [
        "attack/campaign.half_model",
        "drift/campaign.half_model",
    ]
    halves = ("--set", "drift/campaign.half_model=upper", "--set", "attack/campaign.half_model=port")
    done = invoke(
        "import",
        runs,
        "--out",
        tmp_path / "out",
        *named,
        *KNOWN,
        *halves,
        "--set",
        "campaign.symmetry=up-down",
        "--set",
        "whole/campaign.half_model=false",  # a constant Z in drift of a body that is alike up and down is asked about
        "--accept",
    )
    assert done.exit_code == 0, done.output
    tables = {t.file: t.half_model for t in read_campaign(tmp_path / "out" / "campaign.toml").tables}
    assert tables == {"drift.csv": "upper", "attack.csv": "port", "whole.csv": False}


def test_the_command_at_the_end_of_the_form_asks_for_what_is_missing(halves: Path, tmp_path: Path) -> None:
    words = command_of(invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--accept").output)
    answered = [w.replace("campaign.half_model=?", "campaign.half_model=lower") for w in words]
    assert invoke(*answered).exit_code == 0
    np.testing.assert_allclose(table_of(tmp_path / "out").forces["X"], -18.0)


def test_an_error_about_a_folder_names_no_line(halves: Path, tmp_path: Path) -> None:
    done = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--set", "campaign.half_model=port", "--accept")
    (line,) = refused(done)
    assert line.startswith(f"{halves}: found motion v")
    mapped = invoke("import", halves, "--out", tmp_path / "out", *KNOWN, "--map", "Fx=X [m]", "--accept")
    assert mapped.exception is not None
    assert "line 0" not in str(mapped.exception)


def test_the_run_at_zero_is_said_to_give_no_slope(halves: Path, tmp_path: Path) -> None:
    case(halves / "b12", 12)
    out = tmp_path / "out"
    both = ("--set", "campaign.half_model=upper", "--set", "campaign.symmetry=up-down, port-starboard")
    assert invoke("import", halves, "--out", out, *KNOWN, *both, "--accept").exit_code == 0
    said = "extrapolated: the run at zero gives no slope, as it is zero by declared port-starboard symmetry."
    assert said in flat(invoke("fit", out).output)
    text = (
        (out / "campaign.toml")
        .read_text()
        .replace('symmetry = ["up-down", "port-starboard"]', 'symmetry = ["up-down"]')
    )
    (out / "campaign.toml").write_text(text)
    assert "gives no slope" not in flat(invoke("fit", out).output)


def test_a_viscosity_in_pascal_seconds_is_warned_of(tmp_path: Path) -> None:
    for degrees in (0, 4):
        case(tmp_path / "mu" / f"b{degrees}", degrees, cut="", nu=1e-3)
        case(tmp_path / "nu" / f"b{degrees}", degrees, cut="")
    asked = invoke("import", tmp_path / "mu", "--out", tmp_path / "out", *KNOWN).output
    assert "0.001 m^2/s" in asked
    assert "kinematic, Re = 1e+03" in asked
    assert "warning, conditions.viscosity: 0.001 m^2/s is not the kinematic viscosity of water" in flat(asked)
    assert "998 kg/m^3 is 1e-06 m^2/s" in flat(asked)
    done = invoke("import", tmp_path / "mu", "--out", tmp_path / "out", *KNOWN, "--accept")
    assert done.exit_code == 0, done.output
    assert "is not the kinematic viscosity" in flat(done.output)
    assert "viscosity of water" not in flat(invoke("import", tmp_path / "nu", "--out", tmp_path / "b", *KNOWN).output)


def test_another_viscosity_than_that_of_the_runs_is_refused(halves: Path, tmp_path: Path) -> None:
    said = (*KNOWN, "--set", "campaign.half_model=upper", "--accept", "--set")
    done = invoke("import", halves, "--out", tmp_path / "out", *said, "conditions.viscosity=1.2e-6")
    (line,) = refused(done)
    assert "found conditions.viscosity = 1.2e-06 m^2/s; expected 1e-06" in line
    assert "constant/transportProperties:2" in line
    assert invoke("import", halves, "--out", tmp_path / "out", *said, "conditions.viscosity=1.0034e-6").exit_code == 0


def test_the_campaign_says_what_part_of_each_history_is_averaged(tmp_path: Path) -> None:
    settling = np.vstack([np.outer(np.linspace(3.0, 0.0, 40), FORCE), np.zeros((80, 3))]) + np.array(FORCE)
    case(tmp_path / "runs" / "b0", 0, cut="")
    case(tmp_path / "runs" / "b4", 4, cut="", force=settling)
    out = tmp_path / "out"
    assert invoke("import", tmp_path / "runs", "--out", out, *KNOWN, "--accept").exit_code == 0
    text = (out / "campaign.toml").read_text()
    assert "averaged over a window of each run" in text
    assert 'labels = ["status", "averaged over", "condition from"]' in text
    table = (out / "table.csv").read_text()
    assert "iterations 1 to 120" in table
    assert "iterations 61 to 120" in table


def test_a_steady_solver_that_ends_in_a_cycle_is_known_to_its_range(tmp_path: Path) -> None:
    swing = np.tile([[0.0, 5e-4, 0.0], [0.0, -5e-4, 0.0]], (60, 1))
    for degrees in (0, 4):
        case(
            tmp_path / "runs" / f"b{degrees}", degrees, cut="", force=np.array([FORCE[0], -1.5 * degrees, 0.0]) + swing
        )
    assert invoke("import", tmp_path / "runs", "--out", tmp_path / "out", *KNOWN, "--accept").exit_code == 0
    np.testing.assert_allclose(table_of(tmp_path / "out").errors["Y"], 5e-4, rtol=1e-9)
    for degrees in (0, 4):  # the same numbers over time
        (tmp_path / "runs" / f"b{degrees}" / "system/fvSchemes").write_text(
            HEAD.format("dictionary", "fvSchemes") + "ddtSchemes { default Euler; }\n"
        )
    assert invoke("import", tmp_path / "runs", "--out", tmp_path / "time", *KNOWN, "--accept").exit_code == 0
    assert np.all(table_of(tmp_path / "time").errors["Y"] < 2e-4)


def test_an_edited_density_is_refused_as_the_forces_were_made_with_another(tmp_path: Path) -> None:
    for degrees in (0, 4):
        case(tmp_path / "runs" / f"b{degrees}", degrees, cut="")
    out = tmp_path / "out"
    said = (*KNOWN, "--option", "density=1025", "--accept")
    assert invoke("import", tmp_path / "runs", "--out", out, *said).exit_code == 0
    text = (out / "campaign.toml").read_text()
    assert "forces_density = 1025.0                   # stated: option density" in text
    (out / "campaign.toml").write_text(text.replace("\ndensity = 1025.0", "\ndensity = 998.0"))
    with pytest.raises(InputError, match=r"found density = 998 kg/m.3; expected 1025, the forces_density of table.csv"):
        table_of(out)
    (out / "campaign.toml").write_text(text.replace("\ndensity = 1025.0", "\ndensity = 1025.5"))
    assert len(table_of(out)) == 2
