"""Axes, signs, units, inertia and exclusions of CSV tables, against brute force."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.axes import ANGLE_SIGNS, FRAMES, Axes
from coeflab.core.errors import CoeflabError, InputError
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.tables.force_table import ForceTable
from tests.conftest import SECTIONS

Read = Callable[..., ForceTable]
FOOT, POUND_FORCE, KNOT = 0.3048, 4.4482216152605, 1852.0 / 3600.0
UNITS = [*["m/s"] * 3, *["rad/s"] * 3, *["N"] * 3, *["N*m"] * 3]
NAMES = [*MOTIONS, *COMPONENTS]
ARM = "contains_inertia = false"


def in_frame(name: str) -> str:
    return SECTIONS["axes"].replace('"FRD"', name if name.startswith("[") else f'"{name}"')


def as_csv(names: list[str], units: list[str], columns: np.ndarray) -> str:
    rows = [",".join(repr(float(x)) for x in row) for row in columns]
    return "\n".join([",".join(f"{n} [{u}]" for n, u in zip(names, units, strict=True)), *rows]) + "\n"


def same(a: ForceTable, b: ForceTable, rel: float = 1e-12) -> None:
    for ours, theirs in ((a.motion, b.motion), (a.forces, b.forces), (a.errors, b.errors), (a.controls, b.controls)):
        assert ours.keys() == theirs.keys()
        for name in ours:
            np.testing.assert_allclose(ours[name], theirs[name], rtol=rel, atol=1e-12, err_msg=name)
    np.testing.assert_allclose(a.speed, b.speed, rtol=rel)


@pytest.mark.parametrize("frame", ["FLU", "CFD", '["starboard", "aft", "down"]', '["down", "forward", "starboard"]'])
def test_axes_do_not_change_the_physics(read_table: Read, frame: str) -> None:
    rng = np.random.default_rng(7)
    physics = rng.normal(size=(5, 12))
    physics[:, 0] = 2.0 + rng.random(5)
    directions = FRAMES.get(frame) or tuple(eval(frame))
    basis = {"forward": 0, "aft": 0, "starboard": 1, "port": 1, "down": 2, "up": 2}
    own = np.empty_like(physics)
    for triple in range(4):
        for k, direction in enumerate(directions):
            sign = 1.0 if direction in ("forward", "starboard", "down") else -1.0
            own[:, 3 * triple + k] = sign * physics[:, 3 * triple + basis[direction]]
    frd = read_table(as_csv(NAMES, UNITS, physics), table=ARM)
    other = read_table(as_csv(NAMES, UNITS, own), axes=in_frame(frame), table=ARM)
    same(other, frd)
    np.testing.assert_allclose(np.column_stack([frd.motion[m] for m in MOTIONS]), physics[:, :6], rtol=1e-15)
    np.testing.assert_allclose(np.column_stack([frd.forces[c] for c in COMPONENTS]), physics[:, 6:], rtol=1e-15)
    assert other.notes == (f"axes turned from {Axes(directions).name} to FRD",)


@pytest.mark.parametrize("name", ["beta", "alpha"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_angle_signs(read_table: Read, name: str, sign: float) -> None:
    text = next(t for t, s in ANGLE_SIGNS[name].items() if s == sign)
    axes = f'frame = "FRD"\n{name} = "{text}"\ndatum = "nose"\nreference_point = [0, 0, 0]'
    table = read_table(f"{name} [deg],Y [N]\n30,1\n", axes=axes)
    velocity = {"beta": "v", "alpha": "w"}[name]
    assert table.motion[velocity][0] == pytest.approx(sign * 2.0 * 0.5)
    assert table.motion["u"][0] == pytest.approx(2.0 * np.sqrt(0.75))


def test_alpha_and_beta_together(read_table: Read) -> None:
    table = read_table("alpha [deg],beta [deg],Y [N]\n30,-60,1\n")
    alpha, beta = np.radians(30), np.radians(60)
    expected = (np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta))
    assert [table.motion[m][0] for m in "uvw"] == pytest.approx([2.0 * x for x in expected])
    assert np.arctan2(table.motion["w"], table.motion["u"])[0] == pytest.approx(alpha)


def test_angle_sign_stays_to_starboard_in_other_axes(read_table: Read) -> None:
    table = read_table("beta [deg],Y [N]\n30,1\n", axes=in_frame("FLU"))
    assert table.motion["v"][0] == pytest.approx(-1.0)
    assert table.forces["Y"][0] == -1.0


def test_half_model_doubles_and_refuses(read_table: Read) -> None:
    half = SECTIONS["campaign"] + "\nhalf_model = true"
    csv = "alpha [deg],X [N],Z [N],M [N*m],se_Z [N]\n2,-3,-4,5,0.25\n"
    table = read_table(csv, campaign=half)
    assert [float(table.forces[c][0]) for c in "XZM"] == [-6.0, -8.0, 10.0]
    assert table.errors["Z"][0] == 0.5
    for component, unit in (("Y", "N"), ("K", "N*m"), ("N", "N*m")):
        with pytest.raises(InputError, match=f"antisymmetric {component} on a half model.*whole model"):
            read_table(f"alpha [deg],{component} [{unit}]\n2,1\n", campaign=half)
    moving = {"v [m/s]": "v", "p [rad/s]": "p", "r [rad/s]": "r", "delta_r [deg]": "dr"}
    for header, name in moving.items():
        with pytest.raises(InputError, match=f"motion {name} on a half model"):
            read_table(f"{header},Z [N]\n0.1,1\n", campaign=half, table=ARM)
    assert read_table("v [m/s],q [rad/s],Z [N]\n0,0.1,1\n", campaign=half, table=ARM).forces["Z"][0] == 2.0


UPPER = SECTIONS["campaign"] + '\nsymmetry = ["up-down"]\nhalf_model = "upper"'


@pytest.mark.parametrize("half", ["upper", "lower"])
def test_half_of_a_body_cut_at_z_0_doubles_x_y_n(read_table: Read, half: str) -> None:
    csv = "v [m/s],r [rad/s],delta_r [deg],X [N],Y [N],N [N*m],se_Y [N]\n0.2,0.1,3,-3,-4,5,0.25\n"
    table = read_table(csv, campaign=UPPER.replace("upper", half), table=ARM)
    assert [float(table.forces[c][0]) for c in "XYN"] == [-6.0, -8.0, 10.0]
    assert table.errors["Y"][0] == 0.5
    assert f"half model ({half}): X, Y, N doubled, by half_model of campaign.toml" in table.notes


def test_half_of_a_body_cut_at_z_0_refuses_what_leaves_that_plane(read_table: Read) -> None:
    for component, unit in (("Z", "N"), ("K", "N*m"), ("M", "N*m")):
        found = f"antisymmetric {component} on a half model cut at z = 0.*normal force, roll or pitch.*ignore"
        with pytest.raises(InputError, match=found):
            read_table(f"beta [deg],{component} [{unit}]\n2,1\n", campaign=UPPER)
    moving = {"w [m/s]": "w", "p [rad/s]": "p", "q [rad/s]": "q", "delta_s [deg]": "ds"}
    for header, name in moving.items():
        with pytest.raises(InputError, match=f"motion {name} on a half model cut at z = 0"):
            read_table(f"{header},Y [N]\n0.1,1\n", campaign=UPPER, table=ARM)


def test_a_cut_at_z_0_needs_declared_up_down_symmetry(read_table: Read) -> None:
    csv = "beta [deg],Y [N]\n2,1\n"
    with pytest.raises(InputError, match="without declared up-down symmetry") as found:
        read_table(csv, campaign=SECTIONS["campaign"] + '\nhalf_model = "lower"')
    assert "campaign.half_model" in str(found.value)
    assert 'symmetry = ["up-down"]' in str(found.value)
    with pytest.raises(InputError, match="without declared up-down symmetry") as found:
        read_table(csv, campaign=SECTIONS["campaign"] + '\nsymmetry = ["port-starboard"]', table='half_model = "upper"')
    assert "table[0].half_model" in str(found.value)


def test_inertia_of_a_rotating_arm_flips_the_sign_of_suboff(read_table: Read) -> None:
    """A balance with m' = .0174 reads (Yr' - m') = -.0130; the fluid's part is Yr' = +.0044."""
    mass = 0.0174 * 0.5 * 1000.0 * 4.0**3
    inertia = f"mass = {mass!r}\ncentre_of_gravity = [-2.0, 0.0, 0.0]\ninertia = [1.0, 9.0, 9.0]"
    csv = "r' [-],Y' [-]\n0.1,-0.00130\n0.2,-0.00260\n"
    table = read_table(csv, inertia=inertia, table="contains_inertia = true")
    slope = table.primed_force("Y", 4.0) / table.primed_motion("r", 4.0)
    assert slope == pytest.approx([0.0044, 0.0044], rel=1e-12)
    assert "inertia of the model subtracted" in table.notes[0]
    untouched = read_table(csv, table=ARM)
    assert untouched.primed_force("Y", 4.0) / untouched.primed_motion("r", 4.0) == pytest.approx([-0.0130] * 2)


