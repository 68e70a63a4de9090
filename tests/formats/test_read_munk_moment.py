"""A measured Nv or Mw beside a simulator's own C_A(nu) is found in every format that adds it; honest files raise nothing.

All models here are synthetic, made up for these tests.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.formats.gazebo import read as gazebo
from coeflab.formats.gazebo import write as gazebo_exporter
from coeflab.formats.gazebo_plugin import write as gazebo_plugin
from coeflab.formats.mss import read as mss
from coeflab.formats.mss import write as mss_exporter
from coeflab.formats.uuv_simulator import read as uuv_simulator
from coeflab.formats.uuv_simulator import write as uuv_exporter
from coeflab.study.study import Study
from tests.formats import of_second_order as second

DATA = Path(__file__).parent / "data"
UUV = """<robot name="synthetic"><link name="b"/><gazebo><plugin name="p" filename="f"><fluid_density>1025</fluid_density>
<link name="b"><hydrodynamic_model><type>fossen</type>
<added_mass>2 0 0 0 0 0  0 50 0 0 0 0  0 0 50 0 0 0  0 0 0 .1 0 0  0 0 0 0 9 0  0 0 0 0 0 9</added_mass>
<{tag}>-1 0 0 0 0 0  0 -20 0 0 0 0  0 0 -20 0 0 0  0 0 0 -.1 0 0  0 0 {mw} 0 -9 0  0 {nv} 0 0 0 -9</{tag}>
</hydrodynamic_model></link></plugin></gazebo></robot>"""
SDF = """<sdf version="1.10"><model name="synthetic"><link name="b"><inertial><mass>60</mass>{fluid}</inertial></link>
<plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics"><link_name>b</link_name>
{terms}<xUabsU>-2</xUabsU></plugin></model></sdf>"""
FLUID = "<fluid_added_mass><xx>2</xx><yy>50</yy><zz>50</zz><pp>.1</pp><qq>9</qq><rr>9</rr></fluid_added_mass>"
DOTS = "<xDotU>-2</xDotU><yDotV>-50</yDotV><zDotW>-50</zDotW><kDotP>-.1</kDotP><mDotQ>-9</mDotQ><nDotR>-9</nDotR>"
MSS = "rho = 1025; Xudot = -2; Yvdot = -50; Zwdot = -50; Mqdot = -9; Nrdot = -9; Yv = -20; {terms} CA = m2c(MA, nu);\n"


def about_munk(found: tuple[Check, ...]) -> list[Check]:
    return [c for c in found if "C_A" in c.statistic]


def written(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def test_uuv_simulator_names_row_and_column(tmp_path: Path) -> None:
    text = UUV.format(tag="linear_damping_forward_speed", nv=-41, mw=40)
    yaw, pitch = about_munk(uuv_simulator.examine(written(tmp_path, "m.urdf", text)))
    assert (yaw.severity, pitch.severity) == (Severity.FAIL, Severity.FAIL)
    assert yaw.subject == "<linear_damping_forward_speed> row 6 column 2"
    assert yaw.statistic == "N of -41 u v, beside -48 u v of the simulator's C_A(nu)"
    assert "total less that, here 7 u v" in yaw.comment
    assert pitch.subject == "<linear_damping_forward_speed> row 5 column 3"
    assert pitch.statistic == "M of 40 u w, beside 48 u w of the simulator's C_A(nu)"
    assert "total less that, here -8 u w" in pitch.comment


@pytest.mark.parametrize(("nv", "mw"), [(7, -7), (-20, 20), (-110, 110), (0, 0), (41, -41)])
def test_what_is_not_the_munk_moment(nv: float, mw: float, tmp_path: Path) -> None:
    """The viscous part has the other sign; a little or a great deal of the same sign is no total."""
    text = UUV.format(tag="linear_damping_forward_speed", nv=nv, mw=mw)
    assert about_munk(uuv_simulator.examine(written(tmp_path, "m.urdf", text))) == []


def test_linear_damping_is_told_with_the_speed_at_which_both_are_equal(tmp_path: Path) -> None:
    found = about_munk(
        uuv_simulator.examine(written(tmp_path, "m.urdf", UUV.format(tag="linear_damping", nv=-96, mw=9)))
    )
    assert [c.severity for c in found] == [Severity.WARN]
    assert found[0].subject == "<linear_damping> row 6 column 2"
    assert "-96 v, equal at 2 m/s" in found[0].statistic


def test_gz_sim_with_fluid_added_mass(tmp_path: Path) -> None:
    terms = "<nVabsU>-20</nVabsU><nUV>-21</nUV><mWabsU>40</mWabsU>"
    yaw, pitch = about_munk(gazebo.examine(written(tmp_path, "m.sdf", SDF.format(fluid=FLUID, terms=terms))))
    assert (yaw.subject, pitch.subject) == ("<nVabsU>, <nUV>", "<mWabsU>")
    assert yaw.statistic == "N of -41 u v, beside -48 u v of the simulator's C_A(nu)"
    assert "Munk moment twice" in yaw.comment


def test_gz_sims_plugin_has_the_reverse_sign(tmp_path: Path) -> None:
    terms = DOTS + "<nVabsU>-41</nVabsU>"
    (yaw,) = about_munk(gazebo.examine(written(tmp_path, "m.sdf", SDF.format(fluid="", terms=terms))))
    assert yaw.severity is Severity.FAIL
    assert "beside 48 u v" in yaw.statistic
    assert "cancel" in yaw.comment
    off = terms + "<disable_coriolis>true</disable_coriolis>"
    assert about_munk(gazebo.examine(written(tmp_path, "m.sdf", SDF.format(fluid="", terms=off)))) == []


def test_mss_where_the_file_computes_coriolis(tmp_path: Path) -> None:
    text = MSS.format(terms="Nuv = -41; Muw = 40;")
    yaw, pitch = about_munk(mss.examine(written(tmp_path, "m.m", text)))
    assert (yaw.subject, pitch.subject) == ("Nuv", "Muw")
    assert yaw.statistic == "N of -41 u v, beside -48 u v of the simulator's C_A(nu)"
    slow = about_munk(mss.examine(written(tmp_path, "m.m", MSS.format(terms="Nv = -96;"))))
    assert [(c.subject, c.severity) for c in slow] == [("Nv", Severity.WARN)]
    assert about_munk(mss.examine(written(tmp_path, "m.m", text.replace("CA = m2c(MA, nu);", "")))) == []
    zeroed = text + "CA(6,1) = 0; CA(6,2) = 0;\n"
    assert about_munk(mss.examine(written(tmp_path, "m.m", zeroed))) == []


def test_mss_primes_and_feet_are_compared_in_si(tmp_path: Path) -> None:
    primes = "rho = 1000; L = 2; r3 = rho*L^3/2; Xudot = -0.002; Yvdot = -0.03; Nv = -0.025; CA = m2c(MA, nu);"
    (yaw,) = about_munk(mss.examine(written(tmp_path, "m.m", primes)))
    assert yaw.severity is Severity.FAIL
    assert "N of -100 u v, beside -112 u v" in yaw.statistic
    torpedo = (DATA / "torpedo_imperial.m").read_text(encoding="utf-8") + "\nCA = m2c(MA, nu);\n"
    yaw, pitch = about_munk(mss.examine(written(tmp_path, "m.m", torpedo)))
    assert "N of -22.91 u v, beside -16.49 u v" in yaw.statistic
    assert "M of 22.91 u w, beside 14.16 u w" in pitch.statistic


def test_coriolis_added_to_our_own_totals(suboff: Study, tmp_path: Path) -> None:
    ((name, content),) = mss_exporter.render(suboff.parameter_files["suboff_fully_appended"]).items()
    path = written(tmp_path, name, content)
    assert about_munk(mss.examine(path)) == []
    path = written(tmp_path, name, content + b"\nCA = m2c(MA, nu);\n")
    assert [(c.subject, c.severity) for c in about_munk(mss.examine(path))] == [
        ("Nv", Severity.FAIL),
        ("Mw", Severity.FAIL),
    ]


@pytest.mark.parametrize("name", ["suboff_fully_appended", "suboff_bare_hull", "suboff_bare_hull_cfd"])
@pytest.mark.parametrize(
    ("exporter", "importer"),
    [(gazebo_exporter, gazebo), (gazebo_plugin, gazebo), (uuv_exporter, uuv_simulator), (mss_exporter, mss)],
    ids=["gazebo", "gazebo_plugin", "uuv_simulator", "mss"],
)
def test_our_exports_raise_nothing(
    name: str, exporter: object, importer: object, suboff: Study, tmp_path: Path
) -> None:
    for file in (suboff.parameter_files[name], second.golden(), second.bluerov2_heavy()):
        for written_as, content in exporter.render(file).items():
            assert about_munk(importer.examine(written(tmp_path, written_as, content))) == []


@pytest.mark.parametrize(
    ("name", "importer"),
    [("lauv.urdf.xacro", uuv_simulator), ("rexrov.urdf", uuv_simulator), ("tethys_like.sdf", gazebo), ("nps_auv2.m", mss),
     ("bluerov2_heavy.m", mss), ("torpedo_imperial.m", mss)],
)  # fmt: skip
def test_known_vehicles_raise_nothing(name: str, importer: object) -> None:
    assert about_munk(importer.examine(DATA / name)) == []
