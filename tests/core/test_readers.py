"""Files are opened, and texts of others parsed, by the readers in ``core/text`` alone."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.bounded import leading_bytes, stream_of, whole_bytes
from tests.sources import PACKAGE, trees

READS = {"open", "read_text", "read_bytes"}
PARSES = {
    "json.loads", "json.load", "tomllib.loads", "tomllib.load", "yaml.load", "yaml.safe_load", "pickle.load", "pickle.loads", "np.load",
    "np.loadtxt", "np.genfromtxt", "ElementTree.parse", "ElementTree.fromstring", "minidom.parse",
}  # fmt: skip
PATTERNS = {f"re.{n}" for n in ("compile", "match", "fullmatch", "search", "sub", "findall", "finditer", "split")}

NO_READS = {"os.open", "webbrowser.open", "read_text"}  # the last, bare, is the bounded one
MAY_READ = re.compile(
    r"open\(|read_(?:text|bytes)\(|loads?\(|loadtxt|genfromtxt|parse\(|fromstring|safe_load|re\.\w+\([a-z]"
)

READER = "core/text/"  # the readers: they open regular files alone and bound bytes, depth and counts


def called(node: ast.Call) -> str:
    what = node.func
    if isinstance(what, ast.Attribute):
        owner = what.value.id if isinstance(what.value, ast.Name) else ""
        return f"{owner}.{what.attr}"
    return what.id if isinstance(what, ast.Name) else ""


def writes(node: ast.Call) -> bool:
    """Whether a file is opened to be written: its mode says so."""
    modes = [a.value for a in node.args if isinstance(a, ast.Constant) and isinstance(a.value, str)]
    return any(set(mode) & set("wax+") and len(mode) <= 3 for mode in modes)


def foreign(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and name of calls that read a file, parse a text, or make a pattern of something that is no constant of the module."""
    constants = {
        t.id
        for n in ast.walk(tree)
        if isinstance(n, ast.Assign)
        for t in n.targets
        if isinstance(t, ast.Name) and t.id.isupper()
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = called(node)
        if (name.rpartition(".")[2] in READS and name not in NO_READS and not writes(node)) or name in PARSES:
            yield node.lineno, name
        elif (
            name in PATTERNS
            and node.args
            and isinstance(node.args[0], (ast.Name, ast.Attribute, ast.Subscript, ast.Call))
        ):
            inside = {n.id for n in ast.walk(node.args[0]) if isinstance(n, ast.Name)}
            if not all(n.isupper() or n.startswith("_") or n in constants for n in inside):
                yield node.lineno, name


def found(package: Path) -> dict[str, list[str]]:
    out: dict[str, list[str]] = {}
    for file in sorted(package.rglob("*.py")):
        name = file.relative_to(package).as_posix()
        if not name.startswith(READER):
            text = file.read_text(encoding="utf-8")
            tree = trees()[file] if package == PACKAGE else ast.parse(text)
            calls = [f"{at}: {call}" for at, call in foreign(tree)] if MAY_READ.search(text) else []
            if calls:
                out[name] = calls
    return out


def test_foreign_files_are_read_by_the_readers_alone() -> None:
    assert found(PACKAGE) == {}, (
        "core/text has stream_of, read_text, read_toml, parse_json, read_record, own_text, holds"
    )


@pytest.mark.parametrize(
    "line",
    [
        "json.loads(text)",
        "Path(name).read_text()",
        "open(name)",
        "p.open()",
        "re.compile(text)",
        "yaml.load(text)",
        "p.read_bytes()",
        "np.loadtxt(p)",
    ],
)
def test_a_reader_in_a_command_is_found(tmp_path: Path, line: str) -> None:
    (tmp_path / "cli").mkdir()
    (tmp_path / "cli" / "fit.py").write_text(f"import json\ndef command(text, name, p):\n    return {line}\n")
    assert list(found(tmp_path)) == ["cli/fit.py"]


def test_a_reader_in_a_command_of_ours_is_found(tmp_path: Path) -> None:
    copy = tmp_path / "cli" / "export.py"
    copy.parent.mkdir()
    copy.write_text(
        (PACKAGE / "cli" / "export.py").read_text()
        + "\n\ndef _more(text):\n    import json\n\n    return json.loads(text)\n"
    )
    assert [call.partition(": ")[2] for call in found(tmp_path)["cli/export.py"]] == ["json.loads"]


def test_pipes_are_no_files(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for read in (stream_of, partial(whole_bytes, most=10), partial(leading_bytes, most=10)):
        with pytest.raises((OSError, InputError), match="pipe"):
            read(tmp_path / "pipe")
    (tmp_path / "long").write_bytes(b"a" * 11)
    with pytest.raises(InputError, match="at most 10"):
        whole_bytes(tmp_path / "long", 10)
    assert leading_bytes(tmp_path / "long", 10) == b"a" * 10
