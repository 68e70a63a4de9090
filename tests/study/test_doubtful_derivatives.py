"""Signs of derivatives from literature, and inertia of the model that a rotating arm's table holds without saying so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.study.checks.signs import check as signs
from coeflab.study.checks.sizes import check as sizes
from coeflab.study.checks.viscous_centre import check as centres
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile

DENSITY, LBP, MASS_PRIME = 998.0, 4.26086, 0.018078
MASS = MASS_PRIME * 0.5 * DENSITY * LBP**3


def doubts(study: Study) -> list[Check]:
    return [c for c in (*signs(study), *centres(study)) if c.severity in (Severity.WARN, Severity.FAIL)]


def changed(file: ParameterFile, **values: float) -> ParameterFile:
    """A file with other primed values."""
    coefficients = tuple(
        c if c.symbol.removesuffix("'") not in values else replace(c, value=values[c.symbol[:-1]])
        for c in file.coefficients
    )
    return file.model_copy(update={"coefficients": coefficients})


def one(study: Study, file: ParameterFile) -> list[Check]:
    """What a study of this file alone is doubted for."""
    return doubts(replace(study, parameter_files={file.name: file}, hulls={}))


def test_the_shipped_files_raise_no_doubt(suboff: Study) -> None:
    assert doubts(suboff) == []
    asked = [c.subject for c in centres(suboff)]
    assert len(asked) == 8
    assert "suboff_bare_hull_cfd Yr'" in asked


@pytest.mark.parametrize(
    ("name", "symbol", "severity"),
    [
        ("suboff_fully_appended", "Yr", "warn"),
        ("suboff_fully_appended", "Nr", "fail"),
        ("suboff_fully_appended", "Nv", "warn"),
        ("suboff_fully_appended", "Zq", "warn"),
        ("suboff_fully_appended", "Mq", "fail"),
        ("suboff_fully_appended", "Mw", "warn"),
        ("suboff_fully_appended", "Yvdot", "fail"),
        ("suboff_fully_appended", "Nvdot", "warn"),
        ("suboff_fully_appended", "Yrdot", "warn"),
        ("suboff_fully_appended", "Nrdot", "fail"),
        ("suboff_fully_appended", "Zwdot", "fail"),
        ("suboff_fully_appended", "Mwdot", "warn"),
        ("suboff_fully_appended", "Zqdot", "warn"),
        ("suboff_fully_appended", "Mqdot", "fail"),
        ("suboff_bare_hull", "Nr", "fail"),
        ("suboff_bare_hull", "Nvdot", "warn"),
        ("suboff_bare_hull", "Nrdot", "fail"),
    ],
)
def test_a_flipped_sign_is_found(suboff: Study, name: str, symbol: str, severity: str) -> None:
    file = suboff.parameter_files[name]
    stated = file.coefficient(symbol)
    found = one(suboff, changed(file, **{symbol: -stated.value}))
    assert severity in [c.severity.value for c in found if f"{symbol}'" in c.subject]
    if symbol in ("Yr", "Zq", "Nv", "Mw"):
        assert f"with the other sign, {symbol}' = {stated.value:.4g}" in " ".join(c.comment for c in found)


@pytest.mark.parametrize(("half", "severity"), [(2.0, "note"), (0.5, "fail"), (None, "warn")])
def test_a_sign_that_the_data_leave_open_is_a_note(suboff: Study, half: float | None, severity: str) -> None:
    fit = suboff.fits[0]
    slope = next(c for c in fit.coefficients.coefficients if c.symbol == "Yv")
    turned = replace(slope, value=-slope.value, u95=None if half is None else half * abs(slope.value))
    alone = replace(fit, coefficients=replace(fit.coefficients, coefficients=(turned,)))
    [found] = signs(replace(suboff, fits=(alone,), parameter_files={}, missing=()))
    assert found.severity.value == severity
    assert ("leave the sign open" in found.comment) == (severity == "note")


@pytest.mark.parametrize("symbol", ["Yr", "Nv"])
def test_what_a_wide_slope_leaves_open_is_not_doubted(suboff: Study, symbol: str) -> None:
    """Yv' of the bare hull is known to 81 %: within that the force of either sign acts on the body. A narrow one tells."""
    file = suboff.parameter_files["suboff_bare_hull"]
    stated, slope = file.coefficient(symbol), file.coefficient("Yv")
    assert slope.u95 > 0.8 * abs(slope.value)
    assert one(suboff, changed(file, **{symbol: -stated.value})) == []


