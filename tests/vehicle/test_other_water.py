"""A file for water of another density: what goes with it, what stays, and that the file still agrees with itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.table import as_check
from coeflab.formats.export import export
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.other_water import OTHER_WATER, in_water
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

NU = np.array([[1.5, 0.1, -0.05, 0.0, 0.02, 0.1]])


def test_forces_and_added_mass_go_with_the_density_and_mass_and_volume_stay() -> None:
    here = read_parameter_file(Path("remus100"))
    there = in_water(here, 1.1 * here.conditions.density)
    assert motion_law(there)[0].force(NU) == pytest.approx(1.1 * motion_law(here)[0].force(NU), rel=1e-12)
    old, new = vehicle(here), vehicle(there)
    assert new.added == pytest.approx(1.1 * old.added, rel=1e-12)
    assert (new.mass, new.weight) == (old.mass, old.weight)
    assert new.buoyancy == pytest.approx(1.1 * old.buoyancy, rel=1e-12)
    assert there.mass.mass_prime == pytest.approx(here.mass.mass_prime / 1.1, rel=1e-12)
    assert ParameterFile.model_validate_json(there.to_json()).conditions.density == there.conditions.density
    said = next(f for f in there.findings if f.code == OTHER_WATER)
    assert said["heavier"] == pytest.approx((new.weight - new.buoyancy) / new.hydrostatics.gravity)


def test_tables_in_newton_metres_go_with_the_density() -> None:
    """Before: N = -1.0 r|r| N m of HUUV stayed while the finding says that forces go with the density."""
    here = read_parameter_file(Path("cfd_data/huuv/huuv.parameters.json"))
    there = in_water(here, 1.1 * here.conditions.density)
    turning = np.array([[1.0, 0.1, 0.0, 0.0, 0.0, 0.4]])
    assert {m.unit for m in here.models} == {"1", "N*m"}
    assert motion_law(there)[0].force(turning) == pytest.approx(1.1 * motion_law(here)[0].force(turning), rel=1e-12)
    own, moved = (next(m for m in f.models if m.unit != "1") for f in (here, there))
    assert moved.terms[0].value == pytest.approx(1.1 * own.terms[0].value)


def test_a_file_without_mass_has_no_weight_to_hold_against_its_buoyancy() -> None:
    here = read_parameter_file(Path("remus100")).model_copy(update={"mass": None})
    found = [
        next(f for f in in_water(file, 1000.0).findings if f.code == OTHER_WATER)
        for file in (here, read_parameter_file(Path("remus100")))
    ]
    assert [f["by"] for f in found] == ["massless", "weighed"]
    assert [" kg above buoyancy" in as_check("export", f).statistic for f in found] == [False, True]


def test_exported_dimensions_are_of_the_other_water() -> None:
    files = cf.export("remus100", "mss", density="1025 kg/m^3").files
    text = next(content for name, content in files.items() if name.endswith(".m")).decode()
    assert "1025.0;  % density" in text
    assert export(in_water(read_parameter_file(Path("remus100")), 1025.0), "mss").files == files
