"""The HoloOcean export: its own law from closed forms, what finds a place in it, and what does not."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.errors import InputError
from coeflab.formats.export import export
from coeflab.formats.holoocean import write as exporter
from coeflab.formats.holoocean.torpedo import CROSS_FLOW, WATER, Torpedo, lifting_area
from coeflab.law.rigid_body import rigid_body_force
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import MASS, torpedo, with_mass

GOLDEN = Path(__file__).parent / "golden" / "holoocean.json"
LIFTING = {"X0": -2e-4, "Xww": 1e-3, "Zw": -1e-2, "Nr": -1e-2, "Yv": -2e-2, "Nv": -3e-3}


def remus(**changed: object) -> Torpedo:
    """The defaults of HoloOcean."""
    values = {
        "mass": 31.03, "length": 1.6, "diam": 0.19, "r_bg": np.array([0.0, 0.0, 0.02]), "r_bb": np.zeros(3), "area_fraction": 0.7,
        "T_surge": 20.0, "T_sway": 20.0, "zeta_roll": 0.3, "zeta_pitch": 0.8, "T_yaw": 1.0, "r44": 0.3, "Cd": 0.42, "e": 0.7,
    }  # fmt: skip
    return Torpedo(**{**values, **changed})


def lifting() -> ParameterFile:
    return with_mass(made.parameters(LIFTING, made.HULL), np.zeros(3))


def test_golden() -> None:
    """Regenerate by hand: write exporter.render(with_mass(plain())) to golden/holoocean.json and read the difference."""
    assert exporter.render(with_mass(made.plain())) == {"file.json": GOLDEN.read_bytes()}


def test_added_mass_is_lambs_of_the_displaced_spheroid() -> None:
    mass = 4.0 / 3.0 * np.pi * 1000.0 * 0.8 * 0.095**2
    lamb = np.diag(ellipsoid_added_mass(np.array([0.8, 0.095, 0.095]), 1000.0))
    found = remus(mass=mass).added
    np.testing.assert_allclose(found[:3], lamb[:3], rtol=1e-10)
    np.testing.assert_allclose(found[4:], lamb[4:], rtol=1e-10)
    assert found[3] == pytest.approx(0.3 * 0.4 * mass * 0.095**2)


def test_straight_ahead_it_is_the_drag_of_the_front_and_a_fading_line() -> None:
    t = remus()
    u = np.array([0.2, 1.0, 2.5])
    found = t.force(np.column_stack([u, *np.zeros((5, 3))]))
    fading = (31.03 + t.added[0]) / 20.0 * np.exp(-3.0 * u) * u
    np.testing.assert_allclose(found[:, 0], -0.5 * 1026.0 * 0.42 * np.pi * 0.095**2 * u**2 - fading)
    np.testing.assert_allclose(found[:, 1:], 0.0, atol=1e-12)


def test_cross_flow_of_twenty_one_strips() -> None:
    found = remus(T_sway=1e12).force(np.array([[0.0, 0.5, 0.0, 0.0, 0.0, 0.0]]))[0]
    assert found[1] == pytest.approx(-0.5 * 1026.0 * 0.19 * CROSS_FLOW * 1.05 * 1.6 * 0.25, rel=1e-9)
    assert found[5] == pytest.approx(0.0, abs=1e-9)
    turning = remus(T_yaw=1e12).force(np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.4]]))[0]
    x = (np.arange(21) - 10.0) * 0.08
    assert turning[5] == pytest.approx(
        -0.5 * 1026.0 * 0.19 * CROSS_FLOW * 0.08 * np.sum(np.abs(x) ** 3) * 0.16, rel=1e-6
    )


def test_what_is_left_of_coriolis_has_p() -> None:
    """With every damping off: a22 v p and a33 w p across, and the products of added moments; no Munk moment."""
    t = remus(T_surge=1e15, T_sway=1e15, T_yaw=1e15, zeta_roll=0.0, zeta_pitch=0.0, Cd=0.0, length=1.6, diam=1e-3)
    nu = np.random.default_rng(2).normal(size=(20, 6))
    nu[:, [1, 5]] *= 1e-9
    a, (_, _, w, p, q, _) = t.added, nu.T
    found = t.force(nu)
    np.testing.assert_allclose(found[:, 1], a[2] * w * p, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(found[:, 5], (a[3] - a[4]) * p * q, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(found[:, 3], 0.0, atol=1e-9)


def test_damping_of_roll_and_pitch_comes_from_the_righting_lever() -> None:
    t = remus()
    damping = 2.0 * 0.3 * np.sqrt(31.03 * 9.81 * 0.02 / t.inert[3]) * t.inert[3]
    assert t.force(np.array([[0.0, 0.0, 0.0, 0.1, 0.0, 0.0]]))[0, 3] == pytest.approx(-damping * 0.1)
    assert t.damping[4] > 0.0
    assert remus(r_bb=np.array([0.0, 0.0, 0.02])).damping[3] == 0.0


def test_inert_is_mass_about_the_reference_point() -> None:
    """Steady turning of the mass alone, by Newton and Euler, has the same moment about x, y and z of squares left out."""
    t = remus(r_bg=np.array([0.1, 0.02, 0.03]))
    ix, iy = t.inertia
    inertia = np.diag(t.inert[3:] - t.added[3:])
    spin = rigid_body_force(t.mass, np.zeros(3), inertia, np.array([[0.0, 0.0, 0.0, 1.0, 1.0, 0.0]]))[0]
    assert spin[5] == pytest.approx(inertia[1, 1] - inertia[0, 0])
    assert t.inert[5] - t.added[5] == pytest.approx(iy + t.mass * (0.1**2 + 0.02**2))
    assert t.inert[3] - t.added[3] == pytest.approx(ix + t.mass * (0.02**2 + 0.03**2))


@pytest.mark.parametrize("slope", [1e-3, 0.01, 0.05])
def test_lifting_area_has_the_slope(slope: float) -> None:
    area = lifting_area(slope, 0.2)
    aspect = 0.2**2 / area
    assert area * np.pi * aspect / (1.0 + np.sqrt(1.0 + (aspect / 2.0) ** 2)) == pytest.approx(slope, rel=1e-12)


@pytest.mark.parametrize("slope", [-0.01, 0.0, 0.5 * np.pi * 0.04, 1.0])
def test_no_area_lifts_so_much_or_so_little(slope: float) -> None:
    assert lifting_area(slope, 0.2) is None


def test_what_it_takes_it_takes_at_straight_motion() -> None:
    """Resistance, lift in heave with its induced drag, and yaw damping at the file's speed."""
    file = lifting()
    rendered, speed = exporter.render(file), file.conditions.speed
    ours, small = force_law(file), 1e-4 * speed
    straight = np.array([[speed, 0.0, 0.0, 0.0, 0.0, 0.0]])
    assert exporter.force(rendered, straight)[0, 0] == pytest.approx(ours.force(straight)[0, 0], rel=1e-7)
    heave = np.array([[np.sqrt(speed**2 - small**2), 0.0, small, 0.0, 0.0, 0.0]])
    assert exporter.force(rendered, heave)[0, 2] == pytest.approx(ours.force(heave)[0, 2], rel=1e-6)
    w = 0.05 * speed
    heave = np.array([[np.sqrt(speed**2 - w**2), 0.0, w, 0.0, 0.0, 0.0]])
    extra = [f(heave)[0, 0] - f(straight)[0, 0] for f in (lambda nu: exporter.force(rendered, nu), ours.force)]
    assert extra[0] == pytest.approx(extra[1], rel=2e-2)
    yaw = np.array([[speed, 0.0, 0.0, 0.0, 0.0, 1e-6]])
    assert exporter.force(rendered, yaw)[0, 5] == pytest.approx(ours.force(yaw)[0, 5], rel=1e-4)
    assert not {"X0", "Zw", "Xww", "Nr"} & set(exporter.not_held(file))
    assert {"Yv", "Nv"} <= set(exporter.not_held(file))