@pytest.mark.parametrize("symbol", ["Yv", "Zw"])
def test_a_flipped_slope_from_literature_fails(suboff: Study, symbol: str) -> None:
    file = suboff.parameter_files["suboff_fully_appended"]
    stated = file.coefficient(symbol)
    other = replace(stated, value=-stated.value, origin="literature", estimator="Table 4")
    coefficients = tuple(other if c is stated else c for c in file.coefficients)
    found = one(suboff, file.model_copy(update={"coefficients": coefficients}))
    assert [c.subject for c in found if c.severity is Severity.FAIL] == [f"suboff_fully_appended {symbol}'"]


def test_a_vehicle_with_its_fins_forward_is_not_doubted(suboff: Study) -> None:
    """Drift and turning both make their viscous force ahead."""
    file = suboff.parameter_files["suboff_fully_appended"]
    nv = file.coefficient("Nv")
    assert [c for c in one(suboff, changed(file, Nv=nv.potential - 0.008, Yr=-0.006)) if "Yr'" in c.subject] == []


def test_a_plan_with_flipped_literature_fails(tmp_path: Path) -> None:
    """The bare hull's Yr' and Nr' of Table 4, both of the wrong sign."""
    text = (shipped("cfd_data") / "suboff" / "published.toml").read_text()
    wrong = text.replace('Yr = "0.001811", Nr = "-0.001597"', 'Yr = "-0.001811", Nr = "0.001597"')
    assert wrong != text
    (tmp_path / "published.toml").write_text(wrong)
    (tmp_path / "plan.toml").write_text(
        f'[study]\nname = "s"\nwanted = ["Yv"]\n[body]\npath = "{shipped("geometry") / "suboff" / "body.toml"}"\n'
        f'[[table]]\ncampaign = "{shipped("cfd_data") / "suboff_roddy_3"}"\nfits = ["slope_at_origin"]\n'
        '[[references]]\npath = "published.toml"\n[[parameter_file]]\nname = "p"\nbody = "suboff_bare_hull"\n'
        'campaigns = ["suboff_roddy_3"]\nliterature = ["Roddy configuration 3"]\n'
        'added_mass = "suboff_bare_hull"\nadded_mass_method = "ellipsoid"\n'
    )
    study = run(read_plan(tmp_path / "plan.toml"))
    assert study.failed
    assert {(c.subject, c.severity.value) for c in doubts(study)} == {("p Nr'", "fail")}
    grave = {(c.name, c.subject) for c in study.checks if c.severity is Severity.FAIL}
    assert {("signs", "p Nr'"), ("printed_index", "Roddy configuration 3 G_h")} <= grave
    # U95 of Yv' leaves open whether Yr' acts aft: the printed index, not its place, tells of it.
    assert f"{study.parameter_files['p'].coefficient('Yv')!r}".startswith("<Coefficient Yv' = -0.0038 +- 0.0031")
    (index,) = (c for c in study.checks if c.name == "stability" and c.subject == "p G_h")
    assert "stable" not in index.statistic
    assert "Nr' - xG'm' is not negative: it drives the motion instead of damping it" in index.comment


def arm(folder: Path, inertia: bool, declared: str, hull: str = "", mass: float = MASS) -> Study:
    """The computed rotating arm of the bare hull with drift, with or without the model's inertia in it."""
    source = shipped("cfd_data") / "suboff_cfd_barehull"
    campaign = folder / "suboff_cfd_barehull"
    campaign.mkdir()
    head, *rows = (source / "rotating_arm.csv").read_text().splitlines()
    names = head.split(",")
    out = [head]
    for row in rows:
        cells = row.split(",")
        if inertia:
            y = names.index("Y [N]")
            cells[y] = f"{float(cells[y]) - MASS * 2.0 * float(cells[0]):.6g}"
        out.append(",".join(cells))
    (campaign / "rotating_arm.csv").write_text("\n".join(out) + "\n")
    (campaign / "drift.csv").write_bytes((source / "drift.csv").read_bytes())
    lines = [line for line in (source / "campaign.toml").read_text().splitlines() if "sha256" not in line]
    text = "\n".join(lines).replace(
        'file = "rotating_arm.csv"\ncontains_inertia = false', f'file = "rotating_arm.csv"\n{declared}'
    )
    text += f"\n[inertia]\nmass = {mass}\ncentre_of_gravity = [-2.004, 0, 0]\ninertia = [20, 1000, 1000]\n"
    (campaign / "campaign.toml").write_text(text)
    (folder / "plan.toml").write_text(
        f'[study]\nname = "s"\nwanted = ["Yv"]\n[body]\npath = "{shipped("geometry") / "suboff" / "body.toml"}"\n'
        '[[table]]\ncampaign = "suboff_cfd_barehull"\nfits = ["slope_at_origin"]\n' + hull
    )
    return run(read_plan(folder / "plan.toml"))


