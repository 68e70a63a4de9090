"""Thrusters and limits of control angles, for programs in MATLAB and Python: plain rows of numbers, and lines of code."""

from __future__ import annotations

from coeflab.core.wording import one_line
from coeflab.law.symbols import CONTROLS
from coeflab.vehicle.parameter_file import ParameterFile

Rows = list[list[float]]


def coded_thrusters(parameters: ParameterFile) -> tuple[Rows, Rows]:
    """Rows of thrusters and of segments of their curves.

    A thruster: position, direction, tilt axis (zeros: fixed), lowest and highest tilt, handedness. A segment: its thruster from 1, 0 for
    thrust or 1 for torque, lowest and highest command, then the coefficients of the command's powers.
    """
    curves = [
        (k, i, c)
        for k, t in enumerate(parameters.thrusters, 1)
        for i, c in enumerate((t.curve, t.torque_curve))
        if c is not None
    ]
    width = max((len(s.coefficients) for _, _, c in curves for s in c.segments), default=0)
    segments = [
        [float(k), float(i), s.low, s.high, *s.coefficients, *[0.0] * (width - len(s.coefficients))]
        for k, i, c in curves
        for s in c.segments
    ]
    rows = [
        [*t.position, *t.direction, *(t.tilt_axis or (0.0, 0.0, 0.0)), t.tilt_low, t.tilt_high, float(t.handedness)]
        for t in parameters.thrusters
    ]
    return rows, segments


def command_names(parameters: ParameterFile) -> tuple[str, ...]:
    """What stands in the vector of commands, in its order: a command of each thruster, then a tilt of each."""
    names = [one_line(t.name) for t in parameters.thrusters]
    units = [one_line(f"{t.curve.command}, {t.curve.unit}") for t in parameters.thrusters]
    tilts = [f"tilt of {n} (rad)" for n in names] if any(t.tilt_axis for t in parameters.thrusters) else []
    return (*(f"{n} ({u})" for n, u in zip(names, units, strict=True)), *tilts)


def limits(parameters: ParameterFile) -> tuple[dict[str, float], dict[str, float]]:
    """Largest angle and rate by control, rad and rad/s, of those that the file states."""
    each = {s.control: s for s in parameters.surfaces}
    rates = {c: each[c].rate for c in CONTROLS if c in each}
    return {c: each[c].limit for c in CONTROLS if c in each}, {c: r for c, r in rates.items() if r is not None}


def read_angle(control: str, given: str, place: str, held: bool) -> str:
    """The angle of a control as an expression: what is given, not beyond the limit.

    Parameters
    ----------
    control : str
    given : str
        Such as ``delta(1)``.
    place : str
        In front of ``limit_dr``: ``h.`` or ``self.``.
    held : bool
        Whether the file states a limit.
    """
    limit = f"{place}limit_{control}"
    return f"max(-{limit}, min({limit}, {given}))" if held else given


def held_in_words(parameters: ParameterFile, command: str, *, rates: str) -> tuple[str, ...]:
    """How thrusters and limits stand in a program, in words.

    Parameters
    ----------
    parameters : ParameterFile
    command : str
        What the program calls the commands.
    rates : str
        What becomes of rates of angles.
    """
    out = []
    if parameters.thrusters:
        out.append(
            f"thrust of {command}: {', '.join(command_names(parameters))}; curve, dead zone, limits, tilt and torque are the file's"
        )
    largest, turning = limits(parameters)
    if largest:
        out.append(f"angles beyond {', '.join(f'{c} {x:g}' for c, x in largest.items())} rad are held there")
    if turning:
        out.append(f"rates of {', '.join(f'{c} {x:g}' for c, x in turning.items())} rad/s {rates}")
    return tuple(out)
