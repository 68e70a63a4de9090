"""The test matrix: what six derivatives need of a body, by its mirrors."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tank.test_matrix import (
    FOURFOLD,
    PORT_STARBOARD,
    UP_DOWN,
    Half,
    Kind,
    Study,
    Sweeps,
    TowCondition,
    conditions,
    default_sweeps,
    half_of,
    mirrored,
    stated,
    symmetries,
    with_studies,
)
from coeflab.tank.towed_body import TowedBody
from tests.tank.towed_bodies import LENGTH, with_mirrors

SPEED = 2.0
MIRRORS = ["", "y", "z", "yz", "yz4"]


def default_matrix(body: TowedBody | None) -> tuple[TowCondition, ...]:
    """The conditions that the six derivatives need."""
    return conditions(default_sweeps(body, LENGTH), body, SPEED, LENGTH)


def of_kind(matrix: tuple[TowCondition, ...], kind: Kind) -> list[TowCondition]:
    return [c for c in matrix if c.kind is kind]


@pytest.mark.parametrize("mirrors", MIRRORS)
def test_the_default_has_what_six_derivatives_need(mirrors: str) -> None:
    matrix = default_matrix(with_mirrors(mirrors))
    drift, attack, arm = (of_kind(matrix, k) for k in (Kind.DRIFT, Kind.ATTACK, Kind.ARM))
    v = np.array([c.velocity[1] for c in drift]) / SPEED
    w = np.array([c.velocity[2] for c in attack]) / SPEED
    r = np.array([c.rates[2] for c in arm]) * LENGTH / SPEED
    assert len(v) >= 5
    assert len(r) >= 5
    assert np.sum(np.abs(r) <= 0.25) >= 3
    assert np.abs(v).min() <= 0.25 * np.abs(v).max()
    assert np.abs(r).min() <= 0.25 * np.abs(r).max()
    both = "y" not in mirrors
    assert (v.min() < 0.0 < v.max()) == (r.min() < 0.0 < r.max()) == both
    if "4" in mirrors:
        assert not attack
    else:
        assert len(w) >= 5
        assert (w.min() < 0.0 < w.max()) == ("z" not in mirrors)
    for c in matrix:
        assert c.speed == pytest.approx(SPEED, rel=1e-12)
        assert c.velocity[0] > 0.0


@pytest.mark.parametrize("reference", [0.0, 1.0, 2.013])
def test_no_rate_gives_an_end_more_cross_flow_than_the_largest_drift(reference: float) -> None:
    body = with_mirrors("yz", nose=reference, stern=reference - 4.356)
    matrix = default_matrix(body)
    reach = max(abs(reference), abs(reference - 4.356))
    cross = max(abs(c.rates[2]) * reach for c in of_kind(matrix, Kind.ARM))
    drift = max(abs(c.velocity[1]) for c in of_kind(matrix, Kind.DRIFT))
    assert 0.9 * drift < cross <= drift * (1.0 + 1e-9)


def test_a_short_body_is_not_spun() -> None:
    rates = default_sweeps(with_mirrors("yz", nose=0.2, stern=-0.2), LENGTH).yaw
    assert max(rates) <= 0.5
    assert len([r for r in rates if r <= 0.25]) >= 3


@pytest.mark.parametrize(
    ("mirrors", "drift", "attack", "straights"),
    [
        ("", Half.WHOLE, Half.WHOLE, {"straight": Half.WHOLE}),
        ("y", Half.WHOLE, Half.PORT, {"straight": Half.WHOLE, "straight_port": Half.PORT}),
        ("z", Half.UPPER, Half.WHOLE, {"straight": Half.UPPER, "straight_whole": Half.WHOLE}),
        ("yz", Half.UPPER, Half.PORT, {"straight": Half.UPPER, "straight_port": Half.PORT}),
        ("yz4", Half.UPPER, None, {"straight": Half.UPPER}),
    ],
)
def test_every_sweep_has_a_straight_run_on_its_own_mesh(
    mirrors: str, drift: Half, attack: Half | None, straights: dict[str, Half]
) -> None:
    matrix = default_matrix(with_mirrors(mirrors))
    assert {c.half for c in matrix if c.kind in (Kind.DRIFT, Kind.ARM)} == {drift}
    assert {c.half for c in of_kind(matrix, Kind.ATTACK)} == ({attack} if attack is not None else set())
    assert {c.name: c.half for c in of_kind(matrix, Kind.STRAIGHT)} == straights


@pytest.mark.parametrize(
    ("velocity", "rates", "controls", "has", "half"),
    [
        ((2, 0.1, 0), (0, 0, 0.1), {}, (UP_DOWN,), Half.UPPER),
        ((2, 0.1, 0), (0, 0, 0), {}, (PORT_STARBOARD,), Half.WHOLE),
        ((2, 0, 0.1), (0, 0.1, 0), {}, (PORT_STARBOARD, UP_DOWN), Half.PORT),
        ((2, 0.1, 0.1), (0, 0, 0), {}, (PORT_STARBOARD, UP_DOWN), Half.WHOLE),
        ((2, 0, 0), (0.1, 0, 0), {}, (PORT_STARBOARD, UP_DOWN), Half.WHOLE),
        ((2, 0, 0), (0, 0, 0), {"dr": 0.1}, (PORT_STARBOARD, UP_DOWN), Half.UPPER),
        ((2, 0, 0), (0, 0, 0), {"ds": 0.1}, (PORT_STARBOARD, UP_DOWN), Half.PORT),
        ((2, 0, 0), (0, 0, 0), {"dr": 0.1, "ds": 0.1}, (PORT_STARBOARD, UP_DOWN), Half.WHOLE),
        ((2, 0, 0), (0, 0, 0), {"fin_7": 0.1}, (PORT_STARBOARD, UP_DOWN), Half.WHOLE),
        ((2, 0, 0), (0, 0, 0), {"ds": 0.0}, (UP_DOWN,), Half.UPPER),
    ],
)
def test_half_a_body_only_where_the_flow_has_its_mirror(
    velocity: tuple[float, ...], rates: tuple[float, ...], controls: dict[str, float], has: tuple[str, ...], half: Half
) -> None:
    assert half_of(np.array(velocity, float), np.array(rates, float), controls, has) is half


def test_the_mirror_image_of_a_motion_turns_the_other_way() -> None:
    c = TowCondition("c", Kind.COMBINED, np.array([2.0, 0.3, 0.1]), np.array([0.1, 0.2, 0.4]))
    velocity, rates = mirrored(c, PORT_STARBOARD)
    assert velocity.tolist() == [2.0, -0.3, 0.1]
    assert rates.tolist() == [-0.1, 0.2, -0.4]
    velocity, rates = mirrored(c, UP_DOWN)
    assert velocity.tolist() == [2.0, 0.3, -0.1]
    assert rates.tolist() == [-0.1, -0.2, 0.4]


def test_what_the_mirror_gives_is_not_run() -> None:
    both = Sweeps(drift=(0.1, -0.1))
    with pytest.raises(InputError, match=r'"drift-5.72958", the mirror image of "drift\+5.72958"') as why:
        conditions(both, with_mirrors("y"), SPEED, LENGTH)
    assert "symmetry = false" in why.value.advice
    assert len(conditions(both, with_mirrors(""), SPEED, LENGTH)) == 3
    quadrants = Sweeps(combined=((0.1, 0.0, 0.2, 0.0), (0.1, 0.0, -0.2, 0.0)))
    assert len(conditions(quadrants, with_mirrors("yz"), SPEED, LENGTH)) == 3
    with pytest.raises(InputError, match="mirror image"):
        conditions(Sweeps(combined=((0.1, 0.0, 0.2, 0.0), (-0.1, 0.0, -0.2, 0.0))), with_mirrors("y"), SPEED, LENGTH)


def test_a_pair_is_the_mirror_image_that_is_run_on_purpose() -> None:
    both = Sweeps(
        drift=(0.1, 0.2), yaw=(0.2,), attack=(0.1,), pitch=(0.1,), pairs=("drift+5.72958", "yaw+0.2", "pitch+0.1")
    )
    found = {c.name: c for c in conditions(both, with_mirrors("yz"), SPEED, LENGTH)}
    one, other = found["drift+5.72958"], found["drift-5.72958"]
    np.testing.assert_allclose(other.velocity, one.velocity * (1.0, -1.0, 1.0), rtol=1e-12)
    assert (other.half, other.kind, other.grid) == (one.half, one.kind, one.grid)
    np.testing.assert_allclose(found["yaw-0.2"].rates, -found["yaw+0.2"].rates, rtol=1e-12)
    np.testing.assert_allclose(found["pitch-0.1"].rates, -found["pitch+0.1"].rates, rtol=1e-12)
    for pairs, body in ((("drift+9",), "y"), (("straight",), "y"), (("drift+5.72958",), "z")):
        with pytest.raises(InputError) as why:
            conditions(Sweeps(drift=(0.1,), pairs=pairs), with_mirrors(body), SPEED, LENGTH)
        assert why.value.column == "matrix.pairs"
    with pytest.raises(InputError, match="twice"):
        conditions(Sweeps(drift=(0.1,), pairs=("drift+5.72958",) * 2), with_mirrors("y"), SPEED, LENGTH)


def test_names_are_of_folders_and_different() -> None:
    sweeps = Sweeps(
        drift=(0.05, -0.05), attack=(0.05,), yaw=(0.1,), pitch=(-0.1,), speeds=(1.5,), controls={"dr": (0.1, -0.1)},
        combined=((0.05, 0.0, 0.2, 0.0),),
    )  # fmt: skip
    matrix = conditions(sweeps, None, SPEED, LENGTH)
    names = [c.name for c in matrix]
    assert len(set(names)) == len(names) == 10
    assert all(set(name) <= set("abcdefghijklmnopqrstuvwxyz0123456789_.+-") for name in names)
    slower = next(c for c in matrix if c.name == "speed+1.5")
    assert slower.speed == pytest.approx(1.5)
    assert dict(next(c for c in matrix if c.kind is Kind.CONTROL).controls) == {"dr": 0.1}


def test_angles_that_leave_no_speed_ahead() -> None:
    with pytest.raises(InputError, match="leave a speed ahead"):
        conditions(Sweeps(combined=((1.0, 1.0, 0.0, 0.0),)), None, SPEED, LENGTH)


def test_a_study_changes_one_thing_at_a_time() -> None:
    matrix = default_matrix(with_mirrors("yz4"))
    study = Study(("drift+4", "straight"), {"grid": ("coarse", "fine"), "domain": ("1.5",)})
    out = with_studies(matrix, (study,))
    new = out[len(matrix) :]
    assert [c.name for c in new] == [
        "drift+4_grid_coarse", "drift+4_grid_fine", "drift+4_domain_1.5",
        "straight_grid_coarse", "straight_grid_fine", "straight_domain_1.5",
    ]  # fmt: skip
    assert [(c.grid, dict(c.variant)) for c in new[:3]] == [
        ("coarse", {}), ("fine", {}), ("medium", {"domain": "1.5"})
    ]  # fmt: skip
    (spaced,) = with_studies(matrix, (Study(("drift+4",), {"turbulence": ("realizable k-epsilon",)}),))[len(matrix) :]
    assert spaced.name == "drift+4_turbulence_realizable-k-epsilon"
    assert dict(spaced.variant) == {"turbulence": "realizable k-epsilon"}
    assert np.array_equal(new[0].velocity, next(c for c in matrix if c.name == "drift+4").velocity)
    with pytest.raises(InputError, match='"drift\\+5"; expected a condition of the matrix'):
        with_studies(matrix, (Study(("drift+5",), {"grid": ("fine",)}),))
    with pytest.raises(InputError, match="twice"):
        with_studies(matrix, (study, study))


def test_symmetry_is_stated_in_the_place_of_runs() -> None:
    body = with_mirrors("yz4")
    assert symmetries(body) == (PORT_STARBOARD, UP_DOWN, FOURFOLD)
    assert symmetries(None) == ()
    said = " / ".join(stated(body, default_sweeps(body, LENGTH)))
    assert "Zw' = Yv', Mw' = -Nv'" in said
    assert "Zq' = -Yr', Mq' = Nr'" in said
    assert "port-starboard" in said
    assert stated(None, default_sweeps(None, LENGTH)) == ()
    run_both = Sweeps(drift=(0.1,), attack=(0.1,))
    assert not any("fourfold" in s for s in stated(body, run_both))
