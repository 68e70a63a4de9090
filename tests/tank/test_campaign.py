"""What a tow gave becomes a campaign: tables that read as any other, with what every row comes from."""

from __future__ import annotations

import csv
import hashlib
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.force_table import ForceTable
from coeflab.tables.histories import Convergence
from coeflab.tables.raw_table import RawColumn, RawTable, Run, Stated
from coeflab.tables.reading import read_tables, table_at
from coeflab.tables.run_summary import RunSummary
from coeflab.tank.campaign import campaign_files, rows_of, short_history
from coeflab.tank.jobs import Job, JobState, Progressed
from coeflab.tank.tank import Tank
from coeflab.tank.tank_file import read_tank
from coeflab.tank.test_matrix import Kind, TowCondition
from coeflab.tank.towed_run import TowedRun, towed_run
from tests.planted_tank import forces
from tests.tank.towed_bodies import BODY_FILE, with_mirrors

WATER = '[tank]\nsolver = "external"\n[conditions]\nspeed = 2.0\ndensity = 998.0\nviscosity = 1e-6\n'
MATRIX = """
[matrix]
drift = ["2 deg", "4 deg", "8 deg"]
yaw = [0.1, 0.2, 0.3]
"""
STUDY = '[[study]]\nof = ["drift+4"]\ngrid = ["coarse", "fine"]\ndomain = [1.5]\n'
MESH = hashlib.sha256(b"mesh").hexdigest()


def towed(tank: Tank, **cells: float) -> list[TowedRun]:
    """Every condition as a finished run of the known law; the cells of its grid."""
    many = {"coarse": 2.3e5, "medium": 5e5, "fine": 1.1e6}
    return [
        TowedRun(
            c, JobState.FINISHED, "", RunSummary(
                c.name, Convergence.CONVERGED, means=(means := forces(tank, c)),
                errors={k: 1e-3 * (1.0 + abs(x)) for k, x in means.items()}, iterations=412.0,
                stated_conditions={"cells": Stated(many[c.grid], "case.json")},
                patches={f"{k}(hull)": (0.9 * x, "N") for k, x in means.items()},
            ),
            case=hashlib.sha256(c.name.encode()).hexdigest(), mesh=MESH,
        )
        for c in tank.matrix
    ]  # fmt: skip


def tank_of(folder: Path, mirrors: str, text: str = MATRIX) -> Tank:
    (folder / "tank.toml").write_text(WATER + text)
    return read_tank(folder / "tank.toml", with_mirrors(mirrors), body_file=BODY_FILE)


def written(folder: Path, tank: Tank, mirrors: str, runs: list[TowedRun]) -> dict[str, ForceTable]:
    files = campaign_files(tank, with_mirrors(mirrors), runs, "planted 1", {"tank.toml": folder / "tank.toml"})
    out = folder / "campaign"
    for name, content in files.items():
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_bytes(content)
    return {t.name.partition("/")[2]: t for t in read_tables(table_at(out))}


def test_a_run_that_has_just_begun_takes_no_standard_error_from_finished_rows(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "y")
    runs = towed(tank)
    begun = next(i for i, r in enumerate(runs) if r.condition.kind is Kind.DRIFT)
    summary = runs[begun].summary
    assert summary is not None
    runs[begun] = replace(
        runs[begun], state=JobState.RUNNING, summary=replace(summary, status=Convergence.TOO_SHORT, errors={})
    )
    table = written(tmp_path, tank, "y", runs)["drift.csv"]
    row = table.labels.index(runs[begun].condition.name)
    others = [i for i in range(len(table)) if i != row]
    for component in ("Y", "N"):
        assert np.all(table.errors[component][others] > 0.0)
        assert not table.usable[component][row]


