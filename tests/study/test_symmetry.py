"""The check of forces that a declared symmetry forbids, on synthetic tables."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.study.checks import symmetry
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables

CAMPAIGN = """
[campaign]
title = "synthetic"
body = "one"
symmetry = {symmetry}
[axes]
frame = "FRD"
alpha = "w = +U sin(alpha)"
beta = "v = +U sin(beta)"
datum = "nose"
reference_point = {point}
[scaling]
length = 4.0
length_name = "LOA"
[conditions]
density = 1000.0
speed = 2.0
[source]
citation = "synthetic"
kind = "synthetic"
[[table]]
file = "table.csv"
"""


def warned(
    folder: Path, csv: str, declared: str = '["up-down", "port-starboard"]', point: str = "[0, 0, 0]"
) -> list[Check]:
    (folder / "campaign.toml").write_text(CAMPAIGN.format(symmetry=declared, point=point))
    (folder / "table.csv").write_text(csv)
    study: Any = SimpleNamespace(fits=(), tables=read_tables(PlannedTable(folder, ())))
    return list(symmetry.check(study))


def sweep(angle: str, force: str, moment: str, forbidden: str, size: float, error: float = 0.0) -> str:
    head = f"{angle} [deg],X [N],{force} [N],{moment} [N*m],{forbidden} [N]" + f",se_{forbidden} [N]" * bool(error)
    rows = [f"{a},-10,{-1.5 * a},{-0.4 * a},{size}" + f",{error}" * bool(error) for a in (0, 4, 8, 12)]
    return "\n".join([head, *rows]) + "\n"


@pytest.mark.parametrize(
    ("csv", "halves"),
    [
        (sweep("beta", "Y", "N", "Z", -8.0), '"upper" or "lower"'),
        (sweep("alpha", "Z", "M", "Y", 8.0), '"starboard" or "port"'),
    ],
)
def test_forces_of_half_of_a_body_are_named(tmp_path: Path, csv: str, halves: str) -> None:
    (found,) = warned(tmp_path, csv)
    assert found.severity is Severity.WARN
    assert "is 44% of the largest force" in found.statistic  # 8 of 18
    assert f"Forces of half of the body? half_model = {halves} doubles" in found.comment


def test_a_side_force_in_every_row_of_an_attack_sweep_is_named_without_a_declaration(tmp_path: Path) -> None:
    (found,) = warned(tmp_path, sweep("alpha", "Z", "M", "Y", 8.0), '["up-down"]')
    assert "Y is 44%" in found.statistic


@pytest.mark.parametrize(
    ("component", "rest", "slope", "first"),
    [
        ("Y", -0.006, -0.0145, "Forces of half of the body"),  # pressure on the cut
        ("K", 6e-5, 1e-6, "Forces of half of the body"),  # its vertical force at the lever of one half
        ("Y", -0.001, -0.0145, "A large bias: look for a misaligned model"),
        ("K", 2e-6, 1e-7, "A large bias: look for a misaligned model"),  # of a lever of 0.05 % of the length
    ],
)
def test_what_no_angle_changes_names_half_of_a_body_first(
    component: str, rest: float, slope: float, first: str
) -> None:
    v = np.sin(np.radians(np.arange(-8.0, 9.0, 2.0)))
    plain = {
        "variable": "v",
        "value": slope,
        "symmetry": "",
        "campaign": "c",
        "parity": "odd",
        "bias": 0.0,
        "by_symmetry": "",
    }
    sweeps = [SimpleNamespace(component="Y", at_rest=(0.0, 1e-6), y=-0.0145 * v, **plain)]
    sweeps += [SimpleNamespace(component=component, at_rest=(rest, 1e-7), y=rest + slope * v, **plain)]
    study: Any = SimpleNamespace(fits=[SimpleNamespace(sweeps=sweeps, findings=())], tables=())
    found = list(symmetry.check(study))[-1]
    assert found.severity is Severity.WARN
    assert found.comment.startswith(first)


@pytest.mark.parametrize(
    ("csv", "declared"),
    [
        (sweep("beta", "Y", "N", "Z", -8.0), '["port-starboard"]'),  # nothing forbids it
        (sweep("beta", "Y", "N", "Z", 0.2), '["up-down"]'),  # of a mesh that is not quite symmetric
        (sweep("beta", "Y", "N", "Z", 3.0, 1.0), '["up-down"]'),  # noise of the balance
        ("alpha [deg],beta [deg],Y [N],Z [N]\n4,4,-6,-6\n8,4,-6,-12\n", '["up-down"]'),  # not along the plane
    ],
)
def test_what_no_declared_symmetry_forbids_is_no_finding(tmp_path: Path, csv: str, declared: str) -> None:
    assert warned(tmp_path, csv, declared) == []


def test_a_moment_counts_about_a_point_in_the_plane_alone(tmp_path: Path) -> None:
    csv = "beta [deg],X [N],N [N*m],M [N*m]\n" + "".join(f"{a},-10,{-0.4 * a},2\n" for a in (0, 4, 8, 12))
    (found,) = warned(tmp_path, csv)
    assert "M is 42% of the largest moment" in found.statistic
    assert warned(tmp_path, csv, point="[0, 0, 0.1]") == []


def test_no_shipped_campaign_is_doubted() -> None:
    from coeflab.core.files import shipped

    declared = [
        p.parent for p in Path(shipped("cfd_data")).glob("*/campaign.toml") if "\nsymmetry = [" in p.read_text()
    ]
    assert len(declared) > 3
    tables: Any = SimpleNamespace(fits=(), tables=[t for p in declared for t in read_tables(PlannedTable(p, ()))])
    assert symmetry.check(tables) == []
