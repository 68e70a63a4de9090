from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Protocol, runtime_checkable

import pytest

from coeflab.core import registry
from coeflab.core.errors import PluginError
from coeflab.core.registry import Registry


@runtime_checkable
class Greeter(Protocol):
    summary: str

    def greet(self) -> str: ...


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Registry[Greeter]]:
    package = tmp_path / "greeters"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "polite.py").write_text(
        "summary = 'a concierge, well-mannered'\ndef greet() -> str:\n    return 'good day'\n"
    )
    (package / "mute.py").write_text("summary = 's'\n")
    (package / "broken.py").write_text("import a_module_that_does_not_exist\n")
    (package / "_helper.py").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    yield Registry("greeters", "greeter", Greeter)  # type: ignore[type-abstract]
    for name in [n for n in sys.modules if n.partition(".")[0] == "greeters"]:
        del sys.modules[name]


def test_names_are_files_and_nothing_is_imported(room: Registry[Greeter]) -> None:
    assert room.names() == ("broken", "mute", "polite")
    assert [n for n in sys.modules if n.startswith("greeters.")] == []
    assert room.load("polite").greet() == "good day"
    assert [n for n in sys.modules if n.startswith("greeters.")] == ["greeters.polite"]


def test_initials_and_beginnings_suggest_the_name() -> None:
    from coeflab.formats import EXPORTERS

    for typed in ("pvs", "PVS"):
        with pytest.raises(PluginError, match=r"did you mean python_vehicle_simulator\?"):
            EXPORTERS.load(typed)
    from coeflab.motion.manoeuvres import MANOEUVRES

    with pytest.raises(PluginError, match=r"did you mean turning_circle\?"):
        MANOEUVRES.load("turn")


def test_unknown_name_suggests_near_ones(room: Registry[Greeter]) -> None:
    with pytest.raises(PluginError, match=r'no greeter is called "polit": did you mean polite\? Known: broken, mute'):
        room.load("polit")
    with pytest.raises(PluginError, match=r'no greeter is called "zzzz"\. Known: broken'):
        room.load("zzzz")
    with pytest.raises(PluginError, match=r'no greeter is called "Concierge": did you mean polite\?'):
        room.load("Concierge")
    with pytest.raises(PluginError):
        room.load("_helper")


def test_a_plugin_that_lacks_part_of_its_protocol(room: Registry[Greeter]) -> None:
    with pytest.raises(PluginError, match=r'the greeter "mute" lacks greet\.'):
        room.load("mute")


def test_lacks_names_inherited_parts_too(room: Registry[Greeter]) -> None:
    @runtime_checkable
    class Signed(Greeter, Protocol):
        def sign(self) -> str: ...

    with pytest.raises(PluginError, match=r'"mute" lacks greet, sign\.'):
        Registry("greeters", "greeter", Signed).load("mute")  # type: ignore[type-abstract]


def test_import_errors_are_not_hidden(room: Registry[Greeter]) -> None:
    with pytest.raises(ModuleNotFoundError, match="a_module_that_does_not_exist"):
        room.load("broken")


def test_outside_packages_join_through_an_entry_point(room: Registry[Greeter], monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("stranger", "greeters.polite", "greeters")
    asked: list[str] = []

    def found(*, group: str) -> list[EntryPoint]:
        asked.append(group)
        return [point]

    monkeypatch.setattr(registry, "entry_points", found)
    assert "stranger" in room.names()
    assert room.load("stranger").greet() == "good day"
    assert asked == ["greeters"], "installed packages are looked through once"


def test_an_empty_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "emptyroom").mkdir()
    (tmp_path / "emptyroom" / "__init__.py").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    room = Registry("emptyroom", "thing", Greeter)  # type: ignore[type-abstract]
    assert room.names() == ()
    with pytest.raises(PluginError, match="Known: none in this release"):
        room.load("x")
