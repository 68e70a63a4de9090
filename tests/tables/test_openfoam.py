"""Cases of OpenFOAM: every layout of both forks, restarts, crashes, motions by hand, and what is refused."""

from __future__ import annotations

import csv
import gzip
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.importers import IMPORTERS, openfoam
from coeflab.tables.raw_table import Ended, RawTable, Run
from tests.conftest import PEAK_KILOBYTES

SAMPLES = Path(__file__).parent / "samples" / "openfoam"
FORCE = Path("postProcessing/forces/0/force.dat")
# Pressure and viscous part of the three rows in every sample of forces.
WHOLE = np.array([
    [-41.0, 57.0, 2.0, 0.375, 4.0, -123.0],
    [-39.75, 55.75, 1.5, 0.375, 3.5, -121.75],
    [-39.25, 55.25, 1.25, 0.375, 3.25, -121.25],
])  # fmt: skip


@pytest.fixture
def case(tmp_path: Path) -> Callable[[str], Path]:
    """A copy of a sample that a test may spoil."""

    def copied(name: str = "arm_mrf") -> Path:
        return shutil.copytree(SAMPLES / name, tmp_path / name)

    return copied


def read(path: Path, **options: object) -> Run:
    return openfoam.run(path, options)


def forces(table: RawTable) -> np.ndarray:
    columns = [table.meaning(c) for c in COMPONENTS]
    return np.column_stack([c.values for c in columns if c is not None])


def conditions(run: Run, names: str) -> list[float]:
    return [float(str(run.conditions[n].value)) for n in names]


def edit(file: Path, *changes: tuple[str, str]) -> None:
    text = file.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)


def remarks(run: Run) -> str:
    return "\n".join(run.history.remarks)


def restarted(folder: Path, begin: int, rows: int, name: str = "", scale: float = 1.0) -> None:
    """Files of a later start, whose forces are so many times those of the first row."""
    for what in ("force", "moment"):
        file = folder / "postProcessing/forces/0" / f"{what}.dat"
        *head, row = file.read_text().splitlines()[:5]
        cells = row.split("\t")[1:]
        numbers = [[scale * float(v) for v in c.strip("()").split()] for c in cells]
        body = "\t".join("(" + " ".join(f"{v:.8e}" for v in n) + ")" for n in numbers)
        out = folder / f"postProcessing/forces/{0 if name else begin}/{what}{name}.dat"
        out.parent.mkdir(exist_ok=True)
        out.write_text("\n".join([*head, *(f"{begin + i:<16}\t{body}" for i in range(rows))]) + "\n")


@pytest.mark.parametrize("name", ["com_v2212", "org_v10", "org_v4_porous", "arm_mrf", "arm_srf"])
def test_forces_of_every_layout_are_the_same_numbers(name: str) -> None:
    run = read(SAMPLES / name)
    np.testing.assert_allclose(forces(run.history), WHOLE, rtol=1e-14)
    assert [c.unit for c in run.history.columns] == ["", *["N"] * 3, *["N m"] * 3]
    shares = sum(forces(run.patches[s]) for s in ("pressure", "viscous"))
    np.testing.assert_allclose(shares, WHOLE, rtol=1e-14)
    assert run.history.columns[0].means == "iteration"
    assert list(run.history.columns[0].values) == [1.0, 2.0, 3.0]
    assert run.ended is Ended.WHOLE


def test_every_sample_is_one_case_for_one_importer(tmp_path: Path) -> None:
    for folder in filter(Path.is_dir, SAMPLES.iterdir()):
        assert [n for n in IMPORTERS.names() if IMPORTERS.load(n).recognises(folder)] == ["openfoam"]
    assert not openfoam.recognises(SAMPLES)
    assert not openfoam.recognises(SAMPLES / "arm_mrf" / FORCE)
    assert openfoam.recognises(SAMPLES / "arm_mrf" / "postProcessing")
    shutil.copytree(SAMPLES / "arm_mrf" / "postProcessing", tmp_path / "alone" / "postProcessing")
    assert openfoam.recognises(tmp_path / "alone")
    run = read(tmp_path / "alone")
    np.testing.assert_allclose(forces(run.history), WHOLE)
    assert dict(run.conditions) == {}
    assert (run.history.columns[0].means, run.history.columns[0].unit) == ("time", "")
    assert "conditions.density" not in run.history.stated


