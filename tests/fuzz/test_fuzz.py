"""Every parser on spoilt inputs: read or refused by one clear error, in two seconds and 300 MB each; and every input that once was not."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from coeflab.tables.importers import IMPORTERS
from tests.conftest import PEAK_KILOBYTES
from tests.fuzz.fuzz import CASES, SLOWEST_S, Tally, case_is_refused, fuzz, is_read
from tests.fuzz.parsers import ROOT, SAMPLES, Parser, attempt, of_foreign_files, parsers, with_samples

COUNT = int(os.environ.get("COEFLAB_FUZZED", "80"))  # inputs of a parser of share 1; 31,000 make a million
FIRST = int(os.environ.get("COEFLAB_FUZZ_FIRST", "0"))
ALL = list(parsers())
HALVES = (ALL[::2], ALL[1::2])
# Readers that are reached through those that are fuzzed, or read what this process wrote itself.
THROUGH = {
    "toml.read_text": "toml", "coded_thrusters.read_angle": "writes code", "actuators.read_limits": "models", "arm_file.read_chain": "arm", "body.read_body": "body", "campaign.read_campaign": "campaign",
    "coefficient_list.read_coefficient_list": "table",
    "dialect.read_head": "table", "five_dof.read_five_dof": "shipped files", "glide_polar.read_printed": "a list of SYMBOL=NUMBER",
    "huuv.read_huuv": "shipped files", "json.parse_json": "json", "law.read_fossen_link": "models", "law.read_gz_link": "models",
    "law.read_tags": "models", "lift_drag.read_lift_drag": "models", "m_file.read_m_file": "models", "model_files.read_vehicle_file": "models", "model.read_flyingfish": "shipped files", "model.read_huuv": "shipped files",
    "monitors.read_monitor": "fluent", "openfoam_case.read_log": "openfoam", "options.parse_options": "plan", "parameters.read_parameters": "parameters",
    "parts.read_parts": "openfoam", "reading.read_groups": "campaign", "reading.read_raw": "table", "reading.read_table": "campaign",
    "records.read_record": "job", "runs.read_all": "openfoam", "runs.read_run": "openfoam", "series.read_comments": "openfoam",
    "settings.read_setting": "setting", "settings.read_settings": "setting", "symbols.read_factors": "symbol", "terms.parse_suffix": "symbol",
    "named_terms.read_terms": "equation", "vehicle.read_vehicle": "models", "xml.read_xml": "models", "yaml.read_yaml": "models",
}  # fmt: skip


def test_every_importer_of_foreign_files_has_samples() -> None:
    assert of_foreign_files() == with_samples()


def readers() -> Iterator[str]:
    """Functions of the package that read or parse something, as file.function."""
    for file in (ROOT / "coeflab").rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        if "def read_" in text or "def parse_" in text:
            for node in ast.parse(text).body:
                if isinstance(node, ast.FunctionDef) and node.name.startswith(("read_", "parse_")):
                    yield f"{file.stem}.{node.name}"


def test_every_reader_is_fuzzed_or_reached() -> None:
    """A new parser has to be named here or in `parsers`."""
    named = (Path(__file__).parent / "parsers.py").read_text(encoding="utf-8")
    assert [r for r in readers() if r not in THROUGH and r.partition(".")[2] not in named] == []


@pytest.mark.slow
@pytest.mark.parametrize("names", HALVES, ids=["even", "odd"])
def test_spoilt_inputs_are_read_or_refused(names: list[str]) -> None:
    """In a process whose memory ends at 1.5 GB of addresses: a reader that asks for more dies, and the test with it."""
    program = (
        "import resource,sys;resource.setrlimit(resource.RLIMIT_AS,(1500<<20,)*2);"
        "from tests.fuzz.fuzz import fuzz;from tests.fuzz.parsers import parsers;p=parsers()\n"
        "for n in sys.argv[3:]:\n"
        " t=fuzz(n,max(20,round(int(sys.argv[1])*p[n].share)),int(sys.argv[2]));print(n,t.inputs,t.refused,t.read,t.slowest_ms,t.slowest_seed,"
        + PEAK_KILOBYTES + ")"
    )  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-c", program, str(COUNT), str(FIRST), *names], capture_output=True, text=True, cwd=ROOT,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    lines = [line.split() for line in done.stdout.splitlines()]
    assert [line[0] for line in lines] == names
    for name, inputs, refused, read, slowest_ms, seed, kilobytes in lines:
        assert int(inputs) == int(refused) + int(read)
        assert int(refused) > 0 or name in ("header", "words"), name
        assert int(read) > 0, name
        assert float(slowest_ms) < 1000.0 * SLOWEST_S, f"{name}, seed {seed}"
        assert float(kilobytes) < 300 << 10, name


@pytest.mark.parametrize(
    "case", sorted(p for p in CASES.glob("*/*") if p.is_file()), ids=lambda p: f"{p.parent.name}/{p.name}"
)
@pytest.mark.filterwarnings("ignore")
def test_what_was_once_a_fault(case: Path) -> None:
    case_is_refused(case)


def test_the_harness_lets_nothing_but_input_errors_pass(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = IMPORTERS.load("table")

    def broken(_path: Path, _options: object) -> None:
        raise KeyError("x")

    monkeypatch.setattr(table, "raw", broken)
    with pytest.raises(KeyError):
        attempt(table, next((SAMPLES / "table").iterdir()))
    monkeypatch.setattr("tests.fuzz.fuzz.tempfile.gettempdir", lambda: str(tmp_path))
    with pytest.raises(KeyError) as why:
        fuzz("table", 3)
    assert "parser table, seed 0" in why.value.__notes__[0]
    assert isinstance(Tally("table").line, str)
    with pytest.raises(ZeroDivisionError):
        is_read(Parser((), lambda _: 1 / 0, ("a",)), "a")
