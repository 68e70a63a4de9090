"""SECURITY.md says nothing that no test holds."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.sources import PACKAGE, nodes

ROOT = Path(__file__).parents[1]
TEXT = " ".join((ROOT / "SECURITY.md").read_text(encoding="utf-8").split())
# What it says, and the test of that.
CLAIMS = {
    "YAML (safe loader)": "core/test_yaml.py", "XML (no entities)": "core/test_xml.py",
    "Patterns that an input brings are matched in linear time": "core/test_patterns.py",
    "Files are opened by `coeflab/core/text` alone": "core/test_readers.py::test_foreign_files_are_read_by_the_readers_alone",
    "two seconds and 300 MB": "fuzz/test_fuzz.py::test_spoilt_inputs_are_read_or_refused",
    "Pipes, devices and links that lead to themselves are refused": "core/test_readers.py::test_pipes_are_no_files",
    "Names out of inputs become names of files that lead nowhere else": "core/test_names_of_files.py",
    "A file is replaced whole or not at all": "core/test_files.py::test_a_failure_leaves_the_old_file_and_no_litter",
    "removed by the next command": "core/test_killed.py::test_what_a_killed_writer_left_is_removed_by_the_next",
    "names the other's process": "core/test_killed.py::test_who_is_waited_for_is_named",
    "`params conform` runs the command that you type": "cli/test_conform.py",
    "Windows and macOS are not tried": "test_platforms.py::test_what_only_unix_has_is_guarded",
    "**Network**: none": "test_security.py::test_nothing_reaches_the_network",
}  # fmt: skip
# What listens on this machine, or speaks to a scheduler that a person names; of a socket the others ask the name of this machine alone.
MAY_SPEAK = {
    "core/machine.py",
    "report/gallery/server.py",
    "cli/serve.py",
    "motion/uncertainty/batches.py",
    "tank/runners/dask.py",
}
SPEAKS = {
    "urllib.request",
    "http.client",
    "http.server",
    "ftplib",
    "smtplib",
    "requests",
    "httpx",
    "aiohttp",
    "distributed",
    "asyncio",
}


@pytest.mark.parametrize("claim", [c for c, test in CLAIMS.items() if test])
def test_each_claim_has_its_test(claim: str) -> None:
    file, _, name = CLAIMS[claim].partition("::")
    assert claim in TEXT
    assert f"def {name or 'test_'}" in (ROOT / "tests" / file).read_text(encoding="utf-8")


def test_it_is_half_a_page() -> None:
    assert len(TEXT.split()) < 330


def test_nothing_reaches_the_network() -> None:
    found = set()
    for file, within in nodes().items():
        for node in within:
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) and node.module and not node.level else []
            if any(
                n in SPEAKS or n.partition(".")[0] in SPEAKS - {"urllib.request", "http.client", "http.server"}
                for n in names
            ):
                found.add(file.relative_to(PACKAGE).as_posix())
    assert found <= MAY_SPEAK


def test_nothing_is_evaluated() -> None:
    """No eval, exec, compile of a text, pickle, shell: nothing of an input can be executed."""
    bad = {"eval", "exec", "os.system", "os.popen", "pickle.loads", "pickle.load", "marshal.loads", "yaml.unsafe_load"}
    for file, within in nodes().items():
        for node in within:
            if isinstance(node, ast.Call):
                assert ast.unparse(node.func) not in bad, f"{file}:{node.lineno}"
                assert not any(k.arg == "shell" and getattr(k.value, "value", True) for k in node.keywords), (
                    f"{file}:{node.lineno}"
                )
