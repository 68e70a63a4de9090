"""Make an environment with lxdyn, the real xdyn, whose one wheel is for CPython 3.10 on Linux.

python3 tests/consumers/lxdyn_environment.py     once; the tests find it by themselves
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ENVIRONMENT = Path(__file__).resolve().parents[2] / ".venv" / "consumers" / "lxdyn"
PYTHON = ENVIRONMENT / "bin" / "python"
PACKAGES = ("lxdyn==26.8.1", "numpy==2.2.6")


def interpreters() -> list[Path]:
    """Places where a CPython 3.10 may be: the path, pyenv and uv."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    uv = Path(os.environ.get("UV_PYTHON_INSTALL_DIR", Path.home() / ".local" / "share" / "uv" / "python"))
    known = [p for root in (pyenv, Path("/opt/pyenv")) for p in sorted(root.glob("versions/3.10.*/bin/python3.10"))]
    known += sorted(uv.glob("cpython-3.10*/bin/python3.10"))
    on_path = shutil.which("python3.10")
    return [*known, *([Path(on_path)] if on_path else [])]


def works(python: Path) -> bool:
    """Whether it runs and is 3.10; a shim of pyenv may be there for a version that is not chosen."""
    asked = [str(python), "-c", "import sys; raise SystemExit(sys.version_info[:2] != (3, 10))"]
    return subprocess.run(asked, check=False, capture_output=True).returncode == 0


def main() -> int:
    """Make the environment, if it is not there yet."""
    if PYTHON.exists() and subprocess.run([str(PYTHON), "-c", "import xdyn"], check=False).returncode == 0:
        return 0
    found = next((p for p in interpreters() if works(p)), None)
    if found is None:
        sys.stderr.write("No CPython 3.10 on the path or under pyenv or uv; lxdyn has a wheel for no other.\n")
        return 1
    for command in (
        [str(found), "-m", "venv", "--clear", str(ENVIRONMENT)],
        [str(PYTHON), "-m", "pip", "install", "-qq", "--disable-pip-version-check", *PACKAGES],
    ):
        if subprocess.run(command, check=False).returncode:
            return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
