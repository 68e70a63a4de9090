"""Centre of gravity and inertia in the parameter file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError

from coeflab.bodies.body import Body, Configuration
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.provenance import Source
from coeflab.law.rigid_body import MassProperties, about_another
from coeflab.law.scaling import Conditions
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.formats.massed import CENTRE, INERTIA, MASS, torpedo
from tests.vehicle.test_assemble import fitted

GOOD = {"mass": MASS, "mass_moment": MASS * CENTRE[0], "mass_prime": torpedo().mass.mass_prime, "mass_moment_prime": torpedo().mass.mass_moment_prime,
        "centre": CENTRE.tolist(), "inertia_matrix": INERTIA.tolist()}  # fmt: skip


def test_it_comes_back(tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    path.write_bytes(torpedo().to_json())
    assert read_parameter_file(path) == torpedo()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"centre": None}, "without the centre"),
        ({"mass_moment": 1.0}, "not m x_G"),
        ({"inertia_matrix": np.diag([1.0, 2.0, 9.0]).tolist()}, "larger than the others"),
        ({"inertia_matrix": (INERTIA + np.eye(3, k=1)).tolist()}, "not symmetric"),
        ({"inertia_matrix": (INERTIA - 2.0 * np.eye(3)).tolist()}, "principal moment"),
    ],
)
def test_no_body_has_these(change: dict[str, object], said: str) -> None:
    content = torpedo().model_dump()
    ParameterFile.model_validate({**content, "mass": GOOD})
    with pytest.raises(ValidationError, match=said):
        ParameterFile.model_validate({**content, "mass": {**GOOD, **change}})


def test_earlier_versions_do_not_have_them(tmp_path: Path) -> None:
    old = torpedo().model_copy(update={"schema_version": "1.1", "added_mass": None})
    assert "inertia_matrix" not in json.loads(old.to_json())["mass"]
    content = json.loads(torpedo().to_json())
    content["schema_version"], content["added_mass"] = "1.1", None
    path = tmp_path / "p.json"
    path.write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"came with version 1\.2"):
        read_parameter_file(path)
    assert ParameterFile.model_validate_json(torpedo().to_json()).mass.centre.tolist() == CENTRE.tolist()


def test_mass_properties_move_with_the_reference_point() -> None:
    """The body states them about its own point, 0.3 m aft of that of the fit."""
    own = np.array([-0.3, 0.0, 0.0])
    about = about_another(INERTIA, MASS, CENTRE, CENTRE - own)
    mass = MassProperties(MASS, MASS * float(CENTRE[0] + 0.3), None, CENTRE - own, about)
    body = Body(
        "b", "", Datum("nose"), own, {}, (Configuration("b", "", None, None, None, mass),), Source("synthetic"), ()
    )
    group = PlannedParameterFile("file", "b", ("tow",), ())
    fit = fitted("tow", {"Yv": -0.03})
    moved = assemble(group, "study", [fit], [], [], [], body, Conditions(1000.0, 2.0), []).mass
    np.testing.assert_allclose(moved.inertia_matrix, INERTIA, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(moved.centre, CENTRE, rtol=1e-12)
    assert moved.mass_moment == pytest.approx(MASS * CENTRE[0])
