"""Stability in reports: indices with their senses, the mass that they are made of, and what the same source prints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.report.content import document
from coeflab.report.first_page import study_summary
from coeflab.report.sections.stability import in_words, stability_sections
from coeflab.report.tables.added_mass import mass_table
from coeflab.study.checks.stability import check as stability_check
from coeflab.vehicle.published_values import read_references
from tests.motion.vehicles import STABLE, UNSTABLE, made
from tests.report.studies import FULL, small_study

M = 60.0 / (0.5 * 1000.0 * 2.0**3)
IN_WATER = {**STABLE, "Yvdot": -2e-2, "Nrdot": -1e-3, "Zwdot": -2e-2, "Mqdot": -1e-3}
NEARLY = {**STABLE, "Nv": -4e-2 * -1e-2 / (4e-3 - M) * 1.01}  # G_h = 1 - 1.01: next to nothing, below zero


def with_files(*files):
    return replace(small_study(FULL), parameter_files={f.name: f for f in files})


def test_stability_has_indices_roots_and_figures():
    (section,) = stability_sections(with_files(made(IN_WATER)))
    indices, roots = section.tables
    made_of = section.subsections[0].tables[0]
    assert [row[1] for row in indices.rows] == ["G_h", "G_v", "r'/dr"]
    assert [row[:2] for row in made_of.rows] == [("synthetic", "G_h"), ("synthetic", "G_v")]
    assert [row[4] for row in indices.rows[:2]] == ["stable, no U95", "stable at high speed, no U95"]
    assert all("no U95" in row[5] for row in indices.rows)
    assert [row[4] for row in roots.rows] == ["none", "none"]
    assert len(section.figures) == 2
    assert all(f.panels for f in section.figures)


def test_stability_without_hydrostatics_says_what_is_missing():
    (section,) = stability_sections(with_files(made(IN_WATER).model_copy(update={"hydrostatics": None})))
    assert section.tables[1].rows[1][4] == "no value: no BG"
    assert "no hydrostatics" in section.figures[1].caption


def test_roots_and_critical_speed_are_withheld_without_the_added_mass_of_their_plane():
    known = {**STABLE, "Mw": 6e-2, "Zwdot": -2e-2, "Mqdot": -1e-3}
    (section,) = stability_sections(with_files(made(known, 0.02)))
    level, upright = section.tables[1].rows
    assert level[2:] == ("-", "-", "no value: no added mass (Yvdot', Nrdot')", "-")
    assert float(upright[4]) > 0.0
    assert upright[5] == "none: a derivative has no U95"
    assert "acceleration derivatives" in " ".join(section.tables[1].notes)
    assert [f.anchor for f in section.figures] == ["roots-0-v"]
    (section,) = stability_sections(with_files(made({**known, **IN_WATER, "Mqdot": 0.0}, 0.02)))
    assert section.tables[1].rows[1][4] == "no value: no added mass (Mqdot')"
    assert "added mass" not in section.tables[1].rows[0][4]


def with_u95(values, half):
    """A file whose derivatives of sway and yaw are independent, with such half-widths as shares of their sizes."""
    file = made(values)
    deviations = [half * values[s] / 2.0 for s in ("Yv", "Nv", "Yr", "Nr")]
    symbols = tuple(file.coefficient(s).symbol for s in ("Yv'", "Nv'", "Yr'", "Nr'"))
    matrix = tuple(map(tuple, np.diag(np.square(deviations)).tolist()))
    covariance = file.covariance.model_copy(update={"symbols": symbols, "matrix": matrix})
    return file.model_copy(update={"covariance": covariance})


@pytest.mark.parametrize(
    ("values", "half", "said"),
    [(STABLE, 0.05, "stable"), (UNSTABLE, 0.05, "unstable"), (NEARLY, 0.05, "sign open")],
)
def test_an_index_is_stable_unstable_or_of_open_sign_by_its_interval(values, half, said):
    study = with_files(with_u95(values, half))
    (section,) = stability_sections(study)
    by_index = {row[1]: row for row in section.tables[0].rows}
    assert by_index["G_h"][4] == said
    words = "undecided (sign of G_h open)" if said == "sign open" else said
    (sentence,) = [text for text in in_words(study) if "G_h" in text]
    assert sentence.startswith(
        f"With controls fixed, straight motion in the horizontal plane is {words}: synthetic (G_h"
    )
    assert sentence in document(study).sections[0].texts
    (chip,) = [c for c in study_summary(study).answer.chips if c.name == "Stability, horizontal plane"]
    assert chip.text.startswith(f"{said}, G_h = ")


@pytest.mark.parametrize("index", ["G_h", "G_v"])
def test_an_index_can_be_recomputed_from_the_numbers_below_it(index):
    (section,) = stability_sections(with_files(with_u95(STABLE, 0.05)))
    made_of = section.subsections[0].tables[0]
    text, source = next(row[2:] for row in made_of.rows if row[1] == index)
    assert source == "published"
    y, n, y_rate, n_rate, m, x = (float(one.rpartition(" = ")[2]) for one in text.split(", "))
    sign = 1.0 if index == "G_h" else -1.0
    again = 1.0 - n * (y_rate - sign * m) / (y * (n_rate - x * m))
    printed = next(float(row[2]) for row in section.tables[0].rows if row[1] == index)
    assert again == pytest.approx(printed, rel=1e-3)


def test_an_index_over_an_uncertain_denominator_has_limits_by_drawing():
    by_half = {}
    for half in (0.05, 0.3):
        (section,) = stability_sections(with_files(with_u95(STABLE, half)))
        by_half[half] = next(row for row in section.tables[0].rows if row[1] == "G_h")
    assert "linearised" not in by_half[0.05][-1]
    said = by_half[0.3][-1].partition("U95 is linearised; 95 % Monte Carlo limits ")[2]
    assert "20000 draws, seed 1" in said
    low, high = (float(one) for one in said.partition(" (")[0].split(" .. "))
    value = float(by_half[0.3][2])
    assert low < value < high
    assert value - low > 1.1 * (high - value)
    (sentence,) = in_words(with_files(with_u95(STABLE, 0.3)))
    assert f"; Monte Carlo {low:g} to {high:g})" in sentence
    assert "Monte Carlo" not in in_words(with_files(with_u95(STABLE, 0.05)))[0]


def test_limits_by_drawing_stand_alone_where_the_linear_half_width_is_no_part_of_them():
    """Nv' and Yr' - m' near zero, each uncertain: chip, sentence, table and check have the drawn limits and judge by them."""
    file = made({**STABLE, "Nv": 1e-6, "Yr": made().mass.mass_prime + 1e-6})
    for half, said, value in (
        (1e-2, "stable", "1.00, 95 % limits 0.86 to 1.14"),
        (3e-2, "sign open", "1.0, 95 % limits -0.3 to 2.2"),
    ):
        variances = (5e-6**2, (half / 2.0) ** 2, (half / 2.0) ** 2, 5e-6**2)
        update = {"symbols": ("Yv'", "Nv'", "Yr'", "Nr'"), "matrix": tuple(map(tuple, np.diag(variances).tolist()))}
        study = with_files(file.model_copy(update={"covariance": file.covariance.model_copy(update=update)}))
        row = next(row for row in stability_sections(study)[0].tables[0].rows if row[1] == "G_h")
        assert row[3:5] == ("-", said)
        assert row[-1].startswith("Yv', Nv', Yr', Nr' published; 95 % Monte Carlo limits ")
        assert f"synthetic (G_h = {value})" in in_words(study)[0]
        (chip,) = [c for c in study_summary(study).answer.chips if c.name == "Stability, horizontal plane"]
        assert chip.text == f"{said}, G_h = {value}"
        (found,) = [c for c in stability_check(study) if c.subject.endswith("G_h")]
        assert found.statistic == f"G_h = {value}: {said}"
        assert ("The interval contains zero" in found.comment) is (said == "sign open")


