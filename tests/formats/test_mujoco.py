"""The MuJoCo export: the real engine loads it and gives the force that its law says; what it cannot hold is said."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.errors import InputError
from coeflab.core.text.xml import parse_xml
from coeflab.formats.export import export
from coeflab.formats.missing_parts import Kind
from coeflab.formats.mujoco import write as exporter
from coeflab.formats.stated_file import Stated, stated_file
from coeflab.law.scaling import Conditions, Scaling, powers_of
from coeflab.published.huuv.model import parameter_file as huuv_file
from coeflab.published.huuv.model import read_huuv
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.massed import CENTRE, MASS, OWN, torpedo, with_mass
from tests.formats.vehicles import FACTS, vehicle

GOLDEN = Path(__file__).parent / "golden" / "mujoco.xml"
FLU = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
LIKE_SUBOFF = {"X0": -1e-3, "Yv": -2.8e-2, "Yr": 5.2e-3, "Nv": -1.4e-2, "Nr": -4.4e-3, "Yv|v|": -5e-2}
SLENDER = replace(made.HULL, matrix=np.diag([2.0, 70.0, 68.0, 0.5, 15.0, 16.0]))


SLENDER_ADDED = made.parameters({"X0": -1e-3}, SLENDER).added_mass


def slender(**values: float) -> ParameterFile:
    """A file whose Munk moment and side force put the centre within the hull."""
    return made.parameters({**LIKE_SUBOFF, **values}, SLENDER)


# Prestero, MIT and WHOI, 2001: REMUS, combined coefficients, SI per u v, u r and so on.
REMUS = {
    "Xu|u|": -1.62, "Yuv": -28.6, "Yur": 5.22, "Zuw": -28.6, "Zuq": -5.22, "Muw": 24.0, "Muq": -2.0, "Mq|q|": -188.0,
    "Nuv": -24.0, "Nur": -2.0, "Nr|r|": -94.0, "Kp|p|": -0.13,
}  # fmt: skip
CANONICAL = {n: n.replace("u", "") for n in REMUS} | {"Xu|u|": "X0"}
RATES = (0.05, 0.1, 0.2, 0.3, 0.5)


def remus(*names: str) -> ParameterFile:
    """Coefficients of REMUS under these names, with its added mass."""
    scaling, at = Scaling(1.33, "LOA"), Conditions(1030.0, 1.54)
    per_uv = {CANONICAL[n]: v for n, v in REMUS.items()} | REMUS
    values = {n: (per_uv[n] / (0.5 * at.density * scaling.length ** powers_of(n)[1]), "motion") for n in names}
    matrix = np.diag([0.93, 35.5, 35.5, 0.0704, 4.88, 4.88])
    return stated_file(Stated("remus", "remus", scaling, at, values, matrix=matrix), [], ())


def damping(file: ParameterFile, force: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """(6, 5): X at five speeds up to the file's, and Y over v to N over r at five rates, the part that is odd in them."""
    speed, out = file.conditions.speed, np.zeros((6, len(RATES)))
    for i in range(6):
        for k, rate in enumerate(RATES):
            nu = np.tile([speed, 0.0, 0.0, 0.0, 0.0, 0.0], (2, 1))
            if i == 0:
                nu[:, 0] *= 2.0 * rate
                out[i, k] = force(nu)[0, 0]
            else:
                nu[:, i] = rate * speed / (1.0 if i < 3 else file.scaling.length) * np.array([1.0, -1.0])
                out[i, k] = -np.subtract(*force(nu)[::-1, i]) / 2.0
    return out


def wrong(file: ParameterFile) -> list[str]:
    """Dampings whose sign is not that of the file's law; where no coefficient speaks of a motion, those that drive it."""
    law, files = force_law(file), exporter.render(file)
    ours, theirs = damping(file, law.force), damping(file, lambda nu: exporter.force(files, nu))
    stated = damping(file, replace(law, ideal=np.zeros((6, 6, 6))).force)
    bad = np.where(stated != 0.0, ours * theirs <= 0.0, theirs > np.maximum(ours, 0.0) + 1e-9)
    return [f"{'XYZKMN'[i]} {RATES[k]}: {ours[i, k]:.3g}, {theirs[i, k]:.3g}" for i, k in np.argwhere(bad)]


