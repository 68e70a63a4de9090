"""Rotating arms by radius, half models, points, speeds and densities of their own, and several grids: as declared."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.types import Array
from coeflab.core.units import quantity
from coeflab.fits import FITS
from coeflab.fits.rows.regression import Area, response
from coeflab.fits.uncertainty.budget import budgets_of
from coeflab.fits.uncertainty.grid_studies import grid_studies
from coeflab.law.symbols import MOTIONS
from coeflab.study.checks.grids import finer, in_use
from coeflab.tables.assumptions import CODE
from coeflab.tables.force_table import COARSER, FINER, ForceTable
from coeflab.tables.settings import Setting, read_settings, require_one_datum
from tests.conftest import SECTIONS

Read = Callable[..., ForceTable]
LENGTH, SPEED, DENSITY = 4.0, 2.0, 1000.0
POINT = np.array([-2.0, 0.0, 0.0])
SLOPES = {"Yv": -0.03, "Nv": -0.014, "Yr": 0.004, "Nr": -0.005}
ARM = 'contains_inertia = false\ncentre = "starboard"\narm_point = [-2.0, 0.0, 0.0]'
HALF = SECTIONS["campaign"] + "\nhalf_model = true"


def as_csv(columns: dict[str, Array]) -> str:
    rows = [",".join(repr(float(x)) for x in row) for row in zip(*columns.values(), strict=True)]
    return "\n".join([",".join(columns), *rows]) + "\n"


def velocity(table: ForceTable) -> Array:
    return np.column_stack([table.motion[m] for m in MOTIONS])


# ---- the arm


@pytest.mark.parametrize(
    ("side", "to"), [("starboard", (0, 1, 0)), ("port", (0, -1, 0)), ("above", (0, 0, -1)), ("below", (0, 0, 1))]
)
def test_the_body_turns_about_the_declared_centre(read_table: Read, side: str, to: tuple[float, ...]) -> None:
    """The only point of a rigid body at rest in the plane of the circle is the centre, R from the arm point across V."""
    point = [-1.2, 0.0, 0.0]
    table = read_table(
        "R [m],beta [deg],Y [N]\n12,0,1\n12,-15,1\n20,30,1\n",
        table=f'contains_inertia = false\ncentre = "{side}"\narm_point = {point}',
    )
    for row, radius in zip(velocity(table), (12.0, 12.0, 20.0), strict=True):
        at_arm = row[:3] + np.cross(row[3:], np.array(point) - POINT)
        assert np.linalg.norm(at_arm) == pytest.approx(SPEED, rel=1e-14)
        assert np.linalg.norm(row[3:]) == pytest.approx(SPEED / radius, rel=1e-14)
        centre = np.cross(row[3:], at_arm) / (row[3:] @ row[3:])
        assert np.linalg.norm(centre) == pytest.approx(radius, rel=1e-14)
        assert centre @ np.array(to) > 0.0
        assert row[3:] @ np.array(to) == pytest.approx(0.0, abs=1e-15)


def test_a_centre_to_starboard_is_a_positive_yaw_rate_of_l_over_r(read_table: Read) -> None:
    for side, sign in (("starboard", 1.0), ("port", -1.0)):
        table = read_table("R [m],U [m/s],Y [N]\n8,1,1\n8,2,1\n16,3,1\n", table=ARM.replace("starboard", side))
        np.testing.assert_array_equal(table.primed_motion("r", LENGTH), sign * np.array([0.5, 0.5, 0.25]))
        np.testing.assert_array_equal(table.motion["v"], 0.0)
    signed = read_table("R [m],Y [N]\n8,1\n-8,1\n", table=ARM.replace("starboard", "+R port"))
    np.testing.assert_array_equal(signed.primed_motion("r", LENGTH), [-0.5, 0.5])


def test_a_point_ahead_of_the_arm_point_drifts_by_x_r(read_table: Read) -> None:
    aft = ARM.replace("-2.0", "-3.5")
    table = read_table("R [m],beta [deg],U [m/s],Y [N]\n10,0,2,1\n10,-8,4,1\n", table=aft)
    r = np.array([0.2, 0.4])
    np.testing.assert_allclose(table.motion["r"], r, rtol=1e-15)
    drift = np.array([0.0, 4.0 * np.sin(np.radians(8.0))])
    np.testing.assert_allclose(table.motion["v"], drift + 1.5 * r, rtol=1e-14)
    np.testing.assert_allclose(table.motion["u"], [2.0, 4.0 * np.cos(np.radians(8.0))], rtol=1e-14)
    assert "U and velocities are those of (-3.5, 0, 0) m, moved from there" in table.notes
    by_rate = read_table(
        "r [rad/s],beta [deg],U [m/s],Y [N]\n0.2,0,2,1\n0.4,-8,4,1\n", table=aft.replace('centre = "starboard"', "")
    )
    np.testing.assert_allclose(velocity(by_rate), velocity(table), rtol=1e-14)


def test_rows_of_one_speed_are_those_of_the_arms_point(read_table: Read) -> None:
    """1.5 m ahead of it U is 2.136 m/s, by which that row is primed; it was run at 2 m/s."""
    table = read_table("R [m],U [m/s],Y [N]\n4,2,1\n4,3,1\n", table=ARM.replace("-2.0", "-3.5"))
    np.testing.assert_allclose(table.speed, np.array([2.0, 3.0]) * np.hypot(1.0, 1.5 / 4.0), rtol=1e-14)
    assert table.at_speed(2.0).usable["Y"].tolist() == [True, False]


def assumed_keys(table: ForceTable) -> list[str]:
    return [f["key"] for f in table.findings if f.code == CODE]


def test_rows_that_turn_say_which_point_is_assumed(read_table: Read) -> None:
    csv, own = "r [rad/s],Y [N],N [N*m]\n0.1,1,-1\n0.2,2,-2\n", "contains_inertia = false"
    found = read_table(csv, table=own).findings
    assert [(f["key"], f["motions"], f.severity) for f in found] == [
        ("table.arm_point", ("p", "q", "r"), Severity.WARN)
    ]
    assert not assumed_keys(read_table(csv, table=f"{own}\narm_point = [-2.0, 0.0, 0.0]"))
    assert not assumed_keys(read_table(csv.replace("0.1,", "0,").replace("0.2,", "0,"), table=own))
    drifting = "v [m/s],r [rad/s],Y [N]\n0.2,0.1,1\n0.2,0.2,2\n"
    assert assumed_keys(read_table(drifting, table=own)) == ["table.arm_point"]
    accepted = f'{own}\narm_point = [-2.0, 0.0, 0.0]\nassumed = ["table.arm_point", "axes.reference_point"]'
    assert assumed_keys(read_table(csv, table=accepted)) == ["table.arm_point", "axes.reference_point"]


def test_a_pitched_model_turns_about_the_vertical(read_table: Read) -> None:
    table = read_table("R [m],alpha [deg],Y [N]\n10,20,1\n", table=ARM)
    p, q, r = (float(table.motion[m][0]) for m in "pqr")
    np.testing.assert_allclose(
        [p, q, r], 0.2 * np.array([-np.sin(np.radians(20)), 0.0, np.cos(np.radians(20))]), atol=1e-16
    )


def test_everything_an_arm_leaves_open_comes_at_once(read_table: Read) -> None:
    with pytest.raises(InputError) as caught:
        read_table("R [m],Y [N]\n10,1\n")
    lines = str(caught.value).split("\n")
    assert len(lines) == 3
    for key, line in zip(("centre", "arm_point", "contains_inertia"), lines, strict=True):
        assert f'campaign.toml, line 24, "table[0].{key}": found no declaration' in line
    with pytest.raises(InputError, match=r'line 26, "table\[0\]\.centre": found "left"'):
        read_table("R [m],Y [N]\n10,1\n", table='centre = "left"')


@pytest.mark.parametrize(
    ("csv", "table", "said"),
    [
        ("R [m],r [rad/s],Y [N]\n10,0.2,1\n", ARM, "found R and r; expected one or the other"),
        ("r [rad/s],Y [N]\n0.2,1\n", ARM, "centre without a column R"),
        ("R [m],Y [N]\n-10,1\n", ARM, 'line 2, column "R [m]": found a radius of -10 m'),
        ("R [m],Y [N]\n0,1\n", ARM.replace("starboard", "+R starboard"), "a radius that is not zero"),
        ("R [m],Y [N]\n,1\n", ARM, "found a blank cell"),
        ("R [m],beta [deg],Y [N]\n10,90,1\n", ARM, "a motion straight to starboard"),
        ("R,Y [N]\n10,1\n", ARM, "R [m]"),
        ("R [m],Z [N]\n10,1\n", ARM + "\nhalf_model = true", "motion r on a half model"),
    ],
)
def test_arms_that_cannot_be(read_table: Read, csv: str, table: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        read_table(csv, table=table)
    assert said in str(caught.value)


def test_inertia_with_a_centre_of_gravity_ahead_and_drift(read_table: Read) -> None:
    """A balance reads X + m (v r + x_G r^2), Y - m u r, N - m x_G u r: d'Alembert about the reference point, steady turn."""
    mass, ahead = 700.0, 0.3
    u, v, r = (np.array(x) for x in ([1.9, 2.0, 1.8], [0.4, -0.3, 0.0], [0.2, -0.25, 0.3]))
    fluid = {
        "X": np.array([-40.0, -41.0, -42.0]),
        "Y": np.array([11.0, 12.0, 13.0]),
        "N": np.array([-50.0, 60.0, 70.0]),
    }
    read = {
        "u [m/s]": u, "v [m/s]": v, "r [rad/s]": r,
        "X [N]": fluid["X"] + mass * (v * r + ahead * r**2),
        "Y [N]": fluid["Y"] - mass * u * r,
        "N [N*m]": fluid["N"] - mass * ahead * u * r,
    }  # fmt: skip
    inertia = f"mass = {mass}\ncentre_of_gravity = [{-2.0 + ahead}, 0, 0]\ninertia = [10, 900, 900]"
    table = read_table(as_csv(read), inertia=inertia, table="contains_inertia = true")
    for c, values in fluid.items():
        np.testing.assert_allclose(table.forces[c], values, rtol=1e-12)


