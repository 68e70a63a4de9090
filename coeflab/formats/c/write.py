"""C99 for the board: forces, accelerations and one step of a vehicle, no allocation, no library but libm.

Header, source, and a program that holds them against the file's own law. It compiles as C++17 too.
"""

from __future__ import annotations

from coeflab.formats.c_program.program import added_mass, force, render, steered_force
from coeflab.formats.exported_law import not_written, written_changes
from coeflab.formats.missing_parts import missing_mass, missing_water
from coeflab.vehicle.parameter_file import ParameterFile

__all__ = ["added_mass", "changes", "force", "missing", "render", "steered_force"]

summary = (
    "C99: header and source of forces, accelerations and one step, tables, thrusters and fins in them; no allocation"
)
citations = ("sname1950", "fossen2011")
adds_coriolis = False
holds = frozenset({"hydrostatics", "thrusters", "surfaces", "rates", "lags", "tables"})
not_held = not_written


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass, moments of inertia and added mass, where the file has none."""
    held = "motions without an inertia are held"
    return (*missing_mass(parameters, held, f"roll is held; {held}"), *missing_water(parameters))


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the law is written, in words."""
    return (
        *written_changes(parameters, "the source", "terms of their own", "its added mass"),
        "values are SI: primes times 1/2 rho L^k are multiplied in",
        "tables, thrusters and limits of fins are in it; a table that refuses gives NaN and the status 1",
    )
