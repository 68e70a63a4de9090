"""Set up coeflab in an environment of its own, then run it or its tests. Needs only CPython 3.11 or later.

python3 start.py validate suboff     any coeflab command
python3 start.py gallery             the sample reports in reports/gallery, made anew
python3 start.py test                style, types, floors and tests; further arguments go to pytest
python3 start.py test --fast         the same without slow tests
"""

from __future__ import annotations

import hashlib
import os
import signal
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
WORKERS = "4"  # on two cores: tests of kills, of Slurm and of pages wait more than they compute


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
    """Style first, then types and floors beside the tests; the first gate that does not hold ends all, with what it said last."""
    environment = os.environ | ONE_THREAD
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # processes of tests compile coeflab once, not each
    sources = ["coeflab", "tests", "benchmarks", "cfd_data", "geometry", "reports", "start.py"]
    fast = ["-m", "not slow"] if "--fast" in arguments else []
    more = [a for a in arguments if a != "--fast"] or ["-n", WORKERS, "--dist", "worksteal", "--durations=20"]
    for gate in (["ruff", "check", *sources], ["ruff", "format", "--check", *sources]):
        if code := subprocess.run([str(PYTHON), "-m", *gate], cwd=ROOT, env=environment, check=False).returncode:
            return code
    tests = subprocess.Popen([str(PYTHON), "-m", "pytest", *more, *fast], cwd=ROOT, env=environment)
    try:
        for gate in ([str(PYTHON), "-m", "mypy"], [str(BIN / "lint-imports")]):
            done = subprocess.run(gate, cwd=ROOT, env=environment, check=False, capture_output=True, text=True)
            if done.returncode:
                end(tests)
                sys.stdout.write(f"\n{' '.join(gate)}\n{done.stdout}{done.stderr}")
                return done.returncode
        return tests.wait()
    finally:
        end(tests)


def end(tests: subprocess.Popen[bytes]) -> None:
    """Interrupt tests that still run, so that they clear up; kill those that do not end."""
    if tests.poll() is None:
        if os.name == "nt":
            tests.terminate()
        else:
            tests.send_signal(signal.SIGINT)
        try:
            tests.wait(60.0)
        except subprocess.TimeoutExpired:
            tests.kill()
            tests.wait()


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
