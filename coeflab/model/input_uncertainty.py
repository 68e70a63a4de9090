"""What a campaign declares about the uncertainty of its inputs."""

from __future__ import annotations

from dataclasses import dataclass, fields

from coeflab.core.toml import Section

SECTION = "uncertainty"
# Beyond these an input is a mistyped unit (per cent for a share, degrees for radians) or no measurement.
LARGEST_RELATIVE = 0.5
LARGEST_ANGLE = 0.0873  # 5 deg


@dataclass(frozen=True, slots=True)
class InputUncertainty:
    """95 % half-widths of errors that all points of a campaign share; None where nothing was declared.

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

    angle: float | None = None
    rate: float | None = None
    speed: float | None = None
    force: float | None = None
    moment: float | None = None
    reference_point: float | None = None
    length: float | None = None
    density: float | None = None

    @property
    def declared(self) -> tuple[str, ...]:
        """Names of the inputs with a half-width."""
        return tuple(n for n in NAMES if getattr(self, n) is not None)


NAMES = tuple(f.name for f in fields(InputUncertainty))
DIMENSIONS = {"angle": "angle", "reference_point": "length"}


def read_input_uncertainty(section: Section) -> InputUncertainty | None:
    """Read ``[uncertainty]`` of a campaign.toml: 95 % half-widths in SI or as texts with a unit (``"0.1 deg"``).

    Returns
    -------
    InputUncertainty or None
        None where the section is absent or empty: not assessed, which is not zero.

    Raises
    ------
    InputError
        An unknown key, a half-width that is not above zero, or a relative one above one half.
    """
    if not section.content:
        return None
    found: dict[str, float] = {}
    for name in NAMES:
        section.raw(name)
    for name in NAMES:
        dimension = DIMENSIONS.get(name, "none")
        value = section.optional_quantity(name, dimension)
        if value is None:
            continue
        if not value > 0.0:
            raise section.fail(
                name, f"{value:g}", "a 95 % half-width above zero", "Leave the key out where it was not assessed."
            )
        if name == "angle" and value > LARGEST_ANGLE:
            raise section.fail(
                name, f"{value:g} rad", "a half-width up to 5 deg", 'A bare number is in rad; write "0.1 deg".'
            )  # fmt: skip
        if dimension == "none" and value > LARGEST_RELATIVE:
            raise section.fail(
                name, f"{value:g}", "a relative half-width up to 0.5", "One per cent is 0.01."
            )  # fmt: skip
        found[name] = value
    section.finish()
    return InputUncertainty(**found)
