"""The C source: compiled as C99 and as C++17 without a warning, it gives the conformance vectors; its step is ours; names are inert."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity
from coeflab.core.texts import words
from coeflab.formats.c_program import program as c
from coeflab.formats.export import export
from coeflab.formats.flat_law import feet, flat_law
from coeflab.law.domain import Domain
from coeflab.law.symbols import MOTIONS
from coeflab.motion.dynamics import restoring
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.conform import VectorSet, compared, vector_sets
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import torpedo, with_mass
from tests.formats.of_a_vehicle import driven
from tests.vehicle.hybrid import hybrid
from tests.vehicle.make_conformance import actual_commands

GCC, GXX = shutil.which("gcc"), shutil.which("g++")
needs_gcc = pytest.mark.skipif(GCC is None or GXX is None, reason="no gcc")
STRICT = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-O0"]
SETS = {s.name: s for s in vector_sets()}
DRIVER = """
#include "NAME.h"
#include <stdio.h>
int main(void)
{
    double x[13], more[6], command[UPPER_THRUSTERS + 1], tilt[UPPER_THRUSTERS + 1], thrust[6], force[6], rates[6];
    int i, n, refused;
    for (;;) {
        for (i = 0; i < 13; i++) if (scanf("%lf", x + i) != 1) return 0;
        for (n = 0; n < UPPER_THRUSTERS; n++) if (scanf("%lf %lf", command + n, tilt + n) != 2) return 1;
        if (scanf("%lf", more) != 1) return 1;
        NAME_thrust(command, tilt, thrust);
        thrust[0] += more[0];
        refused = NAME_force(x, x + 6, force);
        NAME_acceleration(x, x + 9, x + 6, thrust, rates);
        printf("%d", refused);
        for (i = 0; i < 6; i++) printf(" %.17g", force[i]);
        for (i = 0; i < 6; i++) printf(" %.17g", rates[i]);
        printf("\\n");
    }
}
"""


def of(given: VectorSet) -> ParameterFile:
    return ParameterFile.model_validate_json(json.dumps(given.parameters)).model_copy(update={"name": given.name})


def compiled(folder: Path, file: ParameterFile, main: str, compiler: str = "gcc", standard: str = "c99") -> Path:
    for name, content in c.render(file).items():
        (folder / name).write_bytes(content)
    name = c.name_of(file)
    (folder / "driver.c").write_text(main.replace("NAME", name).replace("UPPER", name.upper()), encoding="utf-8")
    language = ["-x", "c++"] if compiler == "g++" else []
    command = [compiler, f"-std={standard}", *STRICT, *language, f"{name}.c", "driver.c", "-o", "driver", "-lm"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder / "driver"


@needs_gcc
@pytest.mark.parametrize("name", SETS)
def test_it_gives_the_conformance_vectors(tmp_path: Path, name: str) -> None:
    given = SETS[name]
    file = of(given)
    if name == "no_diagonal":  # what cannot move is no program
        with pytest.raises(InputError, match="positive definite"):
            flat_law(file)
        return
    free = "".join(MOTIONS[k] for k in flat_law(file).free)
    driver, rows = compiled(tmp_path, file, DRIVER), []
    for s in given.states:
        commands = actual_commands(file, s)
        orders = [x for t in file.thrusters for x in (commands.get(t.name, 0.0), commands.get(f"{t.name}.tilt", 0.0))]
        rows.append(
            [
                *s["nu"],
                *s.get("delta", [0.0] * 3),
                *s.get("attitude", [1.0, 0.0, 0.0, 0.0]),
                *orders,
                commands.get("thrust", 0.0),
            ]
        )
    text = "\n".join(" ".join(map(repr, r)) for r in rows)
    done = subprocess.run([driver], input=text, capture_output=True, text=True, check=True)
    answers = []
    for line, v in zip(done.stdout.splitlines(), given.vectors, strict=True):
        refused, *numbers = map(float, line.split())
        comparable = v["acceleration"] is not None and v.get("free", "uvwpqr") == free
        rates = numbers[6:] if comparable else v["acceleration"]
        answers.append({"force": None if refused else numbers[:6], "acceleration": rates})
    (found,) = compared(given, answers)
    assert found.severity is Severity.PASS, words(found)
    assert any(v.get("free", "uvwpqr") == free for v in given.vectors) or not free


@needs_gcc
@pytest.mark.parametrize("name", ["torpedo", "domains"])
def test_as_cpp17_and_its_own_check_passes(tmp_path: Path, name: str) -> None:
    check = c.render(of(SETS[name]))[f"{name}_check.c"].decode().replace(name, "NAME")
    driver = compiled(tmp_path, of(SETS[name]), check, "g++", "c++17")
    done = subprocess.run([driver], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert "24 states" in done.stdout


STEPS = """
#include "NAME.h"
#include <stdio.h>
int main(void)
{
    NAME_state s = {{0, 0, 0}, {1, 0, 0, 0}, {1.5, 0, 0, 0, 0, 0}, {0, 0, 0}};
    const double order[3] = {0.3, 0, 0}, push[6] = {2, 0, 0, 0, 0, 0};
    int k, i, status = 0;
    for (k = 0; k < 200; k++) status += NAME_step(&s, order, push, 0.01);
    for (i = 0; i < 3; i++) printf("%.17g ", s.position[i]);
    for (i = 0; i < 4; i++) printf("%.17g ", s.attitude[i]);
    for (i = 0; i < 6; i++) printf("%.17g ", s.nu[i]);
    printf("%.17g %d\\n", s.angles[0], status);
    return 0;
}
"""


@needs_gcc
def test_its_step_is_ours_and_a_fin_turns_at_its_rate(tmp_path: Path) -> None:
    file = driven()
    driver = compiled(tmp_path, file, STEPS)
    *state, angle, status = map(
        float, subprocess.run([driver], capture_output=True, text=True, check=True).stdout.split()
    )
    assert status == 0
    moved = vehicle(file)
    h = moved.hydrostatics

    def rates(x: np.ndarray, t: float) -> np.ndarray:
        q, nu = x[3:7], x[7:]
        delta = np.array([[min(0.3, 0.2 * t), 0.0, 0.0]])
        push = np.array([2.0, 0, 0, 0, 0, 0])
        v, w = nu[:3], nu[3:]
        way = v + 2.0 * (q[0] * np.cross(q[1:], v) + np.cross(q[1:], np.cross(q[1:], v)))
        spin = [-0.5 * q[1:] @ w, *(0.5 * (q[0] * w + np.cross(q[1:], w)))]
        still = restoring(
            q[None] / np.linalg.norm(q), moved.weight, moved.buoyancy, moved.centre, np.array(h.centre_of_buoyancy)
        )
        total = moved.unbalanced(nu[None], np.array([[1.0, 0, 0, 0]]), delta, push)
        level = restoring(
            np.array([[1.0, 0, 0, 0]]), moved.weight, moved.buoyancy, moved.centre, np.array(h.centre_of_buoyancy)
        )
        return np.concatenate([way, spin, ((total - level + still) @ moved.inverse_inertia().T)[0]])

    x, dt = np.array([0, 0, 0, 1.0, 0, 0, 0, 1.5, 0, 0, 0, 0, 0]), 0.01
    for k in range(200):
        t = k * dt
        a = rates(x, t)
        b = rates(x + dt / 2 * a, t + dt / 2)
        d = rates(x + dt / 2 * b, t + dt / 2)
        x = x + dt / 6 * (a + 2 * b + 2 * d + rates(x + dt * d, t + dt))
        x[3:7] /= np.linalg.norm(x[3:7])
    np.testing.assert_allclose(state, x, rtol=0.0, atol=1e-9)
    assert angle == pytest.approx(0.3)


@pytest.mark.parametrize("file", [hybrid(), torpedo(), driven()])
def test_it_holds_all_of_a_file(file: ParameterFile) -> None:
    out = export(file, "c")
    assert out.lossless, [str(x) for x in out.loss.lost]


def test_a_coefficient_5_percent_off_is_seen() -> None:
    files = dict(c.render(torpedo()))
    nu = np.random.default_rng(2).normal(size=(20, 6))
    text = files["file.c"].decode()
    values = re.search(r"VALUES\[\d+\] = \{([^,]+),", text)[1]
    files["file.c"] = text.replace(values, repr(1.05 * float(values)), 1).encode()
    assert np.abs(c.force(files, nu) - motion_law(torpedo())[0].force(nu)).max() > 1e-4


def test_feet_of_a_hull_are_its_nearest_points() -> None:
    rng = np.random.default_rng(3)
    from coeflab.law.domain import half_spaces

    for d in (1, 2, 3):
        points = rng.normal(size=(12, d)) * np.array([1.0, 3.0, 0.2])[:d]
        hull = Domain(tuple("vwr"[:d]), points.min(axis=0), points.max(axis=0), half_spaces(points))
        faces, maps = feet(hull)
        outside = rng.normal(size=(50, d)) * np.array([3.0, 9.0, 0.6])[:d]
        nearest, size = hull.read(outside)[0], hull.high - hull.low
        for x, due in zip(outside, nearest, strict=True):
            y = (x - hull.low) / size
            each = maps[:, :, :-1] @ y + maps[:, :, -1]
            inside = np.all(each @ faces[:, :-1].T - faces[:, -1] <= 1e-9, axis=1)
            best = each[inside][np.argmin(np.linalg.norm(each[inside] - y, axis=1))]
            if not hull.contains(x[None])[0]:
                np.testing.assert_allclose(hull.low + size * best, due, atol=1e-9)


@pytest.mark.parametrize("name", [*made.HOSTILE, "a */ int x; /*", "??/\n#error", "int", "x\\"])
def test_names_that_hurt(name: str) -> None:
    file = with_mass(made.named("file")).model_copy(update={"name": name, "body": name})
    for written, content in c.render(file).items():
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,62}\.[ch]", written)
        text = content.decode("ascii")
        assert text.count("/*") == text.count("*/")
        assert "??" not in text
        assert not re.search(r"\\$(?<!\\n\\)", text.split("#include")[0], re.MULTILINE)
