"""``coeflab identify`` as a real process."""

from __future__ import annotations

import csv
import json
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from coeflab.core.files import shipped
from tests.cli.conftest import flat
from tests.motion.vehicles import made, with_limits

Run = Callable[..., CompletedProcess[str]]
FILES = ["synthetic.identified.csv", "synthetic.identified.json", "synthetic.identified.svg"]


@pytest.fixture
def params(tmp_path: Path) -> Path:
    (tmp_path / "vehicle.json").write_bytes(with_limits(made(), 0.7, 0.3).to_json())
    return tmp_path / "vehicle.json"


@pytest.mark.slow
def test_from_simulate_to_identify(coeflab: Run, params: Path, tmp_path: Path) -> None:
    """A zigzag and a turning circle of the vehicle give its own coefficients."""
    for manoeuvre in ("zigzag", "turning_circle"):
        done = coeflab("simulate", params, "--manoeuvre", manoeuvre, "--free", "u,v,r", "--out", ".")
        assert done.returncode == 0, done.stderr
    asked = (
        "identify",
        "zigzag.csv",
        "turning_circle.csv",
        "--params",
        params,
        "--terms",
        "file",
        "--resamples",
        "50",
        "--out",
        "out",
    )
    done = coeflab(*asked, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    content = json.loads(done.stdout)
    values = {t["symbol"]: t for t in content["terms"]}
    for symbol, true in {"Yv'": -4e-2, "Nr'": -1e-2, "Ydr'": 1e-2, "Ndr'": -5e-3, "X0'": -4e-3}.items():
        assert values[symbol]["value"] == pytest.approx(true, rel=0.08)
        assert values[symbol]["file_value"] == true
        assert values[symbol]["verdict"] == "no U95 in the file"
    assert any("Messenger" in c for c in content["citations"])
    assert any("rows a window" in s for s in content["statements"])
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == FILES
    rows = list(csv.DictReader((tmp_path / "out" / FILES[0]).read_text().splitlines()))
    assert {r["term"] for r in rows} == set(values)
    saved = json.loads((tmp_path / "out" / FILES[1]).read_text())
    assert saved["terms"] == content["terms"]
    ET.parse(tmp_path / "out" / FILES[2])
    before = {n: (tmp_path / "out" / n).read_bytes() for n in FILES}
    again = coeflab(*asked)
    assert again.returncode == 0
    assert "identified from zigzag.csv, turning_circle.csv" in flat(again.stdout)
    assert "jackknife" in flat(again.stdout)
    assert before == {n: (tmp_path / "out" / n).read_bytes() for n in FILES}


def rows(n: int) -> list[str]:
    return [f"{0.1 * k:g},1.5,0" for k in range(n)]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["t [s],u [m/s],v [m/s]", *rows(5), "0.4,1.5,0", *rows(60)[6:]], ("bad.csv, line 7", "twice the time")),
        (["t [s],u [m/s],v [m/s]", *rows(5), "0.5,nan,0", *rows(60)[6:]], ("bad.csv, line 7", 'column "u [m/s]"')),
        (["t [s],u [m/s],v [m/s]", *rows(20)], ("bad.csv, line 21", "20 rows")),
        (["t,u [m/s],v [m/s]", *rows(60)], ("bad.csv, line 1", "without unit")),
        (["t [s],u [m/s],v [m/s]", *rows(60)], ("stretches", "identify.window")),
    ],
)
def test_one_error_and_exit_code_2(
    coeflab: Run, params: Path, tmp_path: Path, lines: list[str], words: tuple[str, ...]
) -> None:
    (tmp_path / "bad.csv").write_text("\n".join(lines) + "\n")
    done = coeflab("identify", "bad.csv", "--params", params, "--out", "out")
    assert done.returncode == 2
    assert done.stderr.count("error:") == 1
    assert all(w in done.stderr for w in words)
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_nothing_identified_is_exit_code_1(fresh: Run, params: Path, tmp_path: Path) -> None:
    """At rest there is no force: every term stays open."""
    lines = [f"{0.05 * k:g},0,{1e-3 * (-1) ** k:g}" for k in range(2000)]
    (tmp_path / "rest.csv").write_text("\n".join(["t [s],u [m/s],v [m/s]", *lines]) + "\n")
    done = fresh("identify", "rest.csv", "--params", params, "--json", "--window", "3 s")
    assert done.returncode == 1, done.stderr
    content = json.loads(done.stdout)
    assert {t["outcome"] for t in content["terms"]} == {"not identifiable"}
    assert "v does not move beyond noise" in content["terms"][0]["why"]


def test_a_missing_file(coeflab: Run, params: Path) -> None:
    done = coeflab("identify", "nowhere.csv", "--params", params)
    assert done.returncode == 2
    assert "nowhere.csv" in done.stderr


def test_a_bench_test_of_a_rotor(coeflab: Run, tmp_path: Path) -> None:
    series = shipped("cfd_data") / "flyingfish_bench_synthetic" / "air.csv"
    asked = ("identify", series, "--params", "flyingfish_air", "--thruster", "rotor1")
    done = coeflab(*asked, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    thrust = found["curves"][0]
    assert thrust["load"] == "thrust"
    assert thrust["file_value"] == [2.8619e-5, 1.1587e-7]
    assert abs(thrust["value"][1] - 1.1587e-7) <= thrust["u95"][1]
    assert len(found["stretches"]) == 9
    written = coeflab(*asked, "--out", tmp_path / "out")
    assert "Curves of rotor1" in written.stdout
    written = sorted(p.name for p in (tmp_path / "out").iterdir())
    assert [n for n in written if "bench" in n] == ["rotor1.bench.json", "rotor1.bench.svg"]
    assert sum(n.endswith(".parameters.json") for n in written) == 1
    refused = coeflab(*asked[:-1], "rotor9")
    assert refused.returncode == 2
    assert '"--thruster": found the thruster "rotor9"; expected one of rotor1' in refused.stderr
