"""Oscillating runs: planted coefficients come back, with an interval that covers them; what is taken out has the right sign."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.fits.planar_motion import against_steady
from coeflab.fits.statistics.harmonics import CUBIC, QUADRATIC, cycles_of, refined, regress
from coeflab.fits.statistics.robust_errors import t_factor
from coeflab.law.coefficient import Status
from coeflab.tables.planar_motion import Filter
from tests.fits.oscillating import campaign, declared, fitted, law, record, run, table, truth

AMPLITUDES = {"sway": (0.05, 0.1, 0.2), "heave": (0.05, 0.1, 0.2), "yaw": (0.15, 0.3, 0.45), "pitch": (0.15, 0.3, 0.45), "roll": (0.3, 0.6, 0.9)}  # fmt: skip


def exact(motion: str, **how: Any) -> list[Any]:
    return [run(motion, a, noise=0.0, label=f"{motion} {a}", **how) for a in AMPLITUDES[motion]]


@pytest.mark.parametrize("motion", AMPLITUDES)
def test_exact_records_give_back_the_law(motion: str) -> None:
    found = fitted(*exact(motion)).coefficients
    assert found.coefficients
    for c in found.coefficients:
        assert c.value == pytest.approx(truth(c.symbol), rel=2e-5), c.symbol


@pytest.mark.parametrize("text", ["lag -{lag} deg", "none"])
def test_a_filter_with_the_wrong_phase_turns_damping_into_added_mass(text: str) -> None:
    """The Butterworth lags; declared as a lead, or not at all, the acceleration derivative is wrong by far."""
    order, cut_off = law().FILTER
    runs = exact("sway")
    lag = -np.degrees(np.angle(Filter(order, cut_off).gain(runs[0].omega)))
    assert lag > 5.0
    wrong = Filter.read(text.format(lag=lag), campaign().runs[0].listed, "filter")
    filters = dict.fromkeys(campaign().filters, wrong) | {"motion": Filter()}
    found = fitted(*runs, filters=filters).coefficients["Yvdot"]
    assert abs(found.value - truth("Yvdot")) > 0.1 * abs(truth("Yvdot"))


@pytest.mark.parametrize("text", ["lag {lag} deg", "delay {delay} s", "Butterworth 2, 2 Hz"])
def test_every_way_to_declare_a_lag_takes_it_out(text: str) -> None:
    runs = exact("sway")
    omega = runs[0].omega
    gain = Filter(*law().FILTER).gain(omega)
    words = text.format(lag=-np.degrees(np.angle(gain)), delay=-np.angle(gain) / omega)
    filters = dict.fromkeys(campaign().filters, Filter.read(words, runs[0].listed, "filter")) | {"motion": Filter()}
    found = fitted(*runs, filters=filters).coefficients["Yvdot"]
    assert found.value == pytest.approx(truth("Yvdot"), rel=0.02)


def test_a_filter_that_motion_and_forces_share_cancels() -> None:
    shared = Filter(*law().FILTER)
    made = table(*exact("sway"))
    late = []
    for r in made.runs:
        gain = shared.gain(r.omega)
        theta = r.omega * r.record.time + 0.7 + np.angle(gain)
        y = (
            abs(gain)
            * np.max(np.abs(r.record.displacements["y"]))
            / np.max(np.abs(np.sin(r.omega * r.record.time + 0.7)))
        )
        late.append(replace(r, record=record({"t": r.record.time, "y": y * np.sin(theta), **r.record.forces})))
    found = fitted(*late, filters=dict.fromkeys(made.filters, shared)).coefficients
    assert found["Yvdot"].value == pytest.approx(truth("Yvdot"), rel=1e-4)
    assert found["Yv"].value == pytest.approx(truth("Yv"), rel=1e-4)


def test_butterworth_agrees_with_scipy() -> None:
    signal = pytest.importorskip("scipy.signal")
    pole, zero = signal.butter(4, 2.0 * np.pi * 5.0, analog=True, output="ba")
    for f in (0.2, 1.0, 5.0, 9.0):
        whole = signal.freqs(pole, zero, [2.0 * np.pi * f])[1][0]
        assert Filter(4, 5.0).gain(2.0 * np.pi * f) == pytest.approx(whole, rel=1e-12)
        assert Filter(4, 5.0, zero_phase=True).gain(2.0 * np.pi * f) == pytest.approx(abs(whole) ** 2, rel=1e-12)


def test_the_model_inertia_is_taken_out_exactly() -> None:
    """With and without inertia in the record the same; kept in it, Yvdot is off by m' and Yr by m', Nr by m' x_G'."""
    m = law()
    for motion in ("sway", "yaw"):
        with_it, without = exact(motion), exact(motion, inertia=False)
        found, bare = fitted(*with_it).coefficients, fitted(*without, inertia=None).coefficients
        for a, b in zip(found.coefficients, bare.coefficients, strict=True):
            assert a.value == pytest.approx(b.value, rel=1e-6)
        left = fitted(*with_it, inertia=None).coefficients
        mass = m.MASS / (0.5 * m.DENSITY * m.LENGTH**3)
        centre = m.CENTRE[0] / m.LENGTH
        expected = {
            "sway": {"Yvdot": -mass, "Nvdot": -mass * centre},
            "yaw": {"Yr": -mass, "Nr": -mass * centre, "Yrdot": -mass * centre},
        }
        for symbol, shift in expected[motion].items():
            # To first order in the angle; the path of pure yaw is faster by 1 / cos(psi).
            assert left[symbol].value - found[symbol].value == pytest.approx(shift, rel=0.02)  # type: ignore[operator]


def test_runs_in_air_take_the_inertia_out_whatever_their_phase() -> None:
    m, runs = law(), []
    for r in exact("sway"):
        phase = 2.1
        theta = r.omega * r.record.time + phase
        size = np.max(np.abs(np.fft.rfft(r.record.displacements["y"]))) * 2.0 / len(r.record.time)
        nu, rates = np.zeros((len(theta), 6)), np.zeros((len(theta), 6))
        nu[:, 0], nu[:, 1] = m.SPEED, size * r.omega * np.cos(theta)
        rates[:, 1] = -size * r.omega**2 * np.sin(theta)
        held = m.held(nu, rates)
        gain = Filter(*m.FILTER).gain(r.omega)
        late = {}
        for c in "YNK":
            content = np.linalg.lstsq(
                np.column_stack([np.cos(theta), np.sin(theta), np.ones_like(theta)]), -held[c], rcond=None
            )[0]
            late[c] = np.real(gain * (content[0] - 1j * content[1]) * np.exp(1j * theta)) + content[2]
        air = record({"t": r.record.time, "y": size * np.sin(theta), **late})
        runs.append(replace(r, in_air=air))
    found = fitted(*runs, inertia=None).coefficients
    for symbol in ("Yv", "Yvdot", "Nv", "Nvdot"):
        assert found[symbol].value == pytest.approx(truth(symbol), rel=1e-3)


def test_restoring_moments_left_in_pass_for_added_inertia() -> None:
    kept = fitted(*exact("roll"), restoring=(0.0, 0.0)).coefficients["Kpdot"]
    m = law()
    omega = 2.0 * m.SPEED / m.LENGTH
    # K = -C phi, and phi = -pdot / omega^2.
    off = m.RESTORING[0] / omega**2 / (0.5 * m.DENSITY * m.LENGTH**5)
    assert kept.value == pytest.approx(truth("Kpdot") + off, rel=1e-3)


def test_relations_of_pure_sway_by_hand() -> None:
    """Gertler 1959: with y = a sin(wt), Y holds -Yvdot w^2 a in phase with y and Yv w a in quadrature."""
    a, w, yv, yvdot = 0.1, 1.7, -40.0, -55.0
    t = np.arange(200) * 2.0 * np.pi / w / 40.0
    force = -yvdot * w**2 * a * np.sin(w * t) + yv * w * a * np.cos(w * t)
    phasor = regress(w * t, force[:, None]).phasors[0, 1]
    assert phasor.real / (w * a) == pytest.approx(yv, rel=1e-12)
    assert phasor.imag / (w * w * a) == pytest.approx(yvdot, rel=1e-12)


def test_describing_functions() -> None:
    theta = np.linspace(0.0, 2.0 * np.pi, 20000, endpoint=False)
    c = np.cos(theta)
    for force, factor in ((c * np.abs(c), QUADRATIC), (c**3, CUBIC)):
        assert 2.0 * np.mean(force * c) == pytest.approx(factor, rel=1e-7)


def test_errors_by_cycles_cover_correlated_noise() -> None:
    """400 records of 6.5 cycles whose noise stays correlated for half a cycle."""
    rng = np.random.default_rng(3)
    n, m = 260, 400
    theta = np.arange(n) * 2.0 * np.pi / 40.0
    noise = rng.standard_normal((n, m))
    for i in range(1, n):
        noise[i] += 0.9 * noise[i - 1]
    found = regress(theta, 2.0 * np.cos(theta)[:, None] + 3.0 * np.sin(theta)[:, None] + noise)
    assert found.freedom == 5
    for part, true, k in ((found.phasors[:, 1].real, 2.0, 0), (-found.phasors[:, 1].imag, 3.0, 1)):
        half = t_factor(found.freedom) * np.sqrt(found.covariance[:, k, k])
        assert 0.92 <= np.mean(np.abs(part - true) <= half) <= 0.98
        # White noise of the same residuals would claim much less.
        assert np.mean(half) > 1.5 * t_factor(250.0) * np.std(noise) * np.sqrt(2.0 / n) * 0.9


def test_frequency_is_refined() -> None:
    t = np.arange(300) * 0.05
    for start in (0.97, 1.03):
        assert refined(t, np.sin(2.7 * t + 0.3), 2.7 * start) == pytest.approx(2.7, rel=1e-9)
    assert cycles_of(np.arange(40) * 2.0 * np.pi / 20.0) == pytest.approx(2.0)


@pytest.mark.slow
def test_intervals_cover_the_planted_law() -> None:
    """200 seeds, every motion, noise correlated over time and in proportion to each run's force: at least 90 % each."""
    inside: dict[str, list[bool]] = {}
    clean = {m: [(declared(run(m, a, noise=0.0, restoring=True), a)) for a in AMPLITUDES[m]] for m in AMPLITUDES}
    made = law()
    for seed in range(200):
        rng = np.random.default_rng(seed)
        runs = []
        for several in clean.values():
            for r in several:
                noisy = {}
                for c, force in r.record.forces.items():
                    error = rng.standard_normal(len(force))
                    for i in range(1, len(error)):
                        error[i] = made.CORRELATION * error[i - 1] + np.sqrt(1.0 - made.CORRELATION**2) * error[i]
                    noisy[c] = force + made.NOISE * np.max(np.abs(force)) * error
                runs.append(replace(r, record=replace(r.record, forces=noisy)))
        for c in fitted(*runs).coefficients.coefficients:
            if c.u95 is not None and c.value is not None:
                inside.setdefault(c.symbol, []).append(abs(c.value - truth(c.symbol)) <= c.u95)
    assert len(inside) == 30
    for symbol, hits in inside.items():
        assert len(hits) >= 190, symbol
        assert np.mean(hits) >= 0.90, (symbol, np.mean(hits))


