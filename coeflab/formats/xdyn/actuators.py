"""Thrusters and limits of angles as expressions of xdyn's ``maneuvering`` model, of numbers, names and abs, sqrt, sin, cos alone.

A value between two limits is (low + high + |x - low| - |x - high|) / 2; a polynomial of it less its value at the low end, summed over the
segments of a curve, is the curve but for its steps, each a sign function. Numbers stand under names: xdyn's grammar has no sign before a
bracket.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from coeflab.core.text.yaml import number
from coeflab.core.wording import identifier
from coeflab.formats.coded_thrusters import limits
from coeflab.law.symbols import COMPONENTS, CONTROLS
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCurve, ParameterThruster

HAIR = 1e-9  # of the span of a curve's commands, by which a step lies beside its command, so that both ends count as in the file
TINY = 1e-300
INNER = "thruster_"  # what names of no command begin with


def limited(control: str) -> str:
    """What expressions call an angle that is held at its limit."""
    return f"{control}_held"


def held_lines(parameters: ParameterFile, controls: Sequence[str]) -> list[str]:
    """Angles at their limits, of the commands ``dr`` ..."""
    largest = limits(parameters)[0]
    return [
        line
        for c, most in largest.items()
        if c in controls
        for line in (f"{c}_limit: {most!r}", f"{limited(c)}: {_held(c)}")
    ]


def _held(control: str) -> str:
    return f"0.5*(abs({control} + {control}_limit) - abs({control} - {control}_limit))"


def read_limits(expressions: Mapping[str, str]) -> dict[str, float]:
    """Limits by control, where expressions hold an angle as `held_lines` writes it."""
    found = {c: number(expressions.get(f"{c}_limit")) for c in CONTROLS if expressions.get(limited(c)) == _held(c)}
    return {c: x for c, x in found.items() if x is not None and x > 0.0}


def command_names(parameters: ParameterFile) -> tuple[str, ...]:
    """Identifiers of the thrusters' commands, one each and apart."""
    out: list[str] = []
    for t in parameters.thrusters:
        name = identifier(
            t.name, {*COMPONENTS, *"uvwpqrtgL", "rho", "nu", "abs", "sqrt", "sin", "cos", "exp", "log", *out}
        )
        while name in out or name.endswith("_tilt") or name.startswith(INNER):
            name = f"T_{len(out) + 1}_{name}_"
        out.append(name)
    return tuple(out)


def thrust_lines(parameters: ParameterFile) -> tuple[list[str], list[str]]:
    """Commands, and the expressions of a model of all thrusters, about the reference point."""
    commands, lines = [], list[str]()
    sums: dict[str, list[str]] = {c: [] for c in COMPONENTS}
    for n, (t, command) in enumerate(zip(parameters.thrusters, command_names(parameters), strict=True)):
        name = f"{INNER}{n}"
        commands.append(command)
        lines += _curve(t.curve, command, f"{name}_thrust")
        parts = [_arm(t, np.array(v)) for v in _directions(t)]
        turns = [""]
        if t.tilt_axis is not None:
            commands.append(f"{command}_tilt")
            lines += [f"{name}_tilt_low: {t.tilt_low!r}", f"{name}_tilt_high: {t.tilt_high!r}"]
            lines.append(f"{name}_angle: {_between(f'{command}_tilt', f'{name}_tilt_low', f'{name}_tilt_high')}")
            turns = ["", f"*cos({name}_angle)", f"*sin({name}_angle)"]
        if t.torque_curve is not None:
            lines += _curve(t.torque_curve, command, f"{name}_torque")
        for k, (turn, arm) in enumerate(zip(turns, parts, strict=True)):
            for i, c in enumerate(COMPONENTS):
                if abs(arm[i]) > TINY:
                    lines.append(f"{name}_{c}{k}: {float(arm[i])!r}")
                    sums[c].append(f"{name}_{c}{k}*{name}_thrust{turn}")
            for i, c in enumerate("KMN"):
                along = t.handedness * arm[i]
                if t.torque_curve is not None and abs(along) > TINY:
                    lines.append(f"{name}_Q{c}{k}: {float(along)!r}")
                    sums[c].append(f"{name}_Q{c}{k}*{name}_torque{turn}")
    return commands, [*lines, *(f"{c}: {' + '.join(sums[c]) or '0'}" for c in COMPONENTS)]


def _directions(t: ParameterThruster) -> list[tuple[float, ...]]:
    """The direction, or what of it is constant, goes with the cosine and with the sine of the tilt (Rodrigues)."""
    if t.tilt_axis is None:
        return [t.direction]
    d, k = np.array(t.direction), np.array(t.tilt_axis)
    along = k * float(k @ d)
    return [tuple(v.tolist()) for v in (along, d - along, np.cross(k, d))]


def _arm(t: ParameterThruster, along: np.ndarray) -> np.ndarray:
    return np.concatenate([along, np.cross(np.array(t.position), along)])


def _between(x: str, low: str, high: str) -> str:
    return f"0.5*({low} + {high} + abs({x} - {low}) - abs({x} - {high}))"


def _curve(curve: ParameterCurve, command: str, name: str) -> list[str]:
    """A curve over a command as expressions, the last of them called ``name``."""
    hair = HAIR * (curve.high - curve.low)
    lines = [f"{name}_low: {curve.low!r}", f"{name}_high: {curve.high!r}", f"{name}_hair: {hair!r}"]
    lines.append(f"{name}_at: {_between(command, f'{name}_low', f'{name}_high')}")
    parts, steps, before, end = [], list[tuple[float, float]](), 0.0, curve.low
    first = curve.segments[0].at(curve.low)
    for k, s in enumerate(curve.segments):
        own = f"{name}_{k}"
        lines += [f"{own}_low: {s.low!r}", f"{own}_high: {s.high!r}"]
        lines.append(f"{own}_x: {_between(f'{name}_at', f'{own}_low', f'{own}_high')}")
        for power, c in enumerate(s.coefficients):
            if power and c:
                lines.append(f"{own}_c{power}: {c!r}")
                x = f"{own}_x" + (f"^{power}" if power > 1 else "")
                low = f"{own}_low" + (f"^{power}" if power > 1 else "")
                parts.append(f"{own}_c{power}*({x} - {low})")
        if k and s.low > end + hair and before:
            steps.append((end + hair, -before))
            before = 0.0
        if k and s.at(s.low) != before:
            steps.append((s.low + (hair if s.low <= end else -hair), s.at(s.low) - before))
        before, end = s.at(s.high), s.high
    lines.append(f"{name}_first: {first!r}")
    for k, (at, size) in enumerate(steps):
        own = f"{name}_step{k}"
        lines += [f"{own}_at: {at!r}", f"{own}_half: {size / 2.0!r}"]
        parts.append(f"{own}_half*(1 + ({name}_at - {own}_at)/(abs({name}_at - {own}_at) + 1e-9*{name}_hair))")
    lines.append(f"{name}: {' + '.join([f'{name}_first', *parts])}")
    return lines
