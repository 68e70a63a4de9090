"""The panel method on bodies with a known answer, and the bodies that it must refuse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.bodies.added_mass import panel
from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.closed_forms.parts import plate_added_mass
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.structured_surface import box_surface
from coeflab.bodies.panel_solver.panels import slivers
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts, Shape
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.law.added_mass import AddedMass
from tests.bodies.test_mesh_family import rod

RHO = 1000.0
STRAIGHT = np.eye(3)
# Decimated meshes differ by chance, and estimates from their differences by a factor of two or three from mesh to mesh:
# no bound on them follows from theory. A tenth of the entry is what still serves who must choose between methods.
OF_USE = 0.1


def body(shape: Shape, point: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Body:
    hull = read_body(shipped("geometry") / "spheroid_example" / "body.toml")
    return replace(hull, shape=shape, reference_point=np.array(point))


def part(form: Form, x: float = 0.0, name: str = "p") -> Part:
    return Part(name, form, np.array([x, 0.0, 0.0]), STRAIGHT)


def solved(form: Form, **options: object) -> AddedMass:
    return panel.added_mass(body(Parts((part(form),))), RHO, options)


def held(found: AddedMass, exact: np.ndarray) -> bool:
    return bool(np.all(np.abs(found.matrix - exact) <= found.error))


def test_a_sphere() -> None:
    found = solved(Ellipsoid(0.5, 0.5, 0.5), panels=4000)
    assert np.diag(found.matrix)[:3] == pytest.approx(0.5 * RHO * np.pi / 6.0, rel=1e-3)
    assert not np.any(found.matrix[3:])
    assert held(found, ellipsoid_added_mass(np.full(3, 0.5), RHO))
    assert found.statements[-1] == "set to zero, below its error: p, q, r"
    assert found.verdict == "symmetric, positive semidefinite"


@pytest.mark.slow
@pytest.mark.parametrize("kernel", ["numpy", "numba"])
def test_a_slender_spheroid_is_lambs_within_a_thousandth(kernel: str) -> None:
    exact = ellipsoid_added_mass(np.array([6.0, 1.0, 1.0]), RHO)
    found = solved(Ellipsoid(6.0, 1.0, 1.0), panels=8000, kernel=kernel)
    assert np.diag(found.matrix) == pytest.approx(np.diag(exact), rel=1e-3)
    assert held(found, exact)
    assert f"({kernel})" in found.statements[0]
    assert "extrapolated with order 2" in found.statements[2]


@pytest.mark.parametrize(
    "axes", [(2.0, 1.0, 1.0), (1.0, 2.0, 2.0), (0.3, 1.0, 1.0), (3.0, 2.0, 1.0), (1.0, 0.5, 3.0), (10.0, 1.0, 1.0)]
)
@pytest.mark.parametrize("panels", [2000, 4000])
def test_the_error_estimate_holds_the_error(axes: tuple[float, float, float], panels: int) -> None:
    found = solved(Ellipsoid(*axes), panels=panels, kernel="numpy")
    assert held(found, ellipsoid_added_mass(np.array(axes), RHO))
    # Two meshes carry Roache's factor 3 where three carry half of it or less.
    widest = 0.15 if "from two meshes" in found.statements[2] else 0.08
    assert np.all(np.diag(found.error)[:3] < widest * np.diag(found.matrix)[:3])


@pytest.mark.parametrize("axes", [(1.0, 3.0, 0.5), (5.0, 1.0, 0.3)])
def test_two_coarse_meshes_do_not_understate_their_error(axes: tuple[float, float, float]) -> None:
    """Half of what is asked for here left an entry of turning outside its estimate."""
    found = solved(Ellipsoid(*axes), panels=1500, kernel="numpy")
    assert "from two meshes, order not observed" in " ".join(found.statements)
    assert held(found, ellipsoid_added_mass(np.array(axes), RHO))


def test_a_body_with_edges_says_that_it_converges_slowly() -> None:
    """A cube: polarisability -1.6383 (Sihvola et al. 2004)."""
    found = solved(Box(1.0, 1.0, 1.0), panels=4000)
    assert "the error does not fall as the square of the panels' size" in found.statements[2]
    assert np.diag(found.matrix)[:3] == pytest.approx(638.3, rel=0.01)
    assert abs(found.matrix[0, 0] - 638.3) < found.error[0, 0]


@pytest.mark.slow
def test_a_flat_ended_cylinder() -> None:
    """Length five diameters; 0.877 across and 0.127 along were computed once with another panel code, to a per cent."""
    found = solved(Cylinder(0.5, 5.0), panels=8000)
    mass = RHO * np.pi * 0.25 * 5.0
    assert found.error is not None
    assert np.diag(found.matrix)[:3] / mass == pytest.approx([0.127, 0.877, 0.877], rel=0.01)
    assert found.matrix[1, 1] / mass == pytest.approx(0.877, rel=0.005)
    assert np.all(np.diag(found.error)[:3] < 0.03 * np.diag(found.matrix)[:3])


def test_two_spheres_far_apart_add_up_about_any_point() -> None:
    shape = Parts((part(Ellipsoid(1.0, 1.0, 1.0), 20.0, "a"), part(Ellipsoid(1.0, 1.0, 1.0), -20.0, "b")))
    found = panel.added_mass(body(shape, (0.0, 0.0, 3.0)), RHO, {"panels": 4000})
    mass = 2.0 * RHO * 2.0 * np.pi / 3.0
    assert np.diag(found.matrix) / mass == pytest.approx([1.0, 1.0, 1.0, 9.0, 409.0, 400.0], rel=2e-3)
    assert found.matrix[0, 4] / mass == pytest.approx(-3.0, rel=2e-3)
    assert found.matrix[1, 3] / mass == pytest.approx(3.0, rel=2e-3)


def test_suboff_lies_between_strip_and_measurement_and_is_not_tuned() -> None:
    """Sections with Lamb's end correction give -0.0171 and Roddy measured -0.0133."""
    hull = read_body(shipped("geometry") / "suboff_bare_hull" / "body.toml")
    found = panel.added_mass(hull, RHO)
    assert found.primed("Yvdot", hull.scaling, RHO) == pytest.approx(-0.01688, abs=3e-5)
    assert found.primed("Zwdot", hull.scaling, RHO) == pytest.approx(-0.01688, abs=3e-5)
    assert found.primed("Nrdot", hull.scaling, RHO) == pytest.approx(-0.000849, abs=3e-6)
    assert found.primed("Xudot", hull.scaling, RHO) == pytest.approx(-0.000675, abs=3e-6)


