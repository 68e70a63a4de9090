"""A column whose sign is wrong all over: noticed where every hull has that sign, else named as one that would not be noticed."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.finding import Severity
from coeflab.study.checks.signs import check as signs
from coeflab.study.checks.signs import unseen_columns
from coeflab.study.plan import ParameterFileKeys
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from coeflab.tables.reading import table_at

CAMPAIGN = """[campaign]
name = "t"
title = "t"
body = "b"
[axes]
frame = "FRD"
beta = "v = -U sin(beta)"
datum = "nose"
reference_point = [-1.0, 0, 0]
[scaling]
length = 2.0
length_name = "LOA"
[conditions]
density = 1000.0
speed = 1.5
[source]
kind = "cfd"
citation = "own numbers"
how_obtained = "computed"
[[table]]
file = "drift.csv"
contains_inertia = false
"""
SLOPES = {"Y": -0.02, "K": -0.0004, "N": -0.009}


def with_signs(folder: Path, **signs: float) -> Study:
    """A study of one drift sweep; of a column named, every value is multiplied."""
    beta = np.arange(-8.0, 9.0, 2.0)
    v, size = -np.sin(np.radians(beta)), 0.5 * 1000 * 1.5**2 * 4.0
    ripple = 2e-6 * np.cos(7.0 * beta)
    columns = [signs.get(c, 1.0) * size * (1.0 if c == "Y" else 2.0) * (s * v + ripple) for c, s in SLOPES.items()]
    rows = [",".join(f"{x:.8g}" for x in row) for row in zip(beta, *columns, strict=True)]
    (folder / "campaign.toml").write_text(CAMPAIGN)
    (folder / "drift.csv").write_text("\n".join(["beta [deg],Y [N],K [N*m],N [N*m]", *rows]) + "\n")
    table = table_at(folder, ("slope_at_origin",), {"slope_at_origin": {}})
    return run(Plan(name="t", title="t", tables=(table,)), lambda _: None)


@pytest.mark.parametrize("column", ["", *SLOPES])
def test_what_is_not_noticed_is_named(column: str, tmp_path: Path) -> None:
    study = with_signs(tmp_path, **({column: -1.0} if column else {}))
    noticed = {c.subject.split()[-1][0] for c in signs(study) if c.severity is Severity.FAIL}
    assert noticed == ({"Y"} if column == "Y" else set())
    (found,) = unseen_columns(study)
    named = {str(text)[0] for text in found["columns"]}
    assert named == {"K", "N"}
    assert column == "" or column in noticed | named


def test_the_advice_is_a_key_of_the_plan(tmp_path: Path) -> None:
    """``hull under [[parameter_file]]`` was no key."""
    (found,) = unseen_columns(with_signs(tmp_path))
    key = found.advice.split()[0]
    assert key in {f.name for f in fields(ParameterFileKeys)}
