"""The body of a plan in a report, with and without a shape, beside bodies whose added mass is shown."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from types import SimpleNamespace

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.shape import Box, Cylinder, Part, Parts
from coeflab.core.axes import Datum
from coeflab.core.provenance import Source
from coeflab.report.content import document
from coeflab.report.sections.body import body_sections
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from tests.report.studies import FULL, small_study

PARTS = Parts(
    (
        Part("hull", Cylinder(0.1, 1.0), np.zeros(3), np.eye(3)),
        Part("sail", Box(0.2, 0.05, 0.1), np.array([0.1, 0.0, -0.15]), np.eye(3)),
    )
)


def body_of(shape):
    return Body("b", "B", Datum("nose"), np.zeros(3), {}, (), Source("synthetic", kind="synthetic"), (), shape)


def with_body(shape, **more):
    return replace(small_study(FULL), body=body_of(shape), **more)


def test_a_shape_is_drawn_and_turned_with_no_added_mass():
    (section,) = body_sections(with_body(PARTS))
    (figure,) = section.figures
    assert figure.anchor == "body-parts"
    assert figure.scene.is_body
    assert {layer.label for layer in figure.scene.layers} >= {"CB"}
    assert "none is computed" in section.paragraphs[0]
    anchors = [s.anchor for s in document(with_body(PARTS)).sections]
    assert "body" in anchors
    assert "added-mass" not in anchors


def test_particulars_alone_have_no_picture_and_it_is_said():
    (section,) = body_sections(with_body(None))
    assert section.figures == ()
    assert "without a shape" in section.paragraphs[1]


def test_a_body_is_shown_once():
    assert body_sections(small_study(FULL)) == ()
    for shape, other, times in ((PARTS, "b", 0), (PARTS, "other", 1), (None, "other", 0)):
        hulls = {"f": SimpleNamespace(body=SimpleNamespace(name=other))}
        assert len(body_sections(with_body(shape, hulls=hulls))) == times


@pytest.fixture(scope="module")
def template(tmp_path_factory):
    folder, source = tmp_path_factory.mktemp("new"), files("coeflab.cli") / "template"
    for name in ("plan.toml", "body.toml", "campaign/campaign.toml", "campaign/drift.csv", "campaign/rotating_arm.csv"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(source.joinpath(*name.split("/")).read_bytes())
    return run(read_plan(folder / "plan.toml"))


def test_a_new_study_shows_where_the_force_of_a_drift_acts(template):
    (section,) = body_sections(template)
    (figure,) = section.figures
    marks = {layer.label: layer.places[0] for layer in figure.scene.layers if layer.label}
    assert set(marks) == {"CB", "CG", "CP sway"}
    assert marks["CG"] == pytest.approx([-0.80, 0.0, 0.0])
    # The template's numbers are made of N' / Y' = 0.010 / 0.030 at small angles.
    assert marks["CP sway"][0] == pytest.approx(-0.80 + 1.60 / 3.0, abs=0.03)


def test_the_mass_of_a_body_with_a_shape_reaches_the_parameter_file(template):
    computed, told = template.body.configurations
    assert computed.mass is None
    assert computed.volume == pytest.approx(told.volume, rel=1e-3)
    assert told.mass.mass == 40.0
    assert template.parameter_files["my_vehicle"].mass.mass == 40.0
