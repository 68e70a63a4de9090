"""Thrusters and fins of Stonefish and uuv_simulator: thrust, torque, lag, lift against the laws of their sources, written here as there."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from coeflab.formats.model_files import ModelFile, read_model_file
from coeflab.vehicle.parameter_parts import ParameterThruster

RHO, D, MOST = 1025.0, 0.18, 120.0
SCENARIO = """<scenario><robot name="r"><base_link name="b" type="box" physics="submerged"><dimensions xyz="1 .5 .4"/><mass value="80"/></base_link>
<actuator name="t" type="thruster"><link name="{link}"/><specs max_setpoint="${{60*2}}" inverted_setpoint="{inverted}" normalized_setpoint="true"/>
<propeller diameter="0.18" right="{right}"/><origin xyz="-1 0.2 0" rpy="0 0 1.5707963267948966"/>
<rotor_dynamics type="{rotor}"><time_constant value="0.3"/></rotor_dynamics>{model}</actuator></robot></scenario>"""
MODELS = {
    "quadratic": '<thrust_model type="quadratic"><thrust_coeff value="0.004"/></thrust_model>',
    "deadband": '<thrust_model type="deadband"><thrust_coeff forward="0.005" reverse="0.003"/><deadband lower="-900" upper="400"/></thrust_model>',
    "linear_interpolation": '<thrust_model type="linear_interpolation"><input value="-100 -20 0 20 90"/><output value="-7 -1 0 2 10"/></thrust_model>',
    "fluid_dynamics": '<thrust_model type="fluid_dynamics"><thrust_coeff forward="0.5" reverse="0.3"/><torque_coeff value="0.02"/></thrust_model>',
}


def read(folder: Path, text: str) -> ModelFile:
    path = folder / ("m.scn" if "<scenario" in text else "m.urdf")
    path.write_text(text, encoding="utf-8")
    return read_model_file(path, RHO)


def scenario(folder: Path, model: str, rotor: str = "first_order", link: str = "b", inverted: str = "false", right: str = "true") -> ModelFile:  # fmt: skip
    return read(folder, SCENARIO.format(model=MODELS[model], rotor=rotor, link=link, inverted=inverted, right=right))


def by_stonefish(model: str, setpoint: float, inverted: bool, right: bool) -> tuple[float, float]:
    """Thrust along x and torque about it at rest: Thruster.cpp and ActuatorDynamics.h."""
    w = np.clip(setpoint, -MOST, MOST) * (-1.0 if inverted else 1.0)
    vv = w * abs(w)
    if model == "fluid_dynamics":
        backward = (right and w < 0.0) or (not right and w > 0.0)
        n = (-1.0 if backward else 1.0) * abs(w) / (2.0 * math.pi)
        thrust = RHO * D**3 * abs(n) * D * (0.3 if backward else 0.5) * n
        return thrust, (-1.0 if right else 1.0) * RHO * D**4 * abs(n) * D * 0.02 * n
    if model == "quadratic":
        thrust = 0.004 * vv
    elif model == "deadband":
        thrust = 0.003 * (vv + 900.0) if vv < -900.0 else 0.005 * (vv - 400.0) if vv > 400.0 else 0.0
    else:
        thrust = float(np.interp(w, [-100, -20, 0, 20, 90], [-7, -1, 0, 2, 10]))
    return (thrust if right else -thrust), 0.0


def about_y(t: ParameterThruster, command: float) -> tuple[float, float]:
    """Thrust along +y and torque about it."""
    assert t.direction[:1] + t.direction[2:] == pytest.approx((0.0, 0.0))
    torque = t.torque_curve.at(command) * t.handedness if t.torque_curve is not None else 0.0
    return t.curve.at(command) * t.direction[1], torque * t.direction[1]


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("right", ["true", "false"])
@pytest.mark.parametrize("inverted", ["false", "true"])
def test_stonefish(tmp_path: Path, model: str, right: str, inverted: str) -> None:
    (t,) = scenario(tmp_path, model, inverted=inverted, right=right).parameters.thrusters
    assert (t.lag, t.position, t.curve.unit) == (0.3, (-1.0, 0.2, 0.0), "rad/s")
    for c in (-200.0, -75.0, -25.0, -10.0, 0.0, 15.0, 21.0, 55.0, 300.0):
        due = by_stonefish(model, c, inverted == "true", right == "true")
        assert about_y(t, c) == pytest.approx(due, abs=1e-9)


def test_what_is_left_out_of_stonefish_has_its_name(tmp_path: Path) -> None:
    assert scenario(tmp_path, "quadratic", "zero_order").parameters.thrusters[0].lag is None
    late = scenario(tmp_path, "fluid_dynamics", "mechanical_pi")
    assert late.parameters.thrusters[0].lag is None
    assert late.left_out["rotors"] == ["mechanical_pi of t"]
    assert [f["value"] for f in late.parameters.findings if f.code == "model.open_water"] == [0.5]
    for text in ({"rotor": "yoerger"}, {"link": "arm"}):
        other = scenario(tmp_path, "quadratic", **text)
        assert other.parameters.thrusters == ()
        assert other.left_out["actuators"] == ["thruster t"]


URDF = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="quarter" value="${{0.5*pi}}"/>
<link name="r/base"><inertial><mass value="80"/><origin xyz="0 0 -0.1"/><inertia ixx="2" ixy="0" ixz="0" iyy="9" iyz="0" izz="9"/></inertial></link>
<link name="r/mount"/><link name="r/t"><inertial><mass value="0.1"/><origin xyz="0.05 0 0"/></inertial></link>
<joint name="fixed" type="fixed"><parent link="r/base"/><child link="r/mount"/><origin xyz="-1 0.2 0.3" rpy="0 0 ${{quarter}}"/></joint>
<joint name="spins" type="continuous"><parent link="r/mount"/><child link="r/t"/><origin xyz="0.1 0 0" rpy="0 0 0"/><axis xyz="1 0 0"/></joint>
<gazebo><plugin name="uuv" filename="libuuv_underwater_object_ros_plugin.so"><fluid_density>1025</fluid_density><link name="r/base"><volume>0.078</volume>
<hydrodynamic_model><type>fossen</type><added_mass>5 0 0 0 0 0 0 60 0 0 0 0 0 0 60 0 0 0 0 0 0 0.2 0 0 0 0 0 0 5 0 0 0 0 0 0 5</added_mass>
<linear_damping>-3 -9 -9 -1 -9 -9</linear_damping></hydrodynamic_model></link></plugin>
<plugin name="main" filename="libuuv_thruster_ros_plugin.so"><linkName>r/t</linkName><jointName>spins</jointName><thrusterID>0</thrusterID>{tags}
<dynamics><type>{rotor}</type><timeConstant>0.2</timeConstant></dynamics><conversion>{law}</conversion></plugin></gazebo></robot>"""
LAWS = {
    "Basic": "<type>Basic</type><rotorConstant>0.004</rotorConstant>",
    "falling": "<type>Basic</type><rotorConstant>-0.004</rotorConstant>",
    "Bessa": "<type>Bessa</type><rotorConstantL>0.003</rotorConstantL><rotorConstantR>0.005</rotorConstantR><deltaL>-900</deltaL><deltaR>400</deltaR>",
    "LinearInterp": "<type>LinearInterp</type><inputValues>-100 -20 0 20 90</inputValues><outputValues>-7 -1 0 2 10</outputValues>",
}
TAGS = {
    "plain": {}, "clamped": {"clampMin": -60.0, "clampMax": 40.0}, "limited": {"thrustMin": -2.5, "thrustMax": 4.0},
    "geared": {"gain": -2.0, "thrust_efficiency": 0.9, "propeller_efficiency": 0.8, "clampMax": 30.0, "clampMin": -50.0, "thrustMax": 6.0, "thrustMin": -3.0},
    "disordered": {"clampMin": 5.0, "clampMax": 4.0, "thrust_efficiency": 3.0},
}  # fmt: skip


