"""A mesh that lies across, upside down or backwards stops with the axes that are right; what is stated one by one is obeyed."""

from __future__ import annotations

import re
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.orientation import doubt, require_orientation
from coeflab.bodies.readers import read_body
from coeflab.bodies.simplify.source import mesh_body, subject
from coeflab.core.axes import DIRECTIONS, Axes, parse_axes
from coeflab.core.errors import InputError
from coeflab.estimates import Water, estimated
from coeflab.study.estimated_vehicle import asked, from_shape
from coeflab.tank.tank_file import read_tank
from tests.bodies.four import FOUR
from tests.bodies.twelve import TWELVE

RIGHT = [Axes(d) for d in permutations(DIRECTIONS, 3) if np.linalg.det([DIRECTIONS[k] for k in d]) > 0.5]
FLU = parse_axes("FLU")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.usefixtures("in_a_shell"),
]  # a doubt about axes takes two outlines of a mesh
TOML = (
    '[body]\nname = "toml"\nreader = "mesh"\ndatum = "nose"\nreference_point = [0, 0, 0]\n'
    '[mesh]\npath = "{}"\nunit = "m"\naxes = {}\n[prime]\nlength = 2.0\nlength_name = "LOA"\n'
    '[source]\ncitation = "synthetic"\nkind = "synthetic"\n'
)


def written(folder: Path, kind: str, own: Axes, suffix: str = "stl") -> Path:
    """A vehicle in axes of its own: their components of what stands in FLU."""
    mesh = {**TWELVE, **FOUR}[kind]()
    mesh.apply_transform(np.block([[own.rotation.T @ FLU.rotation, np.zeros((3, 1))], [np.zeros((1, 3)), 1.0]]))
    path = folder / f"{kind}.{suffix}"
    mesh.export(path)
    return path


def proposed(why: InputError) -> str:
    return re.findall(r"--axes ([\w,]+)", why.advice)[0]


@pytest.mark.parametrize("own", RIGHT[1::3], ids=lambda a: a.typed)  # every direction ahead and abeam, FLU among them
def test_a_submarine_in_any_axes_is_read_right_within_two_commands(tmp_path: Path, own: Axes) -> None:
    path = written(tmp_path, "submarine", own)
    body = mesh_body(str(path), "m", "FLU")
    if own == FLU:
        require_orientation(body)
        return
    with pytest.raises(InputError) as why:
        require_orientation(body)
    assert parse_axes(proposed(why.value)) == own
    again = mesh_body(str(path), "m", proposed(why.value))
    require_orientation(again)
    assert doubt(again) is None


@pytest.mark.parametrize("own", ["starboard,forward,up", "port,aft,up"])
def test_what_shows_no_tail_is_offered_both_ways_round(tmp_path: Path, own: str) -> None:
    """A tube has no bow: one of two proposals is right whichever end leads, and which is not guessed."""
    with pytest.raises(InputError) as why:
        require_orientation(mesh_body(str(written(tmp_path, "tube", parse_axes(own))), "m", "FLU"))
    offered = re.findall(r"--axes (\w+,\w+,\w+)", str(why.value).partition("If it lies right")[0])
    assert parse_axes(own) in [parse_axes(o) for o in offered]
    assert len(offered) == 2


@pytest.mark.parametrize(
    ("kind", "typed"),
    [
        ("torpedo", "down,port,forward"), ("glider", "port,up,forward"), ("box_rov", "starboard,forward,up"),
        ("frame_rov", "port,up,forward"), ("frame_rov", "down,port,forward"),
    ],
)  # fmt: skip
def test_what_lies_across_is_refused_and_the_proposal_is_accepted(tmp_path: Path, kind: str, typed: str) -> None:
    path = written(tmp_path, kind, parse_axes(typed), "ply")
    with pytest.raises(InputError) as why:
        require_orientation(mesh_body(str(path), "m", "FLU"))
    better = mesh_body(str(path), "m", proposed(why.value))
    require_orientation(better)
    assert doubt(better) is None


@pytest.mark.parametrize("kind", ["torpedo", "glider", "submarine", "frame_rov", "box_rov", "ducted_quadrotor", "triple_hull",
                                  "sphere_with_arms", "tube", "catamaran", "ring_wing_hull", "lander"])  # fmt: skip
def test_what_lies_right_passes(tmp_path: Path, kind: str) -> None:
    require_orientation(mesh_body(str(written(tmp_path, kind, FLU)), "m", "FLU"))


def test_axes_stated_one_by_one_are_obeyed(tmp_path: Path) -> None:
    path = written(tmp_path, "submarine", parse_axes("starboard,forward,up"))
    body = mesh_body(str(path), "m", "forward,port,up")
    require_orientation(body)
    found = doubt(body)
    assert found.code == "orientation.across"


def test_vehicle_estimates_and_tow_stop_and_name_the_axes(tmp_path: Path) -> None:
    own = "starboard,forward,up"
    path = written(tmp_path, "submarine", parse_axes(own))
    body = subject(str(path), "m", "FLU")
    (tmp_path / "body.toml").write_text(TOML.format(path.name, '"FLU"'))
    (tmp_path / "tank.toml").write_text(
        '[tank]\nname = "t"\nbody = "body.toml"\nsolver = "external"\n[conditions]\nspeed = 2.0\ndensity = 1000.0\n'
        "viscosity = 1e-6\n[scaling]\nlength = 2.0\nlength_name = 'LOA'\n"
    )
    stated = read_body(tmp_path / "body.toml")
    plan, said = asked(body)
    for use in (
        lambda: from_shape(plan, body, said),
        lambda: estimated(stated, Water(1000.0, 1e-6, 2.0)),
        lambda: read_tank(tmp_path / "tank.toml"),
    ):
        with pytest.raises(InputError, match="FLU") as why:
            use()
        assert parse_axes(proposed(why.value)) == parse_axes(own)
    (tmp_path / "body.toml").write_text(TOML.format(path.name, f'"{own}"'))
    require_orientation(read_body(tmp_path / "body.toml"))


def test_a_model_of_a_robot_is_held_to_its_axes_too(tmp_path: Path) -> None:
    written(tmp_path, "submarine", parse_axes("starboard,forward,up"))
    urdf = '<robot name="r"><link name="hull"><visual><geometry><mesh filename="submarine.stl"/></geometry></visual></link></robot>'
    (tmp_path / "r.urdf").write_text(urdf)
    with pytest.raises(InputError) as why:
        require_orientation(subject(str(tmp_path / "r.urdf")))
    require_orientation(subject(str(tmp_path / "r.urdf"), axes=proposed(why.value)))