def test_the_density_in_the_source_is_made_up_for() -> None:
    dynamics = json.loads(exporter.render(lifting())["file.json"])["agents"][0]["dynamics"]
    front = np.pi * dynamics["diam"] ** 2 / 4.0
    assert 0.5 * WATER * dynamics["Cd"] * front == pytest.approx(2e-4 * 0.5 * 1000.0 * 4.0)
    assert dynamics["mass"] == MASS
    assert dynamics["rho"] == 1000.0
    assert np.pi / 6.0 * dynamics["length"] * dynamics["diam"] ** 2 * 1000.0 == pytest.approx(MASS)


def test_keys_are_those_of_the_torpedo() -> None:
    dynamics = json.loads(exporter.render(torpedo())["file.json"])["agents"][0]["dynamics"]
    assert set(dynamics) == {"rho", *(f.name for f in fields(Torpedo))}


def test_the_loss_is_said() -> None:
    loss = export(lifting(), "holoocean").loss
    assert not loss.lossless
    assert "the added mass of the file" in loss.not_held[0]
    assert any("no Munk moment" in c for c in loss.changes)
    assert any("area_fraction" in c and "from Zw" in c for c in loss.changes)


def test_rest_damping_becomes_time_constants() -> None:
    file = with_mass(made.parameters({"Xu": -1e-3, "Yv": -3e-2, "Nr": -4e-3}, law="rest"), np.zeros(3))
    still = 1e-6 * np.eye(6)[[0, 1, 5]]
    found, wanted = exporter.force(exporter.render(file), still), force_law(file).force(still)
    np.testing.assert_allclose(found[[0, 1, 2], [0, 1, 5]], wanted[[0, 1, 2], [0, 1, 5]], rtol=1e-4)


