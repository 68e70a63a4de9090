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


FILE = "nothing/there"
# Every reader, as it is given a path, and the command that reads the same.
READERS: dict[str, tuple[Callable[[Any], Any], tuple[str, ...]]] = {
    "read_table": (cf.read_table, ("fit", FILE)),
    "read_tables": (cf.read_tables, ("fit", FILE)),
    "fit": (cf.fit, ("fit", FILE)),
    "read_campaign": (cf.read_campaign, ("run", FILE)),
    "read_plan": (cf.read_plan, ("run", FILE)),
    "run": (cf.run, ("run", FILE)),
    "validation": (cf.validation, ("validate", FILE)),
    "read_body": (cf.read_body, ("added-mass", FILE)),
    "estimate": (cf.estimate, ("vehicle", FILE)),
    "vehicle": (cf.vehicle, ("vehicle", FILE)),
    "tow": (cf.tow, ("tow", FILE, "--dry-run")),
    "tow, matrix": (lambda p: cf.tow("tow_spheroid", p), ("tow", "tow_spheroid", "--matrix", FILE, "--dry-run")),
    "read_vehicle": (cf.read_vehicle, ("export", FILE, "--to", "csv")),
    "export": (lambda p: cf.export(p, "csv"), ("export", FILE, "--to", "csv")),
    "simulate": (lambda p: cf.simulate(p, "zigzag"), ("simulate", FILE)),
    "trim": (cf.trim, ("trim", FILE)),
    "compare": (lambda p: cf.compare(p, "remus100"), ("compare", FILE, "remus100")),
    "compare, second": (lambda p: cf.compare("remus100", p), ("compare", "remus100", FILE)),
    "vehicle, coefficients": (lambda p: cf.vehicle("remus100", method="ellipsoid", coefficients=p), ("params", "check", FILE)),
}  # fmt: skip


def test_every_public_function_that_reads_is_among_them() -> None:
    paths = ("read_", "run", "validation", "fit", "estimate", "vehicle", "tow", "export", "simulate", "trim", "compare")
    verbs = {n for n in cf.__all__ if n[0].islower() and n.startswith(paths)}
    assert verbs == {name.partition(",")[0] for name in READERS}


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("kind", [str, Path])
def test_a_missing_file(name: str, kind: Any, shell: Shell) -> None:
    reader, command = READERS[name]
    said = complaint(reader, kind(FILE))
    assert FILE in said
    assert said == shell(*command)


@pytest.mark.parametrize("name", READERS)
def test_what_is_no_path(name: str) -> None:
    assert "expected" in complaint(READERS[name][0], 3.0)


REMUS = ("vehicle", "remus100")
# A wrong value by keyword, and the same by option; a bare number is the same in both.
VALUES: list[tuple[Callable[[], Any], tuple[str, ...], dict[str, str]]] = [
    (lambda: cf.vehicle("remus100", mass="3 m"), (*REMUS, "--mass", "3 m"), {"mass": "--mass"}),
    (lambda: cf.vehicle("remus100", mass=-3), (*REMUS, "--mass=-3"), {"mass": "--mass"}),
    (lambda: cf.vehicle("remus100", speed="3 kg"), (*REMUS, "--speed", "3 kg"), {"speed": "--speed"}),
    (lambda: cf.vehicle("remus100", speed=0), (*REMUS, "--speed=0"), {"speed": "--speed"}),
    (lambda: cf.vehicle("remus100", density="3 kg"), (*REMUS, "--density", "3 kg"), {"density": "--density"}),
    (lambda: cf.vehicle("remus100", density=-1), (*REMUS, "--density=-1"), {"density": "--density"}),
    (lambda: cf.vehicle("remus100", method="nope"), (*REMUS, "--method", "nope"), {}),
    (lambda: cf.estimate("remus100", speed=-2), (*REMUS, "--speed=-2"), {"speed": "--speed"}),
    (lambda: cf.estimate("remus100", density="2 m"), (*REMUS, "--density", "2 m"), {"density": "--density"}),
    (lambda: cf.trim("remus100", speed="3 kg"), ("trim", "remus100", "--speed", "3 kg"), {"speed": "--speed"}),
    (lambda: cf.fit("suboff_roddy_2", length="3 kg", length_name="LOA"),
     ("fit", "suboff_roddy_2", "--length", "3 kg", "--length-name", "LOA"), {"length": "--length"}),
    (lambda: cf.fit("suboff_roddy_2", length=-3, length_name="LOA"),
     ("fit", "suboff_roddy_2", "--length=-3", "--length-name", "LOA"), {"length": "--length"}),
    (lambda: cf.fit("suboff_roddy_2", "nope"), ("fit", "suboff_roddy_2", "--fit", "nope"), {}),
    (lambda: cf.fit("suboff_roddy_2", nope=3), ("fit", "suboff_roddy_2", "--nope", "3"), {}),
    (lambda: cf.export("remus100", "nope"), ("export", "remus100", "--to", "nope"), {}),
    (lambda: cf.simulate("remus100", "nope"), ("simulate", "remus100", "--manoeuvre", "nope"), {}),
    (lambda: cf.simulate("remus100", "zigzag", rudder="20 kg"),
     ("simulate", "remus100", "--manoeuvre", "zigzag", "--rudder", "20 kg"), {}),
    (lambda: cf.simulate("remus100", "zigzag", nope=3), ("simulate", "remus100", "--manoeuvre", "zigzag", "--nope", "3"), {}),
    (lambda: cf.read_body("remus100").added_mass("ellipsoid", density=0),
     ("added-mass", "remus100", "--method", "ellipsoid", "--density", "0"), {}),
    (lambda: cf.read_body("remus100").added_mass("ellipsoid", nope=3),
     ("added-mass", "remus100", "--method", "ellipsoid", "--nope", "3"), {}),
]  # fmt: skip


