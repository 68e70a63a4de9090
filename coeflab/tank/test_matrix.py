"""The test matrix: the conditions in which a body is towed, turned and steered."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType

import numpy as np

from coeflab.core.types import Array, brief, locked


class Kind(StrEnum):
    """What a condition is for."""

    STRAIGHT = "straight"
    DRIFT = "drift"
    ATTACK = "attack"
    ARM = "arm"
    COMBINED = "combined"
    CONTROL = "control"


class Half(StrEnum):
    """Which half of the body is in the domain; on the cut is a symmetry plane."""

    WHOLE = ""
    PORT = "y<0"
    UPPER = "z<0"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TowCondition:
    """One steady motion of the body through water at rest.

    Attributes
    ----------
    name : str
        Of its folder and its row: letters, digits, ``_ . + -``.
    kind : Kind
    velocity : (3,) array
        u, v, w of the reference point, m/s, FRD.
    rates : (3,) array
        p, q, r, rad/s, FRD.
    controls : mapping of str to float
        Angle of each control by its name (``dr``, ``ds``), rad; an absent one is at zero.
    half : Half
        What has to be computed of the body.
    grid : str
        Name of the grid, ``medium`` by default.
    variant : mapping of str to str
        What a study changes, by its name: ``domain``, ``turbulence``, ``iterations``; empty for the matrix itself.
    """

    name: str
    kind: Kind
    velocity: Array
    rates: Array
    controls: Mapping[str, float] = field(default_factory=dict)
    half: Half = Half.WHOLE
    grid: str = "medium"
    variant: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "velocity", locked(self.velocity))
        object.__setattr__(self, "rates", locked(self.rates))
        for name in ("controls", "variant"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @property
    def speed(self) -> float:
        """Of the reference point, m/s."""
        return float(np.linalg.norm(self.velocity))

    @property
    def turns(self) -> bool:
        """Whether the body is on a rotating arm."""
        return bool(np.any(self.rates))
