"""Edges that a mesh keeps, planes across which it is mirrored, and layers on what carries lift."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.law.scaling import Conditions
from coeflab.tank.openfoam.features import edges, features, foils, lies_in
from coeflab.tank.openfoam.layers import THICKEST, boundary_layer, layers, wall_unit
from coeflab.tank.openfoam.mesh_report import MeshReport, findings
from coeflab.tank.openfoam.mesh_sizes import MeshKeys, mesh_sizes
from coeflab.tank.openfoam.mirroring import images, mirrored_axes, sides
from coeflab.tank.test_matrix import Half
from coeflab.tank.towed_body import TowedBody, towed
from tests.tank.towed_bodies import X_FINS

WATER = Conditions(density=998.2, speed=2.0, viscosity=1.0034e-6)


def body_of(name: str, panels: int = 20_000) -> TowedBody:
    return towed(read_body(shipped("geometry") / name / "body.toml"), np.zeros(3), panels=panels)


@pytest.fixture(scope="module")
def plane() -> TowedBody:
    return body_of("naca0020_plane")


@pytest.fixture(scope="module")
def x_fins(tmp_path_factory: pytest.TempPathFactory) -> TowedBody:
    folder = tmp_path_factory.mktemp("x_fins")
    (folder / "body.toml").write_text(X_FINS)
    return towed(read_body(folder / "body.toml"), np.zeros(3), panels=8000)


def length(ends: np.ndarray) -> float:
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


def test_edges_of_a_plane_are_its_trailing_edge_and_its_tips(plane: TowedBody) -> None:
    """With its image: twice 0.44251 ft of trailing edge, and about twice both sides of a tip's chord of 0.5 ft."""
    found = edges(plane).ends
    aft = np.abs(found[:, :, 0] - plane.vertices[:, 0].min()).max(axis=1) < 1e-6
    assert length(found[aft]) == pytest.approx(2 * 0.44251 * 0.3048, rel=0.02)
    tips = np.abs(np.abs(found[:, :, 2]) - 0.44251 * 0.3048).max(axis=1) < 1e-6
    assert length(found[tips & ~aft]) == pytest.approx(4 * 0.5 * 0.3048, rel=0.05)


def test_a_smooth_hull_has_no_edges_and_is_not_mirrored() -> None:
    hull = body_of("suboff_bare_hull")
    assert foils(hull) == frozenset()
    assert not features(hull, hull.vertices.min(0) - 1.0, hull.vertices.max(0) + 1.0)
    assert mirrored_axes(hull, Half.WHOLE) == ()


def test_edges_of_an_appendage_are_its_own_also_where_it_stands_on_the_hull() -> None:
    body = body_of("suboff_aff8")
    assert foils(body) == {"sail", "fins"}
    far = np.full(3, 9.0)
    found = features(body, -far, far)
    assert set(found) == {"sail", "fins"}
    foot = np.abs(np.hypot(found["sail"][..., 1], found["sail"][..., 2]) - 0.254).max(axis=1) < 2e-3
    assert length(found["sail"][foot]) > 2 * 0.368  # both sides of its chord on the hull
    upper = features(body, -far, np.array([9.0, 9.0, 0.0]))["fins"]
    assert upper[..., 2].max() <= 1e-5
    assert length(upper) == pytest.approx(length(found["fins"]) / 2.0, rel=0.1)


def test_a_mesh_is_mirrored_unless_a_trailing_edge_lies_in_the_plane(plane: TowedBody, x_fins: TowedBody) -> None:
    assert lies_in(plane, 1)
    assert mirrored_axes(plane, Half.UPPER) == ()
    assert plane.mirrors[1]
    assert mirrored_axes(x_fins, Half.WHOLE) == (1, 2)
    assert mirrored_axes(x_fins, Half.UPPER) == (1,)
    rudders = body_of("finned_spheroid", 6000)
    assert mirrored_axes(rudders, Half.WHOLE) == (2,)
    assert mirrored_axes(rudders, Half.UPPER) == ()
    one_patch = replace(x_fins, patches=("hull",), patch=np.zeros(len(x_fins.faces), np.int64), chord={"hull": 2.0})
    assert mirrored_axes(one_patch, Half.WHOLE) == (1, 2)


