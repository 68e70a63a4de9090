"""One oscillating run as equivalent linear coefficients: its motion, its harmonics, and what is taken out of them.

Recorded is the filter's gain times the fluid's force less the model's inertia M_RB nudot + C_RB(nu) nu about the reference
point, less the moments of weight and buoyancy.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.types import Array
from coeflab.fits.results.oscillation import OscillatedForce
from coeflab.fits.statistics import harmonics
from coeflab.fits.statistics.robust_errors import t_factor
from coeflab.law.rigid_body import parallel_axis, rigid_body_force, rigid_body_inertia
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.tables import planar_motion

GIVES = {"sway": "YNK", "yaw": "YNK", "heave": "ZM", "pitch": "ZM", "roll": "KYN"}
LEAST_SAMPLES = 8  # a cycle
UNEXPLAINED = 0.2  # share of a motion's variance that its harmonics may leave
AGREE = 0.05  # relative: columns of one motion, and what is declared of it
IMPURE = 0.05  # of the other velocity, primed, over the one of the motion
GRID = 2.0 * np.pi * np.arange(64) / 64


@dataclass(frozen=True, slots=True)
class _Motion:
    """Motion of one record: frequency, velocities as phasors (6, K + 1) over omega (t - t0), and the phase of the motion's own."""

    omega: float
    start: float
    velocity: harmonics.Phasors
    phase: float

    def theta(self, time: Array) -> Array:
        """Phase of the velocity at the samples."""
        return np.asarray(self.omega * (time - self.start) + self.phase)


def _checked_record(run: planar_motion.PlanarMotionRun, record: planar_motion.TimeSeries, orders: int) -> None:
    if len(record.time) < 3:
        raise run.fail(f"{len(record.time)} samples", "a record of one cycle and more", file=record.file)
    cycles = harmonics.cycles_of(run.omega * record.time)
    if cycles < 1.0 - harmonics.WHOLE:
        raise run.fail(
            f"a record of {cycles:.2g} cycles at {run.omega / (2.0 * np.pi):g} Hz",
            "at least one whole cycle",
            file=record.file,
        )
    samples = 2.0 * np.pi / (run.omega * float(np.max(np.diff(record.time))))
    least = max(LEAST_SAMPLES, 2 * orders + 2)
    if samples < least * (1.0 - 1e-9):
        raise run.fail(
            f"{samples:.1f} samples a cycle at the widest step", f"at least {least}", file=record.file, column="t",
            advice="Harmonics fold back into the fundamental: record more often.",
        )  # fmt: skip


def _motion(
    run: planar_motion.PlanarMotionRun, record: planar_motion.TimeSeries, gain: planar_motion.Filter, orders: int
) -> _Motion:
    """The motion of a record, from its columns or as the list of runs declares it."""
    _checked_record(run, record, orders)
    axis = MOTIONS.index(planar_motion.VARIABLES[run.motion])
    start, omega = float(record.time[0]), run.omega
    velocity = np.zeros((6, orders + 1), dtype=complex)
    flow = (np.cos(run.attack) * np.cos(run.drift), np.sin(run.drift), np.sin(run.attack) * np.cos(run.drift))
    velocity[:3, 0] = run.speed * np.array(flow)
    if not record.has_motion:
        if run.amplitude is None or run.phase is None:
            raise run.fail("no motion", "columns of the motion, or amplitude and phase")
        velocity[axis, 1] = run.amplitude * omega * np.exp(1j * (run.phase + omega * start))
        if run.motion in ("yaw", "pitch") and not run.drift and not run.attack:
            # The carriage keeps its speed, and the slope of a pure path is the angle.
            angle = run.amplitude * np.sin(GRID + run.phase + omega * start)
            velocity[0] = harmonics.regress(GRID, run.speed / np.cos(angle)[:, None], orders).phasors[0]
    else:
        omega = _frequency(run, record, orders)
        _from_columns(run, record, gain, omega, velocity)
    if not abs(velocity[axis, 1]) > 0.0:
        raise run.fail(
            f"no {planar_motion.VARIABLES[run.motion]} in {record.file.name}",
            f"columns of {run.motion}",
            file=record.file,
        )
    return _Motion(omega, start, velocity, float(np.angle(velocity[axis, 1])))