def engine() -> ModuleType:
    return pytest.importorskip("mujoco", reason="MuJoCo is not installed (dependency group test)")


def passive(file: ParameterFile, nu: np.ndarray) -> np.ndarray:
    """MuJoCo's fluid force in body axes, at random places and attitudes, without its balance of weight."""
    mujoco = engine()
    (content,) = exporter.render(file).values()
    model = mujoco.MjModel.from_xml_string(content.decode())
    data, rng, out = mujoco.MjData(model), np.random.default_rng(3), []
    model.body_gravcomp[:] = 0.0
    for velocity in nu * FLU:
        turn, matrix = rng.normal(size=4), np.zeros(9)
        data.qpos[:] = [*rng.normal(size=3), *(turn / np.linalg.norm(turn))]
        mujoco.mju_quat2Mat(matrix, data.qpos[3:])
        axes = matrix.reshape(3, 3)
        data.qvel[:] = [*(axes @ velocity[:3]), *velocity[3:]]
        mujoco.mj_forward(model, data)
        out.append(np.concatenate([axes.T @ data.qfrc_passive[:3], data.qfrc_passive[3:]]) * FLU)
    return np.array(out)


def test_golden() -> None:
    """Regenerate by hand: write exporter.render(plain()) to golden/mujoco.xml and read the difference."""
    assert exporter.render(made.plain()) == {"file.xml": GOLDEN.read_bytes()}


@pytest.mark.parametrize(
    "file", [made.plain(), slender(), with_mass(slender()), remus(*REMUS), vehicle("bluerov2_heavy")]
)
def test_the_real_engine_agrees(file: ParameterFile) -> None:
    nu = np.random.default_rng(4).normal(size=(40, 6))
    said = exporter.force(exporter.render(file), nu)
    np.testing.assert_allclose(passive(file, nu), said, atol=2e-6 * np.abs(said).max())


def test_what_it_takes_it_takes_exactly() -> None:
    """Resistance, side force, total yaw moment (Munk counted once) and the force of turning, near straight motion."""
    file = slender()
    speed, small = 1.5, 1e-6
    for at in ([0, 0], [small, 0], [0, small]):
        nu = np.array([[speed, at[0], 0.0, 0.0, 0.0, at[1]]])
        found, wanted = exporter.force(exporter.render(file), nu)[0], force_law(file).force(nu)[0]
        assert found[0] == pytest.approx(wanted[0], rel=1e-5)
        assert found[1] == pytest.approx(wanted[1], rel=1e-5, abs=1e-12)
        if not at[1]:
            assert found[5] == pytest.approx(wanted[5], rel=1e-5, abs=1e-12)
    rate = 0.25 * speed / 2.0
    moments = [exporter.force(exporter.render(file), np.array([[speed, 0, 0, 0, 0, s * rate]]))[0, 5] for s in (1, -1)]
    assert moments[0] == pytest.approx(-moments[1])
    assert moments[0] == pytest.approx(force_law(file).force(np.array([[speed, 0, 0, 0, 0, rate]]))[0, 5], rel=0.2)
    assert not {"X0", "Yv", "Nv", "Yr"} & set(exporter.not_held(file))


def test_the_loss_is_said() -> None:
    loss = export(made.plain(), "mujoco").loss
    assert not loss.lossless
    assert "added inertia" in loss.not_held[0]
    assert {"Nr", "Zw", "Yvvv"} <= set(loss.not_held)
    assert any("its Munk moment, and with it Nv, is chosen so that no turn is driven" in c for c in loss.changes)


def test_mass_and_inertia_are_those_of_the_file() -> None:
    mujoco = engine()
    (content,) = exporter.render(with_mass(slender())).values()
    model = mujoco.MjModel.from_xml_string(content.decode())
    assert model.body_mass[1] == MASS
    np.testing.assert_allclose(model.body_ipos[1], CENTRE * FLU[:3])
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[1])
    axes = turn.reshape(3, 3)
    np.testing.assert_allclose(
        axes @ np.diag(model.body_inertia[1]) @ axes.T * np.outer(FLU[:3], FLU[:3]), OWN, atol=1e-12
    )
    assert model.opt.density == 1000.0