def test_derivatives_of_the_literature_are_named_beside_measured_ones():
    file = made()
    measured = tuple(replace(c, origin="fit") if c.symbol in ("Yv'", "Nv'") else c for c in file.coefficients)
    (said,) = in_words(with_files(file.model_copy(update={"coefficients": measured})))
    assert said.endswith(" Where the data give no value, the indices use published ones: Yr' and Nr' of synthetic.")
    assert "published" not in in_words(with_files(file))[0]


def test_a_missing_rate_derivative_is_named():
    few = {s: v for s, v in STABLE.items() if s not in ("Nr", "Zq", "Mq", "Zw", "Mw")}
    (section,) = stability_sections(with_files(made(few)))
    assert [t.title for t in section.tables] == ["Standard criteria"]
    assert [t.title for t in section.subsections[0].tables] == ["Mass and inertia used"]
    assert section.tables[0].rows == (("synthetic", "G_h", "-", "-", "no value", "missing: Nr'"),)


def test_the_mass_that_an_index_is_made_of_is_shown_and_named_as_not_assessed():
    (section,) = stability_sections(with_files(with_u95(STABLE, 0.05), made().model_copy(update={"name": "twin"})))
    indices, *_ = section.tables
    _, used = section.subsections[0].tables
    assert all(row[0] == "synthetic, twin" for row in used.rows)
    shown = {row[1]: row for row in used.rows}
    assert float(shown["m'"][2]) == pytest.approx(M, rel=1e-4)
    assert shown["Iz"][2:4] == ("14.000", "kg m^2")
    assert {row[4:] for row in used.rows} == {("not stated", "not stated")}
    v = STABLE
    heavier, plain = (1.0 - v["Nv"] * (v["Yr"] - m) / (v["Yv"] * v["Nr"]) for m in (1.01 * M, M))
    remark = next(row[-1] for row in indices.rows if row[1] == "G_h")
    assert float(remark.rpartition(" ")[2]) == pytest.approx(heavier - plain, rel=0.05)