ARMS = [
    (
        True,
        "contains_inertia = false",
        "if the table contains the model's inertia (contains_inertia = true), Yr' = 0.000",
    ),
    (
        False,
        "contains_inertia = true",
        "if it never contained the inertia that was subtracted (contains_inertia = false), Yr' = 0.000",
    ),
]


@pytest.mark.parametrize(("inertia", "declared", "said"), ARMS)
def test_inertia_declared_wrongly_is_found(tmp_path: Path, inertia: bool, declared: str, said: str) -> None:
    (found,) = doubts(arm(tmp_path, inertia, declared))
    assert (found.subject, found.severity) == ("suboff_bare_hull Yr'", Severity.WARN)
    assert said in found.comment
    assert "m' = 0.01807" in found.comment
    assert "other sign" not in found.comment


@pytest.mark.parametrize(
    ("inertia", "declared"), [(False, "contains_inertia = false"), (True, "contains_inertia = true")]
)
def test_inertia_declared_rightly_is_not(tmp_path: Path, inertia: bool, declared: str) -> None:
    assert doubts(arm(tmp_path, inertia, declared)) == []


def bare(file: ParameterFile) -> ParameterFile:
    """Without added mass and what it gives."""
    coefficients = tuple(replace(c, potential=None) for c in file.coefficients)
    return file.model_copy(update={"coefficients": coefficients, "added_mass": None})


@pytest.fixture
def about_the_nose(suboff: Study) -> Callable[[float], ParameterFile]:
    """The fully appended hull about its nose, ``share`` of its inertia left in the rotary forces."""
    file = bare(suboff.parameter_files["suboff_fully_appended"])
    dx, yr, nr, m = 2.013 / LBP, 0.005251, -0.004444, 0.018296
    yv, nv = (float(c.value) for c in file.coefficients if c.symbol in ("Yv'", "Nv'") and c.value is not None)

    def made(share: float) -> ParameterFile:
        assert file.mass is not None
        mass = replace(file.mass, mass_moment_prime=-dx * m)
        moved = changed(
            file, Yr=yr - dx * yv - share * m, Nv=nv - dx * yv, Nr=nr - dx * (nv + yr) + dx**2 * yv + share * dx * m
        )
        keep = tuple(c for c in moved.coefficients if c.symbol in ("Yv'", "Nv'", "Yr'", "Nr'"))
        return moved.model_copy(update={"mass": mass, "coefficients": keep})

    return made


def test_the_lever_of_the_centre_of_gravity_counts(
    suboff: Study, about_the_nose: Callable[[float], ParameterFile]
) -> None:
    """About the nose Nr' - m' xG' of a table with inertia is above zero; N, too, tells of it."""
    assert one(suboff, about_the_nose(0.0)) == []
    found = {c.subject.split()[-1]: c for c in one(suboff, about_the_nose(1.0)) if c.name == "viscous_centre"}
    assert set(found) == {"Yr'", "Nr'"}
    assert "(contains_inertia = true), Nr' = -0.00583" in found["Nr'"].comment


def test_without_a_slope_the_mass_alone_decides(suboff: Study) -> None:
    file = bare(suboff.parameter_files["suboff_fully_appended"])
    kept = tuple(c for c in file.coefficients if c.symbol in ("Yr'", "Nr'"))
    file = file.model_copy(update={"coefficients": kept})
    assert one(suboff, file) == []
    (found,) = one(suboff, changed(file, Yr=-0.013))
    assert "(contains_inertia = true), Yr' = 0.005296" in found.comment


