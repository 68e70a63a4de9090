"""Tables over incidence, rate terms of an arm and thrusters in one law: turns and tuning against a solution that shares no code.

The planted vehicle has C_D, C_S, C_n over drift, Y and N over the rate of turn, two thrusters, and no added mass but what its law
carries into a turn: X_vr = m_y and X_rr = m_yr, which the file computes from its parts and the solution here takes from the file.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.stats import t as student

AREA, L, RHO, MASS, U, ARM = 0.045, 1.1, 1000.0, 36.0, 0.8, 0.15
PLANTED = {"s1": 2.2, "s3": 4.0, "n1": 0.06, "n3": 0.3, "nr": 0.6, "nrr": 3.0, "d0": 0.35, "d2": 1.1, "yr": 2.0}
TURNS = (50.0, 40.0, 30.0, 20.0, 0.0)  # left thruster, %, with the right one at 60

CAMPAIGN = """[campaign]
name = "{name}"
title = "{name}"
body = "hybrid"
[axes]
frame = "FRD"
alpha = "w = +U sin(alpha)"
beta = "v = +U sin(beta)"
datum = "cb"
reference_point = [0.0, 0.0, 0.0]
[scaling]
length = 1.1
length_name = "LOA"
[conditions]
density = 1000.0
speed = 0.8
[source]
citation = "own numbers"
kind = "synthetic"
how_obtained = "computed"
[[table]]
file = "table.csv"
contains_inertia = false
"""
BODY = """[body]
name = "hybrid"
title = "Hull of one cylinder and two bow fins"
reader = "primitives"
datum = "cb"
reference_point = [0.0, 0.0, 0.0]
[source]
citation = "own numbers"
kind = "synthetic"
[prime]
length = 1.1
length_name = "LOA"
[[part]]
name = "hull"
form = "cylinder"
radius = 0.1
length = 1.1
centre = [0.0, 0.0, 0.0]
[[part]]
name = "keel"
form = "plate"
chord = 0.15
span = 0.2
centre = [0.35, 0.0, -0.2]
rotation = ["90 deg", "0 deg", "0 deg"]
[[configuration]]
name = "hybrid"
volume = 0.036
centre_of_buoyancy = [0.0, 0.0, 0.0]
mass = "36.0 kg"
centre_of_gravity = [0.0, 0.0, 0.04]
inertia_matrix = [[0.25, 0.0, 0.0], [0.0, 3.6, 0.0], [0.0, 0.0, 3.6]]
""" + "".join(
    f'[[thruster]]\nname = "{name}"\nplace = [-0.5, {y}, 0.0]\naxis = [1.0, 0.0, 0.0]\ncommand = "share"\nunit = "%"\n'
    "curve = [[-100, -20], [-10, 0], [10, 0], [100, 30]]\n"
    for name, y in (("left", -ARM), ("right", ARM))
)
PLAN = """[study]
name = "hybrid"
title = "hybrid"
[body]
path = "body.toml"
[[table]]
campaign = "static"
fits = ["surface"]
options.surface = { degree = 3, area = "0.045 m^2", area_name = "frontal" }
[[table]]
campaign = "arm"
fits = ["slope_at_origin", "tied_law"]
[[parameter_file]]
name = "hybrid"
body = "hybrid"
campaigns = ["static", "arm"]
added_mass = "body.toml"
added_mass_method = "primitives"
"""
TUNE = """[tune]
name = "pool"
parameters = "reports/hybrid/hybrid.parameters.json"
[measured]
table = "tune.csv"
where = { source = "pool" }
magnitudes = ["beta"]
errors = { u = "0.02 m/s", beta = "0.5 deg", radius = "0.05 m" }
[[free]]
places = ["Nr'"]
[[free]]
places = ["C_S C_S_beta"]
[[free]]
places = ["C_n C_n_beta"]
"""
FREE = {"C_S C_S_beta": "s1", "Nr'": "nr", "C_n C_n_beta": "n1"}


def hull(u: float, v: float, r: float, c: dict[str, float]) -> np.ndarray:
    """X, Y, N of the hull in the plane, N and N m."""
    speed = np.hypot(u, v)
    b, q = np.arcsin(v / speed), 0.5 * RHO * (u * u + v * v) * AREA
    drag, side = q * (c["d0"] + c["d2"] * b * b), -q * (c["s1"] * b + c["s3"] * b**3)
    return np.array([
        -np.cos(b) * drag - np.sin(b) * side,
        -np.sin(b) * drag + np.cos(b) * side + c["yr"] * r * speed / U,
        q * L * (c["n1"] * b + c["n3"] * b**3) - c["nr"] * r * speed / U - c["nrr"] * r * abs(r),
    ])  # fmt: skip


def turn(left: float, c: dict[str, float], m_y: float, m_yr: float) -> np.ndarray:
    """u, v, r of the steady turn at a command of the left thruster."""
    push = [0.0 if s < 10.0 else (s - 10.0) / 3.0 for s in (left, 60.0)]

    def rest(x: np.ndarray) -> np.ndarray:
        u, v, r = x
        own = np.array([(MASS + m_y) * v * r + m_yr * r * r + sum(push), -MASS * u * r, ARM * (push[0] - push[1])])
        return np.asarray(hull(u, v, r, c) + own)

    found, _, flag, _ = fsolve(rest, (1.2, 0.25, -0.5), full_output=True)
    assert flag == 1
    return np.asarray(found)


def seen(x: np.ndarray) -> tuple[float, float, float]:
    """u, drift in deg, radius."""
    speed = np.hypot(x[0], x[1])
    return x[0], float(np.degrees(np.arcsin(x[1] / speed))), speed / abs(x[2])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("hybrid")
    rng = np.random.default_rng(8)
    for name in ("static", "arm"):
        (out / name).mkdir()
        (out / name / "campaign.toml").write_text(CAMPAIGN.format(name=name))
    lines = ["alpha [deg],beta [deg],X [N],Y [N],Z [N],M [N*m],N [N*m]"]
    q = 0.5 * RHO * U * U * AREA
    for a in np.radians(np.arange(-25.0, 26.0, 10.0)):
        for b in np.radians(np.arange(0.0, 26.0, 5.0)):
            drag = PLANTED["d0"] + a * a + PLANTED["d2"] * b * b
            side, lift = -(PLANTED["s1"] * b + PLANTED["s3"] * b**3), 1.4 * a + 2.0 * a**3
            ca, sa, cb, sb = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
            force = np.array(
                [
                    -ca * cb * drag - ca * sb * side + sa * lift,
                    -sb * drag + cb * side,
                    -sa * cb * drag - sa * sb * side - ca * lift,
                ]
            )
            moment = L * np.array([0.35 * a - 0.2 * a**3, PLANTED["n1"] * b + PLANTED["n3"] * b**3])
            row = (np.degrees(a), np.degrees(b), *(q * np.r_[force, moment] * (1.0 + 5e-4 * rng.normal(size=5))))
            lines.append(",".join(f"{x:.7g}" for x in row))
    (out / "static/table.csv").write_text("\n".join(lines) + "\n")
    lines = ["u [m/s],r [rad/s],N [N*m],Y [N]"]
    for r in (-1.2, -0.8, -0.5, -0.25, 0.25, 0.5, 0.8, 1.2):
        _, y, n = hull(U, 0.0, r, PLANTED) * (1.0 + 1e-3 * rng.normal(size=3))
        lines.append(f"{U},{r},{n:.7g},{y:.7g}")
    (out / "arm/table.csv").write_text("\n".join(lines) + "\n")
    for name, text in (("body.toml", BODY), ("plan.toml", PLAN), ("tune.toml", TUNE)):
        (out / name).write_text(text)
    return out


def test_turns_and_what_they_determine(folder: Path, coeflab: Callable[..., object]) -> None:
    ran = coeflab("run", "plan.toml", cwd=folder)
    assert ran.returncode == 0, ran.stdout  # type: ignore[attr-defined]
    file = folder / "reports/hybrid/hybrid.parameters.json"
    matrix = np.array(json.loads(file.read_text())["added_mass"]["matrix"])
    m_y, m_yr = matrix[1, 1], matrix[1, 5]
    for left in TURNS:
        done = coeflab(
            "trim",
            file,
            "--commands",
            f"left={left} right=60",
            "--free",
            "u,v,r",
            "--near",
            "u=1.2",
            "--starts",
            "1",
            "--json",
            cwd=folder,
        )
        found = {x["name"]: x["value"] for x in json.loads(done.stdout)["unknowns"]}  # type: ignore[attr-defined]
        truth = turn(left, PLANTED, m_y, m_yr)
        assert [found["u"], found["v"], found["yaw_rate"]] == pytest.approx(truth, rel=0.02)

    turns = [x for x in TURNS if x != 40.0]
    rows = [
        ",".join(f"{x:.8g}" for x in (left, 60.0, *seen(turn(left, PLANTED, m_y, m_yr)))) + ",pool" for left in turns
    ]
    (folder / "tune.csv").write_text(
        "\n".join(["left [%],right [%],u [m/s],beta [deg],radius [m],source", *rows]) + "\n"
    )
    sizes = np.array([0.02, 0.5, 0.05])
    jacobian = np.column_stack([
        np.ravel([
            (np.subtract(*(seen(turn(x, PLANTED | {k: PLANTED[k] * (1 + s)}, m_y, m_yr)) for s in (1e-3, -1e-3)))) / sizes / (2e-3 * PLANTED[k])
            for x in turns
        ])
        for k in FREE.values()
    ])  # fmt: skip
    u95 = student.ppf(0.975, len(jacobian) - 3) * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    told = {place: u < abs(PLANTED[k]) for u, (place, k) in zip(u95, FREE.items(), strict=True)}
    assert told == {"C_S C_S_beta": True, "Nr'": False, "C_n C_n_beta": False}

    done = coeflab("tune", "tune.toml", "--json", cwd=folder)
    parameters = {p["name"]: p for p in json.loads(done.stdout)["parameters"]}  # type: ignore[attr-defined]
    assert {name: p["status"] == "ok" for name, p in parameters.items()} == told
    side = parameters["C_S C_S_beta"]
    assert side["u95"] == pytest.approx(u95[0], rel=0.25)
    assert side["after"] == pytest.approx(-PLANTED["s1"], abs=side["u95"])
