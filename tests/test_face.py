"""The library's face: every public name is there, and importing it stays cheap."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import version

import coeflab


def test_every_public_name_resolves() -> None:
    for name in coeflab.__all__:
        assert getattr(coeflab, name) is not None, name
    assert set(coeflab.__all__) == {*coeflab._homes(), "__version__"}


def test_import_pulls_in_nothing_heavy() -> None:
    heavy = ["numpy", "pandas", "scipy", "pint", "pydantic", "matplotlib", "typer", "rich"]
    code = f"import sys, coeflab; print([m for m in {heavy} if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_command_line_help_pulls_in_nothing_heavy() -> None:
    heavy = ["numpy", "pandas", "scipy", "pint", "pydantic", "matplotlib", "rich"]
    ours = "[m for m in sys.modules if m.startswith('coeflab.') and m.count('.') > 1]"
    code = f"""import atexit, sys; sys.argv[1:] = ["--help"]; from coeflab.cli import main
atexit.register(lambda: print([m for m in {heavy} if m in sys.modules], {ours}))
main()"""
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "uncertainty  Give intervals for the quantities of a manoeuvre" in shown
    loaded = ["cards", "version", "text", "keywords", "errors", "limits", "text.bounded", "applications"]
    assert shown.endswith(f"[] {[f'coeflab.core.{name}' for name in loaded]}\n")


def test_version_is_the_installed_one() -> None:
    assert version("coeflab") == coeflab.__version__
