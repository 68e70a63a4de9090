"""A law held against the force model that it was made from, over motions: what its terms do not hold is a finding of its file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array, dataclass, locking
from coeflab.law.symbols import COMPONENTS, CONTROLS
from coeflab.vehicle.force_law import full_force
from coeflab.vehicle.parameter_file import ParameterFile

Model = Callable[[Array, dict[str, Array]], Array]
OF_A_MODEL = ("law.model", "law.model_met", "law.model_left")  # codes of its findings
ALLOWED = 0.05  # of the largest force of a component: what a law of few terms may leave out
NOTHING = 1e-5  # of 1/2 rho U^2 L^2, and of that times L: a tenth of the smallest coefficients that tests give


@dataclass(frozen=True, slots=True, eq=False)
@locking("nu controls")
class Motions:
    """States of a manoeuvre at which forces are compared.

    Attributes
    ----------
    name : str
    nu : (n, 6) array
        Velocities through the water at the reference point, FRD.
    controls : (n, 3) array
        dr, ds, db, rad.
    """

    name: str
    nu: Array
    controls: Array


def held_to_model(
    parameters: ParameterFile, model: Model, called: str, motions: Sequence[Motions]
) -> tuple[Finding, ...]:
    """How far the law of a file is from the force model that it was made from.

    Parameters
    ----------
    parameters : ParameterFile
    model : callable
        Forces (n, 6) of velocities (n, 6) and angles by name, about the file's reference point.
    called : str
        What the model is, for example ``estimates``.
    motions : sequence of Motions

    Returns
    -------
    tuple of Finding
        A warning for each component whose difference passes both `ALLOWED` of its largest force and the U95 of the law at that
        state; a note with the largest differences of the others.
    """
    warned: list[Finding] = []
    held: dict[str, float] = {}
    law = full_force(parameters)
    forces = [(model(np.array(m.nu), angles_of(m.controls)), law(m.nu, m.controls)) for m in motions]
    for m, (theirs, ours), u95 in zip(motions, forces, _u95_where_apart(parameters, motions, forces), strict=True):
        for i, component in enumerate(COMPONENTS):
            found = _compared(parameters, called, m, i, ours, theirs, u95)
            if found is not None and found.severity is Severity.WARN:
                warned.append(found)
            elif found is not None:
                held[component] = max(held.get(component, 0.0), float(found["share"]))
    names = tuple(m.name for m in motions)
    if held:
        shares = tuple(f"{c} {s:.1%}" for c, s in held.items())
        warned.append(
            Finding.of(
                "law.model_met", parameters.name, Severity.NOTE, statistic=max(held.values()), threshold=ALLOWED,
                model=called, manoeuvres=names, shares=shares,
            )
        )  # fmt: skip
    return tuple(warned)


def _u95_where_apart(
    parameters: ParameterFile, motions: Sequence[Motions], forces: Sequence[tuple[Array, Array]]
) -> list[Array]:
    """U95 (n, 6) of the law where it is further from the model than `ALLOWED` of the largest force; zero elsewhere."""
    far = [np.any(np.abs(a - b) > ALLOWED * np.max(np.abs(a), axis=0, initial=0.0), axis=1) for a, b in forces]
    out = [np.zeros((len(m.nu), 6)) for m in motions]
    if any(f.any() for f in far):
        nu = np.concatenate([m.nu[f] for m, f in zip(motions, far, strict=True)])
        controls = np.concatenate([m.controls[f] for m, f in zip(motions, far, strict=True)])
        parts = np.split(law_u95(parameters, nu, controls), np.cumsum([f.sum() for f in far])[:-1])
        for whole, rows, part in zip(out, far, parts, strict=True):
            whole[rows] = part
    return out


def angles_of(controls: Array) -> dict[str, Array]:
    """Angles by the name of their control, as force models take them."""
    return {name: np.array(controls[:, k]) for k, name in enumerate(CONTROLS)}


def law_u95(parameters: ParameterFile, nu: Array, controls: Array) -> Array:
    """U95 of X Y Z K M N of a law at states, (n, 6), by the covariance of its coefficients; zero of a file without one."""
    known = parameters.covariance
    of: Mapping[str, int] = {s.removesuffix("'"): k for k, s in enumerate(known.symbols)}
    base = full_force(parameters)(nu, controls)
    slopes, rows = [], []
    for k, c in enumerate(parameters.coefficients):
        at = of.get(c.symbol.removesuffix("'"))
        if c.value is None or at is None or not c.u95 or c.law == "rest":
            continue
        others = (
            *parameters.coefficients[:k],
            replace(c, value=c.value + c.u95, value_si=None),
            *parameters.coefficients[k + 1 :],
        )
        changed = full_force(parameters.model_copy(update={"coefficients": others}))(nu, controls)
        slopes.append((changed - base) / c.u95)
        rows.append(at)
    if not rows:
        return np.zeros_like(base)
    cells = [[known.matrix[i][j] or 0.0 for j in rows] for i in rows]
    variance = np.einsum("ani,ab,bni->ni", np.array(slopes), np.array(cells), np.array(slopes))
    return np.asarray(2.0 * np.sqrt(np.maximum(variance, 0.0)))


def _compared(
    parameters: ParameterFile, called: str, m: Motions, i: int, ours: Array, theirs: Array, u95: Array
) -> Finding | None:
    at = parameters.conditions
    speed = max(float(np.max(np.linalg.norm(m.nu[:, :3], axis=1))), at.speed)
    unit = parameters.scaling.unit(COMPONENTS[i], at.density, speed)
    largest = float(np.max(np.abs(theirs[:, i])))
    apart = np.abs(ours[:, i] - theirs[:, i])
    if max(largest, float(apart.max())) <= NOTHING * unit:
        return None
    beyond = apart - np.maximum(ALLOWED * largest, u95[:, i])
    worst = int(np.argmax(beyond if beyond.max() > 0.0 else apart))
    allowed = max(ALLOWED * largest, float(u95[worst, i]))
    u, v, w, p, q, r = (float(x) for x in m.nu[worst])
    return Finding.of(
        "law.model", f"{COMPONENTS[i]}, {m.name}", Severity.WARN if beyond[worst] > 0.0 else Severity.NOTE,
        statistic=float(apart[worst]), threshold=allowed, component=COMPONENTS[i], manoeuvre=m.name, model=called,
        unit="N" if i < 3 else "N m", law=float(ours[worst, i]), theirs=float(theirs[worst, i]), share=float(apart[worst]) / largest if largest else 1.0,
        drift=float(np.degrees(np.arctan2(v, u))), attack=float(np.degrees(np.arctan2(w, u))), p=p, q=q, r=r, speed=float(np.linalg.norm([u, v, w])),
        angles=tuple(float(np.degrees(x)) for x in m.controls[worst]),
    )  # fmt: skip
