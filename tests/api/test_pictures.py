"""One drawing: what `plot` draws into a user's axes is what the report's figure holds, and no style is set."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

import coeflab as cf
from coeflab.report.figures import estimator, sweep
from coeflab.report.figures.files import drawing, files_of, styled
from coeflab.report.figures.palette import COLOURS

mpl.use("agg")


@pytest.fixture(scope="module")
def result() -> cf.Result:
    return cf.fit("suboff_roddy_2")


def lines(axes: Any) -> dict[str, list[Any]]:
    """Lines that belong to a series, by its mark."""
    found: dict[str, list[Any]] = {}
    for one in axes.get_lines():
        if one.get_gid():
            found.setdefault(one.get_gid(), []).append(one.get_xydata())
    return found


@pytest.mark.parametrize(
    ("module", "figure", "kind"), [(sweep, "sweep_figure", ""), (estimator, "estimator_figure", "forms")]
)
def test_a_plot_and_the_figure_of_the_report_are_one_drawing(
    result: cf.Result, module: Any, figure: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    import matplotlib.pyplot as plt

    made: list[Any] = []
    panel = module.panel
    monkeypatch.setattr(module, "panel", lambda *a, **k: made.append(panel(*a, **k)) or made[-1])
    s = result.fits[0].sweep("Yv")
    getattr(module, figure)(s, *(((),) if kind else ()), "a")
    ours, theirs = lines(result.plot("Yv'", ax=plt.subplots()[1], kind=kind)), lines(made[0])
    assert len(ours) > 1
    assert ours.keys() == theirs.keys()
    factor = 1000.0
    for key, drawn in ours.items():
        assert len(drawn) == len(theirs[key])
        for a, b in zip(drawn, theirs[key], strict=True):
            np.testing.assert_allclose(a * [1.0, factor], b, rtol=1e-9, atol=1e-9, equal_nan=True)
    plt.close("all")


def test_a_plot_shows_the_readings_of_the_table(result: cf.Result) -> None:
    """Against Roddy's cells as the file has them, which no drawing knows: beta in degrees, Y' as printed."""
    import matplotlib.pyplot as plt

    raw = np.genfromtxt(
        cf.shipped("cfd_data") / "suboff_roddy_2" / "table.csv", delimiter=",", skip_header=1, usecols=(1, 2, 4)
    )
    printed = {(round(-beta, 6), y) for delta, beta, y in raw if delta == 0.0}
    drawn = [p for one in lines(result.plot("Yv'", ax=plt.subplots()[1]))["data-series=points"] for p in one]
    assert len(drawn) >= 20
    for x, y in drawn:
        assert min(abs(y - b) for a, b in printed if abs(a - x) < 1e-3) < 1e-9, (x, y)
    plt.close("all")


def test_plots_take_the_axes_and_the_colours_of_the_user(result: cf.Result) -> None:
    import matplotlib.pyplot as plt

    with plt.style.context("ggplot"):
        cycle = [one["color"] for one in mpl.rcParams["axes.prop_cycle"]]
        before = dict(mpl.rcParams)
        ax = plt.subplots()[1]
        result.plot("Yv'", ax=ax)
        used = {mpl.colors.to_hex(line.get_color()) for line in ax.get_lines()}
        assert mpl.colors.to_hex(cycle[1]) in used
        assert not used & {COLOURS["a"], COLOURS["b"]}
        assert dict(mpl.rcParams) == before
    plt.close("all")


def test_a_figure_as_files(result: cf.Result, tmp_path: Path) -> None:
    s = result.fits[0].sweep("Yv")
    made = files_of(sweep.sweep_figure(s, "yv"))
    assert sorted(made) == ["figures/yv.csv", "figures/yv.pdf", "figures/yv.png", "figures/yv.svg"]
    assert made["figures/yv.pdf"].startswith(b"%PDF")
    assert made["figures/yv.png"].startswith(b"\x89PNG")
    assert b"var(" not in made["figures/yv.svg"]
    rows = made["figures/yv.csv"].decode().splitlines()
    assert len(rows) > 1 + len(s.x)
    assert made == files_of(sweep.sweep_figure(s, "yv"))


def test_a_style_changes_colours_and_nothing_that_is_drawn(result: cf.Result, tmp_path: Path) -> None:
    sheet = tmp_path / "my.mplstyle"
    sheet.write_text("axes.prop_cycle: cycler('color', ['112233', '445566'])\n")
    s = result.fits[0].sweep("Yv")
    plain = drawing(sweep.sweep_figure(s, "yv")).decode()
    with styled(sheet):
        own = drawing(sweep.sweep_figure(s, "yv")).decode()
    assert "#445566" in own
    assert plain == own.replace("#445566", COLOURS["b"]).replace("#112233", COLOURS["a"])
    assert drawing(sweep.sweep_figure(s, "yv")).decode() == plain
    with pytest.raises(cf.InputError), styled(tmp_path / "none.mplstyle"):
        pass
