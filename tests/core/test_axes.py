from __future__ import annotations

import itertools
from itertools import permutations
from typing import Any

import numpy as np
import pytest

from coeflab.core.axes import ANGLE_SIGNS, DIRECTIONS, FRAMES, angle_sign, axes_of, parse_axes
from coeflab.core.errors import AxesError
from coeflab.law.symbols import COMPONENTS, MOTIONS


def test_every_triad_is_right_handed_or_refused() -> None:
    """48 signed permutations: half of them right-handed, and each matches the cross product of its directions."""
    good = bad = 0
    for triple in itertools.product(DIRECTIONS, repeat=3):
        x, y, z = (np.array(DIRECTIONS[d]) for d in triple)
        if abs(np.dot(np.cross(x, y), z)) < 0.5:
            with pytest.raises(AxesError, match="right angles"):
                parse_axes(list(triple))
        elif np.allclose(np.cross(x, y), z):
            good += 1
            rotation = parse_axes(list(triple)).rotation
            assert np.linalg.det(rotation) == pytest.approx(1.0)
            np.testing.assert_array_equal(rotation @ [1.0, 0.0, 0.0], x)
            np.testing.assert_array_equal(rotation @ [0.0, 0.0, 1.0], z)
        else:
            bad += 1
            with pytest.raises(AxesError, match=r"left-handed axes.*usually mean FLU \(forward, port, up\)"):
                parse_axes(list(triple), "c.toml")
    assert (good, bad) == (24, 24)


@pytest.mark.parametrize(("frame", "point"), [("FRD", (1, 2, 3)), ("FLU", (1, -2, -3)), ("CFD", (-1, 2, -3))])
def test_named_frames(frame: str, point: tuple[float, ...]) -> None:
    axes = parse_axes(frame)
    assert axes.name == frame
    np.testing.assert_array_equal(axes.rotation @ [1.0, 2.0, 3.0], point)
    assert parse_axes(list(FRAMES[frame])) == axes


def test_flu_parity_of_derivatives_by_brute_force() -> None:
    """conventions.md: Yv Nv Yr Nr Zw Mw keep their sign from FRD to FLU, Kv Yp and Z0 M0 flip."""
    rotation = parse_axes("FLU").rotation
    six = np.zeros((6, 6))
    six[:3, :3] = six[3:, 3:] = rotation
    rng = np.random.default_rng(1)
    frd = rng.normal(size=(6, 6))
    flu = np.empty((6, 6))
    for j in range(6):
        nu = np.zeros(6)
        nu[j] = 1.0
        flu[:, j] = six.T @ (frd @ (six @ nu))
    flips = {"Y", "Z", "M", "N", "v", "w", "q", "r"}
    for i, component in enumerate(COMPONENTS):
        for j, motion in enumerate(MOTIONS):
            sign = -1.0 if ((component in flips) + (motion in flips)) % 2 else 1.0
            assert flu[i, j] == pytest.approx(sign * frd[i, j], rel=1e-15), component + motion

    def ratio(symbol: str) -> float:
        i, j = COMPONENTS.index(symbol[0]), MOTIONS.index(symbol[1])
        return float(flu[i, j] / frd[i, j])

    for symbol in ("Yv", "Nv", "Yr", "Nr", "Zw", "Mw", "Xu", "Kp"):
        assert ratio(symbol) == pytest.approx(1.0)
    for symbol in ("Kv", "Yp"):
        assert ratio(symbol) == pytest.approx(-1.0)
    rest = six.T @ np.array([0.0, 0.0, 1.0, 0.0, 1.0, 0.0])
    np.testing.assert_array_equal(rest, [0.0, 0.0, -1.0, 0.0, -1.0, 0.0])


@pytest.mark.parametrize(
    "declared", [None, "frx", "forward,port", "", 3, ["forward"], ["forward", "port", "sky"], {}, ["x", "y", "z"]]
)
def test_unknown_frames(declared: object) -> None:
    with pytest.raises(AxesError, match=r'c.toml, "axes.frame": found .*expected "FRD", "FLU", "CFD"'):
        parse_axes(declared, "c.toml")


def test_angle_signs_are_words() -> None:
    for name, formulas in ANGLE_SIGNS.items():
        assert sorted(formulas.values()) == [-1.0, 1.0]
        for text, sign in formulas.items():
            assert angle_sign(name, text) == sign
            assert angle_sign(name, f"  {text.replace(' ', '  ')} ") == sign
            assert ("+" in text) == (sign > 0.0)
    with pytest.raises(AxesError, match=r"no declared sign.*two signs in the literature"):
        angle_sign("beta", None, "c.toml")
    with pytest.raises(AxesError, match='found "v = U sin'):
        angle_sign("beta", "v = U sin(beta)")
    with pytest.raises(AxesError):
        angle_sign("alpha", "v = +U sin(beta)")


def spellings(directions: tuple[str, str, str]) -> list[Any]:
    """As TOML, options, forms and coeflab's own words have them."""
    x, y, z = directions
    return [
        list(directions), directions, f"{x},{y},{z}", f"{x}, {y}, {z}", f"{x} {y} {z}", f"['{x}', \"{y}\", {z}]",
        f"x {x}, y {y}, z {z}", f"{x};{y};{z}".upper(),
    ]  # fmt: skip


@pytest.mark.parametrize("directions", list(permutations(DIRECTIONS, 3)))
def test_every_spelling_is_read_alike_and_what_is_declared_is_read_again(directions: tuple[str, str, str]) -> None:
    matrix = np.array([DIRECTIONS[d] for d in directions]).T
    right = np.isclose(np.linalg.det(matrix), 1.0)
    for said in spellings(directions):
        if not right:
            with pytest.raises(AxesError):
                parse_axes(said)
            continue
        found = parse_axes(said)
        assert found.directions == directions
        assert found.spelled
        assert np.array_equal(found.rotation, matrix)
        for again in (found.declared, found.typed, found.name):
            assert parse_axes(again) == found
        assert axes_of(found.rotation) == found


def test_the_24_right_handed_triads_are_read() -> None:
    right = [d for d in permutations(DIRECTIONS, 3) if np.linalg.det([DIRECTIONS[k] for k in d]) > 0.5]
    assert len({parse_axes(list(d)) for d in right}) == 24


@pytest.mark.parametrize("name", list(FRAMES))
def test_a_frame_stays_named(name: str) -> None:
    for said in (name, name.lower(), f" {name} "):
        assert parse_axes(said).declared == name
        assert not parse_axes(said).spelled
