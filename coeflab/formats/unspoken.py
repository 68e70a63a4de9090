"""What a parameter file says nothing of, in words: force components without a law, and what a simulation needs besides forces."""

from __future__ import annotations

from coeflab.core.wording import listed
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.vehicle.force_law import force_law, sources_of
from coeflab.vehicle.parameter_file import ParameterFile


def without_law(parameters: ParameterFile) -> tuple[str, ...]:
    """The force components that no source speaks of, and which motions are left, in one sentence; none where all have one.

    A fitted table speaks of its component; drag, side force and lift of X, Y and Z.
    """
    spoken = {t.component for t in force_law(parameters).terms if not t.variables or set(t.variables) & set(MOTIONS)}
    sources = sources_of(parameters)
    spoken |= {c for s in sources.tables for c in sources.components(s)}
    silent = [c for c in COMPONENTS if c not in spoken]
    if not silent:
        return ()
    if silent == ["X"]:
        return ("no law for X: nothing resists u; keep the speed constant",)
    moving = [m for m, c in zip(MOTIONS, COMPONENTS, strict=True) if c not in silent]
    still = [m for m, c in zip(MOTIONS, COMPONENTS, strict=True) if c in silent and m != "u"]
    speed = " at a constant u" if "X" in silent else ""
    if not moving:
        return (f"no law for {', '.join(silent)}: the file has no force of the water",)
    return (f"no law for {', '.join(silent)}: only {listed(moving)} may move{speed}; hold {listed(still)}",)


def unstated(parameters: ParameterFile, names: dict[str, str] | None = None) -> tuple[str, ...]:
    """The keys that a simulation in six degrees of freedom needs and the file lacks, in one sentence; none where it has all.

    Parameters
    ----------
    parameters : ParameterFile
    names : dict of str to str, optional
        What an export calls each key, in brackets behind it.
    """
    mass = parameters.mass
    lacking = {
        "mass": mass is None,
        "mass.centre": mass is not None and mass.centre is None,
        "mass.inertia_matrix": mass is None or mass.inertia_matrix is None,
        "hydrostatics": parameters.hydrostatics is None,
    }
    said = [
        f"{key} ({names[key]})" if names and key in names else key for key, is_lacking in lacking.items() if is_lacking
    ]
    return (f"for a simulation in six degrees of freedom the file lacks {listed(said)}",) if said else ()
