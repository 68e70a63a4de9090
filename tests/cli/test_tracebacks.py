"""Numbers that no vehicle has, consoles that are closed or narrow: one clear error, exit code 2, no traceback."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.profiles import Myring
from coeflab.core.errors import InputError, shown
from coeflab.core.files import shipped
from coeflab.report.rendered import rendered
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.vehicle.stability import index_gradient, stability_index
from tests.cli.conftest import COEFLAB, Run, flat

HUUV = shipped("cfd_data") / "huuv" / "huuv.parameters.json"
SAMPLE = Path(__file__).parents[1] / "data" / "parameters_1_3.json"


@pytest.fixture
def study(coeflab: Run, tmp_path: Path) -> Path:
    coeflab("new", "s")
    return tmp_path / "s"


@pytest.mark.parametrize("force", ["0", "1e-320"])
def test_forces_of_nothing_make_a_report(study: Path, force: str) -> None:
    """Before: ZeroDivisionError in the stability index and in the table of forces at rest."""
    table = study / "campaign" / "drift.csv"
    lines = [line.split(",") for line in table.read_text().splitlines()]
    table.write_text("".join(",".join([*c[:2], *[force] * 3, *c[5:]] if c[0].isdigit() else c) + "\n" for c in lines))
    assert rendered(run(read_plan(study / "plan.toml")))


@pytest.mark.parametrize(
    ("length", "said"),
    [
        ("1e300", '"scaling.length": found "1e+300"; expected a finite number'),
        ("1e-300", "expected a value above zero, from 1e-18"),
        ("9" * 4301, "found an integer of thousands of digits; expected at most 4,300 digits"),
        ("0x" + "f" * 4301, '"scaling.length": found "an integer of thousands of digits"'),
    ],
)
def test_lengths_that_nothing_has(study: Path, length: str, said: str) -> None:
    """Before: OverflowError, ZeroDivisionError and ValueError."""
    plan = study / "plan.toml"
    plan.write_text(plan.read_text().replace("length = 1.60", f"length = {length}"))
    with pytest.raises(InputError) as caught:
        read_plan(plan)
    assert said in str(caught.value)
    assert "plan.toml" in str(caught.value)


def test_an_integer_that_python_does_not_write() -> None:
    assert "thousands of digits" in shown(16**5000)


@pytest.mark.parametrize("asked", [("--speed", "1e300"), ("--speed", "2 m/s", "--yaw-rate", "1e300 deg/s")])
def test_trim_at_impossible_motions(coeflab: Run, asked: tuple[str, ...]) -> None:
    """Before: LinAlgError."""
    done = coeflab("trim", HUUV, *asked)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "1e+300" in done.stderr.replace("1e300", "1e+300")


def test_identify_from_impossible_speeds(coeflab: Run, tmp_path: Path) -> None:
    rows = "".join(f"{k},1e300,0.1,0.01,1\n" for k in range(2000))
    (tmp_path / "u.csv").write_text("t [s],u [m/s],v [m/s],r [rad/s],dr [deg]\n" + rows)
    done = coeflab("identify", "u.csv", "--params", HUUV)
    assert done.returncode == 2
    assert 'u.csv, line 2, column "u [m/s]": found "1e300"' in done.stderr


@pytest.mark.parametrize("name", ["nose", "tail", "diameter", "middle"])
@pytest.mark.parametrize("value", [1e308, 1e5])
def test_hulls_of_impossible_lengths(name: str, value: float) -> None:
    """Before: a hull of infinite volume, ValueError of a spline."""
    sizes = {"nose": 0.2, "middle": 0.6, "tail": 0.5, "diameter": 0.2, name: value}
    with pytest.raises(InputError, match="length"):
        Myring(**sizes, exponent=2.0, tail_angle=0.4)


def test_a_stability_index_without_a_slope_is_no_number() -> None:
    without, about = (0.0, -0.01, 0.005, -0.003, 0.01, 0.0), (-0.02, -0.01, 0.005, -0.003, 0.01, 0.0)
    assert not np.isfinite(index_gradient(*without)).all()
    assert not np.isfinite(stability_index(*without))
    assert np.isfinite(index_gradient(*about)).all()
    assert np.isfinite(stability_index(*about))


@pytest.mark.parametrize("encoding", ["latin-1", "ascii", "cp1252"])
def test_consoles_that_lack_letters(study: Path, encoding: str) -> None:
    """Before: UnicodeEncodeError. JSON stays JSON."""
    plan = study / "plan.toml"
    plan.write_text(plan.read_text().replace('title = "', 'title = "Ψ → 😀 é ', 1))
    seen = {**os.environ, "PYTHONIOENCODING": encoding}
    for options in ((), ("--json",)):
        command = [str(COEFLAB), "run", str(plan), *options]
        done = subprocess.run(command, cwd=study, capture_output=True, env=seen, check=False, timeout=120)
        assert done.returncode in (0, 1), done.stderr
        assert b"Traceback" not in done.stderr
    assert json.loads(done.stdout.decode(encoding))


@pytest.mark.parametrize("closed", [">&-", ">&- 2>&-", "<&- >&- 2>&-"])
def test_closed_standard_output(study: Path, closed: str) -> None:
    """Before: AttributeError, exit code 1."""
    command = f"{COEFLAB} inspect {study / 'campaign'} {closed}"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("closed standard output") == (closed == ">&-")
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_closed_standard_error_and_input(study: Path) -> None:
    command = f"{COEFLAB} inspect {study / 'campaign'} <&- 2>&-"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0
    assert "drift.csv" in flat(done.stdout)


@pytest.mark.parametrize("address", ["garbage://", "tcp://256.256.256.256:99999", "x y", "tcp://"])
def test_schedulers_that_are_no_address(coeflab: Run, address: str) -> None:
    """Before: a traceback of a client that waited for 20 s."""
    done = coeflab(
        "uncertainty", SAMPLE, "--scheduler", address, "--members", "40", "--manoeuvre", "straight_run", "--hold", "u"
    )
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "which is no address" in done.stderr
