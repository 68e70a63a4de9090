"""The MSS function: its own assignments, the same in real Octave, give the force of the file."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.wording import matlab, one_line
from coeflab.formats.export import export
from coeflab.formats.mss import read as importer
from coeflab.formats.mss import write as mss
from coeflab.formats.mss.assignments import assignments
from coeflab.motion.simulation import simulate
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from tests.formats import files as made
from tests.formats.massed import torpedo

PAGE = Path(__file__).parents[2] / "docs" / "simulators.md"
GOLDEN = Path(__file__).parent / "golden" / "mss.m"
PRIMES = {"mass_prime": 1.0, "mass_moment_prime": 0.0}  # computed from the mass


def velocities(n: int = 50) -> np.ndarray:
    return np.random.default_rng(5).normal(size=(n, 6)) + np.array([1.5, 0, 0, 0, 0, 0])


def octave(folder: Path, script: str) -> np.ndarray:
    if shutil.which("octave-cli") is None:
        pytest.skip("GNU Octave (octave-cli) is not installed")
    (folder / "ask.m").write_text(script, encoding="utf-8")
    command = ["octave-cli", "--norc", "--quiet", "ask.m"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return np.array(done.stdout.split(), dtype=np.float64)


def written(folder: Path, file: object) -> str:
    for name, content in mss.render(file).items():
        (folder / name).write_bytes(content)
    return next(iter(mss.render(file))).removesuffix(".m")


def test_golden() -> None:
    """Regenerate by hand: write mss.render(plain()) to golden/mss.m and read the difference."""
    assert mss.render(made.plain()) == {"file.m": GOLDEN.read_bytes()}


@pytest.mark.parametrize("file", [made.full(1), made.full(2), made.plain(), made.at_rest()])
def test_its_force_is_the_files(file: object) -> None:
    nu = velocities()
    expected = force_law(file).force(nu)
    np.testing.assert_allclose(mss.force(mss.render(file), nu), expected, rtol=1e-12, atol=1e-9)


def test_the_munk_moment_is_counted_once() -> None:
    """In steady drift the yaw moment is the measured Nv, Nv|v| and Nuv alone; the added mass adds none."""
    file, speed, beta, length = made.plain(), 2.0, 0.1, 2.0
    v = speed * np.sin(beta)
    nu = np.array([[speed * np.cos(beta), v, 0.0, 0.0, 0.0, 0.0]])
    moment = mss.force(mss.render(file), nu)[0, 5]
    stated = 500.0 * length**3 * (-1.4e-2 * speed * v - 1e-2 * v * abs(v) + 1e-3 * nu[0, 0] * v)
    assert moment == pytest.approx(stated, rel=1e-12)


def test_nothing_is_lost() -> None:
    loss = export(made.full(3), "mss").loss
    assert loss.lossless
    assert any("no C_A(nu)" in c for c in loss.changes)


def test_a_product_with_an_acceleration_is_not_held() -> None:
    file = made.parameters({"Yv": -0.03, "Yvvdot": 0.1, "Yvdot": -0.02})
    assert mss.not_held(file) == ("Yvvdot (product with an acceleration)",)


@pytest.mark.slow
def test_real_octave_computes_the_same_force_and_added_mass(tmp_path: Path) -> None:
    file, nu = made.full(4), velocities(20)
    delta = np.random.default_rng(6).uniform(-0.4, 0.4, size=(20, 3))
    function = written(tmp_path, file)
    np.savetxt(tmp_path / "states.txt", np.hstack([nu, delta]), fmt="%.17g")
    found = octave(
        tmp_path,
        "s = dlmread('states.txt');\n"
        f"for k = 1:20\n  [tau, MA] = {function}(s(k,1:6)', s(k,7:9)');\n  printf('%.17g ', tau, MA);\nend\n"
        f"printf('%.17g ', {function}(s(1,1:6)'));\n",
    )
    by_state = found[:-6].reshape(20, 42)
    expected = force_law(file).force(nu) + made.control_force(file, nu, delta)
    scale = np.abs(expected).max(axis=0)
    assert np.abs(by_state[:, :6] - expected).max() <= 1e-9 * scale.min()
    matrix = np.array(file.added_mass.matrix)
    np.testing.assert_allclose(by_state[0, 6:].reshape(6, 6), matrix, rtol=1e-13, atol=1e-12 * matrix.max())
    np.testing.assert_allclose(found[-6:], force_law(file).force(nu[:1])[0], rtol=1e-9, atol=1e-9 * scale.min())


def test_the_thrust_that_keeps_the_speed_is_stated() -> None:
    """Prestero: 1.62 kg/m times (1.54 m/s)^2."""
    (said,) = [c for c in mss.changes(remus()) if "propulsion" in c]
    assert float(said.split(": ")[1].split()[0]) == pytest.approx(1.62 * 1.54**2, rel=1e-3)
    assert said in next(iter(mss.render(remus()).values())).decode()


def remus() -> ParameterFile:
    return read_parameter_file(shipped("cfd_data") / "remus100" / "remus100.parameters.json")


@pytest.mark.slow
def test_the_loop_of_the_page_is_our_own_turn(tmp_path: Path) -> None:
    written(tmp_path, remus())
    loop = re.search(r'title="mss/loop.m"\n(.*?)^```', PAGE.read_text(encoding="utf-8"), re.S | re.M)
    north, east, heading, speed = octave(tmp_path, loop[1])
    turn = {"rudder": float(np.radians(10.0)), "turns": 5.0, "longest": 30.0}
    ours = simulate(remus(), "turning_circle", turn).trajectory
    np.testing.assert_allclose((north, east), ours.position[-1, :2], atol=2e-3)
    assert heading == pytest.approx(np.degrees(ours.heading[-1]), abs=0.02)
    assert speed == pytest.approx(ours.speed[-1], abs=2e-4)


@pytest.mark.slow
def test_real_octave_reads_hostile_names(tmp_path: Path) -> None:
    for name in made.HOSTILE:
        folder = tmp_path / str(made.HOSTILE.index(name))
        folder.mkdir()
        function = written(folder, made.named(name))
        script = (
            f"[tau, MA, h] = {function}([1 0.1 0 0 0 0]');\nprintf('%d ', uint8(h.name)); printf('%.17g', tau(2));\n"
        )
        *letters, sway = octave(folder, script)
        assert bytes(int(x) for x in letters).decode() == one_line(name)
        assert sway == pytest.approx(force_law(made.plain()).force(np.array([[1, 0.1, 0, 0, 0, 0]]))[0, 1])


@pytest.mark.parametrize("name", made.HOSTILE)
def test_hostile_names_stay_names(name: str) -> None:
    (file, content), *others = mss.render(made.named(name)).items()
    assert not others
    assert re.fullmatch(r"[A-Za-z]\w{0,62}\.m", file, re.ASCII)
    assert file.removesuffix(".m") not in matlab()
    lines = assignments(content.decode())
    benign = assignments(next(iter(mss.render(made.plain()).values())).decode())
    assert [(a.line, a.target) for a in lines] == [(a.line, a.target) for a in benign]
    assert next(a.quoted for a in lines if a.target == "h.name") == one_line(name)


@pytest.mark.parametrize("file", [made.full(7), made.plain(), made.at_rest(), torpedo()])
def test_the_importer_gives_it_back(file: object, tmp_path: Path) -> None:
    function = written(tmp_path, file)
    back = importer.read(tmp_path / f"{function}.m")
    for c in file.coefficients:
        again = back.coefficient(c.symbol)
        assert again.value == pytest.approx(c.value, rel=1e-12)
        assert again.value_si == pytest.approx(c.value_si, rel=1e-12)
        assert again.law == c.law or "dot" in c.symbol
        assert (again.potential is None) == (c.potential is None)
    assert (back.added_mass is None) == (file.added_mass is None)
    if file.added_mass is not None:
        np.testing.assert_allclose(back.added_mass.matrix, file.added_mass.matrix, rtol=1e-12, atol=1e-12)
    masses = [f.model_dump()["mass"] for f in (back, file)]
    assert len({str(m and {**m, **PRIMES}) for m in masses}) == 1
    assert (back.scaling, back.reference_point, back.conditions) == (
        file.scaling,
        file.reference_point,
        file.conditions,
    )
    nu = velocities()
    np.testing.assert_allclose(force_law(back).force(nu), force_law(file).force(nu), rtol=1e-9, atol=1e-9)
