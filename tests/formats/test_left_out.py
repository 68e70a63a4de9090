"""What a reader of somebody's model leaves out is listed; a foreign plugin is read by its own law or refused. All models are made up."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.axes import FLU
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.xml import parse_xml
from coeflab.formats.gazebo.law import read_gz_link
from coeflab.formats.model_files import read_model_file
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file

DATA = Path(__file__).parent / "data"
VESSEL = """function xdot = vessel(x)
L = 2.9; rho = 1019; g = 9.81; W = 4100; B = 4140; zG = 0.027; Ix = 12; Iy = 190; Iz = 193;
r2 = (1/2)*rho*L^2; r3 = (1/2)*rho*L^3; mass = W/g; Cdy = 0.65; Cdz = 0.75; Cd0 = 0.0037;
half = rho/2; Yv = -3.1e-2*2; Zw = -6.9e-2; Zwn = -4.1e-3; Mwn = -2.3e-3; Nr = -1.1e-2; Nv = half*0 - 0.01;
Y = Yv*x(2) + Cdy;
end
"""
SDF = """<?xml version="1.0"?><!-- made up --><sdf version="1.9"><model name="toy"><link name="hull"><inertial><pose>0.1 0 0 0 0 0</pose>
<mass>41</mass><inertia><ixx>0.3</ixx><iyy>5</iyy><izz>5.2</izz></inertia></inertial></link>
<link name="mast"><inertial><mass>2</mass></inertial></link>
<plugin filename="FILE" name="CLASS"><link_name>hull</link_name>MORE
<xDotU>-4</xDotU><yDotV>-37</yDotV><zDotW>-38</zDotW><kDotP>-0.2</kDotP><mDotQ>-7</mDotQ><nDotR>-8</nDotR>
<xU>-1.5</xU><yV>-3</yV><zW>-3.5</zW><kP>-0.5</kP><mQ>-6</mQ><nR>-6.5</nR>
<xUU>-6.1</xUU><yVV>-210</yVV><zWW>-215</zWW><kPP>-0.3</kPP><mQQ>-90</mQQ><nRR>-95</nRR></plugin>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster"/>
<plugin filename="gz-sim-pose-publisher-system" name="gz::sim::systems::PosePublisher"/></model></sdf>"""
LRAUV = ("HydrodynamicsPlugin", "tethys::HydrodynamicsPlugin")


def listed(file: ParameterFile) -> dict[str, set[str]]:
    return {f["kind"]: set(f["names"]) for f in file.findings if f.code == "model.left_out"}


def read(folder: Path, text: str, name: str) -> ParameterFile:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return read_model_file(path, 1000.0).parameters


def sdf(kind: tuple[str, str], more: str = "") -> str:
    return SDF.replace("FILE", kind[0]).replace("CLASS", kind[1]).replace("MORE", more)


def test_an_m_file(tmp_path: Path) -> None:
    """Before: read without a word. Numbers that only serve what is read, as `half`, are none."""
    file = read(tmp_path, VESSEL, "vessel.m")
    assert listed(file) == {
        "hydrostatics": {"B"}, "strips": {"Cdy", "Cdz", "Cd0"},
        "terms": {"Zwn", "Mwn"}, "equations": {"Y (line 5)"},
    }  # fmt: skip
    assert {f["kind"] for f in file.findings if f.severity is Severity.WARN} == {"strips", "terms", "equations"}
    assert any("Cdy, Cdz and Cd0" in r for r in file.remarks)


def test_what_is_left_out_travels_with_the_file(tmp_path: Path) -> None:
    file = read(tmp_path, VESSEL, "vessel.m")
    path = tmp_path / "vessel.parameters.json"
    path.write_bytes(file.to_json())
    assert read_parameter_file(path).findings == file.findings
    checks = read_model_file(path).findings
    assert sum(c.severity is Severity.WARN and "Left out" in c.statistic for c in checks) == 3


def test_an_sdf(tmp_path: Path) -> None:
    kind = ("gz-sim-hydrodynamics-system", "gz::sim::systems::Hydrodynamics")
    more = "<default_current>1 0 0</default_current><xExotic>3</xExotic>"
    assert listed(read(tmp_path, sdf(kind, more), "toy.sdf")) == {
        "terms": {"<xExotic>"}, "environment": {"<default_current>"}, "actuators": {"Thruster of no joint"}, "masses": {"mast"},
    }  # fmt: skip


def test_a_model_that_a_world_includes(tmp_path: Path) -> None:
    """As gz-sim's own auv_controls.sdf: the plugin stands in the world, the vehicle in a model of elsewhere."""
    kind = ("gz-sim-hydrodynamics-system", "gz::sim::systems::Hydrodynamics")
    include = "<include><uri>https://fuel.gazebosim.org/1.0/a/models/MBARI%20Tethys%20LRAUV</uri></include>"
    text = sdf(kind, "")
    file = read(tmp_path, text.replace("</model>", f"{include}</model>", 1), "toy.sdf")
    assert listed(file)["includes"] == {"MBARI%20Tethys%20LRAUV"}


