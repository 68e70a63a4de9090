"""``coeflab added-mass`` as a real process."""

from __future__ import annotations

import json
from collections.abc import Callable
from subprocess import CompletedProcess

import numpy as np
import pytest

Run = Callable[..., CompletedProcess[str]]


def test_suboff_shows_the_gap(coeflab: Run) -> None:
    done = coeflab("added-mass", "suboff_bare_hull")
    assert done.returncode == 0
    assert done.stderr == ""
    for words in ("5.9883", "5.9195", "0.699211", "+28.4 to +28.5 %", "+36.1 to +36.2 %", "+30.4 %", "-0.01327?"):
        assert words in done.stdout
    assert "primed by LBP 4.26086 m" in done.stdout
    assert "primitives: not used" in done.stdout


def test_json_holds_matrices(coeflab: Run) -> None:
    done = coeflab("added-mass", "huuv", "--json", "--density", "1025")
    found = json.loads(done.stdout)
    assert set(found) == {"ellipsoid", "primitives", "primitives:lamb"}
    matrix = np.array(found["primitives"])
    assert matrix.shape == (6, 6)
    assert matrix[1, 1] == pytest.approx(1025.0 * np.pi * (0.07**2 * 1.2 + 0.02**2 * 0.3), rel=1e-12)


def test_one_method(coeflab: Run) -> None:
    done = coeflab("added-mass", "spheroid_example", "--method", "strip:lamb", "--json")
    assert list(json.loads(done.stdout)) == ["strip:lamb"]


def test_help_has_an_example(coeflab: Run) -> None:
    assert "Example: coeflab added-mass" in coeflab("added-mass", "--help").stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("suboff",), "a body of particulars without a shape"),
        (("huuv", "--method", "panle"), "no added-mass method is called"),
    ],
)
def test_wrong_input(coeflab: Run, arguments: tuple[str, ...], said: str) -> None:
    done = coeflab("added-mass", *arguments)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""