def urdf(folder: Path, law: str, tags: dict[str, float], rotor: str = "FirstOrder") -> ModelFile:
    written = "".join(f"<{k}>{v}</{k}>" for k, v in tags.items())
    return read(folder, URDF.format(law=LAWS[law], tags=written, rotor=rotor))


def by_uuv(law: str, tags: dict[str, float], command: float) -> float:
    """ThrusterPlugin.cc, Update, long after the command."""
    low, least = (tags.get(f"{k}Min", -1e9) for k in ("clamp", "thrust"))
    high, most = (tags.get(f"{k}Max", 1e9) for k in ("clamp", "thrust"))
    low, high = (low, high) if low < high else (-1e9, 1e9)
    share = [e if 0.0 <= (e := tags.get(f"{k}_efficiency", 1.0)) <= 1.0 else 1.0 for k in ("thrust", "propeller")]
    n = share[1] * tags.get("gain", 1.0) * min(max(command, low), high)
    basic = n * abs(n)
    match law:
        case "Bessa":
            thrust = 0.003 * (basic + 900.0) if basic <= -900.0 else 0.005 * (basic - 400.0) if basic >= 400.0 else 0.0
        case "LinearInterp":
            thrust = float(np.interp(n, [-100, -20, 0, 20, 90], [-7, -1, 0, 2, 10]))
        case _:
            thrust = (0.004 if law == "Basic" else -0.004) * basic
    return min(max(share[0] * thrust, least), most)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("tags", TAGS)