def test_a_urdf_of_uuv_simulator(tmp_path: Path) -> None:
    text = (DATA / "rexrov.urdf").read_text(encoding="utf-8")
    more = "<scaling_damping>2</scaling_damping><type>fossen</type>"
    assert "<type>fossen</type>" in text
    file = read(tmp_path, text.replace("<type>fossen</type>", more), "rexrov.urdf")
    assert listed(file)["terms"] == {"<scaling_damping>"}
    lauv = listed(read(tmp_path, (DATA / "lauv.urdf.xacro").read_text(encoding="utf-8"), "lauv.urdf.xacro"))
    assert "hydrostatics" not in lauv
    assert lauv["ignored"] >= {"<quadratic_damping> row 2 column 6"}


def test_macros_and_includes_of_xacro(tmp_path: Path) -> None:
    """As eca_a9_base.xacro has them: four fins and a thruster, of which nothing was said; sensors move nothing."""
    text = (DATA / "lauv.urdf.xacro").read_text(encoding="utf-8")
    calls = "".join(f'<xacro:fin_macro namespace="a" fin_id="{k}"/>' for k in range(4))
    calls += '<xacro:thruster_module_first_order_basic_fcn_macro namespace="a"/><xacro:imu_plugin_macro namespace="a"/>'
    calls += '<xacro:include filename="$(find lauv_description)/urdf/lauv_thrusters.xacro"/>'
    file = read(tmp_path, text.replace("</robot>", f"{calls}</robot>"), "more.urdf.xacro")
    assert listed(file)["macros"] == {"4 fin_macro", "thruster_module_first_order_basic_fcn_macro"}
    assert "lauv_thrusters.xacro" in listed(file)["includes"]
    assert [f.severity for f in file.findings if dict(f.facts).get("kind") == "macros"] == [Severity.WARN]


def test_parts_of_a_stonefish_robot_beside_a_mesh(tmp_path: Path) -> None:
    """Mass and volume are sums: where a mesh states neither, what the other parts state is left out as well, and named."""
    frame = '<compound_transform rpy="0 0 0" xyz="0 0 0"/>'
    text = f"""<scenario><robot name="auv"><base_link name="v" type="compound">
      <external_part name="Hull" type="model" physics="submerged" buoyant="true"><physical><mesh filename="h.obj"/></physical>{frame}</external_part>
      <internal_part name="Battery" type="cylinder" physics="submerged" buoyant="true"><dimensions radius="0.1" height="0.5"/>
      <mass value="70.0"/>{frame}</internal_part></base_link></robot></scenario>"""
    found = listed(read(tmp_path, text, "auv.scn"))
    assert found["inertia"] == {"mass of Hull", "70 kg of Battery"}
    assert found["hydrostatics"] == {"volume of Hull", "0.01571 m^3 of Battery"}


def test_an_xdyn_body(tmp_path: Path) -> None:
    text = (DATA / "bluerov2_heavy.yml").read_text(encoding="utf-8")
    more = "      - model: gravity\n      - model: Holtrop & Mennen\n      - model: maneuvering\n        name: rudder_like\n" + "".join(
        ["        reference frame: {frame: BlueROV2 Heavy, x: {value: 0, unit: m}, y: {value: 0, unit: m}, z: {value: 0, unit: m},",
         " phi: {value: 0, unit: rad}, theta: {value: 0, unit: rad}, psi: {value: 0, unit: rad}}\n        commands: [fan]\n"]
    ) + "".join(f"        {c}: {v}\n" for c, v in zip("XYZKMN", ("3*fan", "-2*v(t)*abs(v(t))", 0, 0, 0, "t*0"), strict=True))  # fmt: skip
    file = read(tmp_path, text.replace("      - model: gravity\n", more, 1), "rov.yml")
    assert listed(file) == {
        "hydrostatics": {"gravity"}, "forces": {"Holtrop & Mennen"}, "commands": {"fan"}, "time": {"N"},
    }  # fmt: skip


def _lrauv_force(nu: np.ndarray, coriolis: bool) -> np.ndarray:
    """X ... N of lrauv's plugin for steady velocities in the link's axes, written from its source and from nothing here."""
    u, v, w, p, q, r = nu
    added = (-4.0, -37.0, -38.0, -0.2, -7.0, -8.0)
    linear, square = (-1.5, -3.0, -3.5, -0.5, -6.0, -6.5), (-6.1, -210.0, -215.0, -0.3, -90.0, -95.0)
    force = np.array([(a + b * abs(x)) * x for a, b, x in zip(linear, square, nu, strict=True)])
    if coriolis:
        xu, yv, zw, kp, mq, nr = added
        matrix = np.zeros((6, 6))
        matrix[0, 4:] = -zw * w, -yv * v
        matrix[1, [3, 5]] = zw * w, -xu * u
        matrix[2, 3:5] = -yv * v, xu * u
        matrix[3, [1, 2, 4, 5]] = -zw * w, yv * v, -nr * r, mq * q
        matrix[4, [0, 2, 3, 5]] = zw * w, -xu * u, nr * r, -kp * p
        matrix[5, [0, 1, 3, 4]] = zw * w, xu * u, -mq * q, kp * p
        force = force + matrix @ nu
    return force