def test_tables_read_as_any_other_and_hold_what_was_towed(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "y")
    tables = written(tmp_path, tank, "y", towed(tank))
    assert set(tables) == {"drift.csv", "attack.csv", "arm.csv"}
    for name, variable in (("drift.csv", "v"), ("attack.csv", "w"), ("arm.csv", "r")):
        assert tables[name].varies == (variable,)
    drift = tables["drift.csv"]
    by_name = {c.name: c for c in tank.matrix}
    for i, label in enumerate(drift.labels):
        c = by_name[label]
        known = forces(tank, c)
        assert [drift.motion[m][i] for m in "uvw"] == pytest.approx(c.velocity.tolist(), abs=1e-11)
        for component in drift.forces:
            assert drift.forces[component][i] == pytest.approx(known[component], rel=1e-5, abs=1e-9)
    assert drift.source.kind == "cfd"
    assert drift.datum.id == "nose"
    assert drift.reference_point.tolist() == pytest.approx(tank.reference_point.tolist())
    assert drift.scaling == tank.scaling
    assert not any(drift.exclusions)
    arm = tables["arm.csv"]
    assert arm.primed_motion("r", tank.scaling.length).tolist() == pytest.approx([0.1, 0.2, 0.3])
    assert arm.arm_point.tolist() == tank.reference_point.tolist()
    assert arm.motion["v"].tolist() == [0.0] * 3


def test_a_row_that_did_not_converge_is_there_and_counts_for_nothing(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "y")
    runs = {r.condition.name: r for r in towed(tank)}
    runs["drift+4"] = replace(runs["drift+4"], state=JobState.UNCONVERGED, why="Y still moves by 0.3")
    runs["drift+8"] = replace(runs["drift+8"], state=JobState.CRASHED, why="log.solver:3: NaN", summary=None)
    runs["yaw+0.2"] = replace(runs["yaw+0.2"], state=JobState.WAITING, summary=None)
    tables = written(tmp_path, tank, "y", list(runs.values()))
    drift = tables["drift.csv"]
    at = drift.labels.index("drift+4")
    assert np.isfinite(drift.forces["Y"][at])
    assert {e.status for e in drift.exclusions} == {"unconverged", "crashed"}
    for row in ("drift+4", "drift+8"):
        assert not any(mask[drift.labels.index(row)] for mask in drift.usable.values())
    assert {e.status for e in tables["arm.csv"].exclusions} == {"not run"}
    listed = {r["condition"]: r for r in csv.DictReader((tmp_path / "campaign/runs.csv").read_text().splitlines())}
    assert listed["drift+4"]["why"] == "Y still moves by 0.3"
    assert listed["drift+8"]["case sha256"] == hashlib.sha256(b"drift+8").hexdigest()
    assert listed["drift+8"]["mesh sha256"] == MESH


def test_a_finished_run_that_still_drifts_is_marked(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "y")
    runs = towed(tank)
    late = runs[-1].summary
    assert late is not None
    runs[-1] = replace(runs[-1], summary=replace(late, status=Convergence.DRIFTING))
    tables = written(tmp_path, tank, "y", runs)
    assert [e.status for e in tables["arm.csv"].exclusions if e.component == "Y"] == ["drifting"]


def test_fourfold_bodies_get_attack_from_drift_turned_by_90_deg(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "yz4")
    assert not any(c.velocity[2] for c in tank.matrix)
    tables = written(tmp_path, tank, "yz4", towed(tank))
    drift, attack = tables["drift.csv"], tables["attack.csv"]
    assert set(drift.forces) == {"X", "Y", "N"}
    assert set(attack.forces) == {"X", "Z", "M"}
    assert attack.motion["w"].tolist() == drift.motion["v"].tolist()
    assert attack.forces["Z"].tolist() == drift.forces["Y"].tolist()  # Zw = Yv
    assert attack.forces["M"].tolist() == (-drift.forces["N"]).tolist()  # Mw = -Nv
    pitch, arm = tables["arm_pitch.csv"], tables["arm.csv"]
    assert pitch.motion["q"].tolist() == (-arm.motion["r"]).tolist()
    assert pitch.forces["M"].tolist() == (-arm.forces["N"]).tolist()  # Mq = Nr
    assert pitch.forces["Z"].tolist() == arm.forces["Y"].tolist()  # Zq = -Yr
    assert (tmp_path / "campaign/attack.csv").read_text().startswith("# Not run: by fourfold symmetry, from drift.csv")
    assert "By symmetry: attack" in (tmp_path / "campaign/campaign.toml").read_text()


