"""Set up coeflab in an environment of its own, then run it or its tests. Needs only CPython 3.11 or later.

python3 start.py validate suboff     any coeflab command
python3 start.py gallery             the sample reports in reports/gallery, made anew
python3 start.py test                style, types, floors and tests; further arguments go to pytest
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
ENVIRONMENT = ROOT / ".venv"
BIN = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
PYTHON = BIN / ("python.exe" if os.name == "nt" else "python")
ACTIVATE = r".venv\Scripts\activate" if os.name == "nt" else "source .venv/bin/activate"
GALLERY = ROOT / "reports" / "gallery" / "make.py"
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
OLDEST = (3, 11)
EXTRA = "derive"  # the one that a command of the README needs
WORKERS = "3"  # on two cores: tests of kills, of Slurm and of pages wait more than they compute


def requirements(groups: tuple[str, ...]) -> list[str]:
    """Packages of the dependency groups in pyproject.toml."""
    import tomllib

    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["dependency-groups"]
    return [package for group in groups for package in declared[group]]


def set_up(groups: tuple[str, ...]) -> None:
    """Make the environment and install what is missing; nothing is done when it is up to date."""
    files = [ROOT / "pyproject.toml", ROOT / "constraints.txt"]
    state = hashlib.sha256(b"".join(f.read_bytes() for f in files) + repr(sys.version_info[:2]).encode()).hexdigest()
    ready = ENVIRONMENT / "coeflab-ready"
    done = ready.read_text(encoding="utf-8").split() if ready.exists() else []
    if done[:1] == [state] and set(groups) <= set(done[1:]) and PYTHON.exists():
        return
    sys.stderr.write("Setting up .venv (a minute or two, once) ...\n")
    if not PYTHON.exists():
        made = subprocess.run([sys.executable, "-m", "venv", str(ENVIRONMENT)], check=False)
        if made.returncode:
            raise SystemExit("This Python cannot make virtual environments; install its venv module (python3-venv).")
    install = [str(PYTHON), "-m", "pip", "install", "-qq", "--disable-pip-version-check"]
    packages = ["-c", str(ROOT / "constraints.txt"), "-e", f"{ROOT}[{EXTRA}]", *requirements(groups)]
    if subprocess.run(install + packages, check=False).returncode:
        raise SystemExit("The packages could not be installed; pip says why above.")
    kept = set(groups) | (set(done[1:]) if done[:1] == [state] else set())
    ready.write_text(" ".join([state, *sorted(kept)]), encoding="utf-8")


def test(arguments: list[str]) -> int:
    """Every gate in turn; stops at the first that does not hold."""
    environment = os.environ | ONE_THREAD
    sources = ["coeflab", "tests", "benchmarks", "cfd_data", "geometry", "reports", "start.py"]
    gates = [
        [str(PYTHON), "-m", "ruff", "check", *sources],
        [str(PYTHON), "-m", "ruff", "format", "--check", *sources],
        [str(PYTHON), "-m", "mypy"],
        [str(BIN / "lint-imports")],
        [str(PYTHON), "-m", "pytest", *(arguments or ["-n", WORKERS, "--dist", "worksteal"])],
    ]
    for gate in gates:
        code = subprocess.run(gate, cwd=ROOT, env=environment, check=False).returncode
        if code:
            return code
    return 0


def main() -> int:
    """Set up, then do what was asked."""
    if sys.version_info < OLDEST:
        raise SystemExit(f"coeflab needs CPython {OLDEST[0]}.{OLDEST[1]} or later; this is {sys.version.split()[0]}.")
    arguments = sys.argv[1:]
    if not arguments or arguments[0] in ("-h", "--help"):
        sys.stdout.write(f"{__doc__}")
        return 0
    if arguments[0] == "test":
        set_up(("test", "lint"))
        return test(arguments[1:])
    set_up(())
    if arguments == ["gallery"]:
        return subprocess.run([str(PYTHON), str(GALLERY)], env=os.environ | ONE_THREAD, check=False).returncode
    code = subprocess.run([str(BIN / "coeflab"), *arguments], check=False).returncode
    if code == 0:
        sys.stderr.write(
            f"Set up in .venv, and the command ended well. Next: {ACTIVATE}, then coeflab without start.py.\n"
        )
    return code


if __name__ == "__main__":
    raise SystemExit(main())
