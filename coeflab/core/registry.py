"""Rooms of plugins: one file each, listed without importing, imported on use."""

from __future__ import annotations

import difflib
import importlib
import inspect
import pkgutil
from functools import cached_property
from importlib.metadata import entry_points
from typing import Any, Generic, TypeVar

from coeflab.core.errors import PluginError, shown

Port = TypeVar("Port")


class Registry(Generic[Port]):
    """The plugins of one room.

    A plugin is a module; its file's name is its name. Packages outside coeflab add theirs through an entry point in
    the group that is named like the room (``coeflab.fits``).

    Parameters
    ----------
    package : str
        Dotted name of the room.
    kind : str
        What a plugin of this room is called in messages.
    port : type
        The runtime-checkable protocol that a plugin keeps.
    """

    def __init__(self, package: str, kind: str, port: type[Port]) -> None:
        self.package, self.kind, self._port = package, kind, port

    @cached_property
    def _outside(self) -> dict[str, Any]:
        """Looked up once: the metadata of every installed package is read for it."""
        return {point.name: point for point in entry_points(group=self.package)}

    def names(self) -> tuple[str, ...]:
        """Names of all plugins of the room, sorted; nothing is imported."""
        room = importlib.import_module(self.package)
        own = {module.name for module in pkgutil.iter_modules(room.__path__) if not module.name.startswith("_")}
        return tuple(sorted(own | set(self._outside)))

    def load(self, name: str) -> Port:
        """Import one plugin.

        Raises
        ------
        PluginError
            No plugin has that name (near names are suggested), or the plugin lacks part of its protocol.
        """
        if name not in self.names():
            near = difflib.get_close_matches(name, self.names(), n=3)
            hint = f"did you mean {' or '.join(near)}? " if near else ""
            known = ", ".join(self.names()) or "none in this release"
            raise PluginError(f"no {self.kind} is called {shown(name)}: {hint}Known: {known}.")
        point = self._outside.get(name)
        plugin = point.load() if point is not None else importlib.import_module(f"{self.package}.{name}")
        if not isinstance(plugin, self._port):
            missing = [a for a in _members(self._port) if not hasattr(plugin, a)]
            raise PluginError(f"the {self.kind} {shown(name)} lacks {', '.join(missing)}.")
        return plugin


def _members(port: type) -> list[str]:
    protocols = [c for c in port.__mro__ if getattr(c, "_is_protocol", False) and c.__module__ != "typing"]
    names = {n for c in protocols for n in (*inspect.get_annotations(c), *vars(c))}
    return sorted(n for n in names if not n.startswith("_"))
