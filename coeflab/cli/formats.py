"""``coeflab formats``: the kinds of plugins, the plugins, and the options of these."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.core.registry import Registry
    from coeflab.core.table import Table


EXAMPLE = "coeflab formats surface"


@options.worded
def command(*, name: str = "", json: bool = False) -> None:
    """List importers, fits, exporters, checks, with their options."""
    from coeflab.core.table import Table

    found, broken = _chosen(name)
    rows = [(registry.kind, plugin, registry.load(plugin).summary) for registry, plugin in found]
    if not name:
        from coeflab.api.validations import validations

        rows += [("validation", v, f"coeflab validate {v}") for v in validations()]
    ours = len(rows)
    rows += [(registry.kind, plugin, f"broken: {reason}") for registry, plugin, reason in broken]
    if json:
        show.json_object({"plugins": [_as_object(registry, plugin) for registry, plugin in found] + [
            dict(zip(("kind", "name", "summary"), row, strict=True)) for row in rows[len(found):ours]
        ] + [{"kind": registry.kind, "name": plugin, "broken": reason} for registry, plugin, reason in broken]})  # fmt: skip
        return
    notes = () if name else ("`coeflab formats NAME` explains the options of a plugin, or of a kind such as fits.",)
    show.table(Table("Formats", ("kind", "name", "what"), tuple(rows), notes, frozenset({0, 1, 2})))
    if name:
        for registry, plugin in found:
            show.table(options_of(registry, plugin))


def explain(kind: str, plugin: str) -> None:
    """Print the options of a plugin of a kind such as fits."""
    from coeflab.core.registry import registry_of

    show.table(options_of(registry_of(kind), plugin))


def options_of(registry: Registry[Any], plugin: str) -> Table:
    """Every option of a plugin: what it takes, its default, what it means. No rows where it has none."""
    from coeflab.core.declarations import Declaration
    from coeflab.core.options import described
    from coeflab.core.table import Table

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


def _as_object(registry: Registry[Any], plugin: str) -> dict[str, Any]:
    rows = options_of(registry, plugin).rows
    options = [dict(zip(("name", "takes", "default", "meaning"), row, strict=True)) for row in rows]
    return {"kind": registry.kind, "name": plugin, "summary": registry.load(plugin).summary, "options": options}


def _chosen(name: str) -> tuple[list[tuple[Registry[Any], str]], list[tuple[Registry[Any], str, str]]]:
    """Every plugin, those of one kind, or those of one name; and beside them those that cannot be used, with the reason.

    Raises
    ------
    InputError
        Neither a kind nor a plugin has that name.
    """
    import difflib

    from coeflab.core.errors import InputError, shown
    from coeflab.core.registry import registries

    every = [(registry, plugin) for registry in registries() for plugin in registry.usable()]
    useless = [(registry, plugin, why) for registry in registries() for plugin, why in registry.unusable()]
    kinds = [registry.package.rpartition(".")[2] for registry in registries()]
    out = [(r, p) for r, p in every if not name or name in (p, r.package.rpartition(".")[2])]
    broken = [(r, p, why) for r, p, why in useless if not name or name in (p, r.package.rpartition(".")[2])]
    if not out and not broken and name not in kinds:
        near = difflib.get_close_matches(name, [*kinds, *(p for _, p in every)], n=1)
        hint = f"Did you mean {near[0]}? " if near else ""
        raise InputError(
            shown(name), f"a plugin, or one of {', '.join(kinds)}", advice=f"{hint}`coeflab formats` lists all."
        )
    return out, broken
