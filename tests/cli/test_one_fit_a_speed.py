"""Speeds pooled in one sweep: a slope that depends on the speed is named with what was held constant, and fitted at one speed."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.campaign import read_campaign
from tests.cli.test_import import invoke, without_slopes
from tests.tables.test_levels import pooled

__all__ = ["without_slopes"]


def test_a_fit_names_the_dependence_the_constant_column_and_takes_one_speed(
    tmp_path: Path, coeflab: Callable[..., object]
) -> None:
    x, y, u = pooled(lambda s: -0.0031 * (1.3 / s) ** 1.65)
    rows = [f"{np.degrees(a):.6g},{s:g},11.2,{b:.8g},{-0.5 * b:.8g}" for a, b, s in zip(x, y, u, strict=True)]
    (tmp_path / "t.csv").write_text("\n".join(["rudder angle (deg),speed (m/s),rps,Y',N'", *rows]) + "\n")
    known = ("axes.frame=FRD", "axes.reference_point=midship", "scaling.length=3 LPP", "coefficients.area=prime")
    sets = [w for k in known for w in ("--set", k)]
    done = invoke("import", tmp_path / "t.csv", "--out", tmp_path / "made", *sets, "--accept")
    assert done.exit_code == 0, done.output
    assert read_campaign(tmp_path / "made" / "campaign.toml").tables[0].constant == {"rps": 11.2}
    found = json.loads(coeflab("fit", "made", "--json").stdout)  # type: ignore[attr-defined]
    warned = [json.dumps(c) for c in found["checks"] if c["severity"] == "warn" and "Ydr'" in c["subject"]]
    assert warned
    assert all("rps 11.2" in text and "--speed" in text for text in warned)
    for speed in (0.45, 1.3):
        one = json.loads(coeflab("fit", "made", "--speed", str(speed), "--json").stdout)  # type: ignore[attr-defined]
        (slope,) = [c for c in one["coefficients"] if c["symbol"] == "Ydr'"]
        assert slope["value"] == pytest.approx(-0.0031 * (1.3 / speed) ** 1.65, rel=1e-3)
    assert coeflab("fit", "made", "--speed", "3").returncode == 2  # type: ignore[attr-defined]


def test_one_speed_keeps_its_rudder_where_it_has_one_run_at_drift(
    tmp_path: Path, coeflab: Callable[..., object]
) -> None:
    """Of four speeds one was run at drift; at the others Ydr' was refused for the sake of Yv'."""
    rows = [f"{b},0,1.3,{-0.02 * -np.sin(np.radians(b)):.8g},0.001" for b in (-8, -4, 0, 4, 8)]
    rows += [
        f"0,{d},{u},{0.01 * np.radians(d) / u:.8g},{-0.004 * np.radians(d):.8g}"
        for u in (0.5, 1.3)
        for d in (-20, -10, 10, 20)
    ]
    rows += ["0,0,0.5,0,0"]
    (tmp_path / "t.csv").write_text("\n".join(["beta (deg),rudder angle (deg),speed (m/s),Y',N'", *rows]) + "\n")
    known = (
        "axes.frame=FRD",
        "axes.beta=-",
        "axes.reference_point=midship",
        "scaling.length=3 LPP",
        "coefficients.area=prime",
    )
    sets = [w for k in known for w in ("--set", k)]
    done = invoke("import", tmp_path / "t.csv", "--out", tmp_path / "made", *sets, "--accept")
    assert done.exit_code == 0, done.output
    for speed in (0.5, 1.3):
        one = json.loads(coeflab("fit", "made", "--speed", str(speed), "--json").stdout)  # type: ignore[attr-defined]
        values = {c["symbol"]: c["value"] for c in one["coefficients"]}
        assert values["Ydr'"] == pytest.approx(0.01 / speed, rel=1e-3)
        assert (values["Yv'"] is None) == (speed == 0.5)


@pytest.mark.parametrize(("name", "prime"), [("rps", True), ("J", False)])
def test_a_column_that_no_fit_uses_and_a_slope_hangs_on_is_named(tmp_path: Path, name: str, prime: bool) -> None:
    """A rudder at one speed and three propeller rates: its slope goes with the rate."""
    x, y, level = pooled(lambda s: -0.004 * s)
    heads = "rudder angle (deg),speed (m/s),{},Y',N'" if prime else "rudder angle (deg),speed (m/s),{},Y (N),N (N m)"
    size = 1.0 if prime else 0.5 * 1000 * 1.5**2 * 9.0
    rows = [
        f"{np.degrees(a):.6g},1.5,{s:g},{size * b:.8g},{-size * b:.8g}" for a, b, s in zip(x, y, level, strict=True)
    ]
    (tmp_path / "t.csv").write_text("\n".join([heads.format(name), *rows]) + "\n")
    said = " ".join(
        invoke("import", tmp_path / "t.csv", "--out", tmp_path / "made", "--map", f"{name}=ignore").output.split()
    )
    assert f"at {name} 0.45, 0.7, 1 and 1.3" in said