def test_no_shape_without_added_mass() -> None:
    with pytest.raises(InputError, match="no added mass along x, y and z"):
        exporter.render(made.at_rest())


@pytest.mark.parametrize("name", made.HOSTILE)
def test_hostile_names_load(name: str) -> None:
    mujoco = engine()
    ((file, content),) = exporter.render(made.named(name)).items()
    assert "/" not in file
    assert mujoco.MjModel.from_xml_string(content.decode()).ngeom == 1


def test_every_vehicle_is_damped_as_its_file_says(suboff: Study) -> None:
    """Bare hull of SUBOFF at r' = .1: N was +185 N m for -69; REMUS and Healey's AUV were driven too. One of twelve is refused:
    the HUUV, whose file has no added mass.
    """
    shipped = {n: suboff.parameter_files[n] for n in suboff.parameter_files}
    published = {n: vehicle(n) for n in FACTS}
    ours = {"plain": made.plain(), "slender": slender(), "torpedo": torpedo(), "remus": remus(*REMUS)}
    found = {n: wrong(file) for n, file in {**shipped, **published, **ours}.items()}
    assert len(found) == 11
    with pytest.raises(InputError, match="no added mass along x, y and z"):
        exporter.render(huuv_file(read_huuv()))
    assert not {n: bad for n, bad in found.items() if bad}


def test_the_hull_of_suboff_keeps_what_it_kept_and_is_damped(suboff: Study) -> None:
    """Nv, Yv, Yr and X0 are met, Mw too since the geom stays where it is, and N at its rate is the file's."""
    file = suboff.parameter_files["suboff_fully_appended"]
    assert not {"X0", "Yv", "Nv", "Yr", "Mw"} & set(exporter.not_held(file))
    speed = file.conditions.speed
    geom, _ = exporter._fitted(file)
    nu = np.array([[speed, 0.0, 0.0, 0.0, 0.0, geom.rate * speed / file.scaling.length]])
    assert geom.force(nu)[0, 5] == pytest.approx(force_law(file).force(nu)[0, 5], rel=1e-6)


@pytest.mark.parametrize("names", [("Yuv", "Nuv", "Xu|u|"), tuple(REMUS), ("Xu|u|", "Zuw", "Muw", "Muq")])
def test_names_of_one_law_make_one_geom(names: tuple[str, ...]) -> None:
    """Yuv is Yv on a straight course; such a REMUS had ``fluidcoef="0 0 0 0 0"``, and nothing of it was held."""
    files = exporter.render(remus(*names))
    assert files == exporter.render(remus(*(CANONICAL[n] for n in names)))
    geom = next(parse_xml(files["remus.xml"].decode()).iter("geom"))
    assert float(geom.get("fluidcoef").split()[0]) > 0.0
    assert not {"Xu|u|", "Yuv", "Nuv", "Yur", "Muw"} & set(exporter.not_held(remus(*names)))
    assert wrong(remus(*names)) == []


@pytest.mark.parametrize("seed", range(12))
def test_a_law_that_damps_is_not_refused(seed: int) -> None:
    """Random slender bodies, more and less stable than their Munk moment."""
    rng = np.random.default_rng(seed)
    surge = 10 ** rng.uniform(-0.5, 1.5)
    sway = surge * rng.uniform(1.2, 40.0)
    values = {
        "X0": -rng.uniform(0.1, 0.5) * surge, "Yv": -rng.uniform(0.05, 1.5) * sway, "Yr": rng.uniform(-0.25, 0.4) * sway,
        "Nv": -rng.uniform(-0.15, 0.65) * (sway - surge), "Nr": -rng.uniform(0.01, 0.25) * sway,
    }  # fmt: skip
    masses = np.array([surge, sway, sway * rng.uniform(0.6, 1.5), 0.01 * sway, 0.1 * sway, 0.1 * sway])
    file = made.parameters({n: v / 2000.0 for n, v in values.items()}, replace(made.HULL, matrix=np.diag(masses)))
    assert wrong(file) == []


def test_a_damping_of_the_wrong_sign_is_refused() -> None:
    """A law that drives the turn: a fluid ellipsoid can only damp."""
    driven = slender(Nr=4.4e-3)
    said = r"Nr does not keep its sign: at r' = 0\.05 the file has N = 1\.98 N m, MuJoCo's fluid ellipsoid 0 N m"
    with pytest.raises(InputError, match=said) as caught:
        export(driven, "mujoco")
    assert "fmi, xdyn, mss or gazebo" in caught.value.advice


