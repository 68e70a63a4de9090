"""Every gate of a mesh: the fault planted, the message read; then the repair on request."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.mesh import gates as mesh_gates
from coeflab.bodies.mesh.decimation import is_closed
from coeflab.bodies.mesh.gates import SoundMesh, examined, repaired, sound
from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import box, surface
from coeflab.bodies.mesh.topology import shells
from coeflab.core.errors import InputError
from tests.bodies.test_surface_mesh import CUBE, CUBE_FACES

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

FILE = Path("hull.stl")
APART, SHIFT = CUBE + np.array([3.0, 0.0, 0.0]), np.array([0.5, 0.4, 0.3])
Mesh = tuple[np.ndarray, np.ndarray]


def two(second: np.ndarray, turned: bool = False) -> Mesh:
    """The cube and a second one."""
    faces = CUBE_FACES[:, ::-1] if turned else CUBE_FACES
    return np.vstack([CUBE, second]), np.vstack([CUBE_FACES, faces + 8])


def with_cap() -> Mesh:
    """A cube with a vertex on an edge: two halves of a face on one side, a triangle without area between."""
    a, b, c = CUBE_FACES[0]
    return (
        np.vstack([CUBE, (CUBE[a] + CUBE[b]) / 2.0]),
        np.vstack([CUBE_FACES[1:], [[a, 8, c], [8, b, c], [a, b, 8]]]),
    )


def twisted() -> Mesh:
    """A ball with one vertex pulled through the far side: watertight, but not simple."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    vertices = np.array(ball.vertices)
    top = int(np.argmax(vertices[:, 2]))
    vertices[top] = [0.05, 0.02, -1.5]
    return vertices, np.asarray(ball.faces)


def turned_face() -> Mesh:
    faces = CUBE_FACES.copy()
    faces[2] = faces[2, ::-1]
    return CUBE, faces


def sheet() -> Mesh:
    return CUBE * [1.0, 1.0, 0.0], CUBE_FACES


FAULTS = {
    "hole": (CUBE, CUBE_FACES[1:]),
    "fin of one sheet": (np.vstack([CUBE, [[0.0, 0.0, 3.0]]]), np.vstack([CUBE_FACES, [[0, 1, 8]]])),
    "turned": turned_face(),
    "inward": (CUBE, CUBE_FACES[:, ::-1]),
    "degenerate": with_cap(),
    "duplicate": (CUBE, np.vstack([CUBE_FACES, CUBE_FACES[:2]])),
    "cavity": two(0.5 * CUBE, turned=True),
    "part inside out": two(APART, turned=True),
    "overlap": two(CUBE + SHIFT),
    "one in the other": two(0.5 * CUBE),
    "twisted": twisted(),
}
MESSAGES = {
    "hole": ["not watertight: 3 edges with one face", "--fill", "--sheets"],
    "fin of one sheet": ["not watertight: 2 edges with one face and 1 edges with more than two"],
    "turned": ["inconsistent winding", "at 3 edges", "repair = true"],
    "inward": ["inward normals", "repair = true"],
    "degenerate": ["1 degenerate faces of 14", "repair = true"],
    "duplicate": ["2 duplicate faces of 14", "repair = true"],
    "cavity": ["1 of 2 shells that look inward: a cavity", "leave inner walls out"],
    "part inside out": ["1 of 2 shells that look inward", "inside out"],
    "overlap": ["2 shells of which 1 pairs overlap", "counts twice", "Union them first", "repair = true"],
    "one in the other": ["2 shells of which 1 pairs overlap"],
    "twisted": ["cuts through itself", "Mend it where it was made"],
}


def test_a_sound_mesh_passes_untouched() -> None:
    found = examined(CUBE, CUBE_FACES, FILE)
    assert found.vertices == pytest.approx(CUBE)
    assert found.faces.tolist() == CUBE_FACES.tolist()
    assert found.statements == ()


def test_bodies_apart_pass() -> None:
    assert examined(*two(APART), FILE).faces.shape == (24, 3)
    ring = trimesh.creation.annulus(0.9, 1.0, 0.5)
    within = trimesh.util.concatenate([ring, trimesh.creation.icosphere(radius=0.5)])
    assert len(examined(np.asarray(within.vertices), np.asarray(within.faces), FILE).faces) == len(within.faces)


@pytest.mark.parametrize("fault", FAULTS)
def test_every_gate(fault: str) -> None:
    with pytest.raises(InputError) as caught:
        examined(*FAULTS[fault], FILE)
    for words in ("hull.stl", *MESSAGES[fault]):
        assert words in str(caught.value)


