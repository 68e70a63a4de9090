"""What a campaign declares about the uncertainty of its inputs."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Annotated, Any

from coeflab.core import declarations as takes

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema


# Beyond these an input is a mistyped unit (per cent for a share, degrees for radians) or no measurement.
LARGEST_RELATIVE = 0.5
LARGEST_ANGLE = 0.0873  # 5 deg
HALF_WIDTH = takes.Within(
    lambda v: "" if v > 0.0 else "a 95 % half-width above zero",
    "Leave the key out where it was not assessed.",
    {"exclusiveMinimum": 0},
)
NO_DEGREES = takes.Within(lambda v: "a half-width up to 5 deg" if v > LARGEST_ANGLE else "")
NO_PER_CENT = takes.Within(
    lambda v: "a relative half-width up to 0.5" if v > LARGEST_RELATIVE else "", "One per cent is 0.01."
)


class PerCent:
    """A text in per cent, such as ``"1 %"``, is that share; anything else stays."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(_share, handler(source))


def _share(value: Any) -> Any:
    given = re.fullmatch(r"\s*([-+]?(?:\d{1,9}\.?\d{0,9}|\.\d{1,9}))\s*%\s*", value) if isinstance(value, str) else None
    return value if given is None else float(given[1]) / 100.0


HalfAngle = Annotated[takes.Angle, HALF_WIDTH, NO_DEGREES]
Share = Annotated[takes.Pure, HALF_WIDTH, NO_PER_CENT, PerCent()]


@dataclass(frozen=True, slots=True)
class InputUncertainty(takes.Declaration):
    """95 % half-widths of errors that all points of a campaign share; what is left out was not assessed, which is not zero.

    Attributes
    ----------
    angle : float or None
        Offset of every set angle, rad.
    rate : float or None
        Of every set rate, relative.
    speed : float or None
        Relative.
    force, moment : float or None
        Calibration, relative.
    reference_point : float or None
        Of the point that moments and rates refer to, along x, m.
    length : float or None
        Of the length of the primes, relative.
    density : float or None
        Relative.
    """

    angle: HalfAngle | None = None
    rate: Share | None = None
    speed: Share | None = None
    force: Share | None = None
    moment: Share | None = None
    reference_point: Annotated[takes.Length, HALF_WIDTH] | None = None
    length: Share | None = None
    density: Share | None = None

    @property
    def declared(self) -> tuple[str, ...]:
        """Names of the inputs with a half-width."""
        return tuple(n for n in NAMES if getattr(self, n) is not None)


NAMES = tuple(f.name for f in fields(InputUncertainty))
