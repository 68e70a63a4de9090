"""Oscillating runs beside steady ones in one plan: parameter file, report and refusals."""

from __future__ import annotations

import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.report.sections.campaign import campaign_section
from coeflab.report.tables import oscillations as tables
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from coeflab.tables.reading import table_at

HERE = shipped("cfd_data") / "pmm_synthetic"


@pytest.fixture(scope="module")
def study() -> Study:
    return run(read_plan(HERE / "beside_steady.toml"))


@pytest.mark.slow
def test_added_mass_joins_the_steady_law_in_the_parameter_file(study: Study) -> None:
    (file,) = study.parameter_files.values()
    origin = {c.symbol: c.campaign for c in file.coefficients}
    assert origin["Yv'"] == "pmm_synthetic_steady"
    assert origin["Yvdot'"] == origin["Nrdot'"] == origin["Kp'"] == "pmm_synthetic"
    assert any("left out, from planar_motion: Yv'" in n for n in file.provenance.notes)


@pytest.mark.slow
def test_the_report_says_what_amplitude_explains(study: Study) -> None:
    pmm = study.fits[-1]
    rows = {(r[0], r[1]): r for r in tables.explained(pmm, study.fits).rows}
    own, steady = rows["Yv'", "zero amplitude"], rows["Yv'", "pmm_synthetic_steady by slope_at_origin"]
    assert "(100" in own[7]
    assert "%" in steady[7]
    assert abs(float(steady[8])) < float(steady[9])
    section = campaign_section(study, pmm, "pmm", set())
    titles = [s.title for s in section.subsections]
    assert titles[:2] == ["Amplitude and frequency", "Yv' and Yvdot'"]
    assert [f.title for f in section.subsections[1].figures] == [
        "Y' of sway_4 over time", "Yv' over amplitude", "Yvdot' over amplitude",
    ]  # fmt: skip
    assert any("Butterworth 2, 2 Hz" in line for line in section.paragraphs)


@pytest.mark.slow
def test_the_headline_has_the_damping_and_the_added_mass(study: Study) -> None:
    said = tables.headline(study.fits[-1])
    assert said.startswith("Yv' = -0.0")
    assert "Nrdot' = " in said
    assert tables.headline(study.fits[0]) == ""
    assert tables.explained(study.fits[0], study.fits).rows == ()


@pytest.mark.parametrize(
    ("campaign", "fit"), [("pmm_synthetic", "tied_law"), ("pmm_synthetic_steady", "planar_motion")]
)
def test_a_fit_of_the_other_kind_is_refused(campaign: str, fit: str) -> None:
    with pytest.raises(InputError, match=f"{fit} over"):
        run(Plan("p", "p", (table_at(shipped("cfd_data") / campaign, (fit,)),)))
