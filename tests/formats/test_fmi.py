"""The FMU: its parts, its law, its variables, hostile names."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.formats.fmi import write as fmi
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import torpedo, with_mass
from tests.formats.of_a_vehicle import driven
from tests.vehicle.hybrid import hybrid

GOLDEN = Path(__file__).parent / "golden"


def parts(file: ParameterFile) -> dict[str, bytes]:
    (content,) = fmi.render(file).values()
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def scalars(file: ParameterFile) -> list[ElementTree.Element]:
    return list(ElementTree.fromstring(parts(file)["modelDescription.xml"]).iter("ScalarVariable"))


def test_golden() -> None:
    """Regenerate by hand: write parts(torpedo())["modelDescription.xml"] to golden and read the difference."""
    found = re.sub(rb'guid="\w+"', b'guid=""', parts(torpedo())["modelDescription.xml"])
    assert found == (GOLDEN / "fmi_modelDescription.xml").read_bytes()


@pytest.mark.parametrize("file", [with_mass(made.full(1)), with_mass(made.at_rest()), torpedo(), hybrid()])
def test_its_force_is_the_files(file: ParameterFile) -> None:
    nu = np.random.default_rng(6).normal(size=(50, 6))
    nu[:, 0] += 4.0
    np.testing.assert_allclose(fmi.force(fmi.render(file), nu), motion_law(file)[0].force(nu), rtol=1e-12, atol=1e-9)
    assert fmi.not_held(file) == ()


def test_sources_are_inside_and_no_python() -> None:
    found = parts(torpedo())
    assert {"modelDescription.xml", "sources/unit.c", "sources/file.c", "sources/file.h"} == set(found)
    assert b"Python" not in b"".join(found.values())
    root = ElementTree.fromstring(found["modelDescription.xml"])
    assert [root.find(f"{kind}/SourceFiles/File").get("name") for kind in ("ModelExchange", "CoSimulation")] == [
        "unit.c"
    ] * 2


def test_entries_bear_one_date_and_no_owner() -> None:
    (content,) = fmi.render(torpedo()).values()
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        infos = archive.infolist()
    assert [i.filename for i in infos] == sorted(i.filename for i in infos)
    assert {i.date_time for i in infos} == {(1980, 1, 1, 0, 0, 0)}
    assert {(i.create_system, i.compress_type) for i in infos} == {(3, zipfile.ZIP_STORED)}


def test_without_a_compiler_the_sources_alone_are_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fmi.shutil, "which", lambda _: None)
    fmi.compiled.cache_clear() if hasattr(fmi.compiled, "cache_clear") else None
    other = torpedo().model_copy(update={"name": "never compiled"})
    files = fmi.render(other)
    assert fmi.built(files) == files


def test_another_law_has_another_guid() -> None:
    guids = {ElementTree.fromstring(parts(f)["modelDescription.xml"]).get("guid") for f in (hybrid(), torpedo())}
    assert len(guids) == 2


def test_thrusters_and_fins_are_inputs_with_units() -> None:
    known = {s.get("name"): s for s in scalars(driven())}
    assert {"control.dr", "external.X", "thruster.propeller", "tilt.propeller"} <= {
        n for n, s in known.items() if s.get("causality") == "input"
    }
    assert known["control.dr"].find("Real").get("unit") == "rad"
    assert known["external.N"].find("Real").get("unit") == "N.m"
    assert "limit 0.4 rad" in known["control.dr"].get("description")
    rates = [s for s in known.values() if s.find("Real").get("derivative")]
    assert len(rates) == 16


def test_a_file_without_mass_is_refused() -> None:
    with pytest.raises(InputError, match="no mass"):
        fmi.render(made.plain())


@pytest.mark.parametrize("name", made.HOSTILE)
def test_names_that_hurt(name: str) -> None:
    file = with_mass(made.named(name)).model_copy(update={"body": name})
    found = parts(file)
    assert all(not n.startswith("/") and ".." not in n for n in found)
    assert len(scalars(file)) > 50
    source = next(x for n, x in found.items() if n.endswith(".c") and not n.endswith("unit.c")).decode()
    first = source.splitlines()[0]
    assert first.startswith("/*")
    assert first.endswith("*/")
    assert first.count("*/") == 1
    assert "\\" not in first