# ---- a point of its own


def physical(point: Array, *, moments: bool = True, rows: int = 9) -> dict[str, Array]:
    """One physical table, drift at one speed, with velocities and moments at a point x of the body."""
    v, r = SPEED * np.sin(np.radians(np.linspace(-16.0, 16.0, rows))), np.zeros(rows)
    return motions_and_forces(point, v, r, moments=moments)


def turning(point: Array) -> dict[str, Array]:
    r = np.array([-0.35, -0.25, -0.15, -0.05, 0.05, 0.15, 0.25, 0.35])
    return motions_and_forces(point, np.zeros(len(r)), r)


def motions_and_forces(point: Array, v: Array, r: Array, *, moments: bool = True) -> dict[str, Array]:
    u = np.sqrt(SPEED**2 - v**2)
    vp, rp = v / SPEED, r * LENGTH / SPEED
    q = 0.5 * DENSITY * SPEED**2 * LENGTH**2
    y = q * (SLOPES["Yv"] * vp - 0.2 * vp**3 + SLOPES["Yr"] * rp + 0.01 * rp * np.abs(rp))
    n = q * LENGTH * (SLOPES["Nv"] * vp + 0.1 * vp**3 + SLOPES["Nr"] * rp - 0.004 * rp * np.abs(rp))
    shift = point - POINT
    along = v + shift[0] * r
    out = {"u [m/s]": u, "v [m/s]": along, "r [rad/s]": r, "U [m/s]": np.hypot(u, along), "Y [N]": y}
    return out | ({"N [N*m]": n - shift[0] * y} if moments else {})