def test_one_amplitude_has_no_interval_and_says_so() -> None:
    found = fitted(run("sway", 0.1, noise=0.0)).coefficients
    assert found["Yv"].status is Status.SINGLE_ESTIMATOR
    assert found["Yv"].u95 is None
    assert found["Yv"].value == pytest.approx(truth("Yv") + QUADRATIC * 0.1 * truth("Yv|v|"), rel=1e-4)
    assert "Yv|v|" not in found


def test_dependence_on_frequency_is_seen_and_taken_to_rest() -> None:
    """Added mass and damping that go with omega'^2: the slope is reported, and an interval gives the value at rest."""
    m, runs = law(), []
    for a, w in product((0.05, 0.1, 0.2), (1.0, 2.0, 3.0)):
        r = run("sway", a, w, label=f"{a} {w}", noise=0.0)
        gain = Filter(*m.FILTER).gain(r.omega)
        theta = r.omega * r.record.time + 0.7
        extra = 0.002 * w**2 * a * m.unit("Y") * np.real(gain * np.exp(1j * theta))
        forces = dict(r.record.forces) | {"Y": r.record.forces["Y"] + extra}
        runs.append(replace(r, record=replace(r.record, forces=forces)))
    found = fitted(*runs)
    slope, half, chance = found.oscillations[0].damping.frequency
    assert slope == pytest.approx(0.002 * 4.0, rel=0.1)
    assert abs(slope) > half
    assert chance < 0.05
    at_rest = fitted(*runs, options={"steady_below": 3.0}).coefficients["Yv"]
    assert at_rest.value == pytest.approx(truth("Yv"), rel=1e-3)
    assert "taken to w' = 0" in at_rest.estimator
    starved = fitted(*runs, options={"steady_below": 1.0}).coefficients["Yv"]
    assert starved.status is Status.TOO_FEW_POINTS
    assert "two frequencies up to w' = 1" in starved.estimator