def _frequency(run: planar_motion.PlanarMotionRun, record: planar_motion.TimeSeries, orders: int) -> float:
    """The frequency of the motion's own column, refined from the declared one."""
    kinds = (record.displacements, record.velocities, record.accelerations)
    names = (
        planar_motion.DISPLACEMENTS[run.motion],
        planar_motion.VARIABLES[run.motion],
        planar_motion.VARIABLES[run.motion],
    )
    own = next(((n, k[n]) for n, k in zip(names, kinds, strict=True) if n in k), None)
    if own is None:
        raise run.fail(
            f"no column {names[0]} or {names[1]} for {run.motion}",
            f"{names[0]}, {names[1]} or {names[1]}dot",
            file=record.file,
        )
    name, values = own
    omega = harmonics.refined(record.time, values, run.omega, orders)
    left = float(harmonics.regress(omega * (record.time - record.time[0]), values[:, None], orders).unexplained[0])
    if left > UNEXPLAINED or abs(omega / run.omega - 1.0) > AGREE:
        declared = f"{run.omega / (2.0 * np.pi):.4g} Hz"
        found = (
            f"{omega / (2.0 * np.pi):.4g} Hz"
            if left <= UNEXPLAINED
            else f"{100.0 * (1.0 - left):.0f} % explained by {declared}"
        )
        raise run.fail(
            f"{found} in column {name}", f"the frequency of the list of runs, {declared}", file=record.file, column=name,
            advice="Look at frequency [Hz], which is no rad/s.",
        )  # fmt: skip
    return omega


def _from_columns(
    run: planar_motion.PlanarMotionRun,
    record: planar_motion.TimeSeries,
    gain: planar_motion.Filter,
    omega: float,
    velocity: harmonics.Phasors,
) -> None:
    """Fill in phasors (6, K + 1) of velocities; columns that contradict each other or the list of runs are refused."""
    orders = velocity.shape[1] - 1
    theta = omega * (record.time - record.time[0])
    undone = np.array([gain.gain(omega, k) if k else 1.0 for k in range(orders + 1)])

    def phasors(values: Array) -> harmonics.Phasors:
        return np.asarray(harmonics.regress(theta, values[:, None], orders).phasors[0] / undone)

    moved = {n: phasors(v) for n, v in record.displacements.items()}
    found: list[tuple[str, int, harmonics.Phasors]] = []
    for n, v in record.velocities.items():
        found.append((n, MOTIONS.index(n), phasors(v)))
    if moved:
        found += [("displacements", i, p) for i, p in _of_displacements(moved, run, omega, orders).items()]
    for n, v in record.accelerations.items():
        rate = phasors(v) / (1j * omega * np.maximum(np.arange(orders + 1), 1))
        rate[0] = velocity[MOTIONS.index(n), 0]
        found.append((f"{n}dot", MOTIONS.index(n), rate))
    own = MOTIONS.index(planar_motion.VARIABLES[run.motion])
    size = max(abs(p[1]) for _, i, p in found if i == own)
    first: dict[int, tuple[str, harmonics.Phasors]] = {}
    for name, i, p in found:
        if i not in first:
            velocity[i, 1:] = p[1:]
            if name != f"{MOTIONS[i]}dot":
                velocity[i, 0] = p[0]
            first[i] = name, p
        elif i == own and abs(p[1] - first[i][1][1]) > AGREE * size:
            ratio = p[1] / first[i][1][1]
            raise run.fail(
                f"{name} gives {abs(ratio):.3g} times the amplitude of {first[i][0]}, {np.degrees(np.angle(ratio)):+.3g} deg of phase",
                f"columns that agree on {MOTIONS[i]}", file=record.file, column=name,
            )  # fmt: skip
    declared = None if run.amplitude is None else run.amplitude * omega
    if declared is not None and abs(abs(velocity[own, 1]) / declared - 1.0) > AGREE:
        raise run.fail(
            f"an amplitude of {abs(velocity[own, 1]) / omega:.4g} in {record.file.name}",
            f"that of the list of runs, {run.amplitude:.4g}", column=planar_motion.DISPLACEMENTS[run.motion],
        )  # fmt: skip
    if run.phase is not None:
        turned = velocity[own, 1] * np.exp(-1j * (run.phase + omega * float(record.time[0])))
        if abs(np.angle(turned)) > 2.0 * AGREE:
            raise run.fail(
                f"a phase {np.degrees(np.angle(turned)):+.4g} deg from the declared one in {record.file.name}",
                f"{planar_motion.DISPLACEMENTS[run.motion]} = amplitude sin(2 pi f t + phase), or no phase", column="phase",
            )  # fmt: skip


