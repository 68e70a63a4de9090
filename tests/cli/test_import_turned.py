"""``coeflab import`` of a body turned in one inflow: forces along the flow are never taken as those of the body without a word."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import flat
from tests.cli.test_import import invoke, without_slopes
from tests.cli.test_import_half import case

__all__ = ["without_slopes"]


def test_runs_that_share_a_reason_are_refused_once(tmp_path: Path) -> None:
    for degrees in (0, 4, 8):
        case(tmp_path / "runs" / f"b{degrees}", degrees)
    for file in tmp_path.glob("runs/*/postProcessing/forces/0/*.dat"):
        file.write_text("".join(line for line in file.read_text().splitlines(keepends=True) if line[0] != "#"))
    done = invoke("import", tmp_path / "runs", "--out", tmp_path / "out")
    assert done.exit_code == 2
    assert flat(done.output).count("no line of column names") == 1
    assert "no readable run of 3: b0, b4 and b8 (postProcessing" in flat(done.output)
