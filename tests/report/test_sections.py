"""Sections for the expert reader, and scenes: data quality, axes, bodies and surfaces in space."""

from __future__ import annotations

import base64
import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Box, Cylinder, Part, Parts
from coeflab.core.files import shipped
from coeflab.core.provenance import Source
from coeflab.fits import FITS
from coeflab.report.figures.axes import AXES, axes_figures
from coeflab.report.figures.hull_scene import FACES, Mark, _even, hull_scene
from coeflab.report.figures.surface_scene import surface_scene
from coeflab.report.figures.sweep import sweep_figure
from coeflab.report.formats.html import panels_json, scene_json
from coeflab.report.sections.body import hull_marks
from coeflab.report.sections.data_quality import quality_sections
from coeflab.study.checks.symmetry import check as symmetry_check
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.motion.vehicles import made
from tests.report.studies import FULL, HOSTILE, LENGTH, small_study, small_table


def with_files(*files):
    return replace(small_study(FULL), parameter_files={f.name: f for f in files})


def test_the_sketch_states_a_sense_of_control_angles_only_with_its_source():
    with_controls, without = axes_figures("a"), axes_figures("a", controls=False)
    assert all("Roddy (1990), Table 4" in f.caption for f in with_controls[:2])
    assert all("Roddy" not in f.caption and "rudder" not in f.description for f in without)
    assert with_controls[0].svg != without[0].svg
    assert with_controls[2] == without[2]


def test_forces_at_rest_and_the_check_of_symmetry_have_one_value():
    study = small_study(FULL)
    (section,) = quality_sections(study)
    rest = next(t for t in section.tables if t.title == "Forces at rest")
    found = symmetry_check(study)
    assert len(rest.rows) == len(found) == 2
    for row, c in zip(rest.rows, found, strict=True):
        assert f"' at zero drift = {row[3]} +- {row[4]}," in c.statistic


@pytest.mark.parametrize(
    ("offset", "noise", "severity"),
    [(0.0, 1.0, "pass"), (0.0005, 1e-3, "pass"), (0.02, 1e-3, "note"), (0.2, 1e-3, "warn")],
)
def test_the_check_of_symmetry_does_as_its_rule_says(offset, noise, severity):
    """An offset as a share of the largest force: within its interval or below 0.1 % passes, 5 % and more is a warning."""
    v = np.sin(np.radians(np.linspace(-10.0, 10.0, 21)))
    table = small_study(FULL).tables[0]
    ripple = noise * 1e-3 * np.cos(7.0 * np.arange(len(v)))
    y = -v / v[-1] * (1.0 - offset) + offset + ripple
    made_table = small_table(list(np.degrees(np.arcsin(v))))
    size = 0.03 * 0.5 * 1000.0 * 1.5**2 * 4.0
    usable = {c: np.ones(len(v), dtype=bool) for c in made_table.usable}
    planted = replace(made_table, forces={**made_table.forces, "Y": size * y}, usable=usable, exclusions=())
    fit = FITS.load("slope_at_origin").fit([planted], LENGTH, {})
    (found,) = [
        c for c in symmetry_check(replace(small_study(FULL), tables=(table,), fits=(fit,))) if c.subject == "tow Y0'"
    ]
    assert found.severity.value == severity
    assert found.rule.startswith("zero within U95; a note from 0.1 % of the largest, a warning from 5 %")


def test_data_quality_finds_the_planted_offset_and_names_the_doubtful_cell():
    (section,) = quality_sections(small_study(FULL, named=HOSTILE))
    by_title = {t.title: t for t in section.tables}
    rest = {row[1]: row for row in by_title["Forces at rest"].rows}
    assert float(rest["Y'"][3]) == pytest.approx(1e-4, rel=0.15)
    assert by_title["Rows and cells"].rows[0][1:] == ("13", "26", "25", "0", "1", "0")
    (cell,) = by_title["Cells that the fits do not use"].rows
    assert cell[1:] == ("doubtful", HOSTILE, f"Y: {HOSTILE} 1")


def test_repeatability_is_the_pooled_scatter_of_equal_settings():
    study = small_study([-4.0, -2.0, 0.0, 0.0, 0.0, 2.0, 4.0])
    (section,) = quality_sections(study)
    rows = next(t for t in section.tables if t.title == "Repeatability").rows
    y = study.tables[0].primed_force("Y", LENGTH.length)[2:5]
    assert rows[0][1:4] == ("Y'", "1", "2")
    assert float(rows[0][4]) == pytest.approx(np.std(y, ddof=1), rel=1e-2)


def test_the_axes_are_drawn_as_an_orthographic_view():
    """Rows of an orthogonal matrix without its third column: right and up are unit vectors at right angles."""
    assert pytest.approx(np.eye(2), abs=2e-3) == AXES.T @ AXES
    assert len(axes_figures("axes")) == 3
    assert axes_figures("axes") == axes_figures("axes")


def layer_of(scene, name):
    content = json.loads(scene_json(scene))
    layer = next(item for item in content["layers"] if item["name"] == name)
    low, high = np.array([a["ends"] for a in content["axes"]]).T
    share = np.frombuffer(base64.b64decode(layer["places"]), "<u2").reshape(-1, 3) / 65535.0
    index = np.frombuffer(base64.b64decode(layer["index"]), f"<u{layer['wide']}")
    return layer, low + share * (high - low), index


