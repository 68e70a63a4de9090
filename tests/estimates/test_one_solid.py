"""One solid, two meshes: the union of its parts, and their overlapping shells, repaired, in another unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.creation import box, cylinder
from trimesh.transformations import rotation_matrix

from coeflab.bodies.body import Body
from coeflab.bodies.mirror_planes import mirror_planes
from coeflab.bodies.simplify.source import subject
from coeflab.estimates import Estimates, Water, estimated
from tests.bodies.twelve import Mesh, at, fin, hull, rounded

WATER = Water(998.2, 1.0034e-6, 1.0)
FORBIDDEN = {"Kw", "Nw", "Mv", "Yq", "Kq", "Mp", "Zv", "Yw", "Mr", "Nq", "Zr", "Zp"}  # of port-starboard symmetry


def small_rov(bar: float = 0.03) -> list[Mesh]:
    """Two blocks of foam on a frame of square bars, a pod below, a mast; bars of 30 mm have a quarter of the pod's radius."""
    parts = [at(box((0.7, 0.12, 0.14)), 0.0, y, 0.2) for y in (-0.18, 0.18)]
    parts += [at(box((0.8, bar, bar)), 0.0, y, z) for y in (-0.25, 0.25) for z in (-0.2, 0.1)]
    parts += [at(box((bar, bar, 0.33)), x, y, -0.05) for y in (-0.25, 0.25) for x in (-0.35, 0.35)]
    parts += [at(box((bar, 0.53, bar)), x, 0.0, z) for x in (-0.35, 0.35) for z in (-0.2, 0.1)]
    pod = cylinder(0.06, 0.5, sections=32).apply_transform(rotation_matrix(np.pi / 2.0, [0.0, 1.0, 0.0]))
    parts.append(at(pod, 0.0, 0.0, -0.08))
    return [*parts, at(box((0.06, 0.4, 0.03)), 0.0, 0.0, 0.1), at(box((0.03, 0.03, 0.2)), 0.0, 0.0, 0.02)]


def torpedo() -> list[Mesh]:
    fins = [fin(0.16, 0.014, 0.03, 0.22, -0.7, a) for a in (0.0, 90.0, 180.0, 270.0)]
    return [hull(*rounded(2.0, 0.12, 0.2, 0.5)), *fins]


def both_ways(parts: list[Mesh], folder: Path) -> tuple[Body, Body]:
    """Read as a user does: the union in mm, the shells in m with --repair."""
    united = trimesh.boolean.union(parts, engine="manifold").apply_scale(1000.0)
    united.export(folder / "union.stl")
    trimesh.util.concatenate(parts).export(folder / "shells.stl")
    return subject(str(folder / "union.stl"), "mm", "FLU"), subject(str(folder / "shells.stl"), "m", "FLU", repair=True)


def require_equal(one: Estimates, other: Estimates) -> None:
    """Numbers and half-widths within what single precision leaves."""
    a, b = ({c.symbol: c for c in e.coefficients.coefficients} for e in (one, other))
    assert a.keys() == b.keys()
    for symbol, c in a.items():
        scale = max(abs(c.value or 0.0), c.u95 or 0.0)
        assert b[symbol].value == pytest.approx(c.value, abs=1e-5 * scale), symbol
        assert b[symbol].u95 == pytest.approx(c.u95, abs=1e-5 * scale), symbol


@pytest.mark.parametrize("bar", [0.03, 0.028])
def test_a_frame_is_one_bluff_part_however_it_is_meshed(tmp_path: Path, bar: float) -> None:
    """Bars of exactly a quarter of the largest radius hang on no rounding, and thinner ones are no hull with two fins."""
    found = []
    for body in both_ways(small_rov(bar), tmp_path):
        assert body.shape is not None
        assert mirror_planes(body.shape)[1]
        outline = body.outline
        assert (outline.hulls, outline.foils) == ((), ())
        assert [part.name for part in outline.bluff] == ["body"]
        found.append(estimated(body, WATER))
    require_equal(*found)
    assert not FORBIDDEN & set(found[0].shares)


def test_a_hull_with_fins_stays_one_however_it_is_meshed(tmp_path: Path) -> None:
    found = []
    for body in both_ways(torpedo(), tmp_path):
        assert len(body.outline.hulls) == 1
        names = {foil.name for foil in body.outline.foils}
        assert names == {"foil_upper", "foil_lower", "foil_port", "foil_starboard"}
        found.append(estimated(body, WATER))
    require_equal(*found)
    symbols = set(found[0].shares)
    assert {"Yv", "Nv", "Zw", "Mw", "Kp"} <= symbols
    assert not (FORBIDDEN | {"Z0", "M0", "Kv", "Yp", "Kr", "Np"}) & symbols  # two planes


def test_a_frame_is_between_shielded_and_not(tmp_path: Path) -> None:
    """Drag ahead: 1.05 on the mean of the silhouette and of half the faces' sum; U95 reaches both."""
    body, _ = both_ways(small_rov(), tmp_path)
    (part,) = body.outline.bluff
    assert part.areas == pytest.approx([0.0962, 0.2255, 0.2975], rel=2e-3)
    assert part.in_the_open == pytest.approx([0.1526, 0.3859, 0.3999], rel=2e-3)
    assert body.configurations[0].projected_areas == pytest.approx(part.areas)
    drag = next(c for c in estimated(body, WATER).coefficients.coefficients if c.symbol == "Xu|u|")
    assert drag.value == pytest.approx(-1.05 * (0.0962 + 0.1526) / 2.0 / 0.8**2, rel=5e-3)
    assert drag.u95 is not None
    assert drag.value is not None
    for area in (part.areas[0], part.in_the_open[0]):
        assert abs(-1.05 * area / 0.8**2 - drag.value) < drag.u95