def bluff() -> ParameterFile:
    """A frame as wide as a third of its length and flat: of one lift, what Yv asks for drives heave."""
    hull = replace(made.HULL, matrix=np.diag([20.8, 33.4, 143.3, 2.8, 5.4, 2.6]))
    values = {"X0": -0.2, "Yv": -0.15, "Yv|v|": -0.15, "Zw": -0.28, "Zw|w|": -0.28, "Mq": -0.036, "Nr": -0.023}
    return with_mass(made.parameters(values, hull), np.zeros(3))


def opposite(file: ParameterFile) -> list[str]:
    """Dampings that the file has the other way round, or that drive a motion of which it says nothing."""
    law, files = force_law(file), exporter.render(file)
    ours, theirs = damping(file, law.force), damping(file, lambda nu: exporter.force(files, nu))
    small = 1e-8 * np.abs(ours).max(axis=1, keepdims=True)
    bad = ((np.abs(theirs) > small) & (ours * theirs < 0.0)) | ((theirs > small) & (ours <= small))
    return [f"{'XYZKMN'[i]} {RATES[k]}: {ours[i, k]:.3g}, {theirs[i, k]:.3g}" for i, k in np.argwhere(bad)]


def test_a_lift_of_the_wrong_sign_is_left_out_for_those_who_accept_it() -> None:
    mujoco, file = engine(), bluff()
    with pytest.raises(InputError, match="Zw does not keep its sign") as caught:
        export(file, "mujoco")
    assert "fmi, xdyn, mss or gazebo. Or accept the loss" in caught.value.advice
    found = export(file, "mujoco", accept_loss=True)
    (left,) = (x for x in found.loss.lost if x.kind is Kind.LEFT_OUT)
    assert left.what.startswith("the lift of Yv: with it Zw does not keep its sign: at w' = 0.05")
    assert "Yv" in found.loss.not_held
    text = found.files["file.xml"].decode()
    assert "Left out: the lift of Yv" in text
    assert opposite(file) == []
    theirs = damping(file, lambda nu: exporter.force({"file.xml": found.files["file.xml"]}, nu))
    assert np.all(theirs[[0, 1, 2, 4, 5]] < 0.0)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qvel[:] = [1.0, 0.5, -0.5, 0.2, 0.2, -0.2]
    mujoco.mj_step(model, data, 1000)
    assert np.linalg.norm(data.qvel) < 0.5


@pytest.mark.parametrize("seed", range(12))
def test_no_damping_is_ever_the_wrong_way_round(seed: int) -> None:
    """Random laws that damp some motions and drive others, with bluff bodies among them."""
    rng = np.random.default_rng(seed)
    masses = np.diag(ellipsoid_added_mass(rng.uniform(0.1, 1.0, 3), 1000.0))
    names = ("X0", "Yv", "Zw", "Kp", "Mq", "Nr", "Yv|v|", "Zw|w|", "Nr|r|", "Nv", "Mw", "Yr", "Zq")
    values = {n: float(rng.choice([-1.0, -1.0, 0.5]) * 10 ** rng.uniform(-3.0, -1.0)) for n in names}
    hull = replace(made.HULL, matrix=np.diag(masses + 0.1))
    assert opposite(made.parameters(values, hull)) == []


def test_what_drives_a_turn_is_left_out_alone() -> None:
    loss = export(slender(Nr=4.4e-3), "mujoco", accept_loss=True).loss
    assert [x.what.partition(":")[0] for x in loss.lost if x.kind is Kind.LEFT_OUT] == ["Nr"]
    assert not {"X0", "Yv", "Nv"} & set(loss.not_held)


def test_a_table_is_a_loss_and_no_reason_to_refuse() -> None:
    """The drag and the side force of the HUUV are tables alone, which no simulator is given."""
    hull = replace(SLENDER_ADDED, body="HUUV")
    file = huuv_file(read_huuv()).model_copy(update={"added_mass": hull})
    loss = export(file, "mujoco").loss
    assert any("no force stands in its place" in str(x) for x in loss.lost)
