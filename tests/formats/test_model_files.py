"""The same fault in any format is the same finding and the same exit code. All models here are synthetic."""

from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.formats.model_files import read_model_file
from coeflab.formats.mss import write as mss_exporter
from tests.formats import of_second_order as second

DATA = Path(__file__).parents[1] / "formats" / "data"
LAUV = (DATA / "lauv.urdf.xacro").read_text(encoding="utf-8")
GLIDER = (DATA / "tethys_like.sdf").read_text(encoding="utf-8")
BLUEROV = (DATA / "bluerov2_heavy.yml").read_text(encoding="utf-8")
BLUEROV_M = (DATA / "bluerov2_heavy.m").read_text(encoding="utf-8")
KNOWN = ["lauv.urdf.xacro", "rexrov.urdf", "tethys_like.sdf", "nps_auv2.m", "bluerov2_heavy.m", "bluerov2_heavy.yml",
         "torpedo_imperial.m"]  # fmt: skip
# The made-up glider's numbers: the plugin's reversed C_A makes dN/dv +81 where an ideal fluid has -121, and dY/dr +5 for -5,
# beside a side force of 2 N/(m/s), whose lever would then be 100 m; see the test of what goes with it.
# The cross-flow strips of nps_auv2.m are left out, and the file says so.
# Healey and Lienard print Mvp' with the sign of Yrdot'; by Kirchhoff's equations it is -Yrdot'.
FORMAT = {"<quadratic_damping>", "<disable_coriolis>"}
WELL_KNOWN = {"rexrov.urdf": set(), "lauv.urdf.xacro": {"<quadratic_damping>"},
              "tethys_like.sdf": {"<disable_coriolis>", "Nv'", "Yur'"},
              "nps_auv2.m": {"Mvp'", "nps_auv2"}}  # fmt: skip


