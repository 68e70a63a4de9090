"""What pages and reports state, worked out again from shipped data by arithmetic that shares nothing with what prints it."""

from __future__ import annotations

import csv
import json
import tomllib
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import fsolve, least_squares
from scipy.stats import t as student

from coeflab.core.files import shipped
from coeflab.published.urv import acceptance as urv
from coeflab.report.acceptance import acceptance_csv, headline, held
from coeflab.study.study import Study

DATA = Path(str(shipped("cfd_data")))
HALVES = {"matlab": (0.01, np.radians(0.3), 0.02), "tracker": (0.06, np.radians(1.1), 0.14)}
FREE = ("intercept", "d0", "d2", "s1", "s3", "n1", "n3", "nr", "nrr")


def cells(path: Path) -> list[dict[str, str]]:
    """Rows of a shipped table by their heads, without comments."""
    with path.open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_suboff_with_its_rudder_amidships_in_time(suboff: Study) -> None:
    """Item 13: a disturbance grows, and terms in v end it at 7.8 deg and r' .366, within the tested drift; explicit steps of its own."""
    content = json.loads(suboff.parameter_files["suboff_fully_appended"].model_dump_json())
    c = {x["symbol"].rstrip("'"): x["value"] for x in content["coefficients"]}
    mass, moment = content["mass"]["mass_prime"], content["mass"]["mass_moment_prime"]
    inertia = content["mass"]["inertia"] / (0.5 * content["conditions"]["density"] * content["scaling"]["length"] ** 5)
    heavy = np.array([[mass - c["Yvdot"], moment - c["Yrdot"]], [moment - c["Nvdot"], inertia - c["Nrdot"]]])

    def rates(v: float, r: float) -> np.ndarray:
        side = c["Yv"] * v + c["Yv|v|"] * v * abs(v) + c["Yvvv"] * v**3 + (c["Yr"] - mass) * r
        turn = c["Nv"] * v + c["Nv|v|"] * v * abs(v) + (c["Nr"] - moment) * r
        return np.linalg.solve(heavy, (side, turn))

    state, step = np.array([-1e-3, 1e-3]), 0.02  # of v/U and r L/U, in lengths
    for _ in range(20_000):
        state = state + step * rates(*(state + 0.5 * step * rates(*state)))
    drift, rate = np.degrees(np.arcsin(-state[0])), state[1]
    assert np.max(np.abs(rates(*state))) < 1e-9
    assert (drift, rate) == pytest.approx((7.8, 0.366), rel=0.005)
    tested = [
        float(row["beta [deg]"]) for row in cells(DATA / "suboff_roddy_2" / "table.csv") if row["delta_r [deg]"] == "0"
    ]
    assert min(-min(tested), max(tested)) > drift


def test_what_a_publication_validates(publication: Callable[[str], Any]) -> None:
    """Item 23: of rows by what stands behind each; the headline counts as the written table does, and none of these validates."""
    known = {
        ("tank", "lamb"): 36,  # Lamb's own equations, as printed
        ("thauv", "left_out"): 6,  # speeds that the authors computed
        ("flyingfish", "predicted"): 36,
        ("urv", "link_1"): 13,  # expressions
    }
    for name in ("tank", "thauv", "flyingfish"):
        found = publication(name)
        rows = list(csv.DictReader(acceptance_csv(found).decode().splitlines()))
        bases = Counter(row["basis"] for row in rows)
        assert bases["validation"] == 0, name
        assert any("Nothing here is validation" in line for line in headline(held(found))), name
        for (publisher, table), count in known.items():
            if publisher == name:
                assert Counter(r["basis"] for r in rows if r["table"] == table) == {"verification": count}
    (first, *_) = urv.compared()
    assert Counter(str(r.basis) for r in first.rows)["verification"] == known["urv", "link_1"]


def test_the_cube_of_suboffs_two_lengths() -> None:
    """Item 26: of the metres that theory.md prints 1.068; of Groves' 14.2917 ft over Roddy's 13.9792 ft it would round to 1.069."""
    assert round((4.356 / 4.26086) ** 2, 3) == 1.045
    assert round((4.356 / 4.26086) ** 3, 3) == 1.068
    assert pytest.approx(1.06857, abs=1e-5) == (14.2917 / 13.9792) ** 3
    page = (Path(__file__).parents[2] / "docs" / "theory.md").read_text(encoding="utf-8")
    assert "4.26086 m; many computations use the overall length, 4.356 m" in page
    assert "1.045, its cube 1.068" in page


def test_the_bias_of_aff8_at_rest_and_the_secants_that_the_page_prints() -> None:
    """Y of the straight run, zero by symmetry, is 2 % of that of the slowest turn."""
    folder = DATA / "suboff_tow_aff8"
    drift = {r["point"]: r for r in cells(folder / "drift.csv")}
    turns = {r["point"]: r for r in cells(folder / "arm.csv")}
    assert abs(float(drift["straight"]["Y [N]"]) / float(turns["yaw+0.06"]["Y [N]"])) == pytest.approx(0.018, abs=0.001)
    unit = 0.5 * 998.2 * 2.0**2 * 4.26086**2
    by_rate = [float(turns[f"yaw+{r}"]["Y [N]"]) / unit / float(r) for r in ("0.06", "0.12", "0.24", "0.36")]
    by_angle = [-float(drift[f"drift+{a}"]["Y [N]"]) / unit / np.sin(np.radians(a)) for a in (2, 3, 6)]
    page = " ".join((Path(__file__).parents[2] / "docs" / "validation.md").read_text(encoding="utf-8").split())
    assert ", ".join(f"{x:.4f}"[1:] for x in by_rate) in page
    assert ", ".join(f"{x:.4f}"[1:] for x in by_angle) in page


