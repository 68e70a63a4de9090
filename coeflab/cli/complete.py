"""Values that a shell offers behind an argument: shipped names, plugins, words, and paths beside them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from coeflab.core.registry import registry_of

Offer = Callable[[str], list[str]]
DIRECTIONS = (("forward", "aft"), ("starboard", "port"), ("down", "up"))


def names(words: Iterable[str], begun: str) -> list[str]:
    """Words that begin so, in order."""
    return sorted(word for word in words if word.startswith(begun))


def or_paths(words: Iterable[str], begun: str) -> list[str]:
    """Names that fit, then files and folders; a folder with its stroke."""
    folder, _, start = begun.rpartition("/")
    place = Path(folder or ("/" if begun.startswith("/") else ".")).expanduser()
    ahead = begun[: len(begun) - len(start)]
    entries = [e for e in place.iterdir() if e.name.startswith(start)] if place.is_dir() else []
    found = [f"{ahead}{e.name}" + "/" * e.is_dir() for e in entries if start or not e.name.startswith(".")]
    return [*names(words, begun), *sorted(found)]


def plugins(kind: str, begun: str) -> list[str]:
    """Plugins of a kind that begin so."""
    return names(registry_of(kind).usable(), begun)


def shipped_with(kind: str, file: str) -> list[str]:
    """Shipped folders of a kind that have the file."""
    from coeflab.core.files import shipped

    return [place.parent.name for place in shipped(kind).glob(f"*/{file}")]


def validations(incomplete: str) -> list[str]:
    """Shipped studies and publications."""
    from coeflab.api.validations import validations as shipped_ones

    return names(shipped_ones(), incomplete)


def studies(incomplete: str) -> list[str]:
    """The same, and plans by path."""
    from coeflab.api.validations import validations as shipped_ones

    return or_paths(shipped_ones(), incomplete)


def folders(incomplete: str) -> list[str]:
    """Folders."""
    return [path for path in or_paths((), incomplete) if path.endswith("/")]


def plans(incomplete: str) -> list[str]:
    """Shipped plans, and paths."""
    return or_paths(shipped_with("cfd_data", "plan.toml"), incomplete)


def parameters(incomplete: str) -> list[str]:
    """Shipped parameter files, and paths."""
    from coeflab.core.files import by_name

    return or_paths(tuple(by_name("*.parameters.json")), incomplete)


def campaigns(incomplete: str) -> list[str]:
    """Shipped campaigns, and paths."""
    return or_paths(shipped_with("cfd_data", "campaign.toml"), incomplete)


def bodies(incomplete: str) -> list[str]:
    """Shipped bodies, and paths."""
    return or_paths(shipped_with("geometry", "body.toml"), incomplete)


def inspected(incomplete: str) -> list[str]:
    """Shipped campaigns and bodies, and paths."""
    shipped_ones = (*shipped_with("cfd_data", "campaign.toml"), *shipped_with("geometry", "body.toml"))
    return or_paths(shipped_ones, incomplete)


def _plugins(kind: str) -> Offer:
    def offered(incomplete: str) -> list[str]:
        return plugins(kind, incomplete)

    return offered


fits, importers, exporters, manoeuvres, simulators = map(
    _plugins, ("fits", "importers", "exporters", "manoeuvres", "simulators")
)


def methods(incomplete: str) -> list[str]:
    """Methods of added mass."""
    return [*names(("all", "strip:lamb"), incomplete), *plugins("added_mass", incomplete)]


def reports(incomplete: str) -> list[str]:
    """Formats of a report; behind a comma another."""
    ahead, comma, last = incomplete.rpartition(",")
    return [f"{ahead}{comma}{name}" for name in plugins("reporting", last)]


def formats(incomplete: str) -> list[str]:
    """Kinds of plugins, and plugins."""
    from coeflab.core.registry import registries

    kinds = [registry.package.rpartition(".")[2] for registry in registries()]
    return names({*kinds, *(name for registry in registries() for name in registry.usable())}, incomplete)


def accelerations(incomplete: str) -> list[str]:
    """Where coefficients of acceleration come from."""
    from coeflab.api.names import ACCELERATIONS

    return names(ACCELERATIONS, incomplete)


def axes(incomplete: str) -> list[str]:
    """Axes of a mesh file; behind a comma directions that are left."""
    ahead, comma, last = incomplete.rpartition(",")
    taken = set(ahead.split(","))
    left = [word for pair in DIRECTIONS if not taken & set(pair) for word in pair]
    words = left if comma else ("FRD", "FLU", "CFD", *left)
    return [f"{ahead}{comma}{word}" for word in names(words, last)]


def symbols(incomplete: str) -> list[str]:
    """Derivatives of forces and moments by velocities, rates and control angles, without primes."""
    from coeflab.api.names import slopes

    return names(slopes(), incomplete)


def options_of(kind: str, name: str, begun: str) -> list[tuple[str, str]]:
    """Options of a plugin as they are typed, with their meaning; none where no plugin has that name.

    Parameters
    ----------
    kind : str
        Of the plugin.
    name : str
        Of the plugin.
    begun : str
        What stands on the command line, from ``--`` on.
    """
    from coeflab.core.options import described

    plugins = registry_of(kind)
    if name not in plugins.names():
        return []
    of_plugin = described(plugins.load(name).Options)
    typed = {f"--{o.name.replace('_', '-')}": o.meaning for o in of_plugin}
    return [(option, typed[option]) for option in names(typed, begun)]


def _words(*words: str) -> Offer:
    def offered(incomplete: str) -> list[str]:
        return names(words, incomplete)

    return offered


planes, tables = _words("horizontal", "vertical"), _words("csv", "parquet")
integrators, kernels = _words("adaptive", "rk4"), _words("auto", "compiled", "numpy")
units, optimizers = _words("m", "cm", "mm", "in", "ft"), _words("stlsq", "sr3")