def test_uuv_simulator(tmp_path: Path, law: str, tags: str) -> None:
    file = urdf(tmp_path, law, TAGS[tags]).parameters
    (t,) = file.thrusters
    assert t.lag == 0.2
    assert t.position == pytest.approx((-1.0, -0.35, -0.3))  # FLU: (-1, 0.2 + 0.1 + 0.05, 0.3)
    for c in (-200.0, -55.0, -31.0, -20.0, -7.0, 0.0, 8.0, 22.0, 35.0, 90.0):
        assert t.curve.at(c) * t.direction[1] == pytest.approx(-by_uuv(law, TAGS[tags], c), abs=1e-9)
    free = [f for f in file.findings if f.code == "model.no_limit"]
    assert len(free) == (law in ("Basic", "falling", "Bessa") and tags in ("plain", "disordered"))


def test_what_is_left_out_of_uuv_simulator_has_its_name(tmp_path: Path) -> None:
    assert urdf(tmp_path, "Basic", {}, "ZeroOrder").parameters.thrusters[0].lag is None
    other = urdf(tmp_path, "Basic", {}, "Yoerger")
    assert other.parameters.thrusters == ()
    assert other.left_out["actuators"] == ["Thruster main"]


FIN = """<joint name="{n}j" type="revolute"><limit lower="-0.5" upper="0.5" velocity="0"/><origin xyz="{at}" rpy="{rpy}"/><axis xyz="0 0 1"/>
<parent link="r/base"/><child link="{n}"/></joint><link name="{n}"><inertial><mass value="0.001"/></inertial></link>
<gazebo><plugin name="{n}p" filename="libuuv_fin_ros_plugin.so"><dynamics><type>FirstOrder</type><timeConstant>0.2</timeConstant></dynamics>
<liftdrag>{law}</liftdrag><link_name>{n}</link_name><joint_name>{n}j</joint_name></plugin></gazebo>"""
LIFTS = {
    "<type>Quadratic</type><lift_constant>9.8</lift_constant><drag_constant>6.5</drag_constant>": 9.8,
    "<type>TwoLines</type><area>0.02</area><fluid_density>1025</fluid_density><a0>0</a0><alpha_stall>0.3</alpha_stall><cla>2.5</cla>"
    "<cla_stall>0</cla_stall><cda>0.1</cda><cda_stall>0</cda_stall>": 0.5 * 1025.0 * 0.02 * 2.5,
}  # fmt: skip
TAIL = (("a", "-0.4 0 0.04", "0 0 0"), ("b", "-0.4 -0.04 0", "${0.5*pi} 0 0"), ("c", "-0.4 0 -0.04", "${pi} 0 0"), ("d", "-0.4 0.04 0", "-${0.5*pi} 0 0"))  # fmt: skip


@pytest.mark.parametrize("law", LIFTS)
def test_fins_of_uuv_simulator(tmp_path: Path, law: str) -> None:
    """A cross of fins .4 m aft, by hand: k = dL/d(angle) / U^2 of each; two turn about z, two about y."""
    k = LIFTS[law]
    fins = "".join(FIN.format(n=n, at=at, rpy=rpy, law=law) for n, at, rpy in TAIL)
    text = URDF.format(law=LAWS["Basic"], tags="", rotor="ZeroOrder").replace("</robot>", fins + "</robot>")
    found = read(tmp_path, text)
    p = found.parameters
    hand = {
        "Ydr": 2.0 * k,
        "Ndr": -0.8 * k,
        "Zds": -2.0 * k,
        "Mds": -0.8 * k,
        "Nv": 0.8 * k - 55.0,  # and the ideal fluid's (5 - 60) kg
        "Yr": 0.8 * k - 5.0,
        "Mw": -0.8 * k + 55.0,
    }
    for symbol, due in hand.items():
        c = p.coefficient(symbol) or p.coefficient(f"{symbol}|u|")
        assert c.value * p.scaling.unit(c.symbol, RHO) == pytest.approx(due, rel=1e-5), symbol
    assert {s.control: (s.limit, s.rate) for s in p.surfaces} == {"dr": (0.5, None), "ds": (0.5, None)}
    assert found.left_out["late_fins"] == [f"0.2 s of {n}p" for n, _, _ in TAIL]
    assert "joints" not in found.left_out
    silent = text.replace(
        "0.2</timeConstant></dynamics>\n<liftdrag>", "${later}</timeConstant></dynamics>\n<liftdrag>", 1
    )
    assert read(tmp_path, silent).left_out["actuators"] == ["Fin ap"]
    other = read(tmp_path, text.replace("<type>Quad", "<type>Other").replace("<type>Two", "<type>Other"))
    assert other.left_out["actuators"] == [f"Fin {n}p" for n, _, _ in TAIL]
