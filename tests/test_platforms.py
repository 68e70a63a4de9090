"""What ties the package to one system is guarded: fork, locks, /proc, signals, letters that files of Windows cannot bear; syntax of the oldest Python."""

from __future__ import annotations

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.sources import PACKAGE, trees

ROOT = Path(__file__).parents[1]
# What is not there on Windows, and what says that somebody thought of it: a branch, a suppressed error, or a missing file.
UNIX = {
    "fcntl": "sys.platform", "resource": "sys.platform", "termios": "sys.platform", "pwd": "sys.platform", "grp": "sys.platform",
    "os.fork": "hasattr", "os.killpg": "sys.platform", "os.getpgid": "sys.platform", "os.setsid": "sys.platform", "os.mkfifo": "sys.platform",
    "os.getuid": "hasattr", "os.sched_getaffinity": "hasattr", "signal.SIGKILL": "sys.platform", "signal.pause": "sys.platform",
}  # fmt: skip
GUARDS = (
    "sys.platform",
    "os.name",
    "hasattr(",
    "getattr(",
    "get_all_start_methods",
    "suppress(OSError",
    "except (OSError",
    "except OSError",
    "AttributeError",
)
FORBIDDEN = set('<>:"|?*\\\\')


def unguarded(file: Path) -> Iterator[str]:
    """Uses of what only Unix has in a file in which nothing guards them."""
    text = file.read_text(encoding="utf-8")
    if any(guard in text for guard in GUARDS):
        return
    tree = trees()[file] if file.is_relative_to(PACKAGE) else ast.parse(text)
    uses = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            uses += [(a.name, node.lineno) for a in node.names if a.name in UNIX]
        elif isinstance(node, ast.ImportFrom) and node.module in UNIX:
            uses.append((node.module, node.lineno))
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            uses += [(n, node.lineno) for n in [f"{node.value.id}.{node.attr}"] if n in UNIX]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith("/proc"):
            uses.append(("/proc", node.lineno))
        elif isinstance(node, ast.Call) and any(isinstance(a, ast.Constant) and a.value == "fork" for a in node.args):
            uses += (
                [("fork", node.lineno)]
                if "context" in ast.unparse(node.func) or "start_method" in ast.unparse(node.func)
                else []
            )
    yield from (f"{file.name}:{line}: {name}" for name, line in uses)


def test_what_only_unix_has_is_guarded() -> None:
    assert [use for file in trees() for use in unguarded(file)] == []


@pytest.mark.parametrize(
    "line", ["import fcntl", "import os\nos.fork()", "P = '/proc/self'", "C = get_context('fork')"]
)
def test_an_unguarded_use_is_found(tmp_path: Path, line: str) -> None:
    (tmp_path / "a.py").write_text(line)
    assert list(unguarded(tmp_path / "a.py"))
    (tmp_path / "a.py").write_text(f"import sys\nif sys.platform != 'win32':\n    pass\n{line}")
    assert not list(unguarded(tmp_path / "a.py"))


def test_names_of_files_are_those_that_every_system_bears() -> None:
    """Of all that is committed, so of all that a wheel or a checkout unpacks."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    names = listed.stdout.split("\0")[:-1] or [str(p.relative_to(ROOT)) for p in (ROOT / "coeflab").rglob("*")]
    assert [n for n in names if set(n) & FORBIDDEN or n.endswith((" ", ".")) or len(n) > 180] == []
    assert len({n.casefold() for n in names}) == len(names)


def test_the_oldest_python_reads_every_file() -> None:
    assert len(trees()) > 400


def test_no_lookahead_ends_a_possessive_repeat() -> None:
    """CPython 3.11.2, which Debian serves, keeps what the failing last repeat has read; `atomic` of core/text/patterns stands for it."""
    wrong = re.compile(r"\(\?[!=][^()]*(?:\([^()]*\)[^()]*)*\)\)[*+?]\+")
    assert wrong.search(r"(?:a(?!b))*+")
    assert [file.name for file in trees() if wrong.search(file.read_text(encoding="utf-8"))] == []