def test_nothing_enclosed() -> None:
    """A bent sheet of two sides that all but touch."""
    ball = trimesh.creation.icosphere(subdivisions=1)
    x, y, z = np.array(ball.vertices).T
    with pytest.raises(InputError, match="zero volume"):
        examined(np.column_stack([x, y, 0.3 * x**2 + 2e-9 * z]), np.asarray(ball.faces), FILE)


@pytest.mark.parametrize("turn", [0.0, 0.4])
@pytest.mark.parametrize("faces", [CUBE_FACES, CUBE_FACES[:2]])
def test_a_plate_without_thickness_is_sent_to_the_plate_formulas(turn: float, faces: np.ndarray) -> None:
    """Two sheets on each other, or one alone; along the axes or tilted, and far from the origin."""
    c, s = np.cos(turn), np.sin(turn)
    tilted = CUBE * [1.0, 1.0, 1e-8] @ np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]) + 100.0
    top = faces if len(faces) > 2 else CUBE_FACES[[np.ptp(CUBE[f][:, 2]) == 0.0 for f in CUBE_FACES]][:2]
    with pytest.raises(InputError, match="plate of zero thickness") as caught:
        examined(tilted, top, FILE)
    assert "reader primitives" in caught.value.advice


def test_too_many_shells(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_gates, "MOST_SHELLS", 1)
    with pytest.raises(InputError, match="2 separate shells"):
        examined(*two(APART), FILE)


def test_what_was_not_looked_at_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_gates, "MOST_TESTED", 11)
    assert examined(CUBE, CUBE_FACES, FILE).statements == ("self-intersection not looked for above 11 faces",)
    monkeypatch.undo()
    monkeypatch.setattr(mesh_gates, "crossing_faces", lambda *_: None)
    assert "too many faces lie close together" in examined(CUBE, CUBE_FACES, FILE).statements[0]


@pytest.mark.parametrize(
    ("fault", "volume", "said"),
    [
        ("turned", 1.0, "1 faces turned"),
        ("inward", 1.0, "1 of 1 shells turned outward"),
        ("degenerate", 1.0, "faces without an area merged into their neighbours"),
        ("duplicate", 1.0, "2 degenerate or duplicate faces dropped"),
        ("cavity", 1.0, "1 of 2 shells turned outward, 2 shells united"),
        ("part inside out", 2.0, "1 of 2 shells turned outward"),
        ("overlap", 2.0 - 0.5 * 0.6 * 0.7, "2 shells united"),
        ("one in the other", 1.0, "2 shells united"),
    ],
)
def test_repair_on_request_says_what_it_did(fault: str, volume: float, said: str) -> None:
    found = repaired(*FAULTS[fault], FILE)
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(volume, rel=1e-9)
    assert found.statements[0].startswith("repaired: ")
    assert said in found.statements[0]


@pytest.mark.parametrize("fault", ["hole", "fin of one sheet", "twisted"])
def test_repair_does_not_guess(fault: str) -> None:
    with pytest.raises(InputError) as caught:
        repaired(*FAULTS[fault], FILE)
    assert MESSAGES[fault][0].split(":")[0] in str(caught.value)


def test_repair_joins_what_is_nearly_joined() -> None:
    rng = np.random.default_rng(1)
    soup = CUBE[CUBE_FACES].reshape(-1, 3) + 1e-9 * rng.standard_normal((36, 3))
    corners = np.arange(36).reshape(-1, 3)
    with pytest.raises(InputError, match=r"not watertight: 36 edges .* nearly meet: set repair = true"):
        examined(soup, corners, FILE)
    found = repaired(soup, corners, FILE)
    assert len(found.vertices) == 8
    assert found.statements == ("repaired: 28 vertices joined",)
    assert repaired(CUBE, CUBE_FACES, FILE).statements == ("repaired: nothing to do",)


def meeting() -> Mesh:
    """Two cubes on one common edge, their vertices joined: four faces there, two one way and two the other."""
    corner = {tuple(v): k for k, v in enumerate(CUBE)}
    moved = CUBE + np.array([np.ptp(CUBE[:, 0]), np.ptp(CUBE[:, 1]), 0.0])
    number = [corner.get(tuple(v), 8 + k) for k, v in enumerate(moved)]
    vertices = np.vstack([CUBE, moved])
    return vertices, np.vstack([CUBE_FACES, np.array(number)[CUBE_FACES]])


@pytest.mark.parametrize("mend", [False, True])
def test_edges_in_balance_close_a_surface(mend: bool) -> None:
    found = sound(*meeting(), FILE, repair=mend)
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(2.0, rel=1e-12)
    assert is_closed(found.faces)
    assert mend or found.statements == ("solids that meet in 1 edges taken apart there",)


