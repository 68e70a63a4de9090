"""A real OpenFOAM, from its dictionaries to Yv': a spheroid in five oblique flows, run, imported, turned to FRD and fitted."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import openfoam
from coeflab.tables.raw_table import Ended, RawTable, Run
from tests.conftest import SECTIONS

CASE = Path(__file__).with_name("openfoam_case")
DRIFT = (-8.0, -4.0, 0.0, 4.0, 8.0)  # deg
SPEED, DENSITY, LENGTH, DIAMETER, LAST = 1.0, 1000.0, 4.0, 1.0, 20
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        shutil.which("simpleFoam") is None, reason="OpenFOAM is not installed: apt-get install openfoam"
    ),
]


def solve(folder: Path, *command: str) -> None:
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    (folder / f"log.{command[0]}").write_text(done.stdout)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr


def flow(beta: float) -> tuple[float, float]:
    """Water past the body, in axes x aft, y to starboard, when it moves with v = -U sin(beta)."""
    angle = np.radians(beta)
    return SPEED * np.cos(angle), SPEED * np.sin(angle)


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case with its mesh."""
    folder = shutil.copytree(CASE, tmp_path_factory.mktemp("openfoam") / "mesh", ignore=lambda *_: {"arm"})
    solve(folder, "blockMesh")
    solve(folder, "transformPoints", "-scale", "(2 0.5 0.5)")
    return folder


@pytest.fixture(scope="module")
def runs(mesh: Path) -> list[Run]:
    """Five inflows."""
    out = []
    for beta in DRIFT:
        folder = shutil.copytree(mesh, mesh.with_name(f"beta_{beta:+.0f}"))
        inflow = folder / "0/include/inflow"
        text = inflow.read_text()
        assert "(1 0 0)" in text
        inflow.write_text(text.replace("(1 0 0)", "({:.10f} {:.10f} 0)".format(*flow(beta))))
        solve(folder, "simpleFoam")
        out.append(openfoam.run(folder, {}))
    return out


def last(table: RawTable) -> np.ndarray:
    """Mean of the last iterations."""
    columns = [table.meaning(c) for c in COMPONENTS]
    return np.array([c.values[-LAST:].mean() for c in columns if c is not None])


@pytest.fixture
def fitted(runs: list[Run], read_table: Callable[..., ForceTable]) -> FitResult:
    names = ("u", "v", "w", *COMPONENTS)
    head = [f"{n} [{'m/s' if n in 'uvw' else 'N' if n in 'XYZ' else 'N*m'}]" for n in names]
    rows = [[float(str(run.conditions[n].value)) for n in "uvw"] + list(last(run.history)) for run in runs]
    text = "\n".join([",".join(head), *(",".join(f"{v:.10g}" for v in row) for row in rows)]) + "\n"
    axes = SECTIONS["axes"].replace('frame = "FRD"', 'frame = "CFD"').replace("[-2.0, 0.0, 0.0]", "[0.0, 0.0, 0.0]")
    table = read_table(
        text, axes=axes.replace('datum = "nose"', 'datum = "centre"'),
        scaling=f'length = {LENGTH}\nlength_name = "LOA"', conditions=f"speed = {SPEED}\ndensity = {DENSITY}",
    )  # fmt: skip
    return FITS.load("slope_at_origin").fit([table], table.scaling, {})


def test_every_run_is_read_whole_with_its_conditions(runs: list[Run]) -> None:
    for run, beta in zip(runs, DRIFT, strict=True):
        assert (run.ended, len(run.history)) == (Ended.WHOLE, 120)
        found = [float(str(run.conditions[n].value)) for n in ("u", "v", "w", "U", "cells")]
        np.testing.assert_allclose(found, [-flow(beta)[0], -flow(beta)[1], 0.0, SPEED, 17280], atol=1e-9)
        assert run.conditions["u"].place == "0/U:12"
        stated = {k: s.value for k, s in run.history.stated.items()}
        assert stated["conditions.density"] == DENSITY
        assert stated["conditions.viscosity"] == 2e-3
        assert stated["axes.reference_point"] == (0.0, 0.0, 0.0)
        assert run.history.dialect["version"] == "v1912"
        np.testing.assert_allclose(last(run.patches["pressure"]) + last(run.patches["viscous"]), last(run.history))
        by_coefficients = openfoam.run(run.path, {"function": "coefficients"})
        np.testing.assert_allclose(last(by_coefficients.history), last(run.history), rtol=1e-7, atol=1e-6)


def test_port_and_starboard_mirror(runs: list[Run]) -> None:
    forces = np.array([last(run.history) for run in runs])
    side = np.abs(forces[:, 1]).max()
    np.testing.assert_allclose(forces[:, 1], -forces[::-1, 1], atol=0.01 * side)
    np.testing.assert_allclose(forces[:, 5], -forces[::-1, 5], atol=0.01 * np.abs(forces[:, 5]).max())
    np.testing.assert_allclose(forces[:, 0], forces[::-1, 0], rtol=0.01)
    # Nothing heaves.
    assert np.abs(forces[:, 2]).max() < 0.02 * side


def test_slopes_of_the_runs_are_those_of_a_slender_body(fitted: FitResult) -> None:
    value = {n: fitted.coefficients[n].value for n in ("Yv", "Nv")}
    # Jones's slender wing of the same span bounds the side force: Yv' = -(pi / 2) (D / L)^2.
    jones = 0.5 * np.pi * (DIAMETER / LENGTH) ** 2
    assert -jones < value["Yv"] < -0.3 * jones
    # Nv' is a part of Munk's moment -(m_yy - m_xx) u v: viscous stern flow takes some of it away.
    added = ellipsoid_added_mass(np.array([LENGTH, DIAMETER, DIAMETER]) / 2.0, DENSITY)
    munk = (added[1, 1] - added[0, 0]) / (0.5 * DENSITY * LENGTH**3)
    assert -munk < value["Nv"] < -0.4 * munk


def test_drag_is_that_of_a_laminar_boundary_layer(runs: list[Run]) -> None:
    # Blasius on the wetted surface at Re = 2000; the layer is as thick as the body, so more than on a plate, and less than thrice.
    eccentricity = np.sqrt(1.0 - (DIAMETER / LENGTH) ** 2)
    wetted = 0.5 * np.pi * DIAMETER**2 * (1.0 + LENGTH / DIAMETER * np.arcsin(eccentricity) / eccentricity)
    plate = 0.5 * DENSITY * SPEED**2 * wetted * 1.328 / np.sqrt(2000.0)
    assert plate < last(runs[2].patches["viscous"])[0] < 3.0 * plate


def test_on_the_arm_the_body_goes_forwards_and_is_damped(mesh: Path, runs: list[Run]) -> None:
    folder = shutil.copytree(mesh, mesh.with_name("arm"))
    shutil.copytree(CASE / "arm", folder, dirs_exist_ok=True)
    solve(folder, "topoSet", "-constant")
    solve(folder, "simpleFoam")
    run = openfoam.run(folder, {})
    # Axes x aft, y to starboard, z up: 1 m/s forwards, about a centre 10 m to starboard.
    found = [float(str(run.conditions[n].value)) for n in "uvwpqr"]
    np.testing.assert_allclose(found, [-SPEED, 0.0, 0.0, 0.0, 0.0, -0.1], atol=1e-12)
    # OpenFOAM's own forces say the same: they hold back the way, nearly as much as without the turn, and the turn.
    force = last(run.history)
    assert force[0] == pytest.approx(last(runs[2].history)[0], rel=0.1)
    assert force[5] * found[5] < 0.0