@pytest.mark.parametrize("make", [physical, turning])
def test_one_physical_table_about_two_points_gives_the_same_derivatives(
    read_table: Read, make: Callable[[Array], dict[str, Array]]
) -> None:
    fit = FITS.load("slope_at_origin").fit
    other = np.array([-2.7, 0.0, 0.0])
    here = read_table(as_csv(make(POINT)), table="contains_inertia = false")
    moved = read_table(as_csv(make(other)), table=f"contains_inertia = false\nreference_point = {other.tolist()}")
    assert np.array_equal(moved.reference_point, POINT)
    assert moved.notes == ("moments moved by (+0.7, +0, +0) m",)
    a, b = (fit([t], t.scaling, {}).coefficients for t in (here, moved))
    assert a.symbols == b.symbols
    for symbol in a.symbols:
        assert b[symbol].value == pytest.approx(a[symbol].value, rel=1e-12, abs=1e-15)


def test_a_moment_whose_move_needs_a_force_that_is_not_there_is_left_out(read_table: Read) -> None:
    csv = "beta [deg],N [N*m],X [N]\n0,1,2\n4,3,4\n"
    table = read_table(csv, table="reference_point = [-1.5, 0.0, 0.0]")
    assert list(table.forces) == ["X"]
    assert "N left out: to move it needs Y, which the table does not have" in table.notes


