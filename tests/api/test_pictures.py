"""One drawing: what `plot` draws into a user's axes is what the report's figure holds, and no style is set."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

import coeflab as cf
from coeflab.api import studies
from coeflab.core.errors import InputError
from coeflab.fits import tied_law
from coeflab.report.document import AnswerRow
from coeflab.report.figures import estimator, first_page, law_along, laws, motion, nouns, slices, sweep, three_views
from coeflab.report.figures.files import drawing, files_of, styled
from coeflab.report.figures.palette import COLOURS
from coeflab.report.plots import plot_forest

mpl.use("agg")


@pytest.fixture(scope="module")
def result() -> cf.Result:
    return cf.fit("suboff_roddy_2")


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    import matplotlib.pyplot as plt

    yield
    plt.close("all")


def new_axes() -> Any:
    import matplotlib.pyplot as plt

    return plt.subplots()[1]


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
    made = captured(monkeypatch, module)
    s = result.fits[0].sweep("Yv")
    getattr(module, figure)(s, *(((),) if kind else ()), "a")
    ours, theirs = lines(result.plot("Yv'", ax=new_axes(), kind=kind)), lines(made[0])
    assert len(ours) > 1
    assert ours.keys() == theirs.keys()
    factor = 1000.0
    for key, drawn in ours.items():
        assert len(drawn) == len(theirs[key])
        for a, b in zip(drawn, theirs[key], strict=True):
            np.testing.assert_allclose(a * [1.0, factor], b, rtol=1e-9, atol=1e-9, equal_nan=True)


def captured(monkeypatch: pytest.MonkeyPatch, module: Any, name: str = "panel") -> list[Any]:
    """The axes of a report's figures, as they are made."""
    made: list[Any] = []
    make = getattr(module, name)

    def kept(*given: Any, **named: Any) -> Any:
        found = make(*given, **named)
        made.append(found[1] if isinstance(found, tuple) else found)
        return found

    monkeypatch.setattr(module, name, kept)
    return made


def scaled(points: Any) -> Any:
    """Points with the first corner of their box at 0 and the other at 1."""
    at = np.asarray(points, dtype=float)
    if not np.isfinite(at).all(axis=1).any():
        return at * np.nan
    low, size = np.nanmin(at, axis=0), np.nanmax(at, axis=0) - np.nanmin(at, axis=0)
    return (at - low) / np.where(size > 0.0, size, 1.0)


def assert_one_drawing(ours: Any, theirs: Any, alike: str = "") -> None:
    """The same series with the same points, but for the units of the axes, which are ``alike`` across, up or both; and the same look."""
    a, b = lines(ours), lines(theirs)
    assert a
    assert a.keys() == b.keys()
    for key, drawn in a.items():
        for one, other in zip(drawn, b[key], strict=True):
            np.testing.assert_allclose(scaled(one), scaled(other), rtol=1e-9, atol=1e-9, equal_nan=True)
            for axis in ("xy".index(name) for name in alike):
                np.testing.assert_allclose(one[:, axis], other[:, axis], rtol=1e-12, equal_nan=True)
    looks = [[(one.get_linestyle(), one.get_marker(), one.get_linewidth()) for one in axes.get_lines() if one.get_gid()]
             for axes in (ours, theirs)]  # fmt: skip
    assert looks[0] == looks[1]


@pytest.fixture(scope="module")
def run() -> cf.Motion:
    return cf.simulate("remus100", "zigzag", rudder="20 deg")


def test_a_track_is_drawn_once(run: cf.Motion, monkeypatch: pytest.MonkeyPatch) -> None:
    made = captured(monkeypatch, motion)
    motion.track_figure(run.trajectory, "t", 0.0, False)
    assert_one_drawing(run.plot(ax=new_axes()), made[0], "xy")


