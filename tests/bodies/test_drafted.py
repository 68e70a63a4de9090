"""The body.toml that is made of a bare mesh: it reads as the mesh did, and becomes a steered vehicle once it is completed."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
import trimesh

from coeflab.bodies.body import Body
from coeflab.bodies.drafted import drafted, is_untouched
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.readers import read_body
from coeflab.bodies.simplify.source import mesh_body
from coeflab.core.axes import DIRECTIONS
from coeflab.core.errors import InputError
from coeflab.core.units import factor
from tests.bodies.twelve import TWELVE


def made(folder: Path, kind: str) -> tuple[Body, Path]:
    """The bare mesh of a vehicle, and its body.toml in a folder beside."""
    mesh = folder / f"{kind}.stl"
    TWELVE[kind]().export(mesh)
    bare = mesh_body(str(mesh), "m", "FLU")
    bare = replace(bare, reference_point=bare.configurations[0].centre_of_buoyancy)
    assert isinstance(bare.shape, TriangleMesh)
    (folder / "draft").mkdir()
    file = folder / "draft" / "body.toml"
    file.write_text(drafted(bare, bare.shape, mesh, file.parent, "m", "FLU"))
    return bare, file


def completed(text: str) -> str:
    """With its comments of rudder, planes and thruster taken in, and numbers in the place of words."""
    head, block, tail = text.partition("# [[control]]")
    tail = tail.partition("# Or by another command")[0]
    lines = re.sub(r"(?m)^# (\[\[|name|parts|hinge|axis|limit|rate|place|curve)", r"\1", block + tail)
    return head + lines.replace("LIMIT", "20").replace("RATE", "40").replace("[RPM, NEWTON]", "[1500, 30]")


def test_as_it_is_made_it_is_the_mesh_and_nothing_turns(tmp_path: Path) -> None:
    bare, file = made(tmp_path, "torpedo")
    found = read_body(file)
    assert found.require_shape().volume == pytest.approx(bare.require_shape().volume, rel=1e-12)
    assert found.reference_point == pytest.approx(bare.reference_point, abs=1e-4)
    assert (found.controls, found.thrusters) == ((), ())
    assert 'path = "../torpedo.stl"' in file.read_text()
    assert is_untouched(file.read_text())
    assert not is_untouched(file.read_text().replace('"FLU"', '"FRD"'))


def test_completed_its_pairs_of_fins_are_rudder_and_stern_planes(tmp_path: Path) -> None:
    _, file = made(tmp_path, "torpedo")
    file.write_text(completed(file.read_text()))
    found = read_body(file)
    turned = {c.name: c for c in found.controls}
    assert set(turned) == {"dr", "ds"}
    assert set(turned["dr"].parts) == {"foil_upper", "foil_lower"}
    assert set(turned["ds"].parts) == {"foil_starboard", "foil_port"}
    (thruster,) = found.thrusters
    shape = found.require_shape()
    assert isinstance(shape, TriangleMesh)
    assert thruster.place == pytest.approx([shape.vertices[:, 0].min(), 0.0, 0.0], abs=1e-4)
    turning = {f.name: f for f in found.outline.foils if f.control}
    assert set(turning) == {"foil_upper", "foil_lower", "foil_starboard", "foil_port"}
    upper = turning["foil_upper"]  # half of the root chord lies a quarter of it behind the quarter chord
    assert turned["dr"].hinge == pytest.approx([upper.root[0] - 0.25 * upper.root_chord, 0.0, 0.0], abs=1e-3)
    # Positive: the trailing edge of a rudder to port, of a plane down; sign counts from root to tip, up and to starboard.
    assert turning["foil_upper"].sign == -turning["foil_lower"].sign == -1.0
    assert turning["foil_starboard"].sign == -turning["foil_port"].sign == 1.0


def test_without_numbers_the_words_are_refused(tmp_path: Path) -> None:
    _, file = made(tmp_path, "torpedo")
    file.write_text(completed(file.read_text()).replace("20 deg", "LIMIT deg"))
    with pytest.raises(InputError, match="LIMIT deg"):
        read_body(file)


def test_a_placeholder_of_a_curve_is_named_with_its_line(tmp_path: Path) -> None:
    _, file = made(tmp_path, "torpedo")
    text = completed(file.read_text()).replace("[1500, 30]", "[RPM, NEWTON]")
    file.write_text(text)
    with pytest.raises(InputError, match="RPM and NEWTON, placeholders") as why:
        read_body(file)
    assert text.splitlines()[why.value.line - 1].startswith("curve")
    file.write_text(text.replace("[[0, 0], [RPM, NEWTON]]", '"RPM" "NEWTON" # RPM'))
    with pytest.raises(InputError, match="a TOML error"):
        read_body(file)


def test_the_other_command_and_the_masses_of_its_comments_are_read(tmp_path: Path) -> None:
    """What stands behind the # of the draft is a body.toml: a throttle in %, and a neutral vehicle by ballast."""
    _, file = made(tmp_path, "torpedo")
    head, _, rest = completed(file.read_text()).partition("curve = ")
    other, _, masses = file.read_text().partition("# Or by another command")[2].partition("\n\n")
    lines = [line.removeprefix("# ") for line in other.splitlines()[1:]]
    weights = [line.removeprefix("# ") for line in masses.splitlines()[1:]]
    text = "\n".join([head, *lines, *weights]).replace("MASS", "5")
    for name, own in (("IX", "0.02"), ("IY", "0.8"), ("IZ", "0.8")):
        text = text.replace(f'"{name} kg m^2"', f'"{own} kg m^2"')
    file.write_text(text)
    found = read_body(file)
    (thruster,) = found.thrusters
    assert (thruster.command, thruster.unit) == ("throttle", "%")
    assert thruster.curve.tolist() == [[0.0, 0.0], [100.0, 40.0]]
    assert np.linalg.eigvalsh(found.mass_model.inertia)[0] > 0.0
    assert found.mass_model.mass == pytest.approx(found.mass_model.density * found.mass_model.volume)
    assert rest


