"""What a scientist types, line by line, from a table to a simulator."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
import trimesh

import coeflab as cf

mpl.use("agg")
LENGTH, DENSITY, SPEED = 2.0, 1000.0, 2.0
FORCE = 0.5 * DENSITY * SPEED**2 * LENGTH**2
YV, NV, YR, NR = -0.030, -0.010, 0.004, -0.006
PLAN = """[study]
name = "mine"
[[table]]
campaign = "mine"
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a drift table, a hull as STL in mm and FLU, a plan and a matrix of a tow."""
    monkeypatch.chdir(tmp_path)
    v = np.linspace(-0.4, 0.4, 9)
    rng = np.random.default_rng(1)
    y, n = (FORCE * (k * v / SPEED + 1e-6 * rng.standard_normal(9)) * s for k, s in ((YV, 1.0), (NV, LENGTH)))
    pd.DataFrame({"v [m/s]": v, "Y [N]": y, "N [N*m]": n}).to_csv("drift.csv", index=False)
    hull = trimesh.creation.icosphere(4, 1.0)
    hull.apply_scale([1000.0, 110.0, 110.0])
    hull.export("hull.stl")
    return tmp_path


@pytest.fixture
def frame_of_data() -> pd.DataFrame:
    r = np.linspace(-0.3, 0.3, 7)
    x = r * LENGTH / SPEED
    rng = np.random.default_rng(2)
    noise = 1e-6 * rng.standard_normal((2, 7))
    return pd.DataFrame(
        {"r [rad/s]": r, "Y [N]": FORCE * (YR * x + noise[0]), "N [N*m]": FORCE * LENGTH * (NR * x + noise[1])}
    )


def test_from_a_table_to_a_simulator(here: Path, frame_of_data: pd.DataFrame) -> None:
    import matplotlib.pyplot as plt

    before = dict(mpl.rcParams)
    drift = cf.read_table("drift.csv", frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft")
    arm = cf.read_table(
        frame_of_data, name="arm", frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft",
        contains_inertia=False, arm_point="reference point",
    )  # fmt: skip
    result = cf.fit([drift, arm])
    for symbol, planted in (("Yv'", YV), ("Nv'", NV), ("Yr'", YR), ("Nr'", NR)):
        assert abs(result[symbol].value - planted) <= result[symbol].u95 < 0.05 * abs(planted)
    assert list(result.frame().index) == list(result.symbols)
    assert str(result.summary()).count("\n") > len(result)
    drawn = result.samples(1000)
    assert drawn.std()["Yv'"] == pytest.approx(result["Yv'"].u95 / 2.0, rel=0.1)
    assert result.covariance.shape == (len(result.symbols),) * 2
    ax = plt.subplots()[1]
    assert result.plot("Yv'", ax=ax) is ax
    assert np.allclose(result.points("Yv'").y, drift.forces["Y"] / FORCE)

    assert cf.fit(drift, "polynomial", variable="v", degree=1).fits[0].fit == "polynomial"
    law = cf.fit(drift, terms=["Yv", "Nv"])
    assert law["Yv'"].value == pytest.approx(YV, rel=1e-2)

    body = cf.read_body("hull.stl", unit="mm", axes="FLU")
    added = body.added_mass("ellipsoid").matrix
    assert added[1, 1] == pytest.approx(998.2 * body.configurations[0].volume, rel=0.1)
    assert body.plot().get_xlabel() == "x [m]"

    auv = cf.vehicle(body, mass=46, coefficients=result)
    assert auv["Nr'"].value == pytest.approx(moved_nr(body), abs=2.0 * result["Nr'"].u95 + 1e-4)
    assert {str(auv[s].status) for s in ("Yv'", "Nv'", "Yr'", "Nr'")} == {"ok"}
    assert auv.save() == Path("auv.json") or auv.save().is_file()
    assert cf.read_vehicle(auv.save()).file == auv.file
    assert auv.linear(speed=1.5).A.shape[0] >= 2

    assert cf.compare(auv, "remus100").frame().shape[1] == 8
    auv.export("csv", "out/")
    assert ".csv" in {p.suffix for p in Path("out").iterdir()}
    assert cf.estimate(body)["Yv'"].value < 0.0
    plt.close("all")
    changed = {k for k in before if before[k] != mpl.rcParams[k]}
    assert changed == set()


def moved_nr(body: cf.Body) -> float:
    """N_r' about the centre of buoyancy of the ellipsoid, its middle, which is the tables' point: 1 m aft of the nose; primes by 2 m."""
    assert np.allclose(body.counted_from("nose").reference_point, [-1.0, 0.0, 0.0], atol=1e-6)
    return NR


def test_a_motion_and_its_export(here: Path) -> None:
    run = cf.simulate("remus100", "zigzag", rudder="20 deg")
    assert run["first overshoot"].value == pytest.approx(
        cf.simulate("remus100", "zigzag", rudder=np.radians(20.0))["first overshoot"].value
    )
    assert len(run.frame()) == len(run.trajectory.time)
    assert run.plot("heading").get_ylabel() == "heading [deg]"
    auv = cf.read_vehicle("remus100")
    with pytest.raises(cf.InputError):
        auv.export("gazebo", "lost/")
    assert not Path("lost").exists()
    assert auv.export("gazebo", "lost/", accept_loss=True).loss is not None
    auv.export("xdyn", "out/")
    assert any(p.suffix in (".yml", ".yaml") for p in Path("out").iterdir())


@pytest.mark.slow
def test_a_plan_and_its_report(here: Path) -> None:
    study = cf.run("suboff_roddy_2")
    assert study.report("report.html") == Path("report.html")
    assert Path("report.html").stat().st_size > 10_000
    assert len(cf.tow("suboff_bare_hull").frame()) > 6
