"""The body's mesh in a written gz-sim model: where the link is, with the sail above and the planes aft."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.core.text.xml import parse_xml
from coeflab.formats.export import PlannedExport, exports_of
from coeflab.formats.gazebo import write as gazebo
from coeflab.formats.gazebo.seen import with_mesh
from coeflab.vehicle.parameter_file import ParameterFile, ParameterPoint
from tests.formats.massed import torpedo

AFF8 = read_body(shipped("geometry") / "suboff_aff8" / "body.toml")
POINT = np.array([-2.0, 0.0, 0.1])  # aft of the nose, below the axis


def corners(content: bytes) -> np.ndarray:
    """(n, 3, 3) of a binary STL, read by its own layout."""
    count = int(np.frombuffer(content, "<u4", 1, 80)[0])
    assert len(content) == 84 + 50 * count
    rows = np.frombuffer(content, np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("rest", "<u2")]), count, 84)
    outward = np.cross(rows["c"][:, 1] - rows["c"][:, 0], rows["c"][:, 2] - rows["c"][:, 0])
    assert np.all(np.einsum("ij,ij->i", outward, rows["n"]) >= 0.0)
    return np.array(rows["c"])


def test_where_it_is_seen() -> None:
    """Nose 2 m ahead, stern 2.356 m aft; sail up: 18.25 in above the axis (Groves), .1 m less the point's depth below; outward."""
    out = with_mesh(gazebo.render(torpedo()), AFF8.shape, POINT)
    (name,) = (n for n in out if n.endswith(".stl"))
    found = corners(out[name])
    low, high = found.reshape(-1, 3).min(axis=0), found.reshape(-1, 3).max(axis=0)
    assert high[0] == pytest.approx(2.0, abs=2e-3)
    assert low[0] == pytest.approx(2.0 - 4.356, abs=2e-3)
    assert high[2] == pytest.approx(0.1 + 0.4763, abs=3e-3)
    assert low[2] == pytest.approx(0.1 - 0.254, abs=3e-3)
    assert high[1] == pytest.approx(-low[1], abs=3e-3)
    volume = np.einsum("ij,ij->i", found[:, 0], np.cross(found[:, 1], found[:, 2])).sum() / 6.0
    assert volume == pytest.approx(0.7058, rel=0.01)
    for text in (t for n, t in out.items() if n.endswith(".sdf")):
        root = parse_xml(text.decode())
        assert root.findtext(".//visual[@name='hull']/geometry/mesh/uri") == name
        assert root.find(".//visual[@name='hull']/geometry/ellipsoid") is None
        assert b"no mesh of the body" not in text


def of_aff8(file: ParameterFile, body: str) -> ParameterFile:
    assert file.added_mass is not None
    at = ParameterPoint(point=(-2.0, 0.0, 0.1), datum=Datum("nose").id)
    return file.model_copy(update={"reference_point": at, "body": body})


@pytest.mark.usefixtures("few_states")
@pytest.mark.parametrize("target", ["gazebo", "gazebo_plugin", "mss"])
def test_of_another_body_nothing_is_shown(target: str) -> None:
    for body, shown in (("body of tow", target != "mss"), ("another", False)):
        file = of_aff8(torpedo(), body)
        (made,), _ = exports_of(
            [PlannedExport(target, accept_loss=True)], [file], lambda _: None, {file.name: AFF8.shape}
        )
        assert any(n.endswith(".stl") for n in made.files) == shown


def test_the_real_parser_takes_it(tmp_path: Path) -> None:
    if shutil.which("ign") is None:
        pytest.skip("SDFormat's parser (ign sdf) is not installed")
    out = with_mesh(gazebo.render(torpedo()), AFF8.shape, POINT)
    for name, text in out.items():
        (tmp_path / name).write_bytes(text)
    for name in (n for n in out if n.endswith(".sdf")):
        done = subprocess.run(
            ["ign", "sdf", "--check", str(tmp_path / name)], capture_output=True, text=True, timeout=60, check=False
        )
        assert "Valid" in done.stdout, done.stdout + done.stderr
