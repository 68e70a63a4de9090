"""Listings of Digital and Missile DATCOM. The samples are synthetic: CL = 4 sin(alpha), CD = .02 + .8 sin^2(alpha), CM = -1.5 sin(alpha)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import coeflab as cf
from coeflab.cli import app
from coeflab.core.errors import InputError
from coeflab.tables.importers import datcom
from coeflab.tables.reading import importer_of

SAMPLES = Path(__file__).parent / "samples" / "datcom"
DIGITAL, MISSILE = SAMPLES / "digital.out", SAMPLES / "for006.dat"
FOOT = 0.3048


def test_a_listing_of_digital_datcom_states_all_but_nothing_of_motion_sideways() -> None:
    table = datcom.raw(DIGITAL, {})
    assert importer_of(DIGITAL) == "datcom"
    assert [c.name for c in table.columns] == ["ALPHA", "CL", "CD", "CN", "CA", "CM", "BETA", "MACH"]
    assert table.stated["coefficients.area"].value == pytest.approx(10.0 * FOOT**2)
    assert table.stated["coefficients.length"].value == pytest.approx(2.0 * FOOT)
    assert table.stated["axes.reference_point"].value == pytest.approx((-5.0 * FOOT, 0.0, -0.5 * FOOT))
    assert table.dialect["configuration"] == "WING-BODY CONFIGURATION / SYNTHETIC GLIDER"
    assert table.column("ALPHA").values.tolist() == [-8, -6, -4, -2, 0, 2, 4, 6, 8, 10] * 2
    assert set(table.column("MACH").values) == {0.1, 0.8}
    assert table.lines[0] == 43, "of its row in the listing"


def test_another_configuration_is_wanted_by_its_title() -> None:
    body = datcom.raw(DIGITAL, {"configuration": "body alone"})
    assert np.abs(body.column("CL").values).max() < 0.1
    with pytest.raises(InputError, match="SYNTHETIC GLIDER"):
        datcom.raw(DIGITAL, {"configuration": "canard"})


def test_a_listing_of_missile_datcom_has_body_axes_and_sideslip(tmp_path: Path) -> None:
    text = MISSILE.read_text().replace("SIDESLIP =        .00 DEG", "SIDESLIP =       2.00 DEG")
    (path := tmp_path / "for006.dat").write_text(
        text.replace("     0.000     0.000     0.000\n", "    -0.200     0.050     0.000\n")
    )
    table = datcom.raw(path, {})
    assert table.dialect["configuration"] == "SYNTHETIC TORPEDO / BODY-FIN SET 1"
    assert table.column("BETA").values == pytest.approx(2.0)
    assert table.column("CLN").values == pytest.approx(0.05 * 0.7 / 0.35), "by the longitudinal length"
    angle = np.radians(table.column("ALPHA").values)
    turned = table.column("CN").values * np.cos(angle) - table.column("CA").values * np.sin(angle)
    assert turned == pytest.approx(table.column("CL").values, abs=2e-3), "both tables of a page are one row an angle"


@pytest.mark.parametrize(("path", "area"), [(DIGITAL, 10.0 / 2.0**2), (MISSILE, 0.1 / 0.35**2)])
def test_first_slopes_in_one_command_without_a_question(path: Path, area: float, tmp_path: Path) -> None:
    """Z = -D sin(alpha) - L cos(alpha): Zw' = -(4 + .02) S / L^2, Mw' = -1.5 S / L^2."""
    done = CliRunner().invoke(app, ["import", str(path), "--out", str(tmp_path / "out"), "--accept"])
    assert done.exit_code == 0, done.output
    found = cf.fit(tmp_path / "out")
    for symbol, value in {"Zw'": -4.02 * area, "Mw'": -1.5 * area}.items():
        assert found[symbol].value == pytest.approx(value, rel=0.015), "by three printed decimals"
