"""Registries of plugins: one file each, listed without importing, imported on use; what others installed never breaks ours."""

from __future__ import annotations

import difflib
import importlib
import inspect
import logging
import pkgutil
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cached_property
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

from coeflab.core.applications import declared
from coeflab.core.errors import CoeflabError, PluginError, shown
from coeflab.core.options import NoOptions
from coeflab.core.text.bounded import own_text
from coeflab.core.version import VERSION

Port = TypeVar("Port")
OURS = f"coeflab {VERSION}"


def of_application(name: str, module: str) -> Any:
    """A module of an application, imported."""
    return importlib.import_module(f"coeflab.{name}.{module}")


class Registry(Generic[Port]):
    """The plugins of one kind.

    A plugin is a module; its file's name is its name. An application brings its own in a folder that it declares as
    ``PLUGINS``. Packages outside coeflab add theirs through an entry point in the group of this name
    (``coeflab.fits``). A name that coeflab ships, or that two packages claim, is
    refused: the shipped plugin stays, and the log says whose was left out.

    Parameters
    ----------
    package : str
        Name of the kind, ``coeflab.`` and a word: what people type, and the group of entry points.
    kind : str
        What a plugin of this kind is called in messages.
    port : type
        The runtime-checkable protocol that a plugin keeps.
    folder : str, optional
        Dotted name of the package that holds the shipped plugins; by default that of the name.
    file : str, optional
        Every plugin is a package with this module in it, such as ``write``; otherwise every plugin is a module.
    """

    def __init__(self, package: str, kind: str, port: type[Port], folder: str = "", file: str = "") -> None:
        self.package, self.kind, self._port, self._folder, self._file = package, kind, port, folder or package, file

    @cached_property
    def _shipped(self) -> dict[str, str]:
        """Dotted name of the folder of every shipped plugin, by its name."""
        here = [Path(root) for root in importlib.import_module(self._folder).__path__]
        if self._file:
            names = (p.parent.name for root in here for p in root.glob(f"*/{self._file}.py"))
        else:
            names = (m.name for m in pkgutil.iter_modules(map(str, here)) if not m.ispkg)
        homes = dict.fromkeys(names, self._folder)
        for home, theirs in declared("PLUGINS").items():
            for folder in (folder for kind, folder in theirs.items() if kind == self.package):
                place = Path(__file__).parents[1] / home / folder
                names = (m.name for m in pkgutil.iter_modules([str(place)]) if not m.ispkg)
                homes |= dict.fromkeys(names, f"coeflab.{home}.{folder}")
        return {name: home for name, home in homes.items() if not name.startswith("_")}

    @cached_property
    def _claims(self) -> tuple[dict[str, EntryPoint], tuple[tuple[str, str], ...]]:
        """Plugins of other packages by name, and the names refused with the reason.

        Looked up once: the metadata of every installed package is read for it.
        """
        claims: dict[str, dict[tuple[str, str], EntryPoint]] = {}
        for point in entry_points(group=self.package):
            claims.setdefault(point.name, {})[_distribution(point), point.value] = point
        selected, refused = {}, []
        for name, points in sorted(claims.items()):
            owners = sorted({owner for owner, _ in points})
            if name in self._shipped:
                refused += [(name, f"the {self.kind} {shown(name)} of {o} is refused: {OURS} ships one of that name, "
                                   "which stays") for o in owners]  # fmt: skip
            elif len(points) > 1:
                refused.append((name, f"the {self.kind} {shown(name)} is refused: {' and '.join(owners)} claim it"))
            else:
                selected[name] = next(iter(points.values()))
        for _, reason in refused:
            logging.getLogger("coeflab").warning("%s.", reason)
        return selected, tuple(refused)

    def names(self) -> tuple[str, ...]:
        """Names of all plugins, sorted; nothing is imported."""
        return tuple(sorted({*self._shipped, *self._claims[0]}))

    def home(self, name: str) -> str:
        """Dotted name of the module that a shipped plugin is."""
        return ".".join(filter(None, (self._shipped[name], name, self._file)))

    def is_shipped(self, name: str) -> bool:
        """Whether the plugin of that name is coeflab's own."""
        return name in self._shipped

    def usable(self) -> tuple[str, ...]:
        """Names of the plugins that can be imported and keep their contract, sorted."""
        broken = {name for name, _ in self._broken()}
        return tuple(name for name in self.names() if name not in broken)

    def unusable(self) -> tuple[tuple[str, str], ...]:
        """Name and reason of every plugin of another package that is refused or broken, sorted by name."""
        return tuple(sorted((*self._broken(), *self._claims[1])))

    def _broken(self) -> list[tuple[str, str]]:
        out = []
        for name in self._claims[0]:
            try:
                self.load(name)
            except PluginError as why:
                out.append((name, str(why).removesuffix(".")))
        return out

    @staticmethod
    def _shortened(name: str, typed: str) -> bool:
        """Whether what is typed begins the name, or is its initials: turn for turning_circle, pvs for python_vehicle_simulator."""
        initials = "".join(word[:1] for word in name.split("_"))
        return len(typed) > 1 and (name.startswith(typed) or typed == initials)

    def _described_by(self, word: str) -> list[str]:
        """Names of the plugins whose summary has the word: gz for gazebo; one that cannot be imported has none."""
        found = []
        for name in self.names():
            with suppress(ImportError, PluginError):
                words = re.findall(r"\w+", getattr(self.load(name), "summary", "").casefold())
                found += [name] * (word.casefold() in words)
        return found

    def load(self, name: str) -> Port:
        """Import one plugin.

        Raises
        ------
        PluginError
            No plugin has that name (near names are suggested), or the plugin lacks part of its protocol, or the one of
            another package cannot be imported.
        """
        if name not in self.names():
            short = [n for n in self.names() if self._shortened(n, name.casefold())]
            near = short or difflib.get_close_matches(name, self.names(), n=3) or self._described_by(name)
            hint = f": did you mean {' or '.join(near)}?" if near else "."
            known = ", ".join(self.names()) or "none in this release"
            refused = "".join(f" {reason[0].upper()}{reason[1:]}." for n, reason in self._claims[1] if n == name)
            raise PluginError(f"no {self.kind} is called {shown(name)}{hint} Known: {known}.{refused}")
        point = self._claims[0].get(name)
        if point is None:
            plugin: Any = importlib.import_module(self.home(name))
            owner = ""
        else:
            with self.guarded(name, "cannot be imported"):
                plugin = point.load()
            owner = f" of {_distribution(point)}"
        for member, value in _optional(self._port).items():
            if not hasattr(plugin, member):
                setattr(plugin, member, value)
        missing = [a for a in _members(self._port) if not hasattr(plugin, a)]
        if missing or not isinstance(plugin, self._port):
            raise PluginError(f"the {self.kind} {shown(name)}{owner} lacks {', '.join(missing)}.")
        if point is not None and not isinstance(plugin.summary, str):  # type: ignore[attr-defined]
            raise PluginError(f"the {self.kind} {shown(name)}{owner} has a summary that is no text.")
        return plugin

    @contextmanager
    def guarded(self, name: str, doing: str = "failed") -> Iterator[None]:
        """Turn whatever a plugin of another package raises into an error with its name; ours raise as they are.

        Parameters
        ----------
        name : str
        doing : str
            What the message says of it.

        Raises
        ------
        PluginError
            With the plugin, its package and what it raised, which is the cause.
        """
        try:
            yield
        except (Exception, SystemExit) as why:
            point = self._claims[0].get(name)
            if point is None or isinstance(why, CoeflabError):
                raise
            what = f"{type(why).__name__}: {shown(why, 200)[1:-1]}" if str(why) else type(why).__name__
            raise PluginError(f"the {self.kind} {shown(name)} of {_distribution(point)} {doing}: {what}.") from why


