"""``coeflab tow`` as a person types it: dry run, killed and gone on with, looked at from another terminal, refused."""

from __future__ import annotations

import json
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.cli.conftest import COEFLAB, Run, flat
from tests.planted_tank import planted

HEAD = """
[tank]
name = "{name}"
solver = "{solver}"
[conditions]
speed = "1 m/s"
density = 998.0
viscosity = 1e-6
[matrix]
drift = ["3 deg", "6 deg", "9 deg"]
yaw = [0.1, 0.2]
[solver.planted]
pace = {pace}
"""
Done = subprocess.CompletedProcess[str]
PATIENCE = 60.0


def tank_file(folder: Path, *, name: str = "spheroid", solver: str = "planted", pace: float = 0.0) -> Path:
    path = folder / "tank.toml"
    path.write_text(HEAD.format(name=name, solver=solver, pace=pace))
    return path


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    return planted(tmp_path_factory.mktemp("planted") / "site")


def run(folder: Path, environment: dict[str, str], *arguments: str) -> Done:
    command = [str(COEFLAB), "tow", *arguments]
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=PATIENCE
    )


@contextmanager
def begun(folder: Path, environment: dict[str, str], *arguments: str) -> Iterator[subprocess.Popen[str]]:
    """A tow that runs until its end or that of the block."""
    # A shell that starts the tests in the background has them ignore Ctrl-C.
    command = ["env", "--default-signal=INT", str(COEFLAB), "tow", *arguments]
    process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True)  # fmt: skip
    try:
        yield process
    finally:
        process.kill()
        process.communicate(timeout=PATIENCE)


def states(folder: Path) -> dict[str, str]:
    found = {}
    for path in [*folder.glob("*/state.json"), *folder.glob("mesh/*/state.json")]:
        found[path.parent.name] = json.loads(path.read_text())["state"]
    return found


def until(found: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not found():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.05)


def far(folder: Path) -> bool:
    """Whether a condition that runs has written what it can go on from."""
    running = [folder / name / "history.csv" for name, state in states(folder).items() if state == "running"]
    return any(len(path.read_text().splitlines()) > 25 for path in running if path.exists())


def rows(folder: Path) -> dict[str, str]:
    """Lines of the campaign's tables by condition."""
    lines = [line for path in (folder / "campaign").glob("*.csv") if path.name != "runs.csv"
             for line in path.read_text().splitlines() if not line.startswith(("#", "point"))]  # fmt: skip
    return {f"{line.split(',')[0]} {len(line.split(','))}": line for line in lines}


def test_a_dry_run_says_what_it_will_take_and_leaves_nothing(tmp_path: Path, environment: dict[str, str]) -> None:
    tank_file(tmp_path)
    done = run(tmp_path, environment, "tow_spheroid", "--matrix", "tank.toml", "--dry-run", "--cores", "2")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(
        "spheroid: 6 conditions on 1 mesh by planted 1, about 3 min on 2 cores, up to\n400 MB."
    )
    assert "\n1 m/s, 998 kg/m^3, Re 1.2e6.\n" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert "  mesh/medium_upper                             50k  100 MB   5 s\n" in done.stdout
    assert "  yaw+0.1            r' 0.1     z<0   medium    50k  200 MB  60 s\n" in done.stdout
    assert "Zw' = Yv', Mw' = -Nv'" in flat(done.stdout)
    assert done.stdout.endswith("Next: coeflab tow tow_spheroid --matrix tank.toml --out runs/spheroid\n")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["tank.toml"]


def test_a_dry_run_without_a_tank_file_names_its_defaults(tmp_path: Path, environment: dict[str, str]) -> None:
    dry = run(tmp_path, environment, "suboff_bare_hull", "--solver", "estimate", "--dry-run")
    assert dry.returncode == 0, dry.stderr
    assert "\n2 m/s, 998.2 kg/m^3, Re 8.5e6 (defaults; --matrix tank.toml changes them).\n" in dry.stdout


def test_a_missing_solver_says_what_to_install(tmp_path: Path, environment: dict[str, str]) -> None:
    tank_file(tmp_path)
    without = {**environment, "PLANTED_VERSION": ""}
    dry = run(tmp_path, without, "tow_spheroid", "--matrix", "tank.toml", "--dry-run")
    assert dry.returncode == 0
    assert "apt install planted" in flat(dry.stdout)
    done = run(tmp_path, without, "tow_spheroid", "--matrix", "tank.toml", "--out", "x")
    assert done.returncode == 2
    assert "apt install planted. Or take --solver external. The cases are in" in done.stderr
    assert (tmp_path / "x" / "drift+3" / "case.json").is_file()