def test_attack_that_was_run_is_not_stated(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "yz4", MATRIX + 'attack = ["2 deg", "4 deg", "8 deg"]\n')
    tables = written(tmp_path, tank, "yz4", towed(tank))
    assert not (tmp_path / "campaign/attack.csv").read_text().startswith("#")
    assert set(tables["attack.csv"].forces) == {"X", "Z", "M"}


def test_rows_of_studies_do_not_enter_fits_as_rows(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "y", MATRIX + STUDY)
    drift = written(tmp_path, tank, "y", towed(tank))["drift.csv"]
    out = {drift.labels[e.row] for e in drift.exclusions}
    assert out == {"drift+4_grid_coarse", "drift+4_grid_fine", "drift+4_domain_1.5"}
    assert sorted(set(drift.cells)) == [2.3e5, 5e5, 1.1e6]
    assert drift.variants[drift.labels.index("drift+4_domain_1.5")] == "domain = 1.5"


def test_the_same_runs_give_the_same_bytes(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "yz4", MATRIX + STUDY)
    one, two = (campaign_files(tank, with_mirrors("yz4"), towed(tank), "planted 1") for _ in range(2))
    assert one == two


def test_a_method_without_runs_gives_rows_by_name(tmp_path: Path) -> None:
    tank = tank_of(tmp_path, "y")
    names = [c.name for c in tank.matrix if c.name != "drift+8"]
    known = {c.name: forces(tank, c) for c in tank.matrix}
    columns = [RawColumn(c, "N", np.array([known[n].get(c, math.nan) for n in names]), means=c) for c in "XYZMN"]
    table = RawTable(tmp_path / "forces.csv", tuple(columns), row_labels=tuple(names))
    runs = {r.condition.name: r for r in rows_of(tank, table)}
    assert runs["drift+8"].state is JobState.WAITING
    assert runs["drift+4"].summary.means == known["drift+4"]
    drift = written(tmp_path, tank, "y", list(runs.values()))["drift.csv"]
    assert {drift.labels[e.row] for e in drift.exclusions} == {"drift+8"}


def test_a_short_history_keeps_its_ends() -> None:
    at = RawColumn("iteration", "-", np.arange(1.0, 1001.0), means="iteration")
    y = RawColumn("Fy", "N", np.arange(1000.0), means="Y")
    lines = short_history(Run(Path(), "x", RawTable(Path(), (at, y))), 50).decode().splitlines()
    assert (lines[0], lines[1], lines[-1]) == ("iteration,Y [N]", "1,0", "1000,999")
    assert len(lines) == 51


def test_a_smooth_approach_counts_from_where_it_was_judged() -> None:
    rows = np.arange(655.0)
    columns = [RawColumn(c, "N", 50.0 * (1.0 + 0.5 * np.exp(-rows / 100.0)), means=c) for c in ("X", "Y")]
    history = Run(Path("run"), "run", RawTable(Path("run"), tuple(columns)))
    job = Job("run", Path("run"), "slow", ())
    condition = TowCondition("run", Kind.DRIFT, np.array([1.0, 0.1, 0.0]), np.zeros(3))
    found = towed_run(condition, Progressed(JobState.FINISHED, plateau=655), {}, job, history)
    assert found.counts
    assert found.summary.means["Y"] == pytest.approx(50.0, rel=0.005)
    assert found.history is history