def test_runs_with_drift_are_shown_and_not_used() -> None:
    straight = exact("yaw")
    found = fitted(*straight, run("yaw", 0.3, noise=0.0, drift=6.0, label="drift"))
    o = next(o for o in found.oscillations if o.symbol == "Nr")
    assert [r.label for r in o.runs if not r.used] == ["drift"]
    assert o.runs[-1].drift == pytest.approx(np.sin(np.radians(6.0)), rel=1e-6)
    assert found.coefficients["Nr"].value == pytest.approx(truth("Nr"), rel=1e-4)


def test_amplitude_explains_the_difference_to_the_steady_law() -> None:
    found = fitted(*exact("sway"))
    own = found.oscillations[0].explained()
    assert own.by_amplitude == pytest.approx(QUADRATIC * 0.2 * truth("Yv|v|"), rel=1e-4)
    assert own.difference == pytest.approx(own.by_amplitude, rel=1e-4)
    steady = replace(found, fit="slope_at_origin", campaign="steady", oscillations=())
    (against,) = [e for e in against_steady(found, (steady,)) if e.symbol == "Yv"]
    assert against.against == "steady by slope_at_origin"
    assert against.by_amplitude == pytest.approx(own.by_amplitude, rel=1e-3)
    assert abs(against.rest[0]) <= 1e-3 * abs(against.difference)
    assert against_steady(found, (replace(steady, body="another"),)) == ()