def test_what_the_dictionaries_state_and_where() -> None:
    run = read(SAMPLES / "com_v2212")
    stated = {k: (s.value, s.place) for k, s in run.history.stated.items()}
    assert conditions(run, "uvw") == [-1.992389, -0.174311, 0.0]
    assert stated["conditions.density"] == (998.0, "system/controlDict:22")
    assert stated["conditions.viscosity"] == (1.05e-06, "constant/transportProperties:11")
    assert stated["axes.reference_point"] == ((2.0, 0.0, 0.0), "postProcessing/all/0/force.dat:2")
    assert stated["table.contains_inertia"][0] is False
    assert stated["source.how_obtained"][0] == "simpleFoam of OpenFOAM v2212"
    assert run.conditions["cells"].value == 1600
    assert (run.conditions["y_plus"].value, run.conditions["y_plus"].place) == (
        42.5,
        "postProcessing/yPlus/0/yPlus.dat:5",
    )
    assert "axes.frame" not in stated
    assert not set("pqr") & set(run.conditions)
    read_too = {f.name for f in run.history.files}
    assert {"force.dat", "moment.dat", "U", "initialConditions", "owner", "log.simpleFoam", "yPlus.dat"} <= read_too


def test_groups_of_patches_about_the_point_of_the_whole() -> None:
    run = read(SAMPLES / "com_v2212")
    assert run.history.dialect["function object"] == "all"
    np.testing.assert_allclose(forces(run.patches["hull"]), 0.75 * WHOLE, rtol=1e-12)
    # The sail's moments are about (1 0 0), those of the whole about (2 0 0): N + (1 - 2) Y, M - (1 - 2) Z.
    np.testing.assert_allclose(forces(run.patches["sail"]), 0.25 * WHOLE, rtol=1e-12)
    assert "moments of sail were moved" in remarks(run)


def test_two_groups_without_the_whole_are_asked_about(case: Callable[[str], Path]) -> None:
    folder = case("com_v2212")
    shutil.rmtree(folder / "postProcessing/all")
    with pytest.raises(InputError, match=r"function objects hull, sail; none of them covers all.*function=hull"):
        read(folder)
    both = read(folder, function="hull sail")
    np.testing.assert_allclose(forces(both.history), WHOLE, rtol=1e-12)
    sail = read(folder, function=["sail"])
    np.testing.assert_allclose(forces(sail.history)[:, :3], 0.25 * WHOLE[:, :3])
    assert "leave out the walls hull" in remarks(sail)
    assert "leave out" not in remarks(both)
    with pytest.raises(InputError, match=r"found hull twice; expected every function object once.*half_model"):
        read(folder, function="hull hull")
    with pytest.raises(InputError, match='no forces of the function object "fin"'):
        read(folder, function=["fin"])


def test_two_that_cover_the_same_are_asked_about(case: Callable[[str], Path]) -> None:
    folder = case("com_v2212")
    edit(folder / "system/controlDict", ("patches         (hull)", 'patches         (sail ".*ull")'))
    with pytest.raises(InputError, match="all and hull cover the same patches"):
        read(folder)


