"""Composed bodies: hulls of every kind with fins, sails, ducts and plates in one body.toml."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.decimation import is_closed
from coeflab.bodies.profiles import suboff_meridian
from coeflab.bodies.readers import read_body
from coeflab.core.errors import InputError
from coeflab.core.files import shipped

HEAD = """
[body]
name = "composed"
reader = "finned"
datum = "nose"
datum_note = "on the axis"
reference_point = [0.0, 0.0, 0.0]
[source]
citation = "synthetic"
kind = "synthetic"
"""
SPHEROID = "[hull]\nlength = 1.0\ndiameter = 0.2\n"
GROVES = '[hull]\nkind = "groves"\nlength = 2.0\nnose_at = 1.0\n'
FIN = """
[[fin]]
name = "fin"
section = "NACA 0012"
roll = "90 deg"
root = 0.0
tip = 0.2
root_chord = 0.1
tip_chord = 0.1
trailing_edge = -0.05
"""
DUCT = '[[duct]]\nsection = "NACA 0010"\ndiameter = 0.4\nchord = 0.1\ntrailing_edge = -0.05\n'
PLATE = """
[[plate]]
name = "strut"
roll = "0 deg"
root = 0.0
tip = 0.3
root_chord = 0.08
tip_chord = 0.06
trailing_edge = -0.04
thickness = 0.004
"""


def body(folder: Path, *tables: str) -> Body:
    path = folder / "body.toml"
    path.write_text(HEAD + "".join(tables))
    return read_body(path)


@pytest.fixture(scope="module")
def auv() -> Body:
    return read_body(shipped("geometry") / "myring_auv" / "body.toml")


def test_shipped_vehicle_has_all_that_a_turn_needs(auv: Body) -> None:
    assert [c.name for c in auv.controls] == ["dr", "ds"]
    assert np.degrees([c.limit for c in auv.controls]) == pytest.approx([20.0, 20.0])
    assert [t.name for t in auv.thrusters] == ["propeller"]
    outline = auv.outline
    assert {f.name: f.control for f in outline.foils} == {
        "rudder_upper": "dr", "rudder_lower": "dr", "plane_starboard": "ds", "plane_port": "ds", "antenna": "",
    }  # fmt: skip
    whole = auv.require("by_mesh")
    hull = outline.hulls[0]
    assert whole.volume == pytest.approx(-np.trapezoid(hull.area, hull.x), rel=0.02)
    assert whole.volume > -np.trapezoid(hull.area, hull.x)


def test_hull_of_suboff_to_a_length(tmp_path: Path) -> None:
    """A uniform scale: volume goes with its cube."""
    full = suboff_meridian()
    found = body(tmp_path, GROVES, FIN.replace("trailing_edge = -0.05", "trailing_edge = -0.7")).outline
    hull = found.hulls[0]
    assert hull.x[[0, -1]] == pytest.approx([1.0, -1.0])
    assert -np.trapezoid(hull.area, hull.x) == pytest.approx(full.volume * (2.0 / full.length) ** 3, rel=1e-3)


def test_duct_is_a_closed_ring_of_its_volume(tmp_path: Path) -> None:
    """Pappus: area of the section times the way of its centre; the section's area is .685 t c."""
    found = body(tmp_path, SPHEROID, DUCT, PLATE)
    piece = next(p for p in found.pieces if p.name == "duct").surface(8000)
    assert is_closed(piece.faces)
    assert piece.volume == pytest.approx(np.pi * 0.4 * 0.685 * 0.1 * 0.1**2, rel=0.01)
    outline = found.outline
    (ring,) = outline.rings
    assert ring.centre == pytest.approx([0.025, 0.0, 0.0])
    assert (ring.diameter, ring.chord, ring.thickness) == pytest.approx((0.4, 0.1, 0.1))


def test_plate_has_square_edges(tmp_path: Path) -> None:
    found = body(tmp_path, PLATE)
    assert found.require("by_mesh").volume == pytest.approx(0.07 * 0.3 * 0.004, rel=1e-6)
    outline = found.outline
    assert outline.foils[0].thickness == pytest.approx(0.004 / 0.07)


@pytest.mark.parametrize(
    ("tables", "column", "found"),
    [
        ((SPHEROID, FIN.replace("root = 0.0", "root = 0.15")), "fin[0].root", "outside of the hull"),
        ((SPHEROID, FIN.replace("tip = 0.2", "tip = 0.08")), "fin[0].tip", "within the hull"),
        ((SPHEROID, FIN.replace("-0.05", "2.0")), "fin[0].root", "outside of the hull"),
        ((SPHEROID, DUCT.replace("0.4", "0.2")), "duct[0].diameter", "inner radius"),
        ((DUCT.replace("0.4", "0.005"),), "duct[0].diameter", "thick"),
        ((SPHEROID, FIN, FIN.replace('"fin"', '"other"')), "fin[1].roll", "over"),
        ((SPHEROID, FIN, PLATE.replace('"strut"', '"fin"')), "plate[0].name", "two parts"),
        (('[hull]\nkind = "myring"\nlength = 1.0\n', FIN), "hull", "nose"),
        (('[hull]\nkind = "groves"\ndiameter = 1.0\n', FIN), "hull.diameter", "unknown key"),
        ((SPHEROID,), "fin", "no [[fin]]"),
    ],
    ids=[
        "root outside",
        "all within",
        "beside the hull",
        "duct in hull",
        "duct closed",
        "overlap",
        "name",
        "myring",
        "groves",
        "bare",
    ],
)
def test_what_does_not_compose(tmp_path: Path, tables: tuple[str, ...], column: str, found: str) -> None:
    with pytest.raises(InputError) as why:
        body(tmp_path, *tables)
    said = str(why.value)
    assert column in said
    assert found in said
