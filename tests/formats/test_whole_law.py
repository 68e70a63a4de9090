"""Every export against the whole law: tables that it cannot hold, courses astern, and what was found of the numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import remark
from coeflab.formats import EXPORTERS, SimulatorExporter
from coeflab.formats.export import PlannedExport, export, exports_of
from coeflab.formats.exported_law import written_terms
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import LOSSLESS, rare_states
from coeflab.formats.missing_parts import Kind
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats.massed import torpedo
from tests.vehicle.hybrid import RATES, hybrid

TARGETS = [n for n in EXPORTERS.names() if isinstance(EXPORTERS.load(n), SimulatorExporter)]
CODE = ["c", "fmi", "mss", "python_vehicle_simulator", "xdyn"]  # targets that are programs
ASTERN = np.array(
    [[-1.0, 0, 0, 0, 0, 0], [-0.05, 1.0, 0, 0, 0, 0], [0.0, 1.0, 0.2, 0, 0, 0], [0.0] * 6, [0, 0, 0, 0, 0, 0.4]]
)


def rendered(target: str, file: ParameterFile) -> object:
    return EXPORTERS.load(target).render(file)


@pytest.mark.parametrize("target", CODE)
def test_resistance_is_drag_astern_broadside_and_at_rest_in_every_program(target: str) -> None:
    """X0' pushed astern with the whole resistance: -4.69 N at -1 m/s in a toy torpedo."""
    file, plugin = torpedo(), EXPORTERS.load(target)
    files = plugin.render(file)
    found, wanted = plugin.force(files, ASTERN), motion_law(file)[0].force(ASTERN)
    assert found[0, 0] > 0.0
    np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-6)  # U is never below 1e-9 m/s there
    assert abs(found[2, 0] - motion_law(replaced_x0(file))[0].force(ASTERN)[2, 0]) < 1e-9  # none of X0' at u = 0


def replaced_x0(file: ParameterFile) -> ParameterFile:
    kept = tuple(replace(c, value=0.0, value_si=0.0) if c.symbol == "X0'" else c for c in file.coefficients)
    return file.model_copy(update={"coefficients": kept})


@pytest.mark.parametrize("target", [t for t in TARGETS if t not in ("holoocean", "mujoco", "stonefish")])
def test_no_target_with_a_resistance_pushes_astern(target: str) -> None:
    file, plugin = torpedo(), EXPORTERS.load(target)
    assert plugin.force(plugin.render(file), ASTERN[:1])[0, 0] > 0.0


def test_the_states_of_a_loss_hold_astern_broadside_and_rest() -> None:
    rare = rare_states(torpedo())
    speed = np.linalg.norm(rare[:, :3], axis=1)
    assert np.any(rare[:, 0] <= -1.5 * torpedo().conditions.speed)
    assert all(np.any((np.abs(rare[:, k]) > 0.0) & (rare[:, 0] == 0.0)) for k in (1, 2))
    assert np.any((speed == 0.0) & (np.abs(rare[:, 5]) > 0.0))
    assert np.any(np.all(rare == 0.0, axis=1))


def test_a_law_that_differs_astern_alone_is_not_lossless() -> None:
    made = export(torpedo(), "mss").loss
    assert made.rare.furthest[1] <= LOSSLESS
    worse = replace(made, rare=replace(made.rare, worst=np.array([1.0, 0, 0, 0, 0, 0])))
    assert not worse.lossless


@pytest.mark.parametrize("target", TARGETS)
def test_a_target_without_tables_says_which_parts_it_lacks_and_writes_no_ideal_fluid_in_their_place(
    target: str,
) -> None:
    file = hybrid()
    if "tables" in EXPORTERS.load(target).holds:
        loss = export(file, target).loss
        assert not any("C_D" in x.what for x in loss.lost)
        assert max(loss.furthest[1], loss.rare.furthest[1]) <= LOSSLESS
        return
    try:
        made = export(file, target, accept_loss=True)
    except InputError:
        return  # it holds no such vehicle at all
    loss = made.loss
    assert not made.lossless
    held = " ".join(x.what for x in loss.lost if x.kind is Kind.NOT_HELD)
    assert all(f"{m.response} over alpha, beta" in held for m in file.models)
    text = "".join(c.decode(errors="ignore") for c in made.files.values())
    assert "C_D over alpha and beta" in text
    _, (refused,) = exports_of([PlannedExport(target)], [file], lambda _: None)
    assert "C_D" in str(refused.why)


def test_programs_hold_only_the_products_that_no_source_speaks_of() -> None:
    symbols = {t.symbol for t in written_terms(hybrid())}
    assert symbols >= set(RATES)
    assert "Xvr" in symbols  # the cross term of the added mass
    assert not symbols & {"Nuv", "Muw", "Yur", "Zuq", "Nvu", "Mwu"}
    bare = {t.symbol for t in written_terms(hybrid(models=()))}
    assert "Nuv" in bare


@pytest.mark.parametrize("target", EXPORTERS.names())
def test_what_was_found_of_the_numbers_is_in_every_export(target: str) -> None:
    found = Finding.of("law.undetermined", "C_D C_D_7", Severity.NOTE)
    file = torpedo().model_copy(update={"findings": (found,)})
    made = export(file, target, accept_loss=True)
    text = "\n".join(c.decode(errors="ignore") for n, c in made.files.items() if not n.endswith(".loss.txt"))
    assert " ".join(remark(found).split()).removesuffix(".") in " ".join(text.split())
    assert remark(found).removesuffix(".") in in_header(file)