@pytest.mark.parametrize(("what", "group"), [("depth", "depth"), ("speed", None)])
def test_a_quantity_over_time_is_drawn_once(
    run: cf.Motion, what: str, group: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = captured(monkeypatch, motion)
    values = {"depth": run.trajectory.position[:, 2], "speed": run.trajectory.speed}[what]
    motion._history(run.trajectory.time, {what: values}, "h", f"{what}  [m]", group or what)
    assert_one_drawing(run.plot(what, ax=new_axes()), made[0], "xy")


def test_points_of_a_table_are_drawn_once(monkeypatch: pytest.MonkeyPatch) -> None:
    v = np.linspace(-0.3, 0.3, 9)
    table = cf.read_table({"v [m/s]": v, "Y [N]": -120.0 * v, "N [N m]": np.where(v > 0.2, np.nan, -60.0 * v)}, name="drift",
                          frame="FRD", length=2.0, density=1000, speed=2.0, about="nose, 1.0 m aft")  # fmt: skip
    usable = {**table.usable, "Y": np.arange(9) != 4}
    table = replace(table, usable=usable)
    made = captured(monkeypatch, laws)
    nouns.table_figure(table, "t")
    for component, theirs in zip("YN", made, strict=True):
        ours = table.plot(component, ax=new_axes())
        keys = {"data-series=law0": "data-series=filled", "data-series=law1": "data-series=hollow"}
        for one in theirs.get_lines():
            one.set_gid(keys.get(str(one.get_gid())))
        assert_one_drawing(ours, theirs)


def test_a_law_along_a_motion_is_drawn_once(monkeypatch: pytest.MonkeyPatch) -> None:
    result = cf.fit("suboff_cfd_barehull", "manoeuvring_model")
    law = next(m for m in result.fits[0].models if "Yv" in [s.removesuffix("'") for s in m.symbols])
    made = captured(monkeypatch, law_along)
    law_along.along_figure(law, "m")
    assert_one_drawing(result.plot("Yv'", ax=new_axes()), made[law_along.along(law).index("v")], "x")


TERMS = ["Yv", "Yr", "Yv|r|", "Nv", "Nr", "Nvvr"]


def crossed(apart: float = 0.0) -> cf.Table:
    """Rows of a law with Yv|r|' and Nvvr' on a grid of drift and yaw rate, or on rates that are all apart."""
    v, r = (x.ravel() for x in np.meshgrid(-np.sin(np.radians([-8, -4, 0, 4, 8])), [-0.3, -0.15, 0.0, 0.15, 0.3]))
    r = r + apart * np.arange(len(r))
    columns = {
        "v' [1]": v,
        "r' [1]": r,
        "Y' [1]": -0.03 * v + 0.01 * r - 0.2 * v * np.abs(r),
        "N' [1]": -0.012 * v - 0.006 * r - 0.03 * v**2 * r,
    }
    return cf.read_table(
        columns,
        frame="FRD",
        length=2.0,
        density=1000,
        speed=2.0,
        about="cg",
        datum="cg",
        contains_inertia=False,
        accept=True,
    )


def test_a_cross_term_is_drawn_in_slices_as_the_report_draws_them(monkeypatch: pytest.MonkeyPatch) -> None:
    result = cf.fit(crossed(), "manoeuvring_model", terms=TERMS)
    law = next(m for m in result.fits[0].models if m.response == "Y")
    made = captured(monkeypatch, slices)
    slices.slices_figure(law, "m")
    ours = result.plot("Yv|r|'", ax=new_axes())
    assert_one_drawing(ours, made[0], "x")
    levels = [t.get_text() for t in ours.get_legend().get_texts()]
    assert levels == ["r' = −0.3", "r' = −0.15", "r' = 0.15", "r' = 0.3"]
    slopes = [np.polyfit(*one.get_xydata().T, 1)[0] for one in ours.get_lines() if one.get_linestyle() != "None"]
    assert slopes == pytest.approx([-0.03 - 0.2 * abs(r) for r in (-0.3, -0.15, 0.15, 0.3)], rel=1e-6)


def test_a_cross_term_without_a_grid_says_what_has_its_law() -> None:
    result = cf.fit(crossed(0.001), "manoeuvring_model", terms=TERMS)
    with pytest.raises(InputError, match=r'v and r together.*laws\["N"\]\.evaluate\(v=\.\.\., r=\.\.\.\)'):
        result.plot("Nvvr'", ax=new_axes())


def test_coefficients_with_their_intervals_are_drawn_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The forest of the report's first page, of a result and of a comparison."""
    rows = [("Yv'", 3.0, 0.6), ("Nv'", 2.0, 0.1), ("Zw'", 5.0, 2.0)]
    made = captured(monkeypatch, first_page, "_drawing")
    first_page.forest_figure([AnswerRow(s.removesuffix("'"), value, half) for s, value, half in rows], (), "")
    ours = plot_forest([(s, [(value, half)]) for s, value, half in rows], (), new_axes())
    for one in made[0].get_lines():
        one.set_gid("data-series=s0" if one.get_gid() == "data-series=ours" else None)
    assert_one_drawing(ours, made[0], "x")


@pytest.mark.parametrize("view", ["side", "top", "front"])
def test_an_outline_is_drawn_once(view: str) -> None:
    body = cf.read_body("huuv_mesh")
    sheet = three_views._drawn(body).axes[0]
    ours = body.plot(view, ax=new_axes())
    signs = {"side": (1.0, -1.0), "top": (1.0, -1.0), "front": (-1.0, -1.0)}[view]
    (mine, *_), theirs = ours.patches, sheet.patches
    found = [p for p in theirs if len(p.get_path().vertices) == len(mine.get_path().vertices)]
    shapes = [scaled(p.get_path().vertices) for p in found]
    wanted = scaled(mine.get_path().vertices * signs)
    assert any(np.allclose(wanted, one, atol=2e-4) for one in shapes)
    assert [p.get_linewidth() for p in ours.patches[:2]] == [p.get_linewidth() for p in theirs[:2]]


def test_every_picture_of_the_front_door_draws_with_a_figure_of_the_report() -> None:
    """But the matrix of added mass, of which the report has numbers."""
    plots = Path(str(cf.__file__)).parent / "report" / "plots"
    for file in sorted(plots.glob("*.py")):
        if file.stem in ("__init__", "axes", "matrix"):
            continue
        called = {n.func.attr for n in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(n, ast.Call)
                  and isinstance(n.func, ast.Attribute) and isinstance(n.func.value, ast.Name) and n.func.value.id == "axes"}  # fmt: skip
        assert not called & {"fill", "errorbar", "fill_between", "scatter", "imshow", "bar"}, file.stem
        assert "draw_" in file.read_text("utf-8"), file.stem


def test_a_plot_shows_the_readings_of_the_table(result: cf.Result) -> None:
    """Against Roddy's cells as the file has them, which no drawing knows: beta in degrees, Y' as printed."""
    raw = np.genfromtxt(
        cf.shipped("cfd_data") / "suboff_roddy_2" / "table.csv", delimiter=",", skip_header=1, usecols=(1, 2, 4)
    )
    printed = {(round(-beta, 6), y) for delta, beta, y in raw if delta == 0.0}
    drawn = [p for one in lines(result.plot("Yv'", ax=new_axes()))["data-series=points"] for p in one]
    assert len(drawn) >= 20
    for x, y in drawn:
        assert min(abs(y - b) for a, b in printed if abs(a - x) < 1e-3) < 1e-9, (x, y)


def test_plots_take_the_axes_and_the_colours_of_the_user(result: cf.Result) -> None:
    import matplotlib.pyplot as plt

    with plt.style.context("ggplot"):
        cycle = [one["color"] for one in mpl.rcParams["axes.prop_cycle"]]
        before = dict(mpl.rcParams)
        ax = new_axes()
        result.plot("Yv'", ax=ax)
        used = {mpl.colors.to_hex(line.get_color()) for line in ax.get_lines()}
        assert mpl.colors.to_hex(cycle[1]) in used
        assert not used & {COLOURS["a"], COLOURS["b"]}
        assert dict(mpl.rcParams) == before


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


def test_a_term_beyond_the_slope_is_drawn_with_its_law(result: cf.Result) -> None:
    """Yv|v|' of a law that is tied to Yv': the points of its sweep, and Yv' v' + Yv|v|' v'|v'| + ... over the range it was fitted to."""
    slopes = result.fits[0]
    tied = tied_law.complete(slopes, result.tables, slopes.coefficients.scaling, {})
    both = cf.Result((slopes, tied), result.tables)
    symbol = next(s for s in ("Yv|v|'", "Yvvv'") if s in both)
    ax = both.plot(symbol, ax=new_axes())
    law, points = (np.concatenate(lines(ax)[f"data-series={key}"]) for key in ("law", "points"))
    v = np.sin(np.radians(law[:, 0]))
    powers = {"Yv'": v, "Yv|v|'": v * np.abs(v), "Yvvv'": v**3}
    rest = sum(x for table, term, x in tied.tied.set_up if term == "Y0" and table == slopes.sweep("Yv").table)
    due = rest + sum(both[s].value * x for s, x in powers.items() if s in both)
    np.testing.assert_allclose(law[:, 1], due, atol=1e-9)
    np.testing.assert_allclose(points[:, 1], slopes.sweep("Yv").y)
    assert np.max(np.abs(np.interp(points[:, 0], law[:, 0], law[:, 1]) - points[:, 1])) < 0.1 * np.max(
        np.abs(points[:, 1])
    )


def test_figures_of_a_study_go_into_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def drawn(study: Any, formats: list[str], **more: Any) -> Any:
        asked.append((formats, more))
        return None, {"figures/yv.svg": b"<svg/>", "figures/yv.csv": b"x,y"}, False

    monkeypatch.setattr(studies, "report_files", drawn)
    found = studies.Study.figures(None, tmp_path / "out", style="ggplot")  # type: ignore[arg-type]
    assert [p.name for p in found] == ["yv.csv", "yv.svg"]
    assert (tmp_path / "out" / "yv.svg").read_bytes() == b"<svg/>"
    assert asked == [(["figures"], {"full": False, "style": "ggplot"})]