def test_without_a_mass_only_what_leaves_the_body_is_doubted(suboff: Study) -> None:
    file = bare(suboff.parameter_files["suboff_bare_hull"]).model_copy(update={"mass": None})
    study = replace(suboff, body=None)
    assert one(study, file) == []
    (found,) = one(study, changed(file, Yr=-0.05))
    assert found.subject == "suboff_bare_hull Yr'"
    assert "does the force contain the model's inertia?" in found.comment


def test_rates_without_their_point_enter_no_file(tmp_path: Path) -> None:
    """They differ from point to point, and so would G_h."""
    line = 'reference_point = ["-6.6042 ft", 0.0, 0.0]\n'
    text = (shipped("cfd_data") / "suboff" / "published.toml").read_text()
    head, mark, tail = text.partition('name = "Roddy configuration 3"')
    assert line in tail
    (tmp_path / "published.toml").write_text(head + mark + tail.replace(line, ""))
    (tmp_path / "plan.toml").write_text(
        f'[study]\nname = "s"\nwanted = ["Yv"]\n[[table]]\ncampaign = "{shipped("cfd_data") / "suboff_roddy_3"}"\n'
        'fits = ["slope_at_origin"]\n[[references]]\npath = "published.toml"\n[[parameter_file]]\nname = "p"\n'
        'body = "suboff_bare_hull"\ncampaigns = ["suboff_roddy_3"]\nliterature = ["Roddy configuration 3"]\n'
    )
    with pytest.raises(InputError) as caught:
        run(read_plan(tmp_path / "plan.toml"))
    assert caught.value.column == "parameter_file.p.literature"
    assert caught.value.found == '"Roddy configuration 3" without reference_point'


def test_a_mass_in_tonnes_is_refused(tmp_path: Path) -> None:
    """697.7 kg of 4.26 m is m' = 0.018; 0.6977 is that of a rod of 1,000 diameters, and would turn the sign of Yr'."""
    with pytest.raises(
        InputError, match=r"inertia\.mass.*0\.69\d* kg.*m' = 1\.8e-05.*\(0\.001 to 10\): kg\?.*0\.69\d* t"
    ):
        arm(tmp_path, True, "contains_inertia = true", mass=MASS / 1000.0)


@pytest.mark.parametrize(
    ("factor", "subjects"), [(1.19, []), (1.25, ["suboff_cfd_barehull mass"]), (0.5, ["suboff_cfd_barehull mass"])]
)
def test_a_model_of_another_mass_than_its_body_is_doubted(tmp_path: Path, factor: float, subjects: list[str]) -> None:
    study = arm(tmp_path, True, "contains_inertia = true", mass=factor * MASS)
    found = [c for c in sizes(study) if c.subject.endswith(" mass")]
    assert [c.subject for c in found] == subjects
    assert all(c.severity is Severity.WARN and f"{factor:.3g} of it" in c.statistic for c in found)


def test_masses_apart_by_a_unit_are_refused(tmp_path: Path) -> None:
    """A hundred times the body's: within what a body of the length can have, and no mass of this one."""
    with pytest.raises(InputError, match=r"70479\.7 kg under \[inertia\].*one mass of one body, in kg.*kg\?"):
        arm(tmp_path, True, "contains_inertia = true", mass=101.0 * MASS)


def test_a_rate_that_is_the_mass_of_the_model_has_a_note(tmp_path: Path) -> None:
    """Yr' = -m' of a table without inertia, by its U95; none where it is three U95 away."""
    study = arm(tmp_path, True, "contains_inertia = false")
    (file,) = study.parameter_files.values()
    u95 = file.coefficient("Yr").u95

    def notes(yr: float) -> list[Check]:
        mine = replace(study, parameter_files={file.name: changed(file, Yr=yr)})
        return [c for c in centres(mine) if c.severity is Severity.NOTE]

    (found,) = notes(0.9 * u95 - MASS_PRIME)
    assert "what the mass of the model alone gives, -0.01807" in found.statistic
    assert "contains_inertia = true" in found.comment
    assert notes(3.0 * u95 - MASS_PRIME) == []
