"""The shipped synthetic campaigns are what their script makes, say that they are synthetic, and hold the printed laws."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from types import ModuleType

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS

NAMES = (
    "flyingfish_water_synthetic",
    "flyingfish_air_synthetic",
    "thauv_case_01_synthetic",
    "thauv_case_02_synthetic",
    "thauv_case_03_synthetic",
    "huuv_elevator_synthetic",
)


@cache
def script() -> ModuleType:
    path = shipped("cfd_data") / "make_synthetic_vehicles.py"
    spec = importlib.util.spec_from_file_location("make_synthetic_vehicles", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def table(name: str) -> ForceTable:
    return IMPORTERS.load("csv").read(read_campaign(shipped("cfd_data") / name / FILE))[0]


def test_the_script_makes_these_campaigns_and_no_others() -> None:
    assert sorted(script().files()) == sorted(f"{n}/{f}" for n in NAMES for f in ("campaign.toml", "table.csv"))


@pytest.mark.parametrize("name", NAMES)
def test_shipped_bytes_are_what_the_script_makes(name: str) -> None:
    made = script().files()
    for file in ("table.csv", "campaign.toml"):
        assert (shipped("cfd_data") / name / file).read_bytes() == made[f"{name}/{file}"]


@pytest.mark.parametrize("name", NAMES)
def test_every_campaign_says_that_it_is_synthetic_and_from_what(name: str) -> None:
    campaign = read_campaign(shipped("cfd_data") / name / FILE)
    assert campaign.source.kind == "synthetic"
    assert campaign.name.endswith("_synthetic")
    assert campaign.body.endswith("_synthetic")
    assert "synthetic" in campaign.title
    assert campaign.source.citation.startswith("Synthetic")
    for needed in ("Synthetic", "seed ", "standard deviation"):
        assert needed in campaign.source.how_obtained
    assert campaign.tables[0].sha256


def test_noise_is_of_the_stated_size() -> None:
    """Residuals about the exact law, over the largest force: 0.2 % within what 16 to 96 draws allow."""
    s = script()
    for medium in ("water", "air"):
        t = table(f"flyingfish_{medium}_synthetic")
        for component, motion, (a, b) in zip("XYZKMN", "uvwpqr", s.FLYINGFISH[medium], strict=True):
            x = t.motion[motion]
            exact = -(a + b * np.abs(x)) * x
            share = np.std(t.forces[component] - exact) / np.max(np.abs(exact))
            assert share == pytest.approx(s.DAMPING_NOISE, rel=0.3)


def test_damping_rows_move_one_velocity_at_a_time() -> None:
    t = table("flyingfish_water_synthetic")
    moving = np.array([t.motion[m] != 0.0 for m in "uvwpqr"])
    np.testing.assert_array_equal(moving.sum(axis=0), 1)
    np.testing.assert_array_equal(moving.sum(axis=1), 16)


def test_glider_forces_turn_back_to_lift_and_drag_by_the_papers_equations() -> None:
    """Equations 17 and 18 solved for L and D at 8 degrees and 0.7 m/s, case 01, within five standard deviations."""
    t = table("thauv_case_01_synthetic")
    i = len(t) - 1
    a, v = np.arctan2(t.motion["w"][i], t.motion["u"][i]), 0.7
    assert np.degrees(a) == pytest.approx(8.0)
    x, z = t.forces["X"][i], t.forces["Z"][i]
    lift, drag = x * np.sin(a) - z * np.cos(a), -x * np.cos(a) - z * np.sin(a)
    largest_lift, largest_drag = (1.9169 + 9.5281 * 8.0) * v**2, (11.1159 + 0.215 * 64.0) * v**2
    assert lift == pytest.approx((-1.9169 + 9.5281 * 8.0) * v**2, abs=5 * 0.005 * largest_lift)
    assert drag == pytest.approx(largest_drag, abs=5 * 0.005 * largest_drag)