def test_where_the_mass_comes_from_and_what_is_said_of_it():
    body = read_body(shipped("geometry") / "suboff" / "body.toml")
    file = made().model_copy(update={"body": "suboff_bare_hull"})
    (used,) = mass_table(replace(with_files(file), body=body))
    by_name = {row[1]: row[4:] for row in used.rows}
    assert by_name["m'"] == ("roddy1990, Table 1, report pp. 14-15", "mass about 2 %")
    assert by_name["Iz"][1] == "not stated"


def test_an_index_stands_beside_the_one_that_the_same_source_prints():
    """Roddy's Table 4: -0.443297 for the body with its appendages; a file of other campaigns gets none."""
    published = read_references(shipped("cfd_data") / "suboff" / "published.toml")
    own = replace(made().coefficients[0], campaign="suboff_roddy_2")
    file = made().model_copy(update={"body": "suboff_fully_appended", "coefficients": (*made().coefficients[1:], own)})
    other = file.model_copy(update={"name": "other", "coefficients": made().coefficients})
    (section,) = stability_sections(replace(with_files(file, other), references=published))
    indices = section.tables[0]
    assert indices.headers[4] == "published"
    assert [row[4] for row in indices.rows if row[1].startswith("G")] == ["-0.443297", "-", "-", "-"]
    assert (
        "published: G_h of synthetic: Roddy configuration 2 (Table 4, report p. 19, configuration 2)" in indices.notes
    )


def test_the_vertical_index_speaks_of_high_speed_wherever_it_stands():
    """Without the restoring moment it says nothing of the speed of the file where BG is not known."""
    diving = made({**STABLE, "Mw": 6e-2}).model_copy(update={"hydrostatics": None})
    study = with_files(diving)
    (said,) = in_words(study)
    start = "With controls fixed, straight motion in the horizontal plane is stable, no U95: synthetic (G_h"
    vertical = (
        " In the vertical plane, it is unstable at high speed (restoring moment left out), no U95: synthetic (G_v"
    )
    assert said.startswith(start)
    assert vertical in said
    assert said.endswith(". G_v gives no verdict at 1.50 m/s, because BG is unknown.")
    (known,) = in_words(with_files(made({**STABLE, "Mw": 6e-2})))
    assert known.startswith(start)
    assert vertical in known
    assert "BG" not in known
    (chip,) = [c for c in study_summary(study).answer.chips if c.name == "Stability, horizontal plane"]
    assert chip.text.startswith("stable, G_h = ")
    assert chip.text.endswith(", no U95")
    (chip,) = [c for c in study_summary(study).answer.chips if c.name == "Stability, vertical plane at high speed"]
    assert chip.text.startswith("unstable, G_v = ")
    (found,) = [c for c in stability_check(study) if c.subject.endswith("G_v")]
    assert "unstable at high speed" in found.statistic
    assert "BG is unknown" in found.comment


def test_no_parameter_file_no_stability():
    assert stability_sections(small_study(FULL)) == ()
