"""A control is called the same in a campaign's table, in read_table, in a list of runs, in a pattern and over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.tables.column_map import read_column_map
from coeflab.tables.run_list import setting_of
from coeflab.tables.vocabulary import did_you_mean, one_name

NAMES = {
    "dr": ("dr", "delta_r", "rudder", "Rudder_angle", "Seitenruder"),
    "ds": ("ds", "delta_s", "elevator", "stern_plane"),
    "db": ("db", "delta_b", "bow_plane"),
}
EVERY = [(symbol, name) for symbol, names in NAMES.items() for name in names]
CAMPAIGN = """[campaign]
name = "mine"
title = "mine"
body = "boat"
[axes]
frame = "FRD"
datum = "nose"
reference_point = [-1.0, 0.0, 0.0]
[scaling]
length = 2.0
length_name = "LOA"
[conditions]
density = 1000.0
speed = 2.0
[source]
citation = "mine"
kind = "experiment"
how_obtained = "made"
[[table]]
file = "rudder.csv"
contains_inertia = false
"""
DEGREES = (-20.0, -10.0, 0.0, 10.0, 20.0)


def campaign(folder: Path, head: str) -> Path:
    (folder / "campaign.toml").write_text(CAMPAIGN)
    (folder / "rudder.csv").write_text(f"{head} [deg],Y [N],Z [N]\n" + "".join(f"{d},{d},{d}\n" for d in DEGREES))
    return folder


@pytest.mark.parametrize(("symbol", "name"), EVERY)
def test_a_control_has_every_name_everywhere(tmp_path: Path, symbol: str, name: str) -> None:
    """A campaign knew delta_r alone. A word of a stranger's file is asked about in read_table, for its sign."""
    table = cf.read_table(campaign(tmp_path, name))
    assert np.degrees(table.controls[symbol]) == pytest.approx(DEGREES)
    typed = cf.read_table(
        {f"{name} [deg]": np.array(DEGREES), "Y [N]": np.array(DEGREES)}, frame="FRD", about="nose, 1 m aft", length=2.0, density=1000, speed=2.0, accept=True,
    )  # fmt: skip
    assert np.degrees(typed.controls[symbol]) == pytest.approx(DEGREES)
    assert read_column_map(f"-{name} [deg]").name == symbol
    assert (setting_of(name), one_name(name)) == (symbol, symbol)


@pytest.mark.parametrize(
    ("typed", "near"), [("detla_r", "dr"), ("ruder_angel", "dr"), ("Fx", "X"), ("sideslip", "beta"), ("yaw_rate", "r")]
)
def test_an_unknown_name_is_answered_with_a_near_one(tmp_path: Path, typed: str, near: str) -> None:
    assert near in did_you_mean(typed)
    with pytest.raises(InputError) as wrong:
        cf.read_table(campaign(tmp_path, typed))
    assert f"Did you mean {did_you_mean(typed)[13:]}" in wrong.value.advice
    assert did_you_mean("qwertz") == ""


def test_two_names_of_one_control_are_refused(tmp_path: Path) -> None:
    campaign(tmp_path, "rudder [deg],delta_r")
    text = (tmp_path / "rudder.csv").read_text().splitlines()
    (tmp_path / "rudder.csv").write_text("\n".join([text[0], *(f"1.0,{line}" for line in text[1:])]) + "\n")
    with pytest.raises(InputError, match="one of them"):
        cf.read_table(tmp_path)
