"""Spoilt files of every importer: read or refused by one clear error, in two seconds and 500 MB each."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from coeflab.tables.importers import IMPORTERS
from tests.conftest import PEAK_KILOBYTES
from tests.tables.mutated_inputs import SAMPLES, SLOWEST_S, Tally, attempt, fuzz, of_foreign_files, with_samples

COUNT = int(os.environ.get("COEFLAB_MUTATED_INPUTS", "2000"))


def test_every_importer_of_foreign_files_has_samples() -> None:
    assert of_foreign_files() == with_samples()


@pytest.mark.slow
@pytest.mark.parametrize("name", with_samples())
def test_spoilt_inputs_are_read_or_refused(name: str) -> None:
    """In a process whose memory ends at 1.5 GB of addresses: a reader that asks for more dies, and the test with it."""
    program = (
        "import resource,sys;resource.setrlimit(resource.RLIMIT_AS,(1500<<20,)*2);"
        "from tests.tables.mutated_inputs import fuzz;t=fuzz(sys.argv[1],int(sys.argv[2]));"
        "print(t.inputs,t.errors,t.read,t.slowest_ms,t.slowest_seed," + PEAK_KILOBYTES + ")"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, name, str(COUNT)], capture_output=True, text=True, cwd=Path(__file__).parents[2],
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    inputs, errors, read, slowest_ms, seed, kilobytes = map(float, done.stdout.split())
    assert inputs == COUNT
    assert errors > 0 < read
    assert slowest_ms < 1000.0 * SLOWEST_S, f"seed {seed:.0f}"
    assert kilobytes < 500_000


def test_the_harness_lets_nothing_but_input_errors_pass(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = IMPORTERS.load("table")

    def broken(_path: Path, _options: object) -> None:
        raise KeyError("x")

    monkeypatch.setattr(table, "raw", broken)
    with pytest.raises(KeyError):
        attempt(table, next((SAMPLES / "table").iterdir()))
    monkeypatch.setattr("tests.tables.mutated_inputs.tempfile.gettempdir", lambda: str(tmp_path))
    with pytest.raises(KeyError) as why:
        fuzz("table", 3)
    assert "importer table, seed 0" in why.value.__notes__[0]
    assert isinstance(Tally("table").line, str)
