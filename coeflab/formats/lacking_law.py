"""What a parameter file says nothing of, in words: force components without a law, and what a simulation needs besides forces."""

from __future__ import annotations

from coeflab.core.texts import remark
from coeflab.core.wording import listed, one_line
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.vehicle.force_law import force_law, sources_of
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.sources import name_of


def without_law(parameters: ParameterFile) -> tuple[str, ...]:
    """The force components that no source speaks of, and which motions are left, in one sentence; none where all have one.

    A fitted table speaks of its component; drag, side force and lift of X, Y and Z.
    """
    spoken = {t.component for t in force_law(parameters).terms if not t.variables or set(t.variables) & set(MOTIONS)}
    sources = sources_of(parameters)
    spoken |= {c for s in sources.tables for c in s.components}
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


def in_header(parameters: ParameterFile, *, tables: bool = False) -> tuple[str, ...]:
    """What the head of every exported file says: components without a law, tables of the law that are not in the file, and what
    was found of the numbers, each in one line.

    Parameters
    ----------
    parameters : ParameterFile
    tables : bool
        Whether the file holds the tables.
    """
    lacking = () if tables else lacking_tables(parameters)
    return (*without_law(parameters), *lacking, *found_in(parameters))


def lacking_tables(parameters: ParameterFile) -> tuple[str, ...]:
    """The tables of the law, which no simulator's file holds, in one sentence; none where there are none."""
    tables = [name_of(s.model) for s in sources_of(parameters).tables]
    return (f"not in this file, and no force in its place: {listed(tables)}",) if tables else ()


def found_in(parameters: ParameterFile) -> tuple[str, ...]:
    """The findings of a parameter file in words, each in one line."""
    return tuple(one_line(remark(f)).removesuffix(".") for f in parameters.findings)


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
    words = [
        f"{key} ({names[key]})" if names and key in names else key for key, is_lacking in lacking.items() if is_lacking
    ]
    return (f"for a simulation in six degrees of freedom the file lacks {listed(words)}",) if words else ()
