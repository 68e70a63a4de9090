"""Overlay drawing and scene: well formed, the same bytes twice, what is drawn is where it should be."""

from __future__ import annotations

import io
import json
import re
import struct
from dataclasses import replace
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from matplotlib.figure import Figure as Drawing

from coeflab.bodies.mesh import silhouettes
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import box, surface
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Part, Parts, Plate, StandIn
from coeflab.law.transforms import rotation
from coeflab.report.figures.body import FRONT, OBLIQUE, SIDE, TOP, _spread, body_figure
from coeflab.report.figures.body_scene import body_scene
from coeflab.report.figures.body_view import Sheet
from coeflab.report.figures.hull_scene import hull_scene
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.rulers import rulers, ticks

SVG = "{http://www.w3.org/2000/svg}"
SHAPE = Parts(
    (
        Part("hull", Cylinder(0.1, 2.0), np.zeros(3), np.eye(3)),
        Part("mast", Ellipsoid(0.2, 0.05, 0.05), np.array([0.3, 0.0, -0.25]), rotation(0.0, np.pi / 2, 0.0)),
        Part("fin <&>", Plate(0.2, 0.4), np.array([-0.8, 0.3, 0.0]), np.eye(3)),
        Part("pod", Box(0.3, 0.1, 0.1), np.array([0.5, -0.3, 0.1]), rotation(0.2, 0.1, 0.3)),
    )
)


def mesh() -> TriangleMesh:
    return TriangleMesh(*surface(box(np.array([-1.0, -0.1, -0.1]), np.array([1.0, 0.1, 0.1]))))


@pytest.mark.parametrize("view", [SIDE, FRONT, TOP, OBLIQUE])
def test_views_do_not_mirror(view) -> None:
    """The picture's right, up and toward the viewer are right-handed."""
    assert view.axes @ view.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(view.axes) == pytest.approx(1.0)


def test_views_show_what_they_say() -> None:
    bow, starboard, up = np.eye(3) * [[1.0], [1.0], [-1.0]]
    assert SIDE.axes @ bow == pytest.approx([1, 0, 0])
    assert SIDE.axes @ starboard == pytest.approx([0, 0, 1])
    assert FRONT.axes @ bow == pytest.approx([0, 0, 1])
    assert TOP.axes @ up == pytest.approx([0, 0, 1])
    assert all(v.axes[1] @ up > 0.9 for v in (SIDE, FRONT, OBLIQUE))
    assert np.all(OBLIQUE.axes[2] * [1, 1, -1] > 0.0)


@pytest.mark.parametrize("with_mesh", [True, False])
def test_drawing(with_mesh: bool) -> None:
    figure = body_figure("a & b", SHAPE, mesh() if with_mesh else None, "overlay")
    root = ET.fromstring(figure.svg)
    assert "fin <&>" in figure.description
    assert root.find(f"{SVG}title").text.startswith("a & b")
    texts = {"".join(t.itertext()) for t in root.iter(f"{SVG}text")}
    assert {p.name for p in SHAPE.parts} <= texts
    assert {"cylinder", "plate", "ellipsoid", "box"} <= texts
    assert ("outline of the mesh" in texts) == with_mesh
    assert not re.findall("#[0-9a-f]{6}", re.sub(r"var\(--fig-\w+, #[0-9a-f]{6}\)", "", figure.svg))
    assert figure.svg == body_figure("a & b", SHAPE, mesh() if with_mesh else None, "overlay").svg
    assert len(figure.svg) < 200_000