def test_inertia_taken_out_is_newtons_law_of_particles(read_table: Read) -> None:
    """Rows contain -sum(m a) of point masses on a steady screw motion; without inertia nothing is left."""
    rng = np.random.default_rng(3)
    masses, places = np.ones(2) * 32.0, np.array([[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]])
    cg = np.array([-1.7, 0.1, 0.2])
    reference = np.array([-2.0, 0.0, 0.0])
    nu = rng.normal(size=(4, 6))
    nu[:, 0] = 2.0
    rows = []
    for v, w in zip(nu[:, :3], nu[:, 3:], strict=True):
        force, moment = np.zeros(3), np.zeros(3)
        for m, place in zip(masses, places, strict=True):
            arm = cg + place - reference
            acceleration = np.cross(w, v + np.cross(w, arm))
            force -= m * acceleration
            moment -= m * np.cross(arm, acceleration)
        rows.append([*v, *w, *force, *moment])
    inertia = "mass = 64.0\ncentre_of_gravity = [-1.7, 0.1, 0.2]\ninertia = [0.0, 16.0, 16.0]"
    table = read_table(as_csv(NAMES, UNITS, np.array(rows)), inertia=inertia, table="contains_inertia = true")
    for component in COMPONENTS:
        np.testing.assert_allclose(table.forces[component], 0.0, atol=1e-12)


