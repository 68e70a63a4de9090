"""Faults planted in two sound SDF files are found, none is in four sound files. All models are made up."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.formats.gazebo.joined import structure_checks
from coeflab.formats.model_files import read_model_file

TORPEDO = """<sdf version="1.9"><world name="w"><gravity>0 0 -9.8</gravity><model name="t"><link name="b"><inertial><pose>0 0 -0.012 0 0 0</pose><mass>31.4</mass>
<inertia><ixx>0.11</ixx><iyy>5.9</iyy><izz>5.9</izz></inertia></inertial>
<collision name="c"><pose>0 0 0 0 1.5707963 0</pose><geometry><cylinder><radius>0.076</radius><length>1.7</length></cylinder></geometry></collision></link>
<link name="prop"><pose>-0.9 0 0 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>0.0001</ixx><iyy>0.0001</iyy><izz>0.0001</izz></inertia></inertial></link>
<joint name="pj" type="revolute"><parent>b</parent><child>prop</child><axis><xyz>1 0 0</xyz></axis></joint>
<link name="fin"><pose>-0.75 0 0 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>0.0001</ixx><iyy>0.0001</iyy><izz>0.0001</izz></inertia></inertial></link>
<joint name="fj" type="revolute"><parent>b</parent><child>fin</child><axis><xyz>0 0 1</xyz><limit><lower>-0.3</lower><upper>0.3</upper></limit></axis></joint>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster"><joint_name>pj</joint_name><thrust_coefficient>0.0046</thrust_coefficient>
<fluid_density>1025</fluid_density><propeller_diameter>0.16</propeller_diameter><max_thrust_cmd>40</max_thrust_cmd><min_thrust_cmd>-30</min_thrust_cmd><deadband>0.5</deadband></plugin>
<plugin filename="gz-sim-lift-drag-system" name="gz::sim::systems::LiftDrag"><link_name>fin</link_name><air_density>1025</air_density><cla>3.6</cla><cda>0.0</cda>
<area>0.011</area><forward>1 0 0</forward><upward>0 1 0</upward></plugin>
<plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics"><link_name>b</link_name><disable_coriolis>true</disable_coriolis>
<uniform_fluid_density>1025</uniform_fluid_density>
<xDotU>-1.1</xDotU><yDotV>-30.0</yDotV><zDotW>-30.0</zDotW><kDotP>-0.02</kDotP><mDotQ>-5.6</mDotQ><nDotR>-5.6</nDotR>
<xUabsU>-1.6</xUabsU><yVabsV>-96</yVabsV><zWabsW>-96</zWabsW><kPabsP>-0.1</kPabsP><mQabsQ>-61</mQabsQ><nRabsR>-61</nRabsR>
<yVabsU>-22</yVabsU><nVabsU>-13</nVabsU><zWabsU>-22</zWabsU><mWabsU>13</mWabsU><yRabsU>4.6</yRabsU><nRabsU>-2.4</nRabsU><zQabsU>-4.6</zQabsU><mQabsU>-2.4</mQabsU></plugin></model></world></sdf>"""
AUV = """<sdf version="1.10"><world name="w"><gravity>0 0 -9.81</gravity>
<plugin filename="gz-sim-buoyancy-system" name="gz::sim::systems::Buoyancy"><uniform_fluid_density>1026</uniform_fluid_density></plugin>
<model name="auv"><link name="hull"><inertial><pose>0.03 0 -0.018 0 0 0</pose><mass>71.2</mass>
<inertia><ixx>0.42</ixx><iyy>21.5</iyy><izz>21.6</izz></inertia></inertial>
<collision name="c"><pose>0.03 0 0 0 1.5707963 0</pose><geometry><cylinder><radius>0.1</radius><length>2.21</length></cylinder></geometry></collision></link>
<link name="screw"><pose>-1.15 0 0 0 0 0</pose><inertial><mass>0.2</mass><inertia><ixx>0.0004</ixx><iyy>0.0003</iyy><izz>0.0003</izz></inertia></inertial></link>
<joint name="shaft" type="revolute"><parent>hull</parent><child>screw</child><axis><xyz>1 0 0</xyz></axis></joint>
<link name="rudder"><pose>-0.98 0 0 0 0 0</pose><inertial><mass>0.2</mass><inertia><ixx>0.0004</ixx><iyy>0.0004</iyy><izz>0.0004</izz></inertia></inertial></link>
<joint name="stock" type="revolute"><parent>hull</parent><child>rudder</child><axis><xyz>0 0 1</xyz><limit><lower>-0.35</lower><upper>0.35</upper></limit></axis></joint>
<link name="planes"><pose>-0.98 0 0 0 0 0</pose><inertial><mass>0.2</mass><inertia><ixx>0.0004</ixx><iyy>0.0004</iyy><izz>0.0004</izz></inertia></inertial></link>
<joint name="hinge" type="revolute"><parent>hull</parent><child>planes</child><axis><xyz>0 1 0</xyz><limit><lower>-0.35</lower><upper>0.35</upper></limit></axis></joint>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster"><joint_name>shaft</joint_name><thrust_coefficient>0.006</thrust_coefficient>
<fluid_density>1026</fluid_density><propeller_diameter>0.19</propeller_diameter><use_angvel_cmd>true</use_angvel_cmd><max_thrust_cmd>90</max_thrust_cmd><min_thrust_cmd>-90</min_thrust_cmd></plugin>
<plugin filename="gz-sim-lift-drag-system" name="gz::sim::systems::LiftDrag"><link_name>rudder</link_name><air_density>1026</air_density><cla>3.9</cla><cda>0.1</cda><alpha_stall>0.4</alpha_stall>
<area>0.021</area><forward>1 0 0</forward><upward>0 1 0</upward><cp>0 0 0</cp></plugin>
<plugin filename="gz-sim-lift-drag-system" name="gz::sim::systems::LiftDrag"><link_name>planes</link_name><air_density>1026</air_density><cla>3.9</cla><cda>0.1</cda><alpha_stall>0.4</alpha_stall>
<area>0.021</area><forward>1 0 0</forward><upward>0 0 1</upward><cp>0 0 0</cp></plugin>
<plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics"><link_name>hull</link_name><disable_coriolis>true</disable_coriolis>
<xDotU>-2.4</xDotU><yDotV>-69</yDotV><zDotW>-69</zDotW><kDotP>-0.05</kDotP><mDotQ>-24</mDotQ><nDotR>-24</nDotR>
<xUabsU>-4.1</xUabsU><yVabsV>-210</yVabsV><zWabsW>-210</zWabsW><kPabsP>-0.3</kPabsP><mQabsQ>-190</mQabsQ><nRabsR>-190</nRabsR>
<yVabsU>-45</yVabsU><nVabsU>-35</nVabsU><zWabsU>-45</zWabsU><mWabsU>35</mWabsU><yRabsU>9.5</yRabsU><nRabsU>-8.4</nRabsU><zQabsU>-9.5</zQabsU><mQabsU>-8.4</mQabsU></plugin></model></world></sdf>"""
ROV = """<?xml version="1.0"?><robot name="rov"><link name="base_link"><inertial><origin xyz="0 0 -0.02"/><mass value="17.3"/>
<inertia ixx="0.31" ixy="0" ixz="0" iyy="0.42" iyz="0" izz="0.55"/></inertial>
<collision><origin xyz="0 0 0.01"/><geometry><box size="0.4 0.3 0.146"/></geometry></collision></link>
<gazebo><plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics"><link_name>base_link</link_name><disable_coriolis>true</disable_coriolis>
<xDotU>-6.1</xDotU><yDotV>-11.2</yDotV><zDotW>-13.9</zDotW><kDotP>-0.14</kDotP><mDotQ>-0.17</mDotQ><nDotR>-0.19</nDotR>
<xUabsU>-21</xUabsU><yVabsV>-37</yVabsV><zWabsW>-58</zWabsW><kPabsP>-1.1</kPabsP><mQabsQ>-1.3</mQabsQ><nRabsR>-1.7</nRabsR></plugin></gazebo></robot>"""
SOUND = {
    "torpedo": TORPEDO,
    "rov": ROV,
    "auv": AUV,
    "rounded": TORPEDO.replace("<yDotV>-30.0", "<yDotR>0.201</yDotR><nDotV>0.2012</nDotV><yDotV>-30.0"),
}
# What is changed, and what the finding must name.
FAULTS = {
    "mass in pounds": (("<mass>31.4", "<mass>69.2"), "<mass>|volume|mass"),
    "mass in grams": (("<mass>31.4", "<mass>31400"), "<mass>|volume|mass"),
    "length in inches": (("<length>1.7", "<length>66.9"), "collision|volume"),
    "radius in mm": (("<radius>0.076", "<radius>76"), "collision|volume"),
    "length in feet": (("<length>1.7", "<length>5.58"), "collision|volume"),
    "inertia in g m^2": (("<iyy>5.9", "<iyy>5900"), "inertia|Iy"),
    "inertia in lb ft^2": (("<iyy>5.9</iyy><izz>5.9", "<iyy>140.0</iyy><izz>140.0"), "Iy"),
    "triangle": (("<ixx>0.11", "<ixx>13.0"), "inertia"),
    "centre of gravity above": (("0 0 -0.012", "0 0 0.012"), "centre_of_buoyancy|turns over"),
    "pose in degrees": (("0 0 0 0 1.5707963 0", "0 0 0 0 90 0"), "<pose>"),
    "limits in degrees": (("<lower>-0.3</lower><upper>0.3", "<lower>-17</lower><upper>17"), "limit"),
    "added mass in grams": (("<yDotV>-30.0", "<yDotV>-30000"), "Yv|M_A"),
    "added mass over ten": (("<yDotV>-30.0</yDotV><zDotW>-30.0", "<yDotV>-3.0</yDotV><zDotW>-3.0"), "Yv"),
    "damping with a plus": (("<nRabsR>-61", "<nRabsR>61"), "Nr"),
    "density in g/cm^3": (("<uniform_fluid_density>1025", "<uniform_fluid_density>1.025"), "density"),
    "gravity in feet": (("0 0 -9.8<", "0 0 -32.17<"), "gravity"),
    "Munk moment of the other sign": (("<nVabsU>-13", "<nVabsU>13"), "Nv"),
    "rates in degrees": (("<nRabsR>-61", "<nRabsR>-0.0186"), "Nr"),
    "Coriolis on": (("<disable_coriolis>true", "<disable_coriolis>false"), "disable_coriolis"),
}  # fmt: skip

SCREW = AUV[AUV.index('<plugin filename="gz-sim-thruster') : AUV.index('<plugin filename="gz-sim-lift')]
RUDDER = (
    AUV[AUV.index('<plugin filename="gz-sim-lift') : AUV.index('<plugin filename="gz-sim-hydro')].partition(
        "</plugin>"
    )[0]
    + "</plugin>"
)
OTHERS = {
    "centres from two points": (("<pose>0.03 0 -0.018", "<pose>0.43 0 -0.018"), "^auv$"),
    "screw in mm": (("<propeller_diameter>0.19", "<propeller_diameter>190"), "^thruster of shaft$"),
    "screw in inches": (("<propeller_diameter>0.19", "<propeller_diameter>7.5"), "^thruster of shaft$"),
    "K_T per square of 1/s": (("<thrust_coefficient>0.006", "<thrust_coefficient>0.24"), "^thruster of shaft$"),
    "screw in g/cm^3": (("<fluid_density>1026", "<fluid_density>1.026"), "^<fluid_density> of"),
    "thruster twice": ((SCREW, SCREW + SCREW), "^thruster of shaft$"),
    "fin twice": ((RUDDER, RUDDER + RUDDER), "^lift-drag of rudder$"),
    "fin in air": (("<air_density>1026</air_density>", ""), "^<air_density> of lift-drag of rudder"),
    "lift per degree": (("<cla>3.9", "<cla>0.068"), "^lift-drag of rudder$"),
    "fin in square inches": (("<area>0.021", "<area>32.5"), "^Ydr'$"),
    "shaft in cm": (('"screw"><pose>-1.15', '"screw"><pose>-115'), "shaft"),
    "limits of a joint exchanged": (("<lower>-0.35</lower><upper>0.35", "<lower>0.35</lower><upper>-0.35"), "^joint stock$"),
    "limits of a thruster exchanged": (("cmd>90</max_thrust_cmd><min_thrust_cmd>-90", "cmd>-90</max_thrust_cmd><min_thrust_cmd>90"), "^thruster of shaft$"),
    "gravity up": (("0 0 -9.81", "0 0 9.81"), "^<gravity>$"),
    "triangle in one link": (("<ixx>0.42", "<ixx>44"), "^hull$"),
    "drag in lb and feet": (("<xUabsU>-4.1", "<xUabsU>-0.086"), "^Xu"),
    "drag in mm": (("<xUabsU>-4.1", "<xUabsU>-4100"), "^Xu"),
    "link of another name": (("<link_name>hull", "<link_name>base_link"), "^base_link$"),
    "a link twice": (('<link name="planes">', '<link name="rudder">'), "^link rudder$"),
    "a joint twice": (('<joint name="hinge"', '<joint name="stock"'), "^joint stock$"),
    "a joint of no link": (("<child>rudder", "<child>ruder"), "^joint stock$"),
    "a joint of itself": (("<child>rudder", "<child>hull"), "^joint stock$"),
    "joints in a circle": (("<parent>hull</parent><child>screw", "<parent>screw</parent><child>hull</child></joint><joint name='back' type='fixed'><parent>hull</parent><child>screw"), "^joint back$"),
    "thruster of no joint": (("<joint_name>shaft", "<joint_name>propeller"), "^Thruster$"),
    "fin of no link": (("<link_name>rudder", "<link_name>rudders"), "^LiftDrag$"),
    "axis of length zero": (("<xyz>1 0 0", "<xyz>0 0 0"), "^<axis>$"),
    "pose in no frame": (('"screw"><pose>', '"screw"><pose relative_to="tail">'), "^pose screw$"),
    "poses in a circle": (('"screw"><pose>', '"screw"><pose relative_to="screw">'), "^pose screw$"),
    "static": (('<model name="auv">', '<model name="auv"><static>true</static>'), "^<static>$"),
    "stall in degrees": (("<alpha_stall>0.4", "<alpha_stall>23"), "^lift-drag of rudder$"),
}  # fmt: skip


def wrong(folder: Path, text: str) -> list[str]:
    path = folder / ("model.urdf" if "<robot" in text else "model.sdf")
    path.write_text(text, encoding="utf-8")
    found = read_model_file(path, 1025.0).findings
    return [f"{c.subject} {c.statistic} {c.comment}" for c in found if c.severity in (Severity.WARN, Severity.FAIL)]


@pytest.mark.parametrize("name", SOUND)
def test_none_in_a_sound_file(name: str, tmp_path: Path) -> None:
    assert wrong(tmp_path, SOUND[name]) == []


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_found(fault: str, tmp_path: Path) -> None:
    (before, after), named = FAULTS[fault]
    assert before in TORPEDO
    found = wrong(tmp_path, TORPEDO.replace(before, after, 1))
    assert any(re.search(named, line) for line in found), found


@pytest.mark.parametrize("fault", OTHERS)
def test_a_fault_of_actuators_and_sizes_is_found(fault: str, tmp_path: Path) -> None:
    (before, after), subject = OTHERS[fault]
    path = tmp_path / "model.sdf"
    path.write_text(AUV.replace(before, after, 1), encoding="utf-8")
    bad = [c.subject for c in read_model_file(path).findings if c.severity in (Severity.WARN, Severity.FAIL)]
    assert before in AUV
    assert any(re.search(subject, s) for s in bad), bad


def test_a_plugin_of_all_links_is_refused_where_it_stands_twice(tmp_path: Path) -> None:
    path = tmp_path / "model.sdf"
    again = '<plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics"><link_name>hull</link_name></plugin>'
    path.write_text(AUV.replace("</model>", again + "</model>"), encoding="utf-8")
    with pytest.raises(InputError):
        read_model_file(path)


def test_what_a_torpedo_is_read_as(tmp_path: Path) -> None:
    """Thruster, fin, mass and volume by hand: dead band .5 N, Ydr = 1/2 rho A cla, Ndr = x Ydr, all links as one body."""
    path = tmp_path / "t.sdf"
    path.write_text(TORPEDO, encoding="utf-8")
    p = read_model_file(path).parameters
    assert p.mass.mass == pytest.approx(31.6)
    assert p.mass.centre == pytest.approx([(-0.1 * 0.9 - 0.1 * 0.75) / 31.6, 0.0, 31.4 * 0.012 / 31.6])
    assert p.hydrostatics.volume == pytest.approx(3.14159265 * 0.076**2 * 1.7)
    assert p.hydrostatics.gravity == 9.8
    (thruster,) = p.thrusters
    assert thruster.direction == (1.0, 0.0, 0.0)
    assert thruster.position == pytest.approx((-0.9, 0.0, 0.0))
    assert [thruster.curve.at(x) for x in (-50.0, 0.4, 10.0, 90.0)] == pytest.approx([-30.0, 0.0, 10.0, 40.0])
    (fin,) = p.surfaces
    assert (fin.control, fin.limit) == ("dr", 0.3)
    lift = 0.5 * 1025.0 * 0.011 * 3.6
    unit = 0.5 * 1025.0  # of a prime by 1 m
    assert p.coefficient("Ydr").value * unit == pytest.approx(lift, rel=1e-6)
    assert p.coefficient("Ndr").value * unit == pytest.approx(-0.75 * lift, rel=1e-6)
    assert p.coefficient("Yv").value * unit == pytest.approx(-22.0 - lift, rel=1e-6)
    assert p.coefficient("Yr").value * unit == pytest.approx(4.6 + 0.75 * lift, rel=1e-6)


def test_links_of_one_name_in_nested_models_are_no_loop() -> None:
    """An arm's base on a vehicle's base, and two models of a world with the same links joined the other way round."""
    plugin = '<plugin name="h"><link_name>base</link_name></plugin>'
    nested = f"""<sdf><model name="a"><link name="base"/><model name="arm"><link name="base"/></model>
    <joint name="j" type="fixed"><parent>base</parent><child>arm::base</child></joint>{plugin}</model></sdf>"""
    two = f"""<sdf><world name="w"><model name="a"><link name="base"/><link name="p"/><joint name="j" type="fixed"><parent>base</parent><child>p</child></joint>
    {plugin}</model><model name="b"><link name="base"/><link name="p"/><joint name="j" type="fixed"><parent>p</parent><child>base</child></joint></model></world></sdf>"""
    for text in (nested, two):
        root = ElementTree.fromstring(text)
        assert structure_checks(root, next(root.iter("plugin")), Path("m.sdf")) == []
    turned = ElementTree.fromstring(
        two.replace("<parent>base</parent><child>p</child>", "<parent>p</parent><child>p</child>", 1)
    )
    assert [c.subject for c in structure_checks(turned, next(turned.iter("plugin")), Path("m.sdf"))] == ["joint j"]
