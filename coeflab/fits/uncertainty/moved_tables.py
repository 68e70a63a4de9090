"""The tables that a campaign would have given, had an input been off by an error that all its points share.

An error d says that true angles are the set ones plus d, that true speed, rates, forces, moments, density and length are
1 + d times those stated, and that moments and velocities refer to a point d ahead of the stated one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.types import Array, dataclass
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import ANGULAR, FORCES, LINEAR, MOMENTS
from coeflab.law.transforms import force_transfer, incidence
from coeflab.tables.force_table import ForceTable
from coeflab.tables.input_uncertainty import NAMES, InputUncertainty

SET_ANGLES = {"alpha": "alpha", "w": "alpha", "beta": "beta", "v": "beta", "dr": "dr", "ds": "ds", "db": "db"}


@dataclass(frozen=True, slots=True)
class UncertainInput:
    """One input that is uncertain.

    Attributes
    ----------
    kind : str
        A field of `InputUncertainty`.
    half_width : float
        95 %: rad, m or relative.
    angle : str
        ``alpha``, ``beta`` or a control; empty unless ``kind`` is ``angle``.
    campaign : str
        Whose tables it moves; empty where it moves them all.
    """

    kind: str
    half_width: float
    angle: str = ""
    campaign: str = ""

    @property
    def name(self) -> str:
        """``force``, ``angle beta``, ``speed of suboff_roddy_2``."""
        own = f"{self.kind.replace('_', ' ')} {self.angle}".rstrip()
        return f"{own} of {self.campaign}" if self.campaign else own


def uncertain_inputs(tables: Sequence[ForceTable], variables: Sequence[str]) -> tuple[UncertainInput, ...]:
    """What the campaigns of some tables declare, the angles one by one as each is set by itself.

    Parameters
    ----------
    tables : sequence of ForceTable
    variables : sequence of str
        Those of the fitted models; only their angles are moved.

    Notes
    -----
    All campaigns of a fit share the length of the primes: the largest of their half-widths is taken for it.
    """
    campaigns: dict[str, InputUncertainty] = {t.campaign: t.uncertainty for t in tables if t.uncertainty is not None}
    several = len({t.campaign for t in tables}) > 1
    lengths = [d.length for d in campaigns.values() if d.length is not None]
    angles = tuple(dict.fromkeys(SET_ANGLES[v] for v in variables if v in SET_ANGLES))
    out: dict[UncertainInput, None] = {}
    for campaign, declared in campaigns.items():
        for kind in NAMES:
            half = max(lengths, default=None) if kind == "length" else getattr(declared, kind)
            if half is None:
                continue
            owner = campaign if several and kind != "length" else ""
            for angle in angles if kind == "angle" else ("",):
                out[UncertainInput(kind, half, angle, owner)] = None
    return tuple(out)


def moved(
    tables: Sequence[ForceTable], scaling: Scaling, inputs: Sequence[UncertainInput], errors: Array
) -> tuple[list[ForceTable], Scaling]:
    """Tables and length with every input off by its error, errors of shape (k,)."""
    length = scaling.length
    for given, error in zip(inputs, errors, strict=True):
        if given.kind == "length":
            length *= 1.0 + float(error)
    out = []
    for table in tables:
        acting = {
            (i.kind, i.angle): float(e)
            for i, e in zip(inputs, errors, strict=True)
            if not i.campaign or i.campaign == table.campaign
        }
        out.append(_moved(table, acting))
    return out, replace(scaling, length=length)


def _moved(table: ForceTable, errors: Mapping[tuple[str, str], float]) -> ForceTable:
    def factor(kind: str) -> float:
        return 1.0 + errors.get((kind, ""), 0.0)

    ahead = errors.get(("reference_point", ""), 0.0)
    if ahead:
        stated = table.reference_point
        true = replace(table, reference_point=stated + np.array([ahead, 0.0, 0.0]))
        table = replace(true.about(stated), notes=table.notes)
    motion = dict(table.motion)
    if ("angle", "alpha") in errors or ("angle", "beta") in errors:
        motion |= _turned(table, errors.get(("angle", "alpha"), 0.0), errors.get(("angle", "beta"), 0.0))
    for names, kind in ((LINEAR, "speed"), (ANGULAR, "rate")):
        motion |= {m: motion[m] * factor(kind) for m in names}
    scale = dict.fromkeys(FORCES, factor("force")) | dict.fromkeys(MOMENTS, factor("moment"))
    forces = {c: f * scale[c] for c, f in table.forces.items()}
    if table.measured_about is not None:  # a calibration is of what the balance reads
        lever = force_transfer(table.reference_point - table.measured_about)[3:, :3] * (
            factor("force") - factor("moment")
        )
        for c, row in zip(MOMENTS, lever, strict=True):
            if c in forces:
                forces[c] = forces[c] + sum(table.forces[f] * k for f, k in zip(FORCES, row, strict=True) if k)
    return replace(
        table,
        motion=motion,
        controls={c: a + errors.get(("angle", c), 0.0) for c, a in table.controls.items()},
        speed=table.speed * factor("speed"),
        forces=forces,
        errors={c: e * scale[c] for c, e in table.errors.items()},
        conditions=replace(table.conditions, density=table.conditions.density * factor("density")),
        density=None if table.density is None else table.density * factor("density"),
    )


def _turned(table: ForceTable, attack: float, drift: float) -> dict[str, Array]:
    """u, v, w at the same speed with both angles moved."""
    u, v, w = (np.asarray(table.motion[m]) for m in LINEAR)
    alpha, beta = incidence(u, v, w)
    speed = np.sqrt(u**2 + v**2 + w**2)
    alpha, beta = alpha + attack, beta + drift
    return {
        "u": speed * np.cos(alpha) * np.cos(beta),
        "v": speed * np.sin(beta),
        "w": speed * np.sin(alpha) * np.cos(beta),
    }