def test_rotating_arm_must_declare_inertia(read_table: Read) -> None:
    csv = "r [rad/s],Y [N]\n0.1,1\n"
    with pytest.raises(InputError, match=r"campaign\.toml.*no declaration; expected contains_inertia.*rotating arm"):
        read_table(csv)
    with pytest.raises(InputError, match=r"contains_inertia = true without mass; expected \[inertia\]"):
        read_table(csv, table="contains_inertia = true")


def test_prime_and_dimensional_columns_agree(read_table: Read) -> None:
    q, length, speed = 0.5 * 1000.0 * 4.0, 4.0, 2.0
    si = read_table("v [m/s],r [rad/s],X [N],N [N*m],se_Y [N],Y [N]\n0.5,0.25,1,2,3,4\n", table=ARM)
    prime = read_table(
        f"v' [-],r' [-],X' [-],N' [-],se_Y' [-],Y' [-]\n{0.5 / speed},{0.25 * length / speed},"
        f"{1 / q / length**2!r},{2 / q / length**3!r},{3 / q / length**2!r},{4 / q / length**2!r}\n",
        table=ARM,
    )
    same(si, prime)
    assert si.primed_motion("r", length)[0] == 0.5


def test_imperial_units_give_the_same_si(read_table: Read) -> None:
    si = read_table(
        "U [m/s],beta [rad],delta_r [rad],p [rad/s],r [rad/s],Y [N],N [N*m],se_N [N*m]\n2.5,0.1,-0.2,0.3,0.4,5,6,7\n",
        table=ARM,
    )
    values = (2.5 / KNOT, np.degrees(0.1), np.degrees(-0.2), 0.3 * 30 / np.pi, np.degrees(0.4), 5 / POUND_FORCE,
              6 / POUND_FORCE / FOOT, 7e-3)  # fmt: skip
    header = "U [kn],beta [deg],delta_r [deg],p [rpm],r [deg/s],Y [lbf],N [ft*lbf],se_N [kN*m]\n"
    imperial = read_table(
        header + ",".join(repr(float(v)) for v in values) + "\n",
        table=ARM,
        axes=SECTIONS["axes"].replace("-2.0", f'"{-2.0 / FOOT!r} ft"'),
        scaling=f'length = "{4.0 / FOOT!r} ft"\nlength_name = "LBP"',
        conditions=f'speed = "{2.0 / KNOT!r} kn"\ndensity = "{1000.0 * FOOT**3 / 0.45359237!r} lb/ft^3"',
    )
    same(si, imperial)
    assert imperial.conditions.density == pytest.approx(1000.0, rel=1e-12)
    assert imperial.conditions.speed == pytest.approx(2.0, rel=1e-12)
    assert imperial.scaling.length == pytest.approx(4.0, rel=1e-12)
    assert imperial.reference_point[0] == pytest.approx(-2.0, rel=1e-12)