def _of_displacements(
    moved: Mapping[str, harmonics.Phasors], run: planar_motion.PlanarMotionRun, omega: float, orders: int
) -> dict[int, harmonics.Phasors]:
    """Velocities of the body by index, from where it is and how it is turned on a carriage of constant speed.

    One angle turns at a time: v = ydot cos psi - U sin psi, w = zdot cos theta + U sin theta; r, q, p are the rates of the angles.
    """
    at = {n: harmonics.series(p[None], GRID)[:, 0] for n, p in moved.items()}
    rate = {n: harmonics.series(harmonics.derivative(p[None], omega), GRID)[:, 0] for n, p in moved.items()}
    out: dict[int, Array] = {}
    for name, offset, angle, sign, held in (("v", "y", "psi", -1.0, -run.drift), ("w", "z", "theta", 1.0, run.attack)):
        if offset in at or angle in at:
            a, across = at.get(angle, np.full_like(GRID, held)), rate.get(offset, np.zeros_like(GRID))
            out[MOTIONS.index(name)] = across * np.cos(a) + sign * run.speed * np.sin(a)
            out[0] = run.speed * np.cos(a) - sign * across * np.sin(a)
    for name, angle in (("p", "phi"), ("q", "theta"), ("r", "psi")):
        if angle in at:
            out[MOTIONS.index(name)] = rate[angle]
    return {i: harmonics.regress(GRID, values[:, None], orders).phasors[0] for i, values in out.items()}


def _pure(run: planar_motion.PlanarMotionRun, motion: _Motion, length: float) -> None:
    """Refuse a second velocity that oscillates: its coefficients would be counted in."""
    own = planar_motion.VARIABLES[run.motion]
    scale = {m: (length if m in "pqr" else 1.0) / run.speed for m in MOTIONS}
    size = scale[own] * abs(motion.velocity[MOTIONS.index(own), 1])
    for m in MOTIONS[1:]:
        other = scale[m] * abs(motion.velocity[MOTIONS.index(m), 1])
        if m != own and other > IMPURE * size:
            raise run.fail(
                f"{m}' of {other:.2g} beside {own}' of {size:.2g}", f"pure {run.motion} about the reference point",
                file=run.record.file, advice="In pure yaw the path's slope is the heading; the pivot is the reference point.",
            )  # fmt: skip


def _inertia(table: planar_motion.PlanarMotionTable, motion: _Motion) -> harmonics.Phasors:
    """(6, K + 1) phasors of M_RB nudot + C_RB(nu) nu, what holds the model on its path."""
    orders = motion.velocity.shape[1] - 1
    if table.inertia is None:
        return np.zeros((6, orders + 1), dtype=complex)
    model = table.inertia
    if model.inertia is None:
        raise InputError("no inertia", "Ix, Iy, Iz of the oscillating model", column="inertia.inertia")
    centre = model.centre_of_gravity - table.point
    tensor = np.diag(model.inertia) + parallel_axis(model.mass, centre)
    nu = harmonics.series(motion.velocity, GRID)
    rates = harmonics.series(harmonics.derivative(motion.velocity, motion.omega), GRID)
    held = rates @ rigid_body_inertia(model.mass, centre, tensor).T + rigid_body_force(model.mass, centre, tensor, nu)
    return harmonics.regress(GRID, held, orders).phasors


