"""`plugins`: the kinds of plugins, the plugins, and the options of these."""

from __future__ import annotations

import difflib
from typing import Any

from coeflab.core.declarations import Declaration
from coeflab.core.errors import shown
from coeflab.core.options import described
from coeflab.core.registry import Registry, registries, registry_of
from coeflab.core.table import Table
from coeflab.core.texts import input_error

__all__ = ["chosen", "listed", "options_of", "plugins", "registry_of"]


def plugins(name: str = "") -> Table:
    """Fits, exporters, simulators, manoeuvres, importers and all other plugins, or what one of them takes.

    Parameters
    ----------
    name : str
        A kind, ``"fits"``; a plugin, ``"slope_at_origin"``, whose options are those of the verb that takes its name.

    Raises
    ------
    InputError
        Neither a kind nor a plugin has that name.

    Examples
    --------
    >>> import coeflab as cf
    >>> [row[1] for row in cf.plugins("fits").rows if "slope" in row[1]]
    ['slope_at_origin']
    >>> [row[0] for row in cf.plugins("slope_at_origin").rows][0]
    'largest_angle'
    """
    found, broken = chosen(name)
    if len(found) == 1 and not broken and name == found[0][1]:
        return options_of(*found[0])
    return listed(found, broken, validations=not name)


def listed(
    found: list[tuple[Registry[Any], str]], broken: list[tuple[Registry[Any], str, str]], *, validations: bool
) -> Table:
    """A row a plugin: kind, name, what it does; those that cannot be used with the reason.

    Parameters
    ----------
    found, broken : lists
        As `chosen` has them.
    validations : bool
        Those of ``coeflab validate`` too.
    """
    rows = [(registry.kind, plugin, registry.load(plugin).summary) for registry, plugin in found]
    if validations:
        from coeflab.api.validations import validations as every

        rows += [("validation", v, f"coeflab validate {v}") for v in every()]
    rows += [(registry.kind, plugin, f"broken: {reason}") for registry, plugin, reason in broken]
    notes = (
        ("`coeflab formats NAME` explains the options of a plugin, or of a kind such as fits.",) if validations else ()
    )
    return Table("Formats", ("kind", "name", "what"), tuple(rows), notes, frozenset({0, 1, 2}))


def options_of(registry: Registry[Any], plugin: str) -> Table:
    """Every option of a plugin: what it takes, its default, what it means. No rows where it has none."""
    loaded = registry.load(plugin)
    declared = getattr(loaded, "options", None)
    kind = declared if isinstance(declared, type) and issubclass(declared, Declaration) else loaded.Options
    with registry.guarded(plugin, "has options that cannot be read"):
        rows = tuple((o.name, o.takes, o.default, o.meaning) for o in described(kind))
    notes = (
        f"On the command line: coeflab fit TABLE --fit {plugin} --{rows[0][0].replace('_', '-')} VALUE; in a plan: [table.options.{plugin}].",
    ) if rows and registry.package == "coeflab.fits" else ()  # fmt: skip
    if rows and kind is declared:
        section = registry.package.rpartition(".")[2].removeprefix("tow_").removesuffix("s")
        notes = (f"In tank.toml: [{section}.{plugin}].",)
    return Table(
        f"Options of {plugin}", ("option", "takes", "default", "meaning"), rows, notes, frozenset({0, 1, 2, 3})
    )


def chosen(name: str) -> tuple[list[tuple[Registry[Any], str]], list[tuple[Registry[Any], str, str]]]:
    """Every plugin, those of one kind, or those of one name; and beside them those that cannot be used, with the reason.

    Raises
    ------
    InputError
        Neither a kind nor a plugin has that name.
    """
    every = [(registry, plugin) for registry in registries() for plugin in registry.usable()]
    useless = [(registry, plugin, why) for registry in registries() for plugin, why in registry.unusable()]
    kinds = [registry.package.rpartition(".")[2] for registry in registries()]
    out = [(r, p) for r, p in every if not name or name in (p, r.package.rpartition(".")[2])]
    broken = [(r, p, why) for r, p, why in useless if not name or name in (p, r.package.rpartition(".")[2])]
    if not out and not broken and name not in kinds:
        near = difflib.get_close_matches(name, [*kinds, *(p for _, p in every)], n=1)
        hint = f"Did you mean {near[0]}? " if near else ""
        raise input_error("front_door.plugin_one", found=shown(name), kinds=", ".join(kinds), hint=hint)
    return out, broken
