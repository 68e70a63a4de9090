"""The page of data quality: planted gaps, asymmetry, tares and standard errors are found where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.report.sections.data_quality import quality_sections, settings_figure
from coeflab.report.tables import data_quality as quality
from tests.report.studies import small_study, small_table

ANGLES = [-8.0, -4.0, -2.0, 0.0, 0.0, 2.0, 4.0, 8.0]


def by_rows(table):
    return {row[1]: row for row in table.rows}


def planted(angles=ANGLES, **changed):
    """Y and N odd in the angle, no noise."""
    table = small_table(list(angles))
    v = table.primed_motion("v", table.scaling.length)
    forces = dict.fromkeys(table.forces, -1000.0 * v)
    usable = {c: np.ones(len(v), dtype=bool) for c in table.forces}
    return replace(table, forces={**forces, **changed}, usable=usable, exclusions=())


def test_settings_say_levels_ends_gap_and_side():
    row = quality.coverage([planted()]).rows[0]
    assert row[2:] == ("7", "6", "-8.000", "8.000", "4.00", "both")
    assert quality.coverage([planted([0.0, 2.0, 4.0])]).rows[0][-1] == "one"


def test_mirrored_rows_are_paired_once_and_a_planted_asymmetry_has_its_size_and_place():
    table = planted()
    assert len(quality.mirror_pairs(table)) == 3
    assert by_rows(quality.symmetry([table]))["Y'"][3:5] == ("0 %", "0 %")
    y = np.array(table.forces["Y"])
    y[-1] *= 1.1
    row = by_rows(quality.symmetry([planted(Y=y)]))["Y'"]
    assert row[2] == "3"
    assert float(row[4].split()[0]) == pytest.approx(100.0 * 0.1 / 1.1, rel=0.05)
    assert row[5] == f"{table.labels[0]} and {table.labels[-1]}"


def test_an_even_force_is_mirrored_without_a_change_of_sign():
    table = planted()
    x = {"X": np.abs(table.forces["Y"])}
    whole = replace(table, forces={**table.forces, **x}, usable={**table.usable, "X": table.usable["Y"]})
    assert by_rows(quality.symmetry([whole]))["X'"][3] == "0 %"
    odd = replace(whole, forces={**whole.forces, "X": table.forces["Y"]})
    assert float(by_rows(quality.symmetry([odd]))["X'"][3].split()[0]) > 50.0


def test_angles_that_are_not_images_of_each_other_are_no_pairs():
    assert not len(quality.mirror_pairs(planted([-4.0, 0.0, 4.5, 8.0])))
    assert len(quality.mirror_pairs(planted([-4.0, 0.0, 4.2, 8.0]))) == 1


def test_a_tare_that_moves_between_the_first_and_the_last_reading_is_shown():
    table = planted()
    y = np.array(table.forces["Y"])
    y[4] += 0.05 * np.abs(y).max()
    row = by_rows(quality.tares([planted(Y=y)]))["Y'"]
    assert row[2] == "2"
    assert row[-1] == "5 %"


def test_standard_errors_are_shown_over_the_largest_force_with_the_worst_row():
    table = planted()
    largest = np.abs(table.forces["Y"]).max()
    se = np.full(len(table), 0.01 * largest)
    se[2] *= 3.0
    row = by_rows(quality.convergence([replace(table, errors={"Y": se})]))["Y'"]
    assert row[3:] == ("1 %", "3 %", table.labels[2])


def test_the_figure_has_one_line_a_variable_and_none_where_nothing_varies():
    drawn = settings_figure(planted(), "settings")
    assert "7 levels from -8 to 8" in drawn.description
    assert settings_figure(planted([0.0, 0.0]), "settings") is None


def test_the_page_holds_them_all_and_the_gate_s_outliers():
    (section,) = quality_sections(small_study(ANGLES))
    titles = [t.title for t in section.tables]
    assert titles[0] == "Settings"
    assert "Symmetry of mirrored runs" in titles
    assert len(section.figures) == 1