def test_no_torpedo_without_mass() -> None:
    with pytest.raises(InputError, match="no mass"):
        exporter.render(made.plain())


def test_no_torpedo_that_is_a_ball() -> None:
    heavy = with_mass(made.plain())
    file = heavy.model_copy(update={"mass": replace(heavy.mass, mass=1e5)})
    with pytest.raises(InputError, match="a body longer than thick"):
        exporter.render(file)


@pytest.mark.parametrize("name", made.HOSTILE)
def test_names_that_hurt(name: str) -> None:
    ((file, content),) = exporter.render(with_mass(made.named(name))).items()
    agent = json.loads(content)["agents"][0]
    assert f"{agent['agent_name']}.json" == file
    assert agent["agent_name"].isidentifier()


def test_names_of_one_law_make_one_torpedo() -> None:
    """Zuw is Zw on a straight course, Nur is Nr; by such names lift and damping in yaw were left out."""
    same = {"X0": "Xu|u|", "Xww": "Xww", "Zw": "Zuw", "Nr": "Nur", "Yv": "Yuv", "Nv": "Nuv"}
    other = with_mass(made.parameters({same[n]: v for n, v in LIFTING.items()}, made.HULL), np.zeros(3))
    assert exporter.render(other) == exporter.render(lifting())
    assert len(exporter.not_held(other)) == len(exporter.not_held(lifting()))


def test_buoyancy_of_the_file_rights_it_and_roll_damping_is_that_of_the_file() -> None:
    from tests.formats.of_a_vehicle import BUOYANT, floating

    file = floating()
    (content,) = exporter.render(file).values()
    dynamics = json.loads(content)["agents"][0]["dynamics"]
    assert dynamics["r_bb"] == list(BUOYANT)
    speed = file.conditions.speed
    rolling = np.array([[speed, 0.0, 0.0, 0.1, 0.0, 0.0], [speed, 0.0, 0.0, -0.1, 0.0, 0.0]])
    found, due = exporter.force(exporter.render(file), rolling), force_law(file).force(rolling)
    assert found[0, 3] - found[1, 3] == pytest.approx(due[0, 3] - due[1, 3], rel=1e-9)