def test_forces_of_a_part_beside_coefficients_of_the_whole_are_not_the_whole(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    shutil.copytree(SAMPLES / "coefficients_com/postProcessing/forceCoeffs1", folder / "postProcessing/all")
    with pytest.raises(InputError, match=r"no dictionary says which patches all has"):
        read(folder)
    alike = "all { type forceCoeffs; patches (hull); rho rhoInf; rhoInf 998; }\n"
    edit(folder / "system/controlDict", ("functions\n{\n", "functions\n{\n" + alike))
    assert read(folder).history.dialect["function object"] == "forces"
    edit(folder / "system/controlDict", ("patches (hull)", "patches (hull sail)"))
    assert read(folder).history.dialect["function object"] == "all"


def test_coefficients_become_forces_by_what_their_comments_state() -> None:
    # 1/2 rho U^2 A = 1000 N, and 4000 N m with lRef; liftDir z, dragDir x, Cm about y; no Cs, CmRoll, CmYaw.
    old = read(SAMPLES / "coefficients_old").history
    assert [c.means for c in old.columns] == ["iteration", "X", "Z", "M"]
    np.testing.assert_allclose([c.values[-1] for c in old.columns[1:]], [35.0, 100.0, 50.0])
    # Drag along (.8 .6 0), lift along (-.6 .8 0), side along -z: X = 1000 (.8 Cd - .6 Cl) ...
    com = read(SAMPLES / "coefficients_com").history
    np.testing.assert_allclose(
        forces(com)[0], [1000 * (0.04 - 0.06), 1000 * (0.03 + 0.08), -20.0,
                         4000 * (0.0008 - 0.0012), 4000 * (0.0006 + 0.0016), -16.0],
    )  # fmt: skip
    assert com.stated["scaling.length"].value == 4.0
    assert com.stated["conditions.speed"].value == 2.0


def test_coefficients_without_density_are_those_of_one(case: Callable[[str], Path]) -> None:
    folder = case("coefficients_com")
    shutil.rmtree(folder / "system")
    alone = read(folder)
    assert alone.history.stated["conditions.density"].value == 1.0
    assert "no file states the density" in remarks(alone)
    assert "forces are made those of a fluid of 1 kg/m^3" in remarks(alone)
    np.testing.assert_allclose(1000.0 * forces(alone.history), forces(read(SAMPLES / "coefficients_com").history))
    given_ = read(folder, density="1025 kg/m^3")
    np.testing.assert_allclose(1025.0 * forces(alone.history), forces(given_.history))


def test_coefficients_by_another_speed_than_the_inflow_are_said(case: Callable[[str], Path]) -> None:
    folder = case("coefficients_old")
    shutil.copytree(SAMPLES / "org_v4_porous/0", folder / "0")
    assert "magUInf" not in remarks(read(folder))
    edit(folder / "0/U", ("value           uniform (2 0 0)", "value           uniform (2 0.3 0)"))
    run = read(folder)
    assert "magUInf 2 is not the speed 2.02237 m/s of 0/U:16" in remarks(run)
    assert run.history.stated["conditions.speed"].value == pytest.approx(np.hypot(2.0, 0.3))


def test_coefficients_whose_comments_say_nothing_stay_coefficients(case: Callable[[str], Path]) -> None:
    folder = case("coefficients_old")
    edit(folder / "postProcessing/forceCoeffs/0/forceCoeffs.dat", ("# magUInf", "# somewhat"))
    run = read(folder)
    assert [(c.name, c.unit, c.means) for c in run.history.columns[1:3]] == [("Cm", "-", ""), ("Cd", "-", "")]
    assert "state no magUInf" in remarks(run)
    edit(
        folder / "postProcessing/forceCoeffs/0/forceCoeffs.dat",
        ("# somewhat", "# magUInf"),
        ("(0.000000e+00 0.0", "(0.0"),
    )
    assert "state no dragDir" not in remarks(read(folder))
    assert "state no liftDir" in remarks(read(folder))


def test_coefficients_by_a_speed_beyond_numbers_stay_coefficients(case: Callable[[str], Path]) -> None:
    folder = case("coefficients_old")
    edit(
        folder / "postProcessing/forceCoeffs/0/forceCoeffs.dat",
        ("# magUInf    : 2.000000e+00", "# magUInf    : 2e+200"),
    )
    assert "magUInf 2e+200 and Aref 0.5 make a force beyond" in remarks(read(folder))


def test_kinematic_density_is_said_and_turned(case: Callable[[str], Path]) -> None:
    run = read(SAMPLES / "org_v4_porous")
    assert run.history.stated["conditions.density"].value == 1.0
    assert (
        "rhoInf 1, so forces are those of a fluid of 1 kg/m^3, while constant/transportProperties:11 says 1000"
        in remarks(run)
    )
    turned = read(SAMPLES / "org_v4_porous", density=1000)
    np.testing.assert_allclose(forces(turned.history), 1000.0 * WHOLE)
    np.testing.assert_allclose(forces(turned.patches["viscous"]), 1000.0 * forces(run.patches["viscous"]))
    assert turned.history.stated["conditions.density"].value == 1000.0
    folder = case("org_v10")
    (folder / "system/forcesHull").unlink()
    (folder / "constant/physicalProperties").unlink()
    with pytest.raises(InputError, match="no rhoInf of forcesHull"):
        read(folder, density=1000)


def test_rotating_arm_by_hand() -> None:
    # omega = .25 about +z through (0 8 0); at CofR (.5 0 0): omega x (.5 -8 0) = .25 (8 .5 0) = (2 .125 0) m/s.
    for name in ("arm_mrf", "arm_srf"):
        run = read(SAMPLES / name)
        np.testing.assert_allclose(conditions(run, "uvwpqr"), [2.0, 0.125, 0.0, 0.0, 0.0, 0.25], atol=1e-12)
        assert run.conditions["U"].value == pytest.approx(np.hypot(2.0, 0.125))
        assert "constant/" in run.conditions["r"].place


def test_an_inflow_relative_to_the_frame_is_not_taken(case: Callable[[str], Path]) -> None:
    folder = case("arm_srf")
    edit(folder / "0/Urel", ("relative        no", "relative        yes"))
    run = read(folder)
    assert "u" not in run.conditions
    assert run.conditions["r"].value == pytest.approx(0.25)
    assert "UInf of far is relative to the rotating frame" in remarks(run)


def test_a_rotor_is_not_the_motion_of_the_body(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    mesh = folder / "constant/polyMesh"
    mesh.mkdir()
    (mesh / "owner").write_text('FoamFile { note "nPoints:1 nCells:800 nFaces:1"; }\n')
    (mesh / "cellZones").write_text("1\n(\nall\n{\n type cellZone;\n cellLabels List<label> 200 (0 1 2);\n}\n)\n")
    run = read(folder)
    assert not set("pqr") & set(run.conditions)
    assert "covers 25% of the cells" in remarks(run)
    assert conditions(run, "uvw") == [0.0, 0.0, 0.0]
    assert read(folder, rotation="body").conditions["r"].value == 0.25
    edit(mesh / "cellZones", ("200", "800"))
    assert read(folder).conditions["r"].value == 0.25
    assert "r" not in read(folder, rotation="none").conditions
    edit(folder / "constant/MRFProperties", ("(far)", "(far hull)"))
    assert "does not turn the body's patches" in remarks(read(folder))
    (mesh / "cellZones").unlink()
    edit(folder / "constant/MRFProperties", ("(far hull)", "(far)"), ("cellZone        all", "cellZone some"))
    unknown = read(folder)
    assert not set("pqruvw") & set(unknown.conditions)
    assert "give the option rotation=body or rotation=none" in remarks(unknown)


@pytest.mark.parametrize(
    ("old", "new", "rate"),
    [
        ("constant 0.25", "60 [rpm]", 2.0 * np.pi),
        ("omega           constant 0.25", "rpm 30", np.pi),
        ("constant 0.25", "omega [0 0 -1 0 0 0 0] -0.5", -0.5),
        ("constant 0.25", "$rate", -0.125),
        ("constant 0.25", "table ((0 0) (1 2))", None),
        ("constant 0.25", "[0 0 -1 0 0 0 0]", None),
        ("constant 0.25", '#calc "1.0/8.0"', 0.125),
        ("constant 0.25", "#eval{ 1/8 }", 0.125),
        ("constant 0.25", '#calc "1/8"', None),
        ("constant 0.25", "{ type constant; value 30 [rpm]; }", np.pi),
        ("active          yes", "active no", None),
    ],
)
def test_rates_as_they_are_written(case: Callable[[str], Path], old: str, new: str, rate: float | None) -> None:
    folder = case("arm_mrf")
    edit(folder / "constant/MRFProperties", (old, new), ("whole\n", "rate -0.125;\nwhole\n"))
    run = read(folder)
    if rate is None:
        assert "r" not in run.conditions
        assert ("u" in run.conditions) == ("active" in old)
    else:
        assert run.conditions["r"].value == pytest.approx(rate)
    if new.startswith("#") and rate is None:
        assert "constant/MRFProperties:17: " in remarks(run)


@pytest.mark.parametrize(
    ("far", "flow"),
    [
        ("type fixedValue; value uniform (1 0 0.5);", (1.0, 0.0, 0.5)),
        ("type uniformFixedValue; uniformValue constant (1 2 0);", (1.0, 2.0, 0.0)),
        ("type freestream; freestreamValue uniform ($ux 0 0);", (3.0, 0.0, 0.0)),
        ("type freestream; freestreamValue $:flow;", (4.0, 0.0, 0.0)),
        ("type freestream; freestreamValue ${flow};", (4.0, 0.0, 0.0)),
        ("type freestream; freestreamValue uniform $nowhere;", None),
        ('type fixedValue; value #calc "vector(1,0,0)";', (1.0, 0.0, 0.0)),
        ("type fixedValue; value uniform (#neg $ux 0 0.5);", (-3.0, 0.0, 0.5)),
        ('type fixedValue; value #calc "mesh()";', None),
        ("type codedFixedValue; value uniform (1 0 0);", None),
        ("type zeroGradient;", None),
        ("type fixedValue; value uniform (1 0 0) uniform (1 0 0);", None),
        ("type uniformFixedValue; uniformValue table ((0 (1 0 0)));", None),
        ("type fixedValue; value nonuniform List<vector> 2((1 0 0)(2 0 0));", None),
        ("type fixedValue; value uniform (1 0 0); } outlet { type inletOutlet; inletValue uniform (2 0 0);", None),
    ],
)
def test_inflow_as_it_is_written(case: Callable[[str], Path], far: str, flow: tuple[float, ...] | None) -> None:
    folder = case("org_v10")
    (folder / "0").rename(folder / "0.orig")
    (folder / "0.orig/U").unlink()
    content = f"ux 3; flow (4 0 0);\ninternalField uniform (9 9 9);\nboundaryField {{ far {{ {far} }} hull {{ type noSlip; }} }}\n"
    (folder / "0.orig/U.gz").write_bytes(gzip.compress(content.encode()))
    run = read(folder)
    if flow is None:
        assert "u" not in run.conditions
        assert "0.orig/U" in remarks(run)
    else:
        assert conditions(run, "uvw") == [-v + 0.0 for v in flow]
        assert run.conditions["u"].place in ("0.orig/U.gz:3", "0.orig/U.gz:1")


def test_the_later_start_wins(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    restarted(folder, 3, 4, scale=2.0)
    restarted(folder, 5, 2, scale=3.0)
    run = read(folder)
    assert list(run.history.columns[0].values) == [1, 2, 3, 4, 5, 6]
    np.testing.assert_allclose(forces(run.history)[:, 1], [57.0, 55.75, 114.0, 114.0, 171.0, 171.0])
    assert "3 rows of forces were computed again" in remarks(run)


def test_a_second_run_from_the_same_time_comes_after_the_first(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    restarted(folder, 2, 1, name="_0", scale=2.0)
    run = read(folder)
    assert list(run.history.columns[0].values) == [1, 2]
    np.testing.assert_allclose(forces(run.history)[:, 5], [-123.0, -246.0])


def test_a_restart_about_another_point_is_moved(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    restarted(folder, 3, 2)
    for what in ("force", "moment"):
        edit(folder / f"postProcessing/forces/3/{what}.dat", ("(5.00000000e-01 0", "(2.50000000e+00 0"))
    run = read(folder)
    # From (.5 0 0) to (2.5 0 0): N - 2 Y, M + 2 Z.
    np.testing.assert_allclose(forces(run.history)[0, 4:], [4.0 + 2 * 2.0, -123.0 - 2 * 57.0])
    np.testing.assert_allclose(forces(run.history)[3, 4:], [4.0, -123.0])
    assert run.history.stated["axes.reference_point"].value == (2.5, 0.0, 0.0)


def test_a_last_line_that_is_cut_is_left_out(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    file = folder / FORCE
    file.write_bytes(file.read_bytes()[:-60])
    run = read(folder)
    assert len(run.history) == 2
    assert run.ended is Ended.CRASHED
    assert "force.dat: line 7 ends after" in run.why
    assert "force.dat: line 7 has no end and is left out" in remarks(run)
    (folder / "log.simpleFoam").write_text("Build : 10\nExec : simpleFoam\n\nEnd\n")
    assert read(folder).ended is Ended.WHOLE
    # A number may be cut inside: without its line end a whole line is left out too.
    whole = case("org_v10") / "postProcessing/forcesHull/0/forces.dat"
    whole.write_bytes(whole.read_bytes().rstrip(b"\n"))
    assert len(read(whole.parents[3]).history) == 2


def test_a_tail_of_zeros_was_never_written(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    for what in ("force", "moment"):
        with (folder / f"postProcessing/forces/0/{what}.dat").open("ab") as stream:
            stream.write(b"\0" * 5000)
    run = read(folder)
    assert (len(run.history), run.ended) == (3, Ended.CRASHED)


@pytest.mark.parametrize("written", ["nan", "-nan", "inf", "-1.#IND", "1e999"])
def test_divergence_is_found_with_its_line(case: Callable[[str], Path], written: str) -> None:
    folder = case("arm_mrf")
    edit(folder / FORCE, ("(-3.97500000e+01 ", f"({written} "))
    run = read(folder)
    assert run.ended is Ended.DIVERGED
    assert run.why.startswith("postProcessing/forces/0/force.dat:6: the first number that is not finite, at time 2")
    assert len(run.history) == 3


def test_a_diverged_part_is_moved_without_a_warning(case: Callable[[str], Path]) -> None:
    folder = case("com_v2212")
    edit(folder / "postProcessing/sail/0/force.dat", ("1.393750e+01", "inf"))
    run = read(folder)
    assert run.ended is Ended.WHOLE
    assert not np.all(np.isfinite(forces(run.patches["sail"])))


def test_a_header_without_rows_is_an_empty_run(case: Callable[[str], Path]) -> None:
    folder = case("org_v10")
    file = folder / "postProcessing/forcesHull/0/forces.dat"
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:3]))
    (folder / "log.simpleFoam").write_text("Build : 10\nExec : simpleFoam\n--> FOAM FATAL ERROR : no such patch\n")
    run = read(folder)
    assert (len(run.history), run.ended) == (0, Ended.EMPTY)
    assert "FOAM FATAL ERROR" in run.why


def test_a_log_says_that_the_solver_broke_off(case: Callable[[str], Path]) -> None:
    folder = case("org_v10")
    (folder / "log").write_text("Build : 10\nExec : simpleFoam\nTime = 3\n#0 Foam::sigFpe::sigHandler(int)\n")
    (folder / "log.simpleFoam").unlink()
    run = read(folder)
    assert run.ended is Ended.CRASHED
    assert "sigFpe" in run.why


def test_local_axes_are_turned_to_those_of_the_mesh(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    local = "coordinateSystem { origin (0.5 0 0); rotation { type axes; e1 (0 1 0); e2 (0 0 1); } }"
    edit(folder / "system/controlDict", ("CofR            (0.5 0 0);", local))
    run = read(folder)
    # OpenFOAM 1912 wrote (Fy Fz Fx) with these axes: local x is y, local y is z, local z is x.
    np.testing.assert_allclose(forces(run.history)[0], [2.0, -41.0, 57.0, -123.0, 0.375, 4.0])
    assert "turned from its coordinateSystem" in remarks(run)
    edit(
        folder / "system/controlDict", ("type axes; e1 (0 1 0); e2 (0 0 1);", "type axisAngle; axis (0 0 2); angle 90;")
    )
    # 1912 wrote (Fy -Fx Fz).
    np.testing.assert_allclose(forces(read(folder).history)[0], [-57.0, -41.0, 2.0, -4.0, 0.375, -123.0], atol=1e-12)
    edit(folder / "system/controlDict", ("type axisAngle;", "type euler;"))
    with pytest.raises(InputError, match="a coordinateSystem whose axes"):
        read(folder)


def test_files_compressed_and_over_several_lines(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    for file in (folder / FORCE, folder / "constant/MRFProperties", folder / "system/controlDict"):
        Path(f"{file}.gz").write_bytes(gzip.compress(file.read_bytes().replace(b"\n", b"\r\n")))
        file.unlink()
    (folder / "postProcessing/forces/0/moment.dat").rename(folder / "postProcessing/forces/0/moment.dat.gz")
    plain = folder / "postProcessing/forces/0/moment.dat.gz"
    plain.write_bytes(gzip.compress(plain.read_bytes()))
    run = read(folder)
    np.testing.assert_allclose(forces(run.history), WHOLE)
    assert run.conditions["r"].value == 0.25


@pytest.mark.parametrize(
    ("file", "old", "new", "complaint"),
    [
        (FORCE, "# Time  ", "# Zeit  ", "no line of column names"),
        (
            FORCE,
            "total_x total_y total_z)\t(pressure_x",
            "total_x total_y)\t(pressure_x",
            "line 5.*10 numbers.*9, as the header",
        ),
        (FORCE, "(-3.97500000e+01 ", "(-3,97500000e+01 ", "line 6.*11 numbers"),
        (FORCE, "(-3.97500000e+01 ", "(1_0 ", 'line 6.*"1_0".*a number'),
        (
            "system/controlDict",
            "libs            (forces);",
            "libs            (forces;",
            "line .*system/controlDict|controlDict.*line",
        ),
        ("system/controlDict", "functions\n{", "functions\n{ {{{{{{{{{{{{{{", "controlDict, line .*nest too deep"),
        ("0/U", "boundaryField\n{", "boundaryField\n{ /*", "0/U, line .*a comment without its end"),
    ],
)
def test_files_that_are_refused(
    case: Callable[[str], Path], file: str | Path, old: str, new: str, complaint: str
) -> None:
    folder = case("arm_mrf")
    edit(folder / file, (old, new))
    with pytest.raises(InputError, match=complaint):
        read(folder)


def test_a_case_without_forces_is_told_what_to_add(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    shutil.rmtree(folder / "postProcessing")
    with pytest.raises(InputError, match=r"a case without forces.*type forces;.*patches"):
        read(folder)


def test_circles_of_links_and_includes_end(case: Callable[[str], Path]) -> None:
    folder = case("arm_mrf")
    (folder / "postProcessing/again").symlink_to(folder / "postProcessing")
    (folder / "postProcessing/loop").symlink_to(folder / "postProcessing/loop")
    (folder / "0/U").unlink()
    (folder / "0/U").symlink_to("U")
    np.testing.assert_allclose(forces(read(folder).history), WHOLE)
    (folder / "circle").symlink_to("circle")
    assert not openfoam.recognises(folder / "circle")
    edit(folder / "system/controlDict", ("functions\n", '#include "controlDict"\nfunctions\n'))
    with pytest.raises(InputError, match="includes without end"):
        read(folder)


def test_what_is_shut_is_said(case: Callable[[str], Path], monkeypatch: pytest.MonkeyPatch) -> None:
    folder = case("arm_mrf")
    opening = Path.open

    def shut(path: Path, *args: object, **more: object) -> object:
        if path.name == "moment.dat":
            raise PermissionError(13, "Permission denied")
        return opening(path, *args, **more)  # type: ignore[call-overload]

    monkeypatch.setattr(Path, "open", shut)
    with pytest.raises(InputError, match=r"moment.dat: found Permission denied"):
        read(folder)


def test_code_in_a_case_is_not_run(case: Callable[[str], Path]) -> None:
    folder = case("com_v2212")
    edit(folder / "system/controlDict", ("functions\n{", "functions\n{\n  c { type coded; code #{ int i = 1; } #}; }\n"),
         ("rhoInf          998;\n        CofR            (2 0 0);\n        writeControl", "rhoInf #codeStream { code #{ os << 1; #}; };\n        writeControl"))  # fmt: skip
    run = read(folder)
    np.testing.assert_allclose(forces(run.history), WHOLE)
    assert "conditions.density" not in run.history.stated


SEEDS = {
    f: (SAMPLES / "arm_mrf" / f).read_bytes()
    for f in (str(FORCE), "system/controlDict", "constant/MRFProperties", "0/U")
}
PIECES = [
    b"(",
    b")",
    b"{",
    b"}",
    b";",
    b"\n",
    b"#",
    b"$",
    b'"',
    b"/*",
    b"//",
    b"nan",
    b"1e999",
    b"\0",
    b"\xff",
    b"#include ",
    b"[",
    b"]",
    b"uniform ",
]


@pytest.mark.slow
@settings(max_examples=400)
@given(st.data())
def test_mutated_cases_raise_input_errors_alone(fuzzed: Path, data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(SEEDS)))
    seed = SEEDS[name]
    at, upto = sorted(data.draw(st.tuples(*[st.integers(0, len(seed))] * 2)))
    piece = data.draw(st.sampled_from(PIECES)) * data.draw(st.sampled_from([0, 1, 2, 40]))
    content = seed[:at] + piece + seed[data.draw(st.sampled_from([at, upto])) :]
    (fuzzed / name).write_bytes(content)
    try:
        read(fuzzed)
    except InputError:
        pass
    finally:
        (fuzzed / name).write_bytes(seed)


@pytest.fixture(scope="module")
def fuzzed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shutil.copytree(SAMPLES / "arm_mrf", tmp_path_factory.mktemp("fuzz") / "case")


MEASURED = f"""
import sys
from pathlib import Path
from time import process_time
start = process_time()
from coeflab.tables.importers import openfoam
run = openfoam.run(Path(sys.argv[1]), {{}})
print(len(run.history), process_time() - start, {PEAK_KILOBYTES})
"""


@pytest.mark.slow
def test_two_million_rows_take_bounded_memory_and_time(case: Callable[[str], Path]) -> None:
    folder, rows = case("org_v10"), 2_000_000
    file = folder / "postProcessing/forcesHull/0/forces.dat"
    lines = file.read_text().splitlines(keepends=True)
    body = lines[3].partition("\t")[2]
    with file.open("w") as stream:
        stream.writelines(lines[:3])
        stream.writelines(f"{i}\t{body}" for i in range(rows))
    done = subprocess.run([sys.executable, "-c", MEASURED, str(folder)], capture_output=True, text=True, check=True)
    count, seconds, peak = map(float, done.stdout.split())
    assert count == rows
    assert peak * 1024 < 500e6
    begin = time.process_time()
    with file.open() as stream:
        for cells in csv.reader(islice(stream, rows // 10), delimiter=" "):
            if not cells[0].startswith("#"):
                for cell in cells:
                    for number in cell.split("\t"):
                        float(number.strip("()") or 0.0)
    assert seconds < 3.0 * 10.0 * (time.process_time() - begin)
