"""``coeflab draw`` and ``coeflab mass``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run


def places(folder: Path) -> set[str]:
    """Paths that stand alone on their line, as long as they are."""
    return {str(folder / f"myring_auv.{form}") for form in ("svg", "png")}


def test_draw_writes_three_views_and_says_what_estimates_see(coeflab: Run, tmp_path: Path) -> None:
    out = coeflab("draw", "myring_auv", "--out", str(tmp_path))
    assert out.returncode == 0, out.stderr
    assert max(len(line) for line in out.stdout.splitlines() if line.strip() not in places(tmp_path)) <= 80
    assert "rudder_upper" in out.stdout
    svg = (tmp_path / "myring_auv.svg").read_text(encoding="utf-8")
    for said in ("centre of gravity", "hinge", "thruster", "1.6 m", "0.32 m", "0.36 m", "side, from starboard"):
        assert said in svg
    assert (tmp_path / "myring_auv.png").read_bytes().startswith(b"\x89PNG")
    again = coeflab("draw", "myring_auv", "--out", str(tmp_path))
    assert again.stdout.count("unchanged") == 2
    (tmp_path / "myring_auv.svg").write_text("mine")
    assert coeflab("draw", "myring_auv", "--out", str(tmp_path)).returncode == 2
    assert (tmp_path / "myring_auv.svg").read_text() == "mine"


def test_mass_as_table_and_json(coeflab: Run) -> None:
    out = coeflab("mass", "myring_auv")
    assert out.returncode == 0, out.stderr
    assert "neutral" in out.stdout
    assert max(map(len, out.stdout.splitlines())) <= 80
    found = json.loads(coeflab("mass", "myring_auv", "--json").stdout)
    shell = found["parts"][0]
    assert shell["name"] == "shell"
    assert shell["density"] == pytest.approx(1900.0)
    assert found["mass"]["value"] == pytest.approx(sum(p["mass"] for p in found["parts"]))
    assert found["trim"]["roll"] == pytest.approx(0.0, abs=1e-6)


def test_bodies_without_shape_or_masses(coeflab: Run, tmp_path: Path) -> None:
    out = coeflab("mass", "suboff_bare_hull")
    assert out.returncode == 2
    assert "[[mass]]" in out.stderr
    out = coeflab("draw", "suboff", "--out", str(tmp_path))
    assert out.returncode == 2
    assert not list(tmp_path.iterdir())
