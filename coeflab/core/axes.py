"""Body axes in which tables come, and their rotation to FRD (x forward, y starboard, z down)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import AxesError, shown

DIRECTIONS = {
    "forward": (1.0, 0.0, 0.0),
    "aft": (-1.0, 0.0, 0.0),
    "starboard": (0.0, 1.0, 0.0),
    "port": (0.0, -1.0, 0.0),
    "down": (0.0, 0.0, 1.0),
    "up": (0.0, 0.0, -1.0),
}
FRAMES = {
    "FRD": ("forward", "starboard", "down"),
    "FLU": ("forward", "port", "up"),
    "CFD": ("aft", "starboard", "up"),
}
ANGLE_SIGNS = {
    "beta": {"v = +U sin(beta)": 1.0, "v = -U sin(beta)": -1.0},
    "alpha": {"w = +U sin(alpha)": 1.0, "w = -U sin(alpha)": -1.0},
}


@dataclass(frozen=True, slots=True)
class Axes:
    """Right-handed body axes.

    Attributes
    ----------
    directions : tuple of str
        Where x, y and z point.
    """

    directions: tuple[str, str, str]

    @property
    def rotation(self) -> NDArray[np.float64]:
        """(3, 3) matrix that turns components in these axes into FRD components."""
        return np.array([DIRECTIONS[d] for d in self.directions]).T

    @property
    def name(self) -> str:
        """FRD, FLU or CFD, else the three directions."""
        named = {directions: name for name, directions in FRAMES.items()}
        return named.get(self.directions, ", ".join(f"{a} {d}" for a, d in zip("xyz", self.directions, strict=True)))


def parse_axes(declared: Any, file: str | Path | None = None, key: str = "axes.frame") -> Axes:
    """Read an axes declaration: ``"FRD"``, ``"FLU"``, ``"CFD"`` or three directions.

    Parameters
    ----------
    declared : object
        As TOML gave it.
    file : path, optional
    key : str
        Both for the error.

    Raises
    ------
    AxesError
        Unknown frame, directions that do not span space, or a left-handed triad.
    """
    expected = '"FRD", "FLU", "CFD" (x aft, y starboard, z up) or three directions like ["forward", "port", "up"]'
    if isinstance(declared, str) and declared in FRAMES:
        directions = FRAMES[declared]
    elif isinstance(declared, list) and len(declared) == 3 and all(d in DIRECTIONS for d in declared):
        directions = (declared[0], declared[1], declared[2])
    else:
        found = "nothing" if declared is None else shown(declared)
        raise AxesError(found, expected, file=file, column=key)
    axes = Axes(directions)
    determinant = round(float(np.linalg.det(axes.rotation)))
    if determinant == 0:
        raise AxesError(shown(declared), "three directions at right angles", file=file, column=key)
    if determinant < 0:
        likely = ", ".join(FRAMES["FLU"])
        raise AxesError(
            f"left-handed axes (x {directions[0]}, y {directions[1]}, z {directions[2]})",
            "a right-handed triad",
            file=file,
            column=key,
            advice=f"Papers that print this usually mean FLU ({likely}): check one force of known sign, then declare it.",
        )
    return axes


def angle_sign(name: str, declared: Any, file: str | Path | None = None) -> float:
    """Sign of v (starboard) for beta, of w (down) for alpha, from the declaration in words.

    Parameters
    ----------
    name : {"alpha", "beta"}
    declared : object
        As TOML gave it.
    file : path, optional
        For the error.

    Raises
    ------
    AxesError
        Nothing or something else than one of the two formulas was declared.
    """
    allowed = ANGLE_SIGNS[name]
    text = " ".join(str(declared).split()) if declared is not None else None
    if text not in allowed:
        raise AxesError(
            "no declared sign" if declared is None else shown(declared),
            " or ".join(f'"{formula}"' for formula in allowed),
            file=file,
            column=f"axes.{name}",
            advice=f"{name} has two signs in the literature; say which one this table uses "
            "(v to starboard, w down, whatever the table's own axes are).",
        )
    return allowed[text]
