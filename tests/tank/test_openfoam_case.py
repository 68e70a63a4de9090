"""Cases of OpenFOAM: what they say, and what the solver makes of them on a spheroid."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.declarations import validated
from coeflab.core.errors import InputError
from coeflab.core.text.foam import FoamCase
from coeflab.tables import openfoam_case
from coeflab.tables.raw_table import Ended
from coeflab.tank.jobs import Job
from coeflab.tank.openfoam import KEEPS_MEMORY, case, step
from coeflab.tank.solvers import openfoam
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half, Kind
from tests.tank import spheroid as towed

Jobs = Callable[[Tank], dict[str, Job]]


@pytest.fixture
def jobs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Jobs:
    """Cases beside meshes that are not made."""
    monkeypatch.setattr(openfoam, "mesh_job", lambda _t, _b, grid, half, *_: towed.mesh_of(tmp_path, grid.name, half))
    monkeypatch.setattr(openfoam, "expected_cells", lambda _: float(towed.CELLS))
    monkeypatch.setattr(openfoam, "installed", lambda: openfoam.Installation("OpenFOAM 1912"))
    return lambda tank: {j.name: j for j in openfoam.jobs(tank, towed.surface(), tmp_path)}


@pytest.mark.parametrize("rates", [(0, 0, 0), (0, 0, 0.2), (0.05, -0.1, 0.2)])
def test_the_frame_gives_the_body_its_velocity(rates: tuple[float, ...]) -> None:
    velocity, turning = np.array([2.0, -0.3, 0.4]), np.array(rates, float)
    water, centre = case.frame(velocity, turning)
    np.testing.assert_allclose(np.cross(turning, -centre) - water, velocity, atol=1e-14)
    np.testing.assert_allclose(np.cross(turning, water), 0.0, atol=1e-14)  # steady in the frame


def test_the_centre_of_an_arm_is_to_starboard_of_a_turn_to_starboard() -> None:
    np.testing.assert_allclose(case.frame(np.array([2.0, 0, 0]), np.array([0, 0, 0.1]))[1], [0, 20, 0])


def test_an_arm_whose_axis_lies_inside_the_tank_is_refused(jobs: Jobs, tmp_path: Path) -> None:
    arm = next(c for c in towed.MATRIX if c.name == "arm")
    tank = towed.tank(arm)
    short = replace(arm, name="yaw+3", kind=Kind.ARM, rates=np.array([0.0, 0.0, 3.0]) * arm.speed / tank.scaling.length)
    with pytest.raises(InputError, match=r"the axis of this arm of .* lies inside the tank") as why:
        jobs(towed.tank(arm, short))
    assert why.value.column == "matrix.yaw"
    assert not list(tmp_path.iterdir())
    largest = float(why.value.expected.split()[2])
    near = {share: replace(short, rates=short.rates * share * largest / 3.0) for share in (1.0, 1.003)}
    assert jobs(towed.tank(near[1.0]))
    with pytest.raises(InputError):
        jobs(towed.tank(near[1.003]))
    # Rolling, and turning on the spot, are no arms.
    assert jobs(towed.tank(replace(short, velocity=np.array([1.0, 0.0, 0.0]), rates=np.array([0.5, 0.0, 0.0]))))
    assert jobs(towed.tank(replace(short, velocity=np.zeros(3), rates=np.array([0.0, 0.0, 0.5]))))


@pytest.mark.parametrize("condition", towed.MATRIX, ids=lambda c: c.name)
def test_the_dictionaries_say_the_condition(jobs: Jobs, condition: towed.TowCondition) -> None:
    job = jobs(towed.tank(condition))[condition.name]
    read = FoamCase(job.folder)
    frame = openfoam_case.rotating_frame(read, "body", {"hull", "stern"}, {})
    found = openfoam_case.body_motion(read, frame, ([0.0, 0.0, 0.0], "controlDict"), "U")
    said = [float(str(found[n].value)) if n in found else 0.0 for n in "uvwpqr"]
    np.testing.assert_allclose(said, [*condition.velocity, *condition.rates], atol=1e-12)
    assert not read.notes


def test_a_case_is_left_alone_where_nothing_changed_and_mended_where_it_did(jobs: Jobs) -> None:
    first = jobs(towed.tank(towed.MATRIX[4]))["arm"]
    files = {f: f.stat().st_mtime_ns for f in first.folder.rglob("*") if f.is_file()}
    assert jobs(towed.tank(towed.MATRIX[4]))["arm"] == first
    assert {f: f.stat().st_mtime_ns for f in first.folder.rglob("*") if f.is_file()} == files
    straight = jobs(towed.tank(replace(towed.MATRIX[0], name="arm")))["arm"]
    assert not (straight.folder / "constant/MRFProperties").exists()
    assert straight.key != first.key
    assert (straight.folder / "constant/polyMesh").readlink() == Path("../../mesh/medium/constant/polyMesh")


def test_a_run_of_a_study_of_iterations_is_of_their_number(jobs: Jobs) -> None:
    studied = [replace(towed.MATRIX[0], name=f"to{n}", variant={"iterations": n}) for n in ("500", "1000")]
    found = jobs(towed.tank(towed.MATRIX[0], *studied))
    assert {n: (j.to_the_end, j.iterations) for n, j in found.items() if not n.startswith("mesh")} == {
        "straight": (False, 400.0), "to500": (True, 500.0), "to1000": (True, 1000.0),
    }  # fmt: skip
    assert found["to500"].key != found["to1000"].key
    assert found["to1000"].seconds == 2.0 * found["to500"].seconds


def test_the_key_is_of_what_changes_the_result(jobs: Jobs) -> None:
    def key(*matrix: towed.TowCondition, **more: object) -> str:
        return jobs(towed.tank(*(matrix or towed.MATRIX[:1]), **more))["straight"].key

    plain = key()
    assert plain == key(options={"iterations": 900, "checkpoint": 7}) == key(cores=2)
    others = {
        key(viscosity=3e-3), key(options={"simplec": True}), key(options={"turbulence": "k-omega SST"}),
        key(replace(towed.MATRIX[0], velocity=np.array([1.1, 0, 0]))), key(replace(towed.MATRIX[0], half=Half.UPPER)),
    }  # fmt: skip
    assert len(others | {plain}) == 6


def test_variants_of_a_study_change_model_and_length(jobs: Jobs) -> None:
    varied = replace(towed.MATRIX[0], variant={"turbulence": "Spalart-Allmaras", "iterations": "50"})
    folder = jobs(towed.tank(varied))["straight"].folder
    assert "SpalartAllmaras" in (folder / "constant/turbulenceProperties").read_text()
    assert "endTime         50;" in (folder / "system/controlDict").read_text()
    assert (folder / "0/nuTilda").is_file()
    with pytest.raises(InputError, match="k-omega SST"):
        jobs(towed.tank(replace(towed.MATRIX[0], variant={"turbulence": "k-omega"})))


def test_water_without_a_viscosity_is_refused(jobs: Jobs) -> None:
    tank = towed.tank(towed.MATRIX[0])
    with pytest.raises(InputError, match="viscosity"):
        jobs(replace(tank, conditions=replace(tank.conditions, viscosity=None)))


def test_a_stop_is_taken_back_and_a_torn_field_is_not_started_from(jobs: Jobs) -> None:
    job = jobs(towed.tank(towed.MATRIX[0], cores=2))["straight"]
    openfoam.stop(job.folder)
    assert "stopAt          writeNow;" in (job.folder / "system/controlDict").read_text()
    for part in ("processor0", "processor1"):
        for at in ("100", "200"):
            (job.folder / part / at).mkdir(parents=True)
            for name in ("U", "p", "phi"):
                torn = (part, at, name) == ("processor1", "200", "p")
                (job.folder / part / at / name).write_text("FoamFile {}\n" + "// **** //" * (not torn))
    steps, at = openfoam.resumed(job)
    assert ([s.name for s in steps], at) == (["simpleFoam"], 100.0)
    assert not (job.folder / "processor0/200").exists()
    names = {
        n: [s.name for s in openfoam.resumed(jobs(towed.tank(towed.MATRIX[0], cores=n))["straight"])[0]] for n in (1, 3)
    }
    anew = ["reconstructPar", "cleanProcessors"]
    assert names == {1: [*anew, "simpleFoam"], 3: [*anew, "decomposePar", "simpleFoam"]}
    assert "stopAt          endTime;" in (job.folder / "system/controlDict").read_text()
    shutil.rmtree(job.folder / "processor0/100")
    steps, at = openfoam.resumed(job)
    assert steps == job.steps
    assert np.isnan(at)


HEADER = (
    "# CofR : (0 0 0)\n# Time total_x total_y total_z pressure_x pressure_y pressure_z viscous_x viscous_y viscous_z\n"
)


def written(folder: Path, rows: int, *names: str, force: float = 1.0) -> Path:
    """Histories of the three function objects, as the solver writes them; the fields of the last row grow."""
    for name in names or ("forces", "hull", "stern"):
        at = folder / "postProcessing" / name / "0"
        at.mkdir(parents=True, exist_ok=True)
        line = "{} {} 2 3 0 0 0 0 0 0\n"
        body = "".join(line.format(i + 1, force if i + 1 == rows else 1.0) for i in range(rows))
        (at / "force.dat").write_text(HEADER + body)
        (at / "moment.dat").write_text(HEADER + body)
    return folder


def test_forces_of_a_half_are_doubled_and_what_is_zero_by_symmetry_is_left_out(jobs: Jobs) -> None:
    out = jobs(towed.tank(*towed.MATRIX))
    for name, kept in (("drift_upper", "XYN"), ("attack_port", "XZM"), ("drift", "XYZKMN")):
        run = openfoam.history(written(out[name].folder, 30))
        factor = 1.0 if name == "drift" else 2.0
        values = dict(zip("XYZKMN", (1, 2, 3, 1, 2, 3), strict=True))
        for table in (run.history, run.patches["hull"], run.patches["stern"]):
            assert {c.means: c.values[-1] for c in table.columns if c.means in values} == {
                n: factor * values[n] for n in kept
            }


def test_a_patch_in_the_half_is_itself_and_its_image_the_other_one(jobs: Jobs, tmp_path: Path) -> None:
    condition = towed.condition("drift_upper", towed.DRIFT, half=Half.UPPER)
    job = openfoam.jobs(towed.tank(condition), towed.with_rudders(), tmp_path)[1]
    control = FoamCase(job.folder).read("system/controlDict")
    assert [n for n, _ in control.part("functions").parts()] == ["forces", "hull", "stern", "rudder_upper", "yPlus"]  # type: ignore[union-attr]
    run = openfoam.history(written(job.folder, 30, "forces", "hull", "stern", "rudder_upper"))
    found = {n: [c.values[-1] for c in t.columns if c.means in set("XYZKMN")] for n, t in run.patches.items()}
    assert found["hull"] == [2.0, 4.0, 6.0]
    assert found["rudder_upper"] == [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]
    assert found["rudder_lower"] == [1.0, 2.0, -3.0, -1.0, -2.0, 3.0]


def test_a_body_that_is_not_its_own_image_is_towed_whole(jobs: Jobs, tmp_path: Path) -> None:
    body = towed.with_rudders()
    moved = body.vertices + np.array([0.0, 0.0, 0.2]) * (np.arange(len(body.vertices)) > 8)[:, None]
    condition = towed.condition("drift_upper", towed.DRIFT, half=Half.UPPER)
    with pytest.raises(InputError, match="rudder_lower"):
        openfoam.jobs(towed.tank(condition), replace(body, vertices=moved), tmp_path)


def test_a_part_cannot_have_the_name_of_something_else(jobs: Jobs, tmp_path: Path) -> None:
    body = replace(towed.surface(), patches=("hull", "far"))
    with pytest.raises(InputError, match="a part named far"):
        openfoam.jobs(towed.tank(towed.MATRIX[0]), body, tmp_path)


def test_before_the_first_iteration_the_history_is_empty(jobs: Jobs) -> None:
    job = jobs(towed.tank(towed.MATRIX[0]))["straight"]
    assert openfoam.history(job.folder).ended is Ended.EMPTY
    assert openfoam.history(written(job.folder, 0)).ended is Ended.EMPTY


def test_forces_beyond_anything_physical_are_divergence(jobs: Jobs) -> None:
    folder = jobs(towed.tank(towed.MATRIX[0]))["straight"].folder
    assert openfoam.history(written(folder, 30, force=7e5)).ended is Ended.WHOLE
    run = openfoam.history(written(folder, 30, force=9e5))
    assert run.ended is Ended.DIVERGED
    assert "iteration 30" in run.why


def test_a_crash_is_said_with_the_log(jobs: Jobs) -> None:
    job = jobs(towed.tank(towed.MATRIX[0]))["straight"]
    banner = "Exec   : simpleFoam\nBuild  : 1912\ntrapFpe: Floating point exception trapping enabled (FOAM_SIGFPE).\n"
    log = written(job.folder, 30) / "log.simpleFoam"
    log.write_text(banner + "Time = 30\n")
    assert openfoam.ended(job)[1] == ""
    log.write_text(banner + "--> FOAM FATAL ERROR: cannot find file\n")
    assert "FOAM FATAL" in openfoam.ended(job)[1]


def test_the_installation_that_is_missing_is_said_with_the_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    openfoam.installed.cache_clear()
    found = openfoam.installed()
    openfoam.installed.cache_clear()
    assert found.version == ""
    assert "apt-get install openfoam" in found.missing
    assert "external" in found.missing


@pytest.mark.parametrize("given", ["many", 0, 2.5, True])
def test_a_count_that_is_none_is_asked_for_as_a_whole_number(tmp_path: Path, given: object) -> None:
    with pytest.raises(InputError, match="expected a whole number, one or more") as why:
        validated(openfoam.OpenFOAM, {"iterations": given}, tmp_path / "tank.toml", lambda _: 3, ("solver", "openfoam"))
    assert why.value.line == 3


def test_a_solver_keeps_its_memory_unless_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GLIBC_TUNABLES", raising=False)
    assert KEEPS_MEMORY in step("simpleFoam", "simpleFoam").command
    monkeypatch.setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=0")
    assert KEEPS_MEMORY not in step("simpleFoam", "simpleFoam").command
