"""The core without any application: a copy of the sources from which their folders are deleted, its modules, the validation, some tests.

``python tests/core_alone.py`` prints what it ran and ends with the code of the first that fails. Numbers are the whole run's to
compare: what is tried here is that nothing asks for what is deleted. Every module is imported, every plugin, target and rule of the
law is used; of other tests with many cases every third is tried.
"""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

ROOT = Path(__file__).resolve().parents[1]
COPIED = ("coeflab", "cfd_data", "docs", "geometry", "reports", "tests", "pyproject.toml")
TESTED = (
    "every_plugin/test_contract.py", "formats/test_every_exporter.py", "vehicle/test_conformance.py", "motion/test_manoeuvres.py",
    "cli/test_commands.py", "api/test_names_that_people_type.py", "report/test_content.py",
)  # fmt: skip
WHOLE = ("test_contract.py", "test_every_exporter.py", "test_conformance.py")
EVERY_MODULE = """
import importlib, pkgutil, coeflab
for module in pkgutil.walk_packages(coeflab.__path__, "coeflab."):
    if not module.name.endswith("__main__"):
        importlib.import_module(module.name)
"""


def applications(root: Path) -> set[str]:
    """Names of the folders that are applications."""
    return {p.parent.name for p in root.glob("coeflab/*/application.py")}


def reached(file: Path) -> set[str]:
    """Modules that a file imports, hidden in functions too."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {a.name for a in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{a.name}" for a in node.names)}
    return found


def need_applications(root: Path, names: set[str]) -> set[Path]:
    """Test modules that import an application, themselves or through another module of the tests."""
    imports = {p: reached(p) for p in root.glob("tests/**/*.py")}
    dotted = {".".join(p.relative_to(root).with_suffix("").parts): p for p in imports}
    theirs = tuple(f"coeflab.{name}" for name in names)
    need = {p for p, found in imports.items() if any(f == t or f.startswith(f"{t}.") for f in found for t in theirs)}
    while more := {p for p, found in imports.items() if p not in need and any(dotted.get(f) in need for f in found)}:
        need |= more
    return need


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """As a plugin of pytest: one case of three."""
    items[:] = [
        item for k, item in enumerate(items) if k % 3 == 0 or not hasattr(item, "callspec") or item.path.name in WHOLE
    ]


def main() -> int:
    """Copy, delete, run."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name in COPIED:
            if (ROOT / name).is_dir():
                # With what is compiled, but for files that another process is writing.
                shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("*.pyc.*", "*.tmp.*"))
            else:
                shutil.copy(ROOT / name, root / name)
        names = applications(root)
        for file in need_applications(root, names):
            file.unlink()
        for name in names:
            shutil.rmtree(root / "coeflab" / name)
        environment = os.environ | {"PYTHONPATH": folder}
        tests = [f"tests/{name}" for name in TESTED]
        for command in (
            ["-c", EVERY_MODULE],
            ["-m", "coeflab", "validate", "suboff", "--json"],
            ["-m", "pytest", "-q", "-m", "not slow", "-p", "no:cacheprovider", "-p", "tests.core_alone", *tests],
        ):
            code = subprocess.run([sys.executable, *command], cwd=root, env=environment, check=False).returncode
            if code:
                return code
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