def test_inertia_is_taken_out_about_the_tables_own_point(read_table: Read) -> None:
    other = np.array([-2.7, 0.0, 0.0])
    mass, place, spin = 500.0, np.array([-1.9, 0.0, 0.0]), (5.0, 400.0, 400.0)
    inertia = f"mass = {mass}\ncentre_of_gravity = {place.tolist()}\ninertia = {list(spin)}"
    made = turning(other)
    r, lever = made["r [rad/s]"], place[0] - other[0]
    made["Y [N]"] = made["Y [N]"] - mass * made["u [m/s]"] * r
    made["N [N*m]"] = made["N [N*m]"] - mass * lever * made["u [m/s]"] * r
    table = read_table(
        as_csv(made), inertia=inertia, table=f"contains_inertia = true\nreference_point = {other.tolist()}"
    )
    clean = read_table(as_csv(turning(POINT)), table="contains_inertia = false")
    for c in ("Y", "N"):
        np.testing.assert_allclose(table.forces[c], clean.forces[c], rtol=1e-11, atol=1e-10)


# ---- half models


def test_a_table_says_for_itself_whether_it_is_a_half_model(read_table: Read) -> None:
    csv = "alpha [deg],Z [N],X [N]\n2,-4,-3\n"
    for campaign, table, factor, note in (
        (HALF, "", 2.0, "half model: X, Z, M doubled, by half_model of campaign.toml"),
        (HALF, "half_model = false", 1.0, "half model: nothing doubled, by half_model of its table"),
        (SECTIONS["campaign"], "", 1.0, ""),
        (
            SECTIONS["campaign"],
            'half_model = "starboard"',
            2.0,
            "half model (starboard): X, Z, M doubled, by half_model of its table",
        ),
    ):
        read = read_table(csv, campaign=campaign, table=table)
        assert read.forces["Z"][0] == -4.0 * factor
        assert read.notes == ((note,) if note else ())


def test_a_half_model_and_its_whole_give_one_coefficient_by_the_whole_area(read_table: Read) -> None:
    q, area = 0.5 * DENSITY * SPEED**2, Area(0.5, "frontal", LENGTH)
    whole = read_table("alpha [deg],X [N],Z [N],M [N*m]\n2,-30,-40,50\n")
    half = read_table("alpha [deg],X [N],Z [N],M [N*m]\n2,-15,-20,25\n", table='half_model = "port"')
    primes = f"alpha [deg],X' [-],Z' [-],M' [-]\n2,{-15 / q / 16!r},{-20 / q / 16!r},{25 / q / 64!r}\n"
    primed = read_table(primes, table="half_model = true")
    for name in ("X", "Z", "M", "C_D", "C_L"):
        expected, _, _ = response(whole, name, area)
        for other in (half, primed):
            np.testing.assert_allclose(response(other, name, area)[0], expected, rtol=1e-14)


# ---- speed and density of every row


def test_each_row_is_primed_by_its_own_speed_and_density(read_table: Read) -> None:
    csv = "beta [deg],U [m/s],density [kg/m^3],Y [N],N' [-]\n4,1,998,10,0.01\n4,2,1025,10,0.01\n"
    table = read_table(csv, conditions="speed = 9.0\ndensity = 500.0\nviscosity = 1e-6")
    unit = 0.5 * np.array([998.0, 1025.0]) * np.array([1.0, 4.0]) * 16.0
    np.testing.assert_allclose(table.primed_force("Y", LENGTH), 10.0 / unit, rtol=1e-15)
    np.testing.assert_allclose(table.forces["N"], 0.01 * unit * LENGTH, rtol=1e-15)
    np.testing.assert_allclose(response(table, "Y", Area(16.0, "L^2", LENGTH))[0], 10.0 / unit, rtol=1e-15)
    np.testing.assert_allclose(table.reynolds(LENGTH), [4e6, 8e6])
    assert table.run_at == "speed 1 to 2 m/s, density 998 to 1025 kg/m^3"
    one = table.at_one_density()
    np.testing.assert_allclose(one.forces["Y"], 10.0 * 500.0 / np.array([998.0, 1025.0]))
    np.testing.assert_allclose(one.primed_force("Y", LENGTH), table.primed_force("Y", LENGTH), rtol=1e-15)
    assert table.about(POINT + 1.0).density is not None


