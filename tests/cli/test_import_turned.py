"""``coeflab import`` of a body turned in one inflow: forces along the flow are never taken as those of the body without a word."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from tests.cli.conftest import flat
from tests.cli.test_import import invoke, left_open, refused, table_of, without_slopes
from tests.cli.test_import_half import HEAD, case

__all__ = ["without_slopes"]

DEGREES = (0, 4, 8, -4, -8)
KNOWN = ("--name", "b{beta:deg}", "--set", "axes.frame=CFD", "--set", "scaling.length=1 m LOA", "--accept")
ALONG_FLOW = [a for m in ("Fx=drag [N]", "Fy=side [N]", "Fz=ignore", "Mx=ignore", "My=ignore") for a in ("--map", m)]


def body(degrees: float) -> tuple[float, float]:
    """X and Y of the body in FRD, v = -U sin(beta)."""
    v = -np.sin(np.radians(degrees))
    return -9.0 + 2.0 * v**2, -60.0 * v - 100.0 * v * abs(v)


@pytest.fixture
def turned(tmp_path: Path) -> Path:
    """Runs of one inflow along x, aft of the mesh, z up, in which the body is turned; forces are of the mesh."""
    for degrees in DEGREES:
        (x, y), b = body(degrees), np.radians(degrees)
        drag, side = -x * np.cos(b) + y * np.sin(b), x * np.sin(b) + y * np.cos(b)
        folder = tmp_path / "runs" / f"b{degrees}"
        case(folder, 0.0, cut="", force=np.array([drag, side, 0.5]))
        (folder / "0/U").write_text(
            HEAD.format("volVectorField", "U") + "boundaryField\n{ far { type fixedValue; value uniform (1 0 0); } }\n"
        )
    return tmp_path / "runs"


def test_a_mesh_turned_in_one_inflow_leaves_the_axes_of_its_forces_open(turned: Path, tmp_path: Path) -> None:
    done = invoke("import", turned, "--out", tmp_path / "out", *KNOWN)
    assert left_open(done) == ["Fx", "Fy", "Fz", "Mx", "My"]
    assert "drag [N] or X [N]: along the flow" in flat(done.output)
    assert "0/U" in flat(done.output)
    assert not (tmp_path / "out").exists()
    done = invoke("import", turned, "--out", tmp_path / "out", *KNOWN, "--map", "Fx=drag [N]")
    assert left_open(done) == ["Fy", "Fz", "Mx", "My"]
    done = invoke("import", turned, "--out", tmp_path / "out", *KNOWN, *ALONG_FLOW)
    assert done.exit_code == 0, done.output
    table = table_of(tmp_path / "out")
    np.testing.assert_allclose(
        [table.forces["X"], table.forces["Y"]], np.transpose([body(d) for d in DEGREES]), atol=1e-9
    )
    assert sorted(table.forces) == ["N", "X", "Y"]


def test_forces_along_the_body_are_taken_once_somebody_says_so(turned: Path, tmp_path: Path) -> None:
    done = invoke("import", turned, "--out", tmp_path / "out", *KNOWN, "--map", "Fx=X [N]")
    assert done.exit_code == 0, done.output
    assert set(table_of(tmp_path / "out").forces) == set("XYZKMN")


def test_a_folder_in_place_is_refused_until_its_columns_say_the_axes(turned: Path, tmp_path: Path) -> None:
    invoke("import", turned, "--out", tmp_path / "out", *KNOWN, *ALONG_FLOW)
    text = (tmp_path / "out/campaign.toml").read_text()
    sections = "".join(re.findall(r"^\[(?:axes|scaling|conditions|source)\]\n(?:[^\[\n].*\n)+", text, re.MULTILINE))
    head = '[campaign]\ntitle = "T"\nbody = "b"\nimporter = "openfoam"\n[importer]\nnames = "b{beta:deg}"\n'
    said = '[columns]\nFx = "drag [N]"\nFy = "side [N]"\nFz = "ignore"\nMx = "ignore"\nMy = "ignore"\n'
    for columns in ("", said):
        (tmp_path / "campaign.toml").write_text(f'{head}{columns}{sections}[[table]]\nfile = "runs"\n')
        if columns:
            np.testing.assert_allclose(table_of(tmp_path).forces["Y"], [body(d)[1] for d in DEGREES], atol=1e-9)
        else:
            with pytest.raises(InputError, match="the body is turned in the mesh"):
                table_of(tmp_path)


def test_a_flow_that_turns_with_the_angle_asks_nothing(tmp_path: Path) -> None:
    for degrees in (0, 4, 8):
        case(tmp_path / "runs" / f"b{degrees}", degrees, cut="")
    done = invoke(
        "import", tmp_path / "runs", "--out", tmp_path / "out", "--set", "axes.frame=FRD", *KNOWN[:2], *KNOWN[4:]
    )
    assert done.exit_code == 0, done.output
    assert "along the flow" not in flat(done.output)


def test_drag_that_grows_with_the_angle_warns_where_no_file_states_the_flow(turned: Path, tmp_path: Path) -> None:
    for folder in turned.glob("*/0"):
        shutil.rmtree(folder)
    told = flat(invoke("import", turned, "--out", tmp_path / "out", *KNOWN, "--set", "conditions.speed=1").output)
    assert 'If the body was turned in the flow: --map "Fx=drag [N]" --map "Fy=side [N]", and Fz, Mx, My ignore' in told
    more = ("--set", "conditions.speed=1", *ALONG_FLOW)
    told = flat(invoke("import", turned, "--out", tmp_path / "out", "--force", *KNOWN, *more).output)
    assert "turned in the flow" not in told


def test_runs_that_share_a_reason_are_refused_once(turned: Path, tmp_path: Path) -> None:
    for file in turned.glob("*/postProcessing/forces/0/*.dat"):
        file.write_text("".join(line for line in file.read_text().splitlines(keepends=True) if line[0] != "#"))
    (told,) = refused(invoke("import", turned, "--out", tmp_path / "out"))
    assert told.count("no line of column names") == 1
    assert "no readable run of 5: b0, b4, b8, b-4 and b-8 (postProcessing" in told