def _forces(
    table: planar_motion.PlanarMotionTable,
    record: planar_motion.TimeSeries,
    motion: _Motion,
    names: Sequence[str],
    orders: int,
) -> tuple[harmonics.Harmonics, harmonics.Phasors]:
    """Harmonics of the recorded forces over the phase of the velocity, and their phasors with the filter undone."""
    found = harmonics.regress(motion.theta(record.time), np.column_stack([record.forces[c] for c in names]), orders)
    gains = np.array([[table.filters[c].gain(motion.omega, k) if k else 1.0 for k in range(orders + 1)] for c in names])
    return found, found.phasors / gains


def oscillated(
    table: planar_motion.PlanarMotionTable, run: planar_motion.PlanarMotionRun, scaling: Scaling, orders: int
) -> tuple[dict[str, OscillatedForce], dict[str, tuple[float, float]], int]:
    """Every wanted component of one run; variances of damping and inertia by the cycles, and the degrees of freedom."""
    gain = table.filters.get("motion", planar_motion.Filter())
    motion = _motion(run, run.record, gain, orders)
    _pure(run, motion, scaling.length)
    names = [c for c in GIVES[run.motion] if c in run.record.forces]
    found, phasors = _forces(table, run.record, motion, names, orders)
    variance = found.covariance
    turn = np.exp(-1j * motion.phase * np.arange(orders + 1))
    if run.in_air is not None:
        air = _motion(run, run.in_air, gain, orders)
        if abs(air.omega / motion.omega - 1.0) > harmonics.SAME:
            raise run.fail(
                f"{air.omega / (2.0 * np.pi):.4g} Hz in air", f"the motion in water, {motion.omega / (2.0 * np.pi):.4g} Hz",
                file=run.in_air.file,
            )  # fmt: skip
        lacking = next((c for c in names if c not in run.in_air.forces), None)
        if lacking is not None:
            raise run.fail(f"no {lacking} in air", f"the forces of {run.record.file.name}", file=run.in_air.file)
        still, dry = _forces(table, run.in_air, air, names, orders)
        phasors, variance = phasors - dry, variance + still.covariance
    else:
        held = _inertia(table, motion) * turn
        phasors = phasors + held[[COMPONENTS.index(c) for c in names]]
    own = planar_motion.VARIABLES[run.motion]
    size = abs(motion.velocity[MOTIONS.index(own), 1])
    if table.restoring is not None and run.motion in ("roll", "pitch"):
        about = "K" if run.motion == "roll" else "M"
        if about in names:
            # The angle is size / omega sin(theta), whose phasor is -i size / omega; the recorded moment holds -C times it.
            phasors[names.index(about), 1] += -1j * table.restoring[about == "M"] * size / motion.omega
    amplitude = float(size) * (scaling.length if own in "pqr" else 1.0) / run.speed
    frequency = motion.omega * scaling.length / run.speed
    aside = motion.velocity[MOTIONS.index("w" if run.motion in ("heave", "pitch") else "v"), 0].real / run.speed
    forces, variances = {}, {}
    factor = float(t_factor(found.freedom)) if found.freedom else np.nan
    theta = motion.theta(run.record.time)
    for j, c in enumerate(names):
        unit = scaling.unit(c, table.conditions.density, run.speed)
        a, b = phasors[j, 1].real / unit, -phasors[j, 1].imag / unit
        by_cycles = float(np.trace(variance[j])) / 2.0 / (unit * abs(table.filters[c].gain(motion.omega))) ** 2
        error = np.sqrt(by_cycles)
        variances[c] = by_cycles / amplitude**2, by_cycles / (amplitude * frequency) ** 2
        forces[c] = OscillatedForce(
            label=run.label,
            amplitude=amplitude,
            frequency=frequency,
            cycles=found.cycles,
            drift=float(aside),
            damping=(float(a / amplitude), float(factor * error / amplitude)),
            inertia=(float(-b / (amplitude * frequency)), float(factor * error / (amplitude * frequency))),
            mean=float(phasors[j, 0].real / unit),
            sizes=np.abs(phasors[j, 1:]) / unit,
            theta=theta,
            measured=run.record.forces[c] / unit,
            fitted=harmonics.series(found.phasors[j : j + 1], theta)[:, 0] / unit,
            used=bool(abs(aside) <= harmonics.SAME),
        )
    return forces, variances, found.freedom