@pytest.mark.parametrize("tall", [False, True])
def test_everything_lies_on_the_paper(tall: bool) -> None:
    turn = rotation(0.0, np.pi / 2, 0.0) if tall else np.eye(3)
    shape = Parts((Part("hull", Cylinder(0.1, 5.0), np.zeros(3), turn), Part("p", Plate(1, 1), np.ones(3), np.eye(3))))
    svg = body_figure("b", shape, None, "o").svg
    width, height = (float(v) for v in re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', svg).groups())
    numbers = re.findall(r"[ML] ([\d.-]+) ([\d.-]+)", svg)
    places = np.array(numbers, dtype=float)
    assert len(places) > 100
    assert np.all(places >= -1.0)
    assert np.all(places <= [width + 1.0, height + 1.0])


def test_labels_do_not_overlap() -> None:
    widths = [60.0, 40.0, 80.0]
    at = _spread([100.0, 101.0, 102.0], widths)
    assert at == sorted(at)
    assert all(b - a >= (v + w) / 2.0 - 1e-9 for a, b, v, w in zip(at, at[1:], widths, widths[1:]))
    assert _spread([670.0], [60.0]) == [636.0]


def parsed(data: bytes) -> tuple[dict, bytes]:
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    assert size % 4 == 0
    rest, binary = struct.unpack_from("<I4s", data, 20 + size)
    assert binary == b"BIN\0"
    assert 28 + size + rest == len(data)
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def test_scene() -> None:
    data = body_scene("b", SHAPE, mesh())
    assert data == body_scene("b", SHAPE, mesh())
    content, binary = parsed(data)
    assert [n["name"] for n in content["nodes"]] == [*(p.name for p in SHAPE.parts), "mesh", "b"]
    materials = {m["name"]: m for m in content["materials"]}
    assert materials["mesh"]["alphaMode"] == "BLEND"
    assert materials["mesh"]["pbrMetallicRoughness"]["baseColorFactor"][3] < 1.0
    assert "alphaMode" not in materials["cylinder"]
    assert content["buffers"][0]["byteLength"] <= len(binary)
    red = int(COLOURS["a"][1:3], 16)
    assert materials["cylinder"]["pbrMetallicRoughness"]["baseColorFactor"][0] == pytest.approx(red / 255.0, abs=0.1)


def test_an_independent_reader_sees_the_body() -> None:
    """trimesh: volumes and where forward, starboard and down have gone (glTF: z forward, x to port, y up)."""
    import trimesh

    scene = trimesh.load_scene(io.BytesIO(body_scene("b", SHAPE, mesh())), file_type="glb")
    assert scene.geometry["pod"].volume == pytest.approx(0.003, rel=1e-4)
    assert scene.geometry["hull"].volume == pytest.approx(0.02 * np.pi, rel=0.01)
    place = {name: scene.graph.get(name)[0] for name in scene.graph.nodes_geometry}
    mast = scene.geometry["mast"].vertices.mean(axis=0)
    assert (place["mast"] @ [*mast, 1.0])[:3] == pytest.approx([0.0, 0.25, 0.3], abs=1e-6)
    fin = scene.geometry["fin <&>"].vertices.mean(axis=0)
    assert (place["fin <&>"] @ [*fin, 1.0])[:3] == pytest.approx([-0.3, 0.0, -0.8], abs=1e-6)
    paints = {name: g.visual.material for name, g in scene.geometry.items()}
    assert paints["mesh"].alphaMode == "BLEND"
    assert paints["mesh"].baseColorFactor[3] == pytest.approx(0.3 * 255, abs=1)
    assert all(paints[p.name].baseColorFactor[3] == 255 for p in SHAPE.parts)
    assert len({tuple(m.baseColorFactor) for m in paints.values()}) == 5


def test_the_scene_says_unit_and_axes() -> None:
    root = parsed(body_scene("b", SHAPE, mesh()))[0]["nodes"][-1]
    assert root["extras"]["units"] == "m"
    assert root["extras"]["axes"].startswith("vertices FRD: x forward, y starboard, z down")


def test_a_part_called_mesh_keeps_its_name() -> None:
    shape = Parts((Part("mesh", Cylinder(0.1, 2.0), np.zeros(3), np.eye(3)),))
    assert [n["name"] for n in parsed(body_scene("b", shape, mesh()))[0]["nodes"]] == ["mesh", "the mesh", "b"]


def test_ticks() -> None:
    assert ticks(-0.61, 0.6, 0.1) == pytest.approx(
        [-0.6, -0.5, -0.4, -0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    )
    assert ticks(-4.3, 0.2, 0.7) == [-4, -3, -2, -1, 0]
    assert ticks(0.03, 0.29, 0.11) == [0.2]
    assert ticks(1200.0, 5200.0, 1500.0) == [2000, 4000]


def test_axes_carry_metres_and_grow_as_the_body_says() -> None:
    """Side view: z grows downward, x to the right; front view: y grows to the left."""
    root = ET.fromstring(body_figure("b", SHAPE, None, "o").svg)
    texts = ["".join(t.itertext()) for t in root.iter(f"{SVG}text")]
    assert [texts.count(f"{axis} [m]") for axis in "xyz"] == [2, 2, 2]
    drawn = Drawing()
    axes = drawn.add_axes((0.0, 0.0, 1.0, 1.0))
    for view in (SIDE, FRONT):
        axes.clear()
        rulers(Sheet(axes, view, 100.0, np.zeros(2), 2.0), np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]))
        placed = [(t.get_position(), t.get_text(), t.get_ha()) for t in axes.texts]
        across = {float(text): x for (x, _), text, ha in placed if ha == "center"}
        up = {float(text): y for (_, y), text, ha in placed if ha == "right" and "[" not in text}
        assert (across[1.0] > across[0.0]) == (view is SIDE)
        assert abs(across[1.0] - across[0.0]) == pytest.approx(100.0)
        assert up[1.0] < up[0.0] < up[-1.0]


