"""COLLADA files, as the meshes of ROS are: alone, and named by a URDF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.mesh import file as mesh_file
from coeflab.bodies.simplify.source import mesh_body
from coeflab.core.errors import InputError

SIDES = (2.0, 0.5, 0.25)


def written(path: Path, meter: str = "0.001", change: tuple[str, str] = ("", "")) -> Path:
    """A box as a COLLADA in units of so many metres."""
    box = trimesh.creation.box(SIDES)
    box.apply_scale(1.0 / float(meter))
    text = box.export(file_type="dae").decode()
    stated = text.replace("<up_axis>", f'<unit name="x" meter="{meter}"/><up_axis>')
    path.write_text(stated.replace(*change) if change[0] else stated)
    return path


def test_a_dae_is_in_metres_by_its_own_unit(tmp_path: Path) -> None:
    for meter in ("1.0", "0.001", "0.0254"):
        body = mesh_body(str(written(tmp_path / "hull.dae", meter)), axes="forward,port,up")
        assert body.require_shape().volume == pytest.approx(np.prod(SIDES), rel=1e-5)


def test_its_axes_are_asked_for(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no axes"):
        mesh_body(str(written(tmp_path / "hull.dae")))


def test_a_urdf_names_one(tmp_path: Path) -> None:
    written(tmp_path / "hull.dae")
    (tmp_path / "r.urdf").write_text(
        '<robot name="r"><link name="hull"><visual><origin xyz="0.5 0 0"/><geometry>'
        '<mesh filename="package://r/hull.dae" scale="2 2 2"/></geometry></visual></link></robot>'
    )
    shape = mesh_body(str(tmp_path / "r.urdf")).require_shape()
    assert shape.volume == pytest.approx(8.0 * np.prod(SIDES), rel=1e-5)
    assert shape.centre_of_volume[0] == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(
    ("change", "found"),
    [(("<COLLADA", "<NOTHING"), "no <COLLADA>"), (('meter="0.001"', 'meter="none"'), "no length"),
     (("<COLLADA", '<!DOCTYPE a [<!ENTITY b "c">]><COLLADA'), "entities")],
)  # fmt: skip
def test_what_is_no_plain_collada_is_refused(tmp_path: Path, change: tuple[str, str], found: str) -> None:
    with pytest.raises(InputError, match=found):
        mesh_body(str(written(tmp_path / "hull.dae", change=change)), axes="FLU")


def test_without_its_reader_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path / "hull.dae")
    monkeypatch.setattr(mesh_file, "find_spec", lambda _: None)
    with pytest.raises(InputError, match=r"coeflab\[collada\]"):
        mesh_body(str(path), axes="FLU")