def test_a_surface_in_space_goes_through_the_fit_and_holds_every_point():
    tables = read_tables(PlannedTable(shipped("cfd_data") / "huuv_synthetic", (), {}))
    model = FITS.load("surface").fit(tables, LENGTH, {"degree": 3}).models[0]
    scene = surface_scene(model)
    layer, places, _index = layer_of(scene, "points")
    assert len(layer["notes"]) == len(places) == model.n_points
    span = np.ptp(model.y)
    assert places[:, 2] == pytest.approx(model.y, abs=1e-4 * span)
    _, surface, corners = layer_of(scene, "fitted surface")
    assert corners.max() < len(surface)
    used = surface[np.unique(corners)]
    degrees = np.radians(used[:, 0]), np.radians(used[:, 1])
    values, _, _ = model.evaluate(dict(zip(model.domain.variables, degrees, strict=True)))
    assert used[:, 2] == pytest.approx(values, abs=2e-3 * span)


def test_a_body_of_parts_is_solid_and_a_mesh_is_a_skin_of_few_faces():
    parts = Parts(
        (
            Part("hull", Cylinder(0.1, 1.0), np.zeros(3), np.eye(3)),
            Part("sail", Box(0.2, 0.05, 0.1), np.array([0.1, 0.0, -0.15]), np.eye(3)),
        )
    )
    marks = (Mark("centre of buoyancy", "CB", np.array([0.02, 0.0, -0.01]), "a"),)
    scene = hull_scene("b", parts, marks, ("The centre of gravity is not known.",))
    assert [(layer.name, layer.opacity) for layer in scene.layers[:2]] == [("cylinder", 1.0), ("box", 1.0)]
    assert "not known" in scene.caption
    _, places, _ = layer_of(scene, "centre of buoyancy")
    assert places[0] == pytest.approx([0.02, 0.0, -0.01], abs=1e-4)
    body = read_body(shipped("geometry") / "suboff_bare_hull" / "body.toml")
    skin = hull_scene(body.name, body.require_shape(), marks).layers[0]
    assert skin.opacity < 1.0
    assert 200 < len(skin.index) <= FACES


def test_a_hull_is_drawn_in_even_triangles_and_its_fins_apart():
    """SUBOFF AFF-8: no facet of the hull is long, and its nose is round."""
    body = read_body(shipped("geometry") / "suboff_aff8" / "body.toml")
    skin = hull_scene(body.name, body.require_shape(), (), pieces=body.pieces).layers[0]
    vertices = body.require_shape().vertices
    length = float(np.ptp(vertices[:, 0]))
    assert len(skin.index) < 15_000
    corners = skin.places[skin.index]
    hull = corners[: len(_even(body.pieces[0])[1])]
    sides = np.linalg.norm(hull - np.roll(hull, 1, axis=1), axis=2)
    assert np.percentile(sides.max(axis=1) / sides.min(axis=1), [50, 90]) == pytest.approx([1.4, 2.4], abs=0.6)
    assert sides.max() < 0.02 * length
    nose = skin.places[: int(skin.index[: len(hull)].max()) + 1]
    ahead = np.unique(nose[nose[:, 0] > nose[:, 0].max() - 0.02 * length, 0])
    assert len(ahead) > 8
    assert corners.min((0, 1)) == pytest.approx(vertices.min(axis=0), abs=1e-3)
    assert corners.max((0, 1)) == pytest.approx(vertices.max(axis=0), abs=1e-3)


def test_a_centre_that_is_not_known_has_no_mark_and_is_said():
    file = made().model_copy(update={"mass": None})
    parts = Parts((Part("hull", Cylinder(0.1, 1.0), np.zeros(3), np.eye(3)),))
    body = Body(
        "b", "B", file.reference_point.origin, np.zeros(3), {}, (), Source("synthetic", kind="synthetic"), (), parts
    )
    marks, unknown = hull_marks(with_files(file), body, (file.name,))
    assert [m.label for m in marks] == ["CB"]
    assert "centre of gravity is not known" in unknown[0]
    assert "has no value: Nv' or Yv' is missing" in unknown[1]
    assert "has no value: Mw' or Zw' is missing" in unknown[2]


def test_the_centre_of_pressure_is_the_moment_over_the_force():
    study = small_study(FULL)
    fit = study.fits[0]
    found = {c.symbol: c.value for c in fit.coefficients.coefficients}
    file = made().model_copy(
        update={
            "body": fit.body,
            "coefficients": (replace(made().coefficients[0], campaign=fit.campaign),),
        }
    )
    parts = Parts((Part("hull", Cylinder(0.1, 1.0), np.zeros(3), np.eye(3)),))
    body = Body(
        "b", "B", file.reference_point.origin, np.zeros(3), {}, (), Source("synthetic", kind="synthetic"), (), parts
    )
    marks, _ = hull_marks(replace(study, parameter_files={file.name: file}), body, (file.name,))
    (sway,) = [m for m in marks if m.label == "CP sway"]
    assert sway.place[0] == pytest.approx(LENGTH.length * found["Nv"] / found["Yv"], rel=1e-9)
    assert "±" in sway.note


def test_numbers_of_a_figure_stand_where_the_drawing_has_them():
    sweep = small_study(FULL).fits[0].sweeps[0]
    figure = sweep_figure(sweep, "f")
    panel = json.loads(panels_json(figure))["panels"][0]
    left, top, wide, tall = panel["frame"]
    i = int(np.argmax(panel["series"][0]["x"]))
    across = (panel["series"][0]["x"][i] - panel["across"][0]) / (panel["across"][1] - panel["across"][0])
    up = (panel["series"][0]["y"][i] - panel["up"][0]) / (panel["up"][1] - panel["up"][0])
    place = f'x="{left + wide * across:.1f}'
    height = f'y="{top + tall * (1.0 - up):.1f}'
    group = figure.svg[figure.svg.index('data-series="points"') :]
    assert place in group
    assert height in group


def test_nothing_to_tell_is_no_script():
    assert panels_json(SimpleNamespace(panels=(), title="t")) == ""
