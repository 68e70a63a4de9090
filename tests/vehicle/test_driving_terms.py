"""A fitted term that would drive and is not told from zero is written as zero; what is told from zero fails in run and check alike."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.study.checks.plausibility import check
from coeflab.study.plan import plan_at
from coeflab.study.run import run
from coeflab.study.study import Study
from coeflab.vehicle.driving_terms import moved_to_zero
from coeflab.vehicle.own_numbers import typed_file
from coeflab.vehicle.plausibility import plausibility
from coeflab.vehicle.plausible_damping import driving_terms


def sweep(folder: Path, linear: float, noise: float) -> Study:
    """A shipped study whose X is ``linear u - 18.2 u|u|`` with noise, newtons; without its base file and motions."""
    source = shipped("cfd_data") / "flyingfish_water_synthetic"
    shutil.copytree(source, folder, dirs_exist_ok=True)
    head, *rows = (folder / "table.csv").read_text().splitlines()
    names = [n.split()[0] for n in head.split(",")]
    u, x = names.index("u"), names.index("X")
    rng, out = np.random.default_rng(3), [head]
    for line in rows:
        cells = line.split(",")
        ahead = float(cells[u])
        if ahead:
            cells[x] = f"{linear * ahead - 18.2 * ahead * abs(ahead) + noise * rng.standard_normal():.9g}"
        out.append(",".join(cells))
    (folder / "table.csv").write_text("\n".join(out) + "\n")
    toml = folder / "campaign.toml"
    toml.write_text("\n".join(line for line in toml.read_text().splitlines() if "sha256" not in line))
    plan = (folder / "plan.toml").read_text().partition("[[manoeuvre]]")[0].replace('base = "flyingfish_water"\n', "")
    (folder / "plan.toml").write_text(plan)
    return run(plan_at(folder / "plan.toml"))


def test_a_term_moved_to_zero_moves_the_others_as_least_squares_without_it() -> None:
    rng = np.random.default_rng(1)
    x = np.linspace(-1.0, 1.0, 21)
    columns = np.stack([x, x * np.abs(x), x**3], 1)
    y = columns @ np.array([0.1, -3.0, 0.7]) + 0.2 * rng.standard_normal(21)
    whole = np.linalg.lstsq(columns, y, rcond=None)[0]
    less = np.linalg.lstsq(columns[:, 1:], y, rcond=None)[0]
    found = moved_to_zero(whole, np.linalg.inv(columns.T @ columns), 0)
    assert found == pytest.approx([0.0, *less], rel=1e-9)


def test_a_driving_term_not_told_from_zero_is_written_as_zero_and_said(tmp_path: Path) -> None:
    study = sweep(tmp_path / "few", 0.4, 1.0)
    (file,) = study.parameter_files.values()
    fitted = study.fits[0].coefficients["Xu"]
    assert 0.0 < fitted.value < fitted.u95
    written, quadratic = file.coefficient("Xu"), file.coefficient("Xu|u|")
    assert (written.value, written.value_si) == (0.0, 0.0)
    assert written.u95 == pytest.approx(fitted.u95 + fitted.value)
    own = study.fits[0].coefficients["Xu|u|"].value
    assert own < quadratic.value < 0.0
    at = file.covariance.symbols.index("Xu'")
    assert file.covariance.matrix[at][at] == pytest.approx((written.u95 / 2.0) ** 2)
    table = next(m for m in file.models if m.response == "X")
    assert table.terms[0].value == 0.0
    found = next(f for f in file.findings if f.code == "law.driving_term_at_zero" and "Xu'" in f.subject)
    assert (found.statistic, found.threshold, found["moved"]) == (fitted.value, fitted.u95, ("Xu|u|'",))
    assert driving_terms(file) == []
    assert not any(c.severity is Severity.FAIL for c in plausibility(file))
    assert any(c.severity is Severity.WARN and "Xu'" in c.subject for c in check(study))


def test_a_driving_term_told_from_zero_fails_in_run_as_in_params_check(tmp_path: Path) -> None:
    study = sweep(tmp_path / "few", 8.0, 0.05)
    (file,) = study.parameter_files.values()
    written = file.coefficient("Xu")
    assert written.value > 0.0
    in_check = {c.statistic for c in plausibility(file) if c.severity is Severity.FAIL}
    assert in_check
    assert in_check <= {c.statistic for c in study.checks if c.severity is Severity.FAIL}
    assert study.failed


def test_what_is_stated_is_not_touched(tmp_path: Path) -> None:
    """A literature value has no scatter of ours: the check fails it."""
    study = sweep(tmp_path / "few", 0.4, 1.0)
    (file,) = study.parameter_files.values()
    wrong = tuple(
        replace(c, value=1.0, value_si=1.0, u95=2.0, origin="literature") if c.symbol == "Xu'" else c
        for c in file.coefficients
    )
    assert any(c.severity is Severity.FAIL for c in plausibility(file.model_copy(update={"coefficients": wrong})))


def test_a_driving_slope_is_shown_as_the_file_has_it_at_its_speed() -> None:
    """0.049 * 1/2 * 1025 * 1.8 * 1.96^2 = 173.6 N/(m/s), not the 96.5 of its product with U."""
    file = typed_file("t", ["Yv'=0.049"], length="1.96 m", length_name="LOA", speed="1.8", density="1025", about="cg")
    (found,) = (c for c in plausibility(file) if c.severity is Severity.FAIL)
    assert "173.6 (SI)" in str(found.statistic)