@pytest.mark.parametrize("move", [(1.0, 1.0, 0.0), (1.0, 0.5, 0.5), (1.0, 1.0, 1.0), (0.5, 0.0, 0.0)])
def test_what_manifold_unites_is_accepted(move: tuple[float, float, float]) -> None:
    """Unions that meet in an edge, a face, a corner and a body, read back with their vertices joined."""
    block = box(np.zeros(3), np.ones(3))
    whole = block + block.translate(move)
    found = examined(*surface(whole), FILE)
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(whole.volume(), rel=1e-12)


def test_small_holes_are_filled_on_request_and_large_ones_are_not() -> None:
    ball = trimesh.creation.icosphere(subdivisions=3)
    vertices, faces = np.array(ball.vertices), np.asarray(ball.faces)
    around = np.any(faces == 40, axis=1)
    found = sound(vertices, faces[~around], FILE, fill=True)
    assert found.statements[0] == "1 hole of up to 1% of the surface filled"
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(ball.volume, rel=5e-3)
    cap = vertices[faces].mean(axis=1)[:, 2] > 0.6
    with pytest.raises(InputError, match=r"not watertight.* --sheets") as caught:
        sound(vertices, faces[~cap], FILE, fill=True)
    share = re.search(r"not filled: a hole of ([\d.]+) % of the surface, above the limit of 1 %", str(caught.value))
    assert float(share[1]) == pytest.approx(
        100.0 * 0.64 / (4.0 - 0.8), rel=0.05
    )  # the disc in the cap over what is left
    assert "--fill" not in str(caught.value)


def around(faces: np.ndarray, *corners: int) -> np.ndarray:
    return np.any(np.isin(faces, corners), axis=1)


def test_rims_that_touch_are_left_and_the_others_filled() -> None:
    """Two faces that meet in a corner are gone, and the faces about another vertex."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    vertices, faces = np.array(ball.vertices), np.asarray(ball.faces)
    one, *rest = np.flatnonzero(around(faces, 40))
    other = next(k for k in rest if len(np.intersect1d(faces[k], faces[one])) == 1)
    away = int(np.argmax(np.linalg.norm(vertices - vertices[40], axis=1)))
    gone = around(faces, away)
    gone[[one, other]] = True
    with pytest.raises(
        InputError, match="6 edges with one face; not filled: rims that touch in a vertex, with 6 edges"
    ) as caught:
        sound(vertices, faces[~gone], FILE, fill=True)
    assert "--fill" not in str(caught.value)
    found = sound(
        vertices, np.delete(faces, [one], axis=0)[~around(np.delete(faces, [one], axis=0), away)], FILE, fill=True
    )
    assert found.statements[0] == "2 holes of up to 1% of the surface filled"
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(ball.volume, rel=5e-3)


def test_a_fin_of_one_sheet_is_a_sheet_on_request() -> None:
    found = sound(*FAULTS["fin of one sheet"], FILE, open_sheets=True)
    assert len(found.faces) == 12
    assert len(found.sheets) == 1
    assert "1 faces of" in found.statements[0]
    mesh = TriangleMesh(found.vertices, found.faces, sheets=found.sheets)
    assert mesh.volume == pytest.approx(1.0)
    alone = sound(CUBE, CUBE_FACES[2:], FILE, open_sheets=True)
    assert (len(alone.faces), len(alone.sheets)) == (0, 10)
    assert TriangleMesh(alone.vertices, alone.faces, sheets=alone.sheets).volume == 0.0


@pytest.mark.parametrize("read", [repaired, partial(sound, repair=True)])
def test_a_shell_that_is_given_from_both_sides_stays_once(read: Callable[..., SoundMesh]) -> None:
    """A pod of a thruster whose exporter wrote both sides of every face; walls between glued solids go all the same."""
    vertices, faces = two(APART)
    found = read(vertices, np.vstack([faces, faces[len(CUBE_FACES) :, ::-1]]), FILE)
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(
        2.0 * mesh_integrals(CUBE, CUBE_FACES).volume
    )
    glued = two(CUBE + np.array([np.ptp(CUBE[:, 0]), 0.0, 0.0]))
    assert mesh_integrals((one := read(*glued, FILE)).vertices, one.faces).volume == pytest.approx(
        2.0 * mesh_integrals(CUBE, CUBE_FACES).volume
    )
    assert shells(one.faces)[0] == 1


def test_solids_glued_on_a_face_are_one_after_repair() -> None:
    """Both have the wall between them: neither half of it is kept."""
    vertices, faces = two(CUBE + np.array([np.ptp(CUBE[:, 0]), 0.0, 0.0]))
    found = repaired(vertices, faces, FILE)
    assert mesh_integrals(found.vertices, found.faces).volume == pytest.approx(2.0, rel=1e-12)
    assert mesh_integrals(found.vertices, found.faces).area == pytest.approx(10.0, rel=1e-12)