@pytest.mark.parametrize(("call", "command", "options"), VALUES, ids=[" ".join(command) for _, command, _ in VALUES])
def test_a_wrong_value(
    call: Callable[[], Any], command: tuple[str, ...], options: dict[str, str], shell: Shell
) -> None:
    with pytest.raises(cf.CoeflabError) as why:
        call()
    said = " ".join(str(why.value).split())
    for keyword, option in options.items():
        said = said.replace(f'"{keyword}": ', f'"{option}": ')
    assert said == shell(*command)


@pytest.mark.parametrize(
    ("keyword", "call"),
    [
        ("centre_of_gravity", lambda: cf.vehicle("remus100", centre_of_gravity=(1, 2))),
        ("inertia", lambda: cf.vehicle("remus100", inertia=(1,))),
        ("current", lambda: cf.simulate("remus100", "zigzag", current=(1, 2))),
    ],
)
def test_three_numbers_are_three(keyword: str, call: Callable[[], Any]) -> None:
    with pytest.raises(cf.InputError) as why:
        call()
    assert (why.value.column, why.value.expected) == (keyword, "three numbers")


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
def test_a_wrong_unit_names_the_keyword(keyword: str, value: str, tmp_path: Path, shell: Shell) -> None:
    file = tmp_path / "drift.csv"
    file.write_text(TABLE)
    with pytest.raises(cf.InputError) as why:
        cf.read_table(file, **{**SAID, keyword: value})
    assert why.value.column == ("datum" if keyword == "about" else keyword)
    if keyword == "about":  # which point it counts from is a question, that the shell's form asks
        return
    key = KEYS[keyword]
    typed = shell("import", str(file), "--out", str(tmp_path / "out"), "--set", f"{key}={value}", "--accept")
    said = " ".join(str(why.value).split())
    assert said.replace(f'"{keyword}": ', "") == typed.replace(f'"{key}": ', "")


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


def test_what_was_accepted_without_a_source_travels_with_the_numbers() -> None:
    """As with `coeflab import --accept`: the point that a rotating arm carries, which nobody stated."""
    r = np.array([-0.3, -0.2, -0.1, 0.1, 0.2, 0.3])
    arrays = {"r [rad/s]": r, "U [m/s]": np.full(6, 1.5), "Y [N]": 36.0 * r, "N [N m]": -48.0 * r}
    known: dict[str, Any] = {
        "frame": "FRD",
        "about": "-1 from nose",
        "length": "2 m LOA",
        "contains_inertia": False,
        "density": 1000,
    }
    found = cf.fit(cf.read_table(arrays, name="arm", accept=True, **known)).fits[0].findings
    assert [(f["key"], f["symbols"][:2]) for f in found if f.code == "assumed.key"] == [
        ("table.arm_point", ("Yr'", "Nr'"))
    ]
    stated = cf.fit(cf.read_table(arrays, name="arm", accept=True, arm_point="reference point", **known)).fits[0]
    assert [f for f in stated.findings if f.code == "assumed.key"] == []


def test_a_column_of_one_of_several_tables_has_its_name_before_it(tmp_path: Path) -> None:
    """As --map drift/Fy="Y [N]" says it."""
    for name, unit in (("drift", "N"), ("more", "lbf")):
        (tmp_path / f"{name}.csv").write_text(
            TABLE.replace("Y [N]", "Fy").replace("-120", "-120" if unit == "N" else "-1")
        )
    columns = {"drift/Fy": "Y [N]", "more/Fy": "Y [lbf]"}
    with pytest.raises(cf.InputError) as why:
        cf.read_tables(tmp_path, columns=columns, **SAID)
    assert (why.value.column, 'options={"files": "drift.csv, more.csv"}' in why.value.expected) == ("options", True)
    files = {"files": "drift.csv, more.csv"}
    first, second = cf.read_tables(tmp_path, columns=columns, options=files, **SAID)
    assert np.allclose(second.forces["Y"], first.forces["Y"] * 4.4482216152605)
    assert "drift/Fz" in complaint(cf.read_tables, tmp_path, columns={"drift/Fz": "Y [N]"}, options=files, **SAID)


def test_oscillating_runs_are_fitted_by_the_fit_that_they_are_for() -> None:
    table = cf.read_table("pmm_synthetic")
    assert cf.fit("pmm_synthetic")["Yv'"] == cf.fit([table])["Yv'"]
    assert cf.fit([table])["Yv'"].value == pytest.approx(-0.0280, rel=0.01)  # of cfd_data/make_pmm_synthetic.py
