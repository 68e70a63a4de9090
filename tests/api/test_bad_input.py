"""Wrong input is the same complaint in Python and in a shell, and names what has to be said where."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import coeflab as cf
from coeflab.cli import main

Shell = Callable[..., str]


@pytest.fixture
def shell(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Shell:
    """What a command complains of; its exit code is 2."""

    def run(*words: str) -> str:
        monkeypatch.setattr(sys, "argv", ["coeflab", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        assert ended.value.code == 2
        return " ".join(capsys.readouterr().err.removeprefix("error: ").split())

    return run


def complaint(of: Callable[..., Any], *given: Any, **keywords: Any) -> str:
    with pytest.raises(cf.InputError) as why:
        of(*given, **keywords)
    return " ".join(str(why.value).split())


READERS = [
    (cf.read_table, ("fit",)),
    (cf.fit, ("fit",)),
    (cf.read_body, ("added-mass",)),
    (cf.read_vehicle, ("export", "--to", "csv")),
    (cf.tow, ("tow", "--dry-run")),
]


@pytest.mark.parametrize(("reader", "command"), READERS)
@pytest.mark.parametrize("kind", [str, Path])
def test_a_missing_file(reader: Callable[..., Any], command: tuple[str, ...], kind: Any, shell: Shell) -> None:
    said = complaint(reader, kind("nothing/there"))
    assert "nothing/there" in said
    assert said == shell(*command[:1], "nothing/there", *command[1:])


@pytest.mark.parametrize("reader", [cf.read_table, cf.read_body, cf.read_vehicle, cf.tow, cf.run])
def test_what_is_no_path(reader: Callable[..., Any]) -> None:
    assert "expected a" in complaint(reader, 3.0)


def test_a_mesh_without_unit_and_axes(tmp_path: Path, shell: Shell) -> None:
    mesh = tmp_path / "hull.stl"
    mesh.write_bytes(b"solid\nendsolid\n")
    for kind in (str, Path):
        said = complaint(cf.read_body, kind(mesh))
        assert "unit=" in said
        assert "axes=" in said
        assert (
            said.partition(": ")[2].partition(";")[0]
            == shell("added-mass", str(mesh)).replace("--unit ", "unit=").partition(": ")[2].partition(";")[0]
        )


def test_a_wrong_unit_of_a_mesh(tmp_path: Path, shell: Shell) -> None:
    mesh = tmp_path / "hull.stl"
    mesh.write_bytes(b"solid\nendsolid\n")
    said = complaint(cf.read_body, mesh, unit="kg", axes="FLU")
    assert '"unit"' in said
    assert said.replace('"unit"', '"--unit"') == shell("added-mass", str(mesh), "--unit", "kg", "--axes", "FLU")


TABLE = "v [m/s],Y [N],N [N m]\n" + "".join(f"{v},{-120 * v},{-60 * v}\n" for v in np.linspace(-0.3, 0.3, 9).round(3))
SAID = {"frame": "FRD", "length": 2.0, "density": 1000, "speed": 2.0, "about": "nose, 1.0 m aft"}
KEYS = {
    "frame": "axes.frame", "length": "scaling.length", "density": "conditions.density", "speed": "conditions.speed",
    "about": "axes.reference_point",
}  # fmt: skip


@pytest.mark.parametrize("keyword", SAID)
def test_what_nobody_said_is_asked_by_its_keyword(keyword: str, tmp_path: Path, shell: Shell) -> None:
    file = tmp_path / "drift.csv"
    file.write_text(TABLE)
    rest = {k: v for k, v in SAID.items() if k != keyword}
    with pytest.raises(cf.InputError) as why:
        cf.read_table(file, **rest)
    assert why.value.column == keyword
    assert why.value.others == ()
    typed = [w for k, v in rest.items() for w in ("--set", f"{KEYS[k]}={'-1.0 from nose' if k == 'about' else v}")]
    monkey = sys.argv
    sys.argv = ["coeflab", "import", str(file), "--out", str(tmp_path / "out"), *typed, "--accept"]
    try:
        with pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = monkey
    assert ended.value.code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("keyword", "value"),
    [("length", "2 kg"), ("speed", "3 m"), ("density", "heavy"), ("frame", "XYZ"), ("about", "1 m")],
)
def test_a_wrong_unit_names_the_keyword(keyword: str, value: str, tmp_path: Path) -> None:
    file = tmp_path / "drift.csv"
    file.write_text(TABLE)
    with pytest.raises(cf.InputError) as why:
        cf.read_table(file, **{**SAID, keyword: value})
    assert why.value.column in (keyword, "datum")


def test_a_wrong_unit_of_a_column(tmp_path: Path) -> None:
    file = tmp_path / "drift.csv"
    file.write_text(TABLE.replace("v [m/s]", "v [kg]"))
    arrays = {"v [kg]": np.ones(3), "Y [N]": np.ones(3)}
    for source in (file, str(file), arrays):
        assert "[kg]" in complaint(cf.read_table, source, **SAID)


def test_what_is_assumed_nowhere_is_taken_only_when_accepted() -> None:
    beta = np.linspace(-10.0, 10.0, 9)
    arrays = {"beta [deg]": beta, "Y [N]": 20.0 * beta, "N [N m]": 9.0 * beta}
    with pytest.raises(cf.InputError) as why:
        cf.read_table(arrays, **SAID)
    assert why.value.column == "beta"
    stated = cf.read_table(arrays, beta="-", **SAID)
    assert np.allclose(stated.motion["v"], -2.0 * np.sin(np.radians(beta)))
    assert np.allclose(cf.read_table(arrays, accept=True, **SAID).motion["v"], stated.motion["v"])


def test_arrays_and_a_file_of_them_are_the_same_table(tmp_path: Path) -> None:
    file = tmp_path / "drift.csv"
    file.write_text(TABLE)
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    a = cf.read_table(file, **SAID)
    b = cf.read_table(dict(zip(("v [m/s]", "Y [N]", "N [N m]"), rows.T, strict=True)), name="drift", **SAID)
    assert a.name == b.name == "drift/table"
    for c in "YN":
        assert np.array_equal(a.forces[c], b.forces[c])
    assert a.files[0].sha256 != b.files[0].sha256
