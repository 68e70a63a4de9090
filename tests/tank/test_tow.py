"""A tow from end to end with a planted solver: what is kept, what is run anew, what comes out and what does not."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.cli import show
from coeflab.core.errors import InputError
from coeflab.core.files import shipped, write_all
from coeflab.core.finding import Severity
from coeflab.law.coefficient import Coefficient, Status
from coeflab.study.checks.symmetry import biases
from coeflab.study.secants import OF_SECANT
from coeflab.study.towed import SECANT, TowedRow
from coeflab.tables.force_table import Exclusion
from coeflab.tank import tables
from coeflab.tank import tow as room
from coeflab.tank.collected import Collected, collected
from coeflab.tank.commands.tow import _fates
from coeflab.tank.folder import CAMPAIGN, PLAN, has_begun, read_plan
from coeflab.tank.jobs import EARLIER, Job, JobState, only_one, outstanding
from coeflab.tank.states import states_of
from coeflab.tank.tank import Tank
from coeflab.tank.tank_file import read_tank
from coeflab.tank.tow import Tow
from coeflab.tank.towed_body import TowedBody
from tests.planted_tank import planted_here
from tests.tank.towed_bodies import BODY_FILE, with_mirrors

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

HEAD = """
[tank]
name = "{name}"
solver = "{solver}"
runner = "here"
[conditions]
speed = "1 m/s"
density = 998.0
viscosity = 1e-6
[matrix]
drift = ["3 deg", "6 deg", "9 deg"]
yaw = {yaw}
"""
TWO = "[0.1, 0.2]"


@pytest.fixture(scope="module", autouse=True)
def _planted(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with planted_here(tmp_path_factory.mktemp("site")):
        yield


def tank_file(folder: Path, more: str = "", *, name: str = "spheroid", solver: str = "planted", yaw: str = TWO) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "tank.toml"
    path.write_text(HEAD.format(name=name, solver=solver, yaw=yaw) + more)
    return path


def laid_out(folder: Path, matrix: Path, out: str = "x") -> Tow:
    """A tow of a body whose surface is of four triangles: the planted solver does not look at it."""
    body = with_mirrors("yz4")
    tank = read_tank(matrix, body, body_file=BODY_FILE)
    return room.laid_out(tank, body, folder / out, matrix)


def towed(tow: Tow) -> Collected:
    room.carried_out(tow, 0, lambda: None)
    return collected(tow)


def states(tow: Tow) -> dict[str, JobState]:
    return {k.name: k.state for k in room.reuse(tow)}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Tow, Collected]:
    """A tow that went well, fitted."""
    folder = tmp_path_factory.mktemp("whole")
    matrix = tank_file(folder)
    tank, body = room.read(shipped("geometry") / "tow_spheroid", matrix)
    tow = room.laid_out(tank, body, folder / "x", matrix)
    return tow, towed(tow)


def test_known_derivatives_come_back(whole: tuple[Tow, Collected]) -> None:
    tow, made = whole
    assert all(run.counts for run in made.runs)
    rows = {r.symbol: r for r in made.six}
    # The planted law in primes; fourfold: attack is drift turned.
    for symbol, known in {"Yv": -6e-3, "Nv": -1.3e-2, "Zw": -6e-3, "Mw": 1.3e-2}.items():
        assert rows[symbol].u95 is not None
        assert rows[symbol].value == pytest.approx(known, abs=max(rows[symbol].u95, 1e-7))
    assert {p.parent.name for p in made.files} >= {"campaign", "report", "histories"}
    assert (tow.folder / "report" / "report.html").is_file()


@pytest.mark.slow
def test_what_u95_leaves_out_and_what_symmetry_should_make_zero_is_said(whole: tuple[Tow, Collected]) -> None:
    _, made = whole
    assert "error of the grid is not in it: there is no grid study" in tables.covers(made.six)
    studied = [replace(r, u_grid=0.0012) for r in made.six]
    assert "By the grid study, 95 %: Yv' 0.0012" in tables.covers(studied)
    assert "not in it" not in tables.covers(studied)
    fit = made.study.fits[0]
    sweep = fit.sweep("Yv")
    for share, severity in ((0.04, Severity.PASS), (0.06, Severity.WARN)):
        bias = share * float(np.abs(sweep.y).min())
        study = replace(made.study, fits=(replace(fit, sweeps=(replace(sweep, bias=bias),)),))
        (found,) = biases(study)
        assert (found.code, found.severity) == ("symmetry.bias", severity)
        assert found.statistic == pytest.approx(share)
        assert found["of_value"] == pytest.approx(abs(bias * sweep.by_row.sum() / sweep.value))
        assert found["row"] == "drift+3"
        (line,) = tables.symmetry_checks(study)
        assert line.startswith("Warning" if severity is Severity.WARN else "Check")
        table = next(t for t in study.tables if t.name == sweep.table)
        at = table.labels.index("drift+3")
        failed = Exclusion(at, 0, "", "unconverged", uncertain=True, status="unconverged")
        usable = {c: mask & (np.arange(len(table)) != at) for c, mask in table.usable.items()}
        without = replace(table, usable=usable, exclusions=(*table.exclusions, failed))
        (still,) = biases(replace(study, tables=tuple(without if t is table else t for t in study.tables)))
        assert (still["row"], still.statistic) == (
            "drift+3",
            pytest.approx(share),
        )  # not over the larger one that is left
        assert still["ended"] != found["ended"] == ""


def test_long_lines_are_folded(capsys: pytest.CaptureFixture[str]) -> None:
    show.command_line("Next", "coeflab tow " + "a_body_with_a_long_name " * 4 + "--continue")
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2
    assert max(map(len, lines)) <= 80
    assert lines[0].endswith(" \\")
    assert tables.solver_name("OpenFOAM 1912, (patch=200626)") == "OpenFOAM 1912 (patch=200626)"


def test_two_rates_give_a_secant_with_a_wide_u95_and_say_why(whole: tuple[Tow, Collected]) -> None:
    """Planted: Yr' = 2e-3, Nr' = -2e-3 and Nrr' = -1e-3, so that the secant at r' = 0.1 is -2.1e-3."""
    rows = {r.symbol: r for r in whole[1].six}
    for symbol, known, slope in (("Yr", 2e-3, 2e-3), ("Nr", -2.1e-3, -2e-3)):
        assert rows[symbol].value == pytest.approx(known, rel=1e-3)
        assert rows[symbol].u95 == pytest.approx(OF_SECANT * abs(known), rel=0.02)
        assert abs(rows[symbol].value - slope) < rows[symbol].u95  # type: ignore[operator]
        assert rows[symbol].why.startswith(SECANT)


def test_one_run_that_did_not_converge_leaves_no_derivative_open(tmp_path: Path) -> None:
    """Three drifts and two rates: no sweep has three runs that count, and its secants are shown."""
    more = '[solver.planted]\nrestless = ["drift+6"]\n'
    matrix = tank_file(tmp_path, more)
    tank, body = room.read(shipped("geometry") / "tow_spheroid", matrix)
    made = towed(room.laid_out(tank, body, tmp_path / "x", matrix))
    for row in made.six:
        assert row.missing == ""
        assert row.u95 >= OF_SECANT * abs(row.value)
    rows = {r.symbol: r for r in made.six}
    planted = -6e-3 - 2e-2 * np.sin(np.radians(3.0))
    assert rows["Yv"].value == rows["Zw"].value == pytest.approx(planted, rel=1e-3)
    assert abs(rows["Yv"].value + 6e-3) < rows["Yv"].u95  # type: ignore[operator]


def test_a_finished_tow_is_kept_and_gives_the_same_bytes(whole: tuple[Tow, Collected]) -> None:
    tow, _ = whole
    before = {p.name: p.read_bytes() for p in (tow.folder / CAMPAIGN).rglob("*") if p.is_file()}
    again = room.laid_out(tow.tank, tow.body, tow.folder, tow.folder / "tank.toml")
    assert set(states(again).values()) == {JobState.FINISHED}
    room.carried_out(again, 0, lambda: pytest.fail("nothing is left to run"))
    with (tow.folder / "drift+6" / "history.csv").open("a") as late:  # as of a solver that was slow to stop
        late.write("161,-9,-9,-9\n")
    collected(again, fitted=False)
    assert {p.name: p.read_bytes() for p in (tow.folder / CAMPAIGN).rglob("*") if p.is_file()} == before


def test_what_an_earlier_tow_finished_is_taken_over_with_the_same_bytes(
    whole: tuple[Tow, Collected], tmp_path: Path
) -> None:
    earlier, _ = whole
    campaign = earlier.folder / CAMPAIGN
    again = room.laid_out(earlier.tank, earlier.body, tmp_path / "x", earlier.folder / "tank.toml")
    runs = [job.name for job in again.jobs if job.needs]
    assert room.taken_over(again, campaign) == tuple(runs)
    room.carried_out(again, 0, lambda: pytest.fail("nothing is left to run"))
    collected(again, fitted=False)
    for path in (p for p in campaign.rglob("*") if p.is_file()):
        assert (tmp_path / "x" / CAMPAIGN / path.relative_to(campaign)).read_bytes() == path.read_bytes(), path.name
    rows = {row.job.name: row for row in states_of(again.folder)}
    mesh = next(row for row in rows.values() if not row.job.needs)
    assert (mesh.left, mesh.progress.why) == (0.0, "not needed: its runs are kept")
    assert (rows["drift+6"].left, rows["drift+6"].progress.state) == (0.0, JobState.FINISHED)


@pytest.mark.slow
def test_only_new_conditions_are_run_beside_those_that_are_taken_over(
    whole: tuple[Tow, Collected], tmp_path: Path
) -> None:
    matrix = tank_file(tmp_path, yaw="[0.1, 0.2, 0.3]")
    tank, body = room.read(shipped("geometry") / "tow_spheroid", matrix)
    tow = room.laid_out(tank, body, tmp_path / "x", matrix)
    room.taken_over(tow, whole[0].folder / CAMPAIGN)
    assert [job.name for job in outstanding(tow.jobs) if job.needs] == ["yaw+0.3"]
    made = towed(tow)
    assert all(run.counts for run in made.runs)
    first = {run.condition.name: run.summary for run in whole[1].runs}
    for run in made.runs:
        assert run.summary is not None
        if run.condition.name in first:
            for name, mean in first[run.condition.name].means.items():
                assert run.summary.means[name] == pytest.approx(mean, rel=1e-5, abs=1e-9)
    assert not (tmp_path / "x" / "yaw+0.3" / EARLIER).exists()
    assert (tmp_path / "x" / "yaw+0.2" / EARLIER).exists()


def test_rows_of_other_cases_and_rows_edited_by_hand_are_not_taken_over(
    whole: tuple[Tow, Collected], tmp_path: Path
) -> None:
    campaign = tmp_path / "campaign"
    shutil.copytree(whole[0].folder / CAMPAIGN, campaign)
    matrix = tank_file(tmp_path)
    matrix.write_text(matrix.read_text().replace("1 m/s", "2 m/s"))
    tank, body = room.read(shipped("geometry") / "tow_spheroid", matrix)
    other = room.laid_out(tank, body, tmp_path / "other", matrix)
    with pytest.raises(InputError, match="none with a case and mesh of this tow"):
        room.taken_over(other, campaign)
    same = room.laid_out(whole[0].tank, whole[0].body, tmp_path / "same", whole[0].folder / "tank.toml")
    drift = campaign / "drift.csv"
    drift.write_text(drift.read_text().replace("drift+6", "drift+7"))
    with pytest.raises(InputError, match="edited by hand"):
        room.taken_over(same, campaign)
    (campaign / "runs.csv").unlink()
    with pytest.raises(InputError, match=r"no runs\.csv"):
        room.taken_over(same, campaign)
    assert not has_begun(same.folder)


def test_a_moved_folder_is_still_the_tow(whole: tuple[Tow, Collected], tmp_path: Path) -> None:
    import shutil

    shutil.copytree(whole[0].folder, tmp_path / "moved")
    assert set(states(room.opened(tmp_path / "moved")).values()) == {JobState.FINISHED}
    assert str(tmp_path) not in (tmp_path / "moved" / PLAN).read_text()


def test_a_folder_named_by_way_of_another_or_by_a_link_keeps_its_jobs(tmp_path: Path) -> None:
    (tmp_path / "aside").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "aside")
    for out, folder in (("aside/../x", "x"), ("link/y", "aside/y")):
        tow = laid_out(tmp_path, tank_file(tmp_path, solver="openfoam"), out)
        assert [row.job for row in states_of(tmp_path / folder)] == [row.job for row in states_of(tow.folder)]


def test_what_changed_is_named_and_run_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tow = laid_out(tmp_path, tank_file(tmp_path))
    room.carried_out(tow, 0, lambda: None)
    before = read_plan(tow.folder)
    denser = (tmp_path / "tank.toml").read_text().replace("998.0", "1025.0")
    (tmp_path / "tank.toml").write_text(denser)
    again = laid_out(tmp_path, tmp_path / "tank.toml")
    found = {k.name: k for k in room.reuse(again, before)}
    assert found["mesh/medium_upper"].what == "kept, finished"
    assert (found["drift+6"].what, found["drift+6"].why) == ("run anew", "its case changed")
    monkeypatch.setenv("PLANTED_VERSION", "planted 2")
    newer = laid_out(tmp_path, tmp_path / "tank.toml")
    why = {k.why for k in room.reuse(newer, before) if k.name != "straight"}
    assert why == {"the solver was planted 1, now planted 2"}


def test_what_a_crashed_run_wrote_says_how_it_goes_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tow = laid_out(tmp_path, tank_file(tmp_path, '[solver.planted]\ncrashes = ["drift+6", "drift+9"]\n'))
    room.carried_out(tow, 0, lambda: None)
    head = (tow.folder / "drift+3" / "history.csv").read_text().splitlines()
    (tow.folder / "drift+9" / "history.csv").write_text("\n".join(head[:48]) + "\n")
    found = {k.name: k.what for k in room.reuse(tow)}
    assert found["drift+6"] == "begins anew, as it had written nothing"
    assert found["drift+9"] == "goes on from what it wrote last, iteration 40"
    _fates(tow, None)
    assert f"Kept: {len(found) - 2} of {len(found)}; go on: 1; run anew: 1; to be run: 0\n" in capsys.readouterr().out


def test_a_case_edited_by_hand_is_named_when_it_is_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solver = room.SOLVERS.load("planted")
    usual = solver.jobs

    def with_dictionary(tank: Tank, body: TowedBody, folder: Path) -> tuple[Job, ...]:
        write_all(folder / "drift+3", {"system/fvSchemes": b"linear;\n", "system/controlDict": b"stopAt endTime;\n"})
        made: tuple[Job, ...] = usual(tank, body, folder)
        return made

    monkeypatch.setattr(solver, "jobs", with_dictionary)
    tow = laid_out(tmp_path, tank_file(tmp_path))
    (tow.folder / "drift+3/system/controlDict").write_text("stopAt writeNow;\n")  # as coeflab stops a run
    assert laid_out(tmp_path, tmp_path / "tank.toml").restored == ()
    (tow.folder / "drift+3/system/fvSchemes").write_text("upwind;\n")
    assert laid_out(tmp_path, tmp_path / "tank.toml").restored == ("drift+3/system/fvSchemes",)


def test_one_of_many_crashes_and_the_others_go_on(tmp_path: Path) -> None:
    matrix = tank_file(tmp_path, '[solver.planted]\ncrashes = ["drift+6"]\nrestless = ["yaw+0.2"]\n')
    tow = laid_out(tmp_path, matrix)
    room.carried_out(tow, 0, lambda: None)
    made = collected(tow, fitted=False)
    bad = {r.condition.name: r for r in made.runs if not r.counts}
    assert {n: r.status for n, r in bad.items()} == {"drift+6": "crashed", "yaw+0.2": "unconverged"}
    assert "planted: floating point exception" in bad["drift+6"].why
    table = (tow.folder / CAMPAIGN / "drift.csv").read_text()
    assert next(line for line in table.splitlines() if line.startswith("drift+6")).endswith(",crashed,,,,,,X Y N")
    # Mended, the crashed run alone is begun again; more iterations carry on the one that did not settle.
    matrix = tank_file(tmp_path, '[solver.planted]\nrestless = ["yaw+0.2"]\niterations = 200\n')
    again = laid_out(tmp_path, matrix)
    assert {n for n, s in states(again).items() if s is not JobState.FINISHED} == {"drift+6", "yaw+0.2"}
    room.carried_out(again, 0, lambda: None)
    assert (tow.folder / "yaw+0.2" / "log.solver").read_text().startswith("from 160")
    assert {n for n, s in states(again).items() if s is not JobState.FINISHED} == {"yaw+0.2"}


def test_a_motion_whose_every_run_crashed_is_open_and_says_so(whole: tuple[Tow, Collected], tmp_path: Path) -> None:
    made = whole[1]
    crashed = [replace(r, state=JobState.CRASHED, summary=None) if r.condition.turns else r for r in made.runs]
    none = [t for t in made.study.tables if "r" not in t.varies]
    lost = replace(made, runs=tuple(crashed), study=replace(made.study, tables=tuple(none)))
    rows = {r.symbol: (r.missing, r.why) for r in lost.six}
    assert rows["Yr"] == rows["Nr"] == ("open", "no turning run used (of 2, 2 crashed)")
    waiting = [replace(r, state=JobState.WAITING) if r.condition.turns else r for r in crashed]
    assert {r.why for r in replace(lost, runs=tuple(waiting)).six if r.symbol == "Yr"} == {"no run varies r"}


def test_conditions_taken_out_of_the_matrix_are_left_on_disk(tmp_path: Path) -> None:
    tow = laid_out(tmp_path, tank_file(tmp_path))
    fewer = laid_out(tmp_path, tank_file(tmp_path, yaw="[0.1]"))
    assert "yaw+0.2" in tow.of
    assert "yaw+0.2" not in fewer.of
    assert (tow.folder / "yaw+0.2" / "case.json").is_file()
    assert not (tow.folder / "yaw+0.2" / "job.json").exists()


def test_another_tow_or_other_files_are_refused(tmp_path: Path) -> None:
    laid_out(tmp_path, tank_file(tmp_path))
    with pytest.raises(InputError, match="the tow of spheroid by planted") as why:
        laid_out(tmp_path, tank_file(tmp_path / "other", name="another"))
    assert "Name another folder" in str(why.value)
    plan = tmp_path / "x" / "tow.json"
    plan.write_text(plan.read_text().replace('"body": "', '"body": "other_'))
    with pytest.raises(InputError, match="a tow of the body other_"):
        laid_out(tmp_path, tank_file(tmp_path))
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.tex").touch()
    with pytest.raises(InputError, match="which is not empty"):
        laid_out(tmp_path, tank_file(tmp_path), "mine")
    assert [p.name for p in (tmp_path / "mine").iterdir()] == ["thesis.tex"]


def test_a_tow_that_stopped_before_its_plan_was_written_is_laid_out_again(tmp_path: Path) -> None:
    tow = laid_out(tmp_path, tank_file(tmp_path))
    plan = (tow.folder / "tow.json").read_bytes()
    (tow.folder / "tow.json").unlink()
    assert laid_out(tmp_path, tank_file(tmp_path)).jobs == tow.jobs
    assert (tow.folder / "tow.json").read_bytes() == plan
    (tow.folder / "tow.json").unlink()
    (tow.folder / tow.tank.solver).mkdir()  # of what a solver writes beside the conditions
    assert laid_out(tmp_path, tank_file(tmp_path)).jobs == tow.jobs
    (tow.folder / "tow.json").unlink()
    (tow.folder / "thesis.tex").touch()
    with pytest.raises(InputError, match="which is not empty"):
        laid_out(tmp_path, tank_file(tmp_path))


def test_two_processes_do_not_tow_in_one_folder(tmp_path: Path) -> None:
    tow = laid_out(tmp_path, tank_file(tmp_path))
    with only_one(tow.folder, "tow"), pytest.raises(InputError, match="one tow at a time in a folder"):
        laid_out(tmp_path, tank_file(tmp_path))


def test_a_solver_that_is_not_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PLANTED_VERSION", "")
    tow = laid_out(tmp_path, tank_file(tmp_path))
    with pytest.raises(InputError, match="apt install planted") as why:
        room.carried_out(tow, 0, lambda: None)
    assert "--solver external" in str(why.value)


def test_an_outside_solver_fills_a_table_in(tmp_path: Path, whole: tuple[Tow, Collected]) -> None:
    body = whole[0].body
    matrix = tank_file(tmp_path, solver="external")
    matrix.write_text(matrix.read_text() + '[solver.external]\nmade_by = "panel code 3"\n')
    tank = read_tank(matrix, body, body_file=whole[0].tank.body)
    tow = room.laid_out(tank, body, tmp_path / "x", matrix)
    assert towed(tow).unfitted == "no sweep has 3 runs that count"
    path = tow.folder / "external" / "forces.csv"
    known = {r.condition.name: r.summary.means for r in whole[1].runs if r.summary is not None}
    lines = path.read_text().splitlines()
    head = next(line for line in lines if line.startswith("condition")).split(",")
    filled = []
    for line in lines:
        name = line.partition(",")[0]
        cells = {c: known[name].get(c.partition(" ")[0]) for c in head} if name in known else {}
        row = [name, *("" if cells.get(c) is None else repr(cells[c]) for c in head[1:])]
        filled.append(",".join(row) if name in known else line)
    path.write_text("\n".join(filled) + "\n")
    values = {r.symbol: r.value for r in collected(tow).six}
    assert values["Yv"] == pytest.approx(-6e-3, rel=1e-2)
    assert values["Mw"] == pytest.approx(1.3e-2, rel=1e-2)
    said = (tow.folder / "campaign" / "campaign.toml").read_text()
    assert "As the table gives it: panel code 3 (forces.csv), read by coeflab" in said
    assert not any(word in said for word in ("plateau", "batch", "iteration noise", "doubled", "converged"))


def test_paths_of_a_copied_tank_lead_where_they_led(tmp_path: Path) -> None:
    mine = tmp_path / "bodies" / "mine"
    mine.mkdir(parents=True)
    (mine / "body.toml").write_bytes((shipped("geometry") / "tow_spheroid" / "body.toml").read_bytes())
    text = HEAD.format(name="mine", solver="external", yaw=TWO).replace(
        "[tank]", '[tank]\nbody = "bodies/mine"  # near'
    )
    (tmp_path / "tank.toml").write_text(text + '[solver.external]\ntable = "filled.csv"\n')
    tank, body = room.read(None, tmp_path / "tank.toml")
    room.laid_out(tank, body, tmp_path / "runs" / "x", tmp_path / "tank.toml")
    again, _, _ = room.reopened(tmp_path / "runs" / "x")
    assert again.body == tank.body
    assert Path(again.options["table"]).resolve() == (tmp_path / "filled.csv").resolve()


def test_no_tow_in_the_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no tow"):
        room.opened(tmp_path)
    (tmp_path / PLAN).write_text(json.dumps({"kind": "coeflab tow 9"}))
    with pytest.raises(InputError, match="coeflab tow 9"):
        room.opened(tmp_path)


def test_estimates_do_not_speak_like_runs() -> None:
    """Nothing converged, and a value whose interval contains zero says so."""
    one = Coefficient("Yv", -0.0066, 0.0086, Status.ESTIMATE, origin="estimate")
    rows = tuple(
        TowedRow(s, replace(one, symbol=s, value=value), None, "", "", (None,), verdict=None)
        for s, value in (("Yv", -0.0066), ("Nv", -0.0143))
    )
    assert tables.is_estimated(rows)
    assert tables.outcome((None,) * 13, tables.is_estimated(rows)) == "13 conditions estimated, none run."  # type: ignore[arg-type]
    tank = SimpleNamespace(
        title="t", reference_point=(0.0, 0.0, 0.0), datum=SimpleNamespace(id="nose"), scaling="LOA 1 m"
    )
    said = {row[0]: row[3] for row in tables.six(tank, rows).rows}  # type: ignore[arg-type]
    assert said == {"Yv'": "estimate; sign open", "Nv'": "estimate"}
    ran = (replace(rows[0], coefficient=replace(one, status=Status.OK, origin="fit")), rows[1])
    assert not tables.is_estimated(ran)
