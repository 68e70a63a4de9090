"""Mesh files that are not what they say: refused before anything is loaded."""

from __future__ import annotations

import json
import logging
import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coeflab.bodies.mesh import declared_faces
from coeflab.bodies.mesh import file as mesh_file
from coeflab.bodies.mesh.file import faces_of, load, memory_needed
from coeflab.bodies.mesh.gates import examined, repaired
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.core.errors import InputError

BALL = trimesh.creation.icosphere(subdivisions=1)
FORMATS = {"stl": "stl", "ascii.stl": "stl_ascii", "obj": "obj", "ply": "ply", "ascii.ply": "ply_ascii", "glb": "glb"}


def content(kind: str, ball: trimesh.Trimesh = BALL) -> bytes:
    if kind == "ply_ascii":
        return ball.export(file_type="ply", encoding="ascii")
    made = ball.export(file_type=kind)
    return made if isinstance(made, bytes) else made.encode()


def written(folder: Path, name: str, data: bytes) -> Path:
    (folder / name).write_bytes(data)
    return folder / name


def refused(path: Path, *words: str) -> None:
    with pytest.raises(InputError) as caught:
        load(path)
    for w in (path.name, *words):
        assert w in str(caught.value)


@pytest.mark.parametrize("name", FORMATS)
def test_every_format(tmp_path: Path, name: str) -> None:
    path = written(tmp_path, f"ball.{name}", content(FORMATS[name]))
    assert faces_of(path) == 80
    vertices, faces = load(path)
    assert faces.shape == (80, 3)
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("share", [0.0, 0.02, 0.5, 0.97])
def test_every_format_cut_short(tmp_path: Path, name: str, share: float) -> None:
    """No truncated file passes unnoticed; an OBJ has no mark of its end and loses faces, which other gates see."""
    data = content(FORMATS[name])
    path = written(tmp_path, f"ball.{name}", data[: int(share * len(data))])
    if name == "obj" and share > 0.9:
        assert len(load(path)[1]) < 80
        return
    refused(path)


def test_a_header_that_claims_four_thousand_million_triangles(tmp_path: Path) -> None:
    data = bytes(80) + struct.pack("<I", 4_000_000_000) + bytes(50)
    refused(written(tmp_path, "bomb.stl", data), "counts 4000000000 triangles", "200000000084 bytes", "cut short")


@pytest.mark.parametrize("text", [b"no mesh\n", b"x,y,z\r\n1,2,3\r\n" * 20, b"solid fuel and other words\n" * 9])
def test_a_text_file_named_stl(tmp_path: Path, text: bytes) -> None:
    """It says what it is, and counts no triangles."""
    with pytest.raises(InputError, match="a text file that begins") as why:
        faces_of(written(tmp_path, "t.stl", text))
    assert "triangles" not in str(why.value)
    assert "It is no STL" in str(why.value)


def test_a_binary_stl_whose_header_says_solid(tmp_path: Path) -> None:
    data = content("stl")
    path = written(tmp_path, "s.stl", b"solid facet".ljust(80) + data[80:])
    assert faces_of(path) == 80
    assert len(load(path)[1]) == 80


def test_ply_that_promises_too_much(tmp_path: Path) -> None:
    head = "ply\nformat {}\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 12\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    for kind in ("binary_little_endian 1.0", "ascii 1.0"):
        refused(written(tmp_path, "b.ply", head.format(kind).encode() + bytes(500)), "4000000000 vertices", "or more")
    cloud = head.replace("element face 12", "element face 0").replace("4000000000", "4")
    refused(written(tmp_path, "c.ply", cloud.format("ascii 1.0").encode()), "Is it a point cloud?")
    refused(written(tmp_path, "d.ply", b"ply\nformat ascii 1.0\n"), "end_header")


def glb(description: object, binary: bytes = b"") -> bytes:
    text = json.dumps(description).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(binary)) + b"BIN\x00" + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def scene(count: int = 3, nodes: object = None, **more: object) -> dict[str, object]:
    return {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}] if nodes is None else nodes,
        **more,
    }