@pytest.mark.parametrize("coriolis", [True, False])
def test_lrauvs_plugin_by_its_own_law(coriolis: bool, tmp_path: Path) -> None:
    """Before: <yVV> -210 was Yvv v^2, +210 to port, and its Coriolis switch was not seen."""
    text = sdf(LRAUV, f"<enable_coriolis>{'true' if coriolis else 'false'}</enable_coriolis>")
    file = read(tmp_path, text, "toy.sdf")
    assert file.coefficient("Yvv") is None
    assert file.coefficient("Yv|v|").value_si == pytest.approx(-210.0)
    link, law = read_gz_link(parse_xml(text)), force_law(file)
    for nu in np.random.default_rng(5).normal(size=(20, 6)):
        expected = _lrauv_force(nu, coriolis)
        np.testing.assert_allclose(link.force(nu[None])[0], expected, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(law.force((nu * FLU)[None])[0] * FLU, expected, rtol=1e-9, atol=1e-9)
    codes = {f.code for f in file.findings}
    assert {"model.system", "model.ahead"} <= codes
    assert "model.defaults" not in codes


def test_tags_that_lrauvs_plugin_fills_itself(tmp_path: Path) -> None:
    file = read(tmp_path, sdf(LRAUV).replace("<kP>-0.5</kP>", "").replace("<kDotP>-0.2</kDotP>", ""), "toy.sdf")
    (filled,) = (f for f in file.findings if f.code == "model.defaults")
    assert filled["names"] == ("<kP> 20", "<kDotP> 0.1")
    assert file.coefficient("Kp").value_si == pytest.approx(20.0)


@pytest.mark.parametrize(
    "kind",
    [
        ("gz-waves1-hydrodynamics-system", "gz::sim::systems::Hydrodynamics"),
        ("gz-sim-hydrodynamics-system", "gz::sim::systems::HydrodynamicsOfMine"),
        ("HydrodynamicsPlugin", "other::HydrodynamicsPlugin"),
        ("libTritonHydrodynamicsPlugin.so", "triton"),
    ],
)
def test_other_plugins_are_refused(kind: tuple[str, str], tmp_path: Path) -> None:
    with pytest.raises(InputError, match="whose law is not known here") as caught:
        read(tmp_path, sdf(kind), "toy.sdf")
    assert "gz-sim, Ignition Gazebo 6 or lrauv" in caught.value.expected


@pytest.mark.parametrize(
    "kind",
    [
        ("libgz-sim8-hydrodynamics-system.so", "gz::sim::systems::Hydrodynamics"),
        ("ignition-gazebo6-hydrodynamics-system", "ignition::gazebo::systems::Hydrodynamics"),
        ("gz-sim-hydrodynamics-system", ""),
    ],
)
def test_spellings_of_gz_sims_own(kind: tuple[str, str], tmp_path: Path) -> None:
    assert read(tmp_path, sdf(kind), "toy.sdf").coefficient("Yvv") is not None


def test_prefixes_that_are_not_declared(tmp_path: Path) -> None:
    """SDFormat has no namespaces: `gz:type` stands without xmlns."""
    kind = ("gz-sim-hydrodynamics-system", "gz::sim::systems::Hydrodynamics")
    plain = sdf(kind)
    odd = plain.replace(
        "</model>", '<link name="s"><sensor type="custom" gz:type="x"/></link><experimental:params/></model>'
    )
    assert read(tmp_path, odd, "odd.sdf").coefficients == read(tmp_path, plain, "plain.sdf").coefficients
    with pytest.raises(InputError, match="mismatched"):
        parse_xml('<sdf><a gz:b="1"></sdf>')


def test_a_urdf_states_the_same_in_attributes(tmp_path: Path) -> None:
    kind = ("gz-sim-hydrodynamics-system", "gz::sim::systems::Hydrodynamics")
    plain = sdf(kind)
    plugin = plain[plain.index("<plugin") : plain.index("</plugin>") + 9]
    urdf = (
        '<robot name="toy"><link name="hull"><inertial><origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/><mass value="41"/>'
        '<inertia ixx="5" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="5.2"/></inertial></link><gazebo>'
        + plugin
        + "</gazebo></robot>"
    )
    turned, straight = read(tmp_path, urdf, "toy.urdf"), read(tmp_path, plain, "toy.sdf")
    assert turned.coefficients == straight.coefficients
    np.testing.assert_allclose(turned.mass.inertia_matrix, straight.mass.inertia_matrix, atol=1e-9)
    assert turned.name == "toy"


def test_finding_of_an_unknown_release_does_not_stop_the_check(tmp_path: Path) -> None:
    file = read(tmp_path, VESSEL, "vessel.m")
    path = tmp_path / "later.parameters.json"
    strange = Finding.of("model.of_another_day", "vessel", Severity.WARN)
    path.write_bytes(file.model_copy(update={"findings": (strange,)}).to_json())
    assert read_model_file(path).passed