def test_speed_column_and_its_absence(read_table: Read) -> None:
    assert list(read_table("U [m/s],Y [N]\n3,1\n4,1\n").speed) == [3.0, 4.0]
    assert list(read_table("v [m/s],Y [N]\n0.5,1\n").speed) == [2.0]
    still = read_table("v [m/s],Y [N]\n1.2,1\n")
    assert still.motion["u"][0] == pytest.approx(1.6)
    given = read_table("u [m/s],v [m/s],Y [N]\n3,4,1\n")
    assert given.speed[0] == 5.0
    aft = read_table("u [m/s],v [m/s],Y [N]\n-3,4,1\n", axes=in_frame("CFD"))
    assert (aft.motion["u"][0], aft.motion["v"][0], aft.speed[0]) == (3.0, 4.0, 5.0)
    surge_is_v = read_table("v [m/s],Y [N]\n3,1\n", axes=in_frame('["port", "forward", "down"]'))
    assert (surge_is_v.motion["u"][0], surge_is_v.speed[0]) == (3.0, 3.0)


def test_dimensional_surge_with_primed_sway(read_table: Read) -> None:
    """v' = v / U with U the whole speed, not the surge alone."""
    table = read_table("u [m/s],v' [-],Y [N]\n3,0.8,1\n")
    assert table.speed[0] == pytest.approx(5.0)
    assert table.motion["v"][0] == pytest.approx(4.0)


def test_angles_beside_a_surge_column_are_refused(read_table: Read) -> None:
    with pytest.raises(InputError, match=r"angles and u; expected one or the other.*U \[m/s\]"):
        read_table("beta [deg],u [m/s],Y [N]\n4,2,1\n")


def test_cross_flow_faster_than_the_speed(read_table: Read) -> None:
    with pytest.raises(InputError, match="line 3: found a cross-flow faster than U"):
        read_table("v [m/s],Y [N]\n1,1\n2.5,1\n")


def test_labels_ignore_select(read_table: Read) -> None:
    csv = "point,beta [deg],grid,wall,Y [N]\n7,1,A,9,1\n8,2,B,x,2\n"
    table = read_table(
        csv, table='labels = ["grid"]\nignore = ["wall"]\nselect = { grid = "A", reason = "grid study" }'
    )
    assert table.labels == ("7", "8")
    assert list(table.usable["Y"]) == [True, False]
    (exclusion,) = table.exclusions
    assert (exclusion.line, exclusion.component, exclusion.reason) == (3, "", "grid B: grid study")
    with pytest.raises(InputError, match=r"unknown column \"wall\".*labels or ignore"):
        read_table(csv, table='labels = ["grid"]')
    with pytest.raises(InputError, match='selection by "mesh"; expected a label column'):
        read_table(csv, table='labels = ["grid"]\nignore = ["wall"]\nselect = { mesh = "A" }')
    assert list(table.with_uncertain_cells().usable["Y"]) == [True, False]


def test_sha256(read_table: Read) -> None:
    csv = "beta [deg],Y [N]\n1,1\n"
    digest = hashlib.sha256(csv.encode()).hexdigest()
    assert read_table(csv, table=f'sha256 = "{digest}"').files[1].sha256 == digest
    with pytest.raises(InputError, match=rf"table\.csv: found sha256 {digest[:12]}.*expected 00000.*was changed"):
        read_table(csv, table=f'sha256 = "{"0" * 64}"')


