"""What a file says nothing of stands in the message, the loss report and the head of what is written."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.formats.export import export
from coeflab.formats.lacking_law import unstated, without_law
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.own_numbers import imported_file, mass_of, own_numbers
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics

PLANAR = ["Yv'=-0.03", "Nv'=-0.012", "Yr'=0.005", "Nr'=-0.006", "Xudot'=-0.001", "Yvdot'=-0.009", "Nrdot'=-0.0005"]
SAID = "no law for X, Z, K, M: only v and r may move at a constant u; hold w, p and q"


def file(*numbers: str, inertia: tuple[float, ...] = (12.0,)) -> ParameterFile:
    centre = np.zeros(3) if len(inertia) == 3 else None
    return imported_file(
        "planar", "planar", Scaling(2.0, "LOA"), Conditions(1000.0, 1.0), np.zeros(3), Datum("cg"), own_numbers(numbers),
        mass_of(40.0, centre, inertia),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ([], (SAID,)),
        (["X0'=-0.002"], ("no law for Z, K, M: only u, v and r may move; hold w, p and q",)),
        (["X0'=-0.002", "Zw'=-0.03", "Kp'=-1e-4"], ("no law for M: only u, v, w, p and r may move; hold q",)),
        (["Zds'=-0.01", "X0'=-0.002", "Kp'=-1e-4", "Mq'=-0.01"], ("no law for Z: only u, v, p, q and r may move; hold w",)),
        (["Zw'=-0.03", "Kp'=-1e-4", "Mq'=-0.01"], ("no law for X: nothing resists u; keep the speed constant",)),
        (["X0'=-0.002", "Zw'=-0.03", "Kp'=-1e-4", "Mq'=-0.01"], ()),
    ],
)  # fmt: skip
def test_components_without_a_law(more: list[str], said: tuple[str, ...]) -> None:
    assert without_law(file(*PLANAR, *more)) == said


def test_accelerations_alone_are_no_law() -> None:
    assert without_law(file("Yvdot'=-0.009")) == ("no law for X, Y, Z, K, M, N: the file has no force of the water",)


@pytest.mark.parametrize(
    "target", ["mss", "xdyn", "gazebo", "gazebo_plugin", "uuv_simulator", "python_vehicle_simulator"]
)
def test_it_stands_in_the_loss_report_and_in_the_head_of_the_file(target: str) -> None:
    made = export(file(*PLANAR, inertia=(0.5, 12.0, 12.0)), target, accept_loss=True)
    texts = {name: content.decode() for name, content in made.files.items()}
    assert f"changed: {SAID}" in next(t for n, t in texts.items() if n.endswith(".loss.txt"))
    assert any(SAID in t for n, t in texts.items() if not n.endswith(".loss.txt"))


def test_what_a_loop_about_an_mss_function_needs_is_named() -> None:
    bare = file(*PLANAR)
    (said,) = unstated(bare)
    assert said.endswith("the file lacks mass.centre, mass.inertia_matrix and hydrostatics")
    whole = file(*PLANAR, inertia=(0.5, 12.0, 12.0)).model_copy(
        update={"hydrostatics": ParameterHydrostatics(volume=0.04, centre_of_buoyancy=(0.0, 0.0, -0.01))}
    )
    assert unstated(whole) == ()
    for made, is_lacking in ((bare, True), (whole, False)):
        text = export(made, "mss", accept_loss=True).files["planar.m"].decode()
        assert ("the file lacks mass.centre (h.xG h.yG h.zG)" in text) == is_lacking
        assert ("h.I33 =" in text) != is_lacking
