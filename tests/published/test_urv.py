"""The URV paper reproduced: what it prints, its errata as numbers, energy, drag, thrusters and control."""

from __future__ import annotations

import json

import numpy as np
import pytest

from coeflab.cli import show
from coeflab.published.urv import acceptance as urv
from coeflab.published.urv import tasks, theory
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.report.as_json import studies as as_json


@pytest.fixture(scope="module")
def tables() -> dict[str, ComparedTable]:
    return {t.key: t for t in urv.compared()}


@pytest.fixture(scope="module")
def moving() -> dict[str, ComparedTable]:
    return {t.key: t for t in urv.moved()}


def rows(table: ComparedTable) -> dict[tuple[str, str], Compared]:
    return {(r.case, r.quantity): r for r in table.rows}


def test_every_number_holds(tables: dict[str, ComparedTable]) -> None:
    assert list(tables) == [
        "link_1", "transformations", "mass_matrix", "bias", "added_mass", "spheroid", "theory", "flow", "drag", "thrusters", "earth",
        "errata",
    ]  # fmt: skip
    assert [(k, r.case, r.quantity) for k, t in tables.items() for r in t.rows if not r.holds] == []


def test_only_what_the_paper_prints_is_validation(tables: dict[str, ComparedTable]) -> None:
    printed = [(r.case, r.quantity) for t in tables.values() for r in t.rows if r.basis is Basis.VERIFICATION]
    assert len(printed) == 13
    assert {case for case, _ in printed} == {"link 1", "gravity along x"}
    assert {t.key for t in tables.values() if any(r.basis is Basis.CALIBRATION for r in t.rows)} == {"transformations"}
    assert not any(r.basis is Basis.VALIDATION for t in tables.values() for r in t.rows)


def test_independent_numbers(tables: dict[str, ComparedTable]) -> None:
    """Typed from the specification of the system, not from the module."""
    mass, bias, added = (rows(tables[k]) for k in ("mass_matrix", "bias", "added_mass"))
    assert mass["diagonal, q1", "entry"].found == pytest.approx(2.703695, abs=5e-7)
    assert mass["row 1, w_z", "entry"].found == pytest.approx(-6.654255, abs=5e-7)
    assert bias["C, v_y", "entry"].found == pytest.approx(9.523231, abs=5e-7)
    assert bias["C, q3", "entry"].found == pytest.approx(0.002126, abs=5e-7)
    assert added["diagonal, v_z", "entry"].found == pytest.approx(515.812717, abs=5e-7)
    assert added["diagonal, q3", "entry"].found == pytest.approx(0.052083, abs=5e-7)


def test_errata_are_shown_as_printed_and_as_corrected(tables: dict[str, ComparedTable]) -> None:
    found = rows(tables["errata"])
    cases = [case for case, _ in found]
    assert {c.split()[0] for c in cases} == {str(i) for i in range(1, 10)}
    assert sum(c.endswith("as printed") for c in cases) == sum(c.endswith("corrected") for c in cases) == 15
    for case, quantity in found:
        if case.endswith("as printed"):
            twin = found[case.removesuffix("as printed") + "corrected", quantity]
            assert abs(found[case, quantity].found - twin.found) > 1e3 * twin.tolerance or "spheroid" in case
    assert found["1 e of the spheroid, as printed", "A55/m"].found == pytest.approx(0.0517, abs=5e-5)
    assert found["1 e of the spheroid, corrected", "A55/m"].found == pytest.approx(0.0847, abs=5e-5)
    assert found["4 equation 16, as printed", "power from nothing"].found == pytest.approx(-0.04523893)
    assert len(urv.PAPER.texts("errata")) == 9


def test_energy_and_power(moving: dict[str, ComparedTable]) -> None:
    assert moving["energy"].holds
    limits = {r.quantity: r.tolerance for r in moving["energy"].rows}
    assert limits["change of kinetic energy over itself"] == 1e-8
    assert limits["energy gained less work, over the larger"] == 1e-6


def test_control_does_what_its_law_says(moving: dict[str, ComparedTable]) -> None:
    assert moving["control"].holds
    said = " ".join(moving["control"].statements)
    for words in (
        "The paper prints no controller",
        "voltage-driven",
        "nothing at its limit",
        "End effector on a straight line",
    ):
        assert words in said
    runs = tasks.tasks()
    assert runs["torque"].apart.max() < 1e-3 < runs["station"].end_apart.max()
    straight = runs["end"].end_wanted
    line = straight[-1] - straight[0]
    off = np.cross(straight - straight[0], line) / np.linalg.norm(line)
    assert np.abs(off).max() < 5e-4
    assert np.linalg.norm(line) == pytest.approx(np.linalg.norm(tasks.REACH), abs=1e-6)


def test_hamel_sees_a_changed_mass(monkeypatch: pytest.MonkeyPatch) -> None:
    chain = theory.wet()
    speeds = theory.in_frame_0(chain, theory.SPEEDS)
    before = theory.hamel_bias(chain, theory.Q, speeds)
    mass = theory.kane.mass_matrix
    monkeypatch.setattr(theory.kane, "mass_matrix", lambda c, q: 1.05 * mass(c, q))
    assert theory.hamel_bias(chain, theory.Q, speeds) == pytest.approx(1.05 * before)


def test_json_of_every_table(
    tables: dict[str, ComparedTable], moving: dict[str, ComparedTable], capsys: pytest.CaptureFixture[str]
) -> None:
    show.json_object(as_json.acceptance(Acceptance("urv", "", (*tables.values(), *moving.values()), (), (), ())))
    assert json.loads(capsys.readouterr().out)["passed"] is True
