"""Added mass of a body by every method."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from coeflab.added_mass import ADDED_MASS
from coeflab.core.errors import InputError
from coeflab.core.machine import one_thread
from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body
from coeflab.model.study import PlannedParameterFile
from coeflab.model.triangulation import Triangulation
from coeflab.workbench.reading import read_body

DENSEST = 1e5
FILE = "body.toml"


def methods() -> tuple[str, ...]:
    """Every method with its presets: ``strip`` and ``strip:lamb``."""
    out = []
    for name in ADDED_MASS.usable():
        out += [name, *(f"{name}:{preset}" for preset in getattr(ADDED_MASS.load(name), "presets", {}))]
    return tuple(out)


def hulls_of(
    groups: Sequence[PlannedParameterFile], density: float, progress: Callable[[str], None]
) -> dict[str, Triangulation]:
    """Added mass of the parameter files that name a hull, by file; a hull that several name is computed once.

    Parameters
    ----------
    groups : sequence of PlannedParameterFile
    density : float
        kg/m^3.
    progress : callable
        Takes what is being done, in words.
    """
    known: dict[tuple[Path, str], Triangulation] = {}
    out = {}
    for group in groups:
        if group.hull is None:
            continue
        key = (group.hull, group.method)
        if key not in known:
            body = read_body(group.hull / FILE if group.hull.is_dir() else group.hull)
            progress(f"added mass of {body.name}")
            known[key] = added_masses(body, density, group.method, reproducible=True)
        out[group.name] = known[key]
    return out


@one_thread()
def added_masses(
    body: Body,
    density: float,
    method: str = "all",
    given: Mapping[str, Any] | None = None,
    *,
    reproducible: bool = False,
) -> Triangulation:
    """Run one method, or all that apply.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.
    method : str
        ``all``, a plugin's name, or a name with a preset.
    given : mapping, optional
        Options of the one method.
    reproducible : bool
        Take the options of each plugin that give the same numbers with and without optional packages.

    Raises
    ------
    InputError
        Density not above zero, no shape, an unknown preset, or no method that applies.
    PluginError
        No plugin has that name.
    """
    if not 0.0 < density <= DENSEST:
        raise InputError(
            f"a density of {density:g} kg/m^3", f"a value above zero, at most {DENSEST:g}", column="density"
        )
    body.require_shape()
    if given and method == "all":
        raise InputError(f"options {', '.join(given)} for all methods", "one --method that they are for")
    results: list[AddedMass] = []
    refused: dict[str, str] = {}
    cited: dict[str, None] = {}
    for name in methods() if method == "all" else (method,):
        plugin_name, _, preset = name.partition(":")
        plugin: Any = ADDED_MASS.load(plugin_name)
        known = getattr(plugin, "presets", {})
        if preset and preset not in known:
            raise InputError(f'the unknown preset "{preset}" of {plugin_name}', f"one of {', '.join(known) or 'none'}")
        options = dict(getattr(plugin, "reproducible", {}) if reproducible else {})
        options |= {**(known[preset] if preset else {}), **(given or {})}
        try:
            found = plugin.added_mass(body, density, options) if options else plugin.added_mass(body, density)
        except InputError as why:
            if method != "all":
                raise
            if not preset:
                refused[name] = why.found
            continue
        results.append(found)
        cited |= dict.fromkeys(plugin.citations)
    if not results:
        raise InputError(f"no method that applies to {body.name}", f"a body for one of {', '.join(methods())}")
    return Triangulation(body, density, tuple(results), refused, tuple(cited))