def test_moved_to_another_point() -> None:
    """Derivatives about a point ahead by the congruence transform, as for steady ones."""
    made = table(*exact("sway"), *exact("yaw"))
    ahead = fitted(
        *made.runs, reference_point=np.array([0.2, 0.0, 0.0]), measured_about=made.reference_point
    ).coefficients
    shift = 0.2 / made.scaling.length
    assert ahead["Yv"].value == pytest.approx(truth("Yv"), rel=1e-4)
    assert ahead["Nv"].value == pytest.approx(truth("Nv") - shift * truth("Yv"), rel=1e-4)
    assert ahead["Nvdot"].value == pytest.approx(truth("Nvdot") - shift * truth("Yvdot"), rel=1e-3)
    assert ahead["Nv|v|"].value == pytest.approx(truth("Nv|v|") - shift * truth("Yv|v|"), rel=1e-3)
    assert ahead["Nr|r|"].status is Status.NOT_DETERMINED


def _cut(r: Any, keep: slice) -> Any:
    values = {**r.record.displacements, **r.record.forces}
    return replace(r, record=record({"t": r.record.time[keep], **{n: v[keep] for n, v in values.items()}}))


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        (lambda r: _cut(r, slice(0, 20)), "at least one whole cycle"),
        (lambda r: _cut(r, slice(0, None, 4)), "samples a cycle"),
        (lambda r: replace(r, omega=1.3 * r.omega), "the frequency of the list of runs"),
        (lambda r: replace(r, amplitude=0.5), "that of the list of runs"),
        (lambda r: replace(r, phase=0.7 + np.pi), "from the declared one"),
        (lambda r: replace(r, motion="yaw"), "no column psi or r"),
    ],
)  # fmt: skip
def test_a_run_that_cannot_be_is_refused(broken: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        fitted(broken(run("sway", 0.1, noise=0.0)))


def test_impure_yaw_mixed_speeds_and_a_contradicting_velocity_are_refused() -> None:
    yaw = run("yaw", 0.3, noise=0.0)
    turned = record({"t": yaw.record.time, "psi": yaw.record.displacements["psi"], **yaw.record.forces})
    with pytest.raises(InputError, match="pure yaw"):
        fitted(replace(yaw, record=turned))
    sway = run("sway", 0.1, noise=0.0)
    with pytest.raises(InputError, match="one speed a motion"):
        fitted(sway, replace(sway, speed=2.0))
    late = record({
        "t": sway.record.time, **sway.record.displacements, **sway.record.forces,
        "v": 0.15 * np.cos(sway.omega * sway.record.time + 1.0),
    })  # fmt: skip
    with pytest.raises(InputError, match="deg of phase"):
        fitted(replace(sway, record=late))
