"""The FMU: its parts, its law, and what it says when the file does not state a mass."""

from __future__ import annotations

import io
import json
import zipfile
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.formats.fmi import write as fmi
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import CENTRE, INERTIA, MASS, torpedo

GOLDEN = Path(__file__).parent / "golden"


def parts(file: ParameterFile) -> dict[str, bytes]:
    (content,) = fmi.render(file).values()
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_golden() -> None:
    """Regenerate by hand: write parts(plain()) of these names to golden/fmi_* and read the difference."""
    found = parts(made.plain())
    assert found["modelDescription.xml"] == (GOLDEN / "fmi_modelDescription.xml").read_bytes()
    assert found["resources/model.json"] == (GOLDEN / "fmi_model.json").read_bytes()


@pytest.mark.parametrize("file", [made.full(1), made.full(2), made.plain(), made.at_rest(), torpedo()])
def test_its_force_is_the_files(file: ParameterFile) -> None:
    nu = np.random.default_rng(6).normal(size=(50, 6))
    expected = force_law(file).force(nu)
    np.testing.assert_allclose(fmi.force(fmi.render(file), nu), expected, rtol=1e-11, atol=1e-9)
    assert fmi.not_held(file) == ()


def test_what_makes_it_run_is_inside() -> None:
    found = parts(made.plain())
    assert {"binaries/linux64/file.so", "binaries/win64/file.dll"} <= set(found)
    assert {"resources/coeflab_unit.py", "resources/pythonfmu/fmi2slave.py", "resources/slavemodule.txt"} <= set(found)
    assert b"MIT" in found["documentation/licenses/pythonfmu.txt"]
    assert b"import coeflab" not in found["resources/coeflab_unit.py"]
    assert b"numpy" not in found["resources/coeflab_unit.py"]


def test_entries_bear_one_date_and_no_owner() -> None:
    (content,) = fmi.render(made.plain()).values()
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        infos = archive.infolist()
    assert [i.filename for i in infos] == sorted(i.filename for i in infos)
    assert {i.date_time for i in infos} == {(1980, 1, 1, 0, 0, 0)}
    assert {(i.create_system, i.compress_type) for i in infos} == {(3, zipfile.ZIP_STORED)}


def test_another_law_has_another_guid() -> None:
    guids = {ElementTree.fromstring(parts(f)["modelDescription.xml"]).get("guid") for f in (made.plain(), torpedo())}
    assert len(guids) == 2


def test_description_and_model_agree() -> None:
    found = parts(torpedo())
    root = ElementTree.fromstring(found["modelDescription.xml"])
    model = json.loads(found["resources/model.json"])
    for k, (scalar, variable) in enumerate(zip(root.iter("ScalarVariable"), model["variables"], strict=True)):
        assert (scalar.get("name"), scalar.get("valueReference")) == (variable["name"], str(k))
        start = scalar.find("Real").get("start")
        assert (start is None) == (variable["causality"] == "output")
        assert start is None or float(start) == variable["start"]


def test_mass_is_that_of_the_file() -> None:
    start = {v["name"]: v["start"] for v in json.loads(parts(torpedo())["resources/model.json"])["variables"]}
    assert start["mass.m"] == MASS
    assert [start[f"mass.{a}_g"] for a in "xyz"] == CENTRE.tolist()
    assert [start[f"mass.I{n}"] for n in ("xx", "yy", "zz", "xy", "xz", "yz")] == pytest.approx(
        [INERTIA[0, 0], INERTIA[1, 1], INERTIA[2, 2], INERTIA[0, 1], INERTIA[0, 2], INERTIA[1, 2]]
    )
    assert fmi.missing(torpedo()) == ()
    (said,) = fmi.missing(made.plain())
    assert said.startswith("mass and moments of inertia: the file has none; the unit does not start")


def test_without_pythonfmu_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> object:
        raise PackageNotFoundError(name)

    monkeypatch.setattr(fmi, "distribution", missing)
    with pytest.raises(InputError, match=r"pip install pythonfmu"):
        fmi.render(made.plain())


@pytest.mark.parametrize("name", made.HOSTILE)
def test_names_that_hurt(name: str) -> None:
    found = parts(made.named(name))
    assert all(not n.startswith("/") and ".." not in n for n in found)
    assert json.loads(found["resources/model.json"])["name"] == name
    root = ElementTree.fromstring(found["modelDescription.xml"])
    assert len(list(root.iter("ScalarVariable"))) == len(json.loads(found["resources/model.json"])["variables"])


def test_it_says_that_its_host_needs_python_and_which_thrust_is_missing() -> None:
    found, said = parts(torpedo()), " ".join(fmi.changes(torpedo()))
    assert "needs Python 3" in found["modelDescription.xml"].decode()
    assert "needs Python 3" in said
    assert "propulsion is not in the export" in said
    assert "external.X" in said