def test_the_image_of_a_patch_gets_its_own_name(x_fins: TowedBody) -> None:
    """Fins 1 to 4 lie below starboard, below port, above port, above starboard; the mesh begins above port."""
    found = images(x_fins, Half.WHOLE, (1, 2))
    assert found[1] == (("f3", "f4"),)
    assert sorted(found[2]) == [("f3", "f2"), ("f4", "f1")]
    assert images(x_fins, Half.UPPER, (1,)) == {1: (("f3", "f4"),)}


def test_a_fin_without_its_image_on_the_other_side_is_meshed_whole(x_fins: TowedBody) -> None:
    own = np.unique(x_fins.faces[x_fins.patch == x_fins.patches.index("f2")])
    vertices = x_fins.vertices.copy()
    vertices[own, 0] += 0.3
    moved = replace(x_fins, vertices=vertices)
    assert set(sides(moved, 1).alone) == {"f1"}
    assert mirrored_axes(moved, Half.WHOLE) == ()


def test_layers_of_foils_are_as_thick_as_their_boundary_layer() -> None:
    """SUBOFF at 2 m/s: eight on the sail, five on the planes, as found by hand on cells of 4.95 and 2.48 mm."""
    body = body_of("suboff_aff8")
    sizes = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(cells_per_length=220.0, cells_per_chord=60.0), WATER)
    assert {p: sizes.layers[p].count for p in ("sail", "fins")} == {"sail": 8, "fins": 5}
    for patch in ("sail", "fins"):
        made, chord = sizes.layers[patch], body.chord[patch]
        total = made.first * (made.growth**made.count - 1.0) / (made.growth - 1.0)
        assert 0.6 < total / boundary_layer(2.0, chord, 1.0034e-6) < THICKEST
        assert made.first / wall_unit(2.0, chord, 1.0034e-6) == pytest.approx(60.0)
        assert made.last * sizes.edge(patch) / made.growth ** (made.count - 1) == pytest.approx(made.first)


@pytest.mark.parametrize("edge", [1e-4, 1e-3, 1e-2])
def test_a_foil_is_never_without_layers(plane: TowedBody, edge: float) -> None:
    for y_plus in (None, 5.0, 300.0):
        made = layers(plane, "plane", edge, "functions", y_plus, WATER)
        assert made.count >= 3
        assert made.last <= 0.5


def test_boundary_layer_of_a_plate() -> None:
    """Prandtl: .37 m Re^-1/5 at 1 m; Re 1e5 gives .037 m."""
    assert boundary_layer(1.0, 1.0, 1e-5) == pytest.approx(0.037)


def test_the_wake_of_a_sail_is_refined_to_the_tail() -> None:
    body = body_of("suboff_aff8")
    sizes = mesh_sizes(body, 1.0, Half.WHOLE, MeshKeys(), WATER)
    far = {r.name: r for r in sizes.regions}["sail_1_far"]
    assert far.level == sizes.levels["hull"]
    assert far.low[0] == pytest.approx(body.vertices[:, 0].min())
    assert far.high[2] > -0.2
    assert far.low[1] < -0.2 < 0.2 < far.high[1]
    assert not any("fins" in r.name and "far" in r.name for r in sizes.regions)


def test_what_is_found_of_a_mesh() -> None:
    made = MeshReport(
        9, {"hull": 0.94, "sail": 0.94}, {"hull": 1.0, "sail": 0.975}, 1.0, 60.0, 4.4,
        ("Max skewness = 4.38, 40 highly skew faces detected which may impair", "Concave cells found"),
    )  # fmt: skip
    planned = {"coverage": {"hull": 0.95, "sail": 0.9}, "layers": {"hull": 7, "sail": 2}}
    found = findings(made, planned)
    assert [(f.code, f.subject, f.severity) for f in found] == [
        ("tow.layers", "hull", Severity.WARN), ("tow.few_layers", "sail", Severity.NOTE),
        ("tow.surface", "sail", Severity.WARN), ("tow.skew", "mesh", Severity.WARN),
        ("tow.check_mesh", "mesh", Severity.NOTE),
    ]  # fmt: skip
    assert found[3]["faces"] == 40
    assert (found[2].statistic, found[3].statistic) == (0.975, 4.38)
    assert Path("cells.sail").name == found[2].advice
