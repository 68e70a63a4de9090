"""Fitted models as tables: coefficients, quality, influential points, correlations."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.report.tables import models as model_tables
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.report.studies import LENGTH


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
    assert "u -1.50 .. 1.50 m/s" in table.rows[0]


def test_diagnostics_are_those_of_the_kernel():
    m = damping()[0]
    table = model_tables.diagnostics([m])
    row = dict(zip(table.headers, table.rows[0], strict=True))
    press = float(np.sum(m.fit.left_out**2))
    assert float(row["PRESS"]) == pytest.approx(press, rel=5e-3)
    assert float(row["predicted R2"]) == pytest.approx(1.0 - press / np.sum(m.y**2), rel=1e-4)
    assert float(row["largest leverage"]) == pytest.approx(m.fit.leverage.max(), rel=5e-3)
    high = int(np.sum(m.fit.leverage > 2.0 * 2 / m.n_points))
    assert row["high leverage"].startswith(f"{high} > ")


def test_of_many_terms_only_close_pairs_are_shown():
    from coeflab.fits import FITS

    tables = read_tables(PlannedTable(shipped("cfd_data") / "huuv_synthetic", (), {}))
    m = FITS.load("surface").fit(tables, LENGTH, {"responses": "C_D"}).models[0]
    table = model_tables.correlations(m)
    above = np.triu(np.abs(m.fit.correlation), 1)
    assert len(table.rows) == min(int(np.sum(above > 0.9)), 12)
    assert abs(float(table.rows[0][2])) == pytest.approx(above.max(), abs=1e-3)
    assert all(abs(float(row[2])) >= 0.9 for row in table.rows)
