"""Bodies from STEP, URDF and SDF files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.mesh import file as mesh_file
from coeflab.bodies.mesh.file import load
from coeflab.bodies.mesh.integrals import MeshIntegrals, mesh_integrals
from coeflab.bodies.simplify.source import mesh_body
from coeflab.core.errors import InputError

URDF = """<robot name="rov">
  <link name="base">
    <visual><origin xyz="0 0 0.1" rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.1" length="1"/></geometry></visual>
    <collision><geometry><box size="9 9 9"/></geometry></collision>
  </link>
  <link name="arm"><collision><origin xyz="0 0 0.25"/><geometry><box size="0.1 0.2 0.5"/></geometry></collision></link>
  <link name="ball"><visual><geometry><mesh filename="package://rov_description/meshes/ball.stl" scale="0.001 0.001 0.001"/></geometry></visual></link>
  <joint name="a" type="fixed"><parent link="base"/><child link="arm"/><origin xyz="2 0 0" rpy="0 0 1.5707963267948966"/></joint>
  <joint name="b" type="revolute"><parent link="arm"/><child link="ball"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
</robot>"""
SDF = """<sdf version="1.9"><world name="w"><model name="m">
  <link name="base"><pose>0 0 1 0 0 0</pose>
    <visual name="a"><pose>1 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry></visual>
    <visual name="b"><pose>1.5 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry></visual>
  </link></model></world></sdf>"""


def integrals(path: Path) -> MeshIntegrals:
    return mesh_integrals(*load(path))


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_links_of_a_urdf_stand_in_their_poses(tmp_path: Path) -> None:
    (tmp_path / "rov_description" / "meshes").mkdir(parents=True)
    trimesh.creation.box((100.0, 100.0, 100.0)).export(tmp_path / "rov_description" / "meshes" / "ball.stl")
    path = written(tmp_path / "rov_description", "rov.urdf", URDF)
    vertices, _ = load(path)
    round_one = 32.0 * np.sin(2.0 * np.pi / 64.0) * 0.01
    assert integrals(path).volume == pytest.approx(round_one + 0.01 + 0.001, rel=1e-9)
    # The cylinder lies along x; the arm is 0.2 along x after its turn; the box sits at y = 1 of the turned arm.
    assert vertices[:, 0].min() == pytest.approx(-0.5)
    assert vertices[:, 0].max() == pytest.approx(2.1)
    assert vertices[:, 1].max() == pytest.approx(1.05)
    body = mesh_body(str(path))
    assert body.require_shape().volume == pytest.approx(round_one + 0.011, rel=1e-9)
    assert body.require_shape().centre_of_volume[1] < 0.0


def test_overlapping_shapes_of_an_sdf_are_united(tmp_path: Path) -> None:
    found = integrals(written(tmp_path, "m.sdf", SDF))
    assert found.volume == pytest.approx(1.5, rel=1e-9)
    assert found.centre == pytest.approx([1.25, 0.0, 1.0])


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        (
            "a.urdf",
            "<robot><link name='a'/></robot>",
            ["no <visual> and no <collision>", "Save what you want computed"],
        ),
        (
            "b.sdf",
            SDF.replace("<pose>0", "<pose relative_to='x'>0", 1),
            ["a pose relative to", "relative to the parent"],
        ),
        (
            "c.sdf",
            SDF.replace("<box><size>1 1 1</size></box>", "<heightmap/>", 1),
            ["<heightmap>", "box, cylinder, sphere"],
        ),
        ("d.urdf", URDF, ["ball.stl", "not there", "Copy the meshes next to the model"]),
        ("e.sdf", SDF.replace("<link ", "<include/><link ", 1), ["includes others"]),
        ("f.urdf", URDF.replace('xyz="2 0 0"', 'xyz="2 0"'), ["xyz"]),
    ],
)
def test_what_cannot_be_composed_says_what_to_do(tmp_path: Path, name: str, text: str, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        load(written(tmp_path, name, text))
    for word in words:
        assert word in str(caught.value)


def step_block(x: float, y: float, z: float) -> str:
    """A block in mm as an AP214 STEP, written by hand after ISO 10303-42: six planes, twelve lines."""
    rows: list[str] = []

    def add(text: str) -> str:
        rows.append(f"#{len(rows) + 1}={text};")
        return f"#{len(rows)}"

    corners = [(a, b, c) for a in (0.0, x) for b in (0.0, y) for c in (0.0, z)]
    points = [add(f"CARTESIAN_POINT('',({a},{b},{c}))") for a, b, c in corners]
    ends = [add(f"VERTEX_POINT('',{p})") for p in points]
    curves: dict[tuple[int, int], str] = {}

    def way(v: np.ndarray) -> str:
        return add(f"DIRECTION('',({v[0]:.1f},{v[1]:.1f},{v[2]:.1f}))")

    def edge(i: int, j: int) -> str:
        if (j, i) in curves:
            return add(f"ORIENTED_EDGE('',*,*,{curves[j, i]},.F.)")
        along = np.subtract(corners[j], corners[i])
        length = float(np.linalg.norm(along))
        line = add(f"LINE('',{points[i]},{add(f'VECTOR({chr(39)}{chr(39)},{way(along / length)},{length})')})")
        curves[i, j] = add(f"EDGE_CURVE('',{ends[i]},{ends[j]},{line},.T.)")
        return add(f"ORIENTED_EDGE('',*,*,{curves[i, j]},.T.)")

    faces = []
    for ring in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
        a, b, c = (np.array(corners[k]) for k in ring[:3])
        normal = np.cross(b - a, c - b)
        axis, first = way(normal / np.linalg.norm(normal)), way((b - a) / np.linalg.norm(b - a))
        plane = add(f"PLANE('',{add(f'AXIS2_PLACEMENT_3D({chr(39)}{chr(39)},{points[ring[0]]},{axis},{first})')})")
        loop = ",".join(edge(ring[k], ring[(k + 1) % 4]) for k in range(4))
        bound = add(f"FACE_OUTER_BOUND('',{add(f'EDGE_LOOP({chr(39)}{chr(39)},({loop}))')},.T.)")
        faces.append(add(f"ADVANCED_FACE('',({bound}),{plane},.T.)"))
    solid = add(f"MANIFOLD_SOLID_BREP('block',{add(f'CLOSED_SHELL({chr(39)}{chr(39)},({chr(44).join(faces)}))')})")
    units = [
        add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"),
        add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"),
        add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())"),
    ]
    close = add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),{units[0]},'distance_accuracy_value','')")
    context = add(
        f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({close}))"
        f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({','.join(units)}))REPRESENTATION_CONTEXT('',''))"
    )
    shape = add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({solid}),{context})")
    app = add("APPLICATION_CONTEXT('automotive design')")
    product = add(
        f"PRODUCT('block','block','',({add(f'PRODUCT_CONTEXT({chr(39)}{chr(39)},{app},{chr(39)}mechanical{chr(39)})')}))"
    )
    formed = add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    defined = add(
        f"PRODUCT_DEFINITION('','',{formed},{add(f'PRODUCT_DEFINITION_CONTEXT({chr(39)}{chr(39)},{app},{chr(39)}design{chr(39)})')})"
    )
    add(
        f"SHAPE_DEFINITION_REPRESENTATION({add(f'PRODUCT_DEFINITION_SHAPE({chr(39)}{chr(39)},{chr(39)}{chr(39)},{defined})')},{shape})"
    )
    head = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
    return head + "\n".join(rows) + "\nENDSEC;\nEND-ISO-10303-21;\n"


def test_a_step_in_mm_is_read_in_m(tmp_path: Path) -> None:
    vertices, faces = load(written(tmp_path, "block.step", step_block(300.0, 200.0, 100.0)))
    assert mesh_integrals(vertices, faces).volume == pytest.approx(0.006, rel=1e-6)
    assert vertices.max(axis=0) == pytest.approx([0.3, 0.2, 0.1], rel=1e-6)


def test_a_step_without_its_package_says_which(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_file, "find_spec", lambda _: None)
    with pytest.raises(InputError, match=r"coeflab\[step\]"):
        load(written(tmp_path, "block.stp", "ISO-10303-21;"))
