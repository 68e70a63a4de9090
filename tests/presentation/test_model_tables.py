"""Fitted models as tables: coefficients, quality, influential points, correlations."""

from __future__ import annotations

import numpy as np

from coeflab.core.files import shipped
from coeflab.model.study import PlannedTable
from coeflab.presentation import model_tables
from coeflab.workbench import read_tables
from tests.presentation.studies import LENGTH


def damping():
    from coeflab.fits import FITS

    tables = read_tables(PlannedTable(shipped("cfd_data") / "flyingfish_water_synthetic", (), {}))
    return FITS.load("linear_quadratic_damping").fit(tables, LENGTH, {}).models


def test_the_most_influential_points_come_first():
    m = damping()[0]
    table = model_tables.influence(m)
    worst = int(np.argmax(m.fit.cooks_distance))
    assert table.rows[0][0] == m.labels[worst]
    assert len(table.rows) == 5
    found = [float(row[1]) for row in table.rows]
    assert found == sorted(found, reverse=True)


def test_correlations_are_a_lower_triangle_with_ones():
    m = damping()[0]
    rows = model_tables.correlations(m).rows
    assert [float(row[1 + i]) for i, row in enumerate(rows)] == [1.0, 1.0]
    assert rows[0][2] == ""
    assert float(rows[1][1]) < -0.9


def test_quality_has_a_row_a_model_and_names_the_domain():
    models = damping()
    table = model_tables.quality(models)
    assert [row[0] for row in table.rows] == ["X", "Y", "Z", "K", "M", "N"]
    assert "u -1.50 .. 1.50" in table.rows[0]
