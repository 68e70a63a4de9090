from __future__ import annotations

import itertools

import numpy as np
import pytest

from coeflab.core.axes import ANGLE_SIGNS, DIRECTIONS, FRAMES, angle_sign, parse_axes
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


@pytest.mark.parametrize("declared", [None, "frd", "", 3, ["forward"], ["forward", "port", "sky"], {}, ["x", "y", "z"]])
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