def _distribution(point: EntryPoint) -> str:
    if point.dist is None:
        return "a package without a name"
    return f"{point.dist.metadata['Name']} {point.dist.version}"


def _protocols(port: type) -> list[type]:
    return [c for c in port.__mro__ if getattr(c, "_is_protocol", False) and c.__module__ != "typing"]


def _members(port: type) -> list[str]:
    names = {n for c in _protocols(port) for n in (*inspect.get_annotations(c), *vars(c))}
    return sorted(n for n in names if not n.startswith("_"))


def _optional(port: type) -> dict[str, Any]:
    """Members that a plugin may leave out, with what they are then: those to which the port gives a value."""
    return {n: vars(c)[n] for c in reversed(_protocols(port)) for n in inspect.get_annotations(c) if n in vars(c)}


def registry_of(kind: str) -> Registry[Any]:
    """The registry of a kind of plugins; no package without it is imported.

    Parameters
    ----------
    kind : str
        What people type: fits, importers, exporters ...

    Examples
    --------
    >>> "polynomial" in registry_of("fits").names()
    True
    """
    home, package = Path(__file__).parents[1], f"coeflab.{kind}"
    for file in sorted(home.rglob("__init__.py")):
        if re.search(rf'Registry\(\s*"{package}"', own_text(file)):
            found = vars(importlib.import_module(".".join(file.parent.relative_to(home.parent).parts)))
            return next(r for r in found.values() if isinstance(r, Registry) and r.package == package)
    raise KeyError(kind)


def registries() -> tuple[Registry[Any], ...]:
    """Every registry of coeflab, sorted by name: a package that makes one is found by itself."""
    home = [str(Path(__file__).parents[1])]
    folders = (m.name for m in pkgutil.walk_packages(home, "coeflab.") if m.ispkg)
    found = {id(r): r for f in folders for r in vars(importlib.import_module(f)).values() if isinstance(r, Registry)}
    return tuple(sorted(found.values(), key=lambda r: r.package))


@runtime_checkable
class Plugin(Protocol):
    """What every plugin has; a member with a value may be left out.

    Attributes
    ----------
    summary : str
        One line about itself, 10 to 120 letters.
    citations : tuple of str
        The works that it rests on: keys of `coeflab.core.provenance`, or full references.
    Options : type
        Dataclass of its options, see `coeflab.core.options`.
    """

    summary: str
    citations: tuple[str, ...]
    Options: type = NoOptions
