"""Parameter files of publications give the forces of the publications' own equations."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.glider.glider_file import read_glider
from coeflab.motion.vehicle import vehicle
from coeflab.published.flyingfish.model import CONSTANTS, ROTORS, read_flyingfish
from coeflab.published.flyingfish.rotors import steady_residuals
from coeflab.published.parameter_files import THAUV_MASS, flyingfish_file, thauv_file
from coeflab.vehicle.parameter_file import ParameterFile


def test_the_flyingfish_file_leaves_what_the_equations_leave_at_the_printed_points() -> None:
    """All but N, whose lever the paper prints with the other sign than the rotors' places give."""
    fish = read_flyingfish()
    craft = vehicle(ParameterFile.model_validate_json(flyingfish_file(fish).to_json()))
    constants = np.array([fish.constants[name] for name in CONSTANTS])
    theirs = steady_residuals(fish.rotors, constants, fish.motion, fish.angles, fish.speeds)
    for row, (u, w, r, phi, theta) in enumerate(fish.motion):
        commands = {f"rotor{n}": float(s) for n, s in zip(ROTORS, fish.speeds[row], strict=True)}
        commands |= {f"rotor{n}.tilt": float(a) for n, a in zip(ROTORS, fish.angles[row], strict=True)}
        nu, half = np.array([[u, 0.0, w, 0.0, 0.0, r]]), np.array([phi, theta]) / 2.0
        (sp, st), (cp, ct) = np.sin(half), np.cos(half)
        attitude = np.array([[cp * ct, sp * ct, cp * st, -sp * st]])
        rates = craft.acceleration(nu, attitude, np.zeros((1, 3)), craft.wrench(commands))[0]
        left = craft.effective_mass @ rates
        np.testing.assert_allclose(np.abs(left[:5]), np.abs(theirs[row, :5]), atol=2e-5)


@pytest.mark.parametrize("case", ["01", "02", "03"])
@pytest.mark.parametrize("alpha", [-0.2, 0.0, 0.1])
def test_the_thauv_file_has_the_glider_s_polar_and_munk_moment(case: str, alpha: float) -> None:
    glider = read_glider(Path(str(shipped("cfd_data"))) / "thauv" / f"case_{case}.toml")
    craft = vehicle(ParameterFile.model_validate_json(thauv_file(glider).to_json()), free=("u", "w", "q"))
    speed, turn, body = 0.4, 0.02, glider.body
    nu = np.array([[speed * np.cos(alpha), 0.0, speed * np.sin(alpha), 0.0, turn, 0.0]])
    x, _, z, _, m, _ = craft.force(nu, np.zeros((1, 3)))[0]
    u, w = nu[0, 0], nu[0, 2]
    added = glider.mass.surge - THAUV_MASS, glider.mass.heave - THAUV_MASS
    x, z = x + added[1] * w * turn, z - added[0] * u * turn  # less what the added mass adds in a turn
    lift, drag = body.polar.lift_at(np.array(alpha)), body.polar.drag_at(np.array(alpha))
    assert x * np.sin(alpha) - z * np.cos(alpha) == pytest.approx(lift * speed**2, rel=1e-9)
    assert -x * np.cos(alpha) - z * np.sin(alpha) == pytest.approx(drag * speed**2, rel=1e-9)
    moment = body.polar.moment_at(np.array(alpha)) * speed**2 - glider.polar.pitch_damping * speed * turn
    assert m == pytest.approx(moment + body.munk * u * w, rel=1e-9)
    below = craft.restoring(np.array([[np.cos(0.1), 0.0, np.sin(0.1), 0.0]]))[0, 4]
    assert below == pytest.approx(-glider.mass.moment_ahead * np.cos(0.2) - glider.mass.moment_below * np.sin(0.2))