@pytest.mark.parametrize("fit", ["slope_at_origin", "linear_quadratic_damping", "glide_polar"])
def test_no_fit_feels_the_density_that_a_campaign_declares_for_such_a_table(read_table: Read, fit: str) -> None:
    """Rows of two waters give what the same rows, converted to one water by hand, give."""
    w, rho = SPEED * np.sin(np.radians(np.linspace(-12.0, 12.0, 13))), np.where(np.arange(13) % 2, 998.0, 1025.0)
    u, zero = np.sqrt(SPEED**2 - w**2), np.zeros(13)
    if fit == "linear_quadratic_damping":
        u, w = np.linspace(0.2, 3.0, 13), zero
    kind = {"u [m/s]": u, "w [m/s]": w, "U [m/s]": np.full(13, SPEED)}
    x, z = -rho * (0.02 * u + 0.01 * u**2), -rho * (0.3 * u * w + 0.2 * w * np.abs(w))
    both = read_table(
        as_csv({**kind, "density [kg/m^3]": rho, "X [N]": x, "Z [N]": z}), conditions="speed = 2.0\ndensity = 700.0"
    )
    one = read_table(
        as_csv({**kind, "X [N]": x * 700.0 / rho, "Z [N]": z * 700.0 / rho}), conditions="speed = 2.0\ndensity = 700.0"
    )
    options = {"axes": ("u",)} if fit == "linear_quadratic_damping" else {}
    found, expected = (FITS.load(fit).fit([t], t.scaling, options) for t in (both, one))
    for a, b in zip(found.coefficients.coefficients, expected.coefficients.coefficients, strict=True):
        assert (a.symbol, a.status) == (b.symbol, b.status)
        assert a.value == pytest.approx(b.value, rel=1e-9, abs=1e-12)
    for a, b in zip(found.models, expected.models, strict=True):
        np.testing.assert_allclose(a.fit.coefficients, b.fit.coefficients, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("cell", ["", "0", "-998"])
def test_a_density_that_is_none_is_refused(read_table: Read, cell: str) -> None:
    with pytest.raises(InputError, match=r"line 2, column \"density.*a density above zero"):
        read_table(f"beta [deg],density [kg/m^3],Y [N]\n4,{cell},1\n")


# ---- several grids

GRIDS = np.array([1e6, 3e5, 1e5])


def on_grids(order: float = 1.6) -> dict[str, Array]:
    """Drift of nine angles on three grids, every force f (1 + 0.02 h^p)."""
    beta = np.repeat(np.linspace(-12.0, 12.0, 9), 3)
    v = np.sin(np.radians(beta))
    h = np.tile((GRIDS[0] / GRIDS) ** (1.0 / 3.0), 9)
    grid = 1.0 + 0.02 * h**order
    force = 0.5 * DENSITY * SPEED**2 * LENGTH**2 * (-0.03 * v - 0.2 * v**3)
    return {"beta [deg]": beta, "n [-]": np.tile(GRIDS, 9), "Y [N]": force * grid}


@pytest.fixture
def several_grids(read_table: Read) -> ForceTable:
    text = as_csv(on_grids()).replace("n [-]", "cells")
    source = 'citation = "made up"\nkind = "cfd"\nhow_obtained = "formula"'
    return read_table(text, table='cells = "cells"', source=source)


def test_the_finest_grid_of_each_condition_enters_fits_without_a_selection(several_grids: ForceTable) -> None:
    table = several_grids
    np.testing.assert_array_equal(table.usable["Y"], np.tile([True, False, False], 9))
    assert {e.reason for e in table.exclusions} == {COARSER}
    assert len(table.exclusions) == 18
    assert table.exclusions[0].line == 3
    assert not list(in_use(table))
    (found,) = finer(table)
    assert found["need"] == "no"
    assert found.statistic == pytest.approx(1.25 * 0.02 / 1.02, rel=1e-6)


def test_every_condition_has_its_grid_study_and_u95_holds_it(several_grids: ForceTable) -> None:
    studies = grid_studies(several_grids, "Y")
    assert len(studies) == 9
    for s in studies:
        if s.setting == "at rest":
            continue
        assert s.convergence.order == pytest.approx(1.6, abs=1e-6)
        assert s.convergence.relative == pytest.approx(1.25 * 0.02 / 1.02, rel=1e-6)
    fit = FITS.load("slope_at_origin").fit([several_grids], several_grids.scaling, {})
    budget = next(b for b in budgets_of(fit, {several_grids.name: several_grids}) if b.symbol == "Yv")
    assert budget.part("grid") == pytest.approx(abs(budget.value) * 1.25 * 0.02 / 1.02, rel=1e-6)


def test_a_selection_comes_before_the_shared_grid_and_an_unusable_cell_gives_way(read_table: Read) -> None:
    csv = "beta [deg],cells,set,Y [N],X [N],uncertain\n4,100,A,1,2,\n4,300,A,1,2,Y\n4,900,B,1,2,\n6,100,A,1,2,\n6,,A,1,2,\n"
    select = 'select = { set = "A", reason = "one set" }'
    table = read_table(csv, table=f'cells = "cells"\nlabels = ["set"]\n{select}')
    assert table.usable["Y"].tolist() == [True, False, False, True, True]
    assert table.usable["X"].tolist() == [True, False, False, True, True]
    assert [(e.row, e.component) for e in table.exclusions if e.reason == FINER] == [(1, "")]
    (found,) = in_use(table)
    assert (found["count"], found["cells"]) == (1, "100")


@pytest.mark.parametrize(
    ("more", "need"),
    [((1.024,), "unknown"), ((1.024, 1.06), "diverges"), ((1.024, 1.027), "wide"), ((1.005, 1.0055), "no")],
)
def test_a_condition_on_finer_grids_is_for_the_grid_study_only(
    read_table: Read, more: tuple[float, ...], need: str
) -> None:
    """The fit stays on the grid that most conditions share, whose cells differ a little from angle to angle."""
    beta, cells = (
        np.array([-9, -6, -3, 0, 3, 6, 9.0, *[6.0] * len(more)]),
        [1e6 * k for k in (1, 1.01, 1.02, 1.03, 1.04, 1.05, 1.06)],
    )
    cells += [2.1e6, 4.2e6][: len(more)]
    v = np.sin(np.radians(beta))
    force = 0.5 * DENSITY * SPEED**2 * LENGTH**2 * (-0.03 * v - 0.2 * v**3)
    force[7:] *= more
    text = as_csv({"beta [deg]": beta, "n [-]": np.array(cells), "Y [N]": force}).replace("n [-]", "cells")
    table = read_table(text, table='cells = "cells"')
    np.testing.assert_array_equal(np.flatnonzero(table.usable["Y"]), range(7))
    assert {(e.row, e.reason) for e in table.exclusions} == {(7 + i, FINER) for i in range(len(more))}
    (apart,), (answer,) = in_use(table), finer(table)
    assert (apart["count"], apart["cells"]) == (len(more), "1.03M")
    assert (answer["need"], answer["setting"]) == (need, "6 deg of drift")
    assert (answer["coarse"], answer["fine"]) == ("1.05M", "2.1M")
    assert answer["change"] == pytest.approx(100.0 * (more[0] - 1.0), rel=1e-9)
    fit = FITS.load("slope_at_origin").fit([table], table.scaling, {})
    assert abs(fit.coefficients["Yv"].value or 0.0) == pytest.approx(0.03, rel=1e-6)


def test_of_grids_that_share_as_many_conditions_the_finer_is_in_use(read_table: Read) -> None:
    text = "beta [deg],cells,Y [N]\n2,1000,1\n2,2000,1.1\n4,1000,2\n4,2000,2.1\n6,1000,3\n8,2000,4\n"
    table = read_table(text, table='cells = "cells"')
    assert table.usable["Y"].tolist() == [False, True, False, True, True, True]
    (found,) = in_use(table)
    assert (found.severity, found["count"], found["of"]) == (Severity.WARN, 1, 4)


# ---- the page


def test_the_example_of_the_documentation(read_table: Read) -> None:
    page = (shipped("cfd_data").parent / "docs" / "rotating_arm.md").read_text(encoding="utf-8")
    toml, csv = (page.split(f"```{kind}\n")[1].split("```")[0] for kind in ("toml", "csv"))
    keys, _, inertia = toml.partition("[inertia]")
    table = read_table(csv, table=keys.split("\n", 2)[2], inertia=inertia)
    rows = page.split("|---|---|---|---|---|---|---|\n")[1].split("\n\n")[0]
    printed = np.array([[float(cell) for cell in row.strip("|").split("|")] for row in rows.split("\n")])
    found = [
        table.motion["r"],
        table.primed_motion("r", LENGTH),
        table.motion["v"],
        table.forces["Y"],
        table.forces["N"],
    ]
    np.testing.assert_allclose(np.column_stack(found), printed[:, 2:], rtol=2e-5, atol=6e-5)
    radius, speed = printed[:, 0], printed[:, 1]
    prime = LENGTH / radius
    q = 0.5 * DENSITY * speed**2 * LENGTH**2
    side = q * (0.004 * prime + 0.010 * prime * np.abs(prime))
    yaw = q * LENGTH * (-0.005 * prime - 0.004 * prime * np.abs(prime)) - 0.3 * side
    np.testing.assert_allclose(table.forces["Y"], side, atol=1e-3)
    np.testing.assert_allclose(table.forces["N"], yaw, atol=2e-3)
    np.testing.assert_allclose(table.forces["X"], -0.0035 * q, atol=1e-3)


@pytest.mark.parametrize("key", ["axes.reference_point", "table.arm_point"])
@pytest.mark.parametrize("typed", [
    "-6.9 ft from nose", "-82.8 in from nose", "-2103.12 mm from nose", "nose -6.9 ft",
    "-6.9, 0, 0 ft from nose", "-2103.12,0,0 mm from nose", "-2.10312 m from nose",
])  # fmt: skip
def test_a_place_from_a_point_keeps_its_unit(key: str, typed: str) -> None:
    read = read_settings(key, typed)
    assert read["axes.datum"] == "nose"
    assert read[key] == pytest.approx([-2.10312, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    "typed",
    ["-2.1 yd from nose", "-0.45 L from nose", "-6.9', 0, 0 from nose", "-6.9 ft, 0 ft, 0 ft from nose", "-7 inches from nose",
     "-2.1 metres from nose", "nose -2.3 dm", "0.2 in front of midship"],
)  # fmt: skip
def test_a_place_in_a_unit_that_is_not_read_is_refused(typed: str) -> None:
    with pytest.raises(InputError):
        read_settings("axes.reference_point", typed)


@pytest.mark.parametrize("typed", ["13.8 feet LOA", "4.2 yd LOA", "165 inches LBP", "13.8' LOA"])
def test_a_unit_that_is_not_read_is_no_name_of_a_length(typed: str) -> None:
    with pytest.raises(InputError):
        read_settings("scaling.length", typed)


@pytest.mark.parametrize("key", ["axes.reference_point", "table.arm_point", "inertia.centre_of_gravity"])
def test_one_unit_behind_three_numbers_is_that_of_all(key: str) -> None:
    """It was that of the last alone: -6.9 m beside 0 ft."""
    said = read_settings(key, "-6.9, 0, 0.5 ft")[key]
    found = [v if isinstance(v, float) else quantity(str(v), "length") for v in said]
    assert found == pytest.approx([-2.10312, 0.0, 0.1524], abs=1e-12)


def test_a_centre_of_gravity_names_its_datum_as_a_reference_point_does() -> None:
    expected = {"axes.datum": "nose", "inertia.centre_of_gravity": [-2.95, 0.0, 0.0]}
    assert read_settings("inertia.centre_of_gravity", "-2.95 from nose") == expected
    with pytest.raises(InputError, match='places from "midship" and from "nose"'):
        require_one_datum({"axes.datum": Setting("midship", "confirmed")}, expected)
