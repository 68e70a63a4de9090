"""Where the parts of a foreign model stand and which way they turn: poses relative to others, nested models, principal axes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.text.xml import parse_xml
from coeflab.formats.gazebo.assembly import assembly
from coeflab.formats.model_files import read_vehicle_file

TURNED = "0 0 0 0 0 1.5707963267948966"
SDF = """<model name="m"><link name="hull">{hull}</link><link name="p"><pose>-1 0 0 0 0 1.5707963267948966</pose></link>
<joint name="j" type="revolute"><parent>hull</parent><child>p</child>{joint}</joint></model>"""


@pytest.mark.parametrize(
    ("hull", "joint", "axis"),
    [
        ("", "<axis><xyz>1 0 0</xyz></axis>", (0.0, 1.0, 0.0)),  # in the frame of the child
        ("", '<pose relative_to="hull"/><axis><xyz>1 0 0</xyz></axis>', (1.0, 0.0, 0.0)),
        ("", "<axis><xyz>1 0 0</xyz><use_parent_model_frame>true</use_parent_model_frame></axis>", (1.0, 0.0, 0.0)),
        (f"<pose>{TURNED}</pose>", '<axis><xyz expressed_in="__model__">0 1 0</xyz></axis>', (1.0, 0.0, 0.0)),
        ("", '<axis><xyz expressed_in="hull">1 0 0</xyz></axis>', (1.0, 0.0, 0.0)),
    ],
)
def test_an_axis_is_in_the_frame_that_the_joint_names(hull: str, joint: str, axis: tuple[float, ...]) -> None:
    """SDF 1.9, joint: its pose is in the child's frame unless relative_to says another; the axis in the joint's."""
    (found,) = assembly(parse_xml(SDF.format(hull=hull, joint=joint)), "hull").joints
    np.testing.assert_allclose(found.axis, axis, atol=1e-12)


def test_a_nested_model_carries_its_links() -> None:
    text = """<sdf version="1.9"><model name="m"><pose>5 5 5 0 0 0</pose><link name="hull"/><model name="n"><pose>-1 0 0 0 0 0</pose>
<link name="p"><pose>0 .2 0 0 0 0</pose></link></model><joint name="j" type="fixed"><parent>hull</parent><child>n::p</child></joint></model></sdf>"""
    np.testing.assert_allclose(assembly(parse_xml(text), "hull").links["p"].place, (-1.0, 0.2, 0.0), atol=1e-12)


STONEFISH = """<scenario><robot name="r"><base_link name="b" type="box" physics="submerged"><dimensions xyz="1 .5 .4"/><origin xyz="0.3 0 0" rpy="0 0 0"/>
<mass value="80"/><inertia xyz="1 2 2.5"/><cg xyz="0 0 0" rpy="0 0 1.5707963267948966"/></base_link>
<actuator name="t" type="thruster"><specs thrust_coeff="0.48" max_rpm="600"{specs}/><propeller diameter="0.2" right="{right}"/><origin xyz="-1 0 0" rpy="0 0 0"/></actuator>
</robot></scenario>"""


def stonefish(folder: Path, specs: str = "", right: str = "true"):
    path = folder / "r.scn"
    path.write_text(STONEFISH.format(specs=specs, right=right))
    return read_vehicle_file(path)


def test_the_centre_of_gravity_of_stonefish_is_in_the_body_and_turns_its_moments(tmp_path: Path) -> None:
    """SolidEntity.cpp: T_CG2O is the inverse of <cg>; the shape's <origin> is none of it."""
    mass = stonefish(tmp_path).mass
    np.testing.assert_allclose(mass.centre, np.zeros(3), atol=1e-12)
    np.testing.assert_allclose(mass.inertia_matrix, np.diag([2.0, 1.0, 2.5]), atol=1e-12)


@pytest.mark.parametrize(
    ("specs", "right"), [(' inverted="true"', "true"), (' thrust_coeff_backward="0.2"', "true"), ("", "false")]
)
def test_a_thruster_of_stonefish_with_two_sides_or_a_turned_sign_is_left_out_by_name(
    tmp_path: Path, specs: str, right: str
) -> None:
    (t,) = stonefish(tmp_path, ' torque_coeff="0.05"').thrusters
    unit = 1000.0 * 0.2**4 * 5.0 * abs(5.0)  # rho D^4 n|n| at 300 rpm
    found = t.curve.at(300.0) * t.direction[0], t.torque_curve.at(300.0) * t.handedness * t.direction[0]
    assert found == pytest.approx((0.48 * unit, -0.05 * 0.2 * unit))
    assert {f["kind"] for f in stonefish(tmp_path).findings if f.code == "model.left_out"} >= {"rotors"}
    file = stonefish(tmp_path, specs, right)
    assert file.thrusters == ()
    assert any("thruster t" in note for note in file.remarks)


def test_b_beside_a_mass_that_it_cannot_carry_is_a_breadth(tmp_path: Path) -> None:
    path = tmp_path / "ship.m"
    text = (
        "rho = 1025; m = 1500; xG = 0; yG = 0; zG = 0; xB = 0; yB = 0; zB = 0; L = 5; Yv = -20; Yvdot = -30; B = {};\n"
    )
    path.write_text(text.format(0.8))
    assert read_vehicle_file(path).hydrostatics is None
    path.write_text(text.format(1500 * 9.81))
    floating = read_vehicle_file(path).hydrostatics
    assert floating.volume == pytest.approx(1500.0 * 9.81 / (1025.0 * 9.80665), rel=1e-2)