def test_facets_of_a_coarse_mesh_are_divided() -> None:
    """Twelve triangles of a cube are as good as many."""
    vertices = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    mesh = TriangleMesh(vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    found = panel.added_mass(body(mesh), RHO, {"panels": 3000})
    assert abs(found.about(np.full(3, 0.5)).matrix[0, 0] - 638.3) < found.error[0, 0]


def bracket(outer: np.ndarray, volume: float, mesh: TriangleMesh, inner: float) -> tuple[np.ndarray, np.ndarray]:
    """Least and most added mass along x, y, z of a body that lies within another and holds that one shrunk to ``inner``.

    Added mass and displaced mass together grow with the body (the polarisation tensor of an insulating inclusion is
    monotone in the inclusion: Ammari & Kang, Polarization and Moment Tensors, 2007).
    """
    own = RHO * mesh.volume
    return inner**3 * (outer + RHO * volume) - own, outer + RHO * volume - own


@pytest.mark.slow
def test_a_cylinder_of_cad_lies_between_two_cylinders() -> None:
    """64 facets from end to end hold a cylinder smaller by cos(pi / 64), and lie within the round one."""
    mesh, whole = rod(64, 5.0), solved(Cylinder(0.5, 5.0), panels=8000)
    found = panel.added_mass(body(mesh), RHO, {"panels": 3000}).about(mesh.centre_of_volume)
    assert found.error is not None
    assert whole.error is not None
    outer, doubt, ours = (np.diag(m)[:3] for m in (whole.matrix, whole.error, found.matrix))
    low, high = bracket(outer, 1.25 * np.pi, mesh, float(np.cos(np.pi / 64.0)))
    own = np.diag(found.error)[:3]
    assert np.all((high - low) < 0.04 * outer)
    assert np.all((low - doubt - own <= ours) & (ours <= high + doubt + own))
    assert np.all(np.abs(ours - outer) <= own + doubt)
    assert np.all(own < 0.025 * ours)
    assert "extrapolated with order 1.3" in found.statements[2]


@pytest.mark.slow
@pytest.mark.parametrize("facets", [64, 256, 300])
def test_needles_of_cad_do_not_fold(facets: int) -> None:
    """Caps of one long triangle a facet: decimation once turned some over, and surge was lost in an estimate of ten times its size."""
    mesh = rod(facets, 5.0)
    found = panel.added_mass(body(mesh), RHO, {"panels": 3000}).about(mesh.centre_of_volume)
    round_one = np.array([0.127, 0.877, 0.877]) * RHO * 1.25 * np.pi
    ours = np.diag(found.matrix)[:3]
    assert found.error is not None
    assert ours == pytest.approx(round_one, rel=0.04)
    assert np.all(np.diag(found.error)[:3] < OF_USE * ours)


@pytest.mark.slow
def test_of_ten_thinned_cylinders_nine_estimates_hold_surge() -> None:
    """Surge of a blunt body hangs on its edges, and thinning takes volume there while it makes panels larger."""
    whole = solved(Cylinder(0.5, 5.0), panels=10_000)
    assert whole.error is not None
    held_ones = 0
    for facets in (180, 200, 220, 240, 256, 272, 288, 300, 320, 350):
        mesh = rod(facets, 5.0)
        found = panel.added_mass(body(mesh), RHO, {"panels": 1500, "kernel": "numpy"}).about(mesh.centre_of_volume)
        assert found.error is not None
        own = np.diag(found.error)[:3]
        assert np.all(own[1:] < OF_USE * np.diag(found.matrix)[1:3])
        held_ones += bool(abs(found.matrix[0, 0] - whole.matrix[0, 0]) <= own[0] + whole.error[0, 0] / 3.0)
    assert held_ones >= 9


@pytest.mark.slow
def test_with_edges_the_estimate_falls_as_theory_says() -> None:
    """Order 4/3: four times as many panels leave 0.4 of the error, and the facets' own share stays."""
    mesh = rod(256, 5.0)
    coarse, fine = (panel.added_mass(body(mesh), RHO, {"panels": n}).about(mesh.centre_of_volume) for n in (1000, 4000))
    assert coarse.error is not None
    assert fine.error is not None
    assert np.all(np.diag(fine.error)[1:3] < 0.4 * np.diag(coarse.error)[1:3])
    assert np.all(np.abs(np.diag(fine.matrix) - np.diag(coarse.matrix))[:3] <= np.diag(coarse.error)[:3])


@pytest.mark.parametrize("panels", [2000, 4000])
def test_a_stretched_mesh_of_a_spheroid_holds_lamb(panels: int) -> None:
    """Triangles six times as long as wide; the facets lie inside the spheroid and lack 0.4 % of its volume.

    No refinement of them can know: the estimate must carry it, and Lamb's values lie within, without an allowance.
    """
    ball = meshed(Parts((part(Ellipsoid(1.0, 1.0, 1.0)),)), 5000)
    mesh = TriangleMesh(ball.vertices * np.array([6.0, 1.0, 1.0]), ball.faces)
    corner = ball.vertices[ball.faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    inner = float(np.min(np.einsum("ij,ij->i", normal, corner[:, 0]) / np.linalg.norm(normal, axis=1)))
    exact = np.diag(ellipsoid_added_mass(np.array([6.0, 1.0, 1.0]), RHO))
    found = panel.added_mass(body(mesh), RHO, {"panels": panels})
    assert found.error is not None
    ours, own = np.diag(found.matrix), np.diag(found.error)
    assert np.all(np.abs(ours - exact) <= own)
    low, high = bracket(exact[:3], 8.0 * np.pi, mesh, inner)
    assert np.all((low <= ours[:3]) & (ours[:3] <= high))
    missing = 1.0 - mesh.volume / (8.0 * np.pi)
    assert np.all(ours[:3] < exact[:3])
    assert np.all(own[:3] >= 1.9 * missing * exact[:3])
    assert np.all(own[1:3] < 0.02 * exact[1:3])
    assert own[0] < (0.02 if panels == 4000 else OF_USE) * exact[0]


def test_one_mesh_has_no_error_estimate() -> None:
    found = solved(Ellipsoid(2.0, 1.0, 1.0), panels=1000, extrapolate="no")
    assert found.error is None
    assert found.statements[2] == "one mesh: its error is unknown"


def test_panels_of_which_no_coarser_mesh_comes_are_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = panel.family
    monkeypatch.setattr(panel, "family", lambda shape, count, most: whole(shape, count, 1 if count < 1500 else most))
    found = solved(Ellipsoid(2.0, 1.0, 1.0), panels=1000)
    assert found.error is not None
    assert np.all(
        np.abs(np.diag(found.matrix) - np.diag(ellipsoid_added_mass(np.array([2.0, 1.0, 1.0]), RHO)))
        <= np.diag(found.error)
    )


def test_what_did_not_converge_is_a_rough_guide(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = panel.panel_added_mass
    monkeypatch.setattr(panel, "panel_added_mass", lambda *given: replace(whole(*given), converged=False))
    found = solved(Ellipsoid(2.0, 1.0, 1.0), panels=1000, extrapolate="no")
    assert found.rough
    assert any("NOT CONVERGED" in said for said in found.statements)


def test_errors_grow_with_the_distance_of_the_point() -> None:
    found = solved(Ellipsoid(2.0, 1.0, 1.0), panels=2000)
    away = found.about(np.array([10.0, 0.0, 0.0]))
    assert np.all(away.error >= found.error * (1.0 - 1e-12))
    assert away.error[5, 5] >= 100.0 * found.error[1, 1]


def refused(shape: Shape, **options: object) -> InputError:
    with pytest.raises(InputError) as caught:
        panel.added_mass(body(shape), RHO, options)
    return caught.value


def block(*sides: float) -> TriangleMesh:
    return TriangleMesh(*box_surface(np.array(sides), 300))


def test_an_open_mesh_is_refused() -> None:
    whole = block(1.0, 1.0, 1.0)
    found = refused(TriangleMesh(whole.vertices, whole.faces[1:]))
    assert found.found == "3 edges that are not shared by two faces wound alike"
    turned = whole.faces.copy()
    turned[0] = turned[0, ::-1]
    assert refused(TriangleMesh(whole.vertices, turned)).found.startswith("3 edges")


def test_a_face_without_area_is_refused() -> None:
    whole = block(1.0, 1.0, 1.0)
    found = refused(TriangleMesh(whole.vertices, np.concatenate([whole.faces, [[0, 1, 1]]])))
    assert found.found == "1 faces without area"


@pytest.mark.parametrize("shape", [block(1.0, 1.0, 0.02), Parts((part(Box(1.0, 0.5, 0.01)),))])
def test_a_thin_body_is_sent_to_the_plate_formulas(shape: Shape) -> None:
    found = refused(shape)
    assert "smallest side is 0.02 of the next" in found.found
    assert "primitives" in found.advice


THIN_BOX = Parts((part(Box(3.0, 1.0, 0.055)),))


def test_panels_larger_than_the_thickness_are_refused_where_there_may_be_no_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(panel, "MOST_PANELS", 1000)
    assert refused(THIN_BOX, panels=1000).found.startswith("a body thinner than its panels are large on ")


def test_panels_are_raised_until_they_are_smaller_than_the_body_is_thin() -> None:
    """Along its normal a box moves little less than the plate of its sides; with one and a half times its edges, little more."""
    found = panel.added_mass(body(THIN_BOX), RHO, {"panels": 1000, "kernel": "numpy"})
    assert int(found.statements[0].split()[0].replace(",", "")) > 1500
    plate = plate_added_mass(3.0, 1.0, RHO)[2, 2]
    assert plate - found.error[2, 2] < found.matrix[2, 2] < 1.15 * plate


def test_parts_that_touch_in_a_point_are_solved() -> None:
    """Two spheres at the ends of a rod; uniting them can leave a face without area where pole meets pole."""
    ball, rod_between = Ellipsoid(1.0, 1.0, 1.0), Cylinder(0.2, 2.0)
    shape = Parts((part(ball, 2.0, "fore"), part(ball, -2.0, "aft"), part(rod_between, 0.0, "rod")))
    assert np.any(slivers(meshed(shape, 6000).vertices[meshed(shape, 6000).faces]))
    found = panel.added_mass(body(shape), RHO, {"panels": 6000})
    alone = 2.0 * RHO * 2.0 * np.pi / 3.0
    assert alone < found.matrix[1, 1] < 1.2 * alone
    assert 0.9 * alone < found.matrix[0, 0] < alone


def test_more_panels_than_memory_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel, "memory_needed", lambda count: count * 2**40)
    found = refused(Parts((part(Ellipsoid(1.0, 1.0, 1.0)),)), panels=1000)
    assert "GiB of this machine" in found.expected
    assert "fewer" in found.advice


def test_numba_that_is_not_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert "numba" in refused(Parts((part(Ellipsoid(1.0, 1.0, 1.0)),)), panels=1000, kernel="numba").found
    assert "plain (numpy)" in solved(Ellipsoid(1.0, 1.0, 1.0), panels=6000).statements[0]


@pytest.mark.parametrize("options", [{"panels": 100}, {"panels": 40_000}, {"kernel": "cuda"}, {"extrapolate": "maybe"}])
def test_options_are_bounded(options: dict[str, object]) -> None:
    refused(Parts((part(Ellipsoid(1.0, 1.0, 1.0)),)), **options)