@pytest.mark.slow
def test_killed_in_the_middle_it_goes_on_and_loses_nothing(tmp_path: Path, environment: dict[str, str]) -> None:
    tank_file(tmp_path, pace=0.08)
    out = tmp_path / "runs" / "x"
    two = ("tow_spheroid", "--matrix", "tank.toml", "--out", "runs/x", "--cores", "2")
    with begun(tmp_path, environment, *two) as process:
        until(lambda: list(states(out).values()).count("finished") >= 3 and "running" in states(out).values())
        until(lambda: len(rows(out)) > 0)
        looked = run(tmp_path, environment, "--status", "--out", "runs/x")
        assert " running" in flat(looked.stdout)
        assert max(map(len, looked.stdout.splitlines())) <= 80
        until(lambda: far(out))
        process.send_signal(signal.SIGKILL)
        process.wait()
    until(lambda: "running" not in states(out).values())
    before = {name: line for name, line in rows(out).items() if ",converged," in line}
    stopped = [name for name, state in states(out).items() if state == "stopped"]
    assert before
    assert stopped
    refused = run(tmp_path, environment, *two)
    assert refused.returncode == 2
    assert "--continue to go on with it, or another --out" in refused.stderr
    tank_file(tmp_path, pace=0.0)  # how fast it goes changes nothing in its key
    done = run(tmp_path, environment, *two, "--continue")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "goes on from what it wrote last" in flat(done.stdout)
    after = rows(out)
    assert {name: after[name] for name in before} == before  # byte for byte
    resumed = {n: json.loads((out / n / "state.json").read_text()) for n in stopped}
    resumed = {n: state for n, state in resumed.items() if state["resumed_from"] is not None}  # others had just begun
    assert resumed
    for name, state in resumed.items():
        assert state["resumed_from"] >= 20
        assert (out / name / "log.solver").read_text() == f"from {state['resumed_from']:.0f}\n"
    assert "6 of 6 conditions converged.\n" in done.stdout
    assert done.stdout.endswith("Next: coeflab next runs/x/campaign\n")
    answer = done.stdout[done.stdout.index("  Yv'") :].splitlines()
    assert answer[0].split()[1:] == ["-0.006000", "0.000019"] or float(answer[0].split()[1]) == pytest.approx(
        -6e-3, rel=1e-2
    )
    assert "no result" in flat(done.stdout)  # two rates give a secant, whose U95 is 60 % of it
    assert max(map(len, done.stdout.splitlines())) <= 80


@pytest.mark.slow
def test_ctrl_c_stops_and_says_how_to_go_on(tmp_path: Path, environment: dict[str, str]) -> None:
    tank_file(tmp_path, pace=0.4)
    with begun(tmp_path, environment, "tow_spheroid", "--matrix", "tank.toml", "--out", "x") as process:
        until(lambda: "running" in [s for n, s in states(tmp_path / "x").items() if "medium" not in n])
        until(lambda: any((tmp_path / "x").glob("*/history.csv")))
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130, said
    assert "Nothing is lost." in said
    assert said.endswith("Next: coeflab tow x --continue\n")
    assert "running" not in states(tmp_path / "x").values()
    done = run(tmp_path, environment, "x", "--status", "--json")
    found = {j["name"]: j["state"] for j in json.loads(done.stdout)["jobs"]}
    assert set(found.values()) <= {"finished", "stopped", "waiting"}
    assert "stopped" in found.values()


def test_an_outside_solver_needs_nothing_installed(coeflab: Run, tmp_path: Path) -> None:
    text = HEAD.format(name="spheroid", solver="external", pace=0.0).partition("[solver.planted]")[0]
    (tmp_path / "tank.toml").write_text(text)
    done = coeflab("tow", "tow_spheroid", "--matrix", "tank.toml", "--out", "x")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("spheroid: 6 conditions to be computed or measured outside coeflab.\n")
    assert "open" not in flat(done.stdout)
    assert "fill in x/external/forces.csv, then coeflab tow x --collect" in " ".join(done.stdout.split())
    assert (tmp_path / "x" / "external" / "run_list.csv").is_file()
    again = coeflab("tow", "x", "--status")
    assert again.returncode == 0
    assert "external needs no runs; 0 of 6 rows of x/external/forces.csv are filled" in " ".join(again.stdout.split())
    forces = tmp_path / "x" / "external" / "forces.csv"
    forces.write_text(forces.read_text().replace("\ndrift+3,", "\ndrift+3,-1.0").replace("\ndrift+6,", "\ndrift+6,2.0"))
    assert "2 of 6 rows" in coeflab("tow", "x", "--status").stdout
    assert coeflab("tow", "x", "--collect").returncode == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--status", "--out", "nothing"), "nothing: found no tow"),
        (("suboff_bare_hull", "--status", "--collect"), "found --status and --collect; expected one of them"),
        ((), "found no body"),
        (("no_such_body",), 'no file or folder "no_such_body"'),
        (("tow_spheroid", "--solver", "nobody"), "no tow solver is called"),
        (("remus100", "--matrix", "missing.toml"), "missing.toml"),
    ],
)
def test_what_cannot_be_is_refused(coeflab: Run, tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    done = coeflab("tow", *arguments)
    assert done.returncode == 2, done.stdout
    assert said in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_tow_without_its_plan_is_laid_out_again(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "x").mkdir()
    (tmp_path / "x" / "tank.toml").touch()
    done = coeflab("tow", "x", "--continue")
    assert done.returncode == 2
    assert "found a tow that was stopped before its cases were written" in flat(done.stderr)
    assert "coeflab tow BODY --matrix TANK --out x" in flat(done.stderr)