def found(folder: Path, text: str, name: str = "model.txt") -> list[Check]:
    """What is worse than a note."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return [c for c in read_model_file(path).findings if c.severity in (Severity.WARN, Severity.FAIL)]


def only(folder: Path, text: str, severity: Severity) -> Check:
    (check,) = (c for c in found(folder, text) if c.severity is severity and c.subject not in FORMAT)
    return check


@pytest.mark.parametrize("name", KNOWN)
def test_known_vehicles_raise_no_other_finding(name: str, tmp_path: Path) -> None:
    told = {c.subject for c in found(tmp_path, (DATA / name).read_text(encoding="utf-8"), name)}
    assert told == WELL_KNOWN.get(name, set())


def test_what_the_reversed_coriolis_of_a_glider_does_goes_with_it(tmp_path: Path) -> None:
    off = GLIDER.replace("<yDotV>", "<disable_coriolis>true</disable_coriolis><yDotV>")
    assert {c.subject for c in found(tmp_path, off)} == {"Nv'"}
    assert found(tmp_path, off.replace("<nVabsU>-40</nVabsU>", "")) == []


FLIPPED = {
    "uuv_simulator": (LAUV.replace("0 16 0 0 0 0", "0 -16 0 0 0 0"), "Yv"),
    "gazebo": (GLIDER.replace("<yDotV>-126", "<yDotV>126"), "Yv"),
    "xdyn": (BLUEROV.replace("[0, 7.12, 0,", "[0, -7.12, 0,"), "Yv"),
    "mss": (BLUEROV_M.replace("Yvdot = -7.12", "Yvdot = 7.12"), "Yv"),
}


@pytest.mark.parametrize("kind", FLIPPED)
def test_a_flipped_added_mass(kind: str, tmp_path: Path) -> None:
    text, name = FLIPPED[kind]
    check = only(tmp_path, text, Severity.FAIL)
    assert check.subject == f"M_A {name}"
    assert f"{'gz-sim' if kind == 'gazebo' else kind.upper() if kind == 'mss' else kind} takes" in check.comment


def test_a_flipped_added_mass_in_our_own_mss_export(tmp_path: Path) -> None:
    ((name, content),) = mss_exporter.render(second.bluerov2_heavy()).items()
    text = content.decode()
    assert found(tmp_path, text, name) == []
    flipped = text.replace("h.Yvdot = -", "h.Yvdot = ")
    assert flipped != text
    assert [c.subject for c in found(tmp_path, flipped, name) if c.severity is Severity.FAIL] == ["M_A Yv"]


DRIVING = {
    "uuv_simulator": (LAUV.replace("0 -23 0 0 0 11.5", "0 23 0 0 0 11.5"), "Yv'"),
    "gazebo": (GLIDER.replace("<zWabsW>-600", "<zWabsW>600"), "Zw|w|'"),
    "xdyn": (BLUEROV.replace("[0, 0, 33,", "[0, 0, -33,"), "Zw'"),
    "mss": (BLUEROV_M.replace("Zw    = -33.0", "Zw = 33"), "Zw'"),
}


@pytest.mark.parametrize("kind", DRIVING)
def test_damping_of_the_wrong_sign(kind: str, tmp_path: Path) -> None:
    text, name = DRIVING[kind]
    check = only(tmp_path, text, Severity.FAIL)
    assert check.subject == name
    assert "It drives the motion" in check.comment
    assert "takes" in check.comment


def test_all_damping_negative_in_xdyn_is_one_finding(tmp_path: Path) -> None:
    """The sign of Gazebo, in a format whose matrices are positive."""
    head, tail = BLUEROV.split("external forces")
    for value in ("13.7", "33", "8e-1", "141", "217", "190", "1.19", "0.47", "1.5"):
        tail = tail.replace(f" {value}", f" -{value}").replace(f"[{value}", f"[-{value}")
    check = only(tmp_path, head + "external forces" + tail, Severity.FAIL)
    assert check.subject.count(",") == 8
    assert "They drive the motions" in check.comment
    assert "xdyn takes the added mass and both damping matrices positive" in check.comment


def test_drag_without_added_mass(tmp_path: Path) -> None:
    alone = GLIDER
    for tag in ("xDotU", "yDotV", "zDotW", "mDotQ", "nDotR"):
        alone = alone.replace(f"<{tag}>", f"<{tag}>0</{tag}><!--").replace(f"</{tag}>\n", "-->\n")
    assert only(tmp_path, alone, Severity.WARN).subject == "added mass"
    sway = LAUV.replace("0 16 0 0 0 0", "0 0 0 0 0 0")
    check = only(tmp_path, sway, Severity.WARN)
    assert (check.subject, check.statistic) == ("M_A Yv", "0")


def test_a_matrix_that_is_no_kinetic_energy(tmp_path: Path) -> None:
    text = LAUV.replace("0 16 0 0 0 0", "0 16 0 0 0 9").replace("0 0 0 0 0 1.3", "0 9 0 0 0 1.3")
    check = only(tmp_path, text, Severity.FAIL)
    assert check.subject == "M_A"
    assert "No kinetic energy" in check.comment


def test_asymmetry_that_is_no_slip(tmp_path: Path) -> None:
    check = only(tmp_path, LAUV.replace("0 16 0 0 0 0", "0 16 0 0 0 2"), Severity.FAIL)
    assert (check.subject, check.statistic) == ("M_A Yr and Nv", "2 and 0")


def test_yaw_damping_per_degree(tmp_path: Path) -> None:
    """9.7 N m s/rad and 9.1 N m s^2/rad^2 of the LAUV, per degree."""
    text = LAUV.replace("0 -3.1 0 0 0 -9.7", "0 -3.1 0 0 0 -0.1693").replace(
        "0 -1.5 0 0 0 -9.1", "0 -1.5 0 0 0 -0.00277"
    )
    told = {c.subject: c.comment for c in found(tmp_path, text) if c.subject not in FORMAT}
    assert set(told) == {"Nr'", "Nr|r|'"}
    assert all("Rates are in rad/s" in c for c in told.values())


def test_planes_of_different_axes(tmp_path: Path) -> None:
    text = LAUV.replace("0 0 3.1 0 -9.7 0", "0 0 -3.1 0 -9.7 0").replace("0 0 -23 0 -11.5 0", "0 0 -23 0 11.5 0")
    pair, place = (c for c in found(tmp_path, text) if c.subject not in FORMAT)
    assert (pair.subject, pair.severity) == ("Nv and Mw; Yr and Zq", Severity.WARN)
    assert pair.statistic == "-3.1 and -3.1; 11.5 and 11.5"
    assert (place.subject, place.severity) == ("Zq'", Severity.WARN)  # the plane that was turned, by its own signs
    assert place.rule == "aft of the centre, as that of drift"


def test_a_vehicle_upside_down(tmp_path: Path) -> None:
    check = only(tmp_path, LAUV.replace("0 0 0.01<", "0 0 -0.01<"), Severity.WARN)
    assert check.subject == "hydrostatics.centre_of_buoyancy"
    assert "z up" in check.comment
    check = only(tmp_path, BLUEROV_M + "zG = -0.02; zB = 0;", Severity.WARN)
    assert check.subject == "zG and zB"
    assert found(tmp_path, BLUEROV_M + "zG = 0.02; zB = 0;") == []


def test_a_model_without_density_is_read_in_every_format(tmp_path: Path) -> None:
    for text in (BLUEROV_M.replace("rho = 1000;", ""), GLIDER.replace("uniform_fluid_density", "something")):
        path = tmp_path / "model.txt"
        path.write_text(text, encoding="utf-8")
        notes = [
            c for c in read_model_file(path).findings if c.severity is Severity.NOTE and "no density" in c.statistic
        ]
        assert ["1000 kg/m^3 is assumed" in c.statistic for c in notes] == [True]
        assert read_model_file(path, 1020.0).parameters.conditions.density == 1020.0


@pytest.mark.parametrize("value", ["0", "-5"])
def test_a_density_that_is_none_is_an_error_in_every_format(value: str, tmp_path: Path) -> None:
    for text in (
        LAUV.replace('default="1028.0"', f'default="{value}"'), GLIDER.replace(">1025<", f">{value}<"),
        BLUEROV.replace("rho: {value: 1000", f"rho: {{value: {value}"), BLUEROV_M.replace("rho = 1000", f"rho = {value}"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=r"model\.txt: found .*above zero"):
            found(tmp_path, text)


def test_gravity_in_feet(tmp_path: Path) -> None:
    feet = BLUEROV.replace("g: {value: 9.81", "g: {value: 32.174")
    assert only(tmp_path, feet, Severity.FAIL).subject == "environmental constants: g"


def test_a_file_of_another_kind_is_not_taken_for_a_model(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="found a file that no importer knows"):
        found(tmp_path, "[vehicle]\nYv = -20.0\n[other]\nYv = -30.0\n")