OTHER = StandIn("other", 0.34, 0.0, (-0.86, 0.0, -0.55), 0.0, 0.447)
OFF = StandIn("box", 0.9, 0.0, (-0.2, 0.0, 0.0), 0.0, 0.06)
GOOD = StandIn("cylinder", 0.99, 0.0, (0.01, 0.0, 0.0), 0.0, 0.01)
STANDING = Parts(
    tuple(replace(p, fit=fit) if fit else p for p, fit in zip(SHAPE.parts, (GOOD, OTHER, None, OFF), strict=True))
)


def test_poor_stand_ins_are_marked_by_more_than_colour() -> None:
    figure = body_figure("b", STANDING, mesh(), "overlay")
    root = ET.fromstring(figure.svg)
    texts = {"".join(t.itertext()) for t in root.iter(f"{SVG}text")}
    assert {"hull", "mast: other, misfit 0.45", "pod: A x −20 %", "poor stand-in"} <= texts
    assert "Striped: a poor stand-in" in figure.caption
    assert "mast (ellipsoid, a poor stand-in)" in figure.description
    plain = body_figure("b", SHAPE, mesh(), "overlay")
    assert "poor stand-in" not in plain.svg + plain.caption
    inked = [f'fill: var(--fig-ink, {COLOURS["ink"]})"' in line for line in figure.svg.split("<path")]
    assert sum(inked) >= 2 * 4 + 1
    assert figure.svg == body_figure("b", STANDING, mesh(), "overlay").svg


def test_stripes_cover_their_share_of_an_outline() -> None:
    square = silhouettes.ring(np.array([[0.0, 0.0], [80.0, 0.0], [80.0, 80.0], [0.0, 80.0]]))
    striped = silhouettes.hatched(square, 8.0, 2.0)
    assert striped.area() == pytest.approx(0.25 * square.area(), rel=1e-6)
    assert (striped ^ square).area() == pytest.approx(striped.area(), rel=1e-9)


def test_poor_stand_ins_are_dark_in_space() -> None:
    content = scene_content(body_scene("b", STANDING, mesh()))
    materials = [m["name"] for m in content["materials"]]
    assert {"cylinder", "ellipsoid, a poor stand-in", "plate", "box, a poor stand-in"} <= set(materials)
    mast = next(n for n in content["nodes"] if n["name"] == "mast")
    assert mast["extras"]["class"] == "other"
    assert mast["extras"]["poor"][0].startswith("class other (misfit 0.45")
    layers = {layer.name: layer.colour for layer in hull_scene("b", STANDING, ()).layers}
    assert layers["ellipsoid, a poor stand-in"] == "ink"
    assert layers["cylinder"] == "a"


def scene_content(content: bytes) -> dict:
    length = struct.unpack("<I", content[12:16])[0]
    return json.loads(content[20 : 20 + length])