@pytest.mark.parametrize(
    ("description", "words"),
    [
        (scene(4_000_000_000), "4000000000 values that the file does not hold"),
        (scene(nodes=[{"children": [1]}, {"children": [0], "mesh": 0}]), "nodes that are no tree"),
        (scene(nodes=[{"children": [1, 1]}, {"mesh": 0}]), "nodes that are no tree"),
        (scene(nodes=[{}] * 10_001), "10001 nodes"),
        (scene(extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression"),
        (scene(buffers=[{"uri": "../secret.bin", "byteLength": 36}]), "data in another file"),
        (scene(accessors=[{"count": 10**12, "componentType": 5126, "type": "VEC3"}]), "a broken description"),
        (scene(meshes=[{"primitives": 7}]), "a broken description"),
        (["no", "object"], "a broken description"),
        (scene(nodes=[]), "no faces"),
    ],
)
def test_glb_that_cannot_be(tmp_path: Path, description: object, words: str) -> None:
    refused(written(tmp_path, "b.glb", glb(description, bytes(36))), words)


def test_glb_of_another_kind(tmp_path: Path) -> None:
    data = content("glb")
    refused(
        written(tmp_path, "a.glb", data[:4] + struct.pack("<I", 1) + data[8:]), "found version 1", "a GLB of version 2"
    )
    refused(written(tmp_path, "e.glb", b"PK" + data[2:]), 'begins with "glTF"')
    refused(written(tmp_path, "d.glb", data[:16] + b"BIN" + data[19:]), "no description behind the header")
    refused(written(tmp_path, "b.glb", data + b"more"), "a whole GLB")
    refused(written(tmp_path, "c.gltf", b"{}"), "Save it as GLB")


def test_copies_in_a_glb_count(tmp_path: Path) -> None:
    made = trimesh.Scene([BALL])
    made.add_geometry(next(iter(made.geometry.values())), transform=np.diag([2.0, 2.0, 2.0, 1.0]))
    path = written(tmp_path, "two.glb", made.export(file_type="glb"))
    assert faces_of(path) == 160
    assert len(load(path)[1]) == 160


def test_paths_to_nothing(tmp_path: Path) -> None:
    refused(tmp_path / "none.stl", "no such file")
    (tmp_path / "folder.stl").mkdir()
    refused(tmp_path / "folder.stl", "a folder")
    refused(written(tmp_path, "empty.stl", b""), "an empty file")
    refused(written(tmp_path, "hull.iges", b"S 1"), ".iges", "stl, obj, ply, glb, dae, step")
    refused(written(tmp_path, "notes.stl", b"a letter, not a mesh"), "an STL")
    refused(written(tmp_path, "letter.obj", b"Dear sirs,\n"), "no vertices and faces")
    with pytest.raises(InputError):
        load(Path("nul\0.stl"))


@pytest.mark.parametrize("word", ["nan", "inf", "1e400"])
def test_coordinates_that_are_no_numbers(tmp_path: Path, word: str) -> None:
    text = content("obj").decode().split("\n")
    first = next(i for i, line in enumerate(text) if line.startswith("v "))
    text[first] = f"v {word} 0 0"
    refused(written(tmp_path, "n.obj", "\n".join(text).encode()), "1 vertices with coordinates that are no numbers")


def test_coordinates_that_are_no_numbers_in_binary(tmp_path: Path) -> None:
    data = bytearray(content("stl"))
    data[84 + 12 : 84 + 16] = struct.pack("<f", np.nan)
    refused(written(tmp_path, "n.stl", bytes(data)), "coordinates that are no numbers")


@pytest.mark.parametrize("corner", ["9", "0", "-9", "x", "9/1/1", "1.5", "99999999999999999999999"])
def test_a_face_without_its_vertex_is_named_by_line(tmp_path: Path, corner: str) -> None:
    text = f"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\nf 1 2 {corner}\nv 1 1 1\n"
    path = written(tmp_path, "f.obj", text.encode())
    refused(path, "f.obj, line 6", f'a face with the corner "{corner}"', "numbers from 1 to 4")


def test_corners_that_count_back_are_read(tmp_path: Path) -> None:
    path = written(tmp_path, "f.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nvt 0 0\nf 1/1/0 2/1 3\n")
    assert load(path)[1].tolist() == [[0, 1, 2], [0, 1, 2]]


def sparse(folder: Path, faces: int) -> Path:
    """A file of the right size: nothing of it is written but the header."""
    path = folder / "huge.stl"
    with path.open("wb") as stream:
        stream.write(bytes(80) + struct.pack("<I", faces))
        stream.truncate(84 + 50 * faces)
    return path


def test_a_mesh_too_large_for_the_machine_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten million faces take 7 GB: too much for 8 GiB, not for 16."""
    path = sparse(tmp_path, 10_000_000)
    monkeypatch.setattr(mesh_file, "physical_memory", lambda: 8 << 30)
    refused(path, "10000000 faces", "7.0 GB of memory", "at most 6.4 GB, three quarters of this machine's", "Decimate")
    monkeypatch.setattr(mesh_file, "physical_memory", lambda: None)
    refused(path, "at most 6.4 GB")
    monkeypatch.setattr(mesh_file, "physical_memory", lambda: 16 << 30)
    assert faces_of(path) == 10_000_000


def test_text_takes_more_memory(tmp_path: Path) -> None:
    sizes = {n: written(tmp_path, f"ball.{n}", content(k)).stat().st_size for n, k in FORMATS.items()}
    for name, size in sizes.items():
        held = declared_faces.text_of(tmp_path / f"ball.{name}", 80)
        assert held == (size if name in ("ascii.stl", "obj", "ascii.ply") else 0)
    assert memory_needed(1, 300 << 20) == 7 * (300 << 20)


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
def test_the_stated_memory_is_not_exceeded(tmp_path: Path, name: str) -> None:
    """From file to volume; a quarter and more of what is stated, lest nothing was measured."""
    path = written(tmp_path, f"ball.{name}", content(FORMATS[name], trimesh.creation.icosphere(subdivisions=6)))
    count = faces_of(path)
    stated = memory_needed(count, declared_faces.text_of(path, count))
    load(written(tmp_path, f"small.{name}", content(FORMATS[name])))
    tracemalloc.start()
    sound = examined(*load(path), path)
    TriangleMesh(sound.vertices, sound.faces)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.25 * stated < peak < stated


def test_text_has_a_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(declared_faces, "LARGEST_TEXT", 1000)
    for name in ("ascii.stl", "obj", "ascii.ply"):
        refused(written(tmp_path, f"ball.{name}", content(FORMATS[name])), "MB of text", "binary STL or PLY")


def test_a_text_bomb_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One vertex and far too many faces of it, and one face of far too many corners."""
    monkeypatch.setattr(mesh_file, "most_memory", lambda: 1000 * mesh_file.BYTES_PER_FACE)
    for bomb in (b"f 1 1 1\n" * 1001, b"f" + b" 1" * 1003):
        refused(written(tmp_path, "bomb.obj", b"v 0 0 0\n" + bomb), "1001 faces", "Decimate")


@pytest.mark.parametrize("name", FORMATS)
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damage_is_an_input_error_or_a_mesh(tmp_path: Path, name: str, data: st.DataObject) -> None:
    """Bytes overwritten or cut out anywhere, most often in the header: refused with the file's name, or read."""
    whole = bytearray(content(FORMATS[name]))
    at = data.draw(st.one_of(st.integers(0, min(len(whole), 700) - 1), st.integers(0, len(whole) - 1)))
    if data.draw(st.booleans()):
        new = data.draw(st.binary(min_size=1, max_size=8))
        whole[at : at + len(new)] = new
    else:
        del whole[at : at + data.draw(st.integers(1, 200))]
    path = written(tmp_path, f"damaged.{name}", bytes(whole))
    for mended in (examined, repaired):
        said = str(path)
        try:
            vertices, faces = load(path)
            mended(vertices, faces, path)
        except InputError as why:
            said = str(why)
        assert str(path) in said


def test_large_meshes_are_announced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    path = written(tmp_path, "ball.stl", content("stl"))
    with caplog.at_level(logging.INFO, "coeflab"):
        load(path)
        assert caplog.messages == ["reading 80 faces of ball.stl"]
        monkeypatch.setattr(mesh_file, "LARGE_MESH", 80)
        load(path)
    assert caplog.messages[1] == "ball.stl: 80 faces, about 0.1 GB of memory"