def test_reynolds_numbers_of_the_computed_bare_hull() -> None:
    """Item 26: 8.7e6 on LOA, 8.5e6 on LBP."""
    stated = tomllib.loads((DATA / "suboff_cfd_barehull" / "campaign.toml").read_text(encoding="utf-8"))
    speed, nu, lbp = (
        float(str(x).split()[0])
        for x in (stated["conditions"]["speed"], stated["conditions"]["viscosity"], stated["scaling"]["length"])
    )
    assert round(speed * 4.356 / nu / 1e6, 1) == 8.7
    assert round(speed * lbp / nu / 1e6, 1) == 8.5
    assert stated["conditions"]["reynolds"] == 8.7e6


def turn_balance(x: np.ndarray, k: dict[str, float], left: float, right: float) -> tuple[float, float, float]:
    """X, Y and N of a steady turn in FRD, N and N m, of u, v and r: the paper's equations 1, 5 to 7 and 34 to 38."""
    u, v, r = x
    speed = np.hypot(u, v)
    beta = np.arcsin(v / speed)
    push = [k["slope"] * q + k["intercept"] if q > k["dead_zone"] else 0.0 for q in (left, right)]
    drag, side = k["d0"] + k["d2"] * beta**2, k["s1"] * beta + k["s3"] * beta**3
    turn = k["n1"] * beta + k["n3"] * beta**3
    return (
        sum(push) - speed * u * drag + speed * v * side + (k["m"] + k["my"]) * v * r + k["myr"] * r * r,
        -speed * v * drag - speed * u * side - (k["m"] + k["mx"]) * u * r,
        k["arm"] * (push[0] - push[1]) + speed**2 * turn - k["nr"] * r - k["nrr"] * r * abs(r) - (k["my"] - k["mx"]) * u * v
        - k["myr"] * u * r,
    )  # fmt: skip


def tuned(source: str) -> dict[str, tuple[float, float]]:
    """Value and 95 % half-width of each free constant, from one half of Fig. 17."""
    stated = tomllib.loads((DATA / "huuv" / "vehicle.toml").read_text(encoding="utf-8"))
    k = {
        name: float(str(x).split()[0])
        for part in ("steady_turn", "thruster")
        for name, x in stated[part].items()
        if isinstance(x, int | float) or str(x)[:1].isdigit()
    }
    rows = [row for row in cells(DATA / "huuv" / "turns.csv") if row["source"] == source]
    pushed = [(float(r["left [%]"]), float(r["right [%]"])) for r in rows]
    printed = np.array(
        [(float(r["u [m/s]"]), np.radians(float(r["beta [deg]"])), float(r["radius [m]"])) for r in rows]
    )
    states = [np.array([u, u * np.tan(b), -u / np.cos(b) / radius]) for u, b, radius in printed]
    sizes = np.array([max(abs(k[name]), 1.0) for name in FREE])

    def apart(p: np.ndarray) -> np.ndarray:
        now, out = k | dict(zip(FREE, p * sizes, strict=True)), []
        for state, (left, right) in zip(states, pushed, strict=True):
            state[:] = fsolve(turn_balance, state, args=(now, left, right), xtol=1e-12, full_output=True)[0]
            speed = np.hypot(state[0], state[1])
            out.append((state[0], abs(np.arcsin(state[1] / speed)), speed / abs(state[2])))
        return ((np.array(out) - printed) / HALVES[source]).ravel()

    fit = least_squares(
        apart,
        np.array([k[name] for name in FREE]) / sizes,
        x_scale="jac",
        jac="3-point",
        diff_step=1e-4,
        xtol=1e-12,
        ftol=1e-12,
    )
    freedom = len(fit.fun) - len(FREE)
    covariance = np.linalg.inv(fit.jac.T @ fit.jac) * max(1.0, 2.0 * fit.cost / freedom)
    half = student.ppf(0.975, freedom) * np.sqrt(np.diag(covariance)) * sizes
    return {name: (float(v), float(h)) for name, v, h in zip(FREE, fit.x * sizes, half, strict=True)}


def test_what_the_second_half_of_huuvs_turns_tells() -> None:
    """Item 25: n1 is 3.3 +- 7.0 kg and nr no more than its own half-width, by another fit; of the first half nr drives the turn."""
    tracker = tuned("tracker")
    assert tracker["n1"] == pytest.approx((3.3, 7.0), abs=0.05)
    assert tracker["nr"] == pytest.approx((0.0331, 0.0331), abs=1e-4)  # .03319 by exact slopes
    matlab = tuned("matlab")
    assert matlab["nr"][0] + matlab["nr"][1] < 0.0
