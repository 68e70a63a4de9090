"""A written body.toml says to the reader what the parts were; shadows; boxes that people draw."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.bodies.body import Body
from coeflab.bodies.readers.primitives import read
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts, Plate, shadow
from coeflab.bodies.simplify.boxes import NamedBox, parse_box, read_boxes
from coeflab.bodies.simplify.part_file import part_file
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.provenance import Source
from coeflab.law.scaling import Scaling
from coeflab.law.transforms import rotation
from coeflab.report.figures.form_facets import normals
from coeflab.report.figures.part_pictures import part_facets

FORMS = (
    Cylinder(0.1, 2.0), Plate(0.12, 0.3), Ellipsoid(3.0, 2.0, 1.0), Ellipsoid(3.0, 1.0, 1.0), Ellipsoid(0.5, 0.5, 0.5),
    Box(3.0, 2.0, 1e-5),
)  # fmt: skip
TURNS = [(0.0, 0.0, 0.0), (0.0, 90.0, 0.0), (12.34, -45.5, 170.01), (0.0, -90.0, 33.0)]


def body(shape: Parts, name: str = 'odd "name" \\ ü', scaling: Scaling | None = None) -> Body:
    source = Source("huuv2025", "Fig. 7", "made\nhere\x7f", "computed")
    return Body(name, "t", Datum("nose"), np.array([-1.5, 0.0, 0.25]), {}, (), source, (), shape, scaling)


def test_there_and_back(tmp_path: Path) -> None:
    parts = tuple(
        Part(f"{i} {j}", form, np.array([1.0 / 3.0, -2e-7, 5.0]), rotation(*np.radians(turn)))
        for i, form in enumerate(FORMS)
        for j, turn in enumerate(TURNS)
    )
    made = body(Parts(parts), scaling=Scaling(1.2, "hull length"))
    remarks = {"0 0": ("a remark\nwith a break " + "that is long " * 20,)}
    path = tmp_path / "body.toml"
    path.write_bytes(part_file(made, made.shape, ("opening",), remarks))
    again = read(path)
    assert (again.name, again.title, again.datum, again.source) == (made.name, made.title, made.datum, made.source)
    assert again.scaling == made.scaling
    assert np.array_equal(again.reference_point, made.reference_point)
    for p, q in zip(again.shape.parts, parts, strict=True):
        assert (p.name, p.form) == (q.name, q.form)
        assert p.centre == pytest.approx(q.centre, rel=1e-11)
        assert p.rotation == pytest.approx(q.rotation, abs=1e-12)
    lines = path.read_text().splitlines()
    assert lines[0] == "# opening"
    assert max(map(len, lines)) <= 120


TEXT = st.text(st.characters(exclude_characters="\0"), max_size=60)  # a NUL is refused in every TOML


@given(TEXT, TEXT)
def test_any_text_survives(tmp_path_factory: pytest.TempPathFactory, name: str, remark: str) -> None:
    name = "b" + name.replace("\ud800", "")
    try:
        (name + remark).encode()
    except UnicodeEncodeError:
        return
    made = body(Parts((Part("p", Box(1, 1, 1), np.zeros(3), np.eye(3)),)), name)
    path = tmp_path_factory.mktemp("b") / "body.toml"
    path.write_bytes(part_file(made, made.shape, (remark,), {}))
    assert read(path).name == name


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.48, -0.6, 0.64)])
def test_shadows_against_facets(form: Form, direction: tuple[float, ...]) -> None:
    facets = part_facets(Part("p", form, np.zeros(3), np.eye(3)))
    area = np.linalg.norm(np.cross(facets[:, 2] - facets[:, 0], facets[:, 3] - facets[:, 1]), axis=1) / 2.0
    by_facets = float(area @ np.abs(normals(facets) @ direction)) / 2.0
    assert shadow(form, np.array(direction)) == pytest.approx(by_facets, rel=8e-3, abs=1e-9)


def test_boxes_as_people_write_them(tmp_path: Path) -> None:
    drawn = NamedBox("mast", (0.05, -0.05, -0.4), (0.15, 0.05, -0.07))
    assert parse_box("mast=0.05:0.15,-0.05:0.05,-0.4:-7 cm") == drawn
    path = tmp_path / "boxes.toml"
    path.write_text('[[box]]\nname = "mast"\nx = [0.05, "15 cm"]\ny = [-0.05, 0.05]\nz = [-0.4, -0.07]\n')
    assert read_boxes(path) == (drawn,)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mast", "NAME=x0:x1"),
        ("=0:1,0:1,0:1", "NAME=x0:x1"),
        ("m=0:1,0:1", "NAME=x0:x1"),
        ("m=0:1,0:1,0:x", "--box"),
        ("m=0:1,0:1,0:nan", "finite"),
        ("m=0:1,0:1,0:5 kg", "length"),
        ("m=0:1,1:0,0:1", "from a lower to a higher"),
    ],
)
@pytest.mark.usefixtures("in_a_shell")
def test_boxes_that_cannot_be(text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        parse_box(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a = 1", "unknown key"),
        ("[[box]]\nname = 'm'\nx = [0, 1]\ny = [0, 1]", "box\\[0\\].z"),
        ("[[box]]\nname = 'm'\nx = [0, 1]\ny = [0, 1]\nz = [1, 0]", "lower to a higher"),
        ("# nothing", "no \\[\\[box\\]\\]"),
    ],
)
def test_box_files_that_cannot_be(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "boxes.toml").write_text(text)
    with pytest.raises(InputError, match=said):
        read_boxes(tmp_path / "boxes.toml")
