"""What a campaign declares of its tables, its notes and its source files stand in the report and in JSON."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.core.provenance import work
from coeflab.report.as_json import studies as as_json
from coeflab.report.content import core, document
from coeflab.report.document import Document, Section
from coeflab.report.first_page import answer
from coeflab.report.tables import sources
from coeflab.report.tables.results import primed_about
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study

SHA = "cd5c0a81b68b0a4764f9416ac0d792f1c7d5438274880fb0224e4e7db2911e2e"
TOML = f"""[campaign]
title = "Tests of B"
body = "model_B"
notes = "Sail taken off, % & <b> Yv' is not ours"
[axes]
frame = "CFD"
datum = "nose"
reference_point = [2.457, 0.0, 0.0]
beta = "v = -U sin(beta)"
[scaling]
length = 5.2
length_name = "LBP"
[conditions]
density = 999
speed = 3.0
[source]
kind = "experiment"
citation = "roddy1990"
place = "p. 19"
[[table]]
file = "table.csv"
source_sha256 = "{SHA}"
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("tests") / "model_B"
    folder.mkdir()
    (folder / "campaign.toml").write_text(TOML)
    rows = [f"{k},{b},{0.5 * b},{10.0 * b + 0.2 * b * abs(b)},{4.0 * b}" for k, b in enumerate(range(-12, 13, 2))]
    (folder / "table.csv").write_text("point,beta [deg],X [N],Y [N],N [N*m]\n" + "\n".join(rows) + "\n")
    return run(read_plan(Path(folder / "campaign.toml")))


def every(sections: tuple[Section, ...]) -> list[Section]:
    return [s for one in sections for s in (one, *every(one.subsections))]


def titles(what: Document) -> dict[str, Section]:
    return {t.title: s for s in every(what.sections) for t in s.tables}


def test_what_is_declared_stands_before_it_is_turned_and_moved(study: Study) -> None:
    found = sources.declared(study.tables)
    rows = dict(found.rows)
    assert rows["frame"] == "CFD"
    assert rows["sign of the drift angle"] == "v = -U sin(beta)"
    assert rows["length of the primes"] == "LBP = 5.2 m"
    assert rows["density"] == "999 kg/m^3"
    assert rows["speed"] == "3 m/s"
    assert rows["moments about"].startswith("x = 2.457 m")
    assert rows["made from a file of sha256"] == SHA
    assert found.notes == ("Notes: Sail taken off, % & <b> Yv' is not ours",)
    assumed = [replace(t, assumed=("beta",)) for t in study.tables]
    assert dict(sources.declared(assumed).rows)["sign of the drift angle"] == "v = -U sin(beta), assumed"
    assert sources.declared([replace(t, declared=None) for t in study.tables]).rows == ()


def test_it_is_in_the_appendix_and_the_source_file_in_the_provenance(study: Study) -> None:
    whole = document(study)
    assert "As campaign.toml declares it" in titles(whole)
    assert "As campaign.toml declares it" not in titles(core(whole))
    assert titles(core(whole))["Files that the tables were made from"].anchor == "provenance"
    assert any("Yv' is not ours" in text for text in whole.verbatim)


def test_json_has_it_too(study: Study) -> None:
    (told,) = as_json.study(study, [])["campaigns"]
    assert told["frame"] == "CFD"
    assert told["signs"] == {"beta": "v = -U sin(beta)"}
    assert told["notes"] == "Sail taken off, % & <b> Yv' is not ours"
    assert told["source_sha256"] == SHA
    assert (told["length"], told["length_name"], told["density"], told["speed"]) == (5.2, "LBP", 999.0, 3.0)


def test_the_sources_are_named_with_their_places(study: Study) -> None:
    assert sources.sources(study) == (f"Source: {work('roddy1990')} p. 19",)


def test_forces_of_half_of_a_body_are_said_to_be_doubled_where_the_values_stand(study: Study, tmp_path: Path) -> None:
    """A factor of two belongs beside the answer; a whole body says nothing."""
    half = TOML.replace('body = "model_B"', 'body = "model_B"\nhalf_model = "upper"\nsymmetry = ["up-down"]')
    (tmp_path / "campaign.toml").write_text(half)
    rows = [f"{k},{b},{0.5 * b},{10.0 * b + 0.2 * b * abs(b)},{4.0 * b}" for k, b in enumerate(range(-12, 13, 2))]
    (tmp_path / "table.csv").write_text("point,beta [deg],X [N],Y [N],N [N*m]\n" + "\n".join(rows) + "\n")
    halved = run(read_plan(tmp_path / "campaign.toml"))
    (said,) = sources.halves(halved)
    assert said.endswith("table.csv: half model (upper): X, Y, N doubled, by half_model of campaign.toml.")
    assert said in primed_about(halved)
    assert said in answer(halved, drawn=False).notes
    assert sources.halves(study) == ()
    (whole, doubled) = (s.coefficients[0].value for s in (study, halved))
    assert doubled == pytest.approx(2.0 * whole, rel=1e-9)
