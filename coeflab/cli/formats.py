"""``coeflab formats``: the kinds of plugins, the plugins, and the options of these."""

from __future__ import annotations

from typing import Any

from coeflab.cli import options, show
from coeflab.core.registry import Registry

EXAMPLE = "coeflab formats surface"


@options.worded
def command(*, name: str = "", json: bool = False) -> None:
    """List importers, fits, exporters, checks, with their options."""
    from coeflab.api.listing import chosen, listed, options_of

    found, broken = chosen(name)
    table = listed(found, broken, validations=not name)
    if json:
        ours = table.rows[len(found) : len(table.rows) - len(broken)]
        show.json_object({"plugins": [_as_object(registry, plugin) for registry, plugin in found] + [
            dict(zip(("kind", "name", "summary"), row, strict=True)) for row in ours
        ] + [{"kind": registry.kind, "name": plugin, "broken": reason} for registry, plugin, reason in broken]})  # fmt: skip
        return
    show.table(table)
    if name:
        for registry, plugin in found:
            show.table(options_of(registry, plugin))


def explain(kind: str, plugin: str) -> None:
    """Print the options of a plugin of a kind such as fits."""
    from coeflab.api.listing import options_of, registry_of

    show.table(options_of(registry_of(kind), plugin))


def _as_object(registry: Registry[Any], plugin: str) -> dict[str, Any]:
    from coeflab.api.listing import options_of

    rows = options_of(registry, plugin).rows
    options = [dict(zip(("name", "takes", "default", "meaning"), row, strict=True)) for row in rows]
    return {"kind": registry.kind, "name": plugin, "summary": registry.load(plugin).summary, "options": options}
