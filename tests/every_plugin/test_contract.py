"""What every plugin of every room keeps; a new file is taken in by itself."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import re
from typing import Any

import pytest

from coeflab.api.listing import options_of
from coeflab.bodies.readers import BODIES
from coeflab.core.declarations import Declaration, validated
from coeflab.core.options import described
from coeflab.core.provenance import works
from coeflab.core.registry import Registry, registries
from coeflab.fits import FITS
from coeflab.formats import EXPORTERS
from coeflab.report.formats import REPORTERS
from coeflab.study.checks import CHECKS
from coeflab.tables.importers import IMPORTERS

TANK = ("coeflab.tow_solvers", "coeflab.tow_runners")
ROOMS = registries()
PLUGINS = [pytest.param(room, name, id=f"{room.package}.{name}") for room in ROOMS for name in room.names()]


def module_of(room: Registry[Any], name: str) -> str:
    return room.home(name)


@pytest.mark.parametrize("room", ROOMS, ids=lambda r: r.package)
def test_rooms_say_what_they_hold(room: Registry[Any]) -> None:
    assert room.kind
    assert importlib.import_module(room._folder).__doc__
    assert list(room.names()) == sorted(set(room.names()))


def test_the_rooms_of_the_main_path_are_not_empty() -> None:
    assert "csv" in IMPORTERS.names()
    assert "particulars" in BODIES.names()
    assert "slope_at_origin" in FITS.names()
    assert "csv" in EXPORTERS.names()
    assert {"symmetry", "signs"} <= set(CHECKS.names())
    assert "html" in REPORTERS.names()


@pytest.mark.parametrize(("room", "name"), PLUGINS)
def test_contract(room: Registry[Any], name: str) -> None:
    plugin = room.load(name)
    assert re.fullmatch(r"[a-z][a-z0-9_]*", name)
    assert plugin.__name__ == module_of(room, name)
    assert isinstance(plugin.summary, str)
    assert plugin.summary == plugin.summary.strip()
    assert 10 <= len(plugin.summary) <= 120
    assert "\n" not in plugin.summary
    assert isinstance(plugin.citations, tuple)
    assert all(c in works() or re.search(r"\b(19|20)\d\d\b", c) for c in plugin.citations)
    assert dataclasses.is_dataclass(plugin.Options)
    assert inspect.getdoc(plugin)


@pytest.mark.parametrize(("room", "name"), [p for p in PLUGINS if p.values[0].package in TANK])
def test_what_tank_toml_says_to_a_plugin_is_declared_and_explained(room: Registry[Any], name: str) -> None:
    declared = room.load(name).options
    assert issubclass(declared, Declaration)
    assert validated(declared, {}) is not None  # a tank.toml need not say anything of it
    for key in described(declared):
        assert key.meaning, key.name
        assert key.takes
    assert [row[0] for row in options_of(room, name).rows] == [key.name for key in described(declared)]


@pytest.mark.parametrize(("room", "name"), PLUGINS)
def test_verbs_have_the_arguments_of_the_port(room: Registry[Any], name: str) -> None:
    plugin = room.load(name)
    optional = inspect.get_annotations(room._port)
    verbs = [n for n, f in vars(room._port).items() if inspect.isfunction(f) and n[0] != "_" and n not in optional]
    assert verbs
    for verb in verbs:
        wanted = inspect.signature(vars(room._port)[verb]).parameters
        have = inspect.signature(getattr(plugin, verb)).parameters
        assert [p for p in wanted if p != "self"] == list(have)[: len(wanted) - 1]
        extra = list(have.values())[len(wanted) - 1 :]
        assert all(p.default is not inspect.Parameter.empty for p in extra)
        assert inspect.getdoc(getattr(plugin, verb))


@pytest.mark.parametrize(("room", "name"), PLUGINS)
def test_no_plugin_imports_another(room: Registry[Any], name: str) -> None:
    module = room.load(name)
    tree = ast.parse(inspect.getsource(module))
    plugins = {module_of(r, n) for r in ROOMS for n in r.names()}
    for node in ast.walk(tree):
        names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        names += [a.name for a in node.names] if isinstance(node, ast.Import) else []
        names += [f"{node.module}.{a.name}" for a in node.names] if isinstance(node, ast.ImportFrom) else []
        assert not plugins & set(names)


def test_every_work_is_one_line() -> None:
    for key, text in works().items():
        assert re.fullmatch(r"[a-z0-9_]+", key)
        assert "\n" not in text
        assert len(text) > 20
