"""One body's added mass by every method."""

from __future__ import annotations

from typing import Any

from coeflab.added_mass import ADDED_MASS
from coeflab.core.errors import InputError
from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body
from coeflab.model.triangulation import Triangulation

DENSEST = 1e5


def methods() -> tuple[str, ...]:
    """Every method with its presets: ``strip`` and ``strip:lamb``."""
    out = []
    for name in ADDED_MASS.names():
        out += [name, *(f"{name}:{preset}" for preset in getattr(ADDED_MASS.load(name), "presets", {}))]
    return tuple(out)


def triangulate(body: Body, density: float, method: str = "all") -> Triangulation:
    """Run one method, or all that apply.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.
    method : str
        ``all``, a plugin's name, or a name with a preset.

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
    results: list[AddedMass] = []
    refused: dict[str, str] = {}
    cited: dict[str, None] = {}
    for name in methods() if method == "all" else (method,):
        plugin_name, _, preset = name.partition(":")
        plugin: Any = ADDED_MASS.load(plugin_name)
        known = getattr(plugin, "presets", {})
        if preset and preset not in known:
            raise InputError(f'the unknown preset "{preset}" of {plugin_name}', f"one of {', '.join(known) or 'none'}")
        try:
            found = plugin.added_mass(body, density, known[preset]) if preset else plugin.added_mass(body, density)
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