def test_uncertain_and_blank_cells(read_table: Read) -> None:
    csv = "beta [deg],Y [N],N [N*m],se_Y [N],uncertain\n1,1,2,.1,\n2,3,4,.1,Y\n3,,6,,Y\n4,7,8,.1,beta\n5,9,1,.1,Y N\n"
    table = read_table(csv)
    assert list(table.usable["Y"]) == [True, False, False, False, False]
    assert list(table.usable["N"]) == [True, True, True, False, False]
    reasons = {(e.line, e.component): (e.reason, e.uncertain) for e in table.exclusions}
    assert reasons[3, "Y"] == ('digit doubtful in the source ("uncertain")', True)
    assert reasons[4, "Y"] == ("blank in the source", False)
    assert {(5, "Y"), (5, "N"), (6, "Y"), (6, "N")} < reasons.keys()
    bold = table.with_uncertain_cells()
    assert list(bold.usable["Y"]) == [True, True, False, True, True]
    assert [e.line for e in bold.exclusions] == [4]
    with pytest.raises(InputError, match=r"line 2, column \"Y \[N\]\": found a blank cell.*name Y under \"uncertain\""):
        read_table("beta [deg],Y [N],uncertain\n1,,\n")
    with pytest.raises(InputError, match=r"line 2, column \"uncertain\": found \"Z\"; expected names of columns"):
        read_table("beta [deg],Y [N],uncertain\n1,1,Z\n")
    with pytest.raises(InputError, match=r"line 3, column \"beta \[deg\]\": found a blank cell; expected a number"):
        read_table("beta [deg],Y [N]\n1,1\n,2\n")


def test_doubtful_cells_of_turned_axes_are_named_by_the_table(read_table: Read) -> None:
    table = read_table("beta [deg],X [N],Y [N],uncertain\n1,5,6,X\n", axes=in_frame('["starboard", "aft", "down"]'))
    assert not table.usable["Y"][0]
    assert table.usable["X"][0]
    assert (table.forces["X"][0], table.forces["Y"][0]) == (-6.0, 5.0)


def test_standard_errors(read_table: Read) -> None:
    assert list(read_table("beta [deg],Y [N],se_Y [N]\n1,1,0.5\n").errors["Y"]) == [0.5]
    for value, found in (("0", "found 0;"), ("-1", "found -1;"), ("", "found a blank cell")):
        with pytest.raises(InputError, match=rf"line 2, column \"se_Y \[N\]\": {found}"):
            read_table(f"beta [deg],Y [N],se_Y [N]\n1,1,{value}\n")
    with pytest.raises(InputError, match=r"se_N without N; expected a column N"):
        read_table("beta [deg],Y [N],se_N [N*m]\n1,1,1\n")


@pytest.mark.parametrize("change", ["bom", "crlf", "quoted", "trailing", "comments", "blanks"])
def test_harmless_ways_of_writing(read_table: Read, change: str) -> None:
    plain = "beta [deg],Y [N]\n1,1.5\n2,-3e0\n"
    ways: dict[str, bytes] = {
        "bom": b"\xef\xbb\xbf" + plain.encode(),
        "crlf": plain.replace("\n", "\r\n").encode(),
        "quoted": b'"beta [deg]","Y [N]"\n"1","1.5"\n"2","-3e0"\n',
        "trailing": plain.encode() + b"\n,\n\n",
        "comments": b"# made by hand; 1, 2, 3\n\n" + plain.encode(),
        "blanks": b"  beta  [ deg ] , Y[N]\n 1 ,  1.5\n2,-3e0",
    }
    same(read_table(ways[change]), read_table(plain))


def test_lines_are_counted_from_the_top_of_the_file(read_table: Read) -> None:
    table = read_table("# one\n# two\nbeta [deg],Y [N]\n1,1\n2,2\n")
    assert table.labels == ("line 4", "line 5")


def test_only_one_table_of_a_campaign(write_campaign: Callable[..., Path]) -> None:
    from coeflab.tables.campaign import read_campaign
    from coeflab.tables.importers.csv import read

    campaign = read_campaign(write_campaign() / "campaign.toml")
    assert len(read(campaign, "table.csv")) == 1
    with pytest.raises(CoeflabError, match=r'no \[\[table\]\] for "other.csv"; expected one of table.csv'):
        read(campaign, "other.csv")