def test_fins_ahead_are_named_and_oblique_ones_of_the_tail_drafted_as_comments(tmp_path: Path) -> None:
    _, file = made(tmp_path, "submarine")  # a sail, and a tail in X
    text = file.read_text()
    assert "foil_upper: " in text
    assert text.count(", oblique\n") == 4
    assert text.count("# [[control]]\n") == text.count("[[control]]\n") == 8  # dr and ds of each fin; none of the sail
    assert np.isfinite(read_body(file).require_shape().volume)


def test_a_body_without_fins_says_so(tmp_path: Path) -> None:
    _, file = made(tmp_path, "box_rov")
    assert "# No fin was found, so nothing can turn." in file.read_text()


RIGHT = [d for d in permutations(DIRECTIONS, 3) if np.linalg.det([DIRECTIONS[k] for k in d]) > 0.5]


WRITTEN = (("mm", "a hull.stl"), ("in", "Rumpf_ä'1.stl"), ("ft", "0.9 m#2.stl"))


@pytest.mark.parametrize(
    ("axes", "unit", "name"),
    [(a, *WRITTEN[k % 3]) for k, a in enumerate([*(",".join(d) for d in RIGHT), "flu", "FRD", "CFD"])],
)
def test_whatever_axes_unit_and_name_a_draft_has_it_reads_as_the_mesh_did(
    tmp_path: Path, axes: str, unit: str, name: str
) -> None:
    mesh, file = tmp_path / name, tmp_path / "draft" / "body.toml"
    trimesh.creation.cone(0.2, 1.0, sections=8).apply_scale(1.0 / factor(unit, "length")).export(mesh)
    bare = mesh_body(str(mesh), unit, axes)
    assert isinstance(bare.shape, TriangleMesh)
    file.parent.mkdir()
    file.write_text(drafted(bare, bare.shape, mesh, file.parent, unit, axes), encoding="utf-8")
    found = read_body(file)
    assert found.name == bare.name
    assert found.axes == bare.axes
    assert found.require_shape().centre_of_volume == pytest.approx(bare.shape.centre_of_volume, abs=1e-9)


def oblique(folder: Path) -> Path:
    """The draft of a torpedo that is rolled by 45 deg, completed: an X tail."""
    mesh = folder / "x.stl"
    whole = TWELVE["torpedo"]()
    whole.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 4.0, [1.0, 0.0, 0.0]))
    whole.export(mesh)
    bare = mesh_body(str(mesh), "m", "FLU")
    assert isinstance(bare.shape, TriangleMesh)
    file = folder / "body.toml"
    file.write_text(completed(drafted(bare, bare.shape, mesh, folder, "m", "FLU")))
    return file


def test_an_x_tail_is_offered_both_angles_a_fin_each(tmp_path: Path) -> None:
    """Each fin turns about its span by all of dr, with dr right-handed about z, and by all of ds, right-handed about y."""
    found = read_body(oblique(tmp_path))
    assert [c.name for c in found.controls] == ["dr"] * 4 + ["ds"] * 4
    signs = {f.name: dict(f.turns) for f in found.outline.foils}
    expected = {
        "foil_upper_starboard": {"dr": -1.0, "ds": 1.0}, "foil_upper_port": {"dr": -1.0, "ds": -1.0},
        "foil_lower_starboard": {"dr": 1.0, "ds": 1.0}, "foil_lower_port": {"dr": 1.0, "ds": -1.0},
    }  # fmt: skip
    assert signs.keys() == expected.keys()
    assert all(signs[n] == pytest.approx(expected[n], abs=0.01) for n in expected)
    assert not [line for line in found.outline.left_out if "foil" in line]


def test_a_hinge_across_its_fin_is_refused(tmp_path: Path) -> None:
    """The normal of an oblique fin, written for its span: it had no effect, and nothing told why."""
    file = oblique(tmp_path)
    text = file.read_text()
    at = text.index("axis = [", text.index('parts = ["foil_upper_starboard"]'))
    wrong = text[:at] + "axis = [0.0, 0.7, 0.7]\n" + text[text.index("\n", at) + 1 :]
    file.write_text(wrong)
    with pytest.raises(
        InputError,
        match=r"0\.707, 0\.707\] of dr, across the span of foil_upper_starboard.*\[0, -0\.7\d*, 0\.7\d*\] is",
    ):
        _ = read_body(file).outline


def test_a_turn_about_z_of_oblique_fins_counts_in_part_and_says_so(tmp_path: Path) -> None:
    file = oblique(tmp_path)
    head = file.read_text().partition("\n[[control]]")[0] + "\n"
    fins = [f"foil_{a}_{b}" for a in ("upper", "lower") for b in ("starboard", "port")]
    file.write_text(f'{head}[[control]]\nname = "dr"\nparts = {fins}\nhinge = [0, 0, 0]\naxis = [0, 0, 1]\n')
    found = read_body(file).outline
    assert [abs(f.sign) for f in found.foils if f.control] == pytest.approx([np.sqrt(0.5)] * 4, abs=0.01)
    assert "by 0.71" in found.left_out[-1]
    assert "along the span, turns it by all" in found.left_out[-1]
