"""Exports that a plan asks for: proved, written to folders of their own, and refused where a loss was not accepted."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.core.errors import InputError, PluginError
from coeflab.core.finding import Severity
from coeflab.formats.export import PlannedExport, export
from coeflab.report.content import document
from coeflab.report.rendered import rendered
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from tests.study.test_other_units_and_axes import write_template


def planned(folder: Path, *tables: str) -> Plan:
    """The template's plan with [[export]] tables."""
    path = write_template(folder)
    path.write_text(path.read_text() + "".join(f"\n[[export]]\n{t}\n" for t in tables))
    return read_plan(path)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """mss holds the law, gazebo has u for U, csv is no simulator."""
    tables = ('to = "mss"\naccept_loss = true', 'to = "gazebo"\naccept_loss = true', 'to = "csv"')
    return run(planned(tmp_path_factory.mktemp("plan"), *tables))


def test_every_target_has_a_folder_with_its_loss_report(study: Study) -> None:
    files = rendered(study)
    parameters = study.parameter_files["my_vehicle"]
    assert files["my_vehicle.parameters.json"] == parameters.to_json()
    for target in ("mss", "gazebo"):
        made = export(parameters, target)
        assert set(made.files) >= {f"my_vehicle.{target}.loss.txt"}
        for name, content in made.files.items():
            assert files[f"my_vehicle.{target}/{name}"] == content
    assert files["my_vehicle.mss/my_vehicle.mss.loss.txt"].splitlines()[2] == b"This export is not lossless: 1 missing."
    assert b"not lossless" in files["my_vehicle.gazebo/my_vehicle.gazebo.loss.txt"]
    assert sum(name.endswith(".coefficients.csv") for name in files) == 1


def test_without_exports_nothing_but_tables_is_written(tmp_path: Path) -> None:
    found = rendered(run(planned(tmp_path)))
    assert sorted(found) == ["my_vehicle.coefficients.csv", "my_vehicle.parameters.json", "report.html"]
    assert b'id="exports"' not in found["report.html"]


def test_the_report_shows_every_export_with_its_loss(study: Study) -> None:
    (section,) = (s for s in document(study).sections if s.anchor == "exports")
    (table,) = section.tables
    assert [row[:2] for row in table.rows] == [("my_vehicle", t) for t in ("mss", "gazebo", "csv")]
    mss, gazebo, csv = (row[2] for row in table.rows)
    assert (mss, csv) == ("accepted: 1 missing", "none: tables of the file's own values")
    assert re.fullmatch(r"accepted: \d not held, 2 missing", gazebo)
    assert [s.title for s in section.subsections] == ["my_vehicle for mss", "my_vehicle for gazebo"]
    shown = section.subsections[1].tables[0]
    assert shown.rows[0][0] == "X"
    assert any(note.startswith("changed: ") for note in shown.notes)
    assert all(s.appendix for s in section.subsections)
    page = rendered(study)["report.html"]
    assert b'id="exports"' in page
    assert b'id="export-1"' not in page


@pytest.mark.parametrize(
    ("table", "key", "expected"),
    [
        ('to = "gazebo"', "export[1].accept_loss", "accept_loss = true"),
        ('to = "gazebo"\naccept_loss = false', "export[1].accept_loss", "accept_loss = true"),
        ('to = "gazebo"\nstrict = true', "export[1].strict", "a target that holds everything"),
        ('to = "gazebo"\naccept_loss = true\nstrict = true', "export[1].strict", "a target that holds everything"),
    ],
)
def test_a_loss_has_to_be_accepted(tmp_path: Path, table: str, key: str, expected: str) -> None:
    """The study stands: it was computed, and thrown away whole."""
    found = run(planned(tmp_path, 'to = "csv"', table))
    (refused,) = found.refused
    why = refused.why
    assert (refused.parameters, refused.target) == ("my_vehicle", "gazebo")
    assert (why.file, why.column) == (tmp_path / "plan.toml", key)
    assert re.match(r'gazebo, a target that loses part of "my_vehicle": no .*Yvvv.* missing: roll inertia, ', why.found)
    assert expected in why.expected
    assert "\n" not in str(why)
    assert found.failed
    assert [made.target for made in found.exports] == ["csv"]
    files = rendered(found)
    assert "my_vehicle.parameters.json" in files
    assert not any("gazebo" in name for name in files)
    assert b"Refused, and not written: my_vehicle for gazebo" in files["report.html"]


ACROSS = {"suboff_fully_appended": "YNZM", "suboff_bare_hull": "YN", "suboff_bare_hull_cfd": "YN"}


@pytest.mark.parametrize("target", ["mss", "xdyn", "gazebo"])
def test_suboff_exports_hold_their_own_points(suboff: Study, target: str) -> None:
    """At most 8 % of the largest force to 18 degrees, by the force law of each target from its written files."""
    made = {e.parameters: e for e in suboff.exports if e.target == target}
    for name, components in ACROSS.items():
        loss = made[name].loss
        found = [f for f in loss.at_points if f.component in components]
        assert {f.component for f in found} == set(components)
        assert max(f.share for f in found) <= 0.08
        assert not any(f.beyond for f in found)
        text = made[name].files[f"{name}.{target}.loss.txt"].decode()
        assert f"Force law of {target} against its points" in text
        assert "Force law of the parameter file against its points" in text


def test_points_that_suboff_leaves_out_are_named_in_a_warning(suboff: Study) -> None:
    """X and K of the appended hull at 18 degrees, where both turn; no component fails."""
    found = [c for c in suboff.checks if c.name == "law at points"]
    assert [c.subject for c in found if c.severity is Severity.FAIL] == []
    warned = {c.subject: c.statistic for c in found if c.severity is Severity.WARN}
    assert set(warned) == {f"suboff_fully_appended {c} suboff_roddy_2/table.csv" for c in "XK"}
    assert all(said.startswith("points 80, 81, outside the range of the law") for said in warned.values())
    # "worst 10 %, expected ... 5 %" read as a failure: the bound is 11 %.
    rule = next(c.rule for c in found if c.subject == "suboff_fully_appended X suboff_roddy_2/table.csv")
    assert rule == "every point within 11 % of the largest force: 3 times the scatter of repeated runs + 5 %"


def test_a_refusal_names_what_is_not_held(tmp_path: Path) -> None:
    (refused,) = run(planned(tmp_path, 'to = "uuv_simulator"')).refused
    said = r'uuv_simulator, a target that loses part of "my_vehicle": no Xvv, .*, and missing: .* and [XN] differs by'
    assert re.search(said, str(refused.why))


def test_what_a_target_cannot_take_at_all_names_the_plan(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise InputError("an inertia that is not positive", "a body")

    monkeypatch.setattr("coeflab.formats.xdyn.write.render", refuse)
    (refused,) = run(planned(tmp_path, 'to = "csv"', 'to = "xdyn"')).refused
    assert (refused.why.file, refused.why.column) == (tmp_path / "plan.toml", "export[1].to")
    assert refused.why.found == "an inertia that is not positive in my_vehicle for xdyn"


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        (('to = "xdyn"\naccept_los = true',), "accept_los"),
        (('to = "xdyn"\naccept_loss = "yes"',), "true or false"),
        (("strict = true",), "export[0].to"),
        (('to = "csv"', 'to = "csv"'), 'the target "csv" twice'),
    ],
)
def test_tables_that_are_no_export(tmp_path: Path, tables: tuple[str, ...], said: str) -> None:
    with pytest.raises(InputError) as caught:
        planned(tmp_path, *tables)
    assert said in str(caught.value)
    assert "plan.toml" in str(caught.value)


def test_an_unknown_target_is_refused_before_anything_is_read(tmp_path: Path) -> None:
    plan = planned(tmp_path, 'to = "xdynn"')
    (tmp_path / "campaign" / "drift.csv").unlink()
    with pytest.raises(
        PluginError, match=r'plan.toml, "export\[0\].to": no exporter is called "xdynn": did you mean xdyn'
    ):
        run(plan)


def test_a_plan_of_a_program_has_no_file_to_name(study: Study) -> None:
    plan = replace(study.plan, exports=(PlannedExport("gazebo"),))
    (refused,) = run(plan).refused
    assert str(refused.why).startswith('"export.accept_loss": found gazebo')


def test_json_names_the_losses(study: Study) -> None:
    from coeflab.report.as_json.studies import study as as_json

    told = json.loads(json.dumps(as_json(study, [])))["exports"]
    assert [(t["parameter_file"], t["target"], t["lossless"]) for t in told] == [
        ("my_vehicle", "mss", False), ("my_vehicle", "gazebo", False), ("my_vehicle", "csv", True),
    ]  # fmt: skip
    assert len(told[1]["worst_difference"]) == 6
